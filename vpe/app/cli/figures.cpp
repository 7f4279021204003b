#include "vpe/app/cli/figures.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "vpe/base/number.h"

namespace vpe::app {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Returns true for characters of names and of numbers, next to which a number is a part of a word.
bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '/';
}

// Returns the end of the digits and points that begin at `at`.
std::size_t end_of_number(std::string_view text, std::size_t at) {
  while (at < text.size() &&
         (is_digit(text[at]) || (text[at] == '.' && at + 1 < text.size() && is_digit(text[at + 1]))))
    ++at;
  return at;
}

// Returns the number with fewer digits, if it has many.
std::string shortened(std::string_view number) {
  constexpr std::ptrdiff_t kMostDigits = 5;
  constexpr int kDigits = 4;
  const auto value = base::parse_number(number);
  if (!value || number.find('.') == std::string_view::npos) return std::string(number);
  const auto first = std::find_if(number.begin(), number.end(), [](char c) { return c >= '1' && c <= '9'; });
  if (std::count_if(first, number.end(), is_digit) <= kMostDigits) return std::string(number);
  return base::format_significant(*value, kDigits);
}

}  // namespace

std::string length_text(double metres, int digits) {
  constexpr double kLeastInKilometres_m = 10000;
  const bool is_long = std::abs(metres) >= kLeastInKilometres_m;
  return base::format_significant(is_long ? 1e-3 * metres : metres, digits) + (is_long ? " km" : " m");
}

std::string bytes_text(double bytes) {
  constexpr int kDigits = 3;
  const bool is_large = bytes >= 999.5e6;
  return base::format_significant(bytes * (is_large ? 1e-9 : 1e-6), kDigits) + (is_large ? " GB" : " MB");
}

std::string with_short_numbers(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const bool begins = is_digit(text[at]) && (at == 0 || !is_word(text[at - 1]));
    const std::size_t end = begins ? end_of_number(text, at) : at + 1;
    const std::string part = text.substr(at, end - at);
    out += begins && (end == text.size() || !is_word(text[end])) ? shortened(part) : part;
    at = end;
  }
  return out;
}

}  // namespace vpe::app
