// What light and air do to colours: the definition that every backend draws. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "mars/sources/source.h"
#include "vpe/core/appearance/appearance.h"

namespace vpe::core {

// Colour, 0 to 255, of ground that shows no other.
inline constexpr glm::dvec3 kPlainGround{178, 142, 112};

// Factor on a colour: the square root, which stands for a display's gamma, of ambient + diffuse * incidence,
// where incidence is the cosine between normal and sun, 0 where that is negative or the sun is hidden. More
// than 1 is possible; colours are cut at 255 at the very end.
double light(double ambient, double diffuse, double incidence);

// Of Koschmieder's law: -ln 0.02.
inline constexpr double kKoschmieder = 3.912;

// Dust thins out with height: by e every kAirScale_m above the sphere.
inline constexpr double kAirScale_m = 11000;
inline constexpr double kAirTop_m = 6 * kAirScale_m;  // nothing above

// Six points and weights of Gauss and Legendre on [0, 1] carry air_m(); the other half lies opposite.
inline constexpr std::array<double, 3> kAirPoints{0.033765242898423987, 0.169395306766867743,
                                                  0.380690406958401546};
inline constexpr std::array<double, 3> kAirWeights{0.0856622461895851725, 0.1803807865240693038,
                                                   0.2339569672863455237};

// How long a way through air as dense as at the sphere dims as much as the way from a camera to a point: the
// integral of exp(-height / kAirScale_m) over the part of it below kAirTop_m. up_sine: of the direction over
// the camera's horizontal. Relative error at most kAirError (and a micrometre) from eyes between -8 km and ten
// radii, to any point above -8 km; over a limb (the way falls and rises again) kAirLimbError, with which no
// colour is 1/255 off.
inline constexpr double kAirError = 1e-5;
inline constexpr double kAirLimbError = 0.01;
double air_m(double planet_radius_m, double camera_height_m, double up_sine, double distance_m);

// What is left of a colour's contrast behind so much air: 2 % at the visibility (exp(-kKoschmieder air / V)); 1
// for visibility 0, clear air.
double transmittance(double air_m, double visibility_m);

// Colour of dust in full light.
inline constexpr glm::dvec3 kDust{212, 173, 135};

// Dust is dark where the sun stands below kDawnSine, in full light above kDaySine (sines of its height); kNight
// of the light is always left.
inline constexpr double kDawnSine = -0.15;
inline constexpr double kDaySine = 0.3;
inline constexpr double kNight = 0.08;

// Colour that haze puts over ground where the sun stands so high (sine).
glm::dvec3 haze_colour(double sun_sine);

// x^(1 / gamma) on every channel, in place.
void apply_gamma(std::span<base::Rgb> colours, double gamma);

}  // namespace vpe::core
