#include "vpe/voxel/ray_renderer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/ext/scalar_constants.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "paging/planet/planet_look.h"
#include "paging/planet/planet_user.h"
#include "vpe/base/parallel.h"
#include "vpe/core/appearance/inspect.h"
#include "vpe/core/appearance/shading.h"
#include "vpe/core/below_ground.h"
#include "vpe/core/image/edge_filter.h"
#include "vpe/core/ray_lengths.h"
#include "vpe/voxel/cast/range_caster.h"
#include "vpe/voxel/cast/tile_fallbacks.h"
#include "vpe/voxel/discrete_image.h"
#include "vpe/voxel/downsampled_view.h"
#include "vpe/voxel/explain_tiles.h"
#include "vpe/voxel/foveated_image.h"
#include "vpe/voxel/frame_prefetcher.h"
#include "vpe/voxel/paint/image_painter.h"
#include "vpe/voxel/pixel_caster.h"
#include "vpe/voxel/smooth/smooth_caster.h"
#include "vpe/voxel/tile_loader.h"

namespace vpe::voxel {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Of a pixel's samples while its image is cast (measured: 51 at 8192 x 8192 and 16384 x 16384 pixels).
constexpr std::size_t kBytesOfSamples = 51;
constexpr double kCastShare = 0.6;
constexpr double kPaintShare = 0.4;
// Of smooth tiles, beside height grids, which stay empty where smooth ground alone is drawn.
constexpr double kSmoothShare = 0.45;
// Upcoming views of an image that may not wait. Each takes a thousandth of its rays.
constexpr std::size_t kMostExpected = 3;
constexpr std::size_t kMostKeptPixels = std::size_t{1} << 24;

// Copies the values of a rectangle of the drawn part, row by row.
void cut_out(std::span<const float> values, const core::SubRectangle& part, const core::SubRectangle& rectangle,
             std::vector<float>& out) {
  out.clear();
  for (int y = rectangle.y; y < rectangle.y + rectangle.height; ++y) {
    const auto row = values.begin() + std::ptrdiff_t{y - part.y} * part.width + (rectangle.x - part.x);
    out.insert(out.end(), row, row + rectangle.width);
  }
}

class RayRenderer : public core::PixelRenderer, public paging::PlanetUser {
 public:
  RayRenderer(std::shared_ptr<const paging::PlanetFile> planet, const RayOptions& options)
      : planet_(std::move(planet)),
        caster_(planet_, share(options, kCastShare)),
        painter_(planet_, share(options, kPaintShare)),
        pool_(options.threads),
        max_image_bytes_(options.max_image_bytes),
        smooth_bytes_(share(options, kSmoothShare)),
        explained_(options.explained),
        prefetcher_(caster_, painter_, pool_, options.memory_bytes),
        loader_(caster_, painter_, options.threads),
        pixel_caster_(caster_) {}

  core::DrawResult draw(const core::DrawRequest& request) override;
  core::DrawResult draw_pixels(const core::DrawRequest& request, const core::WantedPixels& wanted,
                               core::Frame& frame) override;
  void change_planet(std::shared_ptr<const paging::PlanetFile> planet) override;

 private:
  void go_over_to(std::shared_ptr<const paging::PlanetFile> planet);
  static std::size_t share(const RayOptions& options, double part) {
    return static_cast<std::size_t>(part * static_cast<double>(options.memory_bytes));
  }

  // Holds what belongs to one image: how it may read, what it used and what it lacked.
  struct Image {
    Image(const HeightGridStore& store, const core::DrawRequest& request, const ReadingRule& rule)
        : fallbacks(store, request.settings.exaggeration, rule), reading{rule} {}
    TileFallbacks fallbacks;
    ImagePainter::Reading reading;
    std::vector<AbsentPage> absent_colours;  // of all that was painted
    ColumnWalk::Usage usage;
    std::int64_t nodata_pixels = 0;
    std::optional<TileUsage> middle;  // of a foveated image
    bool is_thinned = false;
    // Of an image of smooth ground.
    double smoothing_m = 0;
    double smoothing_px = 0;
  };

