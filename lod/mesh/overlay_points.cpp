#include "lod/mesh/overlay_points.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "vpe/base/mutation.h"

namespace lod {

using vpe::base::Guard;
using vpe::base::mutated;

namespace {

template <class Pair>
Pair load_pair(const double* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof pair);
  return pair;
}

template <class T>
void raise(T& largest, T value) {
  const T size = -value > value ? -value : value;
  largest = size > largest ? size : largest;
}

}  // namespace

// Adds the distances in a direction of length n, from the depths W of mesh and S and their lengths n.
template <class T>
void OverlayPoints::add(T n, T mesh_depth, T depth, T mesh_length, T length, T& total_most, T& sagitta_most,
                        T& height_error_most) const {
  const T depths = mesh_depth * depth;
  const T lengths = mesh_length * length;
  const T scale = n * mesh_.radius_m / (depths * lengths);
  const T total = (depth - mesh_depth) * lengths * scale;
  const T sagitta = (length - mesh_length) * depths * scale;
  raise(total_most, total);
  raise(sagitta_most, sagitta);
  raise(height_error_most, total - sagitta);
}

void OverlayPoints::add(double n, double mesh_depth, double depth, double mesh_length, double length) {
  double total = total_[0];
  double sagitta = sagitta_[0];
  double height_error = height_error_[0];
  add(n, mesh_depth, depth, mesh_length, length, total, sagitta, height_error);
  total_[0] = total;
  sagitta_[0] = sagitta;
  height_error_[0] = height_error;
}

void OverlayPoints::add_row(const CoarseMesh::Triangle& t, const CoarseMesh::Gradient& length_by, int j,
                            int first, int end) {
  const CoarseMesh::Vertex& low = t.corner[0];
  const double depth_row = low.depth + t.depth_dv * (fine_.v[j] - low.v);
  const double length_row = low.length + length_by.dv * (fine_.v[j] - low.v);
  const std::size_t row = static_cast<std::size_t>(j) * static_cast<std::size_t>(side_);
  const double* u = fine_.u.data();
  const double* depth = fine_.depth.data() + row;
  const double* length = fine_.length.data() + row;
  int i = first;
  for (; i + 1 < end; i += 2) {
    const Pair off = load_pair<Pair>(u + i) - low.u;
    const Pair n = load_pair<Pair>(length + i);
    add(n, depth_row + t.depth_du * off, load_pair<Pair>(depth + i), length_row + length_by.du * off, n, total_,
        sagitta_, height_error_);
  }
  if (i < end) {
    const double off = u[i] - low.u;
    add(length[i], depth_row + t.depth_du * off, depth[i], length_row + length_by.du * off, length[i]);
  }
}

void OverlayPoints::add_point(const CoarseMesh::Segment& s, const Point& p, int i, int j, double x, double y) {
  const std::size_t at =
      static_cast<std::size_t>(j) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(i);
  const std::size_t up = at + static_cast<std::size_t>(side_);
  // S's diagonal runs from (i, j) to (i + 1, j + 1).
  const std::size_t middle = x > y ? at + 1 : up;
  const double large = std::max(x, y);
  const double small = std::min(x, y);
  const auto facet = [&](const std::vector<double>& f) {
    return f[at] + large * (f[middle] - f[at]) + small * (f[up + 1] - f[middle]);
  };
  add(std::sqrt(p.u * p.u + p.v * p.v + 1.0), s.from.depth + p.t * (s.to.depth - s.from.depth),
      facet(fine_.depth), s.from.length + p.t * (s.to.length - s.from.length), facet(fine_.length));
}

void OverlayPoints::vary(const CoarseMesh::Triangle& t) {
  const auto& [a, b, c] = t.corner;
  // Divides where the variation may be larger than the largest so far only.
  const auto raise_by = [&](double& largest, double fa, double fb, double fc, const auto& gradient) {
    const double least = std::min(std::min(fa, fb), fc);
    const double limit = largest * least * (1.0 - 1e-15);
    const double between = std::max(std::max(fa, fb), fc) - least;
    if (between <= limit) return;
    const CoarseMesh::Gradient by = gradient();
    const double cell = std::abs(by.du) * fine_.u.widest() + std::abs(by.dv) * fine_.v.widest();
    if (cell <= limit) return;
    largest = std::max(largest, std::min(cell, between) / least);
  };
  raise_by(depth_variation_, a.depth, b.depth, c.depth, [&] {
    return CoarseMesh::Gradient{t.depth_du, t.depth_dv};
  });
  raise_by(length_variation_, a.length, b.length, c.length, [&] { return t.length_gradient(); });
}

