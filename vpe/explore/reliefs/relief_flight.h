// Flights in which reliefs form.
#pragma once

#include <span>

#include "mars/geodesy/pose.h"
#include "relief/spec.h"
#include "scripts/flight.h"

namespace vpe::explore {

// Returns a flight whose camera stays at a pose for some seconds, with the field of view in degrees.
scripts::Flight flight_at(const mars::Pose& pose, double fov_deg, double seconds);

// Returns the flight in which the reliefs also form, in their order, from the ground without them at begin_s to what they are
// at end_s. Reliefs without a name, or with one that a relief of the flight has, get a free one. Throws std::runtime_error with
// what is wrong with the result, and std::invalid_argument unless 0 <= begin_s < end_s.
scripts::Flight with_forming(scripts::Flight flight, std::span<const relief::ReliefSpec> reliefs,
                             double begin_s, double end_s);

}  // namespace vpe::explore
