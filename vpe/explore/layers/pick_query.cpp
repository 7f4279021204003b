#include "vpe/explore/layers/pick_query.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace vpe::explore {
namespace {

// Places between two rays may be farther than those that they meet.
constexpr double kBetweenRays = 1.25;

struct Met {
  double off_px = 0;
  double range_m = 0;
  glm::dvec3 direction{0, 0, 1};
};

}  // namespace

std::optional<PickQuery> query_in_view(const TerrainQuery& ground, const core::View& view, glm::dvec2 xy,
                                       double reach_px) {
  const glm::dvec3 camera_m = view.camera.position_m;
  std::vector<Met> met;
  const int reach = static_cast<int>(std::ceil(reach_px));
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const double off_px = std::hypot(dx, dy);
      if (off_px > reach_px) continue;
      const glm::dvec3 ray = core::pixel_ray(view, xy.x + dx, xy.y + dy);
      const double range_m = ground.cast_m(camera_m, ray);
      if (std::isfinite(range_m) && range_m > 0)
        met.push_back({off_px, range_m, glm::normalize(camera_m + ray * range_m)});
    }
  }
  if (met.empty()) return std::nullopt;
  const Met& nearest = *std::ranges::min_element(met, {}, &Met::off_px);
  PickQuery query;
  query.place = mars::lon_lat(nearest.direction);
  query.is_on_ground = nearest.off_px == 0;
  query.cursor_px = xy;
  query.reach_px = reach_px;
  for (const Met& one : met)
    query.reach_rad = std::max(query.reach_rad, mars::angle_between_rad(nearest.direction, one.direction));
  // A pixel more: rays that meet the same place to the bit would leave no reach.
  const double pixel_rad = nearest.range_m / core::focal_px(view) / ground.radius_m;
  query.reach_rad = std::min(mars::kPi, kBetweenRays * query.reach_rad + pixel_rad);
  const auto point_m = [&ground](glm::dvec2 place_deg) {
    const glm::dvec3 up = mars::direction({place_deg.x, place_deg.y});
    return up * (ground.radius_m + ground.height_m(up));
  };
  query.position = [view, point_m](glm::dvec2 place_deg) -> std::optional<glm::dvec2> {
    const core::Projected shown = core::project(view, point_m(place_deg));
    return shown.behind ? std::nullopt : std::optional(shown.xy);
  };
  query.is_seen = [view, camera_m, point_m, &ground](glm::dvec2 place_deg) {
    // A point two pixels above the ground, so that its own facet does not hide it.
    const glm::dvec3 foot_m = point_m(place_deg);
    const double lift_m = std::max(0.5, 2 * glm::length(foot_m - camera_m) / core::focal_px(view));
    const glm::dvec3 path = foot_m * (1 + lift_m / glm::length(foot_m)) - camera_m;
    const double distance_m = glm::length(path);
    return !(ground.cast_m(camera_m, path / distance_m) < distance_m * (1 - 1e-9));
  };
  return query;
}

PickQuery query_on_map(const MapView& map, mars::LonLat place, double reach_px) {
  PickQuery query;
  query.place = place;
  query.cursor_px = map.position(place);
  query.reach_px = reach_px;
  query.reach_rad =
      reach_px * std::hypot(map.degrees_per_px, map.lon_degrees_per_px()) * mars::kRadiansPerDegree;
  query.position = [map](glm::dvec2 place_deg) {
    return std::optional(map.position({place_deg.x, place_deg.y}));
  };
  return query;
}

}  // namespace vpe::explore
