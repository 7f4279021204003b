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
                                vpe::base::ThreadPool& pool) {
  std::vector<std::optional<Landmark>> found(features.size());
  pool.run(features.size(), [&](std::size_t n) {
    const glm::dvec3 up = mars::direction({features[n].lon_deg, features[n].lat_deg});
    // No point in that direction, at any radius, is nearer than this.
    const double half_angle = 0.5 * mars::angle_between_rad(up, viewpoint.position_m);
    if (std::sin(half_angle) * glm::length(viewpoint.position_m) > within_m) return;
    const double ground_m = radius(up);
    const glm::dvec3 line = ground_m * up - viewpoint.position_m;
    const double distance_m = glm::length(line);
    if (distance_m > within_m || distance_m == 0) return;
    Landmark& landmark = found[n].emplace();
    landmark.feature = features[n];
    const glm::dvec3 ray = line / distance_m;
    landmark.centre = {direction_of(viewpoint, ray),
                       distance_m,
                       {features[n].lon_deg, features[n].lat_deg},
                       ground_m - viewpoint.radius_m};
    const double met_m = range(ray);
    if (met_m >= (1.0 - kLandmarkReach) * distance_m) return;
    const glm::dvec3 point = viewpoint.position_m + met_m * ray;
    landmark.hidden_by = GroundPoint{landmark.centre.direction, met_m, mars::lon_lat(point),
                                     glm::length(point) - viewpoint.radius_m};
    if (const auto* feature = smallest_feature_around(features, landmark.hidden_by->place, viewpoint.radius_m))
      landmark.hidden_by_name = feature->name;
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
