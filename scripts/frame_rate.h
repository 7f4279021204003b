// Frames of a film: exact times at a rational rate.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace scripts {

// numerator / denominator frames a second, in lowest terms, both positive.
struct FrameRate {
  static constexpr double kMin = 0.001;
  static constexpr double kMax = 1000;
  static constexpr std::int64_t kMaxDenominator = 1'000'000;

  std::int64_t numerator = 30;
  std::int64_t denominator = 1;

  bool operator==(const FrameRate&) const = default;
};

// "30", "30000/1001", or a decimal number of at most six places ("29.97" = 2997/100). Nothing when the text is
// something else or the rate is outside kMin..kMax.
std::optional<FrameRate> parse_frame_rate(std::string_view text);

// "30" or "30000/1001"; parse_frame_rate() reads it back.
std::string to_text(const FrameRate& rate);

// Time of frame k in seconds: the double nearest to k / rate, never accumulated. 0 <= k, and
// k * denominator < 2^53.
double frame_time(const FrameRate& rate, std::int64_t k);

// Frames of a film of this length: round(duration * rate); the first is at 0, the last one frame before the
// end. 0 for a duration below half a frame.
std::int64_t frame_count(const FrameRate& rate, double duration_s);

}  // namespace scripts
