#include "panorama/eye_projection.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "panorama/stereo_pieces.h"

namespace panorama {

using mars::kPi;
using mars::kRadiansPerDegree;

EyeProjection::EyeProjection(const PanoramaMap& map, const Viewpoint& viewpoint)
    : map_(map), viewpoint_(viewpoint) {}

EyeProjection::EyeProjection(const PanoramaMap& map, const Viewpoint& viewpoint, Eye eye, double base_m)
    : map_(map), viewpoint_(viewpoint), side_(eye == Eye::kRight ? 1 : -1), base_m_(base_m) {}

std::optional<EyeProjection::Seen> EyeProjection::project(const glm::dvec3& point_m) const {
  constexpr int kMostTurns = 60;
  constexpr double kSettled_rad = 1e-13;
  const mars::LocalFrame& frame = viewpoint_.frame;
  const glm::dvec3 from_m = point_m - viewpoint_.position_m;
  double azimuth_rad = std::atan2(glm::dot(from_m, frame.east), glm::dot(from_m, frame.north));
  const double level_m = std::hypot(glm::dot(from_m, frame.east), glm::dot(from_m, frame.north));
  double elevation_rad = std::atan2(glm::dot(from_m, frame.up), level_m);
  glm::dvec3 seen_from_m = viewpoint_.position_m;
  if (glm::dot(from_m, from_m) == 0) return std::nullopt;
  const double height_m = glm::length(viewpoint_.position_m);
  // The column whose eye sees the point in its own direction; each turn brings it nearer by base / distance.
  for (int turn = 0; side_ != 0 && turn < kMostTurns; ++turn) {
    const double aside_m = 0.5 * side_ * faded_base_m(base_m_, elevation_rad / kRadiansPerDegree);
    const double s = std::sin(azimuth_rad);
    const double c = std::cos(azimuth_rad);
    const glm::dvec3 forward = s * frame.east + c * frame.north;
    glm::dvec3 right = c * frame.east - s * frame.north;
    glm::dvec3 up = frame.up;
    seen_from_m = viewpoint_.position_m + aside_m * right;
    // Verticals as those of the pieces.
    const double tilt_px = map_.turn_px / (2 * kPi) * std::abs(std::tan(elevation_rad) * aside_m) / height_m;
    if (tilt_px <= kStereoTilt_px) {
      const double length_m = std::hypot(height_m, aside_m);
      up = (frame.up * height_m + right * aside_m) / length_m;
      right = (right * height_m - frame.up * aside_m) / length_m;
    }
    const glm::dvec3 along = point_m - seen_from_m;
    const double ahead_m = glm::dot(along, forward);
    const double off_rad = std::atan2(glm::dot(along, right), ahead_m);
    const double next_rad = std::atan2(glm::dot(along, up), std::hypot(glm::dot(along, right), ahead_m));
    const double change_rad = std::max(std::abs(off_rad), std::abs(next_rad - elevation_rad));
    azimuth_rad += off_rad;
    elevation_rad = next_rad;
    if (change_rad < kSettled_rad) break;
  }
  // The cylinder has no row for the zenith or nadir.
  if (map_.kind != MapKind::kEquirectangular && std::abs(elevation_rad) > 0.5 * kPi - 1e-9) return std::nullopt;
  return Seen{map_.place({azimuth_rad / kRadiansPerDegree, elevation_rad / kRadiansPerDegree}), seen_from_m};
}

bool EyeProjection::may_show(const glm::dvec3& centre_m, double radius_m, double margin_px) const {
  constexpr double kNear = 0.9;
  constexpr double kSteep_rad = 1.4;
  const glm::dvec3 along = centre_m - viewpoint_.position_m;
  const double distance_m = glm::length(along);
  const double ball_m = radius_m + 0.5 * base_m_;
  if (ball_m >= kNear * distance_m) return true;
  const double half_rad = std::asin(ball_m / distance_m);
  const mars::LocalFrame& frame = viewpoint_.frame;
  const double sine = glm::dot(along, frame.up) / distance_m;
  const double elevation_rad = std::asin(std::clamp(sine, -1.0, 1.0));
  // Rows of facets are nearest to the horizon at the facets' edges.
  const double edge = map_.kind == MapKind::kFacets ? 1 / std::cos(kPi / map_.facets) : 1;
  const auto limit_rad = [&](double rise_px, bool is_top) {
    if (map_.kind == MapKind::kEquirectangular) return rise_px / map_.focal_px;
    const bool is_outer = is_top == (rise_px > 0);
    return std::atan(rise_px / (map_.focal_px * (is_outer ? 1 : edge)));
  };
  const double highest_rad = limit_rad(map_.horizon_px + margin_px, true);
  const double lowest_rad = limit_rad(map_.horizon_px - static_cast<double>(map_.height_px) - margin_px, false);
  if (elevation_rad - half_rad > highest_rad || elevation_rad + half_rad < lowest_rad) return false;
  if (map_.azimuth_span_deg() > 359 || std::abs(elevation_rad) + half_rad > kSteep_rad) return true;
  const double azimuth_deg =
      std::atan2(glm::dot(along, frame.east), glm::dot(along, frame.north)) / kRadiansPerDegree;
  const double middle_deg =
      map_.to_direction(0.5 * static_cast<double>(map_.width_px), map_.horizon_px).azimuth_deg;
  const double beside_deg = std::asin(std::sin(half_rad) / std::cos(elevation_rad)) / kRadiansPerDegree;
  // Columns of facets are not even in azimuth.
  const double uneven_deg = map_.kind == MapKind::kFacets ? 360.0 / map_.facets : 0;
  const double most_deg =
      0.5 * map_.azimuth_span_deg() + uneven_deg + beside_deg + 2 * margin_px * 360 / map_.turn_px;
  return std::abs(std::remainder(azimuth_deg - middle_deg, 360.0)) <= most_deg;
}

}  // namespace panorama
