// A vehicle with wheels on the surface as drawn: it stands on the plane of contact of its wheels, which gives roll
// and pitch of the camera on its mast.
//
// The plane of contact is the plane with the least squares of the vertical distances to S at the wheels. A wheel
// may be above or below it by Contact::residual_m, as the suspension takes up. The camera is mast_m above the
// higher of the plane and S in the vehicle's middle, so at least mast_m above S.
//
// Typical usage:
//   const VehicleOptions options;
//   Vehicle vehicle = placed({137.4, -4.6}, 90, options, ground);
//   vehicle = driven(vehicle, controls, dt_s, options, ground);  // in each frame
#pragma once

#include <string>

#include "mars/geodesy/pose.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

// Describes a vehicle. The wheels stand in two rows, evenly from the first axle to the last one.
struct VehicleOptions {
  static constexpr int kMinWheels = 4;
  static constexpr int kMaxWheels = 20;
  static constexpr double kMinSize_m = 0.2;
  static constexpr double kMaxSize_m = 50;
  static constexpr double kMaxMast_m = 50;
  static constexpr double kMaxSteepest_deg = 60;
  static constexpr double kMinSpeed_m_s = 0.001;
  static constexpr double kMaxSpeed_m_s = 50;
  static constexpr double kMaxTurningRadius_m = 1000;

  int wheels = 6;            // even
  double length_m = 2.7;     // from the first axle to the last one
  double width_m = 2.2;      // between the two rows
  double mast_m = 2.0;       // height of the camera; at least kMinSize_m
  double steepest_deg = 30;  // slope of the plane of contact at which it stops
  double speed_m_s = 2;      // at full deflection
  double fastest_m_s = 10;   // limit with Controls::speed
  double turning_radius_m = 3;
};

// Returns which option is beyond its limits and what is allowed, or "".
std::string problem(const VehicleOptions& options);

// Describes how a vehicle stands at a place with a heading.
struct Contact {
  double plane_m = 0;     // height of the plane above the sphere, in the vehicle's middle
  double ground_m = 0;    // height of S there
  double pitch_deg = 0;   // of the vehicle: positive: the front is up
  double roll_deg = 0;    // positive: the right side is down
  double slope_deg = 0;   // of the plane, 0 to 90
  double residual_m = 0;  // largest vertical distance of S from the plane at a wheel
};

// Computes the contact. One query of the ground for each wheel and one for the middle. Options are within their
// limits. Pure.
Contact contact(mars::LonLat place, double heading_deg, const VehicleOptions& options,
                const TerrainQuery& ground);

// Holds a vehicle. The pose is that of the camera on the mast, looking ahead.
struct Vehicle {
  mars::Pose pose;
  Contact contact;
  double speed_m_s = 0;     // negative: backwards
  bool is_blocked = false;  // by a slope that is too steep
};

// Returns a vehicle that stands at a place, whatever the slope.
Vehicle placed(mars::LonLat place, double heading_deg, const VehicleOptions& options,
               const TerrainQuery& ground);

// Drives for dt_s seconds (at most SteerLimits::kLongestStep_s). `forward` drives; `right` steers: at full
// deflection the vehicle goes in a circle of the turning radius, also backwards. Other rates are ignored. A step to
// where the plane is steeper than the limit is refused, and the vehicle stops; one that was put on such ground may
// still go down. Queries the ground as contact() does once, and not at all at rest. Pure.
Vehicle driven(const Vehicle& vehicle, const Controls& controls, double dt_s, const VehicleOptions& options,
               const TerrainQuery& ground);

}  // namespace vpe::explore
