#include "scripts/frame_rate.h"

#include <cmath>
#include <numeric>

#include "vpe/base/number.h"

namespace scripts {

using vpe::base::parse_integer;

std::optional<FrameRate> parse_frame_rate(std::string_view text) {
  constexpr std::size_t kMaxDigits = 10;
  const std::size_t split = text.find_first_of("/.");
  const std::string_view head = text.substr(0, split);
  const std::string_view tail = split == std::string_view::npos ? std::string_view{} : text.substr(split + 1);
  if (head.size() > kMaxDigits || tail.size() > kMaxDigits) return std::nullopt;
  if (text.find_first_not_of("0123456789/.") != std::string_view::npos) return std::nullopt;

  std::optional<std::int64_t> numerator = parse_integer(head);
  std::optional<std::int64_t> denominator = 1;
  if (split != std::string_view::npos && text[split] == '/') {
    denominator = parse_integer(tail);
  } else if (split != std::string_view::npos) {
    if (tail.size() > 6) return std::nullopt;
    for (std::size_t place = 0; place < tail.size(); ++place) *denominator *= 10;
    const std::optional<std::int64_t> fraction = parse_integer(tail);
    numerator = numerator && fraction ? std::optional(*numerator * *denominator + *fraction) : std::nullopt;
  }
  if (!numerator || !denominator || *denominator == 0) return std::nullopt;

  const std::int64_t divisor = std::gcd(*numerator, *denominator);
  const FrameRate rate{*numerator / divisor, *denominator / divisor};
  const double value = static_cast<double>(rate.numerator) / static_cast<double>(rate.denominator);
  const bool allowed =
      value >= FrameRate::kMin && value <= FrameRate::kMax && rate.denominator <= FrameRate::kMaxDenominator;
  return allowed ? std::optional(rate) : std::nullopt;
}

std::string to_text(const FrameRate& rate) {
  const std::string numerator = std::to_string(rate.numerator);
  return rate.denominator == 1 ? numerator : numerator + "/" + std::to_string(rate.denominator);
}

double frame_time(const FrameRate& rate, std::int64_t k) {
  // Both are integers that a double holds, so the one division rounds correctly.
  return static_cast<double>(k * rate.denominator) / static_cast<double>(rate.numerator);
}

std::int64_t frame_count(const FrameRate& rate, double duration_s) {
  return std::llround(duration_s * static_cast<double>(rate.numerator) / static_cast<double>(rate.denominator));
}

}  // namespace scripts
