// The size that panorama images may have.
#pragma once

#include <cstdint>

namespace panorama {

// Pixels along a side.
inline constexpr std::int64_t kMaxSide_px = 1'000'000;

}  // namespace panorama
