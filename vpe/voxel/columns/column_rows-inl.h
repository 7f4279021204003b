// Computes slopes of rows, and rows of slopes, for vectors of columns.
//
// Part of column_kernel.cpp, below column_steps-inl.h and column_expand-inl.h.
#if defined(VPE_VOXEL_COLUMN_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_COLUMN_ROWS_INL_H_
#undef VPE_VOXEL_COLUMN_ROWS_INL_H_
#else
#define VPE_VOXEL_COLUMN_ROWS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

#include "vpe/voxel/columns/columns.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Returns y / x to the last bit or two. Requires an x that is finite and not tiny. Dividing takes less time than estimates with two
// steps of Newton's method, as long as vectors are no wider than eight floats.
template <class D>
hn::Vec<D> quotient([[maybe_unused]] D d, hn::Vec<D> y, hn::Vec<D> x) {
#if HWY_TARGET <= HWY_AVX3
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    const auto guess = hn::ApproximateReciprocal(x);
    // One step of Newton's method doubles the correct bits.
    const auto error = hn::NegMulAdd(x, guess, hn::Set(d, 1.0F));
    return hn::Mul(y, hn::MulAdd(guess, error, guess));
  }
#endif
  return hn::Div(y, x);
}

// Converts between rows and slopes of as many lanes as D has.
template <class D, RowKind kKind>
class RowModel {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  RowModel(const Rows& rows, const ColumnGroup& group, int lane0)
      : rows_(rows), count_(hn::Set(D(), static_cast<T>(rows.count))) {
    if constexpr (kKind == RowKind::kEven) {
      centre_ = hn::Set(D(), static_cast<T>(rows.centre));
      step_ = hn::Set(D(), static_cast<T>(rows.step));
      per_step_ = hn::Set(D(), static_cast<T>(1.0 / rows.step));
    }
    if constexpr (kKind == RowKind::kSector) {
      a0_ = load(group.sector_a0 + lane0);
      a1_ = load(group.sector_a1 + lane0);
      b0_ = load(group.sector_b0 + lane0);
      b1_ = load(group.sector_b1 + lane0);
    }
  }

  // Returns the model of other lanes, if lanes differ: of_lane(V) is a vector with the values that they have.
  template <class OfLane>
  decltype(auto) with_lanes([[maybe_unused]] OfLane&& of_lane) const {
    if constexpr (kKind == RowKind::kSector) {
      RowModel out = *this;
      out.a0_ = of_lane(a0_);
      out.a1_ = of_lane(a1_);
      out.b0_ = of_lane(b0_);
      out.b1_ = of_lane(b1_);
      return out;
    } else {
      return static_cast<const RowModel&>(*this);
    }
  }

  // Returns the slopes of rows, whole numbers in [0, count].
  V slope(V row) const {
    const D d;
    if constexpr (kKind == RowKind::kEven) return hn::Mul(hn::Sub(row, centre_), step_);
    if constexpr (kKind == RowKind::kTable) return table(row);
    if constexpr (kKind == RowKind::kSector) {
      // Beyond the last row the coefficients may describe any direction.
      const V last = hn::Min(row, hn::Sub(count_, hn::Set(d, T(1))));
      return hn::Div(hn::MulAdd(a1_, last, a0_), hn::MulAdd(b1_, last, b0_));
    }
  }

  // Returns the number of rows whose slope is at most slope_now.
  V count_up_to(V slope_now) const {
    const D d;
    const V one = hn::Set(d, T(1));
    V n;
    if constexpr (kKind == RowKind::kEven) {
      n = hn::Add(hn::Floor(hn::MulAdd(slope_now, per_step_, centre_)), one);
    } else if constexpr (kKind == RowKind::kSector) {
      const V above = hn::NegMulAdd(slope_now, b1_, a1_);
      const V row = hn::Div(hn::MulSub(slope_now, b0_, a0_), above);
      n = hn::Add(hn::Floor(row), one);
      n = hn::IfThenElse(hn::Le(above, hn::Zero(d)), count_, n);
    } else {
      const V first = hn::Set(d, static_cast<T>(rows_.first_elevation));
      const V per = hn::Set(d, static_cast<T>(1.0 / rows_.elevation_step));
      n = hn::Floor(hn::Mul(hn::Sub(hn::Atan(d, slope_now), first), per));
      n = hn::Min(hn::Max(n, hn::Zero(d)), count_);
      // The estimate is off by at most one row.
      n = hn::IfThenElse(hn::Le(table(n), slope_now), hn::Add(n, one), n);
      n = hn::Min(n, count_);
      const V before = hn::Max(hn::Sub(n, one), hn::Zero(d));
      n = hn::IfThenElse(hn::Gt(table(before), slope_now), before, n);
    }
    return hn::Min(n, count_);
  }

 private:
  static V load(const double* from) {
    T values[kMaxLanes];
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k) values[k] = static_cast<T>(from[k]);
    return hn::LoadU(D(), values);
  }
  V table(V row) const {
    const D d;
    const hn::RebindToSigned<D> di;
    if constexpr (sizeof(T) == 4) {
      return hn::GatherIndex(d, rows_.slope, hn::ConvertTo(di, row));
    } else {
      return hn::GatherIndex(d, rows_.slope_exact, hn::ConvertTo(di, row));
    }
  }

  const Rows& rows_;
  V count_;
  V centre_, step_, per_step_;
  V a0_, a1_, b0_, b1_;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
