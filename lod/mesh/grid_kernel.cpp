#include "lod/mesh/grid_kernel.h"

// Highway compiles this file once for each instruction set and selects the best one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lod/mesh/grid_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lod::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

StripDifferences strip_kernel(const GridStrip& strip, const StripRow& row, double depth_weight) {
  using Doubles = hn::CappedTag<double, kStripStep>;
  using DoubleVec = hn::Vec<Doubles>;
  const Doubles d;
  const DoubleVec dv = hn::Set(d, row.dv);
  const DoubleVec one = hn::Set(d, 1.0);
  const DoubleVec weight = hn::Set(d, depth_weight);
  const DoubleVec low_from = hn::Set(d, row.y - row.margin);
  const DoubleVec high_to = hn::Set(d, row.y + row.margin);
  DoubleVec depth_most = hn::Zero(d);
  DoubleVec length_most = depth_most;
  DoubleVec both_most = depth_most;
  for (std::size_t k = 0; k < strip.count; k += hn::Lanes(d)) {
    const DoubleVec x = hn::LoadU(d, strip.x.data() + k);
    const DoubleVec depth = hn::LoadU(d, row.depth + k);
    const DoubleVec length = hn::LoadU(d, row.length + k);
    const DoubleVec per_length = hn::Div(one, length);
    const auto add = [&](const StripPlanes& planes, auto is_facet) HWY_ATTR {
      const auto difference = [&](DoubleVec post, const std::vector<double>& at,
                                  const std::vector<double>& slope) HWY_ATTR {
        const DoubleVec flat = hn::MulAdd(hn::LoadU(d, slope.data() + k), dv, hn::LoadU(d, at.data() + k));
        return hn::Mul(hn::IfThenElseZero(is_facet, hn::Abs(hn::Sub(post, flat))), per_length);
      };
      const DoubleVec of_depth = difference(depth, planes.depth, planes.depth_dv);
      const DoubleVec of_length = difference(length, planes.length, planes.length_dv);
      depth_most = hn::Max(depth_most, of_depth);
      length_most = hn::Max(length_most, of_length);
      both_most = hn::Max(both_most, hn::MulAdd(weight, of_depth, of_length));
    };
    add(strip.low, hn::Ge(x, low_from));
    add(strip.high, hn::Le(x, high_to));
  }
  return {hn::GetLane(hn::MaxOfLanes(d, depth_most)), hn::GetLane(hn::MaxOfLanes(d, length_most)),
          hn::GetLane(hn::MaxOfLanes(d, both_most))};
}

}  // namespace
}  // namespace lod::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lod {

HWY_EXPORT(strip_kernel);

StripDifferences strip_differences(const GridStrip& strip, const StripRow& row, double depth_weight) {
  return HWY_DYNAMIC_DISPATCH(strip_kernel)(strip, row, depth_weight);
}

void GridStrip::resize(std::size_t columns) {
  count = (columns + kStripStep - 1) / kStripStep * kStripStep;
  x.assign(count, 0);
  for (StripPlanes* planes : {&low, &high}) {
    planes->depth.assign(count, 1);
    planes->depth_dv.assign(count, 0);
    planes->length.assign(count, 1);
    planes->length_dv.assign(count, 0);
  }
}

}  // namespace lod
#endif
