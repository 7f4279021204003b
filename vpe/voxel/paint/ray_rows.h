// Computes the rays of an image row by row as sums of a few terms, so that no pixel needs a sine or a whole
// vector.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): the first step of ImagePainter.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "vpe/core/view.h"

namespace vpe::voxel {

// Pixels that the painting kernel takes at once. Columns are padded to a multiple of it.
inline constexpr int kBlock = 32;

// Describes the rays of one row: the body-fixed direction through the centre of pixel x is a c0[x] + b c1[x] +
// c, with the columns c0 and c1 that all rows share. b is 0 in perspective.
struct RowRays {
  glm::dvec3 a, b, c;
  // The square of the direction's length is m0 + c0 (m1 + c0 m2), near 1 about the principal point.
  double m0 = 1, m1 = 0, m2 = 0;
};

// Holds the rays of the drawn part of a view. Directions are those of core::pixel_ray() up to their length,
// within 1e-14 rad.
struct RayRows {
  std::vector<double> c0, c1;  // by column, and up to kBlock - 1 more for padding
  std::vector<RowRays> rows;
};

// Returns the rays of a view of any projection.
RayRows ray_rows(const core::View& view);

}  // namespace vpe::voxel
