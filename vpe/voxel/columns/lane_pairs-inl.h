// Loads neighbouring values for each lane.
//
// Part of refine_kernel.cpp and round_refine_kernel.cpp.
#if defined(VPE_VOXEL_LANE_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_LANE_PAIRS_INL_H_
#undef VPE_VOXEL_LANE_PAIRS_INL_H_
#else
#define VPE_VOXEL_LANE_PAIRS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Holds two values of each lane.
template <class D>
struct LanePairs {
  hn::Vec<D> first, second;
};

#if HWY_TARGET == HWY_AVX2
// Returns two floats each at two places.
inline __m128 two_pairs(const float* a, const float* b) {
  const __m128 low = _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(a)));
  return _mm_loadh_pi(low, reinterpret_cast<const __m64*>(b));
}
#endif

// Returns from[index] and from[index + 1] of each lane. Loads one by one: since the mitigations of 2023 vector gathers take longer
// than loads on many processors.
template <class D>
HWY_INLINE LanePairs<D> load_pairs([[maybe_unused]] D d, const hn::TFromD<D>* from,
                                   hn::Vec<hn::RebindToSigned<D>> index) {
  using T = hn::TFromD<D>;
  const hn::RebindToSigned<D> di;
  alignas(64) hn::TFromD<decltype(di)> at[64 / sizeof(T)];
  hn::Store(index, di, at);
#if HWY_TARGET == HWY_AVX2
  // Into registers: a vector that is loaded from values just stored one by one waits for them.
  if constexpr (sizeof(T) == 4) {
    const auto four = [&](int a, int b) {
      return _mm256_set_m128(two_pairs(from + at[a + 4], from + at[b + 4]),
                             two_pairs(from + at[a], from + at[b]));
    };
    const __m256 low = four(0, 1);
    const __m256 high = four(2, 3);
    return {hn::Vec<D>{_mm256_shuffle_ps(low, high, _MM_SHUFFLE(2, 0, 2, 0))},
            hn::Vec<D>{_mm256_shuffle_ps(low, high, _MM_SHUFFLE(3, 1, 3, 1))}};
  }
#endif
  alignas(64) T first[64 / sizeof(T)];
  alignas(64) T second[64 / sizeof(T)];
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
    first[k] = from[at[k]];
    second[k] = from[at[k] + 1];
  }
  return {hn::Load(d, first), hn::Load(d, second)};
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
