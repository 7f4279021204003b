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
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/core/appearance/inspect.h"
#include "vpe/core/appearance/shading.h"
#include "vpe/core/image/edge_filter.h"
#include "vpe/voxel/cast/range_caster.h"
#include "vpe/voxel/frame_prefetcher.h"
#include "vpe/voxel/paint/image_painter.h"

namespace vpe::voxel {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

constexpr double kCastShare = 0.6;
constexpr double kPaintShare = 0.4;
constexpr std::size_t kMostKeptPixels = std::size_t{1} << 24;

class RayRenderer : public core::Renderer {
 public:
  RayRenderer(std::shared_ptr<const paging::PlanetFile> planet, const RayOptions& options)
      : planet_(std::move(planet)),
        caster_(planet_, share(options, kCastShare)),
        painter_(planet_, share(options, kPaintShare)),
        pool_(options.threads),
        ahead_(caster_, painter_, pool_, options.memory_bytes) {}

  core::DrawResult draw(const core::DrawRequest& request) override;

 private:
  static std::size_t share(const RayOptions& options, double part) {
    return static_cast<std::size_t>(part * static_cast<double>(options.memory_bytes));
  }

  core::DrawResult draw_image(const core::DrawRequest& request);
  bool has_room_ahead() const;
  ColumnWalk::Used cast(const core::DrawRequest& request, std::vector<float>& range_m);
  ColumnWalk::Used draw_samples(const core::DrawRequest& request, core::Frame& frame, std::int64_t& gaps);
  core::Certificate certify(const core::DrawRequest& request, const core::Frame& frame, std::int64_t gaps,
                            const ColumnWalk::Used& used) const;

  std::shared_ptr<const paging::PlanetFile> planet_;
  RangeCaster caster_;
  ImagePainter painter_;
  base::ThreadPool pool_;
  FramePrefetcher ahead_;
  // Used again by the next image, so that it need not ask for memory.
  std::vector<float> range_m_;
  std::vector<float> inverse_depth_;
  std::int64_t tiles_used_ = 0;  // by the last cast
};

// Where in a pixel its rays go through, from its middle.
std::span<const glm::dvec2> places_in_pixel(int samples) {
  static constexpr std::array<glm::dvec2, 1> kOne{{{0, 0}}};
  static constexpr std::array<glm::dvec2, 2> kTwo{{{-0.25, -0.25}, {0.25, 0.25}}};
  // A square turned by atan(1/2), so that no two are in one row or column.
  static constexpr std::array<glm::dvec2, 4> kFour{
      {{-0.125, -0.375}, {0.375, -0.125}, {0.125, 0.375}, {-0.375, 0.125}}};
  if (samples >= 4) return kFour;
  if (samples >= 2) return kTwo;
  return kOne;
}

// The view whose pixel middles are this view's at `place` from theirs.
core::View shifted(core::View view, const glm::dvec2& place) {
  view.principal_offset_px.y -= place.y;
  if (view.projection == core::Projection::kPerspective) {
    view.principal_offset_px.x -= place.x;
  } else {
    const double turn = place.x / view.width * 2 * glm::pi<double>();
    const glm::dvec3 right = view.camera.axes.right;
    const glm::dvec3 forward = view.camera.axes.forward;
    view.camera.axes.forward = std::cos(turn) * forward + std::sin(turn) * right;
    view.camera.axes.right = std::cos(turn) * right - std::sin(turn) * forward;
  }
  return view;
}

core::Certificate RayRenderer::certify(const core::DrawRequest& request, const core::Frame& frame,
                                       std::int64_t gaps, const ColumnWalk::Used& used) const {
  core::Certificate c;
  c.quantisation_px = RangeCaster::range_error(request.view) * core::focal_px(request.view);
  c.geometric_error_m = used.geometric_error_m;
  c.screen_space_error_px = used.screen_space_error_px;
  c.shift_bound_px = used.screen_space_error_px + c.quantisation_px;
  for (const int n : used.tiles_by_level) c.tiles_drawn += n;
  c.image_bound_px = c.shift_bound_px;
  c.tolerance_px = request.settings.lod_tolerance_px;
  c.nodata_share =
      static_cast<double>(gaps) / static_cast<double>(std::max<std::size_t>(1, frame.colour.size()));
  const paging::PlanetMeta& meta = planet_->meta();
  c.resampling_max_m = meta.resampling.max_m;
  c.resampling_rms_m = meta.resampling.rms_m;
  for (const mars::SourceInfo& s : meta.sources) {
    if (s.accuracy_m) c.source_accuracy_m = std::max(c.source_accuracy_m.value_or(0.0), *s.accuracy_m);
  }
  c.illustration = meta.illustration;
  c.exaggeration = request.settings.exaggeration;
  return c;
}

// Several rays a pixel, shifted in parallel (Cohen-Or 1996, section 2), and their mean; range is that of the
// middle.
ColumnWalk::Used RayRenderer::draw_samples(const core::DrawRequest& request, core::Frame& frame,
                                           std::int64_t& gaps) {
  const RangeOptions options = range_options(request);
  const std::span<const glm::dvec2> places = places_in_pixel(request.settings.samples);
  std::vector<glm::ivec3> sum(frame.colour.size(), glm::ivec3(0));
  std::vector<float> range(frame.range_m.size());
  core::DrawRequest moved = request;
  ColumnWalk::Used used;
  gaps = 0;
  for (const glm::dvec2& place : places) {
    moved.view = shifted(request.view, place);
    used.add(caster_.cast(moved.view, options, pool_, range));
    gaps += painter_.paint(moved, range, frame.colour, {}, pool_);
    for (std::size_t k = 0; k < sum.size(); ++k)
      sum[k] += glm::ivec3(frame.colour[k].r, frame.colour[k].g, frame.colour[k].b);
  }
  if (request.want_range) used.add(caster_.cast(request.view, options, pool_, frame.range_m));
  ahead_.begin(request);
  const int n = static_cast<int>(places.size());
  gaps /= n;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    const auto mean = [&](int s) { return static_cast<std::uint8_t>((s + n / 2) / n); };
    frame.colour[k] = {mean(sum[k].x), mean(sum[k].y), mean(sum[k].z)};
  }
  return used;
}

