#include "vpe/map/viewshed/rise.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "vpe/map/viewshed/rise_series.h"

// Highway compiles this file once for each instruction set and selects the best one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/map/viewshed/rise.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace vpe::map::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMostLanes = 16;

using Floats = hn::CappedTag<float, kMostLanes>;
using FloatVec = hn::Vec<Floats>;

HWY_INLINE FloatVec series(const RiseSeries& coefficients, FloatVec q) {
  const Floats d;
  FloatVec sum = hn::Set(d, coefficients[kRiseTerms - 1]);
  for (std::size_t n = kRiseTerms - 1; n > 0; --n)
    sum = hn::Add(hn::Set(d, coefficients[n - 1]), hn::Mul(q, sum));
  return sum;
}

// Calls `of_posts(first, heights_m, rises_m)` for each vector of posts. The last ones are copied to a vector of their own.
template <class Function>
HWY_INLINE void by_vectors(std::size_t posts, int first, const float* heights_m, float* rises_m,
                           const Function& of_posts) {
  const std::size_t lanes = hn::Lanes(Floats());
  std::size_t n = 0;
  for (; n + lanes <= posts; n += lanes) of_posts(first + static_cast<int>(n), heights_m + n, rises_m + n);
  if (n == posts) return;
  float heights[kMostLanes] = {};
  float rises[kMostLanes] = {};
  std::copy(heights_m + n, heights_m + posts, heights);
  std::copy(rises_m + n, rises_m + posts, rises);
  of_posts(first + static_cast<int>(n), heights, rises);
  std::copy(rises, rises + (posts - n), rises_m + n);
}

// Describes the ground at a vector of posts.
struct RisePosts {
  FloatVec height_m;
  hn::Mask<Floats> known;
  FloatVec dip_m;    // of the sphere under the observer's level
  FloatVec stretch;  // a / sin(a)
};

HWY_INLINE RisePosts rise_posts(const RiseRow& row, const float* heights_m, int first) {
  const Floats d;
  const FloatVec height = hn::LoadU(d, heights_m);
  const FloatVec along = hn::Iota(d, static_cast<float>(first));
  const FloatVec square = hn::Add(hn::Set(d, row.across_squared), hn::Mul(along, along));
  const auto known =
      hn::And(hn::And(hn::Ge(height, hn::Set(d, row.lowest_m)), hn::Le(height, hn::Set(d, kMostRiseHeight_m))),
              hn::Le(square, hn::Set(d, row.reach_squared)));
  const FloatVec one = hn::Set(d, 1.0F);
  if (row.radius_m == 0) return {height, known, hn::Zero(d), one};
  const FloatVec q = hn::Mul(square, hn::Set(d, row.to_q));
  const FloatVec pole = hn::Div(one, hn::Sub(one, hn::Mul(q, hn::Set(d, static_cast<float>(1 / kPiSquare)))));
  const FloatVec dip =
      hn::Mul(hn::Mul(hn::Set(d, row.half_spacing_m), square), hn::Mul(series(kRiseTangent, q), pole));
  return {height, known, dip, hn::Mul(series(kRiseSine, q), pole)};
}

void rises_kernel(const RiseRow& row, const float* heights_m, float added_m, int first, std::size_t posts,
                  float* rises_m) {
  const Floats d;
  by_vectors(posts, first, heights_m, rises_m, [&](int at, const float* heights, float* found) HWY_ATTR {
    const RisePosts p = rise_posts(row, heights, at);
    const FloatVec height = hn::Add(p.height_m, hn::Set(d, added_m));
    FloatVec rise = hn::Sub(height, hn::Set(d, row.observer_m));
    if (row.radius_m > 0) {
      const FloatVec share = hn::Add(hn::Set(d, 1.0F), hn::Mul(height, hn::Set(d, row.curvature)));
      rise = hn::Sub(hn::Mul(hn::Div(rise, share), p.stretch), p.dip_m);
    }
    hn::StoreU(hn::IfThenElse(p.known, rise, hn::Set(d, kNoRise)), d, found);
  });
}

void heights_kernel(const RiseRow& row, const float* heights_m, int first, std::size_t posts, float* rises_m) {
  const Floats d;
  const FloatVec zero = hn::Zero(d);
  const FloatVec one = hn::Set(d, 1.0F);
  const FloatVec unknown = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  const FloatVec never = hn::Set(d, std::numeric_limits<float>::infinity());
  const FloatVec curvature = hn::Set(d, row.curvature);
  by_vectors(posts, first, heights_m, rises_m, [&](int at, const float* heights, float* found) HWY_ATTR {
    const RisePosts p = rise_posts(row, heights, at);
    const FloatVec height = p.height_m;
    // (h - e) R / (R + h) of the height h that is asked for, over the eye's height e.
    const FloatVec shortened = hn::Div(hn::Add(hn::LoadU(d, found), p.dip_m), p.stretch);
    const FloatVec share = hn::Sub(one, hn::Mul(shortened, curvature));
    const FloatVec over_eye = hn::Mul(shortened, hn::Add(one, hn::Mul(height, curvature)));
    const FloatVec missing = hn::Div(hn::Add(hn::Sub(hn::Set(d, row.observer_m), height), over_eye), share);
    const FloatVec needed = hn::IfThenElse(hn::Gt(share, zero), hn::Max(missing, zero), never);
    hn::StoreU(hn::IfThenElse(p.known, needed, unknown), d, found);
  });
}

}  // namespace
}  // namespace vpe::map::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::map {

HWY_EXPORT(rises_kernel);
HWY_EXPORT(heights_kernel);

void rises(const RiseView& view, std::span<const float> heights_m, float added_m, int across, int first,
           std::span<float> rises_m) {
  HWY_DYNAMIC_DISPATCH(rises_kernel)
  (RiseRow(view, across), heights_m.data(), added_m, first, heights_m.size(), rises_m.data());
}

void heights_to_rise(const RiseView& view, std::span<const float> heights_m, int across, int first,
                     std::span<float> rises_m) {
  HWY_DYNAMIC_DISPATCH(heights_kernel)
  (RiseRow(view, across), heights_m.data(), first, heights_m.size(), rises_m.data());
}

}  // namespace vpe::map
#endif
