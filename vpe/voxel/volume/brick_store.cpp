#include "vpe/voxel/volume/brick_store.h"

#include <algorithm>
#include <utility>

#include "vpe/base/parallel.h"
#include "vpe/voxel/volume/brick.h"
#include "vpe/voxel/volume/brick_plan.h"

namespace vpe::voxel {

BrickStore::Bricks BrickStore::get(const std::shared_ptr<const core::GroundParts>& parts, double exaggeration,
                                   const BandSpec& band, double radius_m, const GroundHeight& ground_m) const {
  if (!parts || parts->empty()) return {};
  const std::lock_guard lock(mutex_);
  const auto known = std::ranges::find_if(sets_, [&](const Set& set) {
    return set.parts == parts && set.exaggeration == exaggeration && set.band == band;
  });
  if (known != sets_.end()) {
    sets_.splice(sets_.begin(), sets_, known);
    return known->bricks;
  }
  Set set{parts, exaggeration, band, {}};
  // A pool of its own: that of the caller may be stopped, or busy with what waits for these bricks.
  base::ThreadPool pool(0);
  for (const BrickPlan& plan : plan_bricks(*parts, radius_m)) {
    const core::SolidsAt solids = solids_of(*parts, plan, ground_m);
    GridVolume brick =
        make_brick(plan.face, plan.frame, radius_m, solids, {.threshold = band.threshold}, &pool);
    brick.deviation_m = kBrickDeviation_voxels * brick.voxel_m;
    brick.boundary_deviation_m = kBrickCellDeviation_voxels * brick.voxel_m;
    set.bricks.push_back(std::make_shared<const GridVolume>(std::move(brick)));
  }
  sets_.push_front(std::move(set));
  if (sets_.size() > kMostSets) sets_.pop_back();
  return sets_.front().bricks;
}

void BrickStore::clear() {
  const std::lock_guard lock(mutex_);
  sets_.clear();
}

std::size_t BrickStore::bytes_resident() const {
  const std::lock_guard lock(mutex_);
  std::size_t sum = 0;
  for (const Set& set : sets_)
    for (const auto& brick : set.bricks) sum += brick->bytes();
  return sum;
}

}  // namespace vpe::voxel
