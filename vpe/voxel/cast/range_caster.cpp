#include "vpe/voxel/cast/range_caster.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/cast/column_walk.h"
#include "vpe/voxel/cast/fan_caster.h"
#include "vpe/voxel/cast/fixed_step_marcher.h"
#include "vpe/voxel/cast/tile_fallbacks.h"

namespace vpe::voxel {

namespace {

constexpr double kSurfaceShare = 0.25;
constexpr double kVolumeShare = 0.375;  // half of what height grids have before

std::size_t bytes_of_share(std::size_t bytes, double share) {
  return static_cast<std::size_t>(share * static_cast<double>(bytes));
}

// Tilt up to which the columns of a cylindrical or equirectangular image count as vertical: below a thousandth
// of a pixel.
constexpr double kLevel = 1e-8;

bool is_level(const core::View& view, const glm::dvec3& up) {
  return glm::length(view.camera.axes.up - up) <= kLevel;
}

// Returns true if the image's columns are vertical half-planes.
bool upright(const core::View& view, const glm::dvec3& up) {
  if (view.projection == core::Projection::kPerspective || !is_level(view, up)) return false;
  if (view.projection == core::Projection::kCylinder) return true;
  // Rows beyond the zenith or the nadir look backward.
  const core::SubRectangle part = core::drawn_part(view);
  const double middle = 0.5 * view.height + view.principal_offset_px.y;
  const double highest = (middle - part.y - 0.5) / core::focal_px(view);
  const double lowest = (middle - part.y - part.height + 0.5) / core::focal_px(view);
  constexpr double kQuarter = 1.5707963267948966;
  return highest < kQuarter && lowest > -kQuarter;
}

// Images larger than this are written past the caches.
constexpr std::size_t kCachedBytes = std::size_t{4} << 20;

// Holds the rows of a cylindrical or equirectangular image, the lowest first, with their tables.
struct ImageRows {
  Rows rows;
  std::vector<double> exact;
  std::vector<float> rounded;
  std::vector<float> length;
};

// Returns the rows of rays, `rays` of them for each row of pixels.
ImageRows image_rows(const core::View& view, const core::SubRectangle& part, int rays) {
  ImageRows p;
  p.rows.count = part.height * rays;
  const auto finish = [&] {
    for (int r = 0; r < p.rows.count; ++r) {
      const double slope =
          p.exact.empty() ? (r - p.rows.centre) * p.rows.step : p.exact[static_cast<std::size_t>(r)];
      p.length.push_back(static_cast<float>(std::hypot(1.0, slope)));
    }
    p.rows.length = p.length.data();
  };
  const double centre_y = 0.5 * view.height + view.principal_offset_px.y;
  // In rows of rays: of row 0, upward from the principal row.
  const double lowest = rays * centre_y - (rays * (part.y + part.height) - 0.5);
  const double focal = rays * core::focal_px(view);
  if (view.projection == core::Projection::kCylinder) {
    p.rows.kind = RowKind::kEven;
    p.rows.centre = -lowest;
    p.rows.step = 1.0 / focal;
    finish();
    return p;
  }
  p.rows.kind = RowKind::kTable;
  p.rows.first_elevation = lowest / focal;
  p.rows.elevation_step = 1.0 / focal;
  // A row that looks straight up or down still has a slope.
  constexpr double kSteepest = 1e12;
  for (int r = 0; r < p.rows.count; ++r)
    p.exact.push_back(std::clamp(std::tan((lowest + r) / focal), -kSteepest, kSteepest));
  p.exact.push_back(std::numeric_limits<double>::infinity());
  p.rounded.assign(p.exact.begin(), p.exact.end());
  p.rows.slope = p.rounded.data();
  p.rows.slope_exact = p.exact.data();
  finish();
  return p;
}

}  // namespace

bool casts_by_columns(const core::View& view) {
  const double distance = glm::length(view.camera.position_m);
  return view.projection == core::Projection::kPerspective ||
         (distance > 0 && upright(view, view.camera.position_m / distance));
}

RangeCaster::RangeCaster(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes)
    : surface_(planet, bytes_of_share(budget_bytes, kSurfaceShare)),
      store_(planet, bytes_of_share(budget_bytes, 1.0 - kSurfaceShare)),
      volumes_(surface_, store_, bytes_of_share(budget_bytes, kVolumeShare)) {}

void RangeCaster::make_room_for_volumes() const {
  std::call_once(has_volumes_, [&] { store_.set_budget(store_.budget_bytes() / 2); });
}

double RangeCaster::ground_radius_m(const glm::dvec3& up, double exaggeration,
                                    const TileFallbacks* fallbacks) const {
  if (fallbacks == nullptr) return surface_.at(up, exaggeration).radius_m;
  if (fallbacks->purpose() == TileFallbacks::Purpose::kImage)
    return surface_.readable_radius_m(up, exaggeration);
  const lod::TileTree& tree = surface_.planet().tree();
  const lod::TileInfo& below = tree.deepest(lod::tile_at(mars::chart_point(up), lod::kMaxLevel));
  return surface_.planet_radius_m() + exaggeration * below.min_height_m;
}

ColumnWalk::Usage RangeCaster::cast(const core::View& view, const RangeOptions& options, base::ThreadPool& pool,
                                    std::span<float> range_m, SectorCaster& sectors,
                                    TileFallbacks* fallbacks) const {
  const double distance = glm::length(view.camera.position_m);
  const bool is_discrete = options.method == RangeOptions::Method::kDiscrete;
  if (options.method == RangeOptions::Method::kVolume) {
    make_room_for_volumes();
    return volumes_.cast(view, {options.exaggeration, options.volume}, options.only, pool, range_m, fallbacks);
  }
  if (is_discrete && !casts_by_columns(view))
    throw std::invalid_argument("the discrete caster draws perspective views and those of a level camera");
  const SingleRays single_rays(surface_, options.exaggeration, fallbacks);
  ScratchPool scratches = make_scratch_pool(store_, options.exaggeration, fallbacks);
  std::optional<ColumnWalk> walk;
  // Fallbacks serve single rays too.
  if (distance > 0 && (options.method != RangeOptions::Method::kSingleRays || fallbacks != nullptr)) {
    const glm::dvec3 up = view.camera.position_m / distance;
    const double ground_m = ground_radius_m(up, options.exaggeration, fallbacks);
    if (distance > ground_m) {
      walk.emplace(surface_, ColumnCamera{up, distance, surface_.planet_radius_m(), ground_m},
                   options.exaggeration,
                   CellRule{options.cell_px, core::focal_px(view),
                            lod::is_neutral(options.control) ? nullptr : &options.control,
                            lod::centre_of_view(view), is_discrete, is_discrete && options.discrete.blends},
                   fallbacks);
      if (fallbacks != nullptr && fallbacks->purpose() == TileFallbacks::Purpose::kImage)
        fallbacks->require(walk->below_camera());
    }
  }
  if (walk && options.method != RangeOptions::Method::kSingleRays) {
    const bool round = upright(view, walk->camera().up);
    const bool is_reference = options.method == RangeOptions::Method::kReference;
    if (is_reference || round || view.projection == core::Projection::kPerspective) {
      if (is_reference) {
        march_fixed_steps(view, *walk, scratches, pool, range_m);
      } else if (round) {
        cast_upright(view, *walk, is_discrete ? options.discrete.rays : 1, scratches, pool, range_m);
      } else if (is_discrete) {
        cast_discretely(view, *walk, options.discrete, scratches, pool, sectors.samples(), range_m);
      } else {
        sectors.cast(view, options.sectors, *walk, scratches, options.cell_px == 0 ? &single_rays : nullptr,
                     pool, range_m, options.only);
      }
      return walk->usage();
    }
    // A level image whose rows look backward beyond the zenith or the nadir is cast by single rays.
    if (!is_discrete && !is_level(view, walk->camera().up) &&
        cast_by_fan(view, *walk, scratches, options.cell_px == 0 ? &single_rays : nullptr, pool,
                    sectors.samples(), range_m))
      return walk->usage();
  }
  if (is_discrete) {
    std::ranges::fill(range_m, 0.0F);  // the camera is below the ground
    return {};
  }
  cast_single_rays(view, single_rays, walk ? &*walk : nullptr, scratches, pool, range_m);
  ColumnWalk::Usage usage;
  if (walk) usage = walk->usage();  // of rays that lacked a tile
  usage.steepest_slope = surface_.planet().tree().steepest_slope(options.exaggeration);
  return usage;
}

bool RangeCaster::is_in_volume(const glm::dvec3& place_m, const RangeOptions& options) const {
  make_room_for_volumes();
  return volumes_.is_ground(place_m, {options.exaggeration, options.volume});
}

bool RangeCaster::light_parts(const core::View& view, const RangeOptions& options, const PartLight& light,
                              base::ThreadPool& pool, std::span<const float> range_m,
                              std::span<PixelNormal> out, TileFallbacks* fallbacks) const {
  return volumes_.light(view, {options.exaggeration, options.volume}, light, pool, range_m, out, fallbacks);
}

double RangeCaster::range_error(const core::View& view, double exaggeration) const {
  double lowest_m = std::numeric_limits<double>::infinity();
  double highest_m = -lowest_m;
  for (const lod::TileInfo& tile : surface_.planet().tree().tiles()) {
    if (tile.key.level > 0) break;  // heights nest
    lowest_m = std::min(lowest_m, tile.min_height_m);
    highest_m = std::max(highest_m, tile.max_height_m);
  }
  const bool is_high = exaggeration * (highest_m - lowest_m) > 0.1 * surface_.planet_radius_m();
  return is_high ? kWideRangeError : range_error(view);
}

void RangeCaster::cast_upright(const core::View& view, const ColumnWalk& walk, int rays, ScratchPool& scratches,
                               base::ThreadPool& pool, std::span<float> range_m) const {
  const core::SubRectangle part = core::drawn_part(view);
  const ImageRows image = image_rows(view, part, rays);
  const double level_y = 0.5 * view.height + view.principal_offset_px.y;
  const glm::dvec3& up = walk.camera().up;
  ColumnBatch batch;
  batch.rows = image.rows;
  batch.rows.has_ranges = walk.is_discrete();
  batch.columns = part.width;
  batch.stride = -static_cast<std::ptrdiff_t>(part.width);
  batch.out = range_m.data() - batch.stride * (batch.rows.count - 1);
  batch.stream = range_m.size_bytes() > kCachedBytes;
  batch.set_column = [&](int column, ColumnGroup& group, int lane, glm::dvec3& azimuth) {
    const glm::dvec3 ray = core::pixel_ray(view, part.x + column + 0.5, level_y);
    azimuth = glm::normalize(ray - glm::dot(ray, up) * up);
    group.row_end[lane] = static_cast<float>(batch.rows.count);
  };
  cast_columns({&batch, 1}, walk, scratches, pool);
}

void RangeCaster::cast_single_rays(const core::View& view, const SingleRays& single_rays,
                                   const ColumnWalk* walk, ScratchPool& scratches, base::ThreadPool& pool,
                                   std::span<float> range_m) const {
  const core::SubRectangle part = core::drawn_part(view);
  const glm::dvec3& camera_m = view.camera.position_m;
  pool.run(static_cast<std::size_t>(part.height), [&](std::size_t row) {
    const auto width = static_cast<std::size_t>(part.width);
    for (std::size_t x = 0; x < width; ++x) {
      const glm::dvec3 ray =
          core::pixel_ray(view, part.x + static_cast<double>(x) + 0.5, part.y + static_cast<double>(row) + 0.5);
      std::optional<double> range = single_rays.cast(camera_m, ray);
      if (!range && walk == nullptr) range = 0;  // below the ground that is there
      if (!range) {
        const ScratchPool::Lease scratch = scratches.acquire();
        FacetFinder finder(*walk, scratch->tiles);
        range = march(camera_m, ray, 0, walk->highest_m(), finder, walk->camera().radius_m);
      }
      range_m[row * width + x] = static_cast<float>(*range);
    }
  });
}

}  // namespace vpe::voxel
