// Holds what the samples beside a pixel say of its range.
//
// Part of refine_kernel.cpp, below block_pixels-inl.h.
#if defined(VPE_VOXEL_PIXEL_ESTIMATE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_PIXEL_ESTIMATE_INL_H_
#undef VPE_VOXEL_PIXEL_ESTIMATE_INL_H_
#else
#define VPE_VOXEL_PIXEL_ESTIMATE_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <limits>

#include "vpe/voxel/columns/pixel_refiner-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Hints that differ by more than this share of the nearer one belong to different surfaces.
constexpr double kApart = 0.04;
// Between hints that differ by more than this there may be a crest, with ground behind it that is as well between them.
constexpr double kMaybeCrest = 0.002;

// Holds what the samples on either side of pixels say.
struct PixelEstimate {
  using V = hn::Vec<FloatTag>;
  using M = hn::Mask<FloatTag>;

  PixelEstimate(V a, V b, V share) {
    const FloatTag d;
    near = hn::Min(a, b);
    far = hn::Max(a, b);
    sky = hn::Eq(near, hn::Set(d, std::numeric_limits<float>::infinity()));
    reach = hn::Mul(near, hn::Set(d, static_cast<float>(kApart)));
    const V gap = hn::Sub(far, near);
    is_close = hn::Le(gap, reach);
    is_smooth = hn::Le(gap, hn::Mul(near, hn::Set(d, static_cast<float>(kMaybeCrest))));
    // On one facet the inverse range changes almost linearly from sample to sample.
    between = hn::Div(hn::Mul(a, b), hn::MulAdd(share, hn::Sub(a, b), b));
    // Between two surfaces the nearer one comes first.
    start = hn::IfThenElse(is_smooth, between, near);
    low = hn::Sub(near, reach);
    high = hn::Add(hn::IfThenElse(is_close, far, near), reach);
  }

  V near, far;
  V reach;      // how far a surface may be from a sample of it
  V between;    // interpolated; of lanes that are close
  V start;      // the first estimate
  V low, high;  // of the surface that is met first
  M sky;        // both
  M is_close;   // on one surface, or nearly
  M is_smooth;  // on one surface
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
