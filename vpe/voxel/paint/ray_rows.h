// The rays of an image row by row, as sums of a few terms: no pixel needs a sine or a whole vector.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "vpe/core/view.h"

namespace vpe::voxel {

// Pixels that the kernels take at once; columns are padded to it.
inline constexpr int kBlock = 32;

// Body-fixed direction through the centre of pixel x of one row: a c0[x] + b c1[x] + c, with the columns c0 and
// c1 that all rows share. b is 0 in perspective.
struct RowRays {
  glm::dvec3 a, b, c;
  // Square of its length: m0 + c0 (m1 + c0 m2), near 1 about the principal point.
  double m0 = 1, m1 = 0, m2 = 0;
  double forward = 0;  // its part along the camera's axis, in perspective
};

// Of the drawn part of a view; directions are those of core::pixel_ray up to their length, within 1e-14 rad.
struct RayRows {
  std::vector<double> c0, c1;  // by column, and up to kBlock - 1 more
  std::vector<RowRays> rows;
};
RayRows ray_rows(const core::View& view);

}  // namespace vpe::voxel
