// Smooth patches: the heights of one cell of a height map.
//
// Coordinates (u, v) run from 0 to 1 across the cell, u with x and v with y; heights are in metres. A bilinear patch has
// the four posts of its cell. A bicubic one is the Catmull-Rom patch of 4 x 4 posts in Bezier form: it goes through the
// posts of its cell, so that it differs from flat facets between posts alone, and it has the slope of its neighbours
// at the borders. (A B-spline would be smoother, but would miss the posts.)
// Everything is a pure function of values and may be called from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

#include "relief/shape.h"

namespace relief {

enum class Interpolation : std::uint8_t { kBilinear, kBicubic };

// Holds a patch. Its height is a polynomial of the first or third degree in each coordinate.
class Patch {
 public:
  // Makes a patch from the posts at (0, 0), (1, 0), (0, 1), (1, 1).
  static Patch bilinear(double h00, double h10, double h01, double h11);

  // Makes a patch from 4 x 4 posts, rows along u, the cell in the middle: post 4 (j + 1) + i + 1 lies at (i, j).
  static Patch bicubic(const std::array<double, 16>& posts_m);

  Interpolation interpolation() const { return interpolation_; }

  double height_m(double u, double v) const;

  // Returns the derivatives by u and v, in metres a cell.
  glm::dvec2 gradient(double u, double v) const;

  // Returns an interval that holds the heights of the cell: those of the posts, or of the Bezier points.
  Interval bounds_m() const;

  // Returns an interval that holds the heights of a part of the cell. Exact for bilinear patches.
  Interval bounds_m(const Interval& u, const Interval& v) const;

  // Bounds how far the patch lies from the two flat triangles through the posts of its cell, whichever diagonal they share:
  // |h00 - h10 - h01 + h11| / 4 for a bilinear patch, which the middle of the cell reaches. A bicubic patch adds
  // 15/16 of the largest distance of its Bezier points from those of the bilinear one: the four corners, where both
  // agree, have at least 1/16 of the weight everywhere.
  double facet_deviation_m() const;

 private:
  friend class PatchSlopes;

  Interpolation interpolation_ = Interpolation::kBilinear;
  // Bilinear: h00, h10, h01, h11. Bicubic: Bezier points, row by row along u.
  std::array<double, 16> points_m_{};
};

// Bounds the derivatives of a patch over parts of its cell.
class PatchSlopes {
 public:
  // Expects a patch that outlives it.
  explicit PatchSlopes(const Patch& patch);

  struct Slopes {
    Interval u;  // metres a cell
    Interval v;
  };
  // Returns intervals that hold the derivatives over a part of the cell. They shrink to the gradient as the part shrinks
  // to a point. Exact for bilinear patches.
  Slopes over(const Interval& u, const Interval& v) const;

 private:
  const Patch& patch_;
  Interval u_;  // over the whole cell, from differences of Bezier points
  Interval v_;
  double uu_ = 0;  // largest second derivatives
  double uv_ = 0;
  double vv_ = 0;
  double slack_ = 0;  // for rounding
};

}  // namespace relief
