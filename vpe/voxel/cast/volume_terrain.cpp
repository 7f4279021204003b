#include "vpe/voxel/cast/volume_terrain.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>

#include "vpe/voxel/cast/band_caster.h"
#include "vpe/voxel/cast/tile_fallbacks.h"

namespace vpe::voxel {

namespace {

// Rays to the sun start so many voxels away from the surface, for its steps would hide it.
constexpr double kSunStart_voxels = 1.5;
// Nearer to the ground than this, a hit is on the ground; from a voxel farther on it is on a part.
constexpr double kGroundWithin_voxels = 0.5;
// Densities are shares of cubes along few verticals, so normals are means over so many voxels each way.
constexpr double kNormalAside_voxels = 0.75;
// The light of a part begins so many voxels inside of the border of its brick.
constexpr double kBorder_voxels = 2;

// Measures the ground on one thread.
struct GroundProbe {
  GroundProbe(const ColumnWalk& walk, const GridVolumeStore& volumes, const HeightGridStore& grids,
              TileFallbacks* fallbacks, const VolumeForm& form)
      : tiles(grids, walk.exaggeration(), fallbacks), rays(walk, volumes, tiles, form) {}
  ThreadLocalTiles tiles;
  VolumeRays rays;
};

// Lights single places of an image.
class PartPixels {
 public:
  PartPixels(VolumeRays& rays, const glm::dvec3& sun, double planet_radius_m)
      : rays_(rays), sun_(sun), has_sun_(sun != glm::dvec3(0)), radius_m_(planet_radius_m) {}

  PixelNormal at(const glm::dvec3& place_m) {
    PixelNormal out;
    const GridVolume* const brick = rays_.brick_at(place_m);
    const glm::dvec3 up = glm::normalize(place_m);
    if (brick == nullptr) {
      if (has_sun_ && is_hidden_by_part(place_m)) out.sun = 0, out.sun_share = 1;
      return out;
    }
    const double share = part_share(*brick, place_m);
    const glm::dvec3 normal = share > 0 ? normal_at(*brick, place_m) : glm::dvec3(0);
    if (normal != glm::dvec3(0)) {
      out = {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z),
             static_cast<float>(share)};
    }
    if (!has_sun_) return out;
    const double start_m = kSunStart_voxels * brick->voxel_m;
    if (out.share > 0) {
      out.sun_share = out.share;
      const bool faces_sun = glm::dot(normal, sun_) > 0;
      out.sun = faces_sun && std::isfinite(rays_.cast(place_m + start_m * normal, sun_)) ? 0.0F : 1.0F;
    }
    const glm::dvec3& away = out.share > 0 ? normal : up;
    if (out.share < 1 && is_hidden_by_part(place_m + start_m * away)) out.sun = 0, out.sun_share = 1;
    return out;
  }

 private:
  // Returns how far a place is above or below the ground, in voxels of a brick.
  double from_ground_voxels(const GridVolume& brick, const glm::dvec3& place_m) {
    const double distance_m = glm::length(place_m);
    return std::abs(distance_m - radius_m_ - rays_.ground_height_m(place_m / distance_m)) / brick.voxel_m;
  }

  double part_share(const GridVolume& brick, const glm::dvec3& place_m) {
    const glm::dvec3 at = brick.voxel_of(place_m, radius_m_);
    const double end = brick.frame.intervals;
    const double border = std::min({at.x, at.y, end - at.x, end - at.y}) / kBorder_voxels;
    return std::clamp(border, 0.0, 1.0) *
           std::clamp(from_ground_voxels(brick, place_m) - kGroundWithin_voxels, 0.0, 1.0);
  }

  // Returns the unit vector against which the density grows most about a place; 0 where it does not change.
  glm::dvec3 normal_at(const GridVolume& brick, const glm::dvec3& place_m) const {
    glm::dvec3 normal(0);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 aside((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                             (corner & 4) != 0 ? 1 : -1);
      const glm::dvec3 middle_m = place_m + kNormalAside_voxels * brick.voxel_m * aside;
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 way_m(0);
        way_m[axis] = brick.voxel_m;
        normal[axis] += brick.voxels.density(brick.voxel_of(middle_m - way_m, radius_m_)) -
                        brick.voxels.density(brick.voxel_of(middle_m + way_m, radius_m_));
      }
    }
    const double length = glm::length(normal);
    return length > 0 ? normal / length : glm::dvec3(0);
  }

  // The ground in a brick hides nothing that the posts do not hide.
  bool is_hidden_by_part(const glm::dvec3& from_m) {
    const double range_m = rays_.cast_bricks(from_m, sun_);
    // Beside the foot of a part the way up ends in it.
    if (!std::isfinite(range_m) || !(range_m > 0)) return false;
    const glm::dvec3 place_m = from_m + range_m * sun_;
    const GridVolume* const brick = rays_.brick_at(place_m);
    return brick != nullptr && from_ground_voxels(*brick, place_m) > kGroundWithin_voxels + 0.5;
  }

  VolumeRays& rays_;
  glm::dvec3 sun_;
  bool has_sun_;
  double radius_m_;
};

}  // namespace

