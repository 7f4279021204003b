#include "vpe/app/window_painter.h"

#include <utility>

#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/stereo_render.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {

WindowPainter::WindowPainter(std::shared_ptr<const paging::PlanetFile> planet, Common common)
    : planet_(planet), common_(std::move(common)), overlays_(std::move(planet)) {}

core::DrawResult WindowPainter::draw(const core::DrawRequest& request, double time_s) {
  core::DrawResult result = renderer_->draw(request);
  if (!overlay::any(request.settings)) return result;
  overlays_.load(request.settings);
  const FrameGround ground{result.frame.range_m, result.certificate, {}};
  overlay::composite(overlays_.layer(request, ground, time_s), result.frame.colour);
  return result;
}

window::DrawnImage WindowPainter::paint(const window::ImageRequest& request) {
  // Levels that are controlled are drawn by triangles, whatever is chosen.
  const core::Backend backend =
      voxel::level_control(request.draw).empty() ? request.backend : core::Backend::kPolygon;
  if (backend_ != backend) {
    renderer_.reset();
    backend_.reset();  // stays empty when making the renderer fails
    RenderOptions options;
    options.backend = backend;
    renderer_ = make_renderer(options, common_, planet_);
    backend_ = backend;
  }
  core::DrawRequest draw_request = request.draw;
  draw_request.want_range = draw_request.want_range || overlay::needs_range(draw_request.settings);
  window::DrawnImage drawn;
  const auto draw_one = [&](const core::DrawRequest& one) { return draw(one, request.flight_time_s); };
  if (request.stereo) {
    StereoArguments stereo;
    stereo.layout = core::to_string(*request.stereo);
    stereo.eye_base_m = request.eye_base_m;
    StereoImage pair = draw_stereo(stereo, draw_request, draw_one);
    drawn.image = std::move(pair.image);
    drawn.result = std::move(pair.left);
    drawn.result.settled = drawn.result.settled && pair.right.settled;
    return drawn;
  }
  drawn.result = draw_one(draw_request);
  core::Frame& frame = drawn.result.frame;
  drawn.image = {frame.width, frame.height, std::move(frame.colour)};
  frame = {};
  return drawn;
}

}  // namespace vpe::app
