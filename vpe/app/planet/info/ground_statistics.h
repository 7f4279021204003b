// Slopes and elevations of a planet, by level: each level of posts is a baseline at which slopes are measured.
//
// Typical usage:
//   base::ThreadPool pool(0);
//   const std::vector<GroundStatistics> levels = ground_statistics(planet, pool);
//   print(levels.front().slopes_deg.percentile(0.5));
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/app/planet/info/distribution.h"
#include "vpe/base/parallel.h"

namespace vpe::app {

// Holds the statistics of the posts of one level. Its cells are the squares between four neighbouring posts. Each counts
// with its area on the sphere; those with a nodata post are left out.
struct GroundStatistics {
  int level = 0;
  double baseline_m = 0;   // distance of neighbouring posts at the middle of a face
  std::int64_t tiles = 0;  // of the level
  std::int64_t sampled_tiles = 0;
  double share_of_planet = 0;  // area of all tiles of the level, of that of the sphere
  Distribution slopes_deg;     // angle between the vertical and the normal of both diagonals of a cell
  Distribution elevations_m;   // means of a cell's four posts
};

// Limits what is read: of a level with more tiles, so many are sampled, evenly along the order of the tree.
inline constexpr std::int64_t kMostSampledTiles = 384;

// Returns the statistics of all levels that have tiles, coarsest first. Reads at most kMostSampledTiles tiles of a level one
// by one, and keeps none. Percentiles of slopes are exact to 0.003 degrees plus 1/8000 of the slope, those of elevations to
// 1/4096 of their range. Does not depend on the number of threads. `tell` gets the share of the work that is done, on the
// calling thread. Throws paging::PlanetError.
std::vector<GroundStatistics> ground_statistics(const paging::PlanetFile& planet, base::ThreadPool& pool,
                                                const std::function<void(double)>& tell = {});

// Returns the index of the finest level whose tiles cover the whole planet. Expects what ground_statistics() returns.
std::size_t finest_whole_level(const std::vector<GroundStatistics>& levels);

}  // namespace vpe::app
