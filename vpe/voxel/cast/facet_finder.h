// Finds the height grid over or under a point.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): the link between refinement (refine.h), or the fixed-step
// marcher, and the tiles that the column walk casts.
#pragma once

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
  const ColumnWalk& walk_;
  ThreadLocalTiles& tiles_;
  Facets facets_;
  HeightGridStore::Pointer<float> held_;  // of facets_, as is the next
  HeightGridStore::Pointer<double> exact_held_;
  bool found_ = false;
};

}  // namespace vpe::voxel
