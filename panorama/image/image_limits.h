// The largest size of panorama images.
#pragma once

#include <cstdint>

namespace panorama {

inline constexpr std::int64_t kMaxSide_px = 1'000'000;

}  // namespace panorama
