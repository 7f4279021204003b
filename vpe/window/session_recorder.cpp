#include "vpe/window/session_recorder.h"

#include <cmath>
#include <exception>
#include <glm/geometric.hpp>

#include "vpe/base/number.h"

namespace vpe::window {

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
                                   double now_s) {
  try {
    scripts::FlightView view;
    view.fov_deg = session.screen().fov_deg;
    view.width = session.screen().width;
    view.height = session.screen().height;
    log_ = std::make_unique<explore::SessionLog>(file, view, session.ground().radius_m);
    file_ = file;
    begun_s_ = now_s;
    comment_.clear();
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

std::string SessionRecorder::record_image(ImageRequest& request, const explore::Session& session,
                                          double now_s) {
  return write([&] {
    const double time_s = now_s - begun_s_;
    const std::string comment = "drawn by " + std::string(core::to_string(request.backend)) + ", " +
                                std::to_string(session.screen().width) + "x" +
                                std::to_string(session.screen().height) + ", field of view " +
                                base::format_number(session.screen().fov_deg) + " degrees" +
                                (request.stereo ? ", " + std::string(core::to_string(*request.stereo)) : "");
    if (comment != comment_) log_->note(time_s, comment);
    comment_ = comment;
    request.logged_s =
        log_->frame({time_s, session.pose(), session.look()}, session.settings(), request.draw.interest);
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
