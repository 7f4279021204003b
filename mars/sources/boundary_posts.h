// Differences between an inset and its base along the boundary of the inset's data.
#pragma once

#include <cstddef>
#include <vector>

#include "mars/sources/source.h"

namespace mars {

struct BoundaryPost {
  glm::dvec3 direction;
  double off_m = 0;  // inset minus base
};

// Returns the inset's own posts within `within_posts` of its data boundary where both sources have data. Looks
// at most at about max_posts posts of the inset. Returns none if the inset is not BoundaryAware. Throws
// SourceError on read errors.
std::vector<BoundaryPost> boundary_posts(const ElevationSource& inset, const ElevationSource& base,
                                         double within_posts, std::size_t max_posts);

}  // namespace mars
