// Grids of a whole planet in longitude and latitude, and smooth functions through their posts.
//
// Post (column i, row j) of a grid with `width` columns lies at longitude (i + 1/2) 360 / width degrees east and latitude
// 90 - (j + 1/2) 360 / width degrees; width = 2 height. Columns wrap; beyond a pole rows continue on the opposite meridian.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mars/embedded/block.h"

namespace mars::embedded {

// Holds fractional columns and rows of a block's directions, in posts of a grid of `width` columns: column in
// [-0.5, width - 0.5), row in [-0.5, height - 0.5]. Error below 1e-12 of a full circle.
struct GridPlaces {
  alignas(64) Lane<double> column, row;
};

// Sets `out`. Uses IEEE operations alone, so that it gives equal bits everywhere.
void grid_places(const Block& block, int width, GridPlaces& out);

// Holds the cubic B-spline of a grid: twice continuously differentiable, but at the poles themselves, where it is
// continuous.
class GlobeSpline {
 public:
  GlobeSpline() = default;

  // Makes the spline through all posts. `posts` are rows from the north, columns from longitude 0 eastwards.
  static GlobeSpline through(std::span<const float> posts, int width);

  // Makes a spline that smooths the posts by the B-spline's own weights and passes near them. It never exceeds
  // their extremes.
  static GlobeSpline near(std::span<const float> posts, int width);

  int width() const { return width_; }
  int height() const { return width_ / 2; }
  bool empty() const { return coefficients_.empty(); }

  // Holds values, and their derivatives by column and row where asked for.
  struct Values {
    alignas(64) Lane<double> value, by_column, by_row;
  };

  // Evaluates at places given in posts of this grid.
  void evaluate(const Block& block, const GridPlaces& places, Values& out) const;

  // Evaluates the value alone at places given in posts of a grid `finer` times as wide.
  void evaluate(const Block& block, const GridPlaces& places, int finer, Lane<float>& out) const;

 private:
  // Returns the coefficient of a post that may lie beyond the seam or a pole.
  float at(int column, int row) const {
    if (row < 0) {
      row = -1 - row;
      column += width_ / 2;
    } else if (row >= width_ / 2) {
      row = width_ - 1 - row;
      column += width_ / 2;
    }
    if (column < 0) column += width_;
    while (column >= width_) column -= width_;
    return coefficients_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                         static_cast<std::size_t>(column)];
  }

  // The 4 x 4 coefficients around a cell. Directions of a block are in few cells.
  struct Neighbours {
    int column = -1000, row = -1000;
    double c[16];
  };
  void gather(int column, int row, Neighbours& near) const;

  void find_pole_values();

  int width_ = 0;
  std::vector<float> coefficients_;
  double pole_[2] = {0, 0};  // value at the north and the south pole
};

}  // namespace mars::embedded
