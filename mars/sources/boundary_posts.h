// What an inset lies above its base along its rim.
#pragma once

#include <cstddef>
#include <vector>

#include "mars/sources/source.h"

namespace mars {

struct BoundaryPost {
  glm::dvec3 direction;
  double off_m = 0;  // inset less base
};

// The inset's own posts, of at most about max_posts of them, within `within_posts` of its rim where both have
// data. None of an inset that knows of no rim (not BoundaryAware). Throws SourceError on read errors.
std::vector<BoundaryPost> boundary_posts(const ElevationSource& inset, const ElevationSource& base,
                                         double within_posts, std::size_t max_posts);

}  // namespace mars
