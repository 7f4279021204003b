// A colour of three bytes.
#pragma once

#include <cstdint>

namespace vpe::base {

// Holds red, green and blue, encoded as sRGB.
struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  bool operator==(const Rgb&) const = default;
};

}  // namespace vpe::base
