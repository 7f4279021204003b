#include "panorama/viewer/viewer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sphere.h"

namespace panorama {

namespace {

using mars::kPi;
using mars::kRadiansPerDegree;

// From here on an image counts as closed at the zenith: mosaics state their rows at pixel centres.
constexpr double kClosed_deg = 89.9;

double tangent_of_half(double fov_deg) { return std::tan(0.5 * fov_deg * kRadiansPerDegree); }
double fov_of(double tangent) { return 2.0 * std::atan(tangent) / kRadiansPerDegree; }

}  // namespace

ElevationRange elevations_of(const PanoramaMap& map) {
  const auto height_px = static_cast<double>(map.height_px);
  if (map.kind != MapKind::kFacets) {
    return {map.to_direction(0.0, height_px).elevation_deg, map.to_direction(0.0, 0.0).elevation_deg};
  }
  // A facet's rows bend towards the horizon at its sides.
  const double corner_px = std::hypot(0.5 * map.facet_px(), map.focal_px);
  const double up_px = map.horizon_px;
  const double down_px = map.horizon_px - height_px;
  return {std::atan2(down_px, down_px < 0.0 ? corner_px : map.focal_px) / kRadiansPerDegree,
          std::atan2(up_px, up_px > 0.0 ? corner_px : map.focal_px) / kRadiansPerDegree};
}

glm::dvec3 to_vector(const Direction& direction) {
  const double azimuth_rad = std::fmod(direction.azimuth_deg, 360.0) * kRadiansPerDegree;
  const double elevation_rad = direction.elevation_deg * kRadiansPerDegree;
  const double level = std::cos(elevation_rad);
  return {level * std::sin(azimuth_rad), level * std::cos(azimuth_rad), std::sin(elevation_rad)};
}

Direction to_direction(const glm::dvec3& vector) {
  double azimuth_deg = std::atan2(vector.x, vector.y) / kRadiansPerDegree;
  if (azimuth_deg < 0.0) azimuth_deg += 360.0;
  if (azimuth_deg >= 360.0) azimuth_deg = 0.0;
  return {azimuth_deg, std::atan2(vector.z, std::hypot(vector.x, vector.y)) / kRadiansPerDegree};
}

vpe::core::View view_of(double yaw_deg, double pitch_deg, double fov_deg, int width_px, int height_px,
                        double roll_deg) {
  vpe::core::View view;
  view.camera = {{0, 0, 0}, mars::oriented_axes(kViewerFrame, std::fmod(yaw_deg, 360.0), pitch_deg, roll_deg)};
  view.fov_deg = fov_deg;
  view.width = width_px;
  view.height = height_px;
  return view;
}

Viewer::Viewer(const PanoramaMap& map, int width_px, int height_px) : map_(map), size_(width_px, height_px) {
  // Images wider than a full circle start inside their first one.
  const double middle_px = 0.5 * std::min(static_cast<double>(map.width_px), map.turn_px);
  yaw_deg_ = map.to_direction(middle_px, map.horizon_px).azimuth_deg;
  set_fov(fov_deg_);
}

double Viewer::min_fov_deg() const {
  const double columns_px = map_.kind == MapKind::kFacets ? map_.focal_px : map_.turn_px / (2.0 * kPi);
  const double finest_px = std::max(columns_px, map_.focal_px);
  const double fov_deg = fov_of(0.5 * size_.y / (ViewerLimits::kMaxMagnification * finest_px));
  return std::clamp(fov_deg, ViewerLimits::kMinFov_deg, ViewerLimits::kMaxFov_deg);
}

ElevationRange Viewer::pitch_range() const {
  const ElevationRange seen = elevations_of(map_);
  const double half_deg = 0.5 * fov_deg_;
  const double low_deg = seen.low_deg <= -kClosed_deg ? -90.0 : seen.low_deg + half_deg;
  const double high_deg = seen.high_deg >= kClosed_deg ? 90.0 : seen.high_deg - half_deg;
  if (low_deg <= high_deg) return {low_deg, high_deg};
  const double middle_deg = 0.5 * (seen.low_deg + seen.high_deg);
  return {middle_deg, middle_deg};
}

void Viewer::clamp_pitch() {
  const ElevationRange range = pitch_range();
  pitch_deg_ = std::clamp(pitch_deg_, range.low_deg, range.high_deg);
}

void Viewer::resize(int width_px, int height_px) {
  size_ = {width_px, height_px};
  set_fov(fov_deg_);
}

void Viewer::look_at(double yaw_deg, double pitch_deg) {
  if (!std::isfinite(yaw_deg) || !std::isfinite(pitch_deg)) return;
  yaw_deg_ = yaw_deg;
  pitch_deg_ = pitch_deg;
  clamp_pitch();
}

void Viewer::set_fov(double fov_deg) {
  if (!std::isfinite(fov_deg)) return;
  fov_deg_ = std::clamp(fov_deg, min_fov_deg(), ViewerLimits::kMaxFov_deg);
  clamp_pitch();
}

void Viewer::set_roll(double roll_deg) {
  if (std::isfinite(roll_deg)) roll_deg_ = std::remainder(roll_deg, 360.0);
}

void Viewer::zoom(double factor, double x, double y) {
  if (!(factor > 0.0) || !std::isfinite(factor) || !std::isfinite(x) || !std::isfinite(y)) return;
  const Direction under = direction(x, y);
  set_fov(fov_of(tangent_of_half(fov_deg_) / factor));
  hold(under, x, y);
}

void Viewer::hold(const Direction& direction, double x, double y) {
  if (!std::isfinite(direction.azimuth_deg) || !std::isfinite(direction.elevation_deg) || !std::isfinite(x) ||
      !std::isfinite(y)) {
    return;
  }
  // The ray (u, v, 1) in (right, up, forward) rises by sin p + v cos p = sqrt(1 + v^2) sin(p + atan v).
  const double focal_px = vpe::core::focal_px(view());
  const double right = (x - 0.5 * size_.x) / focal_px;
  const double up = (0.5 * size_.y - y) / focal_px;
  // In the axes of the level view.
  const double roll = roll_deg_ * kRadiansPerDegree;
  const double u = right * std::cos(roll) + up * std::sin(roll);
  const double v = up * std::cos(roll) - right * std::sin(roll);
  const double sine =
      std::sin(direction.elevation_deg * kRadiansPerDegree) * std::sqrt((1.0 + u * u + v * v) / (1.0 + v * v));
  const double rise_rad = std::asin(std::clamp(sine, -1.0, 1.0));
  // Two pitches fulfil this, one with the ray beyond the zenith or nadir; the nearer one counts.
  const double here_rad = pitch_deg_ * kRadiansPerDegree + std::atan(v);
  const double beyond_rad = (rise_rad < 0.0 ? -kPi : kPi) - rise_rad;
  const bool is_beyond = std::abs(beyond_rad - here_rad) < std::abs(rise_rad - here_rad);
  const double pitch_rad = (is_beyond ? beyond_rad : rise_rad) - std::atan(v);
  const ElevationRange range = pitch_range();
  const double pitch_deg = std::clamp(pitch_rad / kRadiansPerDegree, range.low_deg, range.high_deg);
  const double pitch = pitch_deg * kRadiansPerDegree;
  const double aside_deg = std::atan2(u, std::cos(pitch) - v * std::sin(pitch)) / kRadiansPerDegree;
  // The nearest of all equivalent yaws, so that yaw continues where it was.
  look_at(yaw_deg_ + std::remainder(direction.azimuth_deg - aside_deg - yaw_deg_, 360.0), pitch_deg);
}

vpe::core::View Viewer::view() const {
  return view_of(yaw_deg_, pitch_deg_, fov_deg_, size_.x, size_.y, roll_deg_);
}

Direction Viewer::direction(double x, double y) const {
  return to_direction(vpe::core::pixel_ray(view(), x, y));
}

std::optional<glm::dvec2> Viewer::screen(const Direction& direction) const {
  const vpe::core::Projected at = vpe::core::project(view(), to_vector(direction));
  if (at.behind) return std::nullopt;
  return at.xy;
}

}  // namespace panorama
