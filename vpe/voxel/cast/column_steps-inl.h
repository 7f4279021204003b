// The floating horizon of a group of columns, step by step through one lattice.
#if defined(VPE_VOXEL_COLUMN_STEPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_COLUMN_STEPS_INL_H_
#undef VPE_VOXEL_COLUMN_STEPS_INL_H_
#else
#define VPE_VOXEL_COLUMN_STEPS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <algorithm>
#include <bit>
#include <cstdint>

#include "vpe/voxel/cast/column_lines-inl.h"
#include "vpe/voxel/cast/column_paths-inl.h"
#include "vpe/voxel/cast/column_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Lanes that go through one lattice the same way.
template <class D, RowKind kKind>
class Walk {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

  Walk(const HeightGridLines<T>& lines, LineFamily family, int intervals, const Paths& paths, int kind,
       int lane0, const ColumnCamera& camera, const Rows& rows, ColumnGroup& group)
      : lane0_(lane0),
        reader_(lines, family, intervals, load(paths.position), load(paths.turn)),
        group_(group),
        model_(rows, group, lane0) {
    const D d;
    sigma0_ = load(paths.sigma0);
    sigma1_ = load(paths.sigma1);
    base0_ = load(paths.base0);
    base1_ = load(paths.base1);
    depth0_ = load(paths.depth0);
    depth1_ = load(paths.depth1);
    per_distance_ = hn::Set(d, static_cast<T>(1.0 / camera.distance_m));
    row_ = load(group.row);
    end_ = load(group.row_end);
    active_ = hn::Eq(load(paths.kind), hn::Set(d, static_cast<T>(kind)));
    started_ = hn::MaskFromVec(hn::Zero(d));
    seen_x_ = hn::Zero(d);
    seen_h_ = hn::Zero(d);
    aim();
  }

  bool any() const { return !hn::AllFalse(D(), alive_); }

  // Lanes whose path begins at the camera's foot inside this lattice, at line `foot` with post value `height`.
  void start_at_foot(T foot, T height, const Paths& paths) {
    const D d;
    const V at = hn::Set(d, foot);
    const V from = load(paths.from);
    const V to = load(paths.to);
    const V near = hn::Set(d, sizeof(T) == 8 ? T(1e-9) : T(1e-4));
    started_ = hn::And(
        active_, hn::Or(hn::Lt(hn::Abs(hn::Sub(from, at)), near), hn::Lt(hn::Abs(hn::Sub(to, at)), near)));
    seen_x_ = at;
    seen_h_ = hn::Set(d, height);
  }

  // From line `first` to line `last`, outward; stays in whole blocks where it can.
  void run(int first, int last) {
    const bool up = last > first;
    bool fresh = true;
    for (int k = first; k != last && any();) {
      const int next = up ? std::min(last, (floor_block(k) + 1) * kBlockLines)
                          : std::max(last, floor_block(k - 1) * kBlockLines);
      const int low = std::min(k, next);
      const int high = std::max(k, next);
      if (hidden(low, high)) {
        fresh = true;
      } else {
        if (fresh) enter(k);
        fresh = false;
        const bool all = settled(low, high);
        const Reach reach = all ? reach_of_all() : reach_of_some();
        if (reach == Reach::kNear) {
          block<Reach::kNear>(up, all, k, next);
        } else if (reach == Reach::kWide) {
          block<Reach::kWide>(up, all, k, next);
        } else {
          block<Reach::kAny>(up, false, k, next);
        }
      }
      k = next;
    }
  }

  template <Reach kReach>
  void block(bool up, bool all, int first, int last) {
    if (kReach != Reach::kAny && all) {
      up ? fast<true, kReach>(first, last) : fast<false, kReach>(first, last);
    } else {
      up ? careful<true, kReach>(first, last) : careful<false, kReach>(first, last);
    }
  }

