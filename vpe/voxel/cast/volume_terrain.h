// The terrain of a planet as volumes, with the parts of its ground: images, single places, light on the parts.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): RangeCaster hands requests of rays.mode=volume and boundary to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "paging/surface/surface.h"
#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/cast/height_grid_store.h"
#include "vpe/voxel/cast/pixel_normal.h"
#include "vpe/voxel/cast/volume_form.h"
#include "vpe/voxel/volume/brick_store.h"
#include "vpe/voxel/volume/grid_volume_store.h"

namespace vpe::voxel {

// Names what is cast.
struct VolumeCast {
  double exaggeration = 1;
  VolumeForm form = {};
};

// Says how an image is lit, and which of its pixels are wanted.
struct PartLight {
  glm::dvec3 sun{0, 0, 0};                    // unit, body-fixed; 0: no shadows
  std::span<const std::uint8_t> wanted = {};  // an entry for each pixel, 0: not wanted; empty: all are
};

// Any thread may call any const member.
class VolumeTerrain {
 public:
  // `surface` and `grids` must outlive this. `budget_bytes` is that of GridVolumeStore; bricks are not counted.
  VolumeTerrain(const paging::Surface& surface, const HeightGridStore& grids, std::size_t budget_bytes)
      : surface_(surface), grids_(grids), volumes_(budget_bytes) {}

  // Writes the ranges of a view's drawn part, or of `only` in it, and returns the usage of tiles with the errors of volumes and
  // bricks. 0 for a camera in the ground. Throws what cast_volumes() and BrickStore::get() throw.
  TileUsage cast(const core::View& view, const VolumeCast& what, const core::SubRectangle& only,
                 base::ThreadPool& pool, std::span<float> range_m, TileFallbacks* fallbacks) const;

  // Returns true if a point is in the ground. Reads the tile there, or the nearest ancestor that can be read. Throws
  // paging::PlanetError where not even a root can be, and what BrickStore::get() throws.
  bool is_ground(const glm::dvec3& place_m, const VolumeCast& what) const;

  // Writes how parts of the ground are lit in an image of these ranges: normals of their densities, and where they hide the sun or
  // it is hidden from them. Elsewhere the shares are 0. Returns false, and writes nothing, if nothing of it is in the image. Hits
  // within about a voxel of the ground count as ground. Reads tiles as cast() does. Sizes are those of the drawn part.
  bool light(const core::View& view, const VolumeCast& what, const PartLight& light, base::ThreadPool& pool,
             std::span<const float> range_m, std::span<PixelNormal> out, TileFallbacks* fallbacks) const;

  // Drops the bricks, since the ground has changed.
  void forget() { bricks_.clear(); }
  std::size_t bytes_resident() const { return volumes_.bytes_resident() + bricks_.bytes_resident(); }

 private:
  VolumeForm with_bricks(const VolumeCast& what) const;
  // Returns the walk of a camera; nullopt at the planet's centre.
  std::optional<ColumnWalk> walk(const glm::dvec3& camera_m, double exaggeration, double focal_px,
                                 TileFallbacks* fallbacks) const;

  const paging::Surface& surface_;
  const HeightGridStore& grids_;
  GridVolumeStore volumes_;
  BrickStore bricks_;
};

}  // namespace vpe::voxel
