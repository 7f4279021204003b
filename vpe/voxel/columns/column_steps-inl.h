// Steps the floating horizon of a group of columns through one height grid: the inner loop of the ray backend.
//
// Part of column_kernel.cpp, called by walk_grid(). The paths come from column_paths-inl.h, posts from
// column_lines-inl.h, slopes from column_rows-inl.h. Events (crossings with edges) resolve rows.
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
#include <cstdint>

#include "vpe/voxel/columns/column_lines-inl.h"
#include "vpe/voxel/columns/column_paths-inl.h"
#include "vpe/voxel/columns/column_rows-inl.h"
#include "vpe/voxel/columns/column_scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Walks the lanes that cross one height grid by the same family of lines in the same direction.
template <class D, RowKind kKind>
class HorizonWalk {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

  HorizonWalk(const HeightGridLines<T>& lines, LineFamily family, int intervals, const Paths& paths, int kind,
              int lane0, const ColumnCamera& camera, const Rows& rows, ColumnGroup& group)
      : lane0_(lane0),
        reader_(lines, family, intervals, load(paths.position0), load(paths.position1)),
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
    last_x_ = hn::Zero(d);
    last_h_ = hn::Zero(d);
    update_slope();
  }

  // Returns true if some lane has unresolved rows.
  bool any() const { return !hn::AllFalse(D(), alive_); }

  // Starts the lanes whose path begins at the camera's foot inside this grid, at line `foot` with height
  // `height`.
  void start_at_foot(T foot, T height, const Paths& paths) {
    const D d;
    const V at = hn::Set(d, foot);
    const V from = load(paths.from);
    const V to = load(paths.to);
    const V near = hn::Set(d, sizeof(T) == 8 ? T(1e-9) : T(1e-4));
    started_ = hn::And(
        active_, hn::Or(hn::Lt(hn::Abs(hn::Sub(from, at)), near), hn::Lt(hn::Abs(hn::Sub(to, at)), near)));
    last_x_ = at;
    last_h_ = hn::Set(d, height);
  }

  // Walks outward from line `first` to line `last`, in whole blocks where possible. Skips hidden blocks.
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
        const bool all = all_inside(low, high);
        const Reach reach = all ? reach_of_all() : reach_of_some();
        if (reach == Reach::kNear) {
          walk_block<Reach::kNear>(up, all, k, next);
        } else if (reach == Reach::kWide) {
          walk_block<Reach::kWide>(up, all, k, next);
        } else {
          walk_block<Reach::kAny>(up, false, k, next);
        }
      }
      k = next;
    }
  }

  template <Reach kReach>
  void walk_block(bool up, bool all, int first, int last) {
    if (kReach != Reach::kAny && all) {
      up ? step_all<true, kReach>(first, last) : step_all<false, kReach>(first, last);
    } else {
      up ? step_masked<true, kReach>(first, last) : step_masked<false, kReach>(first, last);
    }
  }

  // Writes the lanes' next rows back to the group.
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

  // Subtracts the line z = slope sigma of the next row from the paths' heights, and updates which lanes are
  // alive.
  void update_slope() {
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

  // Returns true if nothing between two lines of one block can reach any lane's next row.
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

  // Returns true if all lanes that are alive have started and are inside the grid, in front of the camera, at
  // both lines.
  bool all_inside(int low, int high) const {
    const D d;
    if (at_low_.low < reader_.first_position(low) || at_low_.high >= reader_.last_position(low)) return false;
    if (at_high_.low < reader_.first_position(high) || at_high_.high >= reader_.last_position(high))
      return false;
    const M ready = hn::And(started_, hn::And(in_front(hn::Set(d, static_cast<T>(low))),
                                              in_front(hn::Set(d, static_cast<T>(high)))));
    return hn::AllFalse(d, hn::AndNot(ready, alive_));
  }

  // Records a path's first event. Nothing of this grid lies before it, so rows are resolved at the event
  // itself.
  void begin_path(M lanes, V x, V height) {
    const D d;
    last_x_ = hn::IfThenElse(lanes, x, last_x_);
    last_h_ = hn::IfThenElse(lanes, hn::Sub(height, hn::Set(d, T(1))), last_h_);
    started_ = hn::Or(started_, lanes);
  }

  // Resolves rows of the lanes whose event reaches their next row.
  void test_event(M lanes, V x, V height) {
    const D d;
    const V rest = hn::Add(height, rest_at(x));
    const M reached = hn::And(hn::And(lanes, alive_), hn::Ge(rest, hn::Zero(d)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, reached))) resolve(reached, x, height, rest);
  }

  // Starts the lanes that are on line k, after hidden blocks or at the border of the grid.
  void enter(int k) {
    const D d;
    const typename PathReader<D>::Line line = reader_.gather(k);
    const V x = hn::Set(d, static_cast<T>(k));
    const M here = hn::And(active_, hn::And(reader_.on_line(k, line), in_front(x)));
    const V height = reader_.height_on(line);
    begin_path(here, x, height);
    test_event(here, x, height);
    last_x_ = hn::IfThenElse(here, x, last_x_);
    last_h_ = hn::IfThenElse(here, height, last_h_);
  }

  static Reach reach_for(T width) {
    return width <= PathReader<D>::kNearWidth
               ? Reach::kNear
               : (width <= PathReader<D>::kWideWidth ? Reach::kWide : Reach::kAny);
  }

  // Returns the reach when each line has a window of its own.
  Reach reach_of_all() const {
    return reach_for(std::max(at_low_.high - at_low_.low, at_high_.high - at_high_.low));
  }

  // Returns the reach when lanes enter and leave, so that one window serves the whole block; sets its start.
  Reach reach_of_some() {
    const T last = static_cast<T>(reader_.intervals());
    from_ = std::clamp(std::min(at_low_.low, at_high_.low), T(-1), last);
    return reach_for(std::clamp(std::max(at_low_.high, at_high_.high), T(-1), last) - from_);
  }

  // Walks a block in which lanes may enter or leave the grid.
  template <bool kUp, Reach kReach>
  void step_masked(int first, int last) {
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
      // Both ends of the edge must be posts of this grid.
      const V one = hn::Set(d, T(1));
      const V low_post = hn::IfThenElse(c.other, hn::Add(lower.whole, one), lower.whole);
      const V high_post = hn::Add(lower.whole, one);
      M here = hn::And(hn::Ge(low_post, hn::Set(d, reader_.first_position(low_k))),
                       hn::Le(low_post, hn::Set(d, reader_.last_position(low_k))));
      here = hn::And(here, hn::And(hn::Ge(high_post, hn::Set(d, reader_.first_position(low_k + 1))),
                                   hn::Le(high_post, hn::Set(d, reader_.last_position(low_k + 1)))));
      here = hn::And(here, hn::And(active_, in_front(c.x)));
      // A path that begins at the camera's foot has no events before it.
      here = hn::And(here, outward<kUp>(c.x));
      process_event(here, c.x, c.height);
      const V x = hn::Set(d, static_cast<T>(next_k));
      const M there =
          hn::And(hn::And(active_, reader_.on_line(next_k, next)), hn::And(in_front(x), outward<kUp>(x)));
      process_event(there, x, reader_.height_on(next));
      line = next;
    }
  }

  template <bool kUp>
  M outward(V x) const {
    const M beyond = kUp ? hn::Ge(x, last_x_) : hn::Le(x, last_x_);
    return hn::Or(beyond, hn::Not(started_));
  }

  // Starts lanes where needed, tests the event and makes it the last one.
  void process_event(M lanes, V x, V height) {
    begin_path(hn::AndNot(started_, lanes), x, height);
    test_event(lanes, x, height);
    last_x_ = hn::IfThenElse(lanes, x, last_x_);
    last_h_ = hn::IfThenElse(lanes, height, last_h_);
  }

  // Walks a block that all lanes cross.
  template <bool kUp, Reach kReach>
  void step_all(int first, int last) {
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
        last_x_ = c.x;
        last_h_ = c.height;
        test_event(alive_, x, height);
      }
      last_x_ = x;
      last_h_ = height;
      line = next;
    }
  }

  // Resolves the rows up to the slope of an event: they show the facet between the last event and this one.
  void resolve(M lanes, V x, V height, V rest) {
    const D d;
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, T(1));
    const V sigma = hn::MulAdd(sigma1_, x, sigma0_);
    const V per_sigma = reciprocal(d, sigma);
    const V reached = hn::Mul(hn::Add(height, hn::MulAdd(base1_, x, base0_)), per_sigma);
    V rows = hn::Max(model_.count_up_to(reached), hn::Add(row_, one));
    rows = hn::Min(rows, end_);
    // The place where the next row's ray meets the facet.
    const V before = hn::Min(hn::Add(last_h_, rest_at(last_x_)), zero);
    const V share =
        hn::Min(hn::Mul(before, reciprocal(d, hn::Sub(before, hn::Max(rest, smallest_divisor())))), one);
    const V at_x = hn::MulAdd(share, hn::Sub(x, last_x_), last_x_);
    const V at_h = hn::MulAdd(share, hn::Sub(height, last_h_), last_h_);
    const V at = hn::Mul(inverse(at_x, at_h), reciprocal(d, hn::MulAdd(sigma1_, at_x, sigma0_)));
    const V top = hn::Sub(rows, one);
    const M more = hn::And(lanes, hn::Gt(top, row_));
    // Where pairs are stored without a branch, one here would be guessed wrong too often.
    if (!kStoresPairs && hn::AllFalse(d, more)) {
      scatter<kValueStep>(d, group_.start, lane0_, lanes, top, at);
    } else {
      const V end = hn::Mul(inverse(x, height), per_sigma);
      const V rise = hn::Sub(reached, slope_);
      const M rises = hn::And(more, hn::Gt(rise, zero));
      const V gain = hn::IfThenElse(rises, hn::Div(hn::Sub(end, at), rise), zero);
      // From the event, which is nearer to the top row: from the first row of a run that begins straight below
      // the camera the difference of two large numbers would be left.
      const V at_top = hn::IfThenElse(rises, hn::MulAdd(gain, hn::Sub(model_.slope(top), reached), end), at);
#if HWY_TARGET == HWY_AVX2
      if constexpr (kStoresPairs)
        scatter_pairs(d, group_.start, lanes, hn::IfThenElse(lanes, top, row_), at_top, gain);
#endif
      // The gain of other rows is 0 already.
      if constexpr (!kStoresPairs)
        scatter<kValueStep>(d, group_.start, group_.gain, lane0_, lanes, top, at_top, gain);
    }
    row_ = hn::IfThenElse(lanes, rows, row_);
    update_slope();
  }

  // Returns w R^2 / |E|; divided by sigma it is the inverse horizontal distance.
  V inverse(V x, V height) const {
    return hn::NegMulAdd(height, per_distance_, hn::MulAdd(depth1_, x, depth0_));
  }

  // Keeps a quotient of two zeros from being NaN.
  static V smallest_divisor() { return hn::Set(D(), T(1e-30)); }

  static constexpr bool kStoresPairs = kValueStep == 2 && sizeof(T) == 4;

  int lane0_;
  PathReader<D> reader_;
  ColumnGroup& group_;
  RowModel<D, kKind> model_;
  V sigma0_, sigma1_, base0_, base1_, depth0_, depth1_, per_distance_;
  V row_, end_, slope_, base_s0_, base_s1_;
  M active_, alive_, started_;
  V last_x_, last_h_;  // the last event of each lane
  Extent at_low_{};
  Extent at_high_{};
  T from_ = 0;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
