// The errors of the posts under a flat triangle. Internal to lod.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lod/mesh/greedy_heap.h"
#include "lod/mesh/greedy_lines.h"
#include "lod/mesh/scan_kernel.h"
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
  // the same for both directions of the edge. Below the tolerance the error is a bound, and there is no post.
  WorstPost worst_crossing(const Corner& from, const Corner& to, double tolerance_m) const;

 private:
  // Triangles of at most so many columns are scanned by the columns of a box, wider ones by rows between their sides.
  static constexpr std::uint32_t kNarrow = 12;
  // Coordinates below this have exact products of differences in double, and exact sums of such products.
  static constexpr std::int64_t kMostExact = std::int64_t{1} << 25;

  // Returns the values of a side, at least 0.5 away from 0.
  static ScannedSide side_of(const Corner& from, const Corner& to);
  ScannedPlane plane(const Corner& a, const Corner& b, const Corner& c) const;
  ScannedPosts posts() const { return {w_.data(), weight_.data(), x_.data(), y_.data(), side_}; }
  // Bounds the errors of worst_crossing() where the edge is none of S's, with few divisions.
  double crossing_bound_m(const Corner& a, const Corner& b) const;
  template <class Lines>
  WorstPost worst_by_rows(const Lines& lines, const ScannedPlane& flat, const Corner& a, const Corner& b,
                          const Corner& c) const;

  // With kScanPad entries more.
  std::vector<double> w_;
  std::vector<double> weight_;  // r / w_post; 0 for posts that are vertices or on a border
  std::vector<double> x_;
  std::vector<double> y_;
  std::vector<double> per_column_;  // 1 / width, by interval
  std::vector<double> per_row_;
  std::uint32_t side_ = 0;
  double lowest_radius_m_ = 0;
  bool has_exact_sides_ = false;
};

template <class Lines>
WorstPost PostField::worst(const Lines& lines, const Corner& a, const Corner& b, const Corner& c) const {
  const ScannedPlane flat = plane(a, b, c);
  // Posts in the last column and row are corners or belong to neighbours.
  const ScannedBox box{std::min(std::min(a.i, b.i), c.i), std::max(std::max(a.i, b.i), c.i),
                       std::min(std::min(a.j, b.j), c.j), std::max(std::max(a.j, b.j), c.j)};
  if (box.i1 - box.i0 <= kNarrow && has_exact_sides_)
    return worst_in_box(posts(), flat, {side_of(a, b), side_of(b, c), side_of(c, a)}, box);
  return worst_by_rows(lines, flat, a, b, c);
}

template <class Lines>
WorstPost PostField::worst_by_rows(const Lines& lines, const ScannedPlane& flat, const Corner& a,
                                   const Corner& b, const Corner& c) const {
  const Corner* low = &a;
  const Corner* middle = &b;
  const Corner* high = &c;
  if (middle->j < low->j) std::swap(low, middle);
  if (high->j < middle->j) std::swap(middle, high);
  if (middle->j < low->j) std::swap(low, middle);

  WorstPost worst;
  const bool middle_left = turn_of(*low, *high, *middle) > 0;
  typename Lines::Walk whole(lines, {low->x, low->y, high->x, high->y});
  std::array<ScannedRow, 32> rows;
  std::size_t count = 0;
  const auto scan = [&] {
    scan_rows(posts(), flat, std::span(rows).first(count), worst);
    count = 0;
  };
  const auto part = [&](const Corner& from, const Corner& to) {
    if (from.j == to.j) return;
    typename Lines::Walk half(lines, {from.x, from.y, to.x, to.y});
    for (std::uint32_t j = from.j; j < to.j; ++j) {
      const std::int64_t y = lines.y()[j];
      const int one = half.first(y);
      const int two = whole.first(y);
      rows[count++] = middle_left ? ScannedRow{j, one, two} : ScannedRow{j, two, one};
      if (count == rows.size()) scan();
    }
  };
  part(*low, *middle);
  part(*middle, *high);
  scan();
  return worst;
}

[[gnu::always_inline]] inline ScannedSide PostField::side_of(const Corner& from, const Corner& to) {
  const auto dx = static_cast<double>(to.x - from.x);
  const auto dy = static_cast<double>(to.y - from.y);
  // Values at posts are whole numbers. Posts on sides that ascend, or that run west, belong to the neighbour.
  const bool has_own_posts = (to.y < from.y) | ((to.y == from.y) & (to.x > from.x));
  const double at = dy * static_cast<double>(from.x) - dx * static_cast<double>(from.y);
  return {at + (static_cast<double>(has_own_posts) - 0.5), -dy, dx};
}

[[gnu::always_inline]] inline ScannedPlane PostField::plane(const Corner& a, const Corner& b,
                                                            const Corner& c) const {
  // Starts at the lowest post, so that the bits do not depend on the order of the corners.
  const std::array<const Corner*, 5> corner{&a, &b, &c, &a, &b};
  const std::size_t first = static_cast<std::size_t>((b.post < a.post) & (b.post < c.post)) +
                            2 * static_cast<std::size_t>((c.post < a.post) & (c.post < b.post));
  const Corner* o = corner[first];
  const Corner* p = corner[first + 1];
  const Corner* q = corner[first + 2];
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

}  // namespace lod
