// The way of a group of columns over the planet: tiles from near to far, without those that cannot be seen.
#pragma once

#include <atomic>
#include <vector>

#include "lod/tree.h"
#include "vpe/voxel/columns.h"
#include "vpe/voxel/lattice_store.h"

namespace vpe::voxel {

// Prepared for one eye and one exaggeration. Threads may share it.
class ColumnWalk {
 public:
  // The eye stands above S: eye.distance_m > eye.ground_m.
  ColumnWalk(const paging::PlanetFile& planet, const ColumnEye& eye, double exaggeration);

  // A group of columns from their azimuth vectors (unit, body-fixed, normal to eye.up), neighbours in order.
  // Rows, fans, and buffers of `group` are set before. Resolves all rows that see ground.
  void cast(const glm::dvec3* azimuth, const Rows& rows, LatticeShelf& shelf, ColumnGroup& group) const;

  const ColumnEye& eye() const { return eye_; }

 private:
  friend class GroupWalk;
  // No ray into the tile is steeper than this many times upward.
  float slope_bound(lod::TileTree::Index tile) const;

  const lod::TileTree& tree_;
  ColumnEye eye_;
  double exaggeration_;
  // Made when first wanted; NaN before. Whoever makes one makes the same.
  mutable std::vector<std::atomic<float>> bounds_;
};

}  // namespace vpe::voxel
