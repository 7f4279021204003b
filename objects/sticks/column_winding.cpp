#include "objects/sticks/column_winding.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace objects {

namespace {

// Lines through columns lie a little beside the middles, where meshes often have edges.
constexpr double kLineAside_x = 1.37e-5;
constexpr double kLineAside_y = 2.91e-5;

}  // namespace

void ColumnWinding::add(const VoxelTriangle& t) {
  const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
  if (n.z == 0) return;
  const auto [low, high] = std::minmax({t[0].y, t[1].y, t[2].y});
  const int first_y = std::max(0, static_cast<int>(std::floor(low - 0.5)));
  const int last_y = std::min(grid_.columns_y - 1, static_cast<int>(std::ceil(high)));
  for (int y = first_y; y <= last_y; ++y) {
    const double line_y = y + 0.5 + kLineAside_y;
    std::array<double, 2> ends{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3* a = &t[k];
      const glm::dvec3* b = &t[(k + 1) % 3];
      if ((a->y <= line_y) == (b->y <= line_y)) continue;
      if (a->y > b->y) std::swap(a, b);  // the same rounding for both triangles of an edge
      if (count < 2) ends[count++] = a->x + (b->x - a->x) * ((line_y - a->y) / (b->y - a->y));
    }
    if (count < 2) continue;
    if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
    const auto first_line = [&](double x) {
      return static_cast<int>(
          std::clamp(std::ceil(x - 0.5 - kLineAside_x), 0.0, static_cast<double>(grid_.columns_x)));
    };
    const int past_x = first_line(ends[1]);
    for (int x = first_line(ends[0]); x < past_x; ++x) {
      const double line_x = x + 0.5 + kLineAside_x;
      const double height = t[0].z - (n.x * (line_x - t[0].x) + n.y * (line_y - t[0].y)) / n.z;
      const std::size_t column =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.columns_x) + static_cast<std::size_t>(x);
      crossings_.push_back({static_cast<std::uint32_t>(column), static_cast<float>(height), n.z < 0 ? 1 : -1});
    }
  }
}

VoxelGrid ColumnWinding::inside() const {
  VoxelGrid out(grid_);
  std::vector<std::uint32_t> first(out.columns() + 1, 0);
  for (const Crossing& c : crossings_) ++first[c.column + 1];
  for (std::size_t n = 1; n < first.size(); ++n) first[n] += first[n - 1];
  std::vector<Crossing> sorted(crossings_.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (const Crossing& c : crossings_) sorted[next[c.column]++] = c;
  for (std::size_t column = 0; column < out.columns(); ++column) {
    const auto begin = sorted.begin() + first[column];
    const auto end = sorted.begin() + first[column + 1];
    int sum = 0;
    for (auto c = begin; c != end; ++c) sum += c->turn;
    if (begin == end || sum != 0) continue;
    std::sort(begin, end, [](const Crossing& a, const Crossing& b) { return a.height < b.height; });
    const int x = static_cast<int>(column % static_cast<std::size_t>(grid_.columns_x));
    const int y = static_cast<int>(column / static_cast<std::size_t>(grid_.columns_x));
    const auto first_centre = [&](float height) {
      return static_cast<int>(std::clamp(std::ceil(height - 0.5F), 0.0F, static_cast<float>(grid_.height)));
    };
    for (auto c = begin; c + 1 != end; ++c) {
      sum += c->turn;
      const int past = first_centre((c + 1)->height);
      for (int z = first_centre(c->height); sum != 0 && z < past; ++z) out.set(x, y, z);
    }
  }
  return out;
}

}  // namespace objects
