#include "vpe/core/appearance/slope.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/geodesy/sphere.h"

namespace vpe::core {

namespace {

constexpr double kFlat_deg = 1e-9;

}  // namespace

double slope_deg(const glm::dvec3& normal, const glm::dvec3& up) {
  return std::atan2(glm::length(glm::cross(normal, up)), glm::dot(normal, up)) / mars::kRadiansPerDegree;
}

double aspect_deg(const glm::dvec3& normal, const glm::dvec3& up, const glm::dvec3& north,
                  const glm::dvec3& east) {
  if (slope_deg(normal, up) < kFlat_deg) return std::numeric_limits<double>::quiet_NaN();
  const double clockwise =
      std::atan2(glm::dot(normal, east), glm::dot(normal, north)) / mars::kRadiansPerDegree;
  const double turned = clockwise < 0 ? clockwise + 360 : clockwise;
  return turned < 360 ? turned : 0;
}

}  // namespace vpe::core
