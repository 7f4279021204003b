// Second pass over the rows of a group of columns: turns runs of rows into ranges, and copies them to the
// image.
//
// Part of column_kernel.cpp; columns.h has the contracts. Runs after all height grids are walked.
#if defined(VPE_VOXEL_COLUMN_EXPAND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_COLUMN_EXPAND_INL_H_
#undef VPE_VOXEL_COLUMN_EXPAND_INL_H_
#else
#define VPE_VOXEL_COLUMN_EXPAND_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
#include <hwy/cache_control.h>
// clang-format on

#include <algorithm>
#include <limits>

#include "vpe/voxel/columns/column_rows-inl.h"
#include "vpe/voxel/columns/column_scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using RowTag = hn::CappedTag<float, kMaxLanes>;
template <RowKind kKind>
void least_as(const Rows& rows, ColumnGroup& group) {
  const RowTag d;
  const RowModel<RowTag, kKind> model(rows, group, 0);
  const auto row = hn::Load(d, group.row);
  const auto alive = hn::Lt(row, hn::Min(hn::Load(d, group.row_end), hn::Load(d, group.row_stop)));
  const auto far = hn::Set(d, std::numeric_limits<float>::infinity());
  group.least_slope =
      static_cast<double>(hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(alive, model.slope(row), far))));
}

void update_least_slope_kernel(const Rows& rows, ColumnGroup& group) {
  switch (rows.kind) {
    case RowKind::kEven: return least_as<RowKind::kEven>(rows, group);
    case RowKind::kTable: return least_as<RowKind::kTable>(rows, group);
    case RowKind::kSector: return least_as<RowKind::kSector>(rows, group);
  }
}

// Returns true if a run of rows of some column begins at a row.
bool any_begins(const float* starts) {
#if HWY_TARGET == HWY_AVX2
  const __m256i all = _mm256_or_si256(_mm256_load_si256(reinterpret_cast<const __m256i*>(starts)),
                                      _mm256_load_si256(reinterpret_cast<const __m256i*>(starts) + 1));
  return _mm256_testz_si256(all, all) == 0;
#else
  const RowTag d;
  return !hn::AllFalse(d, hn::Ne(hn::Load(d, starts), hn::Zero(d)));
#endif
}
// Return the starts and the gains of a row.
hn::Vec<RowTag> starts_of([[maybe_unused]] const Rows& rows, const float* starts) {
  const RowTag d;
#if HWY_TARGET == HWY_AVX2
  if (rows.has_ranges) return hn::Load(d, starts);
  return hn::ConcatEven(d, hn::Load(d, starts + kMaxLanes / 2), hn::Load(d, starts));
#else
  return hn::Load(d, starts);
#endif
}
hn::Vec<RowTag> gains_of([[maybe_unused]] const float* starts, [[maybe_unused]] const float* gains) {
  const RowTag d;
#if HWY_TARGET == HWY_AVX2
  return hn::ConcatOdd(d, hn::Load(d, starts + kMaxLanes / 2), hn::Load(d, starts));
#else
  return hn::Load(d, gains);
#endif
}

