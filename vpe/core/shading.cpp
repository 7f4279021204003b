#include "vpe/core/shading.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vpe::core {

double light(double ambient, double diffuse, double incidence) {
  return std::sqrt(ambient + diffuse * std::max(0.0, incidence));
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
