// The sky of Mars as both backends draw it: plausible colours, not radiometry.
#pragma once

#include <glm/vec3.hpp>

namespace vpe::core {

// The constants of the sky's atmosphere; colours 0 to 1.
struct SkyAir {
  double scale_height_m = 11e3;
  double zenith_depth = 0.25;           // optical depth from the sphere straight up
  double lowest_m = -8e3;               // no ray passes lower
  glm::dvec3 zenith{0.62, 0.48, 0.37};  // thin air
  glm::dvec3 dust{0.83, 0.68, 0.53};    // thick air
  glm::dvec3 glow{0.93, 0.86, 0.80};    // thick air before the sun
  glm::dvec3 sun{1.0, 0.98, 0.94};
  double disc_rim = 0.99999;  // cosines between which the sun's disc fades out
  double disc_full = 0.999995;
};
inline constexpr SkyAir kSkyAir;

// Returns the air mass of a horizontal ray that starts at the sphere, relative to that of a vertical ray.
double limb_mass(double planet_radius_m);

// Returns the colour, 0 to 255, along a unit ray that meets no ground. The model is a thin exponential
// atmosphere of dust over a black sky: the optical depth follows from the lowest height of the ray and a
// bounded air mass. camera_m is relative to the planet's centre.
glm::dvec3 sky_colour(const glm::dvec3& camera_m, const glm::dvec3& ray, const glm::dvec3& sun,
                      double planet_radius_m);

}  // namespace vpe::core
