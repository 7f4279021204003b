#include "vpe/voxel/paint/image_painter.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <unordered_set>
#include <vector>

#include "vpe/base/object_pool.h"
#include "vpe/voxel/paint/paint_job.h"

namespace vpe::voxel {

namespace {

// Share of the budget that threads hold while they paint. The caches have the rest, most of it for what every
// image uses again: heights are needed only when tiles are new.
constexpr double kHeldShare = 0.15;
// Of MadeTiles.
constexpr double kMadeShare = 0.15;
constexpr double kShaderShare = 1 - kHeldShare - kMadeShare;
constexpr paging::ShaderBudgetShares kShares{.surface = 0.1, .heights = 0.2, .normals = 0.45, .images = 0.25};

// Rows that a thread takes at a time.
constexpr int kBand = 16;

std::size_t share(double part, std::size_t budget) {
  return static_cast<std::size_t>(part * static_cast<double>(budget));
}

// Counts the bytes of tiles up to a limit.
class HeldTiles {
 public:
  explicit HeldTiles(std::size_t limit_bytes) : limit_(limit_bytes) {}
  // Returns false if the tiles exceed the limit.
  bool add(const void* tile, std::size_t bytes) {
    if (held_.insert(tile).second) bytes_ += bytes;
    return bytes_ <= limit_;
  }

