#include "vpe/core/appearance/sky.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "mars/geodesy/bodies.h"
#include "vpe/core/appearance/shading.h"

namespace vpe::core {

namespace {

constexpr SkyAir kMarsAir;
// Without air the sun's disc remains. Haze that is asked for is grey.
constexpr SkyAir kNoAir{.zenith_depth = 0, .haze = {170, 170, 170}};
constexpr SkyAir kEarthAir{.scale_height_m = 8.5e3,
                           .zenith_depth = 0.2,
                           .lowest_m = -11e3,
                           .zenith = {0.30, 0.50, 0.86},
                           .dust = {0.74, 0.83, 0.94},
                           .glow = {1.0, 0.97, 0.90},
                           .haze = {189, 212, 240}};
constexpr SkyAir kVenusAir{.scale_height_m = 15e3,
                           .zenith_depth = 2,
                           .zenith = {0.80, 0.62, 0.30},
                           .dust = {0.86, 0.70, 0.40},
                           .glow = {0.92, 0.80, 0.52},
                           .haze = {219, 178, 102}};
constexpr SkyAir kTitanAir{.scale_height_m = 40e3,
                           .zenith_depth = 1,
                           .zenith = {0.62, 0.42, 0.16},
                           .dust = {0.74, 0.52, 0.22},
                           .glow = {0.82, 0.62, 0.30},
                           .haze = {189, 133, 56}};

// The colour of plain ground of bodies other than Mars.
constexpr glm::dvec3 kGreyGround{150, 150, 150};

Atmosphere atmosphere_of(std::string_view body) {
  const mars::Body* known = mars::find_body(body);
  if (known == nullptr) return Atmosphere::kNone;
  if (known->name == "Mars") return Atmosphere::kMars;
  if (known->name == "Earth") return Atmosphere::kEarth;
  if (known->name == "Venus") return Atmosphere::kVenus;
  return known->name == "Titan" ? Atmosphere::kTitan : Atmosphere::kNone;
}

}  // namespace

const SkyAir& air_of(Atmosphere atmosphere) {
  switch (atmosphere) {
    case Atmosphere::kNone: return kNoAir;
    case Atmosphere::kEarth: return kEarthAir;
    case Atmosphere::kVenus: return kVenusAir;
    case Atmosphere::kTitan: return kTitanAir;
    case Atmosphere::kAuto:
    case Atmosphere::kMars: break;
  }
  return kMarsAir;
}

void for_body(Appearance& appearance, std::string_view body) {
  const Atmosphere own = atmosphere_of(body);
  if (appearance.atmosphere == Atmosphere::kAuto) appearance.atmosphere = own;
  if (own == Atmosphere::kMars) return;
  appearance.plain_ground = kGreyGround;
  if (appearance.palette == "auto" && appearance.colour == Colour::kElevation) appearance.palette = "grey";
}

double colour_depth(const SkyAir& air, double camera_height_m) {
  const double inside = std::exp(-std::max(camera_height_m, 0.0) / air.scale_height_m);
  return air.zenith_depth * (1.0 + (air.inner_gain - 1.0) * inside);
}

double limb_mass(const SkyAir& air, double planet_radius_m) {
  return std::sqrt(std::numbers::pi * planet_radius_m / (2.0 * air.scale_height_m));
}

glm::dvec3 sky_colour(const SkyAir& air, const glm::dvec3& camera_m, const glm::dvec3& ray,
                      const glm::dvec3& sun, double planet_radius_m) {
  const double camera_radius = glm::length(camera_m);
  const glm::dvec3 up = camera_m / camera_radius;
  const double slope = glm::dot(ray, up);
  const double height = std::max(camera_radius - planet_radius_m, 0.0);
  const double r = planet_radius_m + height;
  // The lowest height of the ray ahead, computed without the difference of two radii.
  double lowest = height;
  if (slope < 0.0) {
    const double drop = slope * slope * r / (1.0 + std::sqrt(std::max(1.0 - slope * slope, 0.0)));
    lowest = std::max(height - drop, air.lowest_m);
  }
  const double limb = limb_mass(air, planet_radius_m);
  double mass = 1.0 / (std::max(slope, 0.0) + 1.0 / limb);
  if (slope < 0.0)
    mass = glm::mix(limb, 2.0 * limb, std::clamp((height - lowest) / air.scale_height_m, 0.0, 1.0));
  const double density = std::exp(-lowest / air.scale_height_m) * mass;
  const double depth = colour_depth(air, height) * density;
  const glm::dvec3 place = glm::normalize(up * r + ray * (std::max(-slope, 0.0) * r));
  const double day = glm::smoothstep(kDawnSine, kDaySine, glm::dot(sun, place));
  const double glow = std::pow(std::max(glm::dot(ray, sun), 0.0), 24.0);
  const glm::dvec3 dust = glm::mix(air.dust, air.glow, glow);
  const double veil = 1.0 - std::exp(-depth);
  const glm::dvec3 colour = glm::mix(air.zenith, dust, std::clamp(depth * 0.5, 0.0, 1.0));
  const glm::dvec3 c = colour * (veil * (kNight + (1.0 - kNight) * day));
  const double disc = glm::smoothstep(air.disc_rim, air.disc_full, glm::dot(ray, sun));
  return 255.0 * glm::mix(c, air.sun, disc * std::exp(-0.3 * air.zenith_depth * density));
}

}  // namespace vpe::core
