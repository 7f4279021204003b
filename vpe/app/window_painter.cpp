#include "vpe/app/window_painter.h"

#include <utility>

#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/stereo_render.h"

namespace vpe::app {

WindowPainter::WindowPainter(std::shared_ptr<const paging::PlanetFile> planet, Common common)
    : planet_(planet), common_(std::move(common)), overlays_(std::move(planet)) {}

core::DrawResult WindowPainter::draw(const core::DrawRequest& request, double time_s) {
  core::DrawResult result = renderer_->draw(request);
  if (!overlay::any(request.settings)) return result;
  overlays_.load(request.settings);
  overlay::composite(overlays_.layer(request, result.frame, result.certificate, time_s), result.frame.colour);
  return result;
}

window::Picture WindowPainter::paint(const window::PictureOrder& order) {
  if (backend_ != order.backend) {
    renderer_.reset();
    backend_.reset();  // until there is one: making it may fail
    PictureOptions options;
    options.backend = window::to_string(order.backend);
    renderer_ = make_renderer(options, common_, planet_);
    backend_ = order.backend;
  }
  core::DrawRequest request = order.request;
  request.want_range = request.want_range || overlay::needs_range(request.settings);
  window::Picture picture;
  const auto draw_one = [&](const core::DrawRequest& eye) { return draw(eye, order.flight_time_s); };
  if (order.stereo) {
    StereoArguments stereo;
    stereo.layout = core::to_string(*order.stereo);
    stereo.eye_base_m = order.eye_base_m;
    StereoPicture pair = draw_stereo(stereo, request, draw_one);
    picture.image = std::move(pair.image);
    picture.result = std::move(pair.left);
    picture.result.settled = picture.result.settled && pair.right.settled;
    return picture;
  }
  picture.result = draw_one(request);
  core::Frame& frame = picture.result.frame;
  picture.image = {frame.width, frame.height, std::move(frame.colour)};
  frame = {};
  return picture;
}

}  // namespace vpe::app
