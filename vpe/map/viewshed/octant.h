// One eighth of the posts round an observer, swept by fans of rays.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "vpe/map/viewshed/viewshed.h"

namespace vpe::map {

// Holds rises in memory that is left as it is found, for posts that threads fill themselves.
using RiseGrid = std::unique_ptr<float[]>;

// Describes an eighth. Rings count from the observer along one axis of the grid, posts of a ring from that axis.
struct Octant {
  const float* rises_m = nullptr;    // of the observer's post, in a grid of rises
  const float* targets_m = nullptr;  // of the same post: rises of targets
  std::ptrdiff_t ring_step = 0;      // from ring to ring in those grids
  std::ptrdiff_t post_step = 0;      // from post to post
  int rings = 0;
  int last_post = 0;                 // of the grid, from the axis
  bool has_axis = false;             // else the eighth beside it has its posts
  bool has_diagonal = false;         // likewise
  std::ptrdiff_t out_ring_step = 0;  // in the grid of results
  std::ptrdiff_t out_post_step = 0;
};

// Points to the observer's post in grids of results. One of both is null.
struct OctantResults {
  Sight* sights = nullptr;
  // Rises that targets need: kNoRise where the target is seen.
  float* needed_m = nullptr;
};

// Describes a fan: rays first to last of those that divide an octant. Ray n crosses ring k at post k n / division.
struct FanRays {
  int division = 1;
  int first = 0;
  int last = 0;
};

// Returns fans that together cover the octant.
std::vector<FanRays> divide(const Octant& octant);

// Writes the results of the posts of the octant from the fan's first ray to its last one, without those on the last one
// unless it is the octant's last. Fans may be swept at once.
void sweep(const Octant& octant, const FanRays& rays, const OctantResults& results);

}  // namespace vpe::map