  void store() const {
    alignas(64) T rows[kMaxLanes];
    hn::Store(row_, D(), rows);
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k) {
      const auto lane = static_cast<std::size_t>(lane0_) + k;
      group_.row[lane] = static_cast<float>(rows[k]);
    }
  }

 private:
  template <typename S>
  V load(const S* from) const {
    alignas(64) T values[kMaxLanes];
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k)
      values[k] = static_cast<T>(from[lane0_ + static_cast<int>(k)]);
    return hn::Load(D(), values);
  }

  static int floor_block(int k) { return k >= 0 ? k / kBlockLines : -((kBlockLines - 1 - k) / kBlockLines); }

  // The line z = slope sigma of the next row, subtracted from all that comes.
  void aim() {
    slope_ = model_.slope(row_);
    base_s0_ = hn::NegMulAdd(slope_, sigma0_, base0_);
    base_s1_ = hn::NegMulAdd(slope_, sigma1_, base1_);
    alive_ = hn::And(active_, hn::Lt(row_, end_));
  }

  V rest_at(V x) const { return hn::MulAdd(base_s1_, x, base_s0_); }

  struct Extent {
    T low;
    T high;
  };
  Extent extent(V position) const {
    const D d;
    const V far = hn::Set(d, T(1e30));
    return {hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(alive_, position, far))),
            hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElse(alive_, position, hn::Neg(far))))};
  }

  // Whether nothing between two lines of one block can reach any lane's next row.
  bool hidden(int low, int high) {
    const D d;
    at_low_ = extent(reader_.position_at(low));
    at_high_ = extent(reader_.position_at(high));
    const T last = static_cast<T>(reader_.intervals());
    const int c0 = static_cast<int>(std::clamp(std::min(at_low_.low, at_high_.low), T(0), last)) / kBlockLines;
    const int c1 =
        static_cast<int>(std::clamp(std::max(at_low_.high, at_high_.high), T(0), last)) / kBlockLines;
    const T* maxima = reader_.maxima(floor_block(low));
    T highest = maxima[c0];
    for (int c = c0 + 1; c <= c1; ++c) highest = std::max(highest, maxima[c]);
    const V a = rest_at(hn::Set(d, static_cast<T>(low)));
    const V b = rest_at(hn::Set(d, static_cast<T>(high)));
    const V top = hn::Add(hn::Max(a, b), hn::Set(d, highest));
    return hn::AllFalse(d, hn::And(alive_, hn::Ge(top, hn::Zero(d))));
  }

  M in_front(V x) const { return hn::Gt(hn::MulAdd(sigma1_, x, sigma0_), hn::Zero(D())); }

  // Whether all lanes that are alive are inside at both lines, have begun and are near each other.
  bool settled(int low, int high) const {
    const D d;
    if (at_low_.low < reader_.first_position(low) || at_low_.high >= reader_.last_position(low)) return false;
    if (at_high_.low < reader_.first_position(high) || at_high_.high >= reader_.last_position(high))
      return false;
    const M ready = hn::And(started_, hn::And(in_front(hn::Set(d, static_cast<T>(low))),
                                              in_front(hn::Set(d, static_cast<T>(high)))));
    return hn::AllFalse(d, hn::AndNot(ready, alive_));
  }

  // A path's first event: what lies before it is not of this lattice, so a row is resolved at the event itself.
  void begin(M who, V x, V height) {
    const D d;
    seen_x_ = hn::IfThenElse(who, x, seen_x_);
    seen_h_ = hn::IfThenElse(who, hn::Sub(height, hn::Set(d, T(1))), seen_h_);
    started_ = hn::Or(started_, who);
  }

  void event(M who, V x, V height) {
    const D d;
    const V rest = hn::Add(height, rest_at(x));
    const M reached = hn::And(hn::And(who, alive_), hn::Ge(rest, hn::Zero(d)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, reached))) resolve(reached, x, height, rest);
  }

  void enter(int k) {
    const D d;
    const typename PathReader<D>::Line line = reader_.gather(k);
    const V x = hn::Set(d, static_cast<T>(k));
    const M here = hn::And(active_, hn::And(reader_.on_line(k, line), in_front(x)));
    const V height = reader_.height_on(line);
    begin(here, x, height);
    event(here, x, height);
    seen_x_ = hn::IfThenElse(here, x, seen_x_);
    seen_h_ = hn::IfThenElse(here, height, seen_h_);
  }

  static Reach reach_for(T width) {
    return width <= PathReader<D>::kNearWidth
               ? Reach::kNear
               : (width <= PathReader<D>::kWideWidth ? Reach::kWide : Reach::kAny);
  }

  // A window of its own for each line.
  Reach reach_of_all() const {
    return reach_for(std::max(at_low_.high - at_low_.low, at_high_.high - at_high_.low));
  }

  // One for the whole block: lanes come and go.
  Reach reach_of_some() {
    const T last = static_cast<T>(reader_.intervals());
    from_ = std::clamp(std::min(at_low_.low, at_high_.low), T(-1), last);
    return reach_for(std::clamp(std::max(at_low_.high, at_high_.high), T(-1), last) - from_);
  }

  // Lanes may come and go.
  template <bool kUp, Reach kReach>
  void careful(int first, int last) {
    const D d;
    const auto read = [&](int k) { return reader_.template read<kReach>(k, from_); };
    typename PathReader<D>::Line line = read(first);
    for (int k = first; k != last; k += kUp ? 1 : -1) {
      const int next_k = kUp ? k + 1 : k - 1;

      const typename PathReader<D>::Line next = read(next_k);
      const int low_k = kUp ? k : next_k;
      const auto& lower = kUp ? line : next;
      const auto& upper = kUp ? next : line;
      const auto c = reader_.between(low_k, lower, upper);
      // Both ends of the edge must be posts of this lattice.
      const V one = hn::Set(d, T(1));
      const V low_post = hn::IfThenElse(c.other, hn::Add(lower.whole, one), lower.whole);
      const V high_post = hn::Add(lower.whole, one);
      M here = hn::And(hn::Ge(low_post, hn::Set(d, reader_.first_position(low_k))),
                       hn::Le(low_post, hn::Set(d, reader_.last_position(low_k))));
      here = hn::And(here, hn::And(hn::Ge(high_post, hn::Set(d, reader_.first_position(low_k + 1))),
                                   hn::Le(high_post, hn::Set(d, reader_.last_position(low_k + 1)))));
      here = hn::And(here, hn::And(active_, in_front(c.x)));
      // A path that begins at the camera's foot has nothing before it.
      here = hn::And(here, outward<kUp>(c.x));
      pass(here, c.x, c.height);
      const V x = hn::Set(d, static_cast<T>(next_k));
      const M there =
          hn::And(hn::And(active_, reader_.on_line(next_k, next)), hn::And(in_front(x), outward<kUp>(x)));
      pass(there, x, reader_.height_on(next));
      line = next;
    }
  }

  template <bool kUp>
  M outward(V x) const {
    const M beyond = kUp ? hn::Ge(x, seen_x_) : hn::Le(x, seen_x_);
    return hn::Or(beyond, hn::Not(started_));
  }

  void pass(M who, V x, V height) {
    begin(hn::AndNot(started_, who), x, height);
    event(who, x, height);
    seen_x_ = hn::IfThenElse(who, x, seen_x_);
    seen_h_ = hn::IfThenElse(who, height, seen_h_);
  }

  // All lanes are there.
  template <bool kUp, Reach kReach>
  void fast(int first, int last) {
    const D d;
    const V zero = hn::Zero(d);
    const T rate = (at_high_.low - at_low_.low) / static_cast<T>(std::abs(last - first));
    const int low_end = std::min(first, last);
    const auto from = [&](int k) { return at_low_.low + rate * static_cast<T>(k - low_end); };
    typename PathReader<D>::Line line = reader_.template read<kReach>(first, from(first));
    for (int k = first; k != last; k += kUp ? 1 : -1) {
      const int next_k = kUp ? k + 1 : k - 1;

      const typename PathReader<D>::Line next = reader_.template read<kReach>(next_k, from(next_k));
      const auto c = reader_.between(kUp ? k : next_k, kUp ? line : next, kUp ? next : line);
      const V x = hn::Set(d, static_cast<T>(next_k));
      const V height = reader_.height_on(next);
      const V rest_c = hn::Add(c.height, rest_at(c.x));
      const V rest = hn::Add(height, rest_at(x));
      const M reached = hn::And(alive_, hn::Ge(hn::Max(rest_c, rest), zero));
      if (!hn::AllFalse(d, reached)) {
        const M first_reached = hn::And(alive_, hn::Ge(rest_c, zero));
        if (!hn::AllFalse(d, first_reached)) resolve(first_reached, c.x, c.height, rest_c);
        seen_x_ = c.x;
        seen_h_ = c.height;
        event(alive_, x, height);
      }
      seen_x_ = x;
      seen_h_ = height;
      line = next;
    }
  }

  // Rows up to the slope of an event are resolved by the facet between the last event and this one.
  void resolve(M who, V x, V height, V rest) {
    const D d;
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, T(1));
    const V sigma = hn::MulAdd(sigma1_, x, sigma0_);
    const V per_sigma = reciprocal(d, sigma);
    const V reached = hn::Mul(hn::Add(height, hn::MulAdd(base1_, x, base0_)), per_sigma);
    V rows = hn::Max(model_.count_up_to(reached), hn::Add(row_, one));
    rows = hn::Min(rows, end_);
    // Where the next row's ray meets the facet.
    const V before = hn::Min(hn::Add(seen_h_, rest_at(seen_x_)), zero);
    const V share = hn::Min(hn::Mul(before, reciprocal(d, hn::Sub(before, hn::Max(rest, least())))), one);
    const V at_x = hn::MulAdd(share, hn::Sub(x, seen_x_), seen_x_);
    const V at_h = hn::MulAdd(share, hn::Sub(height, seen_h_), seen_h_);
    const V at = hn::Mul(inverse(at_x, at_h), reciprocal(d, hn::MulAdd(sigma1_, at_x, sigma0_)));
    scatter(group_.start, who, at);
    const M more = hn::And(who, hn::Gt(rows, hn::Add(row_, one)));
    if (!hn::AllFalse(d, more)) {
      const V end = hn::Mul(inverse(x, height), per_sigma);
      const V rise = hn::Sub(reached, slope_);
      const M rises = hn::And(more, hn::Gt(rise, zero));
      scatter(group_.gain, rises, hn::Div(hn::Sub(end, at), rise));
    }
    row_ = hn::IfThenElse(who, rows, row_);
    aim();
  }

  // w R^2 / |E|: over sigma it is the inverse horizontal distance.
  V inverse(V x, V height) const {
    return hn::NegMulAdd(height, per_distance_, hn::MulAdd(depth1_, x, depth0_));
  }

  // Keeps a quotient of two zeros from being NaN.
  static V least() { return hn::Set(D(), T(1e-30)); }

  // To each lane's next row.
  void scatter(float* to, M who, V values) const {
    const D d;
#if HWY_TARGET <= HWY_AVX3
    if constexpr (sizeof(T) == 4) {
      const __m512i row = _mm512_cvttps_epi32(row_.raw);
      const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
      _mm512_mask_i32scatter_ps(to, who.raw, _mm512_add_epi32(_mm512_slli_epi32(row, 4), lane), values.raw, 4);
      return;
    }
#endif
    alignas(64) T rows[kMaxLanes];
    alignas(64) T all[kMaxLanes];
    hn::Store(row_, d, rows);
    hn::Store(values, d, all);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, who, bits);
    for (unsigned left = bits[0]; left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      to[static_cast<std::size_t>(rows[k]) * kMaxLanes + static_cast<std::size_t>(lane0_) + k] =
          static_cast<float>(all[k]);
    }
  }

  int lane0_;
  PathReader<D> reader_;
  ColumnGroup& group_;
  RowModel<D, kKind> model_;
  V sigma0_, sigma1_, base0_, base1_, depth0_, depth1_, per_distance_;
  V row_, end_, slope_, base_s0_, base_s1_;
  M active_, alive_, started_;
  V seen_x_, seen_h_;  // the last event of each lane
  Extent at_low_{};
  Extent at_high_{};
  T from_ = 0;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
