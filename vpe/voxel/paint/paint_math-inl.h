// Elementary functions of vectors that every instruction set computes to the same bit: without fused steps and
// estimates.
//
// Part of paint_kernel.cpp.
#if defined(VPE_VOXEL_PAINT_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_PAINT_MATH_INL_H_
#undef VPE_VOXEL_PAINT_MATH_INL_H_
#else
#define VPE_VOXEL_PAINT_MATH_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V clamp(D d, V x, double low, double high) {
  using T = hn::TFromD<D>;
  return hn::Min(hn::Max(x, hn::Set(d, static_cast<T>(low))), hn::Set(d, static_cast<T>(high)));
}

// Returns a + b x.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V line(D d, V x, double a, double b) {
  using T = hn::TFromD<D>;
  return hn::Add(hn::Set(d, static_cast<T>(a)), hn::Mul(hn::Set(d, static_cast<T>(b)), x));
}

// Returns e^x for x <= 80, with relative error 3e-7; 0 below -87.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exponential(D d, V x) {
  const hn::RebindToSigned<D> di;
  const V inside = hn::Max(x, hn::Set(d, -87.0F));
  const V whole = hn::Round(hn::Mul(inside, hn::Set(d, 1.44269504F)));
  // ln 2 in two parts: the first has few digits, so that its product is exact.
  const V rest = hn::Sub(hn::Sub(inside, hn::Mul(whole, hn::Set(d, 0.693359375F))),
                         hn::Mul(whole, hn::Set(d, -2.12194440e-4F)));
  // Pairs of terms, which wait for each other less than a chain would.
  const V rest2 = hn::Mul(rest, rest);
  const V low = hn::Add(hn::Set(d, 1.0F), rest);
  const V middle = line(d, rest, 1.0 / 2, 1.0 / 6);
  const V high = hn::Add(line(d, rest, 1.0 / 24, 1.0 / 120), hn::Mul(rest2, hn::Set(d, 1.0F / 720)));
  const V sum = hn::Add(low, hn::Mul(rest2, hn::Add(middle, hn::Mul(rest2, high))));
  const auto power = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(di, whole), hn::Set(di, 127)));
  const V value = hn::Mul(sum, hn::BitCast(d, power));
  return hn::IfThenElse(hn::Lt(x, hn::Set(d, -87.0F)), hn::Zero(d), value);
}

// Returns the angle of (x, y) in degrees, -180 to 180, within 2e-5; 0 for (0, 0). Abramowitz and Stegun 4.4.49.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V angle_deg(D d, V y, V x) {
  const V wide = hn::Abs(x);
  const V high = hn::Abs(y);
  const V larger = hn::Max(hn::Max(wide, high), hn::Set(d, 1e-37F));
  const V t = hn::Div(hn::Min(wide, high), larger);
  const V q = hn::Mul(t, t);
  V sum = hn::Set(d, 0.0028662257F);
  for (const float term : {-0.0161657367F, 0.0429096138F, -0.0752896400F, 0.1065626393F, -0.1420889944F,
                           0.1999355085F, -0.3333314528F, 1.0F})
    sum = hn::Add(hn::Mul(sum, q), hn::Set(d, term));
  V angle = hn::Mul(hn::Mul(sum, t), hn::Set(d, 57.2957795F));
  angle = hn::IfThenElse(hn::Gt(high, wide), hn::Sub(hn::Set(d, 90.0F), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, 180.0F), angle), angle);
  return hn::IfThenElse(hn::Lt(y, hn::Zero(d)), hn::Neg(angle), angle);
}

// Returns 0 below `low`, 1 above `high`, and a cubic between.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V smooth_step(D d, V x, double low, double high) {
  const V t = clamp(d, line(d, x, -low / (high - low), 1.0 / (high - low)), 0, 1);
  return hn::Mul(hn::Mul(t, t), hn::Sub(hn::Set(d, 3.0F), hn::Add(t, t)));
}

}  // namespace HWY_NAMESPACE
}  // namespace vpe::voxel
HWY_AFTER_NAMESPACE();

#endif
