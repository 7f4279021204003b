// The distances at the vertices of the overlay of a mesh with the reference surface S. Internal to lod; use
// lod/mesh/error_meter.h.
#pragma once

#include "lod/mesh/mesh_overlay.h"
#include "lod/mesh/overlay_cut.h"
#include "lod/tree/error_terms.h"

namespace lod {

// Visits the vertices of the overlay over one finest tile, and keeps the largest distances.
class OverlayPoints {
 public:
  OverlayPoints(const CoarseMesh& mesh, const FineGrid& fine)
      : mesh_(mesh), fine_(fine), side_(fine.u.count()) {}

  // Records how much a mesh triangle's depths vary over one cell. Every triangle over the tile must be recorded.
  void vary(const CoarseMesh::Triangle& t);

  // Visits the posts under a triangle.
  void add_posts(const CoarseMesh::Triangle& t);

  // Visits the points where a mesh edge crosses lines and diagonals, cell by cell. The ends of slanting edges
  // are posts of S, which the triangles around them or the north and east borders have visited.
  void add_crossings(const CoarseMesh::Segment& s);

  LargestDistances largest() const { return {largest(total_), largest(sagitta_), largest(height_error_)}; }

  // Returns the terms for all that was visited and recorded.
  ErrorTerms terms() const;

 private:
  using Pair = double __attribute__((vector_size(16)));

  struct Point {
    double t, u, v;
  };

  static double largest(Pair pair) { return pair[0] > pair[1] ? pair[0] : pair[1]; }
  template <class T>
  void add(T n, T mesh_depth, T depth, T mesh_length, T length, T& total_most, T& sagitta_most,
           T& height_error_most) const;
  void add(double n, double mesh_depth, double depth, double mesh_length, double length);
  void add_row(const CoarseMesh::Triangle& t, const CoarseMesh::Gradient& length_by, int j, int first, int end);
  void add_point(const CoarseMesh::Segment& s, const Point& p, int i, int j, double x, double y);

  const CoarseMesh& mesh_;
  const FineGrid& fine_;
  int side_;
  Pair total_{0.0, 0.0};
  Pair sagitta_{0.0, 0.0};
  Pair height_error_{0.0, 0.0};
  double depth_variation_ = 0;
  double length_variation_ = 0;
};

}  // namespace lod
