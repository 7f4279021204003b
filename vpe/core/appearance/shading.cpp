#include "vpe/core/appearance/shading.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vpe::core {

double light(double ambient, double diffuse, double incidence) {
  return std::sqrt(ambient + diffuse * std::max(0.0, incidence));
}

double air_m(double planet_radius_m, double camera_height_m, double up_sine, double distance_m) {
  const double r = planet_radius_m + camera_height_m;
  const auto height = [&](double t) {
    const double rise = camera_height_m * (2 * planet_radius_m + camera_height_m) + t * (2 * r * up_sine + t);
    return rise / (std::sqrt(planet_radius_m * planet_radius_m + rise) + planet_radius_m);
  };
  // The part of the ray below the top of the air.
  const double top = planet_radius_m + kAirTop_m;
  const double half = -r * up_sine;
  const double under = half * half - (r * r - top * top);
  if (under <= 0.0) return 0.0;
  const double begin = std::clamp(half - std::sqrt(under), 0.0, distance_m);
  const double length = std::clamp(half + std::sqrt(under), 0.0, distance_m) - begin;
  double sum = 0;
  for (std::size_t k = 0; k < kAirPoints.size(); ++k) {
    for (const double x : {kAirPoints[k], 1.0 - kAirPoints[k]})
      sum += kAirWeights[k] * std::exp(-height(begin + x * length) / kAirScale_m);
  }
  return length * sum;
}

double transmittance(double air_m, double visibility_m) {
  return visibility_m > 0.0 ? std::exp(-kKoschmieder * air_m / visibility_m) : 1.0;
}

glm::dvec3 haze_colour(const glm::dvec3& haze, double sun_sine) {
  const double s = std::clamp((sun_sine - kDawnSine) / (kDaySine - kDawnSine), 0.0, 1.0);
  const double day = s * s * (3.0 - 2.0 * s);
  return haze * (kNight + (1.0 - kNight) * day);
}

void apply_gamma(std::span<base::Rgb> colours, double gamma) {
  if (gamma == 1.0) return;
  std::array<std::uint8_t, 256> table;
  for (std::size_t n = 0; n < table.size(); ++n) {
    table[n] =
        static_cast<std::uint8_t>(std::lround(255.0 * std::pow(static_cast<double>(n) / 255.0, 1.0 / gamma)));
  }
  for (base::Rgb& c : colours) c = {table[c.r], table[c.g], table[c.b]};
}

}  // namespace vpe::core
