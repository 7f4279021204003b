// Finds the lattice that a place on the planet lies over.
#pragma once

#include "lod/tree.h"
#include "vpe/voxel/columns.h"
#include "vpe/voxel/lattice_store.h"
#include "vpe/voxel/refine.h"

namespace vpe::voxel {

// For one thread.
class FacetFinder : public FacetSource {
 public:
  FacetFinder(const lod::TileTree& tree, const ColumnEye& eye, LatticeShelf& shelf)
      : tree_(tree), eye_(eye), shelf_(shelf) {}

  const Facets& at(const glm::dvec3& place_m) override;

 private:
  const lod::TileTree& tree_;
  const ColumnEye& eye_;
  LatticeShelf& shelf_;
  Facets facets_;
  bool found_ = false;
};

}  // namespace vpe::voxel
