#include "objects/draw/volume_rays.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace objects {

std::optional<VolumeCrossing> enter_volume(const PlacedObject& o, const VolumeLevel& level,
                                           const ObjectRay& ray, double until_m) {
  const glm::dvec3 origin = o.to_model * (ray.origin_m - o.position_m);
  const glm::dvec3 direction = o.to_model * ray.direction;
  const glm::dvec3 to_ball = o.ball_m - origin;
  const double length2 = glm::dot(direction, direction);
  const double middle = glm::dot(to_ball, direction) / length2;
  const glm::dvec3 beside = to_ball - middle * direction;
  const double rest2 = o.ball_radius_m * o.ball_radius_m - glm::dot(beside, beside);
  if (!(rest2 > 0)) return std::nullopt;
  const double half = std::sqrt(rest2 / length2);
  VolumeCrossing c;
  c.begin_m = std::max(0.0, middle - half);
  c.end_m = std::min(middle + half, until_m);
  const VolumeLattice& lattice = level.lattice;
  for (int k = 0; k < 3; ++k) {
    const double low = static_cast<double>(lattice.corner_m[k]) - origin[k];
    const double high =
        low + static_cast<double>(lattice.spacing_m) * (lattice.posts[static_cast<std::size_t>(k)] - 1);
    if (direction[k] == 0) {
      if (low > 0 || high < 0) return std::nullopt;
      continue;
    }
    const double a = low / direction[k];
    const double b = high / direction[k];
    c.begin_m = std::max(c.begin_m, std::min(a, b));
    c.end_m = std::min(c.end_m, std::max(a, b));
  }
  if (!(c.begin_m < c.end_m)) return std::nullopt;
  c.ray = {origin + c.begin_m * direction, direction};
  return c;
}

void enter_volumes(std::span<const PlacedObject> objects, std::span<const std::uint32_t> named,
                   const ObjectRay& ray, double until_m, std::vector<VolumeCrossing>& out) {
  out.clear();
  for (const std::uint32_t n : named) {
    const PlacedObject& o = objects[n];
    if (o.near_m > until_m) break;
    if (!o.by_rays || o.volume == nullptr) continue;
    if (const auto crossing = enter_volume(o, *o.volume, ray, until_m)) {
      out.push_back(*crossing);
      out.back().object = n;
    }
  }
}

double volume_through(const PlacedObject& o, const ObjectRay& ray) {
  const std::vector<VolumeLevel>& levels = o.model->volume()->levels();
  const VolumeLevel& level = levels[std::min(o.level_index + 1, levels.size() - 1)];
  const auto crossing = enter_volume(o, level, ray, std::numeric_limits<double>::infinity());
  if (!crossing) return 1;
  return std::exp(-optical_depth(level, crossing->ray, 0, crossing->end_m - crossing->begin_m));
}

}  // namespace objects
