#include "vpe/explore/objects/object_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

using Limits = ObjectViewLimits;

constexpr double kLeastRadius_m = 0.05;  // so that a camera keeps a distance from a point

struct Sight {
  double heading_deg = 0;
  double pitch_deg = 0;
};

// Returns the angles of a direction in the level frame of a place. Straight up and down have no heading.
Sight sight_along(const mars::LocalFrame& frame, const glm::dvec3& direction, double usual_heading_deg) {
  const double east = glm::dot(direction, frame.east);
  const double north = glm::dot(direction, frame.north);
  const double level = std::hypot(east, north);
  return {level > 1e-9 * glm::length(direction) ? std::atan2(east, north) / mars::kRadiansPerDegree
                                                : usual_heading_deg,
          std::atan2(glm::dot(direction, frame.up), level) / mars::kRadiansPerDegree};
}

ObjectOffset within(ObjectOffset offset, const ItemBall& ball) {
  const double radius_m = std::max(ball.radius_m, kLeastRadius_m);
  offset.heading_deg = std::remainder(offset.heading_deg, 360.0);
  offset.pitch_deg = std::clamp(offset.pitch_deg, Limits::kHighest_deg, Limits::kLowest_deg);
  offset.distance_m =
      std::clamp(offset.distance_m, Limits::kNearest_radii * radius_m, Limits::kFarthest_radii * radius_m);
  return offset;
}

}  // namespace

ObjectOffset usual_offset(const ItemBall& ball, double heading_deg) {
  return within({heading_deg, Limits::kPitch_deg, Limits::kRadii * std::max(ball.radius_m, kLeastRadius_m)},
                ball);
}

ObjectOffset offset_of(const mars::Pose& camera, const ItemBall& ball, double planet_radius_m) {
  const glm::dvec3 sight = ball.centre_m - mars::to_camera(camera, planet_radius_m).position_m;
  const Sight angles = sight_along(mars::local_frame(mars::lon_lat(ball.centre_m)), sight, camera.yaw_deg);
  return within({angles.heading_deg, angles.pitch_deg, glm::length(sight)}, ball);
}

ObjectOffset turned(const ObjectOffset& offset, const ItemBall& ball, double around_deg, double up_deg,
                    double factor) {
  return within({offset.heading_deg + around_deg, offset.pitch_deg + up_deg, offset.distance_m * factor}, ball);
}

mars::Pose pose_at(const ItemBall& ball, const ObjectOffset& offset, const TerrainQuery& ground) {
  const mars::LocalFrame there = mars::local_frame(mars::lon_lat(ball.centre_m));
  const mars::Axes axes = mars::oriented_axes(there, offset.heading_deg, offset.pitch_deg, 0);
  const glm::dvec3 position_m = ball.centre_m - axes.forward * offset.distance_m;
  const mars::LonLat place = mars::lon_lat(position_m);
  mars::Pose pose{place.lon_deg, place.lat_deg, glm::length(position_m) - ground.radius_m, 0, 0, 0};
  pose = kept_clear(pose, ground);
  const glm::dvec3 camera_m = mars::direction(place) * (ground.radius_m + pose.alt_m);
  const Sight angles = sight_along(mars::local_frame(place), ball.centre_m - camera_m, offset.heading_deg);
  pose.yaw_deg = angles.heading_deg;
  pose.pitch_deg = angles.pitch_deg;
  return pose;
}

}  // namespace vpe::explore
