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
#include "vpe/voxel/columns/column_runs-inl.h"

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
        model_(rows, group, lane0),
        terms_{load(paths.sigma0),
               load(paths.sigma1),
               load(paths.base0),
               load(paths.base1),
               load(paths.depth0),
               load(paths.depth1),
               hn::Set(D(), static_cast<T>(1.0 / camera.distance_m))},
        runs_(terms_, model_, rows, group, lane0) {
    const D d;
    row_ = load(group.row);
    end_ = load(group.row_end);
    from_ = load(paths.from);
    to_ = load(paths.to);
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
      if (hidden(std::min(k, next), std::max(k, next))) {
        fresh = true;
      } else {
        if (fresh) enter(k);
        fresh = false;
        up ? walk_block<true>(k, next) : walk_block<false>(k, next);
      }
      k = next;
    }
  }

  // Writes the lanes' runs and next rows to the group.
  void store() {
    runs_.finish();
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

  // Walks a block whose extents are known: lanes that enter or leave it make its ends slower, not its middle.
  template <bool kUp>
  void walk_block(int first, int last) {
    if (all_inside(std::min(first, last), std::max(first, last))) return step_as<kUp, true>(first, last);
    const D d;
    const V far = hn::Set(d, T(1e30));
    // A lane has started two lines after it enters.
    const T low = hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElse(alive_, from_, hn::Neg(far))));
    const T high = hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(alive_, to_, far)));
    const auto bound = [&](T line) {
      return static_cast<int>(
          std::clamp(line, static_cast<T>(std::min(first, last)), static_cast<T>(std::max(first, last))));
    };
    const int begin = bound(kUp ? low + T(2) : high - T(1));
    const int end = bound(kUp ? high : low + T(1));
    if ((kUp ? end - begin : begin - end) < kShortest) return step_as<kUp, false>(first, last);
    if (begin != first) step_part<kUp>(first, begin);
    step_part<kUp>(begin, end);
    if (end != last) step_part<kUp>(end, last);
  }
  static constexpr int kShortest = 3;

  // Walks a part of a block.
  template <bool kUp>
  void step_part(int first, int last) {
    if (!any()) return;
    const int low = std::min(first, last);
    const int high = std::max(first, last);
    at_low_ = extent(reader_.position_at(low));
    at_high_ = extent(reader_.position_at(high));
    all_inside(low, high) ? step_as<kUp, true>(first, last) : step_as<kUp, false>(first, last);
  }

  template <bool kUp, bool kAll>
  void step_as(int first, int last) {
    switch (kAll ? reach_of_all() : reach_of_some()) {
      case Reach::kNear:
        return kAll ? step_all<kUp, Reach::kNear>(first, last) : step_masked<kUp, Reach::kNear>(first, last);
      case Reach::kWide:
        return kAll ? step_all<kUp, Reach::kWide>(first, last) : step_masked<kUp, Reach::kWide>(first, last);
      case Reach::kAny:
        return kAll ? step_all<kUp, Reach::kAny>(first, last) : step_masked<kUp, Reach::kAny>(first, last);
    }
  }

  static int floor_block(int k) { return k >= 0 ? k / kBlockLines : -((kBlockLines - 1 - k) / kBlockLines); }

  // Subtracts the line z = slope sigma of the next row from the paths' heights, and updates which lanes are
  // alive.
  void update_slope() {
    slope_ = model_.slope(row_);
    base_s0_ = hn::NegMulAdd(slope_, terms_.sigma0, terms_.base0);
    base_s1_ = hn::NegMulAdd(slope_, terms_.sigma1, terms_.base1);
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

  M in_front(V x) const { return hn::Gt(hn::MulAdd(terms_.sigma1, x, terms_.sigma0), hn::Zero(D())); }

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
    if (HWY_UNLIKELY(!hn::AllFalse(d, reached))) resolve(reached, {x, height, last_x_, last_h_});
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
    window_from_ = std::clamp(std::min(at_low_.low, at_high_.low), T(-1), last);
    return reach_for(std::clamp(std::max(at_low_.high, at_high_.high), T(-1), last) - window_from_);
  }

  // Walks a block in which lanes may enter or leave the grid.
  template <bool kUp, Reach kReach>
  void step_masked(int first, int last) {
    const D d;
    const int base = PathReader<D>::window_base(window_from_);
    const auto read = [&](int k) {
      return reader_.template read<kReach>(reader_.line_number(k), base, reader_.posts(k));
    };
    typename PathReader<D>::Line line = read(first);
    for (int k = first; k != last; k += kUp ? 1 : -1) {
      const int next_k = kUp ? k + 1 : k - 1;

      const typename PathReader<D>::Line next = read(next_k);
      const int low_k = kUp ? k : next_k;
      const auto& lower = kUp ? line : next;
      const auto& upper = kUp ? next : line;
      const auto c = reader_.between(reader_.line_number(low_k), lower, upper);
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

  // Walks a block, or a part of it, that all lanes cross.
  template <bool kUp, Reach kReach>
  void step_all(int first, int last) {
    const D d;
    const V zero = hn::Zero(d);
    constexpr int kStep = kUp ? 1 : -1;
    // The lowest position is affine between both ends, or higher. It is kept with a fraction of 16 bits, a little too high, as
    // windows begin a post earlier.
    constexpr T kOne = T(65536);
    const int rate =
        static_cast<int>((at_high_.low - at_low_.low) * kOne / static_cast<T>(std::abs(last - first)));
    int from = static_cast<int>((kUp ? at_low_.low : at_high_.low) * kOne) + 2 * kBlockLines;
    const std::ptrdiff_t step = kUp ? reader_.side() : -reader_.side();
    const int step_from = kUp ? rate : -rate;
    const T* const line_0 = reader_.posts(0);
    // Line 0 of diagonals does not follow on line -1 in memory.
    const T* posts = reader_.posts(std::min(first, last)) + (kUp ? 0 : (last - first) * step);
    const auto read = [&](V x, int k) {
      return reader_.template read<kReach>(x, (from >> 16) - 1, k == 0 ? line_0 : posts);
    };
    V last_x = hn::Set(d, static_cast<T>(first));
    // Copies of members, which stay in registers.
    V base_s0 = base_s0_;
    V base_s1 = base_s1_;
    M alive = alive_;
    V last_h = last_h_;
    V last_event_x = last_x_;
    typename PathReader<D>::Line line = read(last_x, first);
    for (int k = first + kStep; k != last + kStep; k += kStep) {
      from += step_from;
      posts += step;
      const V x = hn::Add(last_x, hn::Set(d, T(kStep)));
      const typename PathReader<D>::Line next = read(x, k);
      const auto c = reader_.between(kUp ? last_x : x, kUp ? line : next, kUp ? next : line);
      const V height = reader_.height_on(next);
      const V rest_c = hn::Add(c.height, hn::MulAdd(base_s1, c.x, base_s0));
      const V rest = hn::Add(height, hn::MulAdd(base_s1, x, base_s0));
      const M reached = hn::And(alive, hn::Ge(hn::Max(rest_c, rest), zero));
      if (!hn::AllFalse(d, reached)) {
        // Lanes that the edge between the lines reaches first, and the others at the line.
        M lanes = reached;
        M first_lanes = hn::And(reached, hn::Ge(rest_c, zero));
        FacetEvent<D> event{hn::IfThenElse(first_lanes, c.x, x), hn::IfThenElse(first_lanes, c.height, height),
                            hn::IfThenElse(first_lanes, last_event_x, c.x),
                            hn::IfThenElse(first_lanes, last_h, c.height)};
        for (;;) {
          resolve(lanes, event);
          base_s0 = base_s0_;
          base_s1 = base_s1_;
          alive = alive_;
          lanes = hn::And(hn::And(first_lanes, alive),
                          hn::Ge(hn::Add(height, hn::MulAdd(base_s1, x, base_s0)), zero));
          if (hn::AllFalse(d, lanes)) break;
          first_lanes = hn::MaskFromVec(zero);
          event = {x, height, c.x, c.height};
        }
      }
      last_x = x;
      last_event_x = x;
      last_h = height;
      line = next;
    }
    last_x_ = last_event_x;
    last_h_ = last_h;
  }

  // Resolves the rows up to the slope of an event: they show the facet between the event before it and this one.
  HWY_INLINE void resolve(M lanes, const FacetEvent<D>& event) {
    const D d;
    const V rows =
        hn::Min(hn::Max(model_.count_up_to(terms_.slope(event)), hn::Add(row_, hn::Set(d, T(1)))), end_);
    runs_.add(lanes, event, slope_, row_, rows);
    row_ = hn::IfThenElse(lanes, rows, row_);
    update_slope();
  }

  int lane0_;
  PathReader<D> reader_;
  ColumnGroup& group_;
  RowModel<D, kKind> model_;
  PathTerms<D> terms_;
  RunWriter<D, kKind> runs_;
  V row_, end_, slope_, base_s0_, base_s1_;
  M active_, alive_, started_;
  V last_x_, last_h_;  // the last event of each lane
  Extent at_low_{};
  Extent at_high_{};
  V from_, to_;  // lines between which a lane is inside the grid
  T window_from_ = 0;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
