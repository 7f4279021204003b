#include "vpe/core/sky.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace vpe::core {

glm::dvec3 sky_colour(const glm::dvec3& eye_m, const glm::dvec3& ray, const glm::dvec3& sun,
                      double planet_radius_m) {
  constexpr double kScaleHeight_m = 11e3;
  constexpr double kZenithDepth = 0.25;
  const double eye_radius = glm::length(eye_m);
  const glm::dvec3 up = eye_m / eye_radius;
  const double slope = glm::dot(ray, up);
  const double height = std::max(eye_radius - planet_radius_m, 0.0);
  const double r = planet_radius_m + height;
  // Height of the lowest point of the ray ahead; written without the difference of two radii.
  double lowest = height;
  if (slope < 0.0) {
    const double drop = slope * slope * r / (1.0 + std::sqrt(std::max(1.0 - slope * slope, 0.0)));
    lowest = std::max(height - drop, -8e3);
  }
  const double limb = std::sqrt(std::numbers::pi * planet_radius_m / (2.0 * kScaleHeight_m));
  double mass = 1.0 / (std::max(slope, 0.0) + 1.0 / limb);
  if (slope < 0.0) mass = glm::mix(limb, 2.0 * limb, std::clamp((height - lowest) / kScaleHeight_m, 0.0, 1.0));
  const double depth = kZenithDepth * std::exp(-lowest / kScaleHeight_m) * mass;
  const glm::dvec3 place = glm::normalize(up * r + ray * (std::max(-slope, 0.0) * r));
  const double day = glm::smoothstep(-0.15, 0.3, glm::dot(sun, place));
  const double glow = std::pow(std::max(glm::dot(ray, sun), 0.0), 24.0);
  const glm::dvec3 dust = glm::mix(glm::dvec3(0.83, 0.68, 0.53), glm::dvec3(0.93, 0.86, 0.80), glow);
  const glm::dvec3 zenith(0.62, 0.48, 0.37);
  const double veil = 1.0 - std::exp(-depth);
  const glm::dvec3 air = glm::mix(zenith, dust, std::clamp(depth * 0.5, 0.0, 1.0));
  const glm::dvec3 c = air * (veil * (0.08 + 0.92 * day));
  const double disc = glm::smoothstep(0.99999, 0.999995, glm::dot(ray, sun));
  return 255.0 * glm::mix(c, glm::dvec3(1.0, 0.98, 0.94), disc * std::exp(-0.3 * depth));
}

}  // namespace vpe::core
