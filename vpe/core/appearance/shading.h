// Light, haze and gamma: the definitions that both backends draw. All functions are pure.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "vpe/base/rgb.h"
#include "vpe/core/appearance/appearance.h"

namespace vpe::core {

// Returns the factor on a colour: the square root, which stands for a display's gamma, of ambient + diffuse *
// incidence. `incidence` is the cosine between normal and sun, or 0 if that is negative or the sun is hidden.
// The factor may exceed 1; colours are clipped at 255 at the very end.
double light(double ambient, double diffuse, double incidence);

// The constant of Koschmieder's law, -ln 0.02.
inline constexpr double kKoschmieder = 3.912;

// The density of dust falls by e for every kAirScale_m above the sphere, and is 0 above kAirTop_m.
inline constexpr double kAirScale_m = 11000;
inline constexpr double kAirTop_m = 6 * kAirScale_m;

// Points and weights of the six-point Gauss-Legendre rule on [0, 1] that air_m() uses; the other half is
// symmetric.
inline constexpr std::array<double, 3> kAirPoints{0.033765242898423987, 0.169395306766867743,
                                                  0.380690406958401546};
inline constexpr std::array<double, 3> kAirWeights{0.0856622461895851725, 0.1803807865240693038,
                                                   0.2339569672863455237};

// Returns the length of a path through air as dense as at the sphere that dims as much as the path from a
// camera to a point: the integral of exp(-height / kAirScale_m) over the part below kAirTop_m. up_sine is the
// sine of the direction's elevation at the camera. The relative error is at most kAirError (and a micrometre)
// for cameras between -8 km and ten radii and points above -8 km; over a limb, where the path falls and rises
// again, it is at most kAirLimbError, which changes no colour by 1/255.
inline constexpr double kAirError = 1e-5;
inline constexpr double kAirLimbError = 0.01;
double air_m(double planet_radius_m, double camera_height_m, double up_sine, double distance_m);

// Returns the share of a colour's contrast that is left behind this much air: exp(-kKoschmieder air /
// visibility), which is 2 % at the visibility. Returns 1 for visibility 0, clear air.
double transmittance(double air_m, double visibility_m);

// Dust is dark if the sine of the sun's elevation is below kDawnSine, and in full light above kDaySine. The
// share kNight of the light always remains.
inline constexpr double kDawnSine = -0.15;
inline constexpr double kDaySine = 0.3;
inline constexpr double kNight = 0.08;

// Returns the colour that haze adds to ground for this sine of the sun's elevation at that ground. `haze` is its
// colour in full light (SkyAir::haze).
glm::dvec3 haze_colour(const glm::dvec3& haze, double sun_sine);

// Replaces each channel x by x^(1 / gamma).
void apply_gamma(std::span<base::Rgb> colours, double gamma);

}  // namespace vpe::core
