#include "vpe/explore/walk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

constexpr double kTobler_m_s = 6.0 / 3.6;
constexpr double kStill_m_s = 0.02;   // slower without controls is rest
constexpr double kSettled_m = 0.001;  // of the eye's height

double ground_m(const mars::Pose& pose, const TerrainQuery& ground) {
  return ground.height_m(mars::direction({pose.lon_deg, pose.lat_deg}));
}

// Returns the share of a way that is gone after a time.
double share(double dt_s, double time_constant_s) { return 1.0 - std::exp(-dt_s / time_constant_s); }

}  // namespace

double stride_m_s(double slope) {
  if (slope > std::tan(WalkLimits::kSteepest_deg * mars::kRadiansPerDegree)) return 0.0;
  const double tobler_m_s = kTobler_m_s * std::exp(-3.5 * std::abs(slope + 0.05));
  return slope < 0.0 ? std::max(tobler_m_s, WalkLimits::kScramble_m_s) : tobler_m_s;
}

mars::Pose standing(const mars::Pose& pose, const TerrainQuery& ground) {
  mars::Pose at = pose;
  at.roll_deg = 0;
  at.alt_m = ground_m(pose, ground) + WalkLimits::kEye_m;
  return at;
}

Walker walked(const Walker& walker, const Controls& controls, double dt_s, const TerrainQuery& ground) {
  const double dt = std::clamp(dt_s, 0.0, SteerLimits::kLongestStep_s);
  const bool is_idle = !any(controls) && !is_moving(walker);
  if (!(dt > 0.0) || is_idle) return walker;
  Walker next = walker;
  next.pose = rotated(walker.pose, controls.yaw_right * SteerLimits::kRotation_deg_s * dt,
                      controls.pitch_up * SteerLimits::kRotation_deg_s * dt, 0.0);
  next.is_blocked = false;
  glm::dvec2 wanted(controls.right, controls.forward);
  if (glm::length(wanted) > 1.0) wanted = glm::normalize(wanted);
  const bool walks = wanted != glm::dvec2(0);
  glm::dvec2 goal_m_s(0);
  if (walks) {
    const glm::dvec2 step = glm::normalize(wanted) * WalkLimits::kBase_m;
    const mars::Pose ahead = carried(next.pose, step.x, step.y, ground.radius_m);
    const double rise_m = ground_m(ahead, ground) - ground_m(next.pose, ground);
    const double stride = stride_m_s(rise_m / WalkLimits::kBase_m);
    next.is_blocked = stride == 0.0;
    goal_m_s = wanted * (stride * std::clamp(controls.speed, 0.0, WalkLimits::kFastest));
  }
  const double time_constant_s = next.is_blocked ? WalkLimits::kSlides_s : WalkLimits::kStarts_s;
  next.velocity_m_s += (goal_m_s - next.velocity_m_s) * share(dt, time_constant_s);
  if (goal_m_s == glm::dvec2(0) && glm::length(next.velocity_m_s) < kStill_m_s) next.velocity_m_s = {0, 0};
  if (next.velocity_m_s != glm::dvec2(0))
    next.pose = carried(next.pose, next.velocity_m_s.x * dt, next.velocity_m_s.y * dt, ground.radius_m);
  const double below_m = ground_m(next.pose, ground);
  const double goal_alt_m = below_m + WalkLimits::kEye_m;
  next.pose.alt_m += (goal_alt_m - next.pose.alt_m) * share(dt, WalkLimits::kFollows_s);
  next.pose.alt_m = std::max(next.pose.alt_m, below_m + WalkLimits::kLeastEye_m);
  next.is_settled = std::abs(next.pose.alt_m - goal_alt_m) < kSettled_m;
  if (next.is_settled) next.pose.alt_m = goal_alt_m;
  return next;
}

bool is_moving(const Walker& walker) { return !walker.is_settled || walker.velocity_m_s != glm::dvec2(0); }

}  // namespace vpe::explore
