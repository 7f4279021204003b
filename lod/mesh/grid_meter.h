// Measures the distance of a tile's own posts, drawn as a grid, to the reference surface.
#pragma once

#include <memory>

#include "lod/mesh/error_meter.h"

namespace lod {

// Gives the same terms as ErrorMeter for the full grid over a tile's own posts, in a fraction of its time.
//
// Both surfaces have edges along grid lines, and the lines of the coarse grid are lines of the fine one. Hence
// a piece of their overlay has its vertices at posts of the reference surface S, except where a coarse diagonal
// crosses an edge of S. One of that edge's two ends is within half the edge of the diagonal; for this post the
// coarse facet on the other side, continued as a plane, counts too. It bounds the difference at the crossing,
// because differences of planes are affine along the edge.
//
// Immutable after construction: any number of threads may measure.
class GridMeter {
 public:
  GridMeter(const Posts& posts, double radius_m);
  ~GridMeter();
  GridMeter(GridMeter&&) noexcept;
  GridMeter& operator=(GridMeter&&) noexcept;

  // Returns the error over one finest tile. `fine` must be the tile itself or one below it, with as many
  // intervals and the same planet radius, else throws std::invalid_argument.
  ErrorTerms measure(const FinePosts& fine) const;

  // Returns the same to the bit, but visits all posts, also those in rows that cannot have the largest distance
  // (grid_kernel.h). For tests and benchmarks.
  ErrorTerms measure_all(const FinePosts& fine) const;

 private:
  ErrorTerms measure(const FinePosts& fine, bool all) const;
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

}  // namespace lod
