#include "lod/mesh/scan_kernel.h"

#include <cmath>

// Highway compiles this file once for each instruction set and selects the best one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lod/mesh/scan_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lod::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, kScanPad>;
using DoubleVec = hn::Vec<Doubles>;

// Returns the worst of some posts, of equals the first.
HWY_INLINE WorstPost worst_of(const DoubleVec error, const DoubleVec post) {
  const Doubles d;
  const DoubleVec most = hn::MaxOfLanes(d, error);
  const DoubleVec no_post = hn::Set(d, 4294967295.0);
  const DoubleVec first = hn::MinOfLanes(d, hn::IfThenElse(hn::Eq(error, most), post, no_post));
  return {hn::GetLane(most), static_cast<std::uint32_t>(hn::GetLane(first))};
}

WorstPost box_kernel(const ScannedPosts& posts, const ScannedPlane& plane,
                     const std::array<ScannedSide, 3>& sides, const ScannedBox& box) {
  const Doubles d;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  const DoubleVec zero = hn::Zero(d);
  const auto side_at = [&](const ScannedSide& side, DoubleVec x) HWY_ATTR {
    return hn::Add(hn::Set(d, side.at), hn::Mul(hn::Set(d, side.along_x), x));
  };
  const DoubleVec step_0 = hn::Set(d, sides[0].along_y);
  const DoubleVec step_1 = hn::Set(d, sides[1].along_y);
  const DoubleVec step_2 = hn::Set(d, sides[2].along_y);
  const DoubleVec row_posts = hn::Set(d, static_cast<double>(posts.side));
  DoubleVec worst = zero;
  DoubleVec worst_at = zero;
  for (std::uint32_t i = box.i0; i < box.i1; i += lanes) {
    const DoubleVec x = hn::LoadU(d, posts.x + i);
    const DoubleVec at_0 = side_at(sides[0], x);
    const DoubleVec at_1 = side_at(sides[1], x);
    const DoubleVec at_2 = side_at(sides[2], x);
    const DoubleVec w_x = hn::Mul(hn::Set(d, plane.dx), hn::Sub(x, hn::Set(d, plane.x)));
    std::size_t post = box.j0 * posts.side + i;
    DoubleVec here = hn::Iota(d, static_cast<double>(post));
    DoubleVec most = zero;
    DoubleVec most_at = zero;
    for (std::uint32_t j = box.j0; j < box.j1; ++j, post += posts.side, here = hn::Add(here, row_posts)) {
      const double y_j = posts.y[j];
      const DoubleVec y = hn::Set(d, y_j);
      const DoubleVec w_row = hn::Set(d, plane.w + plane.dy * (y_j - plane.y));
      const DoubleVec difference = hn::Sub(hn::LoadU(d, posts.w + post), hn::Add(w_row, w_x));
      const DoubleVec error = hn::Abs(hn::Mul(difference, hn::LoadU(d, posts.weight + post)));
      // Values of sides are exact, with a rounding between product and sum and without.
      const DoubleVec least = hn::Min(hn::Min(hn::MulAdd(step_0, y, at_0), hn::MulAdd(step_1, y, at_1)),
                                      hn::MulAdd(step_2, y, at_2));
      const DoubleVec inside = hn::IfThenElseZero(hn::Gt(least, zero), error);
      // In each column the first of equals stays.
      most_at = hn::IfThenElse(hn::Gt(inside, most), here, most_at);
      most = hn::Max(most, inside);
    }
    const auto is_worse = hn::Or(hn::Gt(most, worst), hn::And(hn::Eq(most, worst), hn::Lt(most_at, worst_at)));
    worst = hn::Max(worst, most);
    worst_at = hn::IfThenElse(is_worse, most_at, worst_at);
  }
  return worst_of(worst, worst_at);
}

void rows_kernel(const ScannedPosts& posts, const ScannedPlane& plane, std::span<const ScannedRow> rows,
                 WorstPost& worst) {
  const Doubles d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const DoubleVec dx = hn::Set(d, plane.dx);
  const DoubleVec plane_x = hn::Set(d, plane.x);
  const ScannedRow* worst_row = nullptr;
  for (const ScannedRow& row : rows) {
    const int count = row.end - row.first;
    if (count <= 0) continue;
    const std::size_t first = row.j * posts.side + static_cast<std::size_t>(row.first);
    const double* x = posts.x + row.first;
    const double* w = posts.w + first;
    const double* weight = posts.weight + first;
    const double w_row = plane.w + plane.dy * (posts.y[row.j] - plane.y);
    const DoubleVec row_w = hn::Set(d, w_row);
    const auto errors = [&](int k) HWY_ATTR {
      const DoubleVec flat = hn::Add(row_w, hn::Mul(dx, hn::Sub(hn::LoadU(d, x + k), plane_x)));
      return hn::Abs(hn::Mul(hn::Sub(hn::LoadU(d, w + k), flat), hn::LoadU(d, weight + k)));
    };
    // Two independent maxima, so that one does not wait for the other.
    DoubleVec one = hn::Zero(d);
    DoubleVec two = one;
    int k = 0;
    for (; k + 2 * lanes <= count; k += 2 * lanes) {
      one = hn::Max(one, errors(k));
      two = hn::Max(two, errors(k + lanes));
    }
    for (; k < count; k += lanes) {
      const auto is_in_row = hn::FirstN(d, static_cast<std::size_t>(count - k));
      one = hn::Max(one, hn::IfThenElseZero(is_in_row, errors(k)));
    }
    const double row_worst = hn::GetLane(hn::MaxOfLanes(d, hn::Max(one, two)));
    if (row_worst <= worst.geometric_error_m) continue;
    worst.geometric_error_m = row_worst;
    worst_row = &row;
  }
  if (worst_row == nullptr) return;
  // The first post of that row with this error.
  const double w_row = plane.w + plane.dy * (posts.y[worst_row->j] - plane.y);
  const auto error = [&](int i) {
    const std::size_t post = worst_row->j * posts.side + static_cast<std::size_t>(i);
    return std::abs((posts.w[post] - (w_row + plane.dx * (posts.x[i] - plane.x))) * posts.weight[post]);
  };
  int i = worst_row->first;
  while (i + 1 < worst_row->end && error(i) != worst.geometric_error_m) ++i;
  worst.post = static_cast<std::uint32_t>(worst_row->j * posts.side + static_cast<std::size_t>(i));
}

}  // namespace
}  // namespace lod::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lod {

HWY_EXPORT(box_kernel);
HWY_EXPORT(rows_kernel);

WorstPost worst_in_box(const ScannedPosts& posts, const ScannedPlane& plane,
                       const std::array<ScannedSide, 3>& sides, const ScannedBox& box) {
  return HWY_DYNAMIC_DISPATCH(box_kernel)(posts, plane, sides, box);
}

void scan_rows(const ScannedPosts& posts, const ScannedPlane& plane, std::span<const ScannedRow> rows,
               WorstPost& worst) {
  HWY_DYNAMIC_DISPATCH(rows_kernel)(posts, plane, rows, worst);
}

}  // namespace lod
#endif