  core::DrawResult draw_image(const core::DrawRequest& request);
  core::DrawResult draw_below(const core::DrawRequest& request) const;
  void require_drawable(const core::DrawRequest& request) const;  // throws
  ReadingRule reading_rule(const core::DrawRequest& request, bool reads_all);
  bool is_below_ground(const core::DrawRequest& request) const;
  void check_size(const core::DrawRequest& request) const;
  bool has_room_for_next() const;
  void cast(const core::DrawRequest& request, std::vector<float>& range_m, Image& image);
  ColumnWalk::Usage cast_in_bands(const core::View& view, const RangeOptions& options, std::span<float> range_m,
                                  TileFallbacks& fallbacks);
  void draw_samples(const core::DrawRequest& request, core::Frame& frame, Image& image);
  // Casts the view and, unless `colour` is empty, paints it; does not use the prefetcher.
  void draw_one(const core::DrawRequest& request, std::span<float> range_m, std::span<base::Rgb> colour,
                Image& image);
  void draw_foveated(const core::DrawRequest& request, const FoveaPlan& plan, std::span<float> range_m,
                     std::span<base::Rgb> colour, Image& image);
  // Casts voxels and, unless `colour` is empty, paints them.
  void draw_discrete(const core::DrawRequest& request, const RangeOptions& options, std::span<float> range_m,
                     std::span<base::Rgb> colour, Image& image);
  // Casts smooth ground and, unless `colour` is empty, paints it.
  void draw_smooth(const core::DrawRequest& request, const SmoothForm& form, std::span<float> range_m,
                   std::span<base::Rgb> colour, Image& image);
  void draw_smooth_pixels(const core::DrawRequest& request, const SmoothForm& form,
                          const core::WantedPixels& wanted, core::Frame& frame, Image& image);
  void take_usage(const SmoothUsage& usage, Image& image) const;
  const SmoothGround& smooth_ground() const;
  // Returns how parts of the ground are lit, in normals_; empty if there is nothing of them in the image.
  std::span<const PixelNormal> light_parts(const core::DrawRequest& request, std::span<const float> range_m,
                                           std::span<const std::uint8_t> wanted, Image& image);
  // Returns the number of nodata pixels. Smooths edges where there is one sample a pixel.
  std::int64_t paint(const core::DrawRequest& request, std::span<const float> range_m,
                     std::span<base::Rgb> colour, Image& image, std::span<const PixelNormal> normals = {});
  // Smooths edges where the settings ask for it and there is one sample a pixel.
  void smooth(const core::DrawRequest& request, std::span<const float> range_m, std::span<base::Rgb> colour);
  core::Certificate certify(const core::DrawRequest& request, const core::Frame& frame,
                            const Image& image) const;
  // States what the image lacked, and lets the loader load it.
  void finish_paging(const core::DrawRequest& request, const Image& image, core::DrawResult& result);
  std::vector<TileLoader::Expected> expected_tiles(const core::DrawRequest& request);

