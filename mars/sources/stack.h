// What a source may tell of its own rim, so that a stack can fade it into what lies below.
#pragma once

#include <glm/vec3.hpp>
#include <span>

namespace mars {

class BoundaryAware {
 public:
  virtual ~BoundaryAware() = default;

  // Distance of each place from the rim of the source's data (its border, and places without data inside), in
  // its own posts, at most `limit_posts`; 0 where it has no data. Continuous but for steps below half a post
  // at corners of holes; a function of the place alone. Throws SourceError on a read error.
  virtual void boundary_distance(std::span<const glm::dvec3> directions, double limit_posts,
                                 std::span<double> posts) const = 0;
};

// Widest rim that a stack feathers, posts.
inline constexpr double kMaxFeather_posts = 256;

}  // namespace mars
