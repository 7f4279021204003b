#include "paging/surface/profile.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "paging/surface/section.h"

namespace paging {

namespace {

ProfilePoint point_at(const Surface& surface, const glm::dvec3& direction) {
  const SurfacePoint s = surface.at(direction);
  ProfilePoint p;
  p.place = mars::lon_lat(direction);
  p.height_m = s.height_m;
  p.nodata = s.nodata;
  const double up = glm::dot(s.normal, direction);
  p.cross_slope_deg = std::atan2(glm::length(s.normal - up * direction), up) / mars::kRadiansPerDegree;
  return p;
}

}  // namespace

std::vector<ProfilePoint> profile(const Surface& surface, std::span<const mars::LonLat> places, double step_m) {
  if (places.size() < 2) throw std::invalid_argument("a profile takes at least two places");
  if (!(step_m > 0)) throw std::invalid_argument("the step of a profile must be positive");
  const double radius_m = surface.planet_radius_m();
  double steps = 1;
  for (std::size_t n = 1; n < places.size(); ++n) {
    const double arc = mars::distance_rad(places[n - 1], places[n]);
    if (arc > mars::kPi - kNearlyOpposite_rad) {
      throw std::invalid_argument("places " + std::to_string(n) + " and " + std::to_string(n + 1) +
                                  " lie on opposite sides of the planet; give one between them");
    }
    steps += std::max(1.0, std::ceil(arc * radius_m / step_m));
  }
  if (!(steps <= static_cast<double>(kMostProfilePoints))) {
    throw std::invalid_argument("a profile of " + std::to_string(steps) + " points; give a longer step");
  }

  std::vector<ProfilePoint> points;
  points.reserve(static_cast<std::size_t>(steps));
  double start_m = 0;
  glm::dvec3 before{0, 0, 0};
  for (std::size_t n = 1; n < places.size(); ++n) {
    const glm::dvec3 a = mars::direction(places[n - 1]);
    const glm::dvec3 b = mars::direction(places[n]);
    const double arc_m = mars::angle_between_rad(a, b) * radius_m;
    const auto count = static_cast<std::int64_t>(std::max(1.0, std::ceil(arc_m / step_m)));
    for (std::int64_t i = n == 1 ? 0 : 1; i <= count; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(count);
      const glm::dvec3 here = i == 0 ? a : i == count ? b : mars::slerp(a, b, t);
      ProfilePoint p = point_at(surface, here);
      p.lowest_m = p.highest_m = p.height_m;
      if (!points.empty()) {
        const SectionFigures step = section_figures(surface, before, here);
        p.ground_distance_m = points.back().ground_distance_m + step.length_m;
        p.lowest_m = std::min({p.height_m, points.back().height_m, step.lowest_m});
        p.highest_m = std::max({p.height_m, points.back().height_m, step.highest_m});
      }
      before = here;
      p.distance_m = start_m + t * arc_m;
      p.waypoint = i == 0 || i == count;
      if (p.waypoint) {  // unchanged, also at a pole
        p.place = i == 0 ? places[n - 1] : places[n];
        p.place.lon_deg = mars::normalize_lon_deg(p.place.lon_deg);
      }
      points.push_back(p);
    }
    start_m += arc_m;
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    ProfilePoint& p = points[i];
    const ProfilePoint& last = points[i - 1];
    const double arc = (p.distance_m - last.distance_m) / radius_m;
    const double rise = p.height_m - last.height_m;
    // The straight line between two points at radii r and r + rise, an arc apart.
    const double middle = radius_m + 0.5 * (p.height_m + last.height_m);
    const double across =
        2 * std::sqrt(std::max(0.0, middle * middle - 0.25 * rise * rise)) * std::sin(0.5 * arc);
    p.slope_deg = across > 0 ? std::atan2(rise, across) / mars::kRadiansPerDegree : 0;
  }
  if (points.size() > 1) points.front().slope_deg = points[1].slope_deg;
  return points;
}

}  // namespace paging
