// Stores the runs of rows that events resolve.
//
// Part of column_kernel.cpp, below column_steps-inl.h. An event resolves rows of few columns at a time, and only the next row of a
// column depends on it at once. So with eight lanes (AVX2) events wait until there are enough of them for whole vectors.
#if defined(VPE_VOXEL_COLUMN_RUNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_COLUMN_RUNS_INL_H_
#undef VPE_VOXEL_COLUMN_RUNS_INL_H_
#else
#define VPE_VOXEL_COLUMN_RUNS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "vpe/voxel/columns/column_rows-inl.h"
#include "vpe/voxel/columns/column_scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Holds a crossing with an edge, and the one before it: both ends of a facet's section with the column.
template <class D>
struct FacetEvent {
  hn::Vec<D> x, height;
  hn::Vec<D> last_x, last_height;
};

// Returns the first event for some lanes, and the second one for the others.
template <class D>
FacetEvent<D> merge(hn::Mask<D> lanes, const FacetEvent<D>& first, const FacetEvent<D>& second) {
  return {hn::IfThenElse(lanes, first.x, second.x), hn::IfThenElse(lanes, first.height, second.height),
          hn::IfThenElse(lanes, first.last_x, second.last_x),
          hn::IfThenElse(lanes, first.last_height, second.last_height)};
}

// Holds what is affine along the lanes' paths through a height grid (Paths).
template <class D>
struct PathTerms {
  using V = hn::Vec<D>;
  V sigma0, sigma1, base0, base1, depth0, depth1;
  V per_distance;  // 1 / |E|, for all lanes alike

  V sigma(V x) const { return hn::MulAdd(sigma1, x, sigma0); }
  // Returns the slope of the ray to an event.
  V slope(const FacetEvent<D>& event) const {
    return quotient(D(), hn::Add(event.height, hn::MulAdd(base1, event.x, base0)), sigma(event.x));
  }
  // Returns w R^2 / |E|; divided by sigma it is the inverse horizontal distance.
  V inverse(V x, V height) const { return hn::NegMulAdd(height, per_distance, hn::MulAdd(depth1, x, depth0)); }
};

// Holds a run of rows: the inverse horizontal distance at its last row and the change of that per slope.
template <class D>
struct FacetRun {
  hn::Vec<D> top, start, gain;
};

// Returns the run of rows [row, rows) that an event resolves, the first of which has the slope `slope`.
template <class D, RowKind kKind>
FacetRun<D> facet_run(const PathTerms<D>& terms, const RowModel<D, kKind>& model, const FacetEvent<D>& event,
                      hn::Vec<D> slope, hn::Vec<D> row, hn::Vec<D> rows) {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  const D d;
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, T(1));
  const V base_s0 = hn::NegMulAdd(slope, terms.sigma0, terms.base0);
  const V base_s1 = hn::NegMulAdd(slope, terms.sigma1, terms.base1);
  const V rest = hn::Add(event.height, hn::MulAdd(base_s1, event.x, base_s0));
  const V per_sigma = quotient(d, one, terms.sigma(event.x));
  const V reached = hn::Mul(hn::Add(event.height, hn::MulAdd(terms.base1, event.x, terms.base0)), per_sigma);
  // The place where the next row's ray meets the facet. The least divisor keeps a quotient of two zeros from being NaN.
  const V before = hn::Min(hn::Add(event.last_height, hn::MulAdd(base_s1, event.last_x, base_s0)), zero);
  const V least = hn::Set(d, T(1e-30));
  const V share = hn::Min(quotient(d, before, hn::Sub(before, hn::Max(rest, least))), one);
  const V at_x = hn::MulAdd(share, hn::Sub(event.x, event.last_x), event.last_x);
  const V at_h = hn::MulAdd(share, hn::Sub(event.height, event.last_height), event.last_height);
  const V at = quotient(d, terms.inverse(at_x, at_h), terms.sigma(at_x));
  const V top = hn::Sub(rows, one);
  const V end = hn::Mul(terms.inverse(event.x, event.height), per_sigma);
  const V rise = hn::Sub(reached, slope);
  const auto rises = hn::And(hn::Gt(top, row), hn::Gt(rise, zero));
  const V gain = hn::IfThenElse(rises, hn::Div(hn::Sub(end, at), rise), zero);
  // From the event, which is nearer to the top row: from the first row of a run that begins straight below the camera the
  // difference of two large numbers would be left.
  return {top, hn::IfThenElse(rises, hn::MulAdd(gain, hn::Sub(model.slope(top), reached), end), at), gain};
}

// Writes runs at once.
template <class D, RowKind kKind>
class RunWriter {
 public:
  using V = hn::Vec<D>;

  // `terms` and `model` must outlive this.
  RunWriter(const PathTerms<D>& terms, const RowModel<D, kKind>& model, const Rows& /*rows*/,
            ColumnGroup& group, int lane0)
      : terms_(terms), model_(model), group_(group), lane0_(lane0) {}

  // Adds the rows [row, rows) that an event resolves in some lanes; `slope` is that of `row`.
  void add(hn::Mask<D> lanes, const FacetEvent<D>& event, V slope, V row, V rows) {
    const FacetRun<D> run = facet_run<D, kKind>(terms_, model_, event, slope, row, rows);
    // The gain of other rows is 0 already.
    if (hn::AllFalse(D(), hn::And(lanes, hn::Gt(run.top, row)))) {
      scatter<kValueStep>(D(), group_.start, lane0_, lanes, run.top, run.start);
    } else {
      scatter<kValueStep>(D(), group_.start, group_.gain, lane0_, lanes, run.top, run.start, run.gain);
    }
  }
  // Writes what was added. Must be called last.
  void finish() {}