  std::shared_ptr<const paging::PlanetFile> planet_;
  RangeCaster caster_;
  ImagePainter painter_;
  base::ThreadPool pool_;
  std::size_t max_image_bytes_;
  std::size_t smooth_bytes_;
  std::vector<lod::TileExplanation>* explained_;
  FramePrefetcher prefetcher_;
  TileLoader loader_;
  PixelCaster pixel_caster_;
  mutable std::unique_ptr<const SmoothGround> smooth_;  // made when it is first needed
  std::vector<PixelNormal> normals_;
  SectorCaster hint_sectors_;
  std::optional<double> exaggeration_;        // of the last image
  bool was_flat_ = false;                     // by the last image
  bool has_new_planet_ = false;               // since the last image
  std::unordered_set<std::string> reported_;  // failures
  // Kept so that the next image need not allocate them.
  std::vector<float> range_m_;
  std::vector<float> inverse_depth_;
  std::vector<float> rays_m_;  // of all rays of the pixels
  struct FoveaBuffers {
    std::vector<float> outer_m;
    std::vector<float> dense_m;
    std::vector<base::Rgb> outer;
    std::vector<base::Rgb> dense;
    std::size_t bytes() const {
      return (outer_m.capacity() + dense_m.capacity()) * sizeof(float) +
             (outer.capacity() + dense.capacity()) * sizeof(base::Rgb);
    }
  };
  FoveaBuffers fovea_;
  std::int64_t tiles_used_ = 0;  // by the last cast
};

// Returns where the rays of a pixel go through it, relative to its centre, in pixels.
std::span<const glm::dvec2> sample_offsets(int samples) {
  static constexpr std::array<glm::dvec2, 1> kOne{{{0, 0}}};
  static constexpr std::array<glm::dvec2, 2> kTwo{{{-0.25, -0.25}, {0.25, 0.25}}};
  // A square rotated by atan(1/2), so that no two samples share a row or a column.
  static constexpr std::array<glm::dvec2, 4> kFour{
      {{-0.125, -0.375}, {0.375, -0.125}, {0.125, 0.375}, {-0.375, 0.125}}};
  if (samples >= 4) return kFour;
  if (samples >= 2) return kTwo;
  return kOne;
}

// Returns the view whose pixel centres lie at `offset` from those of `view`.
core::View shifted(core::View view, const glm::dvec2& offset) {
  view.principal_offset_px.y -= offset.y;
  if (view.projection == core::Projection::kPerspective) {
    view.principal_offset_px.x -= offset.x;
  } else {
    const double angle = offset.x / view.width * 2 * glm::pi<double>();
    const glm::dvec3 right = view.camera.axes.right;
    const glm::dvec3 forward = view.camera.axes.forward;
    view.camera.axes.forward = std::cos(angle) * forward + std::sin(angle) * right;
    view.camera.axes.right = std::cos(angle) * right - std::sin(angle) * forward;
  }
  return view;
}

core::Certificate RayRenderer::certify(const core::DrawRequest& request, const core::Frame& frame,
                                       const Image& image) const {
  const ColumnWalk::Usage& usage = image.usage;
  core::Certificate c;
  // A range that is off by d / sin(incidence) puts the point d beside its facet, so d / cos(slope) above it.
  const double range_error_px =
      caster_.range_error(request.view, request.settings.exaggeration) * core::focal_px(request.view);
  c.quantisation_px = range_error_px * std::hypot(1.0, usage.steepest_slope);
  c.geometric_error_m = usage.geometric_error_m;
  c.screen_space_error_px = usage.screen_space_error_px;
  c.smoothing_m = image.smoothing_m;
  c.smoothing_px = image.smoothing_px;
  c.shift_bound_px = usage.screen_space_error_px + c.quantisation_px + c.smoothing_px;
  // Of the whole planet: what lies beside a ray may be ground that no ray has met.
  const double steepest_slope = planet_->tree().steepest_slope(request.settings.exaggeration);
  c.sample_distance_px = range_options(request, planet_->radius_m()).sectors.distance_px();
  const double beside_px = rise_px(c.sample_distance_px, steepest_slope);
  c.shift_bound_px += beside_px;
  if (image.is_thinned) {
    c.thinning_px = thinning_px(steepest_slope);
    c.shift_bound_px += c.thinning_px;
    if (image.middle)
      c.middle_bound_px = image.middle->screen_space_error_px +
                          range_error_px * std::hypot(1.0, image.middle->steepest_slope) + beside_px;
  }
  for (const int n : usage.tiles_by_level) c.tiles_drawn += n;
  c.image_bound_px = c.shift_bound_px;
  if (request.want_colour) {
    c.nodata_share = static_cast<double>(image.nodata_pixels) /
                     static_cast<double>(std::max<std::size_t>(1, frame.colour.size()));
  }
  const paging::PlanetMeta& meta = planet_->meta();
  core::state_data(c,
                   {.tolerance_px = request.settings.lod_tolerance_px,
                    .resampling_max_m = meta.resampling.max_m,
                    .resampling_rms_m = meta.resampling.rms_m,
                    .illustration = meta.illustration},
                   meta.sources);
  c.exaggeration = request.settings.exaggeration;
  c.corner_stretch = core::corner_stretch(request.view);
  return c;
}

std::int64_t RayRenderer::paint(const core::DrawRequest& request, std::span<const float> range_m,
                                std::span<base::Rgb> colour, Image& image,
                                std::span<const PixelNormal> normals) {
  const std::int64_t nodata_pixels =
      painter_.paint(request, range_m, colour, {}, pool_, &image.reading, normals);
  image.absent_colours.insert(image.absent_colours.end(), image.reading.absent.begin(),
                              image.reading.absent.end());
  smooth(request, range_m, colour);
  return nodata_pixels;
}

void RayRenderer::smooth(const core::DrawRequest& request, std::span<const float> range_m,
                         std::span<base::Rgb> colour) {
  if (!request.settings.smooth_edges || request.settings.samples > 1 ||
      request.view.projection != core::Projection::kPerspective)
    return;
  const glm::ivec2 size = core::drawn_size(request.view);
  inverse_depth_.resize(range_m.size());
  core::inverse_depths(request.view, range_m, pool_, inverse_depth_);
  core::smooth_edges(colour, inverse_depth_, size.x, size.y, pool_);
}

const SmoothGround& RayRenderer::smooth_ground() const {
  if (!smooth_) smooth_ = std::make_unique<const SmoothGround>(caster_.surface(), smooth_bytes_);
  return *smooth_;
}

void RayRenderer::take_usage(const SmoothUsage& usage, Image& image) const {
  image.usage.add(usage.tiles, planet_->tree());
  image.smoothing_m = std::max(image.smoothing_m, usage.smoothing_m);
  image.smoothing_px = std::max(image.smoothing_px, usage.smoothing_px);
}

void RayRenderer::draw_smooth(const core::DrawRequest& request, const SmoothForm& form,
                              std::span<float> range_m, std::span<base::Rgb> colour, Image& image) {
  const bool is_lit = !colour.empty();
  normals_.resize(is_lit ? range_m.size() : 0);
  take_usage(cast_smooth(smooth_ground(), request.view, form, pool_, {range_m, normals_}), image);
  if (is_lit) image.nodata_pixels += paint(request, range_m, colour, image, normals_);
}

// Casts the wanted pixels but for those that show sky, and sets normals_ for painting.
void RayRenderer::draw_smooth_pixels(const core::DrawRequest& request, const SmoothForm& form,
                                     const core::WantedPixels& wanted, core::Frame& frame, Image& image) {
  std::vector<std::uint8_t> is_cast(wanted.is_wanted.begin(), wanted.is_wanted.end());
  for (std::size_t n = 0; n < is_cast.size(); ++n) {
    if (is_cast[n] == 0 || wanted.clear_m[n] != core::kSkyRange) continue;
    is_cast[n] = 0;
    frame.range_m[n] = core::kSkyRange;
  }
  if (request.want_colour) normals_.assign(is_cast.size(), {});
  take_usage(cast_smooth(smooth_ground(), request.view, form, pool_, {frame.range_m, normals_, is_cast}),
             image);
}

void RayRenderer::draw_one(const core::DrawRequest& request, std::span<float> range_m,
                           std::span<base::Rgb> colour, Image& image) {
  if (const std::optional<FoveaPlan> plan = fovea_plan(request)) {
    draw_foveated(request, *plan, range_m, colour, image);
    return;
  }
  if (const std::optional<SmoothForm> form = smooth_form(request)) {
    draw_smooth(request, *form, range_m, colour, image);
    return;
  }
  const RangeOptions options = range_options(request, planet_->radius_m());
  if (options.method == RangeOptions::Method::kDiscrete)
    return draw_discrete(request, options, range_m, colour, image);
  image.usage.add(cast_in_bands(request.view, options, range_m, image.fallbacks), planet_->tree());
  if (!colour.empty())
    image.nodata_pixels += paint(request, range_m, colour, image, light_parts(request, range_m, {}, image));
}

std::span<const PixelNormal> RayRenderer::light_parts(const core::DrawRequest& request,
                                                      std::span<const float> range_m,
                                                      std::span<const std::uint8_t> wanted, Image& image) {
  if (!request.ground_parts || !draws_ground_parts(request)) return {};
  const RangeOptions options = range_options(request, planet_->radius_m());
  const PartLight light{request.settings.shadows ? request.sun : glm::dvec3(0), wanted};
  normals_.resize(range_m.size());
  if (!caster_.light_parts(request.view, options, light, pool_, range_m, normals_, &image.fallbacks)) return {};
  return normals_;
}

void RayRenderer::draw_discrete(const core::DrawRequest& request, const RangeOptions& options,
                                std::span<float> range_m, std::span<base::Rgb> colour, Image& image) {
  const int rays = options.discrete.rays;
  std::span<float> rays_m = range_m;
  if (rays > 1) {
    rays_m_.resize(range_m.size() * static_cast<std::size_t>(rays));
    rays_m = rays_m_;
  }
  image.usage.add(cast_in_bands(request.view, options, rays_m, image.fallbacks), planet_->tree());
  if (rays > 1) take_middle_rays(rays_m, core::drawn_size(request.view).x, rays, range_m);
  if (colour.empty()) return;
  image.nodata_pixels +=
      paint_discrete(request, rays_m, {}, painter_, pool_, image.reading, image.absent_colours, colour);
  if (rays == 1) smooth(request, range_m, colour);
}

void RayRenderer::draw_foveated(const core::DrawRequest& request, const FoveaPlan& plan,
                                std::span<float> range_m, std::span<base::Rgb> colour, Image& image) {
  RangeOptions options = range_options(request, planet_->radius_m());
  core::DrawRequest outer = request;
  outer.view = plan.outer;
  std::vector<float>& outer_m = fovea_.outer_m;
  outer_m.resize(drawn_pixels(outer.view));
  RangeOptions outer_options = options;
  // Samples are as far away in the image as in its middle.
  if (options.sectors.is_nearest) outer_options.sectors.spacing_px /= kThinned;
  ColumnWalk::Usage usage = cast_in_bands(outer.view, outer_options, outer_m, image.fallbacks);
  usage.scale_px(core::focal_px(request.view) / core::focal_px(outer.view));
  image.usage.add(usage, planet_->tree());
  image.is_thinned = true;
  core::DrawRequest dense = request;
  dense.view.part = plan.dense;
  if (plan.dense.width > 0) {
    options.only = plan.dense;
    usage = cast_in_bands(request.view, options, range_m, image.fallbacks);
    if (!image.middle) image.middle.emplace();
    image.middle->add(usage, planet_->tree());
    image.usage.add(usage, planet_->tree());
  }
  if (request.want_range || request.want_rough_range || colour.empty())
    spread_ranges(plan, request.view, outer_m, pool_, range_m);
  if (colour.empty()) return;
  std::vector<base::Rgb>& outer_colour = fovea_.outer;
  outer_colour.resize(outer_m.size());
  const std::int64_t nodata_pixels = paint(outer, outer_m, outer_colour, image);
  image.nodata_pixels +=
      nodata_pixels * static_cast<std::int64_t>(colour.size()) / static_cast<std::int64_t>(outer_colour.size());
  fovea_.dense.clear();
  if (plan.dense.width > 0) {
    cut_out(range_m, core::drawn_part(request.view), plan.dense, fovea_.dense_m);
    fovea_.dense.resize(fovea_.dense_m.size());
    paint(dense, fovea_.dense_m, fovea_.dense, image);
  }
  merge_colours(plan, request.view, {outer_colour, fovea_.dense}, pool_, colour);
}

// Draws a complete image for each sample and takes their mean. The range is that of the pixel's centre.
void RayRenderer::draw_samples(const core::DrawRequest& request, core::Frame& frame, Image& image) {
  const std::span<const glm::dvec2> offsets = sample_offsets(request.settings.samples);
  std::vector<glm::ivec3> sum(frame.colour.size(), glm::ivec3(0));
  std::vector<float> range(frame.range_m.size());
  core::DrawRequest moved = request;
  for (const glm::dvec2& offset : offsets) {
    moved.view = shifted(request.view, offset);
    draw_one(moved, range, frame.colour, image);
    for (std::size_t k = 0; k < sum.size(); ++k)
      sum[k] += glm::ivec3(frame.colour[k].r, frame.colour[k].g, frame.colour[k].b);
  }
  if (request.want_range) {
    moved = request;
    moved.want_colour = false;
    draw_one(moved, frame.range_m, {}, image);
  }
  if (request.paging.wait) prefetcher_.begin(request);
  const int n = static_cast<int>(offsets.size());
  image.nodata_pixels /= n;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    const auto mean = [&](int s) { return static_cast<std::uint8_t>((s + n / 2) / n); };
    frame.colour[k] = {mean(sum[k].x), mean(sum[k].y), mean(sum[k].z)};
  }
}

