#include "vpe/explore/vehicle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/base/number.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

constexpr double kAccelerates_s = 0.3;  // time constant of the speed
constexpr double kStands_m_s = 0.005;   // slower without controls is rest

double degrees(double angle_rad) { return angle_rad / mars::kRadiansPerDegree; }

mars::Pose camera_pose(mars::LonLat place, double heading_deg, const Contact& c, double mast_m) {
  return {place.lon_deg, place.lat_deg, std::max(c.plane_m, c.ground_m) + mast_m,
          heading_deg,   c.pitch_deg,   c.roll_deg};
}

}  // namespace

std::string problem(const VehicleOptions& options) {
  using O = VehicleOptions;
  if (options.wheels < O::kMinWheels || options.wheels > O::kMaxWheels || options.wheels % 2 != 0)
    return "the number of wheels must be even, from " + std::to_string(O::kMinWheels) + " to " +
           std::to_string(O::kMaxWheels);
  struct Range {
    const char* name;
    double value;
    double least;
    double most;
  };
  for (const Range& r :
       {Range{"the length", options.length_m, O::kMinSize_m, O::kMaxSize_m},
        Range{"the width", options.width_m, O::kMinSize_m, O::kMaxSize_m},
        Range{"the height of the mast", options.mast_m, O::kMinSize_m, O::kMaxMast_m},
        Range{"the steepest slope", options.steepest_deg, 1, O::kMaxSteepest_deg},
        Range{"the speed", options.speed_m_s, O::kMinSpeed_m_s, O::kMaxSpeed_m_s},
        Range{"the limit of the speed", options.fastest_m_s, O::kMinSpeed_m_s, O::kMaxSpeed_m_s},
        Range{"the turning radius", options.turning_radius_m, O::kMinSize_m, O::kMaxTurningRadius_m}}) {
    if (r.value >= r.least && r.value <= r.most) continue;
    return std::string(r.name) + " must be from " + base::format_number(r.least) + " to " +
           base::format_number(r.most);
  }
  return {};
}

Contact contact(mars::LonLat place, double heading_deg, const VehicleOptions& options,
                const TerrainQuery& ground) {
  const mars::LocalFrame frame = mars::local_frame(place);
  const mars::SinCos h = mars::sin_cos_deg(heading_deg);
  const glm::dvec3 ahead = frame.north * h.cos + frame.east * h.sin;
  const glm::dvec3 right = frame.east * h.cos - frame.north * h.sin;
  Contact c;
  c.ground_m = ground.height_m(frame.up);
  const glm::dvec3 middle_m = frame.up * (ground.radius_m + c.ground_m);

  // The wheels are symmetric about the middle, so the normal equations are diagonal.
  struct Wheel {
    double x_m;
    double y_m;
    double height_m;
  };
  std::array<Wheel, VehicleOptions::kMaxWheels> wheels{};
  const auto count = static_cast<std::size_t>(options.wheels);
  const double axles = options.wheels / 2;
  double sum = 0;
  double sum_xh = 0;
  double sum_yh = 0;
  double sum_xx = 0;
  double sum_yy = 0;
  for (std::size_t n = 0; n < count; ++n) {
    Wheel& w = wheels[n];
    w.x_m = (n % 2 == 0 ? -0.5 : 0.5) * options.width_m;
    w.y_m = options.length_m * (static_cast<double>(n / 2) / (axles - 1.0) - 0.5);
    w.height_m = ground.height_m(middle_m + right * w.x_m + ahead * w.y_m);
    sum += w.height_m;
    sum_xh += w.x_m * w.height_m;
    sum_yh += w.y_m * w.height_m;
    sum_xx += w.x_m * w.x_m;
    sum_yy += w.y_m * w.y_m;
  }
  c.plane_m = sum / options.wheels;
  const double along = sum_yh / sum_yy;
  const double across = sum_xh / sum_xx;
  for (std::size_t n = 0; n < count; ++n) {
    const double plane_m = c.plane_m + across * wheels[n].x_m + along * wheels[n].y_m;
    c.residual_m = std::max(c.residual_m, std::abs(wheels[n].height_m - plane_m));
  }
  c.pitch_deg = degrees(std::atan(along));
  c.roll_deg = degrees(std::atan2(-across, std::hypot(1.0, along)));
  c.slope_deg = degrees(std::atan(std::hypot(along, across)));
  return c;
}

Vehicle placed(mars::LonLat place, double heading_deg, const VehicleOptions& options,
               const TerrainQuery& ground) {
  Vehicle vehicle;
  vehicle.contact = contact(place, heading_deg, options, ground);
  vehicle.pose = camera_pose(place, heading_deg, vehicle.contact, options.mast_m);
  return vehicle;
}

Vehicle driven(const Vehicle& vehicle, const Controls& controls, double dt_s, const VehicleOptions& options,
               const TerrainQuery& ground) {
  const double dt = std::clamp(dt_s, 0.0, SteerLimits::kLongestStep_s);
  if (!(dt > 0.0) || (controls.forward == 0 && vehicle.speed_m_s == 0)) return vehicle;
  const double full_m_s = std::min(options.speed_m_s * std::max(controls.speed, 0.0), options.fastest_m_s);
  const double goal_m_s = std::clamp(controls.forward, -1.0, 1.0) * full_m_s;
  Vehicle next = vehicle;
  next.is_blocked = false;
  next.speed_m_s += (goal_m_s - vehicle.speed_m_s) * (1.0 - std::exp(-dt / kAccelerates_s));
  if (goal_m_s == 0 && std::abs(next.speed_m_s) < kStands_m_s) next.speed_m_s = 0;
  const double way_m = next.speed_m_s * dt;
  const double turn_deg = degrees(way_m / options.turning_radius_m) * std::clamp(controls.right, -1.0, 1.0);
  mars::Pose to = rotated(vehicle.pose, turn_deg, 0, 0);
  to = carried(to, 0, way_m, ground.radius_m);
  const mars::LonLat place{to.lon_deg, to.lat_deg};
  next.contact = contact(place, to.yaw_deg, options, ground);
  const bool descends =
      vehicle.contact.slope_deg > options.steepest_deg && next.contact.plane_m <= vehicle.contact.plane_m;
  if (next.contact.slope_deg > options.steepest_deg && !descends) {
    next = vehicle;
    next.speed_m_s = 0;
    next.is_blocked = true;
    return next;
  }
  next.pose = camera_pose(place, to.yaw_deg, next.contact, options.mast_m);
  return next;
}

}  // namespace vpe::explore
