// Lines of sight one by one, without any saving: what viewsheds are judged by.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/support.h"
#include "vpe/map/height_grid.h"
#include "vpe/map/viewshed/viewshed.h"

namespace vpe::map {

// Follows the line of sight to each post, and meets the ground at each row and column of posts between.
class SightLines {
 public:
  SightLines(const HeightGrid& grid, const ViewshedOptions& options)
      : grid_(grid),
        options_(options),
        eye_m_(double{grid.at(options.column, options.row)} + options.observer_height_m) {}

  // Returns the tangent of the elevation of a point at a distance, by the two axes of the observer's sky.
  double tangent(double height_m, double distance_m) const {
    const double radius = options_.radius_m;
    if (std::isinf(radius)) return (height_m - eye_m_) / distance_m;
    const double angle = distance_m / radius;
    return ((radius + height_m) * std::cos(angle) - (radius + eye_m_)) /
           ((radius + height_m) * std::sin(angle));
  }

  double distance_m(int column, int row) const {
    return grid_.spacing_m * std::hypot(column - options_.column, row - options_.row);
  }

  // Returns the largest tangent of the ground between observer and post; -infinity if there is none.
  double horizon(int column, int row) const {
    const int dx = column - options_.column;
    const int dy = row - options_.row;
    double most = -INFINITY;
    for (int n = 1; n < std::abs(dx); ++n) most = std::max(most, crossing(n * (dx > 0 ? 1 : -1), dy, dx, true));
    for (int n = 1; n < std::abs(dy); ++n)
      most = std::max(most, crossing(n * (dy > 0 ? 1 : -1), dx, dy, false));
    return most;
  }

  bool sees(int column, int row) const {
    if (column == options_.column && row == options_.row) return true;
    const double target_m = double{grid_.at(column, row)} + options_.target_height_m;
    return tangent(target_m, distance_m(column, row)) >= horizon(column, row);
  }

 private:
  // The line crosses the line `along` of posts, `other / all` as far on the other axis.
  double crossing(int along, int other, int all, bool by_columns) const {
    const double across = static_cast<double>(along) * other / all;
    const int before = static_cast<int>(std::floor(across));
    const double part = across - before;
    const auto height = [&](int there) {
      return by_columns ? double{grid_.at(options_.column + along, options_.row + there)}
                        : double{grid_.at(options_.column + there, options_.row + along)};
    };
    const double height_m =
        part == 0 ? height(before) : height(before) + part * (height(before + 1) - height(before));
    const double met = tangent(height_m, grid_.spacing_m * std::hypot(along, across));
    return std::isnan(met) ? -INFINITY : met;
  }

  const HeightGrid& grid_;
  const ViewshedOptions& options_;
  double eye_m_;
};

inline HeightGrid flat_grid(int columns, int rows, double spacing_m, float height_m = 0) {
  return {columns, rows, spacing_m,
          std::vector<float>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), height_m)};
}

inline float& post(HeightGrid& grid, int column, int row) {
  return grid.heights_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                        static_cast<std::size_t>(column)];
}

// Makes ground by displaced midpoints. The side is a power of 2 and one more.
inline HeightGrid fractal_grid(int side, double spacing_m, double height_m, double roughness,
                               std::uint64_t seed) {
  test_support::Random random(seed);
  HeightGrid grid = flat_grid(side, side, spacing_m);
  std::normal_distribution<double> normal;
  double size_m = height_m;
  for (int step = side - 1; step > 1; step /= 2) {
    const int half = step / 2;
    const auto displace = [&](int column, int row, bool is_diagonal) {
      double sum = 0;
      int count = 0;
      for (int n = 0; n < 4; ++n) {
        const int c = column + half * (is_diagonal ? (n % 2 == 0 ? 1 : -1) : (n == 0 ? 1 : n == 1 ? -1 : 0));
        const int r = row + half * (is_diagonal ? (n / 2 == 0 ? 1 : -1) : (n == 2 ? 1 : n == 3 ? -1 : 0));
        if (c < 0 || r < 0 || c >= side || r >= side) continue;
        sum += double{grid.at(c, r)};
        ++count;
      }
      post(grid, column, row) = static_cast<float>(sum / count + size_m * normal(random.engine()));
    };
    for (int row = half; row < side; row += step)
      for (int column = half; column < side; column += step) displace(column, row, true);
    size_m *= std::pow(0.5, roughness / 2);
    for (int row = 0; row < side; row += half)
      for (int column = row / half % 2 == 0 ? half : 0; column < side; column += step)
        displace(column, row, false);
    size_m *= std::pow(0.5, roughness / 2);
  }
  return grid;
}

}  // namespace vpe::map
