// Finds the lattice that a place on the planet lies over.
#pragma once

#include "vpe/voxel/cast/column_walk.h"
#include "vpe/voxel/cast/height_grid_store.h"
#include "vpe/voxel/cast/refine.h"

namespace vpe::voxel {

// For one thread.
class FacetFinder : public FacetSource {
 public:
  // Lattices that the walk casts.
  FacetFinder(const ColumnWalk& walk, ThreadLocalTiles& tiles) : walk_(walk), tiles_(tiles) {}

  const Facets& at(const glm::dvec3& place_m) override;

 private:
  const ColumnWalk& walk_;
  ThreadLocalTiles& tiles_;
  Facets facets_;
  bool found_ = false;
};

}  // namespace vpe::voxel
