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

// Eight lanes have a start and a gain in one cache line, side by side so that both are stored at once.
#if HWY_TARGET == HWY_AVX2
constexpr int kValueStep = 2;
#else
constexpr int kValueStep = 1;
#endif

// Stores a value for each of the given lanes at to[row * kMaxLanes + lane * kStep], and another one likewise in to_too unless that
// is null. lane0 is the column of the vector's first lane.
template <int kStep, class D>
void scatter(D d, float* to, float* to_too, int lane0, hn::Mask<D> lanes, hn::Vec<D> at_row, hn::Vec<D> values,
             hn::Vec<D> values_too) {
  using T = hn::TFromD<D>;
#if HWY_TARGET <= HWY_AVX3
  static_assert(kStep == 1);
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
  auto column = hn::Iota(di, static_cast<hn::TFromD<decltype(di)>>(lane0));
  if constexpr (kStep == 2) column = hn::Add(column, column);
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

#if HWY_TARGET == HWY_AVX2
// Stores a start and a gain for each of eight columns, `lane`, at its row.
inline void scatter_pairs(float* to, __m256i lane, hn::Vec<hn::CappedTag<float, kMaxLanes>> at_row,
                          hn::Vec<hn::CappedTag<float, kMaxLanes>> start,
                          hn::Vec<hn::CappedTag<float, kMaxLanes>> gain) {
  alignas(32) std::uint32_t index[8];
  const __m256i row = _mm256_slli_epi32(_mm256_cvttps_epi32(at_row.raw), 4);
  _mm256_store_si256(reinterpret_cast<__m256i*>(index), _mm256_add_epi32(row, _mm256_add_epi32(lane, lane)));
  // Values 0, 1, 4, 5 and 2, 3, 6, 7.
  const __m256 a = _mm256_unpacklo_ps(start.raw, gain.raw);
  const __m256 b = _mm256_unpackhi_ps(start.raw, gain.raw);
  const auto put = [&](int k, __m128 two) {
    _mm_storel_pi(reinterpret_cast<__m64*>(to + index[k]), two);
    _mm_storeh_pi(reinterpret_cast<__m64*>(to + index[k + 1]), two);
  };
  put(0, _mm256_castps256_ps128(a));
  put(2, _mm256_castps256_ps128(b));
  put(4, _mm256_extractf128_ps(a, 1));
  put(6, _mm256_extractf128_ps(b, 1));
}
#endif

// Stores one value for each of the given lanes.
template <int kStep = 1, class D>
void scatter(D d, float* to, int lane0, hn::Mask<D> lanes, hn::Vec<D> at_row, hn::Vec<D> values) {
  scatter<kStep>(d, to, nullptr, lane0, lanes, at_row, values, values);
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
