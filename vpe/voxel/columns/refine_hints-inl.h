// Finds the samples beside pixels.
//
// Part of refine_kernel.cpp; refine.h has the contracts.
#if defined(VPE_VOXEL_REFINE_HINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_REFINE_HINTS_INL_H_
#undef VPE_VOXEL_REFINE_HINTS_INL_H_
#else
#define VPE_VOXEL_REFINE_HINTS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <algorithm>
#include <cmath>

#include "vpe/voxel/columns/lane_pairs-inl.h"
#include "vpe/voxel/columns/refine.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using HintTag = hn::CappedTag<float, 16>;

void hints_from_columns_kernel(const float* samples, int lines, const float* scale, const float* shift, float y,
                               int count, float* a, float* b, float* share) {
  const HintTag d;
  const hn::RebindToSigned<HintTag> di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  alignas(64) float some[5][16];
  for (int k = 0; k < count; k += lanes) {
    const int used = std::min(lanes, count - k);
    const auto load = [&](const float* from, float* room) {
      if (used == lanes) return hn::LoadU(d, from + k);
      std::fill_n(room, lanes, 0.0F);
      std::copy_n(from + k, used, room);
      return hn::Load(d, room);
    };
    const auto line = hn::MulAdd(load(scale, some[0]), hn::Set(d, y), load(shift, some[1]));
    const auto before =
        hn::Min(hn::Max(hn::Floor(line), hn::Zero(d)), hn::Set(d, static_cast<float>(lines - 2)));
    const auto step = hn::Min(hn::Add(hn::Iota(di, 0), hn::Set(di, k)), hn::Set(di, count - 1));
    const auto at = hn::Add(hn::Mul(step, hn::Set(di, lines)), hn::ConvertTo(di, before));
    const auto [va, vb] = load_pairs(d, samples, at);
    const auto part = hn::Min(hn::Max(hn::Sub(line, before), hn::Zero(d)), hn::Set(d, 1.0F));
    if (used == lanes) {
      hn::StoreU(va, d, a + k);
      hn::StoreU(vb, d, b + k);
      hn::StoreU(part, d, share + k);
    } else {
      hn::Store(va, d, some[2]);
      hn::Store(vb, d, some[3]);
      hn::Store(part, d, some[4]);
      std::copy_n(some[2], used, a + k);
      std::copy_n(some[3], used, b + k);
      std::copy_n(some[4], used, share + k);
    }
  }
}

void hints_from_row_kernel(const float* samples, int sample_count, double first, double step, int count,
                           float* a, float* b, float* share) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  // Relative to the row's first sample, which keeps positions small enough for float.
  const double base = std::floor(first);
  const auto start = hn::Set(d, static_cast<float>(first - base));
  const auto per = hn::Set(d, static_cast<float>(step));
  const auto offset = hn::Set(di, static_cast<std::int32_t>(base));
  const auto last = hn::Set(di, sample_count - 2);
  const auto none = hn::Zero(di);
  alignas(64) float some[3][16];
  for (int k = 0; k < count; k += lanes) {
    const auto x = hn::Add(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(k)));
    const auto place = hn::MulAdd(x, per, start);
    const auto before = hn::Floor(place);
    const auto wanted = hn::Add(hn::ConvertTo(di, before), offset);
    const auto at = hn::Min(hn::Max(wanted, none), last);
    // Beyond the samples the outermost one is taken.
    const auto beyond = hn::ConvertTo(d, hn::Sub(wanted, at));
    const auto part = hn::Min(hn::Max(hn::Add(hn::Sub(place, before), beyond), hn::Zero(d)), hn::Set(d, 1.0F));
    const auto [va, vb] = load_pairs(d, samples, at);
    if (k + lanes <= count) {
      hn::StoreU(va, d, a + k);
      hn::StoreU(vb, d, b + k);
      hn::StoreU(part, d, share + k);
    } else {
      hn::Store(va, d, some[0]);
      hn::Store(vb, d, some[1]);
      hn::Store(part, d, some[2]);
      std::copy_n(some[0], count - k, a + k);
      std::copy_n(some[1], count - k, b + k);
      std::copy_n(some[2], count - k, share + k);
    }
  }
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
