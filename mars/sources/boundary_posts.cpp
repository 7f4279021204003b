#include "mars/sources/boundary_posts.h"

#include <cmath>

#include "mars/sources/stack_walk.h"

namespace mars {

std::vector<BoundaryPost> boundary_posts(const ElevationSource& inset, const ElevationSource& base,
                                         double within_posts, std::size_t max_posts) {
  std::vector<BoundaryPost> posts;
  const auto* boundary = dynamic_cast<const BoundaryAware*>(&inset);
  if (boundary == nullptr) return posts;
  const double spacing_m = resolution_m(inset);
  std::vector<double> distance;
  std::vector<glm::dvec3> places;
  std::vector<double> own_m;
  std::vector<double> base_m;
  inset.visit_posts(max_posts, [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
    distance.resize(directions.size());
    boundary->boundary_distance(directions, within_posts + 1, distance);
    places.clear();
    own_m.clear();
    for (std::size_t i = 0; i < directions.size(); ++i) {
      if (distance[i] > within_posts) continue;
      places.push_back(directions[i]);
      own_m.push_back(heights_m[i]);
    }
    base_m.resize(places.size());
    base.sample(places, spacing_m, base_m);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (std::isfinite(own_m[i] - base_m[i])) posts.push_back({places[i], own_m[i] - base_m[i]});
    }
  });
  return posts;
}

}  // namespace mars
