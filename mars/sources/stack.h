// Optional interface of a source that knows the boundary of its data, so that a stack can feather it into the
// coarser sources below.
#pragma once

#include <glm/vec3.hpp>
#include <span>

namespace mars {

class ElevationSource;

class BoundaryAware {
 public:
  virtual ~BoundaryAware() = default;

  // Sets posts[i] to the distance of each place from the boundary of the source's data (its border, and nodata
  // inside), in posts of the source, at most `limit_posts`. It is 0 where the source has nodata. It is a
  // function of the place alone, continuous except for steps below half a post at corners of nodata areas.
  // Throws SourceError on a read error.
  virtual void boundary_distance(std::span<const glm::dvec3> directions, double limit_posts,
                                 std::span<double> posts) const = 0;
};

// Sets posts[i] for any source: a source that does not know its boundary is not faded, so that the distance is the limit
// wherever it has data. Throws SourceError on a read error.
void boundary_distance_of(const ElevationSource& source, std::span<const glm::dvec3> directions,
                          double limit_posts, std::span<double> posts);

// Widest boundary that a stack feathers, in posts of the finer source.
inline constexpr double kMaxFeather_posts = 256;

}  // namespace mars
