// Depths of posts in vectors, and their largest differences from a flat triangle. Internal to lod; use
// lod/mesh/overlay_cut.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lod {

// Lines along u and rows of depths have so many entries more, of any finite value.
inline constexpr std::size_t kDepthPad = 4;

// The posts of a tile, row by row.
struct DepthPosts {
  const double* depth;
  const double* u;
  const double* v;
  std::size_t side;
};

// A flat triangle: its depth at the point (u, v), and slopes.
struct DepthPlane {
  double depth, du, dv;
  double u, v;
};

// A side of a triangle as the function at + along_u u + along_v v, not below 0 for the posts that the triangle has.
struct DepthSide {
  double at, along_u, along_v;
};

// The columns i0 <= i < i1 and rows j0 <= j < j1 around a triangle.
struct DepthBox {
  std::uint32_t i0, i1, j0, j1;
};

// The largest differences, at least 0, of posts that are deeper and of posts that are higher.
struct DepthDifferences {
  double below = 0;
  double above = 0;
};

// Returns the largest differences between the depths of posts and the plane, over the posts of a box that are inside three
// sides, up to rounding of 4e-16 of the depths. Posts beside the box, up to the end of a vector, may count too.
DepthDifferences largest_differences(const DepthPosts& posts, const DepthPlane& plane,
                                     const std::array<DepthSide, 3>& sides, const DepthBox& box);

// A row of posts, and where their depths go.
struct DepthRow {
  const double* u;
  const double* height_m;
  double v2;  // v^2
  double radius_m;
  std::size_t count;
};

// Sets the lengths n = sqrt(u^2 + v^2 + 1) and the depths n R / (R + h) of a row's posts. The bits do not depend on the
// instruction set.
void fill_depths(const DepthRow& row, double* length, double* depth);

// The least depth of two rows of `count` posts each, and the largest difference between the corners of a cell.
struct DepthRange {
  double least;
  double cell;
};
DepthRange range_of_depths(const double* low, const double* high, std::size_t count);

}  // namespace lod
