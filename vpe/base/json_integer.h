// Reads whole numbers of JSON. The library converts any number to a whole one, also one that does not fit: that is
// undefined for 1e300, and 2.5 becomes 2.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>

namespace vpe::base {

// Returns the value if it is a whole number within the range of T. Throws nlohmann::json::type_error (302) otherwise.
template <class T, class Json>
T json_integer(const Json& value) {
  static_assert(std::is_integral_v<T> && !std::is_same_v<T, bool>);
  const bool fits = value.is_number_unsigned()  ? std::in_range<T>(value.template get<std::uint64_t>())
                    : value.is_number_integer() ? std::in_range<T>(value.template get<std::int64_t>())
                                                : false;
  if (!fits)
    throw nlohmann::json::type_error::create(302, "a whole number is expected, found " + value.dump(), &value);
  return value.template get<T>();
}

}  // namespace vpe::base
