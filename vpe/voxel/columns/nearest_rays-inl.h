// Finds the samples nearest to pixels.
//
// Part of refine_kernel.cpp; refine.h has the contracts. Positions are computed in double, by the same steps in all instruction sets, so
// that these choose the same sample where two are equally near.
#if defined(VPE_VOXEL_NEAREST_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_NEAREST_RAYS_INL_H_
#undef VPE_VOXEL_NEAREST_RAYS_INL_H_
#else
#define VPE_VOXEL_NEAREST_RAYS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "vpe/voxel/columns/refine.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using PlaceTag = hn::CappedTag<double, 8>;
using PlaceIndexTag = hn::Rebind<std::int32_t, PlaceTag>;

// Returns the whole part of a position among `lines` samples; the outermost sample where it is beyond.
inline hn::Vec<PlaceIndexTag> index_of(hn::Vec<PlaceTag> place, int lines) {
  const PlaceTag d;
  const auto last = hn::Set(d, static_cast<double>(lines - 1));
  return hn::DemoteTo(PlaceIndexTag(), hn::Min(hn::Max(place, hn::Zero(d)), last));
}

void nearest_in_columns_kernel(int lines, const double* maps, double s, double first_line, double per_spacing,
                               int count, std::int32_t* index) {
  const PlaceTag d;
  const PlaceIndexTag di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto across = hn::Set(d, s);
  const auto first = hn::Set(d, first_line);
  const auto per = hn::Set(d, per_spacing);
  const auto half = hn::Set(d, 0.5);
  const auto find = [&](const double* from, int k) {
    hn::Vec<PlaceTag> scale, shift;
    hn::LoadInterleaved2(d, from, scale, shift);
    const auto line = hn::Sub(hn::Add(hn::Mul(scale, across), shift), first);
    const auto place = hn::Add(hn::Mul(line, per), half);
    return hn::Add(hn::Mul(hn::Iota(di, k), hn::Set(di, lines)), index_of(place, lines));
  };
  int k = 0;
  for (; k + lanes <= count; k += lanes) hn::StoreU(find(maps + 2 * k, k), di, index + k);
  if (k == count) return;
  alignas(64) double rest[16] = {};
  alignas(64) std::int32_t some[16];
  std::copy_n(maps + 2 * k, 2 * (count - k), rest);
  hn::StoreU(find(rest, k), di, some);
  std::copy_n(some, count - k, index + k);
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
