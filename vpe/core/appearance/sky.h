// The sky as both backends draw it: plausible colours, not radiometry.
#pragma once

#include <glm/vec3.hpp>
#include <string_view>

#include "vpe/core/appearance/appearance.h"

namespace vpe::core {

// The constants of an atmosphere; colours 0 to 1.
struct SkyAir {
  double scale_height_m = 11e3;
  double zenith_depth = 0.25;  // optical depth from the sphere straight up; 0: a black sky
  // Light that is scattered more than once brightens the sky for a camera within the air: there the optical
  // depth that makes colours is larger by this factor, less 1, and falls with the density.
  double inner_gain = 6;
  double lowest_m = -8e3;               // no ray passes lower
  glm::dvec3 zenith{0.62, 0.48, 0.37};  // thin air
  glm::dvec3 dust{0.83, 0.68, 0.53};    // thick air
  glm::dvec3 glow{0.93, 0.86, 0.80};    // thick air before the sun
  glm::dvec3 sun{1.0, 0.98, 0.94};
  double disc_rim = 0.99999;  // cosines between which the sun's disc fades out
  double disc_full = 0.999995;
  glm::dvec3 haze{212, 173, 135};  // 0 to 255, shading.h
};

// Returns the air of an atmosphere; that of Mars for kAuto, which for_body() replaces.
const SkyAir& air_of(Atmosphere atmosphere);

// Replaces what an appearance leaves to the body of the planet, named as in its planet file: the atmosphere
// `auto`, the palette `auto` of elevations and the colour of plain ground. Bodies other than Mars have neutral
// greys; those without air (all but Mars, Earth, Venus and Titan) a black sky. A second call changes nothing.
void for_body(Appearance& appearance, std::string_view body);

// Returns the optical depth that makes the colours of the sky straight up, for a camera at this height above
// the sphere (0 if below).
double colour_depth(const SkyAir& air, double camera_height_m);

// Returns the air mass of a horizontal ray that starts at the sphere, relative to that of a vertical ray.
double limb_mass(const SkyAir& air, double planet_radius_m);

// Returns the colour, 0 to 255, along a unit ray that meets no ground. The model is a thin exponential
// atmosphere over a black sky: the optical depth follows from the lowest height of the ray and a
// bounded air mass. camera_m is relative to the planet's centre.
glm::dvec3 sky_colour(const SkyAir& air, const glm::dvec3& camera_m, const glm::dvec3& ray,
                      const glm::dvec3& sun, double planet_radius_m);

}  // namespace vpe::core
