// The errors of an edge of the mesh where it crosses the lines of the reference surface S between posts.
#include <algorithm>
#include <cmath>
#include <utility>

#include "lod/mesh/greedy_scan.h"

namespace lod {

namespace {

// A point on the line of S from post p to post q, at `fraction` from p.
struct Crossing {
  std::size_t p, q;
  double fraction;
};

}  // namespace

double PostField::crossing_bound_m(const Corner& a, const Corner& b) const {
  const auto ax = static_cast<double>(a.x);
  const auto ay = static_cast<double>(a.y);
  const double dx = static_cast<double>(b.x) - ax;
  const double dy = static_cast<double>(b.y) - ay;
  const double per_x = 1.0 / dx;
  const double per_y = 1.0 / dy;
  const double wa = w_[a.post];
  const double dw = w_[b.post] - wa;
  const std::size_t east = dx > 0 ? 1 : 0;
  const std::size_t north = dy > 0 ? 1 : 0;
  std::size_t i = a.i + east - 1;
  std::size_t j = a.j + north - 1;
  double most = 0;
  double t = 0;
  double s0 = 1.0 - static_cast<double>(east);  // the place in the cell, 0 to 1
  double r0 = 1.0 - static_cast<double>(north);
  double t_column = (x_[i + east] - ax) * per_x;
  double t_row = (y_[j + north] - ay) * per_y;
  while (true) {
    const double* low = w_.data() + j * side_ + i;
    const double* high = low + side_;
    // Within rounding of the last corner there is no error.
    const double next = std::min(t_column, t_row);
    const bool is_last = next > 1.0 - 1e-11;
    const double end = is_last ? 1.0 : next;
    const double s1 = (ax + end * dx - x_[i]) * per_column_[i];
    const double r1 = (ay + end * dy - y_[j]) * per_row_[j];
    const double g0 = s0 - r0;
    const double g1 = s1 - r1;
    if (g0 * g1 < 0) {
      const double part = g0 / (g0 - g1);
      const double surface = low[0] + (s0 + part * (s1 - s0)) * (high[1] - low[0]);
      most = std::max(most, std::abs(surface - (wa + (t + part * (end - t)) * dw)));
    }
    if (is_last) break;
    const double chord = wa + end * dw;
    if (t_column <= t_row) {
      most = std::max(most, std::abs(low[east] + r1 * (high[east] - low[east]) - chord));
      i += 2 * east - 1;
      t_column = (x_[i + east] - ax) * per_x;
      s0 = 1.0 - static_cast<double>(east);
      r0 = r1;
    } else {
      const double* line = north != 0 ? high : low;
      most = std::max(most, std::abs(line[0] + s1 * (line[1] - line[0]) - chord));
      j += 2 * north - 1;
      t_row = (y_[j + north] - ay) * per_y;
      s0 = s1;
      r0 = 1.0 - static_cast<double>(north);
    }
    t = end;
  }
  // The error is R |1 - chord / S|, and S is least where it is nearer by it than the lower end.
  const double ratio = most / std::min(wa, wa + dw);
  return lowest_radius_m_ * (ratio + 2.0 * ratio * ratio + 1e-12);
}

WorstPost PostField::worst_crossing(const Corner& from, const Corner& to, double tolerance_m) const {
  const Corner& a = from.post < to.post ? from : to;
  const Corner& b = from.post < to.post ? to : from;
  WorstPost worst;
  if (a.i == b.i || a.j == b.j) return worst;  // along a line of the grid, whose posts have been visited
  if (b.i == a.i + 1 && b.j == a.j + 1) return worst;  // S's own diagonal
  if (const double bound_m = crossing_bound_m(a, b); bound_m <= tolerance_m) return {bound_m, 0};
  const auto ax = static_cast<double>(a.x);
  const auto ay = static_cast<double>(a.y);
  const double dx = static_cast<double>(b.x) - ax;
  const double dy = static_cast<double>(b.y) - ay;
  const double wa = w_[a.post];
  const double dw = w_[b.post] - wa;
  const auto visit = [&](const Crossing& at, double t) {
    const double surface = w_[at.p] + at.fraction * (w_[at.q] - w_[at.p]);
    const double error = lowest_radius_m_ * std::abs(1.0 - (wa + t * dw) / surface);
    if (error <= worst.geometric_error_m) return;
    // Prefers the nearer end of the line, unless it is a vertex or on the border.
    std::size_t post = at.fraction < 0.5 ? at.p : at.q;
    if (weight_[post] == 0) post = post == at.p ? at.q : at.p;
    if (weight_[post] == 0) return;
    worst = {error, static_cast<std::uint32_t>(post)};
  };
  // Visits cell by cell from a to b: the diagonal inside each cell, then the side through which the edge leaves
  // it.
  const auto row = static_cast<std::size_t>(side_);
  const bool east = dx > 0;
  const bool north = dy > 0;
  std::size_t i = east ? a.i : a.i - 1;
  std::size_t j = north ? a.j : a.j - 1;
  double t = 0;
  while (t < 1) {
    const std::size_t post = j * row + i;
    const double t_column = (x_[east ? i + 1 : i] - ax) / dx;
    const double t_row = (y_[north ? j + 1 : j] - ay) / dy;
    const double end = std::min(std::min(t_column, t_row), 1.0);
    const auto place = [&](double at) {
      const double s = (ax + at * dx - x_[i]) / (x_[i + 1] - x_[i]);
      return std::pair(s, s - (ay + at * dy - y_[j]) / (y_[j + 1] - y_[j]));
    };
    const auto [s0, g0] = place(t);
    const auto [s1, g1] = place(end);
    if (g0 * g1 < 0) {
      const double part = g0 / (g0 - g1);
      visit({post, post + row + 1, s0 + part * (s1 - s0)}, t + part * (end - t));
    }
    if (end >= 1) break;
    if (t_column <= t_row) {
      if (east)
        ++i;
      else
        --i;
      visit({j * row + i + (east ? 0 : 1), (j + 1) * row + i + (east ? 0 : 1),
             (ay + end * dy - y_[j]) / (y_[j + 1] - y_[j])},
            end);
    } else {
      if (north)
        ++j;
      else
        --j;
      const std::size_t line = north ? j : j + 1;
      visit({line * row + i, line * row + i + 1, (ax + end * dx - x_[i]) / (x_[i + 1] - x_[i])}, end);
    }
    t = end;
  }
  return worst;
}

}  // namespace lod
