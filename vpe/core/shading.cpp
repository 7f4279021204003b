#include "vpe/core/shading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace vpe::core {

namespace {

constexpr double kDegrees = 57.295779513082320877;

}  // namespace

double light(double ambient, double diffuse, double incidence) {
  return std::sqrt(ambient + diffuse * std::max(0.0, incidence));
}

double slope_deg(const glm::dvec3& normal, const glm::dvec3& up) {
  return kDegrees * std::atan2(glm::length(glm::cross(normal, up)), glm::dot(normal, up));
}

double aspect_deg(const glm::dvec3& normal, const glm::dvec3& up) {
  constexpr double kLevel = 1e-9;
  const double flat = std::hypot(up.x, up.y);
  const glm::dvec3 east = flat > 0.0 ? glm::dvec3(-up.y, up.x, 0) / flat : glm::dvec3(0, 1, 0);
  const glm::dvec3 north = glm::cross(up, east);
  const double x = glm::dot(normal, east);
  const double y = glm::dot(normal, north);
  if (std::hypot(x, y) < kLevel) return 0.0;
  const double angle = kDegrees * std::atan2(x, y);
  return angle < 0.0 ? std::min(angle + 360.0, std::nextafter(360.0, 0.0)) : angle;
}

double transmittance(double distance_m, double visibility_m) {
  return visibility_m > 0.0 ? std::exp(-kKoschmieder * distance_m / visibility_m) : 1.0;
}

glm::dvec3 haze_colour(double sun_sine) {
  const double s = std::clamp((sun_sine + 0.15) / 0.45, 0.0, 1.0);
  const double day = s * s * (3.0 - 2.0 * s);
  return glm::dvec3(212, 173, 135) * (0.08 + 0.92 * day);
}

void apply_gamma(std::span<mars::Rgb> colours, double gamma) {
  if (gamma == 1.0) return;
  std::array<std::uint8_t, 256> table;
  for (std::size_t n = 0; n < table.size(); ++n) {
    table[n] = static_cast<std::uint8_t>(std::lround(255.0 * std::pow(static_cast<double>(n) / 255.0, 1.0 / gamma)));
  }
  for (mars::Rgb& c : colours) c = {table[c.r], table[c.g], table[c.b]};
}

}  // namespace vpe::core
