// Grids of a whole planet in longitude and latitude, and smooth functions through their posts.
//
// Post (column i, row j) of a grid with `width` columns lies at longitude (i + 1/2) 360 / width degrees east and latitude
// 90 - (j + 1/2) 360 / width degrees; width = 2 height. Columns wrap; beyond a pole rows continue on the opposite meridian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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

// Holds where a block's directions lie in the cells between the posts of a grid.
struct GridCells {
  alignas(64) Lane<std::int32_t> column, row;  // of the post at the cell's north-western corner
  alignas(64) Lane<double> x, y;               // within the cell, 0..1 eastwards and southwards
  alignas(64) Lane<double> beyond;             // rows beyond the last circle of posts, at most 0 elsewhere
  bool touches_pole = false;                   // some `beyond` exceeds 0
  // Compact blocks lie in few cells, which are evaluated one after another, all directions at a time.
  static constexpr int kFew = 6;
  int few = 0;  // number of different cells, 0 where they are more than kFew
  std::int32_t few_column[kFew], few_row[kFew];
  alignas(64) Lane<std::int32_t> few_index;  // which of them; set where few > 0
};

// Sets `out` for a grid of `width` columns from places in posts of a grid `finer` times as wide.
void grid_cells(const Block& block, const GridPlaces& places, int width, int finer, GridCells& out);

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

  // Holds values, and their derivatives by column and row.
  struct Values {
    alignas(64) Lane<double> value, by_column, by_row;
  };

  // Evaluates in cells of this grid: with derivatives, or the value alone, rounded to single precision.
  void evaluate(const Block& block, const GridCells& cells, Values& out) const;
  void evaluate(const Block& block, const GridCells& cells, Lane<float>& out) const;

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

  // The 4 x 4 coefficients around a cell.
  using Neighbours = std::array<double, 16>;
  Neighbours neighbours(std::int32_t column, std::int32_t row) const;

  // Calls evaluate(c, i) once for each direction i, with the coefficients c around its cell.
  template <class Evaluate>
  void for_each(const Block& block, const GridCells& cells, const Evaluate& evaluate) const;

  void find_pole_values();

  int width_ = 0;
  std::vector<float> coefficients_;
  double pole_[2] = {0, 0};  // value at the north and the south pole
};

}  // namespace mars::embedded
