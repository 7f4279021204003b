#include "panorama/viewer/view_places.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sphere.h"
#include "panorama/viewer/viewer.h"

namespace panorama {

namespace {

using vpe::core::Projection;

// Bound fourth derivatives of a row's azimuth and elevation, with h^4 / 384 of the cubic's error, for a horizontal distance of 1 and
// a horizontal step of 1: azimuth is the imaginary part of a logarithm, so its n-th derivative is at most (n - 1)!. The slope of
// elevation is at most 36 / distance within half the distance of a row to the vertical axis in the complex plane; Cauchy's
// estimate makes 3! 36 2^3 of it.
constexpr double kAzimuthBound = 6.0 / 384.0;
constexpr double kElevationBound = 6.0 * 36.0 * 8.0 / 384.0;

double power4(double value) { return value * value * (value * value); }

double from_zero_to(double period, double value) {
  const double rest = value - period * std::floor(value / period);
  return rest < period ? rest : 0.0;
}

// Returns the cubic of two values and the slopes there, both over the whole interval, at t in [0, 1].
double cubic(double begin, double end, double begin_slope, double end_slope, double t) {
  const double s = 1.0 - t;
  return s * s * ((1.0 + 2.0 * t) * begin + t * begin_slope) + t * t * ((1.0 + 2.0 * s) * end - s * end_slope);
}

}  // namespace

// Describes a ray of a row: angles, and their slopes along the row.
struct ViewPlaces::Knot {
  double azimuth_rad = 0;
  double azimuth_slope = 0;
  double elevation_rad = 0;  // of equirectangular images only
  double elevation_slope = 0;
  double level = 0;  // horizontal length of the ray
  double length = 0;
};

ViewPlaces::ViewPlaces(const PanoramaMap& map, const vpe::core::View& view) : map_(map), view_(view) {
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view);
  const glm::dvec2 middle_px(0.5 * view.width, 0.5 * view.height);
  first_px_ = glm::dvec2(part.x + 0.5, part.y + 0.5) - middle_px - view.principal_offset_px;
  if (view.projection == Projection::kPerspective) focal_px_ = vpe::core::focal_px(view);
  level_step_ = std::hypot(view.camera.axes.right.x, view.camera.axes.right.y);
  if (map.kind != MapKind::kFacets) return;
  for (int facet = 0; facet < map.facets; ++facet) {
    const mars::SinCos middle = mars::sin_cos_deg(map.turn_azimuth_deg + (facet + 0.5) * 360.0 / map.facets);
    middles_.emplace_back(middle.sin, middle.cos);
  }
}

ViewPlaces::Knot ViewPlaces::knot_at(const glm::dvec3& ray) const {
  const glm::dvec3& step = view_.camera.axes.right;
  const double level2 = ray.x * ray.x + ray.y * ray.y;
  Knot knot;
  knot.level = std::sqrt(level2);
  knot.length = glm::length(ray);
  if (level2 == 0.0) return knot;
  knot.azimuth_rad = std::atan2(ray.x, ray.y);
  knot.azimuth_slope = (step.x * ray.y - step.y * ray.x) / level2;
  if (map_.kind == MapKind::kEquirectangular) {
    knot.elevation_rad = std::atan2(ray.z, knot.level);
    knot.elevation_slope = (step.z * level2 - ray.z * (ray.x * step.x + ray.y * step.y)) /
                           (knot.level * knot.length * knot.length);
  }
  return knot;
}

bool ViewPlaces::is_bound(const Knot& begin, const Knot& end) const {
  // A pixel is narrowest along the radius from the image's principal point, focal length / length^2 wide.
  const double length = std::max(begin.length, end.length);
  const double allowed_rad = kMostShift_px * focal_px_ / (length * length);
  const double level = std::min(begin.level, end.level) - 0.5 * kStep_px * level_step_;
  if (level <= 0.0) return false;
  double bound_rad = kAzimuthBound * power4(kStep_px * level_step_ / level);
  if (map_.kind == MapKind::kEquirectangular)
    bound_rad = std::hypot(bound_rad, kElevationBound * power4(kStep_px / level));
  return bound_rad <= allowed_rad;
}