// Returns true if the caches have room for the tiles of two images at once.
bool RayRenderer::has_room_for_next() const {
  const HeightGridStore::BuildTotals totals = caster_.store().build_totals();
  if (tiles_used_ == 0 || totals.tiles == 0) return false;
  const double tile_bytes = static_cast<double>(totals.bytes) / static_cast<double>(totals.tiles);
  // A tile may be held in two line families.
  return 2 * tile_bytes * static_cast<double>(tiles_used_) <=
         0.5 * static_cast<double>(caster_.store().budget_bytes());
}

// The samples of columns take several times the memory of the image, so a large image is cast in bands of rows.
ColumnWalk::Usage RayRenderer::cast_in_bands(const core::View& view, const RangeOptions& options,
                                             std::span<float> range_m, TileFallbacks& fallbacks) {
  constexpr std::size_t kLeastRows = 64;
  const core::SubRectangle whole = core::drawn_part(view);
  const auto width = static_cast<std::size_t>(whole.width);
  const auto height = static_cast<std::size_t>(whole.height);
  // Rows of rays for each row of pixels.
  const std::size_t rays =
      options.method == RangeOptions::Method::kDiscrete ? static_cast<std::size_t>(options.discrete.rays) : 1;
  const double bytes =
      static_cast<double>(kBytesOfSamples * width * rays) / std::min(1.0, options.sectors.spacing_px);
  const auto most = static_cast<std::size_t>(static_cast<double>(max_image_bytes_ / 2) / std::max(1.0, bytes));
  const std::size_t rows = std::max(kLeastRows, most);
  if (rows >= height) return caster_.cast(view, options, pool_, range_m, &fallbacks);
  ColumnWalk::Usage usage;
  for (std::size_t y = 0; y < height; y += rows) {
    const std::size_t count = std::min(rows, height - y);
    core::View band = view;
    band.part = {whole.x, whole.y + static_cast<int>(y), whole.width, static_cast<int>(count)};
    usage.add(
        caster_.cast(band, options, pool_, range_m.subspan(y * width * rays, count * width * rays), &fallbacks),
        planet_->tree());
  }
  return usage;
}

