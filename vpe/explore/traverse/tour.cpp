#include "vpe/explore/traverse/tour.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "vpe/base/number.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

mars::Pose tour_pose(const mars::KmlPoint& point, const TerrainQuery& ground) {
  const mars::KmlView& view = *point.view;
  const mars::LocalFrame frame = mars::local_frame(point.place);
  const double base_m = point.is_absolute ? 0 : ground.height_m(frame.up);
  mars::CameraPose camera;
  camera.position_m = frame.up * (ground.radius_m + base_m + point.altitude_m);
  camera.axes = mars::oriented_axes(frame, view.heading_deg, view.tilt_deg - 90, view.roll_deg);
  if (view.range_m) camera.position_m -= camera.axes.forward * *view.range_m;
  mars::Pose pose = mars::to_pose(camera, ground.radius_m);
  // A Camera keeps its own numbers, which the way through the axes would round.
  if (!view.range_m) {
    pose.lon_deg = point.place.lon_deg;
    pose.lat_deg = point.place.lat_deg;
    pose.alt_m = base_m + point.altitude_m;
    pose.yaw_deg = view.heading_deg;
    pose.pitch_deg = std::clamp(view.tilt_deg - 90, -90.0, 90.0);
    pose.roll_deg = view.roll_deg;
  }
  return kept_clear(pose, ground);
}

}  // namespace

scripts::Flight make_tour(std::span<const mars::KmlPoint> points, double speed_m_s,
                          const TerrainQuery& ground) {
  if (points.size() < 2) throw std::invalid_argument("a tour needs at least two views");
  if (!(speed_m_s >= TourLimits::kMinSpeed_m_s && speed_m_s <= TourLimits::kMaxSpeed_m_s))
    throw std::invalid_argument("the speed must be from " + base::format_number(TourLimits::kMinSpeed_m_s) +
                                " to " + base::format_number(TourLimits::kMaxSpeed_m_s));
  scripts::Flight flight;
  glm::dvec3 last_m(0);
  double time_s = 0;
  for (const mars::KmlPoint& point : points) {
    if (!point.view) throw std::invalid_argument("a point of the way has no view; expected a gx:Tour");
    const mars::Pose pose = tour_pose(point, ground);
    const glm::dvec3 here_m = mars::direction({pose.lon_deg, pose.lat_deg}) * (ground.radius_m + pose.alt_m);
    if (!flight.waypoints.empty()) {
      const double way_s = point.view->duration_s.value_or(glm::length(here_m - last_m) / speed_m_s);
      time_s += std::max(way_s, TourLimits::kShortest_s);
    }
    if (time_s > scripts::FlightLimits::kMaxTime_s)
      throw std::invalid_argument("the tour lasts longer than " +
                                  base::format_number(scripts::FlightLimits::kMaxTime_s) +
                                  " s; give a higher speed");
    last_m = here_m;
    scripts::Waypoint w;
    w.time_s = time_s;
    w.lon_deg = pose.lon_deg;
    w.lat_deg = pose.lat_deg;
    w.up_m = pose.alt_m;
    w.yaw_deg = pose.yaw_deg;
    w.pitch_deg = pose.pitch_deg;
    w.roll_deg = pose.roll_deg;
    flight.waypoints.push_back(w);
  }
  return flight;
}

}  // namespace vpe::explore
