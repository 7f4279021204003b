#include "vpe/voxel/ray_renderer.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <stdexcept>
#include <vector>

#include "paging/surface.h"
#include "vpe/core/edge_filter.h"
#include "vpe/core/inspect.h"
#include "vpe/core/parallel.h"
#include "vpe/core/shading.h"
#include "vpe/voxel/picture_painter.h"

namespace vpe::voxel {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

constexpr double kSurfaceShare = 0.6;
constexpr double kPaintShare = 0.4;

// Rounding of a range to float.
constexpr double kRangeRounding = 1.0 / (1 << 24);

class RayRenderer : public core::Renderer {
 public:
  RayRenderer(std::shared_ptr<const paging::PlanetFile> planet, const RayOptions& options)
      : planet_(std::move(planet)),
        surface_(planet_, share(options, kSurfaceShare)),
        painter_(planet_, share(options, kPaintShare)),
        pool_(options.threads) {}

  core::DrawResult draw(const core::DrawRequest& request) override;

 private:
  static std::size_t share(const RayOptions& options, double part) {
    return static_cast<std::size_t>(part * static_cast<double>(options.memory_bytes));
  }

  void fill_ranges(const core::DrawRequest& request, std::span<float> range_m);
  core::Certificate certify(const core::DrawRequest& request, const core::Frame& frame,
                            std::int64_t gaps) const;

  std::shared_ptr<const paging::PlanetFile> planet_;
  paging::Surface surface_;
  PicturePainter painter_;
  core::ThreadPool pool_;
};

// One ray a pixel.
void RayRenderer::fill_ranges(const core::DrawRequest& request, std::span<float> range_m) {
  const core::View& view = request.view;
  const core::SubRectangle part = core::drawn_part(view);
  const auto width = static_cast<std::size_t>(part.width);
  pool_.run(static_cast<std::size_t>(part.height), [&](std::size_t row) {
    const double y = part.y + static_cast<double>(row) + 0.5;
    for (int x = 0; x < part.width; ++x) {
      range_m[row * width + static_cast<std::size_t>(x)] = static_cast<float>(surface_.cast(
          view.eye.eye_m, core::pixel_ray(view, part.x + x + 0.5, y), request.settings.exaggeration));
    }
  });
}

core::Certificate RayRenderer::certify(const core::DrawRequest& request, const core::Frame& frame,
                                       std::int64_t gaps) const {
  core::Certificate c;
  c.quantisation_px = kRangeRounding * core::focal_px(request.view);
  c.shift_bound_px = c.quantisation_px;
  c.picture_bound_px = c.shift_bound_px;
  c.tolerance_px = request.settings.lod_tolerance_px;
  c.share_without_data =
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

core::DrawResult RayRenderer::draw(const core::DrawRequest& request) {
  if (const std::string trouble = core::check(request.view); !trouble.empty())
    throw std::runtime_error(trouble);
  const core::Mode mode = request.settings.mode;
  if (mode == core::Mode::kWireframe || mode == core::Mode::kMarkers)
    throw std::runtime_error("the ray backend has no triangles to show: use --backend polygon for this mode");
  if (request.cull_view || request.settings.inspect != core::Inspect::kNone)
    throw std::runtime_error(
        "the ray backend draws no tiles: --cull-from and inspect show those of --backend polygon");
  const auto start = Clock::now();
  core::DrawResult result;
  core::Frame& frame = result.frame;
  const glm::ivec2 size = core::drawn_size(request.view);
  frame.width = size.x;
  frame.height = size.y;
  const std::size_t pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  frame.colour.resize(pixels);
  frame.range_m.resize(pixels);
  fill_ranges(request, frame.range_m);
  const bool smooth =
      request.settings.smooth_edges && request.view.projection == core::Projection::kPerspective;
  std::vector<float> inverse_depth(smooth ? pixels : 0);
  const std::int64_t gaps = painter_.paint(request, frame.range_m, frame.colour, inverse_depth, pool_);
  if (smooth) core::smooth_edges(frame.colour, inverse_depth, size.x, size.y, pool_);
  core::apply_gamma(frame.colour, request.settings.gamma);
  result.certificate = certify(request, frame, gaps);
  if (!request.want_range) frame.range_m.clear();
  result.stats.draw_ms = ms_since(start);
  result.stats.bytes_resident = static_cast<std::int64_t>(surface_.bytes_resident() +
                                                          painter_.bytes_resident() + planet_->tree().bytes());
  result.settled = true;
  return result;
}

}  // namespace

std::unique_ptr<core::Renderer> make_ray_renderer(std::shared_ptr<const paging::PlanetFile> planet,
                                                  const RayOptions& options) {
  return std::make_unique<RayRenderer>(std::move(planet), options);
}

}  // namespace vpe::voxel
