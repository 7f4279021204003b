// Numbers for people: so many digits behind the point, in every locale.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

namespace vpe::explore {

// "-12.50"; a value that rounds to nothing has no sign. Numbers beyond 1e15 get an exponent, what is not finite
// its name.
inline std::string fixed_text(double value, int digits) {
  std::array<char, 64> text{};
  const bool plain = std::abs(value) < 1e15;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value,
                                    plain ? std::chars_format::fixed : std::chars_format::scientific, digits);
  const std::string_view all(text.data(), static_cast<std::size_t>(result.ptr - text.data()));
  return std::string(
      all.find_first_not_of("-0.") == std::string_view::npos && all.starts_with('-') ? all.substr(1) : all);
}

}  // namespace vpe::explore
