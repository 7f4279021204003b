#include <algorithm>
#include <cmath>
#include <limits>

#include "vpe/voxel/columns/round_refine.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/voxel/columns/round_refine_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

#include "vpe/voxel/columns/pixel_refiner-inl.h"
#include "vpe/voxel/columns/round_hints-inl.h"
#include "vpe/voxel/columns/round_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Samples that differ by more than this share of the nearer one belong to different surfaces.
constexpr double kRoundApart = 0.04;
// Smooth ground at a grazing angle may rise this many times in range from a sample to the next.
constexpr double kMostGrazing = 2;

// Holds what the samples about each pixel say.
struct RoundEstimate {
  using V = hn::Vec<FloatTag>;
  using M = hn::Mask<FloatTag>;

  explicit RoundEstimate(const FanHints<FloatTag>::Samples& s) {
    const FloatTag d;
    const V one = hn::Set(d, 1.0F);
    const V apart = hn::Set(d, static_cast<float>(kRoundApart));
    const V inf = hn::Set(d, std::numeric_limits<float>::infinity());
    near = hn::Min(hn::Min(s.below_a, s.below_b), hn::Min(s.above_a, s.above_b));
    far = hn::Max(hn::Max(s.below_a, s.below_b), hn::Max(s.above_a, s.above_b));
    reach = hn::Mul(near, apart);
    sky = hn::Eq(near, inf);
    is_close = hn::Le(far, hn::Add(near, reach));
    // On one facet the inverse range changes almost linearly from sample to sample.
    const auto between = [](V a, V b, V share) { return hn::MulAdd(share, hn::Sub(b, a), a); };
    const V inverse = between(between(hn::Div(one, s.below_a), hn::Div(one, s.below_b), s.across),
                              between(hn::Div(one, s.above_a), hn::Div(one, s.above_b), s.across), s.upward);
    middle = hn::Div(one, inverse);
    const M level = hn::And(hn::Le(hn::Abs(hn::Sub(s.below_a, s.below_b)), reach),
                            hn::Le(hn::Abs(hn::Sub(s.above_a, s.above_b)), reach));
    const V most = hn::Set(d, static_cast<float>(kMostGrazing));
    is_grazing = hn::And(hn::AndNot(is_close, level), hn::Le(far, hn::Mul(near, most)));
    far_reach = hn::Mul(far, apart);
    const auto on_either = [&](V v) {
      return hn::Or(hn::Le(v, hn::Add(near, reach)), hn::Ge(v, hn::Sub(far, far_reach)));
    };
    are_two = hn::And(hn::Lt(far, inf), hn::And(hn::And(on_either(s.below_a), on_either(s.below_b)),
                                                hn::And(on_either(s.above_a), on_either(s.above_b))));
  }

  V near, far;         // of the four
  V reach, far_reach;  // how far a surface may be from a sample of it
  V middle;            // interpolated
  M sky;               // all of them
  M is_close;          // all on one surface
  M is_grazing;        // apart, but only from below to above, and not far
  M are_two;           // each on the nearest or on the farthest surface
};

void refine_round_row_kernel(const RoundRow& row, const FanSamples& fan, FacetSource& source,
                             FacetSource& exact_source, float* range, std::vector<OpenPixel>& open) {
  const FloatTag d;
  using V = hn::Vec<FloatTag>;
  using M = hn::Mask<FloatTag>;
  const int lanes = static_cast<int>(hn::Lanes(d));
  PixelRefiner<RoundRays> refiner(row, source, exact_source);
  const FanHints<FloatTag> hints(row, fan);
  alignas(64) float some[3][16];
  alignas(64) int pixels[16];
  for (int k = 0; k < row.count; k += lanes) {
    const int used = std::min(lanes, row.count - k);
    const RoundEstimate e(hints.at(k));
    if (hn::AllTrue(d, e.sky)) {
      std::fill_n(range + k, used, std::numeric_limits<float>::infinity());
      continue;
    }
    for (int lane = 0; lane < lanes; ++lane) pixels[lane] = std::min(k + lane, row.count - 1);
    refiner.take(pixels);
    V seen = hn::IfThenElse(e.is_close, e.middle, e.near);
    M done = e.sky;
    const auto try_from = [&](M lanes_to_try, V start, V low, V high) {
      const M todo = hn::AndNot(done, lanes_to_try);
      if (hn::AllFalse(d, todo)) return;
      const M found = refiner.refine(todo, low, high, start);
      seen = hn::IfThenElse(found, start, seen);
      done = hn::Or(done, found);
    };
    const V low = hn::Sub(e.near, e.reach);
    const V high = hn::Add(hn::IfThenElse(e.is_close, e.far, e.near), e.reach);
    // Between two surfaces the nearer one comes first.
    try_from(hn::Not(e.sky), seen, low, high);
    // On rough ground the iteration may fail from between samples. A sample's own facet faces the camera.
    try_from(e.is_close, e.near, low, high);
    try_from(e.is_close, e.far, low, high);
    try_from(e.is_grazing, e.middle, low, hn::Add(e.far, e.far_reach));
    try_from(e.are_two, e.far, hn::Sub(e.far, e.far_reach), hn::Add(e.far, e.far_reach));
    const V shown = hn::IfThenElse(e.sky, e.near, seen);
    hn::Store(shown, d, some[0]);
    std::copy_n(some[0], used, range + k);
    if (hn::AllTrue(d, done)) continue;
    hn::Store(hn::IfThenElse(done, hn::Zero(d), hn::Set(d, 1.0F)), d, some[0]);
    hn::Store(e.near, d, some[1]);
    hn::Store(e.far, d, some[2]);
    for (int lane = 0; lane < used; ++lane)
      if (some[0][lane] != 0) open.push_back({k + lane, some[1][lane], some[2][lane]});
  }
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::voxel {

HWY_EXPORT(refine_round_row_kernel);

void refine_round_row(const RoundRow& row, const FanSamples& fan, FacetSource& source,
                      FacetSource& exact_source, float* range, std::vector<OpenPixel>& open) {
  HWY_DYNAMIC_DISPATCH(refine_round_row_kernel)(row, fan, source, exact_source, range, open);
}

}  // namespace vpe::voxel
#endif