void OverlayPoints::add_posts(const CoarseMesh::Triangle& t) {
  const CoarseMesh::Vertex& low = t.corner[0];
  const CoarseMesh::Vertex& middle = t.corner[1];
  const CoarseMesh::Vertex& high = t.corner[2];
  const double whole = (high.u - low.u) / (high.v - low.v);
  const CoarseMesh::Gradient length_by = t.length_gradient();
  const int begin = fine_.v.first(low.v);
  const int turn = fine_.v.first(middle.v);
  const int end = fine_.v.first(high.v);
  const auto rows = [&](int from, int to, const CoarseMesh::Vertex& a, const CoarseMesh::Vertex& b) {
    if (from >= to) return;  // horizontal edges have no slope
    const double half = (b.u - a.u) / (b.v - a.v);
    for (int j = from; j < to; ++j) {
      const double v = fine_.v[j];
      const int one = fine_.u.first(a.u + half * (v - a.v));
      const int two = fine_.u.first(low.u + whole * (v - low.v));
      if (t.middle_left) {
        add_row(t, length_by, j, one, two);
      } else {
        add_row(t, length_by, j, two, one);
      }
    }
  };
  rows(begin, turn, low, middle);
  rows(turn, end, middle, high);
}

void OverlayPoints::add_crossings(const CoarseMesh::Segment& s) {
  const LineTable& u = fine_.u;
  const LineTable& v = fine_.v;
  const double du = s.to.u - s.from.u;
  const double dv = s.to.v - s.from.v;
  const double per_u = du == 0.0 ? 0.0 : 1.0 / du;
  const double per_v = dv == 0.0 ? 0.0 : 1.0 / dv;
  double t = 0.0;
  double end = 1.0;
  const auto clip = [&](double at, double step, double per, double low, double high) {
    if (step == 0.0) return low <= at && at <= high;
    const double enter = ((step > 0.0 ? low : high) - at) * per;
    const double leave = ((step > 0.0 ? high : low) - at) * per;
    t = std::max(t, enter);
    end = std::min(end, leave);
    return true;
  };
  if (!clip(s.from.u, du, per_u, u[0], u[side_ - 1]) || !clip(s.from.v, dv, per_v, v[0], v[side_ - 1])) return;
  if (t > end) return;

  Point here{t, s.from.u + t * du, s.from.v + t * dv};
  int i = u.interval(here.u);
  int j = v.interval(here.v);
  // interval() gives a point on a line to the cell before it.
  if (du > 0.0 && i + 2 < side_ && here.u >= u[i + 1]) ++i;
  if (dv > 0.0 && j + 2 < side_ && here.v >= v[j + 1]) ++j;
  double x = u.fraction(i, here.u);
  double y = v.fraction(j, here.v);
  const bool slanting = du != 0.0 && dv != 0.0;
  if (!slanting || t > 0.0) add_point(s, here, i, j, x, y);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  while (true) {
    const double next_u = du == 0.0 ? kNever : (u[du > 0.0 ? i + 1 : i] - s.from.u) * per_u;
    const double next_v = dv == 0.0 ? kNever : (v[dv > 0.0 ? j + 1 : j] - s.from.v) * per_v;
    const Point before = here;
    const double before_x = x;
    const double before_y = y;
    here.t = std::min({next_u, next_v, end});
    here.u = s.from.u + here.t * du;
    here.v = s.from.v + here.t * dv;
    x = u.fraction(i, here.u);
    y = v.fraction(j, here.v);
    if (!slanting || here.t < 1.0) add_point(s, here, i, j, x, y);
    if (const double from = before_x - before_y, to = x - y; from * to < 0.0) {
      const double f = from / (from - to);
      const double d = before_x + f * (x - before_x);
      add_point(s,
                {before.t + f * (here.t - before.t), before.u + f * (here.u - before.u),
                 before.v + f * (here.v - before.v)},
                i, j, d, d);
    }
    if (here.t >= end) return;
    if (next_u <= next_v) {
      i += du > 0.0 ? 1 : -1;
      x = du > 0.0 ? 0.0 : 1.0;
    }
    if (next_v <= next_u) {
      j += dv > 0.0 ? 1 : -1;
      y = dv > 0.0 ? 0.0 : 1.0;
    }
    if (i < 0 || j < 0 || i + 1 >= side_ || j + 1 >= side_) return;
  }
}

ErrorTerms OverlayPoints::terms() const {
  const double kappa =
      mutated(Guard::kCellVariation)
          ? 1.0
          : (1.0 + fine_.length_variation) * (1.0 + fine_.depth_variation) * (1.0 + depth_variation_);
  const double flat =
      (1.0 + fine_.length_variation) * (1.0 + fine_.length_variation) * (1.0 + length_variation_);
  const double total = largest(total_);
  const double sagitta = largest(sagitta_);
  ErrorTerms terms;
  terms.height_error_m = largest(height_error_) + (kappa - 1.0) * total + (flat - 1.0) * sagitta;
  terms.sagitta_m = flat * sagitta;
  terms.total_m = std::min(kappa * total, terms.height_error_m + terms.sagitta_m);
  return terms;
}

}  // namespace lod
