// Heights of a second planet at the posts of a first one: what colour=difference and measure_change() take differences of.
//
// Typical usage:
//   const PostHeights before = heights_at_posts(Surface(earlier, budget), key, later->meta().tile.intervals());
#pragma once

#include <vector>

#include "paging/surface/surface.h"

namespace paging {

struct PostHeights {
  std::vector<double> height_m;  // row by row, as lod::Posts
  std::vector<bool> nodata;      // empty when every post has data
};

// Returns the heights of the reference surface in the directions of the posts of a tile's grid; the planet need not have
// the tile. Where the planet has it, with as many intervals, these are its own posts, which lie on the reference surface,
// and no finer tile is read. The error is that of Surface::at(). Any thread may call it. Throws PlanetError.
PostHeights heights_at_posts(const Surface& planet, const lod::TileKey& key, int intervals);

}  // namespace paging
