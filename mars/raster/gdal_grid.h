// Pixel grid of a raster that may wrap around the planet and reach its poles, and interpolation in it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace mars {

// Describes the grid. Pixel coordinates (0, 0) are the centre of the first pixel. Rows may run north or south.
struct PixelGrid {
  int width = 0;
  int height = 0;
  double period = 0;   // columns in 360 degrees where columns are even in longitude, else 0
  bool wraps = false;  // the first column follows the last one
  // Rows of the poles, beyond the first and last row centres, for maps that wrap; infinite if a pole is not
  // included.
  double first_pole_row = -std::numeric_limits<double>::infinity();
  double last_pole_row = std::numeric_limits<double>::infinity();

  bool has_first_pole() const { return std::isfinite(first_pole_row); }
  bool has_last_pole() const { return std::isfinite(last_pole_row); }
  // Return the row whose mean is the value at a pole.
  int first_polar_row() const { return std::max(0, static_cast<int>(std::lround(first_pole_row))); }
  int last_polar_row() const { return std::min(height - 1, static_cast<int>(std::lround(last_pole_row))); }

  // Returns the grid of averages of 2^level x 2^level pixels.
  PixelGrid reduced(int level) const;
};

// Describes the pixels column .. column + columns - 1, rows likewise.
struct PixelWindow {
  int column = 0;
  int row = 0;
  int columns = 0;
  int rows = 0;
};

enum class Pole { kNone, kFirst, kLast };

// Describes the 2x2 pixels from which a value is interpolated. They start at (column, row); fx and fy are in
// [0, 1). Next to a pole the value is interpolated along the row alone and blended with the one value at the
// pole, so that all longitudes agree there.
struct PixelNeighbourhood {
  int column = 0;
  int row = 0;
  double fx = 0;
  double fy = 0;
  Pole pole = Pole::kNone;
  double pole_share = 0;
};

inline PixelGrid PixelGrid::reduced(int level) const {
  const double scale = std::ldexp(1.0, -level);
  const auto reduce = [&](int size) {
    return static_cast<int>((static_cast<long>(size) + (1L << level) - 1) >> level);
  };
  PixelGrid grid = *this;
  grid.width = reduce(width);
  grid.height = reduce(height);
  grid.period = period * scale;
  grid.first_pole_row = (first_pole_row + 0.5) * scale - 0.5;
  grid.last_pole_row = (last_pole_row + 0.5) * scale - 0.5;
  return grid;
}

// Finds the pixels for a position. Returns false outside the raster, i.e. more than half a pixel from the outer
// pixel centres, and for NaN.
inline bool locate(const PixelGrid& grid, double x, double y, PixelNeighbourhood& place) {
  if (!std::isfinite(x) || !std::isfinite(y)) return false;
  const double last_column = grid.width - 1;
  const double last_row = grid.height - 1;
  if (grid.period > 0) {
    const double start = grid.wraps ? 0.0 : (last_column - grid.period) / 2;
    if (x < start || x >= start + grid.period) {
      x -= grid.period * std::floor((x - start) / grid.period);
      if (x >= start + grid.period || x < start) x = start;
    }
  }
  if (grid.wraps) {
    place.column = static_cast<int>(x < last_column ? x : last_column);
    place.fx = x - place.column;
    // The step over the seam is a pixel only if the columns fill 360 degrees exactly.
    if (x > last_column) place.fx /= grid.period - last_column;
  } else {
    if (x < -0.5 || x > last_column + 0.5) return false;
    x = x < 0 ? 0 : x > last_column ? last_column : x;
    place.column = static_cast<int>(x);
    place.fx = x - place.column;
  }
  place.pole = Pole::kNone;
  place.pole_share = 0;
  place.fy = 0;
  // Poles that are not included have infinite rows. Rounding to rows takes longer than all else.
  if (y < grid.first_pole_row + 1) {
    const double first = std::floor(grid.first_pole_row) + 1;
    if (y < first) {
      place.row = static_cast<int>(first);
      place.pole = Pole::kFirst;
      place.pole_share = std::min(1.0, (first - y) / (first - grid.first_pole_row));
      return true;
    }
  }
  if (y > grid.last_pole_row - 1) {
    const double last = std::ceil(grid.last_pole_row) - 1;
    if (y > last) {
      place.row = static_cast<int>(last);
      place.pole = Pole::kLast;
      place.pole_share = std::min(1.0, (y - last) / (grid.last_pole_row - last));
      return true;
    }
  }
  if (y < -0.5 || y > last_row + 0.5) return false;
  y = y < 0 ? 0 : y > last_row ? last_row : y;
  place.row = static_cast<int>(y);
  place.fy = y - place.row;
  return true;
}

}  // namespace mars
