// How far a tile's own posts, drawn as a grid, are from S.
#pragma once

#include <memory>

#include "lod/mesh/mesh.h"

namespace lod {

// ErrorMeter for the full grid over a tile's own posts: the same terms, for a fraction of its time.
//
// Both surfaces have edges along grid lines, and those of the coarse grid are lines of the fine one. Hence a
// piece of their overlay has its vertices at posts of S, but for those where a coarse diagonal crosses an edge
// of S. Of an edge's two ends one is within half the edge of the diagonal; there the coarse facet on the other
// side, continued as a plane, counts too. It bounds what is at the crossing, as differences of planes are
// affine along the edge. Thread rule: immutable after construction, any number of threads may measure.
class GridMeter {
 public:
  GridMeter(const Posts& posts, double radius_m);
  ~GridMeter();
  GridMeter(GridMeter&&) noexcept;
  GridMeter& operator=(GridMeter&&) noexcept;

  // `fine` is the tile itself or one below it, of as many intervals and the same planet radius; else
  // std::invalid_argument.
  ErrorTerms measure(const FinePosts& fine) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

}  // namespace lod
