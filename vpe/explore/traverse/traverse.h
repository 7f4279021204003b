// Traverses: a flight of a walker, a vehicle or a camera at a height along a way over the surface.
//
// The way consists of great circles between its points. It is sampled at equal steps within each of them, so every
// point is a pose. The heading turns at the points, over a distance on either side: 1 m for the walker, the turning
// radius for the vehicle, a step for the camera. Poses have their height above the ground, so that a flight follows the
// exaggeration with which it is drawn; the attitude is that on the ground as given.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "mars/geodesy/sphere.h"
#include "scripts/flight.h"
#include "vpe/explore/terrain_query.h"
#include "vpe/explore/vehicle.h"

namespace vpe::explore {

enum class TraverseBy : std::uint8_t {
  kWalk,    // level eye at the height of a man; looks along the ground 10 m ahead; speed by the slope (walk.h)
  kDrive,   // the camera of a vehicle, with the attitude of its plane of contact
  kHeight,  // a camera at a constant height above the ground, looking ahead to the horizon
};

struct TraverseOptions {
  static constexpr double kMinSpeed_m_s = 0.001;
  static constexpr double kMaxSpeed_m_s = 1e6;
  static constexpr double kMinEye_m = 0.1;
  static constexpr double kMaxEye_m = 1e7;
  static constexpr double kMinStep_m = 0.1;
  static constexpr double kMaxStep_m = 1e6;
  static constexpr std::size_t kMostPoses = 200'000;
  static constexpr double kUsualPoses = 20'000;  // that the default of the step does not exceed by much

  TraverseBy by = TraverseBy::kWalk;
  std::optional<double> speed_m_s;        // walk: on level ground; default: 1.4, vehicle.speed_m_s, 50
  std::optional<double> camera_height_m;  // above the ground; default: 1.7, vehicle.mast_m, 100
  // Between poses. Smaller: follows the ground more closely, larger files. Default: 2, 1 and a quarter of camera_height_m, but
  // at least a kUsualPoses-th of the way.
  std::optional<double> step_m;
  VehicleOptions vehicle;  // camera_height_m replaces its mast
};

struct Traverse {
  scripts::Flight flight;
  double length_m = 0;  // on the planet's sphere
  double duration_s = 0;
  double steepest_deg =
      0;  // of the ground along the way for the walker and the camera, of the plane of the vehicle
  mars::LonLat steepest_at;
  double limit_deg = 0;       // that the walker climbs, or the vehicle stands; 0: none
  std::size_t too_steep = 0;  // number of poses beyond the limit, which are in the flight all the same
};

// Computes the flight along places. Successive equal places count once. Throws std::invalid_argument, which says what to
// change, for fewer than two different places, opposite successive places, options beyond their limits, more than
// kMostPoses poses and flights longer than scripts::FlightLimits::kMaxTime_s. Pure.
Traverse make_traverse(std::span<const mars::LonLat> places, const TraverseOptions& options,
                       const TerrainQuery& ground);

}  // namespace vpe::explore
