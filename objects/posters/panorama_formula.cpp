#include "objects/posters/panorama_formula.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"

namespace objects {

namespace {

// Limits how small a pixel becomes at the zenith and the nadir, as a cosine.
constexpr double kLeastLevelCosine = 1e-6;

// Returns an azimuth counted from the start of the circle, 0 to a full one.
double from_start_rad(const PanoramaFormula& formula, double azimuth_rad) {
  const double angle =
      std::fmod(azimuth_rad - formula.turn_azimuth_deg * mars::kRadiansPerDegree, 2 * mars::kPi);
  return angle < 0 ? angle + 2 * mars::kPi : angle;
}

}  // namespace

double PanoramaFormula::column_px(double azimuth_rad) const {
  const double x = from_start_rad(*this, azimuth_rad) * turn_px / (2 * mars::kPi) - crop_left_px;
  return 0.5 * width_px + std::remainder(x - 0.5 * width_px, turn_px);
}

int PanoramaFormula::facet_at(double azimuth_rad) const {
  return std::min(facets - 1, static_cast<int>(from_start_rad(*this, azimuth_rad) * facets / (2 * mars::kPi)));
}

double PanoramaFormula::facet_azimuth_rad(int facet) const {
  return turn_azimuth_deg * mars::kRadiansPerDegree + (facet + 0.5) * 2 * mars::kPi / facets;
}

double PanoramaFormula::pixel_sr(const glm::dvec3& direction) const {
  const double level = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  const double cosine = std::max(kLeastLevelCosine, level / glm::length(direction));
  if (kind == Kind::kFacets) {
    const double azimuth_rad = std::atan2(direction.x, direction.y);
    const double along = std::cos(azimuth_rad - facet_azimuth_rad(facet_at(azimuth_rad))) * cosine;
    return along * along * along / (focal_px * focal_px);
  }
  const double column_rad = 2 * mars::kPi / turn_px;
  return column_rad * (kind == Kind::kCylinder ? cosine * cosine * cosine : cosine) / focal_px;
}

}  // namespace objects
