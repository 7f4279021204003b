// The sky of Mars: an image, not radiometry. Every backend draws this one.
#pragma once

#include <glm/vec3.hpp>

namespace vpe::core {

// What the sky is made of, colours 0 to 1.
struct SkyAir {
  double scale_height_m = 11e3;
  double zenith_depth = 0.25;           // optical depth from the sphere straight up
  double lowest_m = -8e3;               // no ray passes lower
  glm::dvec3 zenith{0.62, 0.48, 0.37};  // thin air
  glm::dvec3 dust{0.83, 0.68, 0.53};    // thick air
  glm::dvec3 glow{0.93, 0.86, 0.80};    // thick air before the sun
  glm::dvec3 sun{1.0, 0.98, 0.94};
  double disc_rim = 0.99999;  // cosines between which the sun's disc fades
  double disc_full = 0.999995;
};
inline constexpr SkyAir kSkyAir;

// Air that a horizontal ray passes from the sphere on, in times of that straight up.
double limb_mass(double planet_radius_m);

// A thin exponential atmosphere of dust over a black sky: optical depth from the height where the ray passes
// lowest and a bounded air mass. Colour, 0 to 255, along a unit ray that meets no ground. camera_m: from the
// planet's centre.
glm::dvec3 sky_colour(const glm::dvec3& camera_m, const glm::dvec3& ray, const glm::dvec3& sun,
                      double planet_radius_m);

}  // namespace vpe::core
