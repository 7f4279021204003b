#include "panorama/horizon/landmarks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace panorama {

namespace {

Direction direction_of(const Viewpoint& viewpoint, const glm::dvec3& ray) {
  const double east = glm::dot(ray, viewpoint.frame.east);
  const double north = glm::dot(ray, viewpoint.frame.north);
  double azimuth = std::atan2(east, north) / mars::kRadiansPerDegree;
  if (azimuth < 0) azimuth += 360;
  if (azimuth >= 360) azimuth = 0;  // what was just below 0
  return {azimuth,
          std::atan2(glm::dot(ray, viewpoint.frame.up), std::hypot(east, north)) / mars::kRadiansPerDegree};
}

// Ground at the end of a straight line from the viewpoint.
struct Seen {
  GroundPoint point;
  glm::dvec3 ray;  // unit, from the viewpoint
};

// Looks along straight lines from a viewpoint to the ground in directions from the planet's centre.
struct LineToGround {
  const Viewpoint& viewpoint;
  double within_m;
  const GroundRadius& radius;
  const GroundRange& range;

  // Returns true if no point within `reach_m` of that direction, at any radius, is nearer than within_m.
  bool is_too_far(const glm::dvec3& up, double reach_m) const {
    const double half_angle = 0.5 * mars::angle_between_rad(up, viewpoint.position_m);
    return std::sin(half_angle) * glm::length(viewpoint.position_m) > within_m + reach_m;
  }
  // Returns the ground in a direction, or nullopt if it is farther than within_m or at the viewpoint.
  std::optional<Seen> seen(const glm::dvec3& up) const {
    const double ground_m = radius(up);
    const glm::dvec3 line = ground_m * up - viewpoint.position_m;
    const double distance_m = glm::length(line);
    if (distance_m > within_m || distance_m == 0) return std::nullopt;
    const glm::dvec3 ray = line / distance_m;
    return Seen{{direction_of(viewpoint, ray), distance_m, mars::lon_lat(up), ground_m - viewpoint.radius_m},
                ray};
  }
  // Returns the ground that hides a point, if any.
  std::optional<GroundPoint> hidden_by(const Seen& seen) const {
    const double met_m = range(seen.ray);
    if (met_m >= (1.0 - kLandmarkReach) * seen.point.range_m) return std::nullopt;
    const glm::dvec3 met = viewpoint.position_m + met_m * seen.ray;
    return GroundPoint{seen.point.direction, met_m, mars::lon_lat(met), glm::length(met) - viewpoint.radius_m};
  }
  std::optional<GroundPoint> highest_visible(const std::vector<glm::dvec3>& directions) const {
    std::optional<GroundPoint> highest;
    for (const glm::dvec3& up : directions) {
      if (is_too_far(up, 0)) continue;
      const std::optional<Seen> here = seen(up);
      if (!here) continue;
      const bool is_lower = highest && here->point.direction.elevation_deg <= highest->direction.elevation_deg;
      if (!is_lower && !hidden_by(*here)) highest = here->point;
    }
    return highest;
  }
};

}  // namespace

const vpe::core::Place* smallest_feature_around(std::span<const vpe::core::Place> features, mars::LonLat place,
                                                double radius_m) {
  const vpe::core::Place* best = nullptr;
  for (const vpe::core::Place& f : features) {
    if (f.diameter_m <= 0 || (best != nullptr && f.diameter_m >= best->diameter_m)) continue;
    if (mars::distance_rad({f.lon_deg, f.lat_deg}, place) * radius_m <= 0.5 * f.diameter_m) best = &f;
  }
  return best;
}

std::vector<Landmark> landmarks(const Viewpoint& viewpoint, std::span<const vpe::core::Place> features,
                                double within_m, const GroundRadius& radius, const GroundRange& range,
                                vpe::base::ThreadPool& pool, Extent extent) {
  const LineToGround line_to{viewpoint, within_m, radius, range};
  std::vector<std::optional<Landmark>> found(features.size());
  pool.run(features.size(), [&](std::size_t n) {
    const vpe::core::Place& feature = features[n];
    const glm::dvec3 up = mars::direction({feature.lon_deg, feature.lat_deg});
    const bool has_points = extent == Extent::kPoints && feature.diameter_m > 0;
    if (line_to.is_too_far(up, has_points ? 0.5 * feature.diameter_m : 0)) return;
    const std::optional<Seen> centre = line_to.seen(up);
    std::optional<Landmark> landmark;
    if (centre) {
      landmark.emplace();
      landmark->feature = feature;
      landmark->centre = centre->point;
      landmark->centre.place = {feature.lon_deg, feature.lat_deg};
      landmark->hidden_by = line_to.hidden_by(*centre);
      if (landmark->hidden_by) {
        if (const auto* by = smallest_feature_around(features, landmark->hidden_by->place, viewpoint.radius_m))
          landmark->hidden_by_name = by->name;
      }
    }
    if (has_points && (!landmark || landmark->hidden_by)) {
      const std::optional<GroundPoint> seen =
          line_to.highest_visible(vpe::core::points_within(feature, viewpoint.radius_m));
      if (seen) {
        if (!landmark) {
          landmark.emplace();
          landmark->feature = feature;
          landmark->centre = *seen;
          landmark->centre.place = {feature.lon_deg, feature.lat_deg};
        }
        landmark->seen_at = seen;
      }
    }
    found[n] = std::move(landmark);
  });
  std::vector<Landmark> out;
  for (std::optional<Landmark>& landmark : found) {
    if (landmark) out.push_back(std::move(*landmark));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Landmark& a, const Landmark& b) { return a.centre.range_m < b.centre.range_m; });
  return out;
}

double farthest_sight_m(double camera_radius_m, double lowest_radius_m, double highest_radius_m) {
  const auto to_tangent = [&](double r) {
    return std::sqrt(std::max(0.0, (r - lowest_radius_m) * (r + lowest_radius_m)));
  };
  return to_tangent(camera_radius_m) + to_tangent(highest_radius_m);
}

}  // namespace panorama