// Casts the view, or takes its ranges from the prefetcher, and lets the prefetcher start on the next one.
void RayRenderer::cast(const core::DrawRequest& request, std::vector<float>& range_m, Image& image) {
  const RangeOptions options = range_options(request, planet_->radius_m());
  if (!request.paging.wait) {
    image.usage = cast_in_bands(request.view, options, range_m, image.fallbacks);
    return;
  }
  std::optional<ColumnWalk::Usage> usage = prefetcher_.take(request.view, options, range_m);
  const bool early = has_room_for_next();
  if (early) prefetcher_.begin(request);
  if (!usage) usage = cast_in_bands(request.view, options, range_m, image.fallbacks);
  tiles_used_ = 0;
  for (const int n : usage->tiles_by_level) tiles_used_ += n;
  if (!early) prefetcher_.begin(request);
  image.usage = std::move(*usage);
}

ReadingRule RayRenderer::reading_rule(const core::DrawRequest& request, bool reads_all) {
  const core::PagingRequest& paging = request.paging;
  const double exaggeration = request.settings.exaggeration;
  const bool is_exaggerated_anew =
      std::exchange(exaggeration_, exaggeration).value_or(exaggeration) != exaggeration;
  // Flat shading reads no normals of posts.
  const bool is_flat = request.settings.shading == core::Shading::kFlat;
  const bool is_smooth_anew = std::exchange(was_flat_, is_flat) && !is_flat;
  const bool starts_anew = std::exchange(has_new_planet_, false) || is_exaggerated_anew || is_smooth_anew;
  if (reads_all) return ReadingRule::always();
  if (paging.wait) return {paging.timeout_s, pool_.threads()};
  if (starts_anew && paging.change_wait_s > 0) return {paging.change_wait_s, pool_.threads()};
  return ReadingRule::never();
}

