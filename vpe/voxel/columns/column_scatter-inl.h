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

// Stores a value for each of the given lanes at to[row * kMaxLanes + lane]. lane0 is the column of the vector's first lane.
template <class D>
void scatter(D d, float* to, int lane0, hn::Mask<D> lanes, hn::Vec<D> at_row, hn::Vec<D> values) {
  using T = hn::TFromD<D>;
#if HWY_TARGET <= HWY_AVX3
  if constexpr (sizeof(T) == 4) {
    const __m512i row = _mm512_cvttps_epi32(at_row.raw);
    const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    _mm512_mask_i32scatter_ps(to, lanes.raw, _mm512_add_epi32(_mm512_slli_epi32(row, 4), lane), values.raw, 4);
    return;
  }
#endif
  alignas(64) T rows[kMaxLanes];
  alignas(64) T all[kMaxLanes];
  hn::Store(at_row, d, rows);
  hn::Store(values, d, all);
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, lanes, bits);
  for (unsigned left = bits[0]; left != 0; left &= left - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(left));
    to[static_cast<std::size_t>(rows[k]) * kMaxLanes + static_cast<std::size_t>(lane0) + k] =
        static_cast<float>(all[k]);
  }
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
