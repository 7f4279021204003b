// Finds the height grid over or under a point.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): the link between refinement (refine.h), or the fixed-step
// marcher, and the tiles that the column walk casts.
#pragma once

#include <cstddef>
#include <vector>

#include "vpe/voxel/cast/column_walk.h"
#include "vpe/voxel/cast/height_grid_store.h"
#include "vpe/voxel/columns/refine.h"

namespace vpe::voxel {

// Returns the height grids that `walk` casts, so that refined pixels and columns see the same facets. For one
// thread.
class FacetFinder : public FacetSource {
 public:
  // `walk` and `tiles` must outlive this.
  FacetFinder(const ColumnWalk& walk, ThreadLocalTiles& tiles) : walk_(walk), tiles_(tiles) {}

  // Throws paging::PlanetError for tiles that cannot be read.
  const Facets& at(const glm::dvec3& place_m) override;

 private:
  // Holds a height grid and its place in the chart.
  struct Found {
    Facets facets;
    HeightGridStore::Pointer<float> held;  // of `facets`, as is the next
    HeightGridStore::Pointer<double> exact_held;
    double u0 = 1;  // empty: holds no place
    double u1 = -1;
    double v0 = 1;
    double v1 = -1;

    bool holds(const mars::ChartPoint& place) const;
  };
  // Grids that neighbouring rows of pixels cross again and again.
  static constexpr std::size_t kKept = 16;

  void find(const mars::ChartPoint& place, Found& found);

  const ColumnWalk& walk_;
  ThreadLocalTiles& tiles_;
  std::vector<Found> found_;  // at most kKept
  std::size_t last_ = 0;      // that was asked for
  std::size_t oldest_ = 0;
};

}  // namespace vpe::voxel
