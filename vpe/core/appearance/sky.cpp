#include "vpe/core/appearance/sky.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "vpe/core/appearance/shading.h"

namespace vpe::core {

double limb_mass(double planet_radius_m) {
  return std::sqrt(std::numbers::pi * planet_radius_m / (2.0 * kSkyAir.scale_height_m));
}

glm::dvec3 sky_colour(const glm::dvec3& camera_m, const glm::dvec3& ray, const glm::dvec3& sun,
                      double planet_radius_m) {
  constexpr const SkyAir& kAir = kSkyAir;
  const double camera_radius = glm::length(camera_m);
  const glm::dvec3 up = camera_m / camera_radius;
  const double slope = glm::dot(ray, up);
  const double height = std::max(camera_radius - planet_radius_m, 0.0);
  const double r = planet_radius_m + height;
  // The lowest height of the ray ahead, computed without the difference of two radii.
  double lowest = height;
  if (slope < 0.0) {
    const double drop = slope * slope * r / (1.0 + std::sqrt(std::max(1.0 - slope * slope, 0.0)));
    lowest = std::max(height - drop, kAir.lowest_m);
  }
  const double limb = limb_mass(planet_radius_m);
  double mass = 1.0 / (std::max(slope, 0.0) + 1.0 / limb);
  if (slope < 0.0)
    mass = glm::mix(limb, 2.0 * limb, std::clamp((height - lowest) / kAir.scale_height_m, 0.0, 1.0));
  const double depth = kAir.zenith_depth * std::exp(-lowest / kAir.scale_height_m) * mass;
  const glm::dvec3 place = glm::normalize(up * r + ray * (std::max(-slope, 0.0) * r));
  const double day = glm::smoothstep(kDawnSine, kDaySine, glm::dot(sun, place));
  const double glow = std::pow(std::max(glm::dot(ray, sun), 0.0), 24.0);
  const glm::dvec3 dust = glm::mix(kAir.dust, kAir.glow, glow);
  const double veil = 1.0 - std::exp(-depth);
  const glm::dvec3 air = glm::mix(kAir.zenith, dust, std::clamp(depth * 0.5, 0.0, 1.0));
  const glm::dvec3 c = air * (veil * (kNight + (1.0 - kNight) * day));
  const double disc = glm::smoothstep(kAir.disc_rim, kAir.disc_full, glm::dot(ray, sun));
  return 255.0 * glm::mix(c, kAir.sun, disc * std::exp(-0.3 * depth));
}

}  // namespace vpe::core
