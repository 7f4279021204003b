// Says from where the heights of places in scene files count.
#pragma once

#include <cstdint>

namespace objects {

enum class HeightKind : std::uint8_t {
  kAboveGround,
  kAltitude,  // above the planet's sphere
};

}  // namespace objects