// Finds what upcoming views will lack, with few rays.
std::vector<TileLoader::Expected> RayRenderer::expected_tiles(const core::DrawRequest& request) {
  std::vector<TileLoader::Expected> out;
  if (range_options(request, planet_->radius_m()).method == RangeOptions::Method::kReference) return out;
  const RangeOptions options =
      for_hints(range_options(request, planet_->radius_m()), FramePrefetcher::kDownsampling);
  for (std::size_t n = 0; n < std::min(request.paging.upcoming.size(), kMostExpected); ++n) {
    core::DrawRequest later = request;
    later.view = request.paging.upcoming[n];
    if (!core::check(later.view).empty()) continue;
    const core::View few = downsampled_view(later.view, FramePrefetcher::kDownsampling);
    const glm::ivec2 size = core::drawn_size(few);
    std::vector<float> range_m(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    TileFallbacks fallbacks(caster_.store(), options.exaggeration, ReadingRule::never(),
                            TileFallbacks::Purpose::kHint);
    caster_.cast(few, options, pool_, range_m, hint_sectors_, &fallbacks);
    ImagePainter::Reading reading{ReadingRule::never()};
    if (request.want_colour) painter_.read_ahead(later, few, range_m, pool_, &reading);
    out.push_back({later.view, {options.exaggeration, fallbacks.absent(), std::move(reading.absent)}});
  }
  return out;
}

void RayRenderer::finish_paging(const core::DrawRequest& request, const Image& image,
                                core::DrawResult& result) {
  const LackingTiles lacking{request.settings.exaggeration, image.fallbacks.absent(), image.absent_colours};
  result.missing = missing_tiles(planet_->tree(), lacking);
  if (!image.reading.failure_of_points.empty())
    result.missing.push_back({"of flat colours", image.reading.failure_of_points, true});
  for (const core::MissingTile& tile : result.missing) {
    if (tile.is_unreadable && reported_.insert(tile.why).second) result.failures.push_back(tile.why);
  }
  result.stats.tiles_missing = static_cast<int>(result.missing.size());
  result.stats.tiles_substituted = image.usage.tiles_replaced;
  result.certificate.tiles_missing = result.stats.tiles_missing;
  result.certificate.tiles_substituted = result.stats.tiles_substituted;
  std::vector<TileLoader::Expected> expected;
  if (!request.paging.wait) expected = expected_tiles(request);
  result.settled = !loader_.request(request.view, lacking, expected);
}

void RayRenderer::change_planet(std::shared_ptr<const paging::PlanetFile> planet) {
  go_over_to(paging::keep_layers(std::move(planet), planet_));
}

void RayRenderer::go_over_to(std::shared_ptr<const paging::PlanetFile> planet) {
  if (planet == planet_) return;
  paging::require_same_grid(*planet_, *planet);
  prefetcher_.stop();
  loader_.reset();
  caster_.change_planet(planet);
  painter_.change_planet(planet);
  smooth_.reset();
  planet_ = std::move(planet);
  has_new_planet_ = true;
}

core::DrawResult RayRenderer::draw(const core::DrawRequest& request) {
  core::DrawRequest for_planet = request;
  go_over_to(paging::with_layers_of(planet_, request.settings.image_layers));
  paging::fit_to_planet(for_planet.settings, planet_->meta());
  try {
    return draw_image(for_planet);
  } catch (...) {
    prefetcher_.stop();
    throw;
  }
}

void RayRenderer::check_size(const core::DrawRequest& request) const {
  const glm::ivec2 size = core::drawn_size(request.view);
  const std::size_t bytes = ray_image_bytes(request);
  if (bytes <= max_image_bytes_) return;
  const auto megabytes = [](std::size_t n) { return std::to_string((n + 0xfffff) >> 20); };
  throw std::runtime_error("an image of " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                           " pixels takes " + megabytes(bytes) + " MB with the ray backend, more than the " +
                           megabytes(max_image_bytes_) +
                           " MB that it may take beside the ground; give --memory " + megabytes(bytes) +
                           " or more if the machine has twice that, or a smaller --size");
}

// The ground is that of the nearest readable tile, as the caster has it.
bool RayRenderer::is_below_ground(const core::DrawRequest& request) const {
  const glm::dvec3& camera_m = request.view.camera.position_m;
  const double distance_m = glm::length(camera_m);
  if (!(distance_m > 0)) return true;
  if (const std::optional<SmoothForm> form = smooth_form(request)) {
    const SmoothGround& ground = smooth_ground();
    return distance_m < planet_->radius_m() + ground.highest_m(camera_m, form->exaggeration) &&
           distance_m < planet_->radius_m() + ground.at(camera_m, *form).height_m;
  }
  const double exaggeration = request.settings.exaggeration;
  const lod::TileInfo& below =
      planet_->tree().deepest(lod::tile_at(mars::chart_point(camera_m), lod::kMaxLevel));
  const RangeOptions options = range_options(request, planet_->radius_m());
  if (options.method == RangeOptions::Method::kVolume) return caster_.is_in_volume(camera_m, options);
  if (distance_m > planet_->radius_m() + exaggeration * below.max_height_m) return false;
  return distance_m < caster_.surface().readable_radius_m(camera_m / distance_m, exaggeration);
}

// Draws the image of a camera below the ground.
core::DrawResult RayRenderer::draw_below(const core::DrawRequest& request) const {
  core::DrawResult below;
  below.certificate = certify(request, below.frame, Image(caster_.store(), request, ReadingRule::never()));
  core::draw_below_ground(request, below);
  return below;
}

void RayRenderer::require_drawable(const core::DrawRequest& request) const {
  if (const std::string trouble = core::check(request.view); !trouble.empty())
    throw std::runtime_error(trouble);
  if (const std::string trouble = why_not(request); !trouble.empty()) throw std::runtime_error(trouble);
  planet_->tree().require_drawable(request.settings.exaggeration);
}

core::DrawResult RayRenderer::draw_image(const core::DrawRequest& request) {
  require_drawable(request);
  if (!request.paging.wait) prefetcher_.stop();
  const bool reads_all = loader_.begin(request);
  if (explained_ != nullptr) explained_->clear();
  if (is_below_ground(request)) return draw_below(request);
  check_size(request);
  const auto start = Clock::now();
  core::DrawResult result;
  core::Frame& frame = result.frame;
  const glm::ivec2 size = core::drawn_size(request.view);
  frame.width = size.x;
  frame.height = size.y;
  const std::size_t pixels = drawn_pixels(request.view);
  frame.colour.resize(request.want_colour ? pixels : 0);
  frame.range_m.swap(range_m_);
  frame.range_m.resize(pixels);
  Image image(caster_.store(), request, reading_rule(request, reads_all));
  if (request.want_colour && request.settings.samples > 1) {
    draw_samples(request, frame, image);
  } else if (fovea_plan(request) || smooth_form(request) ||
             request.settings.ray_mode == core::RayMode::kDiscrete) {
    draw_one(request, frame.range_m, frame.colour, image);
    if (request.paging.wait) prefetcher_.begin(request);
  } else {
    cast(request, frame.range_m, image);
    result.stats.select_ms = ms_since(start);
    if (request.want_colour)
      image.nodata_pixels =
          paint(request, frame.range_m, frame.colour, image, light_parts(request, frame.range_m, {}, image));
  }
  core::apply_gamma(frame.colour, request.settings.gamma);
  result.certificate = certify(request, frame, image);
  if (explained_ != nullptr) *explained_ = explain_tiles(request, planet_->tree(), image.usage);
  result.stats.tiles_by_level = image.usage.tiles_by_level;
  result.stats.tiles_drawn = result.certificate.tiles_drawn;
  if (!request.want_range && !request.want_rough_range) range_m_.swap(frame.range_m);
  // The buffers of a poster are too large to keep.
  if (pixels > kMostKeptPixels) {
    range_m_ = {};
    inverse_depth_ = {};
    fovea_ = {};
    normals_ = {};
    rays_m_ = {};
  }
  result.stats.draw_ms = ms_since(start);
  result.stats.bytes_resident = static_cast<std::int64_t>(
      caster_.bytes_resident() + painter_.bytes_resident() + prefetcher_.bytes() +
      (range_m_.capacity() + inverse_depth_.capacity() + rays_m_.capacity()) * sizeof(float) + fovea_.bytes() +
      planet_->tree().bytes() + (smooth_ ? smooth_->bytes_resident() : 0) +
      normals_.capacity() * sizeof(PixelNormal));
  finish_paging(request, image, result);
  return result;
}

core::DrawResult RayRenderer::draw_pixels(const core::DrawRequest& request, const core::WantedPixels& wanted,
                                          core::Frame& frame) {
  require_drawable(request);
  const std::size_t pixels = drawn_pixels(request.view);
  if (!core::has_one_ray_a_pixel(request.settings))
    throw std::invalid_argument("single pixels are drawn with one sample each");
  if (wanted.is_wanted.size() != pixels || wanted.clear_m.size() != pixels || frame.range_m.size() != pixels ||
      (request.want_colour && frame.colour.size() != pixels))
    throw std::invalid_argument("the pixels to draw have another size than the image");
  core::DrawRequest for_planet = request;
  go_over_to(paging::with_layers_of(planet_, request.settings.image_layers));
  paging::fit_to_planet(for_planet.settings, planet_->meta());
  prefetcher_.stop();
  const bool reads_all = loader_.begin(for_planet);
  if (is_below_ground(for_planet)) {
    core::DrawResult below = draw_below(for_planet);
    for (std::size_t n = 0; n < pixels; ++n) {
      if (wanted.is_wanted[n] == 0) continue;
      frame.range_m[n] = 0;
      if (request.want_colour) frame.colour[n] = below.frame.colour[n];
    }
    below.frame = {};
    return below;
  }
  const auto start = Clock::now();
  Image image(caster_.store(), for_planet, reading_rule(for_planet, reads_all));
  core::DrawResult result;
  std::span<const PixelNormal> normals;
  if (const std::optional<SmoothForm> form = smooth_form(for_planet)) {
    draw_smooth_pixels(for_planet, *form, wanted, frame, image);
    if (request.want_colour) normals = normals_;
  } else if (for_planet.settings.ray_mode == core::RayMode::kDiscrete) {
    // A voxel is found by the walk of its column alone.
    rays_m_.resize(pixels);
    draw_one(for_planet, rays_m_, {}, image);
    for (std::size_t n = 0; n < pixels; ++n)
      if (wanted.is_wanted[n] != 0) frame.range_m[n] = rays_m_[n];
  } else {
    image.usage = pixel_caster_.cast(for_planet.view, range_options(for_planet, planet_->radius_m()), wanted,
                                     pool_, frame.range_m, &image.fallbacks);
  }
  result.stats.select_ms = ms_since(start);
  if (request.want_colour && for_planet.settings.ray_mode == core::RayMode::kDiscrete) {
    image.nodata_pixels = paint_discrete(for_planet, frame.range_m, wanted.is_wanted, painter_, pool_,
                                         image.reading, image.absent_colours, frame.colour);
  } else if (request.want_colour) {
    if (draws_ground_parts(for_planet))
      normals = light_parts(for_planet, frame.range_m, wanted.is_wanted, image);
    image.nodata_pixels = painter_.paint(for_planet, frame.range_m, frame.colour, wanted.is_wanted, pool_,
                                         &image.reading, normals);
    image.absent_colours = image.reading.absent;
  }
  result.certificate = certify(for_planet, frame, image);
  result.stats.tiles_by_level = image.usage.tiles_by_level;
  result.stats.tiles_drawn = result.certificate.tiles_drawn;
  result.stats.draw_ms = ms_since(start);
  finish_paging(for_planet, image, result);
  return result;
}

}  // namespace

std::unique_ptr<core::PixelRenderer> make_ray_renderer(std::shared_ptr<const paging::PlanetFile> planet,
                                                       const RayOptions& options) {
  return std::make_unique<RayRenderer>(std::move(planet), options);
}

}  // namespace vpe::voxel
