#include "vpe/window/session_recorder.h"

#include <cmath>
#include <exception>
#include <glm/geometric.hpp>

#include "vpe/base/number.h"
#include "vpe/window/image_layout.h"

namespace vpe::window {

namespace {

scripts::ImageSize whole_size(const explore::Session& session, std::optional<core::StereoLayout> stereo) {
  const glm::ivec2 counts = ImageLayout{{}, stereo}.counts();
  return {session.screen().width * counts.x, session.screen().height * counts.y};
}

}  // namespace

template <class Write>
std::string SessionRecorder::write(const Write& write) {
  if (log_ == nullptr) return {};
  try {
    write();
    return {};
  } catch (const std::exception& e) {
    log_.reset();
    return e.what();
  }
}

std::string SessionRecorder::start(const std::filesystem::path& file, const explore::Session& session,
                                   std::optional<core::StereoLayout> stereo, double now_s) {
  try {
    scripts::FlightView view;
    view.fov_deg = session.screen().fov_deg;
    const scripts::ImageSize size = whole_size(session, stereo);
    view.width = size.width;
    view.height = size.height;
    log_ = std::make_unique<explore::SessionLog>(file, view, session.ground().radius_m);
    file_ = file;
    begun_s_ = now_s;
    return {};
  } catch (const std::exception& e) {
    log_.reset();
    return e.what();
  }
}

std::string SessionRecorder::stop(double now_s) {
  const std::string error = write([&] { log_->end(now_s - begun_s_); });
  log_.reset();
  return error;
}

namespace {

// Returns the settings of an image. Rays that keep to the tolerance because nobody named them have another mode than
// the session's, and those of a moving camera other samples; only with these does a replay draw the same image.
core::Settings settings_of(const ImageRequest& drawn, const explore::Session& session) {
  core::Settings settings = session.settings();
  if (drawn.backend != core::Backend::kRay) return settings;
  if (drawn.draw.settings.ray_sample != settings.values().ray_sample)
    (void)settings.set("rays.sample", "nearest");
  if (drawn.draw.settings.ray_mode == settings.values().ray_mode) return settings;
  (void)settings.set("rays.mode", "multires");
  (void)settings.set("rays.cell", base::format_number(drawn.draw.settings.ray_cell_px));
  return settings;
}

}  // namespace

std::string SessionRecorder::record_image(ImageRequest& request, const ImageRequest& drawn,
                                          const explore::Session& session, double now_s) {
  return write([&] {
    const double time_s = now_s - begun_s_;
    scripts::ViewState view;
    view.fov_deg = session.screen().fov_deg;
    view.size = whole_size(session, request.stereo);
    view.backend = core::drawn_by(drawn.backend);
    view.eyes = scripts::Eyes{request.stereo};
    if (request.stereo) {
      view.eye_base_m = request.eye_base_m;
      view.convergence_m = request.convergence_m;
    }
    request.logged_s = log_->frame({time_s, session.pose(), session.look(), view}, settings_of(drawn, session),
                                   request.draw.interest);
  });
}

std::string SessionRecorder::enter_overlook(const explore::Hotspot& hotspot, double now_s) {
  return write([&] { log_->enter_overlook(now_s - begun_s_, hotspot.name, hotspot.panorama); });
}

std::string SessionRecorder::record_overlook(const panorama::Viewer& viewer, const glm::dvec3& camera_m,
                                             explore::Session& session, double now_s) {
  const std::pair look{viewer.yaw_deg(), viewer.pitch_deg()};
  if (log_ == nullptr || look == overlook_deg_) return {};
  overlook_deg_ = look;
  const mars::LonLat place = mars::lon_lat(camera_m);
  const mars::Pose platform{
      place.lon_deg, place.lat_deg, glm::length(camera_m) - session.ground().radius_m, 0, 0, 0};
  return write([&] {
    log_->frame({now_s - begun_s_, platform, {std::remainder(look.first, 360.0), look.second, 0}},
                session.settings(), session.all_interest());
  });
}

std::string SessionRecorder::leave_overlook(double now_s) {
  return write([&] { log_->leave_overlook(now_s - begun_s_); });
}

}  // namespace vpe::window