 private:
  std::size_t limit_;
  std::size_t bytes_ = 0;
  std::unordered_set<const void*> held_;
};

// Returns whether MadeTiles has a share in the image.
bool needs_made(const PaintNeeds& needs) { return needs.facets || needs.post_colours; }

bool is_one_colour(const paging::ShadingParams& shading, const paging::PlanetFile& planet) {
  if (shading.lit || shading.colour_source != paging::ColourSource::kPlain) return false;
  for (int face = 0; face < mars::kFaces; ++face) {
    if (planet.has_nodata({static_cast<mars::Face>(face), 0, 0, 0})) return false;
  }
  return true;
}

// Samples of a pixel are coloured as finely as their distance.
double rays_per_radian(const core::DrawRequest& request) {
  return core::focal_px(request.view) * std::sqrt(static_cast<double>(request.settings.samples));
}

// Returns the range at which rays are as far apart as the posts of level 0.
double root_range(const paging::PlanetFile& planet, const core::DrawRequest& request) {
  return lod::nominal_side_m(0, planet.radius_m()) / planet.meta().tile.intervals() * rays_per_radian(request);
}

}  // namespace

ImagePainter::ImagePainter(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes)
    : planet_(std::move(planet)),
      budget_(budget_bytes),
      shader_(planet_, share(kShaderShare, budget_bytes), kShares),
      made_(share(kMadeShare, budget_bytes)) {}

void ImagePainter::change_planet(std::shared_ptr<const paging::PlanetFile> planet) {
  shader_.change_planet(planet, share(kShaderShare, budget_));
  made_.clear();
  planet_ = std::move(planet);
  failures_.clear();
}

double ImagePainter::level_range_m(const core::DrawRequest& request, double post_px) const {
  return root_range(*planet_, request) / post_px;
}

void ImagePainter::set_shading(const core::DrawRequest& request) {
  const core::Appearance& appearance = request.settings;
  const bool has_image = planet_->meta().finest_image_level >= 0;
  if (!paging::needs_scale(appearance, has_image)) {
    scale_ = nullptr;
  } else if (!scale_ || scale_of_ != appearance) {
    scale_ = std::make_shared<const core::ColourScale>(appearance);
    table_ = scale_table(*scale_);
    scale_of_ = appearance;
  }
  shading_ = paging::shading_params(appearance, request.sun, has_image, scale_);
}

std::int64_t ImagePainter::paint(const core::DrawRequest& request, std::span<const float> range_m,
                                 std::span<base::Rgb> colour, std::span<const std::uint8_t> wanted,
                                 base::ThreadPool& pool, Reading* reading, std::span<const PixelNormal> normals,
                                 double post_px) {
  set_shading(request);
  const glm::ivec2 size = core::drawn_size(request.view);
  PaintJob job;
  job.request = &request;
  job.shader = &shader_;
  job.shading = &shading_;
  job.scale = shading_.scale ? &table_ : nullptr;
  job.rays = ray_rows(request.view);
  job.radius_m = planet_->radius_m();
  job.focal_px = rays_per_radian(request);
  job.root_range_m = level_range_m(request, post_px);
  job.posts_side = planet_->meta().tile.posts();
  job.one_colour = is_one_colour(shading_, *planet_);
  if (!job.one_colour) job.needs = paint_needs(shading_);
  job.camera_radius_m = glm::length(request.view.camera.position_m);
  if (job.camera_radius_m > 0.0) job.up = request.view.camera.position_m / job.camera_radius_m;
  job.width = size.x;
  job.height = size.y;
  job.range_m = range_m.data();
  job.colour = colour.data();
  job.wanted = wanted.empty() ? nullptr : wanted.data();
  job.normals = normals.empty() ? nullptr : normals.data();

  if (!needs_made(job.needs) || reading == nullptr) return paint_bands(job, shading_, pool, reading);
  try {
    return paint_bands(job, shading_, pool, reading);
  } catch (const paging::PlanetError& e) {
    reading->failure_of_points = e.what();
  }
  paging::ShadingParams smooth = shading_;
  smooth.flat = false;
  if (smooth.colour_source == paging::ColourSource::kImageAtPosts)
    smooth.colour_source = paging::ColourSource::kImage;
  job.needs = paint_needs(smooth);
  job.shading = &smooth;
  return paint_bands(job, smooth, pool, reading);
}

std::int64_t ImagePainter::paint_bands(const PaintJob& job, const paging::ShadingParams& shading,
                                       base::ThreadPool& pool, Reading* reading) {
  const auto bands = static_cast<std::size_t>((job.height + kBand - 1) / kBand);
  std::atomic<std::int64_t> nodata_count{0};
  const bool by_rule = reading != nullptr && !needs_made(job.needs);
  PaintSources sources(*planet_, shader_, shading, failures_,
                       by_rule ? std::optional(reading->rule) : std::nullopt);
  base::ObjectPool<PaintTiles> tiles_pool(
      [&] {
        return std::make_unique<PaintTiles>(*planet_, shader_, sources, made_, shading,
                                            share(kHeldShare / pool.threads(), budget_));
      },
      {.discard_on_exception = true});
  pool.run(bands, [&](std::size_t band) {
    const auto tiles = tiles_pool.acquire();
    const int begin = static_cast<int>(band) * kBand;
    nodata_count += paint_rows(job, *tiles, begin, std::min(begin + kBand, job.height));
  });
  if (reading != nullptr) reading->absent = sources.absent();
  return nodata_count;
}

void ImagePainter::read_ahead(const core::DrawRequest& request, const core::View& downsampled,
                              std::span<const float> range_m, const base::ThreadPool& pool,
                              Reading* reading) const {
  const bool has_image = planet_->meta().finest_image_level >= 0;
  // No tile depends on the scale of colours.
  const paging::ShadingParams shading =
      paging::shading_params(request.settings, request.sun, has_image, nullptr);
  if (needs_made(paint_needs(shading))) return;
  constexpr double kPart = 0.5 * kShaderShare;
  PaintSources sources(*planet_, shader_, shading, failures_,
                       reading != nullptr ? std::optional(reading->rule) : std::nullopt);
  MadeTiles none(0);
  PaintTiles tiles(*planet_, shader_, sources, none, shading, budget_);
  HeldTiles ground(share(kPart * kShares.normals, budget_));
  HeldTiles images(share(kPart * kShares.images, budget_));
  const double root_range_m = root_range(*planet_, request);
  const core::SubRectangle part = core::drawn_part(downsampled);
  std::size_t at = 0;
  for (int y = 0; y < part.height; ++y) {
    for (int x = 0; x < part.width; ++x, ++at) {
      const auto range = static_cast<double>(range_m[at]);
      if (!std::isfinite(range) || !(range > 0.0)) continue;
      if (pool.is_stopped()) return;
      const glm::dvec3 ray = core::pixel_ray(downsampled, part.x + x + 0.5, part.y + y + 0.5);
      const int level = static_cast<int>(std::ceil(std::log2(root_range_m / range)));
      const PaintTile& tile =
          tiles.find(downsampled.camera.position_m + range * ray, std::clamp(level, 0, tiles.max_level()));
      if (reading != nullptr) continue;
      if (tile.ground && !ground.add(tile.ground.get(), tile.ground->bytes())) return;
      if (tile.image && !images.add(tile.image.get(), tile.image->texels.capacity() * sizeof(base::Rgb)))
        return;
    }
  }
  if (reading != nullptr) reading->absent = sources.absent();
}

void ImagePainter::read(const PaintPage& page) const {
  if (failures_.of(page)) return;
  try {
    if (page.is_image) {
      shader_.image(page.key, page.stretch);
      return;
    }
    paging::ShadingParams shading;
    shading.exaggeration = page.exaggeration;
    shading.shadows = page.sun != glm::dvec3(0);
    shading.sun = page.sun;
    if (page.has_differences) shading.colour_source = paging::ColourSource::kDifference;
    shader_.normals(page.key, shading);
  } catch (const paging::PlanetError& e) {
    failures_.record(page, e.what());
  }
}

std::size_t ImagePainter::page_capacity(const PaintPage& page) const {
  const auto side = static_cast<std::size_t>(planet_->meta().tile.posts());
  const std::size_t texels = std::size_t{paging::kImageIntervals + 1} * (paging::kImageIntervals + 1);
  const std::size_t bytes =
      page.is_image ? texels * sizeof(base::Rgb) : side * side * (sizeof(paging::NormalTile::Post) + 1);
  return share(kShaderShare * (page.is_image ? kShares.images : kShares.normals), budget_) / bytes;
}

}  // namespace vpe::voxel
