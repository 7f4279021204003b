#include "tests/bench/simplify_methods.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "lod/mesh/greedy.h"

namespace bench {

namespace {

lod::TileMesh from_triangles(int intervals, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  std::vector<std::uint32_t> posts;
  for (const auto& t : triangles) posts.insert(posts.end(), t.begin(), t.end());
  std::sort(posts.begin(), posts.end());
  posts.erase(std::unique(posts.begin(), posts.end()), posts.end());
  return lod::canonical_mesh(intervals, posts, triangles);
}

}  // namespace

lod::TileMesh regular_grid(int intervals, int step) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto post = [&](int i, int j) { return static_cast<std::uint32_t>(j * (intervals + 1) + i); };
  for (int j = 0; j < intervals; j += step) {
    for (int i = 0; i < intervals; i += step) {
      triangles.push_back({post(i, j), post(i + step, j), post(i + step, j + step)});
      triangles.push_back({post(i, j), post(i + step, j + step), post(i, j + step)});
    }
  }
  return from_triangles(intervals, triangles);
}

// Triangles a b c with the hypotenuse a b; children share its middle.
template <class Visit>
void Rtin::at_depth(Post a, Post b, Post c, int depth, Visit&& visit) const {
  if (depth == 0) {
    visit(a, b, c);
    return;
  }
  const Post middle{(a.i + b.i) / 2, (a.j + b.j) / 2};
  at_depth(c, a, middle, depth - 1, visit);
  at_depth(b, c, middle, depth - 1, visit);
}

Rtin::Rtin(const lod::Posts& posts, double radius_m)
    : side_(posts.side()), geometric_error_m_(posts.height_m.size()) {
  const int n = posts.intervals;
  const lod::EvenLines lines(n);
  lod::PostField field;
  field.load(posts, radius_m);
  field.set_lines(lines.x(), lines.y());
  const lod::GridLines chart = lod::grid_lines(posts.key, n);
  const auto w = [&](Post p) {
    return lod::inverse_depth(chart.u[static_cast<std::size_t>(p.i)], chart.v[static_cast<std::size_t>(p.j)],
                              posts.at(p.i, p.j), radius_m);
  };
  const auto corner = [&](Post p) {
    return lod::Corner{static_cast<std::uint32_t>(p.j * side_ + p.i), static_cast<std::uint16_t>(p.i),
                       static_cast<std::uint16_t>(p.j), p.i, p.j};
  };
  // The north and east borders belong to no triangle of the field.
  const auto along_border = [&](Post a, Post b) {
    if (!(a.i == n && b.i == n) && !(a.j == n && b.j == n)) return 0.0;
    const int count = std::max(std::abs(b.i - a.i), std::abs(b.j - a.j));
    double worst = 0;
    for (int k = 1; k < count; ++k) {
      const Post p{a.i + (b.i - a.i) / count * k, a.j + (b.j - a.j) / count * k};
      const double r = radius_m + posts.at(p.i, p.j);
      worst = std::max(worst, std::abs(r * (1.0 - (w(a) + (w(b) - w(a)) * k / count) / w(p))));
    }
    return worst;
  };
  for (int depth = 2 * std::countr_zero(static_cast<unsigned>(n)) - 1; depth >= 0; --depth) {
    const auto visit = [&](Post a, Post b, Post c) {
      const Post middle{(a.i + b.i) / 2, (a.j + b.j) / 2};
      double worst =
          std::max(error(middle), field.worst(lines, corner(a), corner(b), corner(c)).geometric_error_m);
      worst = std::max({worst, along_border(a, b), along_border(b, c), along_border(c, a)});
      if ((a.i + c.i) % 2 == 0 && (a.j + c.j) % 2 == 0) {
        worst = std::max(
            {worst, error({(a.i + c.i) / 2, (a.j + c.j) / 2}), error({(b.i + c.i) / 2, (b.j + c.j) / 2})});
      }
      error(middle) = worst;
    };
    at_depth({0, 0}, {n, n}, {n, 0}, depth, visit);
    at_depth({n, n}, {0, 0}, {0, n}, depth, visit);
  }
}

lod::TileMesh Rtin::mesh(double tolerance_m) const {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto post = [&](Post p) { return static_cast<std::uint32_t>(p.j * side_ + p.i); };
  const auto split = [&](const auto& self, Post a, Post b, Post c) -> void {
    const Post middle{(a.i + b.i) / 2, (a.j + b.j) / 2};
    const bool divisible = std::abs(a.i - c.i) + std::abs(a.j - c.j) > 1;
    if (divisible && error(middle) > tolerance_m) {
      self(self, c, a, middle);
      self(self, b, c, middle);
    } else {
      const int turn = (b.i - a.i) * (c.j - a.j) - (b.j - a.j) * (c.i - a.i);
      triangles.push_back(turn > 0 ? std::array{post(a), post(b), post(c)}
                                   : std::array{post(a), post(c), post(b)});
    }
  };
  const int n = side_ - 1;
  split(split, {0, 0}, {n, n}, {n, 0});
  split(split, {n, n}, {0, 0}, {0, n});
  return from_triangles(n, triangles);
}

}  // namespace bench
