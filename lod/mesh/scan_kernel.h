// The errors of the posts under one flat triangle, in vectors. Internal to lod; use lod/mesh/greedy_scan.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "lod/mesh/greedy_heap.h"

namespace lod {

// Arrays that are scanned have so many entries more than posts or lines.
inline constexpr std::size_t kScanPad = 4;

// The posts of a tile, row by row: inverse depths w, and the factors that make errors of their differences.
struct ScannedPosts {
  const double* w;
  const double* weight;  // 0: a post without error
  const double* x;       // coordinates of columns; of the padding, beyond all posts
  const double* y;       // coordinates of rows
  std::size_t side;
};

// A flat triangle as a plane of inverse depths: w at the point (x, y), and slopes.
struct ScannedPlane {
  double w, dx, dy;
  double x, y;
};

// A side of a counter-clockwise triangle as the function at + along_x x + along_y y of a post's coordinates, above 0 for
// posts that the triangle has. Its values at posts are exact, so that neighbours agree about posts on their side.
struct ScannedSide {
  double at, along_x, along_y;
};

// The columns i0 <= i < i1 and rows j0 <= j < j1 around a triangle.
struct ScannedBox {
  std::uint32_t i0, i1, j0, j1;
};

// The posts first <= i < end of row j.
struct ScannedRow {
  std::uint32_t j;
  int first, end;
};

// Returns the worst post of a triangle, of equals the lowest in (j, i) order.
WorstPost worst_in_box(const ScannedPosts& posts, const ScannedPlane& plane,
                       const std::array<ScannedSide, 3>& sides, const ScannedBox& box);

// Replaces `worst` by the worst post of some rows, if that is worse. Rows ascend.
void scan_rows(const ScannedPosts& posts, const ScannedPlane& plane, std::span<const ScannedRow> rows,
               WorstPost& worst);

}  // namespace lod
