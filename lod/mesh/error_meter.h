// Measures the distance of a tile's mesh to the reference surface.
#pragma once

#include <memory>
#include <span>

#include "lod/mesh/mesh.h"

namespace lod {

struct FineGrid;

// Holds the reference surface over one finest tile, prepared once to be measured against the meshes of all its
// ancestors. The borders of `posts` must be constrained. Immutable: any number of threads may share it.
class FinePosts {
 public:
  FinePosts(const Posts& posts, double radius_m);
  ~FinePosts();
  FinePosts(FinePosts&&) noexcept;
  FinePosts& operator=(FinePosts&&) noexcept;

 private:
  friend class ErrorMeter;
  friend class GridMeter;
  struct Prepared;
  const FineGrid& grid() const;
  std::unique_ptr<const Prepared> prepared_;
};

// Measures the distance of one mesh to the reference surface S, over the finest tiles below it one at a time.
//
// Over a piece of the overlay of both triangulations (mesh triangle and facet of S) both inverse depths are
// affine, so their difference is largest at a vertex of the piece. All of these are visited: posts, and mesh
// edges where they cross grid lines and diagonals (mesh vertices are posts). The radial distance differs from
// that difference by a factor which varies over one cell by at most kappa, where kappa - 1 is about (cell
// angle) (1 + slopes). The terms are raised by it, which makes them upper bounds: total = kappa max|total|,
// sagitta likewise, and height error = max|height error| + (kappa - 1) (max|total| + max|sagitta|), all at the
// vertices. Rounding adds 3e-15 times the largest radius.
//
// Immutable after construction: any number of threads may measure.
class ErrorMeter {
 public:
  // Throws std::invalid_argument if the number of heights is not that of vertices.
  ErrorMeter(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
             double radius_m);
  ~ErrorMeter();
  ErrorMeter(ErrorMeter&&) noexcept;
  ErrorMeter& operator=(ErrorMeter&&) noexcept;

  // Return the error over one finest tile. `fine` must be the mesh's own tile or one below it, with a grid at
  // least as fine as the mesh's and the same planet radius, else they throw std::invalid_argument. Prepare
  // FinePosts if several meshes are measured over the same tile.
  ErrorTerms measure(const FinePosts& fine) const;
  ErrorTerms measure(const Posts& fine) const;

  // Returns the same to the bit, but visits all pieces, also those that cannot have the largest distance (overlay_cut.h).
  // For tests and benchmarks.
  ErrorTerms measure_all(const FinePosts& fine) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

// Measures one mesh over one finest tile with a temporary ErrorMeter.
ErrorTerms measure_error(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
                         const Posts& fine, double radius_m);

}  // namespace lod
