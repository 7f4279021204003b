// Keeps the bricks of the parts of a planet's ground, for all threads that cast.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): beside GridVolumeStore, under the caster of volumes (band_caster.h).
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "vpe/core/ground_parts.h"
#include "vpe/voxel/volume/band_volume.h"
#include "vpe/voxel/volume/grid_volume.h"

namespace vpe::voxel {

// Bound how far the surface of a brick is from what it is made of, but for parts thinner than a voxel (brick.h); and any point of
// its boundary cells, each of which a surface passes through or is beside.
inline constexpr double kBrickDeviation_voxels = 1;
inline constexpr double kBrickCellDeviation_voxels = 3;

// Any thread may call any member.
class BrickStore {
 public:
  using Bricks = std::vector<std::shared_ptr<const GridVolume>>;
  using GroundHeight = std::function<double(const glm::dvec3& up)>;

  // The sets of bricks that are kept at once: those of the parts that were asked for last.
  static constexpr std::size_t kMostSets = 2;

  // Returns the bricks of parts with the deviations above, which stand in the ground of an exaggeration as a band shows it: ground_m() returns its height
  // above the sphere, and may be called by several threads. Makes them when they are new. `parts` may be null: no bricks. Throws
  // what plan_bricks() and make_brick() throw, and what the parts and ground_m() throw.
  Bricks get(const std::shared_ptr<const core::GroundParts>& parts, double exaggeration, const BandSpec& band,
             double radius_m, const GroundHeight& ground_m) const;

  // Drops all bricks, since the ground has changed.
  void clear();

  std::size_t bytes_resident() const;

 private:
  struct Set {
    std::shared_ptr<const core::GroundParts> parts;
    double exaggeration = 1;
    BandSpec band;
    Bricks bricks;
  };

  mutable std::mutex mutex_;
  mutable std::list<Set> sets_;  // the last used one first
};

}  // namespace vpe::voxel
