// Height maps as shapes of relief ("altitude map" or "shape texture" of Vyatkin and Dolgovesov 2002, section 2).
//
// Posts lie on a regular grid. Between them heights are bilinear or bicubic (patch.h). Beyond the border of the posts
// the height is 0: where border posts are not 0, the shape ends in a wall, unless its surface is limited to the support
// or the posts are tapered().
#pragma once

#include <span>
#include <vector>

#include "relief/field/bounds_pyramid.h"
#include "relief/field/patch.h"
#include "relief/shape.h"

namespace relief {

// Describes where the posts of a map lie: column i at x0_m + i dx_m, row j at y0_m + j dy_m.
struct MapLayout {
  int columns = 0;
  int rows = 0;
  double x0_m = 0;
  double y0_m = 0;
  double dx_m = 1;
  double dy_m = 1;
};

inline constexpr int kMaxMapSide = 32768;

// Holds a height map and its pyramids of least and largest heights, about 15 bytes a post. Immutable.
class HeightMap : public Shape {
 public:
  // Takes posts row by row, row 0 at y0_m. Throws std::invalid_argument if a side has fewer than 2 or more than
  // kMaxMapSide posts, if the posts do not fill the grid, or a number is not finite or a spacing not positive.
  // Bicubic cells at the border take posts beyond it from a straight line through the last two.
  HeightMap(const MapLayout& layout, std::vector<float> posts_m, Interpolation interpolation);

  const MapLayout& layout() const { return layout_; }
  Interpolation interpolation() const { return interpolation_; }

  Rect support() const override { return support_; }
  double height_m(double x_m, double y_m) const override;
  glm::dvec2 gradient(double x_m, double y_m) const override;
  Interval bounds_m(const Rect& rect) const override;

  // Returns an interval that holds the heights of whole cells: of columns i0 to i1 and rows j0 to j1, all included.
  Interval cell_bounds_m(int i0, int i1, int j0, int j1) const { return pyramid_.over(i0, i1, j0, j1); }

  // Returns bounds of a rectangle as bounds_m() does, but of whole cells: quick, and wider.
  Interval coarse_bounds_m(const Rect& rect) const;

  // Returns the patch of a cell, 0 <= i < columns - 1, 0 <= j < rows - 1.
  Patch patch(int i, int j) const;

  // Bounds how far the heights lie from flat facets through the posts (either diagonal): of a cell, of all cells.
  double facet_deviation_m(int i, int j) const { return patch(i, j).facet_deviation_m(); }
  double facet_deviation_m() const { return facet_deviation_m_; }

 private:
  double post(int i, int j) const {
    return static_cast<double>(
        posts_m_[static_cast<std::size_t>(j) * static_cast<std::size_t>(layout_.columns) +
                 static_cast<std::size_t>(i)]);
  }
  double post_beyond(int i, int j) const;
  BoundsPyramid make_pyramid();

  struct Place {
    int i = 0;
    int j = 0;
    double u = 0;
    double v = 0;
  };
  Place place(double x_m, double y_m) const;

  MapLayout layout_;
  Interpolation interpolation_;
  std::vector<float> posts_m_;
  Rect support_;
  double facet_deviation_m_ = 0;
  BoundsPyramid pyramid_;
};

// Returns the posts of a grid with a border that falls smoothly to 0 at its outermost posts, `border_posts` wide.
// Throws std::invalid_argument if the posts do not fill the grid or the border is not positive.
std::vector<float> tapered(std::span<const float> posts_m, int columns, int rows, int border_posts);

}  // namespace relief
