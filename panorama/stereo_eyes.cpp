#include "panorama/stereo_eyes.h"

#include <algorithm>
#include <cmath>

#include "mars/geodesy/sphere.h"

namespace panorama {

glm::dvec2 eye_place_m(Eye eye, double azimuth_deg, double base_m) {
  const double azimuth_rad = std::fmod(azimuth_deg, 360.0) * mars::kRadiansPerDegree;
  const double aside_m = eye == Eye::kRight ? 0.5 * base_m : -0.5 * base_m;
  return {aside_m * std::cos(azimuth_rad), -aside_m * std::sin(azimuth_rad)};
}

double faded_base_m(double base_m, double elevation_deg) {
  constexpr double kFadesFrom_deg = 45.0;
  const double past =
      std::clamp((std::abs(elevation_deg) - kFadesFrom_deg) / (90.0 - kFadesFrom_deg), 0.0, 1.0);
  return base_m * (1.0 - past * past * (3.0 - 2.0 * past));
}

}  // namespace panorama
