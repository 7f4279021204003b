#include "lod/mesh/greedy_scan.h"

#include <algorithm>
#include <cmath>

namespace lod {

void PostField::load(const Posts& posts, double radius_m) {
  side_ = static_cast<std::uint32_t>(posts.side());
  const GridLines lines = grid_lines(posts.key, posts.intervals);
  const std::size_t count = posts.height_m.size();
  w_.resize(count + kScanPad);
  weight_.resize(count + kScanPad);
  lowest_radius_m_ = radius_m + *std::min_element(posts.height_m.begin(), posts.height_m.end());
  for (std::size_t j = 0; j < side_; ++j) {
    const double* height = posts.height_m.data() + j * side_;
    double* w = w_.data() + j * side_;
    double* weight = weight_.data() + j * side_;
    const double vv = lines.v[j] * lines.v[j];
    for (std::size_t i = 0; i < side_; ++i) {
      const double r = radius_m + height[i];
      const double inverse = 1.0 / r;
      const double n = std::sqrt(lines.u[i] * lines.u[i] + vv + 1.0);
      w[i] = n * inverse;
      weight[i] = r * r / n;
    }
  }
}

void PostField::set_lines(const std::vector<std::int64_t>& x, const std::vector<std::int64_t>& y) {
  has_exact_sides_ = std::max(x.back(), y.back()) < kMostExact;
  x_.assign(x.begin(), x.end());
  y_.assign(y.begin(), y.end());
  const auto inverse_widths = [](const std::vector<double>& line, std::vector<double>& inverse) {
    inverse.clear();
    for (std::size_t k = 0; k + 1 < line.size(); ++k) inverse.push_back(1.0 / (line[k + 1] - line[k]));
  };
  inverse_widths(x_, per_column_);
  inverse_widths(y_, per_row_);
  x_.resize(x_.size() + kScanPad, static_cast<double>(2 * kMostExact));
}

void PostField::ignore_borders() {
  const std::size_t last = side_ - 1;
  for (std::size_t k = 0; k < side_; ++k) {
    weight_[k] = weight_[last * side_ + k] = 0;
    weight_[k * side_] = weight_[k * side_ + last] = 0;
  }
}

}  // namespace lod
