// Tours of virtual globes as flights.
#pragma once

#include <span>

#include "mars/geodesy/kml_way.h"
#include "scripts/flight.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct TourLimits {
  static constexpr double kMinSpeed_m_s = 0.001;
  static constexpr double kMaxSpeed_m_s = 1e6;
  static constexpr double kShortest_s = 0.1;  // of the flight to a view
};

// Returns the flight through the views of a tour: one pose for each. A view without a duration is reached at
// `speed_m_s`, along the straight line. Absolute altitudes count from the planet's sphere. The camera is at least
// SteerLimits::kClearance_m above the ground at each view. Throws std::invalid_argument for points without a view, less
// than two of them, a speed beyond its limits, and flights longer than scripts::FlightLimits::kMaxTime_s. Pure.
scripts::Flight make_tour(std::span<const mars::KmlPoint> points, double speed_m_s, const TerrainQuery& ground);

}  // namespace vpe::explore
