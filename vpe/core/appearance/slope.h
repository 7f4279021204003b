// Slope and aspect of ground, as colours and queries show them. Pure functions, for any thread.
//
// All vectors are body-fixed and need not have length 1, but none may be 0. `up` is the vertical of the place,
// `north` its north and `east` its east, as mars::local_frame() gives them. At the poles north is the limit
// along the meridian that the place's longitude names, so aspect depends on the longitude there.
#pragma once

#include <glm/vec3.hpp>

namespace vpe::core {

// Returns the degrees between the normal of the ground and the vertical: 0 is flat, 90 a cliff, more an
// overhang. The error is at most 1e-13, also close to 0.
double slope_deg(const glm::dvec3& normal, const glm::dvec3& up);

// Returns the direction of descent: degrees clockwise from north, [0, 360), of the normal's horizontal part.
// Returns NaN for flat ground (slope below 1e-9 degrees, where only rounding decides); a ColourScale shows NaN
// as its low end. `north` and `east` must have equal lengths.
double aspect_deg(const glm::dvec3& normal, const glm::dvec3& up, const glm::dvec3& north,
                  const glm::dvec3& east);

}  // namespace vpe::core
