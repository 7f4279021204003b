#include "vpe/app/window_painter.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "paging/planet/planet_user.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/layer_check.h"
#include "vpe/app/scene/object_renderer.h"
#include "vpe/core/margin.h"
#include "vpe/voxel/ray_renderer.h"
#include "vpe/window/moved_image.h"
#include "vpe/window/ui/driver_lock.h"

namespace vpe::app {

namespace {

// Carrying has this part of the memory.
constexpr std::size_t kCarryingShare = 8;

}  // namespace

WindowPainter::WindowPainter(std::shared_ptr<const paging::PlanetFile> planet, Common common,
                             StereoMethod stereo, double change_s)
    : planet_(planet),
      shown_(planet),
      common_(std::move(common)),
      change_s_(change_s),
      overlays_(std::move(planet)),
      stereo_(std::move(stereo)) {}

CarriedDrawer* WindowPainter::drawer_for(const core::DrawRequest& request, Eye eye) {
  if (eye == Eye::kMiddle || !stereo_.carries() || backend_ != core::Backend::kRay ||
      !why_not_carried(request).empty())
    return nullptr;
  if (!carried_) {
    carried_ = std::make_unique<CarriedDrawer>(
        *renderer_, planet_,
        CarriedDrawerOptions{.gap_px = stereo_.gap_px,
                             .memory_bytes = memory_bytes(common_) / kCarryingShare,
                             .threads = common_.threads});
    if (shown_ != planet_) carried_->change_planet(shown_);
  }
  return carried_.get();
}

core::DrawResult WindowPainter::draw(const core::DrawRequest& request, double time_s, Eye eye) {
  CarriedDrawer* const drawer = drawer_for(request, eye);
  core::DrawResult result = drawer == nullptr    ? renderer_->draw(request)
                            : eye == Eye::kRight ? drawer->draw_carried(request)
                                                 : drawer->draw_first(request);
  return with_overlays(request, std::move(result), time_s, overlays_);
}

core::DrawResult WindowPainter::with_overlays(const core::DrawRequest& request, core::DrawResult result,
                                              double time_s, FrameOverlays& overlays) const {
  if (!overlay::any(request.settings)) return result;
  overlays.load(request.settings);
  const FrameGround ground{result.frame.range_m, result.certificate, {}};
  overlay::composite(overlays.layer(request, ground, time_s), result.frame.colour);
  return result;
}

void WindowPainter::change_ground(const window::ImageRequest& request) {
  std::shared_ptr<const paging::PlanetFile> next = planet_;
  if (request.ground || request.reliefs) {
    const scripts::GroundTracks tracks = request.ground ? *request.ground : scripts::GroundTracks();
    if (!ground_ || !(ground_->tracks() == tracks))
      ground_ = std::make_unique<FlightGround>(planet_, tracks, "flight", common_);
    scripts::GroundState state = tracks.at(request.flight_time_s);
    if (request.reliefs)
      state.reliefs.insert(state.reliefs.end(), request.reliefs->begin(), request.reliefs->end());
    next = ground_->planet(state);
  }
  if (next == shown_) return;
  // If one of them fails, all are made anew.
  shown_ = next;
  try {
    overlays_.change_planet(next);
    paging::change_planet(*renderer_, next);
    if (carried_) carried_->change_planet(next);
  } catch (...) {
    carried_.reset();
    renderer_.reset();
    backend_.reset();
    throw;
  }
}

bool WindowPainter::is_same(const Sight& a, const Sight& b) {
  const mars::Axes& x = a.view.camera.axes;
  const mars::Axes& y = b.view.camera.axes;
  return a.view.camera.position_m == b.view.camera.position_m && x.forward == y.forward && x.up == y.up &&
         a.view.width == b.view.width && a.view.height == b.view.height && a.view.fov_deg == b.view.fov_deg &&
         a.colour == b.colour && a.exaggeration == b.exaggeration;
}

// Takes the ends of the palette from the view, if the settings say so. While the view moves they stay as they
// are, so that colours do; a view that is asked for a second time rests. Returns true if the ends are not those
// of this view.
bool WindowPainter::take_palette(core::DrawRequest& request, window::DrawnImage& drawn) {
  if (!needs_view_palette(request.settings, *planet_)) {
    palette_of_.reset();
    before_.reset();
    return false;
  }
  const Sight now{request.view, request.settings.colour, request.settings.exaggeration};
  const bool rests = before_ && is_same(*before_, now);
  const bool fits = palette_of_ && palette_of_->colour == now.colour;
  if (!fits || (rests && !is_same(*palette_of_, now))) {
    if (!view_palette_) view_palette_ = std::make_unique<ViewPalette>(planet_, common_);
    view_palette_->change_planet(shown_);
    view_palette_->clear();
    view_palette_->add(reduced(request));
    ends_ = view_palette_->ends();
    palette_of_ = now;
  }
  before_ = now;
  take_ends(request.settings, ends_);
  drawn.palette = ends_;
  return !is_same(*palette_of_, now);
}

namespace {

// Adds an image as a grid, if it has ranges.
void add_grid(const core::DrawRequest& request, const core::DrawResult& result,
              std::vector<warp::ImageGrid>& grids) {
  if (!request.want_rough_range || result.frame.range_m.empty() || result.certificate.is_below_ground) return;
  grids.emplace_back(request.view, result.frame.range_m, window::kMovedCells);
}

// Returns the window's context on this thread, or null where it is of no use.
std::shared_ptr<gl::Context> window_context(const window::DrawPlace& place) {
  if (place.context == nullptr) return nullptr;
  try {
    place.context->make_current();
    std::shared_ptr<gl::Context> context = gl::Context::adopt([shared = place.context] { shared->release(); });
    return place.needs_gpu && context->info().software ? nullptr : context;
  } catch (const std::runtime_error&) {
    return nullptr;  // a context of the painter's own is as good
  }
}

RenderOptions with_backend(core::Backend backend) {
  RenderOptions options;
  options.backend = backend;
  return options;
}

// Two planets that are compared have a half of the memory each.
Common share_of(Common common, const paging::PlanetFile& planet) {
  if (planet.earlier()) common.memory_mb /= 2;
  return common;
}

}  // namespace

// The earlier planet is compared with itself, so that the same settings draw it: its differences are 0.
void WindowPainter::draw_earlier(const core::DrawRequest& request, const window::ImageRequest& asked,
                                 window::DrawnImage& drawn) {
  if (earlier_renderer_ == nullptr) {
    const auto earlier = planet_->earlier()->compared_with(planet_->earlier());
    earlier_renderer_ = make_renderer(with_backend(*backend_), share_of(common_, *planet_), earlier);
    earlier_overlays_ = std::make_unique<FrameOverlays>(earlier);
  }
  if (asked.layers) earlier_overlays_->use_layers(*asked.layers);
  core::DrawRequest of_earlier = request;
  (void)leave_out_layers(of_earlier.settings, *planet_->earlier());
  core::DrawResult result =
      with_overlays(request, earlier_renderer_->draw(of_earlier), asked.flight_time_s, *earlier_overlays_);
  add_grid(request, result, drawn.earlier_grids);
  drawn.result.settled = drawn.result.settled && result.settled;
  for (std::string& failure : result.failures) drawn.result.failures.push_back(std::move(failure));
  drawn.earlier = {result.frame.width, result.frame.height, std::move(result.frame.colour)};
}

core::DrawRequest for_window_rays(core::DrawRequest request, bool within_tolerance) {
  core::SettingsValues& values = request.settings;
  if (values.ray_mode != core::RayMode::kExact) return request;
  if (!within_tolerance && voxel::multires_control(request).empty() && !values.ray_fovea) return request;
  values.ray_mode = core::RayMode::kMultires;
  values.ray_cell_px =
      std::clamp(values.lod_tolerance_px, core::RayLimits::kLeastCell_px, core::RayLimits::kMostCell_px);
  return request;
}

window::ImageRequest as_drawn(window::ImageRequest request) {
  if (!voxel::refused_control(request.draw).empty()) request.backend = core::Backend::kPolygon;
  if (request.backend == core::Backend::kRay)
    request.draw = for_window_rays(std::move(request.draw), request.is_auto);
  return request;
}

// Makes the renderer of triangles in the window's context where that is to be had, so that images can stay there.
std::unique_ptr<core::Renderer> WindowPainter::make_ground_renderer(core::Backend backend,
                                                                    const window::DrawPlace& place) {
  const Common common = share_of(common_, *planet_);
  handover_.reset();
  const std::shared_ptr<gl::Context> context =
      backend == core::Backend::kPolygon ? window_context(place) : nullptr;
  if (context == nullptr) return make_renderer(with_backend(backend), common, planet_);
  auto handover = std::make_shared<gl::TextureHandover>();
  gl::RendererOptions options;
  options.memory_bytes = memory_bytes(common);
  options.threads = common.threads;
  options.handover = handover;
  auto renderer =
      with_objects(gl::make_polygon_renderer(context, planet_, options), planet_,
                   {.threads = common.threads, .note = [quiet = common.quiet](const std::string& note) {
                      if (!quiet) std::fprintf(stderr, "vpe: note: %s\n", note.c_str());
                    }});
  handover_ = std::move(handover);
  return renderer;
}

// Takes an image that was left in the window's texture, and its ranges.
void WindowPainter::take_texture(const core::DrawRequest& request, window::DrawnImage& drawn) {
  drawn.is_in_texture = true;
  drawn.drawn = handover_->drawn;
  if (!handover_->range_m.empty())
    drawn.grids.push_back(warp::ImageGrid::of_corners(request.view, handover_->range_m, window::kMovedCells));
}

void WindowPainter::draw_pair(const window::ImageRequest& request, const core::DrawRequest& draw_request,
                              window::DrawnImage& drawn) {
  StereoArguments stereo;
  stereo.layout = core::to_string(*request.stereo);
  stereo.eye_base_m = request.eye_base_m;
  stereo.convergence_m = request.convergence_m;
  StereoImage pair = draw_stereo(stereo, draw_request, [&](const core::DrawRequest& one, Eye eye) {
    core::DrawResult result = draw(one, request.flight_time_s, eye);
    if (eye != Eye::kMiddle) add_grid(one, result, drawn.grids);
    return result;
  });
  drawn.image = std::move(pair.image);
  drawn.result = std::move(pair.left);
  if (pair.right.certificate.shift_bound_px > drawn.result.certificate.shift_bound_px)
    drawn.result.certificate = pair.right.certificate;
  drawn.result.settled = drawn.result.settled && pair.right.settled;
}

window::DrawnImage WindowPainter::paint(const window::ImageRequest& request) {
  const window::DriverLock lock;
  window::ImageRequest as_asked = as_drawn(request);
  const core::Backend backend = as_asked.backend;
  const bool changes = backend_ && backend_ != backend;
  if (backend_ != backend) {
    carried_.reset();
    renderer_.reset();
    earlier_renderer_.reset();
    backend_.reset();  // stays empty when making the renderer fails
    renderer_ = make_ground_renderer(backend, request.place);
    if (shown_ != planet_) paging::change_planet(*renderer_, shown_);
    backend_ = backend;
  }
  change_ground(request);
  if (request.layers) overlays_.use_layers(*request.layers);
  core::DrawRequest draw_request = std::move(as_asked.draw);
  const std::string left_out = leave_out_layers(draw_request.settings, *planet_);
  draw_request.paging.change_wait_s = change_s_;
  draw_request.time_s = request.flight_time_s;
  if (changes) {
    draw_request.paging.wait = true;
    draw_request.paging.timeout_s = change_s_;
  }
  draw_request.want_range = draw_request.want_range || overlay::needs_range(draw_request.settings);
  window::DrawnImage drawn;
  if (shown_ != planet_) drawn.changed = shown_;
  const bool has_other_palette = take_palette(draw_request, drawn);
  const auto tell_left_out = [&] {
    if (!left_out.empty() && left_out != told_) drawn.result.failures.push_back(left_out);
    told_ = left_out;
  };
  if (handover_) *handover_ = {};
  if (request.stereo) {
    draw_pair(request, draw_request, drawn);
    tell_left_out();
    drawn.result.settled = drawn.result.settled && !has_other_palette;
    return drawn;
  }
  draw_request.view = core::with_margin(draw_request.view, request.margin_px);
  if (handover_)
    *handover_ = {
        .texture = request.place.texture, .unused = request.place.unused, .cells = window::kMovedCells};
  drawn.result = draw(draw_request, request.flight_time_s);
  tell_left_out();
  drawn.result.settled = drawn.result.settled && !has_other_palette;
  if (request.with_earlier && planet_->earlier()) draw_earlier(draw_request, request, drawn);
  core::Frame& frame = drawn.result.frame;
  if (handover_ && handover_->is_drawn)
    take_texture(draw_request, drawn);
  else
    add_grid(draw_request, drawn.result, drawn.grids);
  if (request.keeps_ranges && !drawn.grids.empty()) drawn.range_m = std::move(frame.range_m);
  drawn.image = {frame.width, frame.height, std::move(frame.colour)};
  frame = {};
  return drawn;
}

}  // namespace vpe::app
