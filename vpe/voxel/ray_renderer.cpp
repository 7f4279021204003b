#include "vpe/voxel/ray_renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "paging/ground_paint.h"
#include "paging/surface.h"
#include "vpe/core/edge_filter.h"
#include "vpe/core/inspect.h"
#include "vpe/core/parallel.h"
#include "vpe/core/shading.h"
#include "vpe/core/sky.h"

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

mars::Rgb to_bytes(const glm::dvec3& colour) {
  const auto byte = [](double x) { return static_cast<std::uint8_t>(std::clamp(x + 0.5, 0.0, 255.0)); };
  return {byte(colour.x), byte(colour.y), byte(colour.z)};
}

// Ground without data, the mean of the polygon backend's stripes.
constexpr glm::dvec3 kGap{105, 105, 105};

class RayRenderer : public core::Renderer {
 public:
  RayRenderer(std::shared_ptr<const paging::PlanetFile> planet, const RayOptions& options)
      : planet_(std::move(planet)),
        surface_(planet_, share(options, kSurfaceShare)),
        painter_(planet_, share(options, kPaintShare)),
        pool_(options.threads) {}

  core::DrawResult draw(const core::DrawRequest& request) override;

 private:
  struct Row {
    int without_data = 0;
  };

  static std::size_t share(const RayOptions& options, double part) {
    return static_cast<std::size_t>(part * static_cast<double>(options.memory_bytes));
  }

  void set_look(const core::DrawRequest& request);
  Row draw_row(const core::DrawRequest& request, int y, core::Frame& frame,
               std::vector<float>& inverse_depth) const;
  core::Certificate certify(const core::DrawRequest& request, const core::Frame& frame,
                            std::int64_t gaps) const;

  std::shared_ptr<const paging::PlanetFile> planet_;
  paging::Surface surface_;
  paging::GroundPainter painter_;
  core::ThreadPool pool_;
  core::Appearance scale_of_;
  std::shared_ptr<const core::ColourScale> scale_;
  paging::ShadeParams look_;
};

void RayRenderer::set_look(const core::DrawRequest& request) {
  const core::Appearance& appearance = request.settings;
  const bool has_image = planet_->meta().finest_image_level >= 0;
  if (!paging::needs_scale(appearance, has_image)) {
    scale_ = nullptr;
  } else if (!scale_ || scale_of_ != appearance) {
    scale_ = std::make_shared<const core::ColourScale>(appearance);
    scale_of_ = appearance;
  }
  look_ = paging::shade_params(appearance, request.sun, has_image, scale_);
}

RayRenderer::Row RayRenderer::draw_row(const core::DrawRequest& request, int y, core::Frame& frame,
                                       std::vector<float>& inverse_depth) const {
  const core::View& view = request.view;
  const core::SubRectangle part = core::drawn_part(view);
  const core::Appearance& appearance = request.settings;
  const double focal = core::focal_px(view);
  const glm::dvec3& eye = view.eye.eye_m;
  const double eye_radius = glm::length(eye);
  const double radius = planet_->radius_m();
  paging::GroundPainter::Cursor cursor;
  Row row;
  for (int x = 0; x < frame.width; ++x) {
    const glm::dvec3 ray = core::pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5);
    const double range = surface_.cast(eye, ray, appearance.exaggeration);
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x);
    frame.range_m[at] = static_cast<float>(range);
    glm::dvec3 colour(0);
    if (std::isinf(range)) {
      inverse_depth[at] = 0;
      if (appearance.background == core::Background::kWhite) colour = glm::dvec3(255);
      if (appearance.background == core::Background::kSky)
        colour = core::sky_colour(eye, ray, request.sun, radius);
      frame.colour[at] = to_bytes(colour);
      continue;
    }
    inverse_depth[at] = static_cast<float>(1.0 / std::max(range * glm::dot(ray, view.eye.axes.forward), 1e-3));
    const glm::dvec3 place = eye + range * ray;
    const glm::dvec3 up = glm::normalize(place);
    const auto painted = painter_.colour_at(up, range / focal, look_, cursor);
    row.without_data += painted ? 0 : 1;
    colour = glm::clamp(painted.value_or(kGap), 0.0, 255.0);
    if (appearance.haze_visibility_m > 0.0) {
      const double air = core::air_m(radius, eye_radius - radius, glm::dot(ray, eye) / eye_radius, range);
      colour = glm::mix(core::haze_colour(glm::dot(up, request.sun)), colour,
                        core::transmittance(air, appearance.haze_visibility_m));
    }
    frame.colour[at] = to_bytes(colour);
  }
  return row;
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
  set_look(request);
  core::DrawResult result;
  core::Frame& frame = result.frame;
  const glm::ivec2 size = core::drawn_size(request.view);
  frame.width = size.x;
  frame.height = size.y;
  const std::size_t pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  frame.colour.resize(pixels);
  frame.range_m.resize(pixels);
  std::vector<float> inverse_depth(pixels);
  std::vector<Row> rows(static_cast<std::size_t>(size.y));
  pool_.run(rows.size(),
            [&](std::size_t y) { rows[y] = draw_row(request, static_cast<int>(y), frame, inverse_depth); });
  std::int64_t gaps = 0;
  for (const Row& row : rows) gaps += row.without_data;
  if (request.settings.smooth_edges && request.view.projection == core::Projection::kPerspective)
    core::smooth_edges(frame.colour, inverse_depth, size.x, size.y, pool_);
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
