#include "vpe/overlook/direction_patch.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "panorama/viewer/viewer.h"

namespace vpe::overlook {

namespace {

using mars::kPi;
using mars::kRadiansPerDegree;
using panorama::MapKind;
using panorama::PanoramaMap;

struct Span {
  double low = 0;
  double high = 0;
};

double azimuth_rad(const PanoramaMap& map, double x) {
  const double turns = (x + map.crop_left_px) / map.turn_px;
  return std::fmod(map.turn_azimuth_deg, 360.0) * kRadiansPerDegree + 2.0 * kPi * turns;
}

// Of a column from the middle of its facet.
double aside_px(const PanoramaMap& map, int facet, double x) {
  double t = x + map.crop_left_px;
  if (t - (facet + 1) * map.facet_px() > 0.5 * map.turn_px) t -= map.turn_px;
  return t - (facet + 0.5) * map.facet_px();
}

double facet_azimuth_rad(const PanoramaMap& map, int facet) {
  return std::fmod(map.turn_azimuth_deg, 360.0) * kRadiansPerDegree + 2.0 * kPi * (facet + 0.5) / map.facets;
}

Span azimuths(const PanoramaMap& map, int facet, const Rectangle& r) {
  if (map.kind != MapKind::kFacets) return {azimuth_rad(map, r.left), azimuth_rad(map, r.right)};
  const double middle = facet_azimuth_rad(map, facet);
  return {middle + std::atan2(aside_px(map, facet, r.left), map.focal_px),
          middle + std::atan2(aside_px(map, facet, r.right), map.focal_px)};
}

Span elevations(const PanoramaMap& map, int facet, const Rectangle& r) {
  const double high = map.horizon_px - r.top;
  const double low = map.horizon_px - r.bottom;
  if (map.kind == MapKind::kEquirectangular) {
    return {std::clamp(low / map.focal_px, -0.5 * kPi, 0.5 * kPi),
            std::clamp(high / map.focal_px, -0.5 * kPi, 0.5 * kPi)};
  }
  double near = map.focal_px;
  double far = map.focal_px;
  if (map.kind == MapKind::kFacets) {
    const double left = aside_px(map, facet, r.left);
    const double right = aside_px(map, facet, r.right);
    const double least = left <= 0.0 && right >= 0.0 ? 0.0 : std::min(std::abs(left), std::abs(right));
    near = std::hypot(least, map.focal_px);
    far = std::hypot(std::max(std::abs(left), std::abs(right)), map.focal_px);
  }
  return {std::atan2(low, low < 0.0 ? near : far), std::atan2(high, high > 0.0 ? near : far)};
}

double shift_rad(MapKind kind, double a, double b, const Span& e) {
  const double s = std::max(std::abs(std::sin(e.low)), std::abs(std::sin(e.high)));
  const double c = e.low <= 0.0 && e.high >= 0.0 ? 1.0 : std::max(std::cos(e.low), std::cos(e.high));
  if (kind == MapKind::kCylinder) {
    const double bulge = a * a / 8.0;
    return bulge < 0.5 ? c * (s + a) * bulge / (1.0 - bulge) : kPi;
  }
  const double squares = a * a + b * b;
  if (squares > 2.0) return kPi;
  return 0.25 * (s * c * a * a + s * a * b + squares * std::sqrt(squares)) / (1.0 - 0.25 * squares);
}

}  // namespace

int facet_of(const PanoramaMap& map, double x) {
  if (map.kind != MapKind::kFacets) return 0;
  const double t = std::fmod(x + map.crop_left_px, map.turn_px);
  return std::clamp(static_cast<int>(t / map.facet_px()), 0, map.facets - 1);
}

glm::dvec3 direction_vector(const PanoramaMap& map, int facet, double x, double y) {
  const double rise = (map.horizon_px - y) / map.focal_px;
  if (map.kind == MapKind::kFacets) {
    const double azimuth = facet_azimuth_rad(map, facet);
    const double u = aside_px(map, facet, x) / map.focal_px;
    return {std::sin(azimuth) + u * std::cos(azimuth), std::cos(azimuth) - u * std::sin(azimuth), rise};
  }
  const double azimuth = azimuth_rad(map, x);
  if (map.kind == MapKind::kCylinder) return {std::sin(azimuth), std::cos(azimuth), rise};
  const double elevation = std::clamp(rise, -0.5 * kPi, 0.5 * kPi);
  return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
          std::sin(elevation)};
}

Cap cap_of(const PanoramaMap& map, int facet, const Rectangle& rectangle) {
  const Span a = azimuths(map, facet, rectangle);
  const Span e = elevations(map, facet, rectangle);
  const double middle = 0.5 * (e.low + e.high);
  const double azimuth = 0.5 * (a.low + a.high);
  // From the middle along its parallel, then along a meridian.
  return {{std::cos(middle) * std::sin(azimuth), std::cos(middle) * std::cos(azimuth), std::sin(middle)},
          0.5 * (a.high - a.low) * std::cos(middle) + 0.5 * (e.high - e.low)};
}

glm::dvec2 sides_rad(const PanoramaMap& map, int facet, const Rectangle& rectangle) {
  const Span a = azimuths(map, facet, rectangle);
  const Span e = elevations(map, facet, rectangle);
  const double level = e.low <= 0.0 && e.high >= 0.0 ? 1.0 : std::max(std::cos(e.low), std::cos(e.high));
  return {(a.high - a.low) * level, e.high - e.low};
}

double largest_shift_rad(const PanoramaMap& map, const Rectangle& rectangle, const Cuts& cuts) {
  if (map.kind == MapKind::kFacets) return 0.0;
  const Span e = elevations(map, 0, rectangle);
  const double a = 2.0 * kPi * (rectangle.right - rectangle.left) / map.turn_px / cuts.across;
  // Rows of the cylinder are cut at no cost of accuracy: they are straight.
  const double b = (rectangle.bottom - rectangle.top) / map.focal_px / cuts.down;
  return shift_rad(map.kind, a, b, e);
}

Cuts cuts_of(const PanoramaMap& map, const Rectangle& rectangle, double allowed_rad) {
  if (map.kind == MapKind::kFacets) return {};
  const double a = 2.0 * kPi * (rectangle.right - rectangle.left) / map.turn_px;
  const double b = (rectangle.bottom - rectangle.top) / map.focal_px;
  constexpr double kFiner = 0.9;
  constexpr double kFinest_rad = 1e-4;
  Cuts cuts;
  for (double step = 1.0; step > kFinest_rad; step *= kFiner) {
    cuts.across = std::max(1, static_cast<int>(std::ceil(a / step)));
    cuts.down = map.kind == MapKind::kCylinder ? 1 : std::max(1, static_cast<int>(std::ceil(b / step)));
    if (largest_shift_rad(map, rectangle, cuts) <= allowed_rad) break;
  }
  return cuts;
}

}  // namespace vpe::overlook
