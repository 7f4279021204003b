#include "vpe/voxel/cast/band_caster.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <stdexcept>

namespace vpe::voxel {

namespace {

constexpr double kNoMeeting = std::numeric_limits<double>::infinity();

void add_seen(const VolumeTile& seen, VolumeTile& sum) {
  sum.deviation_m = std::max(sum.deviation_m, seen.deviation_m);
  sum.nearest_m = std::min(sum.nearest_m, seen.nearest_m);
}

}  // namespace

VolumesSeen cast_volumes(const core::View& view, const ColumnWalk& walk, const GridVolumeStore& store,
                         const VolumeForm& form, ScratchPool& scratches, base::ThreadPool& pool,
                         const core::SubRectangle& only, std::span<float> range_m) {
  if (!(form.interval >= 0.01 && form.interval <= 10))
    throw std::invalid_argument("casting of volumes: expected an interval of 0.01 to 10 voxels");
  if (!(form.near_m >= 0)) throw std::invalid_argument("casting of volumes: expected a distance of at least 0");
  const core::SubRectangle part = core::drawn_part(view);
  const core::SubRectangle wanted = only.width > 0 ? only : part;
  VolumesSeen all;
  std::mutex mutex;
  pool.run(static_cast<std::size_t>(wanted.height), [&](std::size_t row) {
    const ScratchPool::Lease scratch = scratches.acquire();
    VolumeRays rays(walk, store, scratch->tiles, form);
    const int y = wanted.y + static_cast<int>(row);
    float* const out =
        range_m.data() + static_cast<std::size_t>(y - part.y) * static_cast<std::size_t>(part.width);
    for (int x = wanted.x; x < wanted.x + wanted.width; ++x) {
      const glm::dvec3 ray = core::pixel_ray(view, x + 0.5, y + 0.5);
      out[x - part.x] = static_cast<float>(rays.cast(view.camera.position_m, ray));
    }
    const std::lock_guard lock(mutex);
    for (const auto& [tile, seen] : rays.seen()) add_seen(seen, all.tiles[tile]);
    add_seen(rays.seen_bricks(), all.bricks);
  });
  return all;
}

void add_deviations(const VolumesSeen& found, double focal_px, const lod::TileTree& tree, TileUsage& usage) {
  for (TileUse& use : usage.tiles) {
    const auto tile = found.tiles.find(use.tile);
    if (tile == found.tiles.end()) continue;
    const VolumeTile& seen = tile->second;
    use.geometric_error_m += seen.deviation_m;
    if (!(seen.nearest_m < kNoMeeting)) continue;
    const double clear_m = std::max(seen.nearest_m - seen.deviation_m, use.min_distance_m);
    use.screen_space_error_px += seen.deviation_m * focal_px / std::max(clear_m, 0.0);
  }
  update_totals(tree, usage);
  usage.geometric_error_m = std::max(usage.geometric_error_m, found.bricks.deviation_m);
  if (!(found.bricks.nearest_m < kNoMeeting)) return;
  const double clear_m = std::max(found.bricks.nearest_m - found.bricks.deviation_m, 0.0);
  usage.screen_space_error_px =
      std::max(usage.screen_space_error_px, found.bricks.deviation_m * focal_px / clear_m);
}

}  // namespace vpe::voxel
