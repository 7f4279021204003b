// Both sides of the overlay of a mesh with the reference surface S over one finest tile. Internal to lod; use
// lod/mesh/error_meter.h.
//
// Depths are scaled: W = R w = R n / (R + h), and n for heights 0. Both are affine in the chart over a flat
// triangle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
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

// A mesh as planes of depth over its triangles. It keeps its vertices, and makes its pieces when they are asked for, since a
// piece takes several times the memory of the numbers of its vertices.
struct CoarseMesh {
  CoarseMesh(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
             double radius_m);
  // Pieces refer to the vertices.
  CoarseMesh(const CoarseMesh&) = delete;
  CoarseMesh& operator=(const CoarseMesh&) = delete;

  struct Vertex {
    double u, v;
    double depth, length;
  };
  // Bounds in units of the mesh's grid.
  struct Box {
    std::uint16_t i0, i1, j0, j1;
  };
  struct Gradient {
    double du, dv;
  };
  class Triangle {
   public:
    // Corners ascend by (v, u).
    Triangle(const Vertex& low, const Vertex& middle, const Vertex& high);
    Gradient length_gradient() const;

    Vertex corner[3];
    bool middle_left;
    double depth_du, depth_dv;

   private:
    double turn_;  // > 0: the middle corner lies right of the long edge
  };
  struct Segment {
    Vertex from, to;
  };
  // Makes pieces of `Corners` vertices.
  template <class Piece, std::size_t Corners>
  class Pieces {
   public:
    explicit Pieces(const std::vector<Vertex>& vertices) : vertices_(vertices) {}
    std::size_t size() const { return corners_.size(); }
    Piece operator[](std::size_t k) const {
      return std::apply([&](auto... at) { return Piece{vertices_[at]...}; }, corners_[k]);
    }
    void reserve(std::size_t count) { corners_.reserve(count); }
    void resize(std::size_t count) { corners_.resize(count); }
    void add(const std::array<std::uint16_t, Corners>& corners) { corners_.push_back(corners); }
    void set(std::size_t k, const std::array<std::uint16_t, Corners>& corners) { corners_[k] = corners; }

   private:
    const std::vector<Vertex>& vertices_;
    std::vector<std::array<std::uint16_t, Corners>> corners_;
  };

  TileKey key;
  int intervals;
  double radius_m;
  std::vector<Vertex> vertices;
  Pieces<Triangle, 3> triangles{vertices};
  std::vector<Box> triangle_boxes;
  // The edges that can cross grid lines between posts, and the north and east borders, whose posts belong to no
  // triangle.
  Pieces<Segment, 2> segments{vertices};
  std::vector<Box> segment_boxes;
};

inline CoarseMesh::Triangle::Triangle(const Vertex& low, const Vertex& middle, const Vertex& high)
    : corner{low, middle, high} {
  const double bu = middle.u - low.u;
  const double bv = middle.v - low.v;
  const double cu = high.u - low.u;
  const double cv = high.v - low.v;
  const double depth_b = middle.depth - low.depth;
  const double depth_c = high.depth - low.depth;
  turn_ = bu * cv - bv * cu;
  middle_left = turn_ < 0.0;
  depth_du = (depth_b * cv - depth_c * bv) / turn_;
  depth_dv = (depth_c * bu - depth_b * cu) / turn_;
}

inline CoarseMesh::Gradient CoarseMesh::Triangle::length_gradient() const {
  const auto& [a, b, c] = corner;
  const double length_b = b.length - a.length;
  const double length_c = c.length - a.length;
  return {(length_b * (c.v - a.v) - length_c * (b.v - a.v)) / turn_,
          (length_c * (b.u - a.u) - length_b * (c.u - a.u)) / turn_};
}

}  // namespace lod