glm::dvec2 ViewPlaces::exact(double x, double y) const {
  glm::dvec2 place = map_.place(to_direction(vpe::core::pixel_ray(view_, x, y)));
  if (place.x < 0.0) place.x += map_.turn_px;
  return place;
}

// `turned_px` is the column from azimuth 0 on, as on an even circle; `rise_rad` is the elevation in an equirectangular image.
glm::dvec2 ViewPlaces::place(double turned_px, double rise_rad, const glm::dvec3& ray) const {
  double column_px = from_zero_to(map_.turn_px, turned_px - map_.turn_azimuth_deg / 360.0 * map_.turn_px);
  double rise_px = map_.focal_px * rise_rad;
  if (map_.kind != MapKind::kEquirectangular) {
    // As large as the tangent of a right angle, which is rounded.
    const double tangent = ray.z / std::max(std::sqrt(ray.x * ray.x + ray.y * ray.y), 1e-16 * std::abs(ray.z));
    rise_px = map_.focal_px * tangent;
    if (map_.kind == MapKind::kFacets) {
      const double wide_px = map_.facet_px();
      const auto facet = std::min(static_cast<std::size_t>(column_px / wide_px), middles_.size() - 1);
      const glm::dvec2& middle = middles_[facet];
      const double right = ray.x * middle.y - ray.y * middle.x;
      const double forward = ray.x * middle.x + ray.y * middle.y;
      const double from_middle_px = std::clamp(map_.focal_px * right / forward, -0.5 * wide_px, 0.5 * wide_px);
      column_px = (static_cast<double>(facet) + 0.5) * wide_px + from_middle_px;
      rise_px = tangent * std::sqrt(from_middle_px * from_middle_px + map_.focal_px * map_.focal_px);
    }
  }
  column_px -= map_.crop_left_px;
  return {column_px < 0.0 ? column_px + map_.turn_px : column_px, map_.horizon_px - rise_px};
}

void ViewPlaces::row(int y, std::span<glm::dvec2> places) const {
  const mars::Axes& axes = view_.camera.axes;
  const auto count = static_cast<int>(places.size());
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view_);
  const auto fill_exactly = [&](int begin, int end) {
    for (int x = begin; x < end; ++x)
      places[static_cast<std::size_t>(x)] = exact(part.x + static_cast<double>(x) + 0.5, part.y + y + 0.5);
  };
  if (view_.projection != Projection::kPerspective) {
    fill_exactly(0, count);
    return;
  }
  const glm::dvec3 first = axes.right * first_px_.x - axes.up * (first_px_.y + y) + axes.forward * focal_px_;
  const double px_per_rad = map_.turn_px / (2.0 * mars::kPi);
  Knot end = knot_at(first);
  for (int from = 0; from < count; from += kStep_px) {
    const Knot begin = end;
    end = knot_at(first + axes.right * static_cast<double>(from + kStep_px));
    const int until = std::min(count, from + kStep_px);
    if (!is_bound(begin, end)) {
      fill_exactly(from, until);
      continue;
    }
    const double begin_px = begin.azimuth_rad * px_per_rad;
    const double end_px =
        begin_px + std::remainder(end.azimuth_rad - begin.azimuth_rad, 2.0 * mars::kPi) * px_per_rad;
    for (int x = from; x < until; ++x) {
      const double t = static_cast<double>(x - from) / kStep_px;
      const double turned_px = cubic(begin_px, end_px, begin.azimuth_slope * kStep_px * px_per_rad,
                                     end.azimuth_slope * kStep_px * px_per_rad, t);
      const double rise_rad = cubic(begin.elevation_rad, end.elevation_rad, begin.elevation_slope * kStep_px,
                                    end.elevation_slope * kStep_px, t);
      places[static_cast<std::size_t>(x)] =
          place(turned_px, rise_rad, first + axes.right * static_cast<double>(x));
    }
  }
}

}  // namespace panorama
