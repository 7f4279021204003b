// The errors of the posts under a flat triangle, scanned row by row. Internal to lod.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "lod/mesh/greedy_heap.h"
#include "lod/mesh/greedy_lines.h"
#include "lod/tree/posts.h"

namespace lod {

// Holds the posts of a tile as inverse depths w = n / r with r = R + h; a flat triangle is a plane in them. The
// error of a post is r (1 - w / w_post), the radial distance to first order. It differs from the distance n / w
// - r by the relative amount distance / r only.
class PostField {
 public:
  void load(const Posts& posts, double radius_m);
  void set_lines(const std::vector<std::int64_t>& x, const std::vector<std::int64_t>& y);
  void ignore(std::uint32_t post) { weight_[post] = 0; }
  void ignore_borders();
  double lowest_radius_m() const { return lowest_radius_m_; }

  // Returns the worst post under a counter-clockwise triangle, of equals the lowest in (j, i) order. Posts on
  // an edge belong to the triangle on its right or upper side, so that each post is visited once.
  template <class Lines>
  WorstPost worst(const Lines& lines, const Corner& a, const Corner& b, const Corner& c) const;

  // Returns the largest error where an edge of the mesh crosses the lines of the reference surface, and the
  // post to insert against it. Crossings whose post is a vertex or on the border have no error. The result is
  // the same for both directions of the edge.
  WorstPost worst_crossing(const Corner& from, const Corner& to) const;

 private:
  struct Plane {
    double w, dx, dy;  // w at corner `at`, slopes
    double x, y;
  };
  Plane plane(const Corner& a, const Corner& b, const Corner& c) const;
  void scan_row(const Plane& plane, std::uint32_t j, int first, int end, WorstPost& worst) const;

  std::vector<double> w_;
  std::vector<double> weight_;  // r / w_post; 0 for posts that are vertices or on a border
  std::vector<double> x_;
  std::vector<double> y_;
  std::uint32_t side_ = 0;
  double lowest_radius_m_ = 0;
};

template <class Lines>
WorstPost PostField::worst(const Lines& lines, const Corner& a, const Corner& b, const Corner& c) const {
  const Corner* low = &a;
  const Corner* middle = &b;
  const Corner* high = &c;
  if (middle->j < low->j) std::swap(low, middle);
  if (high->j < middle->j) std::swap(middle, high);
  if (middle->j < low->j) std::swap(low, middle);

  WorstPost worst;
  const Plane flat = plane(a, b, c);
  const std::int64_t turn =
      (high->x - low->x) * (middle->y - low->y) - (high->y - low->y) * (middle->x - low->x);
  const bool middle_left = turn > 0;
  typename Lines::Walk whole(lines, {low->x, low->y, high->x, high->y});
  const auto part = [&](const Corner& from, const Corner& to) {
    if (from.j == to.j) return;
    typename Lines::Walk half(lines, {from.x, from.y, to.x, to.y});
    for (std::uint32_t j = from.j; j < to.j; ++j) {
      const std::int64_t y = lines.y()[j];
      const int one = half.first(y);
      const int two = whole.first(y);
      if (middle_left) {
        scan_row(flat, j, one, two, worst);
      } else {
        scan_row(flat, j, two, one, worst);
      }
    }
  };
  part(*low, *middle);
  part(*middle, *high);
  return worst;
}

inline PostField::Plane PostField::plane(const Corner& a, const Corner& b, const Corner& c) const {
  // Starts at the lowest post, so that the bits do not depend on the order of the corners.
  const Corner* o = &a;
  const Corner* p = &b;
  const Corner* q = &c;
  if (b.post < a.post && b.post < c.post) {
    o = &b;
    p = &c;
    q = &a;
  } else if (c.post < a.post && c.post < b.post) {
    o = &c;
    p = &a;
    q = &b;
  }
  const auto px = static_cast<double>(p->x - o->x);
  const auto py = static_cast<double>(p->y - o->y);
  const auto qx = static_cast<double>(q->x - o->x);
  const auto qy = static_cast<double>(q->y - o->y);
  const double wo = w_[o->post];
  const double wp = w_[p->post] - wo;
  const double wq = w_[q->post] - wo;
  const double scale = 1.0 / (px * qy - py * qx);
  return {wo, (wp * qy - wq * py) * scale, (wq * px - wp * qx) * scale, static_cast<double>(o->x),
          static_cast<double>(o->y)};
}

inline void PostField::scan_row(const Plane& plane, std::uint32_t j, int first, int end,
                                WorstPost& worst) const {
  using TwoDoubles = double __attribute__((vector_size(16)));
  const auto load = [](const double* from) {
    TwoDoubles pair;
    std::memcpy(&pair, from, sizeof pair);
    return pair;
  };
  if (first >= end) return;
  const std::size_t row = static_cast<std::size_t>(j) * side_;
  const double w_row = plane.w + plane.dy * (y_[j] - plane.y);
  const double* x = x_.data() + first;
  const double* w = w_.data() + row + first;
  const double* weight = weight_.data() + row + first;
  const int count = end - first;
  const auto error = [&](int k) {
    return std::abs((w[k] - (w_row + plane.dx * (x[k] - plane.x))) * weight[k]);
  };
  const auto pair_error = [&](int k) {
    const TwoDoubles e = (load(w + k) - (w_row + plane.dx * (load(x + k) - plane.x))) * load(weight + k);
    return -e > e ? -e : e;
  };
  const auto larger = [](TwoDoubles a, TwoDoubles b) { return a > b ? a : b; };
  // Two independent maxima, so that one does not wait for the other.
  TwoDoubles one{0.0, 0.0};
  TwoDoubles two{0.0, 0.0};
  int k = 0;
  for (; k + 3 < count; k += 4) {
    one = larger(one, pair_error(k));
    two = larger(two, pair_error(k + 2));
  }
  if (k + 1 < count) {
    one = larger(one, pair_error(k));
    k += 2;
  }
  one = larger(one, two);
  double row_worst = one[0] > one[1] ? one[0] : one[1];
  if (k < count && error(k) > row_worst) row_worst = error(k);
  if (row_worst <= worst.geometric_error_m) return;
  for (k = 0; k + 1 < count && error(k) != row_worst;) ++k;
  worst = {row_worst, static_cast<std::uint32_t>(row + static_cast<std::size_t>(first + k))};
}

}  // namespace lod