// Whether the caches have room for two images at once.
bool RayRenderer::has_room_ahead() const {
  const HeightGridStore::Made made = caster_.store().made();
  if (tiles_used_ == 0 || made.tiles == 0) return false;
  const double tile_bytes = static_cast<double>(made.bytes) / static_cast<double>(made.tiles);
  // Some tiles are there in two families.
  return 2 * tile_bytes * static_cast<double>(tiles_used_) <=
         0.5 * static_cast<double>(caster_.store().budget_bytes());
}

// Ranges of a view, and of those to come as soon as somebody is idle.
ColumnWalk::Used RayRenderer::cast(const core::DrawRequest& request, std::vector<float>& range_m) {
  const RangeOptions options = range_options(request);
  std::optional<ColumnWalk::Used> used = ahead_.take(request.view, options, range_m);
  const bool early = has_room_ahead();
  if (early) ahead_.begin(request);
  if (!used) used = caster_.cast(request.view, options, pool_, range_m);
  tiles_used_ = 0;
  for (const int n : used->tiles_by_level) tiles_used_ += n;
  if (!early) ahead_.begin(request);
  return *used;
}

core::DrawResult RayRenderer::draw(const core::DrawRequest& request) {
  try {
    return draw_image(request);
  } catch (...) {
    ahead_.stop();
    throw;
  }
}

core::DrawResult RayRenderer::draw_image(const core::DrawRequest& request) {
  if (const std::string trouble = core::check(request.view); !trouble.empty())
    throw std::runtime_error(trouble);
  if (const std::string trouble = why_not(request); !trouble.empty()) throw std::runtime_error(trouble);
  const auto start = Clock::now();
  core::DrawResult result;
  core::Frame& frame = result.frame;
  const glm::ivec2 size = core::drawn_size(request.view);
  frame.width = size.x;
  frame.height = size.y;
  const std::size_t pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  frame.colour.resize(pixels);
  frame.range_m.swap(range_m_);
  frame.range_m.resize(pixels);
  ColumnWalk::Used used;
  std::int64_t gaps = 0;
  if (request.settings.samples > 1) {
    used = draw_samples(request, frame, gaps);
  } else {
    used = cast(request, frame.range_m);
    result.stats.select_ms = ms_since(start);
    const bool smooth =
        request.settings.smooth_edges && request.view.projection == core::Projection::kPerspective;
    inverse_depth_.resize(smooth ? pixels : 0);
    gaps = painter_.paint(request, frame.range_m, frame.colour, inverse_depth_, pool_);
    if (smooth) core::smooth_edges(frame.colour, inverse_depth_, size.x, size.y, pool_);
  }
  core::apply_gamma(frame.colour, request.settings.gamma);
  result.certificate = certify(request, frame, gaps, used);
  result.stats.tiles_by_level = used.tiles_by_level;
  result.stats.tiles_drawn = result.certificate.tiles_drawn;
  if (!request.want_range) range_m_.swap(frame.range_m);
  // Not those of a poster.
  if (pixels > kMostKeptPixels) {
    range_m_ = {};
    inverse_depth_ = {};
  }
  result.stats.draw_ms = ms_since(start);
  result.stats.bytes_resident = static_cast<std::int64_t>(
      caster_.bytes_resident() + painter_.bytes_resident() + ahead_.bytes() +
      (range_m_.capacity() + inverse_depth_.capacity()) * sizeof(float) + planet_->tree().bytes());
  result.settled = true;
  return result;
}

}  // namespace

std::string why_not(const core::DrawRequest& request) {
  const core::Mode mode = request.settings.mode;
  if (mode == core::Mode::kWireframe || mode == core::Mode::kMarkers)
    return "the ray backend has no triangles to show: use --backend polygon for this mode";
  if (request.cull_view || request.settings.inspect != core::Inspect::kNone)
    return "the ray backend draws no tiles: --cull-from and inspect show those of --backend polygon";
  return {};
}

std::unique_ptr<core::Renderer> make_ray_renderer(std::shared_ptr<const paging::PlanetFile> planet,
                                                  const RayOptions& options) {
  return std::make_unique<RayRenderer>(std::move(planet), options);
}

}  // namespace vpe::voxel
