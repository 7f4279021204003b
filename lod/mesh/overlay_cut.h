// Leaves out the pieces of an overlay that cannot have the largest distance. Internal to lod; use lod/mesh/error_meter.h.
//
// A distance at a point is total = D n R / (W (W + D)), where D is the difference of the scaled depths of S and the mesh, W
// the mesh's depth and n the length of the direction. So a bound of total is one of D alone, which needs no roots and no
// divisions at points. The sagitta of a flat triangle is bounded by its size, and the height error is total - sagitta.
// Hence a triangle or an edge is left out when its sagitta's bound is below the largest sagitta so far, and |D| below what
// the largest total and height error so far allow. What is left out never changes a bit of the maxima.
#pragma once

#include "lod/mesh/depth_kernel.h"
#include "lod/mesh/mesh_overlay.h"

namespace lod {

// The largest distances so far.
struct LargestDistances {
  double total_m = 0;
  double sagitta_m = 0;
  double height_error_m = 0;
};

// Judges the pieces of a mesh over a finest tile whose lines are those of the mesh's grid.
class OverlayCut {
 public:
  // The tile's first column and row in the mesh's grid.
  OverlayCut(const CoarseMesh& mesh, const FineGrid& fine, std::int64_t first_i, std::int64_t first_j);

  // Return true if no post under a triangle (no crossing of a slanting edge with S) raises any of the largest distances.
  // False may be wrong, true never is. They return false for pieces that reach beyond the tile.
  bool leaves_out(const CoarseMesh::Triangle& t, const CoarseMesh::Box& box,
                  const LargestDistances& most) const;
  bool leaves_out(const CoarseMesh::Segment& s, const CoarseMesh::Box& box, const LargestDistances& most) const;

 private:
  // Holds what bounds the distances over a piece, from its corners.
  struct Extent {
    double least_depth;
    double least_length;
    double most_length;
    double half_curve;  // (radius of a circle around the corners)^2 / 2
  };
  // The largest differences of depth that raise nothing, where S is deeper than the mesh and where it is higher; below 0 if
  // there are none.
  struct Limits {
    double below;
    double above;
  };
  Limits limits(const Extent& extent, double span, const LargestDistances& most) const;
  bool to_tile(const CoarseMesh::Box& box, DepthBox& own) const;
  // Returns true if the edge has no crossing with a difference of depth beyond the limits.
  bool stays_within(const CoarseMesh::Segment& s, const DepthBox& box, const Limits& limit) const;

  const FineGrid& fine_;
  double radius_m_;
  double cell_curve_;  // half_curve of a cell
  double rounding_;    // of differences of depth
  std::int64_t first_i_, first_j_;
  std::int64_t intervals_;
};

}  // namespace lod
