#include "vpe/explore/foresight.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"

namespace vpe::explore {

namespace {

double turned(double before_deg, double now_deg, double steps) {
  constexpr double kMost_deg = 90;
  return now_deg + std::clamp(std::remainder(now_deg - before_deg, 360.0) * steps, -kMost_deg, kMost_deg);
}

}  // namespace

std::optional<mars::Pose> foreseen(const Motion& motion, double ahead_s) {
  if (!(motion.dt_s > 0) || motion.dt_s > kLongestStep_s || !(ahead_s > 0)) return std::nullopt;
  const mars::Pose& before = motion.before;
  const mars::Pose& now = motion.now;
  const glm::dvec3 from = mars::direction({before.lon_deg, before.lat_deg});
  const glm::dvec3 to = mars::direction({now.lon_deg, now.lat_deg});
  const double angle_rad = mars::angle_between_rad(from, to);
  const bool rests = angle_rad == 0 && before.alt_m == now.alt_m && before.yaw_deg == now.yaw_deg &&
                     before.pitch_deg == now.pitch_deg;
  if (rests) return std::nullopt;
  const double steps = ahead_s / motion.dt_s;
  mars::Pose later = now;
  if (angle_rad > 0) {
    const double further_rad = std::min(angle_rad * steps, kFarthest_rad);
    const glm::dvec3 ahead = glm::normalize(to * std::cos(angle_rad) - from);
    const glm::dvec3 place = std::cos(further_rad) * to + std::sin(further_rad) * ahead;
    const mars::LonLat at = mars::lon_lat(place);
    later.lon_deg = at.lon_deg;
    later.lat_deg = at.lat_deg;
  }
  // A camera that sinks is not foreseen below half of its height above the sphere.
  const double climb_m = (now.alt_m - before.alt_m) * steps;
  later.alt_m = std::max(now.alt_m + climb_m, std::min(now.alt_m, 0.5 * now.alt_m));
  later.yaw_deg = turned(before.yaw_deg, now.yaw_deg, steps);
  later.pitch_deg = std::clamp(turned(before.pitch_deg, now.pitch_deg, steps), -90.0, 90.0);
  return later;
}

}  // namespace vpe::explore
