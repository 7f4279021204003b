// Bounds of a mesh's error over blocks of its tile, where one for the whole tile is too coarse.
//
// Typical usage:
//   const BlockErrors errors = block_errors(mesh, heights, posts, {radius_m});
//   const mars::ChartPoint p = mars::chart_on(posts.key.face, place);
//   const double bound_m = errors.largest_m(p.u, p.v, 1e-6);
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lod/mesh/mesh.h"

namespace lod {

// Holds a bound for each of rows x rows blocks.
struct BlockErrors {
  std::vector<double> u;       // lines between blocks in the chart, rows + 1, ascending
  std::vector<double> v;       // likewise
  std::vector<float> bound_m;  // block (i, j) at j * rows + i

  // Returns the largest error of the blocks within `reach` of a chart point along each axis. Blocks at the tile's
  // border count for what lies beyond them.
  double largest_m(double at_u, double at_v, double reach) const;

  std::size_t bytes() const {
    return sizeof(*this) + (u.capacity() + v.capacity()) * sizeof(double) + bound_m.capacity() * sizeof(float);
  }
};

struct BlockErrorOptions {
  double radius_m = 1;
  double exaggeration = 1;
  // Blocks along a side, a power of two, at most the grid's intervals. More: closer bounds, more memory.
  int rows = 32;
};

// Returns upper bounds of the radial distance between a mesh and the surface of flat facets over `posts`, both with
// heights exaggerated, over each block. The grid of the posts must be that of the mesh, else throws
// std::invalid_argument; it does so too for wrong numbers of heights and rows.
//
// Both inverse depths are affine over each piece of the overlay of both triangulations, so their difference is largest at
// a vertex of a piece: at posts, and where edges of the mesh cross grid lines and diagonals. All of them are visited.
BlockErrors block_errors(const TileMesh& mesh, std::span<const double> vertex_height_m, const Posts& posts,
                         const BlockErrorOptions& options);

}  // namespace lod
