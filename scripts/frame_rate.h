// Frames of a film: exact times at a rational rate.
//
// Typical usage:
//   const FrameRate rate = parse_frame_rate("30000/1001").value();
//   for (std::int64_t k = 0; k < frame_count(rate, duration_s); ++k) draw(frame_time(rate, k));
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace scripts {

// Holds a rate of numerator / denominator frames a second, in lowest terms, both positive.
struct FrameRate {
  static constexpr double kMin = 0.001;
  static constexpr double kMax = 1000;
  static constexpr std::int64_t kMaxDenominator = 1'000'000;

  std::int64_t numerator = 30;
  std::int64_t denominator = 1;

  bool operator==(const FrameRate&) const = default;
};

// Parses "30", "30000/1001", or a number of at most six decimals ("29.97" = 2997/100). Returns nullopt when
// the text is anything else or the rate is outside kMin..kMax.
std::optional<FrameRate> parse_frame_rate(std::string_view text);

// Returns "30" or "30000/1001"; parse_frame_rate() reads it back.
std::string to_text(const FrameRate& rate);

// Returns the time of frame k in seconds: the double nearest to k / rate, never accumulated. Requires 0 <= k
// and k * denominator < 2^53.
double frame_time(const FrameRate& rate, std::int64_t k);

// Returns the number of frames of a film of this length, round(duration * rate). The first is at 0, the last
// one frame before the end. Returns 0 for a duration below half a frame.
std::int64_t frame_count(const FrameRate& rate, double duration_s);

}  // namespace scripts
