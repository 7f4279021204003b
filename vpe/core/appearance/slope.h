// Slope and aspect of ground, as colours and queries show them. Pure functions, for any thread.
//
// All vectors are body-fixed and need not have length 1, but none may be 0. `up` is the vertical of the place,
// `north` its north and `east` its east, as mars::local_frame gives them: at the poles north is the limit along
// the meridian that the place's longitude names, so aspect depends on it there.
#pragma once

#include <glm/vec3.hpp>

namespace vpe::core {

// Degrees between the normal of the ground and the vertical: 0 flat, 90 a wall, above that an overhang. Within
// 1e-13, also close to 0.
double slope_deg(const glm::dvec3& normal, const glm::dvec3& up);

// Which way is down: degrees clockwise from north, [0, 360), of the normal's part along the horizontal. Flat
// ground (slope below 1e-9 degrees, where rounding is all there is) has none: NaN, which a ColourScale shows as
// its low end. north and east of equal length.
double aspect_deg(const glm::dvec3& normal, const glm::dvec3& up, const glm::dvec3& north,
                  const glm::dvec3& east);

}  // namespace vpe::core
