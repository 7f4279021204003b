// Stores values of a group's columns at rows of their own.
//
// Part of column_kernel.cpp and discrete_kernel.cpp.
#if defined(VPE_VOXEL_COLUMN_SCATTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_COLUMN_SCATTER_INL_H_
#undef VPE_VOXEL_COLUMN_SCATTER_INL_H_
#else
#define VPE_VOXEL_COLUMN_SCATTER_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <bit>
#include <cstddef>
#include <cstdint>

#include "vpe/voxel/columns/columns.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Stores a value for each of the given lanes at to[row * kMaxLanes + lane], and another one at to_too[row * kMaxLanes + lane] unless
// that is null. lane0 is the column of the vector's first lane.
template <class D>
void scatter(D d, float* to, float* to_too, int lane0, hn::Mask<D> lanes, hn::Vec<D> at_row, hn::Vec<D> values,
             hn::Vec<D> values_too) {
  using T = hn::TFromD<D>;
#if HWY_TARGET <= HWY_AVX3
  if constexpr (sizeof(T) == 4) {
    const __m512i row = _mm512_cvttps_epi32(at_row.raw);
    const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i index = _mm512_add_epi32(_mm512_slli_epi32(row, 4), lane);
    _mm512_mask_i32scatter_ps(to, lanes.raw, index, values.raw, 4);
    if (to_too != nullptr) _mm512_mask_i32scatter_ps(to_too, lanes.raw, index, values_too.raw, 4);
    return;
  }
#endif
  const hn::RebindToSigned<D> di;
  alignas(64) hn::TFromD<decltype(di)> index[kMaxLanes];
  alignas(64) T all[kMaxLanes];
  alignas(64) T all_too[kMaxLanes];
  const auto column = hn::Iota(di, static_cast<hn::TFromD<decltype(di)>>(lane0));
  static_assert(kMaxLanes == 16);
  hn::Store(hn::Add(hn::ShiftLeft<4>(hn::ConvertTo(di, at_row)), column), di, index);
  hn::Store(values, d, all);
  hn::Store(values_too, d, all_too);
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, lanes, bits);
  for (unsigned left = bits[0]; left != 0; left &= left - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(left));
    to[index[k]] = static_cast<float>(all[k]);
    if (to_too != nullptr) to_too[index[k]] = static_cast<float>(all_too[k]);
  }
}

// Stores one value for each of the given lanes.
template <class D>
void scatter(D d, float* to, int lane0, hn::Mask<D> lanes, hn::Vec<D> at_row, hn::Vec<D> values) {
  scatter(d, to, nullptr, lane0, lanes, at_row, values, values);
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
