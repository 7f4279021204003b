#include "lod/mesh/depth_kernel.h"

// Highway compiles this file once for each instruction set and selects the best one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lod/mesh/depth_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lod::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

DepthDifferences difference_kernel(const DepthPosts& posts, const DepthPlane& plane,
                                   const std::array<DepthSide, 3>& sides, const DepthBox& box) {
  using Doubles = hn::CappedTag<double, kDepthPad>;
  using DoubleVec = hn::Vec<Doubles>;
  const Doubles d;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  const DoubleVec zero = hn::Zero(d);
  const auto side_at = [&](const DepthSide& side, DoubleVec u)
                           HWY_ATTR { return hn::MulAdd(hn::Set(d, side.along_u), u, hn::Set(d, side.at)); };
  const DoubleVec along_0 = hn::Set(d, sides[0].along_v);
  const DoubleVec along_1 = hn::Set(d, sides[1].along_v);
  const DoubleVec along_2 = hn::Set(d, sides[2].along_v);
  const DoubleVec plane_dv = hn::Set(d, plane.dv);
  const DoubleVec plane_v = hn::Set(d, plane.v);
  DoubleVec below = zero;
  DoubleVec above = zero;
  for (std::uint32_t i = box.i0; i < box.i1; i += lanes) {
    const DoubleVec u = hn::LoadU(d, posts.u + i);
    const DoubleVec at_0 = side_at(sides[0], u);
    const DoubleVec at_1 = side_at(sides[1], u);
    const DoubleVec at_2 = side_at(sides[2], u);
    const DoubleVec column =
        hn::MulAdd(hn::Set(d, plane.du), hn::Sub(u, hn::Set(d, plane.u)), hn::Set(d, plane.depth));
    const double* depth = posts.depth + box.j0 * posts.side + i;
    for (std::uint32_t j = box.j0; j < box.j1; ++j, depth += posts.side) {
      const DoubleVec v = hn::Set(d, posts.v[j]);
      const DoubleVec flat = hn::MulAdd(plane_dv, hn::Sub(v, plane_v), column);
      const DoubleVec difference = hn::Sub(hn::LoadU(d, depth), flat);
      const DoubleVec least = hn::Min(hn::Min(hn::MulAdd(along_0, v, at_0), hn::MulAdd(along_1, v, at_1)),
                                      hn::MulAdd(along_2, v, at_2));
      const DoubleVec inside = hn::IfThenElseZero(hn::Ge(least, zero), difference);
      below = hn::Max(below, inside);
      above = hn::Min(above, inside);
    }
  }
  return {hn::GetLane(hn::MaxOfLanes(d, below)), -hn::GetLane(hn::MinOfLanes(d, above))};
}

// Calls each(i) for vectors that cover `count` entries, of which there is at least a vector. The last one may repeat some.
template <class Each>
HWY_INLINE void for_vectors(std::size_t lanes, std::size_t count, const Each& each) {
  for (std::size_t i = 0; i + lanes < count; i += lanes) each(i);
  each(count - lanes);
}

// Calls use(d) with a tag of at most `count` lanes.
template <class Use>
HWY_INLINE void with_lanes(std::size_t count, const Use& use) {
  const hn::CappedTag<double, kDepthPad> d;
  if (count < hn::Lanes(d)) {
    use(hn::CappedTag<double, 1>());
  } else {
    use(d);
  }
}

void fill_kernel(const DepthRow& row, double* length, double* depth) {
  with_lanes(row.count, [&](auto d) HWY_ATTR {
    const auto radius = hn::Set(d, row.radius_m);
    const auto v2 = hn::Set(d, row.v2);
    const auto one = hn::Set(d, 1.0);
    for_vectors(hn::Lanes(d), row.count, [&](std::size_t i) HWY_ATTR {
      const auto u = hn::LoadU(d, row.u + i);
      const auto n = hn::Sqrt(hn::Add(hn::Add(hn::Mul(u, u), v2), one));
      hn::StoreU(n, d, length + i);
      hn::StoreU(hn::Div(hn::Mul(n, radius), hn::Add(radius, hn::LoadU(d, row.height_m + i))), d, depth + i);
    });
  });
}

DepthRange range_kernel(const double* low, const double* high, std::size_t count) {
  DepthRange found{};
  with_lanes(count - 1, [&](auto d) HWY_ATTR {
    auto all_least = hn::LoadU(d, low);
    auto cell = hn::Zero(d);
    for_vectors(hn::Lanes(d), count - 1, [&](std::size_t i) HWY_ATTR {
      const auto a = hn::LoadU(d, low + i);
      const auto b = hn::LoadU(d, low + i + 1);
      const auto p = hn::LoadU(d, high + i);
      const auto q = hn::LoadU(d, high + i + 1);
      const auto least = hn::Min(hn::Min(a, b), hn::Min(p, q));
      const auto most = hn::Max(hn::Max(a, b), hn::Max(p, q));
      all_least = hn::Min(all_least, least);
      cell = hn::Max(cell, hn::Sub(most, least));
    });
    found = {hn::GetLane(hn::MinOfLanes(d, all_least)), hn::GetLane(hn::MaxOfLanes(d, cell))};
  });
  return found;
}

}  // namespace
}  // namespace lod::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lod {

HWY_EXPORT(difference_kernel);
HWY_EXPORT(fill_kernel);
HWY_EXPORT(range_kernel);

DepthDifferences largest_differences(const DepthPosts& posts, const DepthPlane& plane,
                                     const std::array<DepthSide, 3>& sides, const DepthBox& box) {
  return HWY_DYNAMIC_DISPATCH(difference_kernel)(posts, plane, sides, box);
}

void fill_depths(const DepthRow& row, double* length, double* depth) {
  HWY_DYNAMIC_DISPATCH(fill_kernel)(row, length, depth);
}

DepthRange range_of_depths(const double* low, const double* high, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(range_kernel)(low, high, count);
}

}  // namespace lod
#endif
