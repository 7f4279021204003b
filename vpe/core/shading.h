// What light and air do to colours: the definition that every backend draws. Pure.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "mars/source.h"
#include "vpe/core/appearance.h"

namespace vpe::core {

// Colour, 0 to 255, of ground that shows no other.
inline constexpr glm::dvec3 kPlainGround{178, 142, 112};

// Factor on a colour: the square root, which stands for a display's gamma, of ambient + diffuse * incidence, where
// incidence is the cosine between normal and sun, 0 where that is negative or the sun is hidden. More than 1 is
// possible; colours are cut at 255 at the very end.
double light(double ambient, double diffuse, double incidence);

// Of Koschmieder's law: -ln 0.02.
inline constexpr double kKoschmieder = 3.912;

// What is left of a colour's contrast at a distance: 2 % at the visibility (exp(-kKoschmieder d / V)); 1 for
// visibility 0, clear air.
double transmittance(double distance_m, double visibility_m);

// Colour of far ground and of the sky at the horizon, for the sun's height over it at the eye (sine).
glm::dvec3 haze_colour(double sun_sine);

// x^(1 / gamma) on every channel, in place.
void apply_gamma(std::span<mars::Rgb> colours, double gamma);

}  // namespace vpe::core