template <RowKind kKind>
void expand_as(const Rows& rows, ColumnGroup& group, int first, int last, float* out, std::ptrdiff_t stride) {
  const bool whole = group.columns == static_cast<int>(hn::Lanes(RowTag()));
  const RowTag d;
  using V = hn::Vec<RowTag>;
  const RowModel<RowTag, kKind> model(rows, group, 0);
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0F);
  const V sky = hn::Set(d, std::numeric_limits<float>::infinity());
  const V resolved = hn::Load(d, group.row);
  const float most = hn::GetLane(hn::MaxOfLanes(d, resolved));
  V start = hn::Load(d, group.run_start);
  V gain = hn::Load(d, group.run_gain);
  V from = hn::Load(d, group.run_slope);
  const auto put = [&](int r, V seen) {
    float* const to = out + static_cast<std::ptrdiff_t>(r - first) * stride;
    if (whole) {
      hn::StoreU(seen, d, to);
    } else {
      alignas(64) float some[kMaxLanes];
      hn::Store(seen, d, some);
      std::copy_n(some, group.columns, to);
    }
  };
  const int ground = std::clamp(static_cast<int>(most), first, last);
  for (int r = last - 1; r >= ground; --r) put(r, sky);
  for (int r = ground - 1; r >= first; --r) {
    float* const starts = group.start + static_cast<std::ptrdiff_t>(r) * kMaxLanes;
    float* const gains = group.gain + static_cast<std::ptrdiff_t>(r) * kMaxLanes;
    const V row = hn::Set(d, static_cast<float>(r));
    const V slope = model.slope(row);
    if (any_begins(starts)) {
      const V now = starts_of(rows, starts);
      const auto begins = hn::Ne(now, zero);
      start = hn::IfThenElse(begins, now, start);
      gain = hn::IfThenElse(begins, gains_of(starts, gains), gain);
      from = hn::IfThenElse(begins, slope, from);
      hn::Store(zero, d, starts);
      hn::Store(zero, d, kValueStep == 2 ? starts + kMaxLanes / 2 : gains);
    }
    if (rows.has_ranges) {
      put(r, hn::IfThenElse(hn::Lt(row, resolved), start, sky));
      continue;
    }
    const V per = hn::MulAdd(gain, hn::Sub(slope, from), start);
    V length;
    if constexpr (kKind == RowKind::kSector) {
      length = hn::Sqrt(hn::MulAdd(slope, slope, one));
    } else {
      length = hn::Set(d, rows.length[r]);
    }
    put(r, hn::IfThenElse(hn::Lt(row, resolved), hn::Div(length, per), sky));
  }
  hn::Store(start, d, group.run_start);
  hn::Store(gain, d, group.run_gain);
  hn::Store(from, d, group.run_slope);
}

void expand_rows_kernel(const Rows& rows, ColumnGroup& group, int first, int last, float* out,
                        std::ptrdiff_t stride) {
  switch (rows.kind) {
    case RowKind::kEven: return expand_as<RowKind::kEven>(rows, group, first, last, out, stride);
    case RowKind::kTable: return expand_as<RowKind::kTable>(rows, group, first, last, out, stride);
    case RowKind::kSector: return expand_as<RowKind::kSector>(rows, group, first, last, out, stride);
  }
}

void copy_rows_kernel(const float* from, std::ptrdiff_t from_stride, float* to, std::ptrdiff_t to_stride,
                      int columns, int rows, bool stream) {
  const RowTag d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const auto bytes = static_cast<std::uintptr_t>(lanes) * sizeof(float);
  for (int r = 0; r < rows; ++r, from += from_stride, to += to_stride) {
    std::ptrdiff_t x = 0;
    if (stream) {
      // hn::Stream() needs an aligned address.
      while (x < columns && reinterpret_cast<std::uintptr_t>(to + x) % bytes != 0) {
        to[x] = from[x];
        ++x;
      }
      for (; x + 4 * lanes <= columns; x += 4 * lanes) {
        hn::Stream(hn::LoadU(d, from + x), d, to + x);
        hn::Stream(hn::LoadU(d, from + x + lanes), d, to + x + lanes);
        hn::Stream(hn::LoadU(d, from + x + 2 * lanes), d, to + x + 2 * lanes);
        hn::Stream(hn::LoadU(d, from + x + 3 * lanes), d, to + x + 3 * lanes);
      }
      for (; x + lanes <= columns; x += lanes) hn::Stream(hn::LoadU(d, from + x), d, to + x);
    }
    for (; x + lanes <= columns; x += lanes) hn::StoreU(hn::LoadU(d, from + x), d, to + x);
    for (; x < columns; ++x) to[x] = from[x];
  }
  if (stream) hwy::FlushStream();
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
