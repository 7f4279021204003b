#include "vpe/map/local_map.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

namespace vpe::map {

LocalMap::LocalMap(mars::LonLat centre, double radius_m) : centre_(centre), radius_m_(radius_m) {
  if (!mars::is_valid(centre)) throw std::invalid_argument("LocalMap: the centre is not a place");
  if (!(std::isfinite(radius_m) && radius_m > 0))
    throw std::invalid_argument("LocalMap: the radius must be above 0");
  frame_ = mars::local_frame(centre);
}

glm::dvec2 LocalMap::to_map(const glm::dvec3& direction) const {
  const double east = glm::dot(direction, frame_.east);
  const double north = glm::dot(direction, frame_.north);
  const double across = std::hypot(east, north);
  const double distance_m = radius_m_ * std::atan2(across, glm::dot(direction, frame_.up));
  if (across == 0) return {distance_m, 0};
  return {distance_m * (east / across), distance_m * (north / across)};
}

glm::dvec3 LocalMap::to_direction(glm::dvec2 map_m) const {
  const double distance_m = std::hypot(map_m.x, map_m.y);
  if (distance_m == 0) return frame_.up;
  const double angle = distance_m / radius_m_;
  const double sine = std::sin(angle);
  return frame_.up * std::cos(angle) + frame_.east * (sine * (map_m.x / distance_m)) +
         frame_.north * (sine * (map_m.y / distance_m));
}

double LocalMap::scale_across(double distance_m) const {
  const double angle = std::abs(distance_m) / radius_m_;
  if (angle < 1e-8) return 1;
  return angle < mars::kPi ? angle / std::sin(angle) : std::numeric_limits<double>::infinity();
}

}  // namespace vpe::map