std::optional<ColumnWalk> VolumeTerrain::walk(const glm::dvec3& camera_m, double exaggeration, double focal_px,
                                              TileFallbacks* fallbacks) const {
  const double distance_m = glm::length(camera_m);
  if (!(distance_m > 0)) return std::nullopt;
  // Where the ground is below the camera decides nothing for volumes.
  const ColumnCamera camera{camera_m / distance_m, distance_m, surface_.planet_radius_m(), 0.5 * distance_m};
  std::optional<ColumnWalk> made;
  made.emplace(surface_, camera, exaggeration, CellRule{0, focal_px}, fallbacks);
  return made;
}

VolumeForm VolumeTerrain::with_bricks(const VolumeCast& what) const {
  VolumeForm form = what.form;
  if (!form.parts) return form;
  const double radius_m = surface_.planet_radius_m();
  TileFallbacks fallbacks(grids_, what.exaggeration, ReadingRule::always());
  const std::optional<ColumnWalk> any = walk({2 * radius_m, 0, 0}, what.exaggeration, 1, &fallbacks);
  const VolumeForm ground_form{.band = what.form.band};
  base::ObjectPool<GroundProbe> probes(
      [&] { return std::make_unique<GroundProbe>(*any, volumes_, grids_, &fallbacks, ground_form); },
      {.discard_on_exception = true});
  const auto ground_m = [&](const glm::dvec3& up) { return probes.acquire()->rays.ground_height_m(up); };
  const BrickStore::Bricks bricks =
      bricks_.get(form.parts, what.exaggeration, what.form.band, radius_m, ground_m);
  form.bricks.insert(form.bricks.end(), bricks.begin(), bricks.end());
  return form;
}

TileUsage VolumeTerrain::cast(const core::View& view, const VolumeCast& what, const core::SubRectangle& only,
                              base::ThreadPool& pool, std::span<float> range_m,
                              TileFallbacks* fallbacks) const {
  const double focal_px = core::focal_px(view);
  const std::optional<ColumnWalk> tiles = walk(view.camera.position_m, what.exaggeration, focal_px, fallbacks);
  if (!tiles) {
    std::ranges::fill(range_m, 0.0F);
    return {};
  }
  if (fallbacks != nullptr && fallbacks->purpose() == TileFallbacks::Purpose::kImage)
    fallbacks->require(tiles->below_camera());
  ScratchPool scratches = make_scratch_pool(grids_, what.exaggeration, fallbacks);
  const VolumesSeen found =
      cast_volumes(view, *tiles, volumes_, with_bricks(what), scratches, pool, only, range_m);
  TileUsage usage = tiles->usage();
  add_deviations(found, focal_px, tiles->tree(), usage);
  return usage;
}

bool VolumeTerrain::is_ground(const glm::dvec3& place_m, const VolumeCast& what) const {
  TileFallbacks fallbacks(grids_, what.exaggeration, ReadingRule::always());
  const std::optional<ColumnWalk> tiles_here = walk(place_m, what.exaggeration, 1, &fallbacks);
  if (!tiles_here) return true;
  const VolumeForm form = with_bricks(what);
  ThreadLocalTiles tiles(grids_, what.exaggeration, &fallbacks);
  return VolumeRays(*tiles_here, volumes_, tiles, form).is_ground(place_m);
}

bool VolumeTerrain::light(const core::View& view, const VolumeCast& what, const PartLight& light,
                          base::ThreadPool& pool, std::span<const float> range_m, std::span<PixelNormal> out,
                          TileFallbacks* fallbacks) const {
  const VolumeForm form = with_bricks(what);
  if (form.bricks.empty()) return false;
  const glm::dvec3& camera_m = view.camera.position_m;
  const std::optional<ColumnWalk> tiles = walk(camera_m, what.exaggeration, core::focal_px(view), fallbacks);
  if (!tiles) return false;
  ScratchPool scratches = make_scratch_pool(grids_, what.exaggeration, fallbacks);
  const core::SubRectangle part = core::drawn_part(view);
  const auto width = static_cast<std::size_t>(part.width);
  std::atomic<bool> has_any{false};
  pool.run(static_cast<std::size_t>(part.height), [&](std::size_t row) {
    const ScratchPool::Lease scratch = scratches.acquire();
    VolumeRays rays(*tiles, volumes_, scratch->tiles, form);
    PartPixels pixels(rays, light.sun, surface_.planet_radius_m());
    bool row_has_any = false;
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t n = row * width + x;
      out[n] = {};
      const auto distance_m = static_cast<double>(range_m[n]);
      if ((!light.wanted.empty() && light.wanted[n] == 0) || !std::isfinite(distance_m) || !(distance_m > 0))
        continue;
      const glm::dvec3 ray =
          core::pixel_ray(view, part.x + static_cast<double>(x) + 0.5, part.y + static_cast<double>(row) + 0.5);
      out[n] = pixels.at(camera_m + distance_m * ray);
      row_has_any = row_has_any || out[n].share > 0 || out[n].sun_share > 0;
    }
    if (row_has_any) has_any = true;
  });
  return has_any;
}

}  // namespace vpe::voxel
