// Relief below the resolution of the data, without craters: spurs and gullies on walls, beds of rock, wrinkle ridges,
// valleys, hills and hollows, dunes, and what add_detail() adds near the camera.
//
// It comes in groups by wavelength, since each group is taken to zero at the posts of the data over a distance of its own.
#pragma once

#include "mars/embedded/craters.h"
#include "mars/embedded/detail.h"
#include "mars/embedded/ground.h"
#include "mars/embedded/octaves.h"

namespace mars::embedded {

// Octaves of wavelengths below this spacing are detail: coarser posts show the data alone.
inline constexpr double kCoarsestRelief_m = 2048.0;

inline constexpr int kPinnedGroups = 4;
// Distance from a post over which a group is taken to zero there; the first one's is that to the next post. On walls it
// is three times as long along the fall line.
inline constexpr float kPinnedReach_m[kPinnedGroups] = {0.0F, 1500.0F, 420.0F, 110.0F};

struct Relief {
  // Octaves of 4 km and more, 1 to 2 km, 256 and 512 m, 32 to 128 m; the last is all that is shorter.
  alignas(64) Lane<float> group[kPinnedGroups + 1];
  alignas(
      64) Lane<float> grain;     // fine heights relative to their own size, about -2..2; changes the brightness
  alignas(64) Lane<float> rock;  // 0..1: share of rock that is visible from nearby
  alignas(64) Lane<float> rock_tone;  // -1 dark .. 1 bright
  Sand sand;
};

// Sets the pinned groups, the sand and the grain of `out` from the ground, the octaves of a spacing, and the craters. Of
// the last group it sets what octaves and ripples add.
void lay_relief(const Block& block, double detail_m, const Ground& ground, const Octaves& octaves,
                const CraterSum& craters, Relief& out);

// Adds what posts of kCoarsestDetail_m and less show to the last group, and sets rocks. Call it after lay_relief(), for
// compact blocks only: rocks are searched over the whole extent of the block.
void lay_near_relief(const Block& block, double detail_m, const Ground& ground, const Octaves& octaves,
                     const CraterSum& craters, Relief& out);

}  // namespace mars::embedded