 private:
  const PathTerms<D>& terms_;
  const RowModel<D, kKind>& model_;
  ColumnGroup& group_;
  int lane0_;
};

#if HWY_TARGET == HWY_AVX2
// Holds, for each set of eight lanes, their numbers in order.
inline constexpr std::array<std::uint64_t, 256> kLanesOfBits = [] {
  std::array<std::uint64_t, 256> out{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    int count = 0;
    for (unsigned lane = 0; lane < 8; ++lane) {
      if (((bits >> lane) & 1U) != 0) out[bits] |= std::uint64_t{lane} << (8 * count++);
    }
  }
  return out;
}();

// Writes runs in whole vectors, whatever their lanes.
template <RowKind kKind>
class RunWriter<hn::CappedTag<float, kMaxLanes>, kKind> {
 public:
  using D = hn::CappedTag<float, kMaxLanes>;
  using V = hn::Vec<D>;

  RunWriter(const PathTerms<D>& terms, const RowModel<D, kKind>& model, const Rows& rows, ColumnGroup& group,
            int /*lane0*/)
      : terms_(terms), model_(model), group_(group), spare_row_(static_cast<float>(rows.count)) {}

  void add(hn::Mask<D> lanes, const FacetEvent<D>& event, V slope, V row, V rows) {
    const auto bits = static_cast<unsigned>(_mm256_movemask_ps(lanes.raw));
    const __m256i lane = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(kLanesOfBits[bits])));
    float* const at = waiting_ + count_;
    const auto put = [&](Value value, V values) {
      _mm256_storeu_ps(at + value * kMostWaiting, _mm256_permutevar8x32_ps(values.raw, lane));
    };
    _mm256_storeu_ps(at + kLane * kMostWaiting, _mm256_castsi256_ps(lane));
    put(kX, event.x);
    put(kHeight, event.height);
    put(kLastX, event.last_x);
    put(kLastHeight, event.last_height);
    if constexpr (kKind != RowKind::kEven) put(kSlope, slope);
    put(kRow, row);
    put(kRows, rows);
    count_ += std::popcount(bits);
    if (HWY_UNLIKELY(count_ > kMostWaiting - kLanes)) write_whole();
  }

  void finish() {
    if (count_ >= kLanes) write_whole();
    if (count_ > 0) write<false>(0);
    count_ = 0;
  }

 private:
  static constexpr int kLanes = 8;
  static constexpr int kMostWaiting = 64;
  // Numbers what is kept of an event: among others its lane (an integer), the first row that it resolves with its slope, and the row
  // past the last.
  enum Value : std::uint8_t { kLane, kX, kHeight, kLastX, kLastHeight, kSlope, kRow, kRows, kValues };

  // Writes what fills vectors, and keeps the rest.
  HWY_NOINLINE void write_whole() {
    std::ptrdiff_t from = 0;
    for (; from + kLanes <= count_; from += kLanes) write<true>(from);
    count_ -= from;
    for (std::ptrdiff_t k = 0; k < kValues * kMostWaiting; k += kMostWaiting)
      _mm256_store_ps(waiting_ + k, _mm256_load_ps(waiting_ + k + from));
  }

  // Writes the events [from, from + 8), or those of them that are there.
  template <bool kWhole>
  HWY_INLINE void write(std::ptrdiff_t from) {
    const D d;
    const auto get = [&](Value value) { return hn::Load(d, waiting_ + value * kMostWaiting + from); };
    __m256i lane = _mm256_castps_si256(get(kLane).raw);
    const auto there = hn::FirstN(d, static_cast<std::size_t>(kWhole ? kLanes : count_ - from));
    if constexpr (!kWhole) lane = _mm256_and_si256(lane, _mm256_castps_si256(there.raw));
    const auto of_lane = [&](V value) { return V{_mm256_permutevar8x32_ps(value.raw, lane)}; };
    const PathTerms<D> terms{of_lane(terms_.sigma0), of_lane(terms_.sigma1), of_lane(terms_.base0),
                             of_lane(terms_.base1),  of_lane(terms_.depth0), of_lane(terms_.depth1),
                             terms_.per_distance};
    V row = get(kRow);
    V rows = get(kRows);
    if constexpr (!kWhole) {
      // What other lanes hold is not a row, and slopes of rows may be read from a table.
      row = hn::IfThenElseZero(there, row);
      rows = hn::IfThenElse(there, rows, hn::Set(d, 1.0F));
    }
    decltype(auto) model = model_.with_lanes(of_lane);
    const V slope = kKind == RowKind::kEven ? model.slope(row) : get(kSlope);
    FacetRun<D> run = facet_run<D, kKind>(terms, model, {get(kX), get(kHeight), get(kLastX), get(kLastHeight)},
                                          slope, row, rows);
    if constexpr (!kWhole) {
      run.top = hn::IfThenElse(there, run.top, hn::Set(d, spare_row_));
      run.start = hn::IfThenElseZero(there, run.start);
      run.gain = hn::IfThenElseZero(there, run.gain);
    }
    scatter_pairs(group_.start, lane, run.top, run.start, run.gain);
  }

  const PathTerms<D>& terms_;
  const RowModel<D, kKind>& model_;
  ColumnGroup& group_;
  float spare_row_;  // whose values stay 0
  std::ptrdiff_t count_ = 0;
  alignas(32) float waiting_[kValues * kMostWaiting];
};
#endif

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
