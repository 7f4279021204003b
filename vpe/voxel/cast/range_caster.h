// Casts range images of the reference surface.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): the first one. RangeCaster chooses among three ways to
// cast: vertical columns for panoramas of a level camera (ColumnBatch), columns and refinement for perspective images
// (SectorCaster) and panoramas of a tilted camera (cast_by_fan()), and single rays for all else (paging::Surface::cast).
// ImagePainter colours the result.
//
// Typical usage:
//   RangeCaster caster(planet, memory_bytes);
//   base::ThreadPool pool(0);
//   const glm::ivec2 size = core::drawn_size(view);
//   std::vector<float> range_m(std::size_t(size.x) * std::size_t(size.y));
//   caster.cast(view, {.cell_px = 1}, pool, range_m);
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "lod/control.h"
#include "paging/planet/planet_file.h"
#include "paging/surface/surface.h"
#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/discrete_caster.h"
#include "vpe/voxel/cast/height_grid_store.h"
#include "vpe/voxel/cast/sector_caster.h"
#include "vpe/voxel/cast/volume_terrain.h"

namespace vpe::voxel {

struct RangeOptions {
  double exaggeration = 1;
  // Bound of the geometric error in the image (CellRule in column_walk.h). Smaller: closer to the reference
  // surface, slower; larger: coarser tiles, faster. 0: the reference surface itself.
  double cell_px = 0;
  enum class Method {
    kColumns,     // columns and sectors where the view allows it
    kSingleRays,  // every ray by itself, down the maximum pyramids; ignores cell_px
    kReference,   // every ray by itself in fixed steps (fixed_step_marcher.h)
    kDiscrete,    // columns of voxels (discrete_caster.h), at most cell_px wide
    kVolume,      // terrain volumes of the finest tiles (volume_terrain.h); ignores cell_px
  };
  // kColumns is by far the fastest. The others are checks, and the baseline of measurements
  // (docs/measurements/rays.md).
  Method method = Method::kColumns;
  lod::LevelControl control = {};  // acts unless cell_px is 0
  // The pixels of the full image whose ranges are wanted; width 0: all of the drawn part. In perspective by columns
  // the others cost nothing and are not written, but for some beside it (SectorCaster); elsewhere all are cast.
  core::SubRectangle only = {};
  DiscreteForm discrete = {};  // with kDiscrete alone
  VolumeForm volume = {};      // with kVolume alone
  SectorForm sectors = {};     // with kColumns alone, in perspective
  bool operator==(const RangeOptions&) const = default;
};

// Returns true if the columns of a view are lines of its image: perspective views, and round ones of a level camera.
bool casts_by_columns(const core::View& view);

class RangeCaster {
 public:
  // A quarter of the budget goes to single rays (paging::Surface), the rest to height grids. From the first image of volumes on
  // these have half of the rest.
  RangeCaster(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes);

  // Writes the ranges of the view's drawn part (with kDiscrete, discrete.rays rows for each row of pixels), row by row from the top: metres from the camera to the
  // reference surface as exaggerated, infinite for the sky, 0 for a camera below the surface. Columns serve
  // perspective views, and cylindrical and equirectangular ones whose camera is level, and fans of columns most of
  // those whose camera is tilted (fan_caster.h); other views get a ray for each pixel. kDiscrete throws std::invalid_argument for these (see casts_by_columns()).
  //
  // kVolume casts in any projection. Its usage includes how far volumes are from the reference surface.
  //
  // With cell_px 0 ranges are those of paging::Surface::cast() but for rounding: the relative error is below
  // range_error(view) / sine of incidence. They do not depend on the number of threads or on earlier casts. With
  // sectors.is_nearest that holds for a ray up to sectors.distance_px() from the pixel's centre.
  //
  // Returns the tiles that columns used, the bound of their error and their steepest slope; for single rays the
  // steepest slope of the planet alone. Throws
  // paging::PlanetError for tiles that cannot be read.
  //
  // With fallbacks, coarser tiles take the place of tiles that are not there (tile_fallbacks.h), the usage's
  // bounds hold for what was cast, and paging::PlanetError is thrown only where not even a root can be read.
  // Without any absent tile the ranges are those without fallbacks, to the bit.
  //
  // A cast uses the memory of a SectorCaster: one thread at a time may call it for each of them. Without one,
  // the caster's own serves, for one thread at a time.
  ColumnWalk::Usage cast(const core::View& view, const RangeOptions& options, base::ThreadPool& pool,
                         std::span<float> range_m, TileFallbacks* fallbacks = nullptr) {
    return cast(view, options, pool, range_m, sectors_, fallbacks);
  }
  ColumnWalk::Usage cast(const core::View& view, const RangeOptions& options, base::ThreadPool& pool,
                         std::span<float> range_m, SectorCaster& sectors,
                         TileFallbacks* fallbacks = nullptr) const;
  static constexpr double kRangeError = 1e-6;
  // Error in fields of view wider than kWide_deg, whose lowest rows look almost straight down, and of ground
  // whose exaggerated height range is more than a tenth of the radius.
  static constexpr double kWideRangeError = 5e-6;
  static constexpr double kWide_deg = 150;
  // Returns the error for ground whose height range is at most a tenth of the radius.
  static double range_error(const core::View& view) {
    return view.fov_deg > kWide_deg ? kWideRangeError : kRangeError;
  }
  // Returns the error for the planet's own ground.
  double range_error(const core::View& view, double exaggeration) const;

  // Returns true if a point is in the ground that kVolume casts. Reads the tile there, or the nearest ancestor that can be
  // read. Throws paging::PlanetError where not even a root can be.
  bool is_in_volume(const glm::dvec3& place_m, const RangeOptions& options) const;

  // Writes how parts of the ground are lit in an image of these options, which must be of kVolume (VolumeTerrain::light()).
  bool light_parts(const core::View& view, const RangeOptions& options, const PartLight& light,
                   base::ThreadPool& pool, std::span<const float> range_m, std::span<PixelNormal> out,
                   TileFallbacks* fallbacks) const;

  // Goes over to another version of the planet, as paging::PlanetUser::change_planet(). No other member may run
  // meanwhile.
  void change_planet(const std::shared_ptr<const paging::PlanetFile>& planet) {
    surface_.change_planet(planet);
    store_.change_planet(planet);
    volumes_.forget();
  }

  const paging::Surface& surface() const { return surface_; }
  const HeightGridStore& store() const { return store_; }
  std::size_t bytes_resident() const {
    return surface_.bytes_resident() + store_.bytes_resident() + volumes_.bytes_resident() + sectors_.bytes();
  }

 private:
  void make_room_for_volumes() const;
  // Returns the radius of the ground below the camera, or of what lies no higher if nothing may be read.
  double ground_radius_m(const glm::dvec3& up, double exaggeration, const TileFallbacks* fallbacks) const;
  void cast_upright(const core::View& view, const ColumnWalk& walk, int rays, ScratchPool& scratches,
                    base::ThreadPool& pool, std::span<float> range_m) const;
  void cast_single_rays(const core::View& view, const SingleRays& single_rays, const ColumnWalk* walk,
                        ScratchPool& scratches, base::ThreadPool& pool, std::span<float> range_m) const;

  paging::Surface surface_;
  HeightGridStore store_;
  VolumeTerrain volumes_;
  mutable std::once_flag has_volumes_;
  SectorCaster sectors_;
};

}  // namespace vpe::voxel
