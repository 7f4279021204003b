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

}  // namespace
}  // namespace lod::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lod {

HWY_EXPORT(difference_kernel);

DepthDifferences largest_differences(const DepthPosts& posts, const DepthPlane& plane,
                                     const std::array<DepthSide, 3>& sides, const DepthBox& box) {
  return HWY_DYNAMIC_DISPATCH(difference_kernel)(posts, plane, sides, box);
}

}  // namespace lod
#endif
