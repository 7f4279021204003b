// Numbers of pages that show a choice of image layers over patched ground (PlanetFile::version()): the number of the choice in the
// high bits, that of the ground in the low ones.
#pragma once

#include <algorithm>
#include <cstdint>

namespace paging {

// A process does not open or patch so many planets.
inline constexpr unsigned kGroundVersionBits = 32;

// Returns a number of a page with the newer one of its ground and another ground.
inline std::uint64_t with_ground_version(std::uint64_t version, std::uint64_t ground) {
  constexpr std::uint64_t kGround = (std::uint64_t{1} << kGroundVersionBits) - 1;
  return (version & ~kGround) | std::max(version & kGround, ground);
}

}  // namespace paging
