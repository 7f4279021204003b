// Both sides of the overlay of a mesh with the reference surface S over one finest tile. Internal to lod; use
// lod/mesh/error_meter.h.
//
// Depths are scaled: W = R w = R n / (R + h), and n for heights 0. Both are affine in the chart over a flat
// triangle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lod/mesh/depth_kernel.h"
#include "lod/mesh/mesh.h"

namespace lod {

// Holds ascending lines, with a table that finds a line in constant time.
class LineTable {
 public:
  explicit LineTable(std::vector<double> lines);
  int count() const { return static_cast<int>(line_.size()); }
  double operator[](int k) const { return line_[static_cast<std::size_t>(k)]; }
  const double* data() const { return line_.data(); }
  const double* inverse_widths() const { return inverse_width_.data(); }
  double widest() const { return widest_; }

  // Returns the first line at or beyond x, or count() if there is none.
  int first(double x) const {
    const double at = (x - line_.front()) * buckets_per_unit_ - 0.5;
    if (!(at > 0.0)) return x <= line_.front() ? 0 : 1;
    if (x > line_.back()) return count();
    auto i = static_cast<std::size_t>(first_in_bucket_[static_cast<std::size_t>(at)]);
    while (line_[i] < x) ++i;
    return static_cast<int>(i);
  }
  // Returns the interval that contains x, clamped.
  int interval(double x) const {
    const int i = first(x);
    return i == 0 ? 0 : i >= count() ? count() - 2 : i - 1;
  }
  // Returns the position of x in an interval, 0..1, clamped.
  double fraction(int interval, double x) const {
    const double f = (x - (*this)[interval]) * inverse_width_[static_cast<std::size_t>(interval)];
    return f < 0.0 ? 0.0 : f > 1.0 ? 1.0 : f;
  }

 private:
  std::vector<double> line_;
  std::vector<double> inverse_width_;
  std::vector<int> first_in_bucket_;  // buckets are at most as wide as the narrowest interval
  double buckets_per_unit_ = 0;
  double widest_ = 0;
};

// The posts of a finest tile as depths.
struct FineGrid {
  FineGrid(const Posts& posts, double radius_m);

  std::size_t side() const { return static_cast<std::size_t>(intervals) + 1; }

  TileKey key;
  int intervals;
  double radius_m;
  LineTable u;
  LineTable v;
  std::vector<double> padded_u;  // u with kDepthPad entries beyond it
  std::vector<double> depth;     // W, with kDepthPad entries more
  std::vector<double> length;    // n
  double depth_variation = 0;    // largest variation of W over a cell, relative to its least value
  double length_variation = 0;
  double highest_m = 0;
};

// A mesh as planes of depth over its triangles.
struct CoarseMesh {
  CoarseMesh(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
             double radius_m);

  struct Vertex {
    double u, v;
    double depth, length;
  };
  // Bounds in units of the mesh's grid.
  struct Box {
    std::uint16_t i0, i1, j0, j1;
  };
  struct Triangle {
    Vertex corner[3];  // ascending (v, u)
    bool middle_left;
    double depth_du, depth_dv, length_du, length_dv;
  };
  struct Segment {
    Vertex from, to;
  };

  TileKey key;
  int intervals;
  double radius_m;
  std::vector<Triangle> triangles;
  std::vector<Box> triangle_boxes;
  // The edges that can cross grid lines between posts, and the north and east borders, whose posts belong to no
  // triangle.
  std::vector<Segment> segments;
  std::vector<Box> segment_boxes;
};

}  // namespace lod
