#include "vpe/explore/fly_to.h"

#include <algorithm>
#include <cmath>

#include "mars/geodesy/sphere.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

constexpr double kFloor_m = 5;  // heights are compared as logarithms

double log_height(const mars::Pose& pose, const TerrainQuery& ground) {
  return std::log(std::max(height_above_ground_m(pose, ground), kFloor_m));
}

double angle_between(double from_deg, double to_deg, double share) {
  return from_deg + std::remainder(to_deg - from_deg, 360.0) * share;
}

}  // namespace

FlyTo::FlyTo(const mars::Pose& from, const mars::Pose& to, const TerrainQuery& ground) : from_(from), to_(to) {
  const double path_m =
      mars::distance_rad({from.lon_deg, from.lat_deg}, {to.lon_deg, to.lat_deg}) * ground.radius_m;
  const double low = std::max(log_height(from, ground), log_height(to, ground));
  const double apex = std::log(std::max(path_m * 0.6, kFloor_m));
  climb_ = std::max(0.0, apex - low);
  const double vertical = std::abs(log_height(to, ground) - log_height(from, ground)) + 2.0 * climb_;
  const double far = std::log1p(path_m / std::exp(low));
  duration_s_ = std::clamp(0.6 + 0.35 * (vertical + far), FlyToLimits::kShortest_s, FlyToLimits::kLongest_s);
}

mars::Pose FlyTo::at(double time_s, const TerrainQuery& ground) const {
  if (!(time_s < duration_s_)) return to_;
  const double u = std::clamp(time_s / duration_s_, 0.0, 1.0);
  const double s = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);  // speed and acceleration are 0 at both ends
  const glm::dvec3 a = mars::direction({from_.lon_deg, from_.lat_deg});
  const glm::dvec3 b = mars::direction({to_.lon_deg, to_.lat_deg});
  const mars::LonLat place =
      s <= 0.0 ? mars::LonLat{from_.lon_deg, from_.lat_deg} : mars::lon_lat(mars::slerp(a, b, s));
  mars::Pose pose;
  pose.lon_deg = place.lon_deg;
  pose.lat_deg = place.lat_deg;
  const double low = log_height(from_, ground);
  const double high = log_height(to_, ground);
  // Heights are above a level that is interpolated from the ground of one end to that of the other.
  const double base_m = (from_.alt_m - std::exp(low)) * (1.0 - s) + (to_.alt_m - std::exp(high)) * s;
  pose.alt_m = base_m + std::exp(low + (high - low) * s + climb_ * 4.0 * s * (1.0 - s));
  pose.yaw_deg = angle_between(from_.yaw_deg, to_.yaw_deg, s);
  pose.pitch_deg = from_.pitch_deg + (to_.pitch_deg - from_.pitch_deg) * s;
  pose.roll_deg = angle_between(from_.roll_deg, to_.roll_deg, s);
  return kept_clear(pose, ground);
}

}  // namespace vpe::explore
