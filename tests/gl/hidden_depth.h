// The depth below the reference surface that rays of a drawn image reach: the measure of its silhouettes.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "paging/surface/surface.h"
#include "vpe/core/view.h"

namespace test_support {

// Returns f * depth / distance, the largest over the ray up to what it shows (infinity: the sky), in pixels:
// depth is how far below the reference surface the ray is, radially. Negative for a ray that stays above. Found
// at `samples` places between the ray's entrance among the highest ground and its end or exit.
inline double deepest_px(const paging::Surface& surface, const vpe::core::View& view, const glm::dvec3& ray,
                         double seen_m, double exaggeration, int samples = 400) {
  const paging::PlanetMeta& meta = surface.planet().meta();
  const double highest_m = meta.radius_m + exaggeration * (meta.highest_radius_m - meta.radius_m);
  const glm::dvec3& camera_m = view.camera.position_m;
  const double middle = -glm::dot(camera_m, ray);
  const double under = middle * middle - glm::dot(camera_m, camera_m) + highest_m * highest_m;
  if (under <= 0) return -std::numeric_limits<double>::infinity();
  const double begin = std::max(middle - std::sqrt(under), 0.0);
  const double end = std::min(seen_m, middle + std::sqrt(under));
  if (end <= begin) return -std::numeric_limits<double>::infinity();
  std::vector<glm::dvec3> directions;
  std::vector<double> at_m;
  std::vector<double> height_m;
  for (int k = 1; k <= samples; ++k) {
    const double t = begin + (end - begin) * k / (samples + 1.0);
    const glm::dvec3 place = camera_m + t * ray;
    const double r = glm::length(place);
    directions.push_back(place / r);
    at_m.push_back(t);
    height_m.push_back(r);
  }
  std::vector<double> radius_m(directions.size());
  surface.radius(directions, radius_m, exaggeration);
  double deepest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < at_m.size(); ++k)
    deepest = std::max(deepest, (radius_m[k] - height_m[k]) * vpe::core::focal_px(view) / at_m[k]);
  return deepest;
}

}  // namespace test_support
