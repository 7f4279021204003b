// The sky of Mars: a picture, not radiometry. Every backend draws this one.
#pragma once

#include <glm/vec3.hpp>

namespace vpe::core {

// A thin exponential atmosphere of dust over a black sky: optical depth from the height where the ray passes
// lowest and a bounded air mass. Colour, 0 to 255, along a unit ray that meets no ground. eye_m: from the
// planet's centre.
glm::dvec3 sky_colour(const glm::dvec3& eye_m, const glm::dvec3& ray, const glm::dvec3& sun,
                      double planet_radius_m);

}  // namespace vpe::core
