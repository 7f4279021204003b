#include "vpe/base/number.h"

#include <array>
#include <charconv>
#include <cmath>

#include "vpe/base/nice_ticks.h"

namespace vpe::base {

namespace {

template <class Number>
std::optional<Number> parse(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  Number value{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || rest != end) return std::nullopt;
  return value;
}

// The longest plain number has 309 digits before the point; callers ask for a few behind it.
constexpr int kMostDecimals = 100;

std::string print(double value, std::chars_format format, int precision) {
  std::array<char, 512> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value, format,
                                    precision < 0               ? 0
                                    : precision > kMostDecimals ? kMostDecimals
                                                                : precision);
  return {text.data(), result.ptr};
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const std::optional<double> value = parse<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::int64_t> parse_integer(std::string_view text) { return parse<std::int64_t>(text); }

std::string format_number(double value) {
  std::array<char, 64> text;
  const double size = std::abs(value);
  const bool plain = size == 0.0 || (size >= 1e-6 && size < 1e16);
  const auto result =
      plain ? std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed)
            : std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string format_shortest(double value) {
  std::array<char, 64> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string format_fixed(double value, int decimals) {
  return print(value, std::chars_format::fixed, decimals);
}

std::string format_general(double value, int digits) {
  return print(value, std::chars_format::general, digits);
}

std::string format_rounded(double value, int decimals) {
  const double unit = power_of_ten(decimals);
  return format_number(std::round(value * unit) / unit);
}

std::string format_significant(double value, int digits) {
  const auto rounded = parse_number(print(value, std::chars_format::scientific, digits - 1));
  return format_number(rounded.value_or(value));
}

std::string format_display(double value, int decimals) {
  constexpr double kMostPlain = 1e15;
  const bool is_plain = std::abs(value) < kMostPlain;
  std::string text =
      print(value, is_plain ? std::chars_format::fixed : std::chars_format::scientific, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.starts_with('-') ? text.substr(1) : text;
}

}  // namespace vpe::base
