#include <algorithm>
#include <cmath>
#include <utility>

#include "lod/mesh/mesh.h"

namespace lod {

std::vector<int> choose_border(std::span<const double> height_m, std::span<const double> line, double across,
                               double tolerance_m, double radius_m) {
  const std::size_t count = height_m.size();
  std::vector<double> length(count);
  std::vector<double> w(count);
  for (std::size_t k = 0; k < count; ++k) {
    length[k] = std::sqrt(line[k] * line[k] + (across * across + 1.0));
    w[k] = length[k] / (radius_m + height_m[k]);
  }
  // Symmetric under exchange of the ends, to the last bit.
  const auto geometric_error_m = [&](std::size_t a, std::size_t b, std::size_t k) {
    const double blend = w[a] * (line[b] - line[k]) + w[b] * (line[k] - line[a]);
    return std::abs(length[k] * (line[b] - line[a]) / blend - (radius_m + height_m[k]));
  };
  const auto off_middle = [&](std::size_t a, std::size_t b, std::size_t k) {
    return std::abs((line[k] - line[a]) - (line[b] - line[k]));
  };

  std::vector<int> kept{0, static_cast<int>(count) - 1};
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, count - 1}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    double worst = tolerance_m;
    std::size_t first = b;  // first and last of the posts that are equally bad and equally near the middle
    std::size_t last = b;
    for (std::size_t k = a + 1; k < b; ++k) {
      const double e = geometric_error_m(a, b, k);
      if (e < worst || (e == worst && first == b)) continue;
      const double nearer = first == b ? 0.0 : off_middle(a, b, first) - off_middle(a, b, k);
      if (e > worst || nearer > 0.0) {
        first = last = k;
      } else if (nearer == 0.0) {
        last = k;
      }
      worst = e;
    }
    if (first == b) continue;
    kept.push_back(static_cast<int>(first));
    if (last != first) kept.push_back(static_cast<int>(last));
    open.emplace_back(a, first);
    if (last != first) open.emplace_back(first, last);
    open.emplace_back(last, b);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

BorderPosts choose_borders(const Posts& posts, double tolerance_m, double radius_m) {
  const GridLines lines = grid_lines(posts.key, posts.intervals);
  const int n = posts.intervals;
  std::vector<double> height(static_cast<std::size_t>(posts.side()));
  BorderPosts borders;
  for (const Edge edge : kEdges) {
    const bool along_v = edge == Edge::kWest || edge == Edge::kEast;
    const int fixed = edge == Edge::kEast || edge == Edge::kNorth ? n : 0;
    for (int k = 0; k <= n; ++k)
      height[static_cast<std::size_t>(k)] = along_v ? posts.at(fixed, k) : posts.at(k, fixed);
    const std::vector<double>& across = along_v ? lines.u : lines.v;
    borders[static_cast<std::size_t>(edge)] = choose_border(
        height, along_v ? lines.v : lines.u, across[static_cast<std::size_t>(fixed)], tolerance_m, radius_m);
  }
  return borders;
}

}  // namespace lod
