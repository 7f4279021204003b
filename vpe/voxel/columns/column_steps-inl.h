// Steps the floating horizon of a group of columns through one height grid: the inner loop of the ray backend.
//
// Part of column_kernel.cpp, called by walk_grid(). The paths come from column_paths-inl.h, posts from
// column_lines-inl.h. Events (crossings with edges) resolve rows: column_horizon-inl.h.
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

#include "vpe/voxel/columns/column_horizon-inl.h"
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
      : reader_(lines, family, intervals, load_lanes<D>(paths.position0, lane0),
                load_lanes<D>(paths.position1, lane0)),
        horizon_(paths, kind, lane0, camera, rows, group),
        from_(load_lanes<D>(paths.from, lane0)),
        to_(load_lanes<D>(paths.to, lane0)) {}

  // Returns true if some lane has unresolved rows.
  bool any() const { return horizon_.any(); }

  // Starts the lanes whose path begins at the camera's foot inside this grid, at line `foot` with height
  // `height`.
  void start_at_foot(T foot, T height) {
    const D d;
    const V at = hn::Set(d, foot);
    const V near = hn::Set(d, sizeof(T) == 8 ? T(1e-9) : T(1e-4));
    const M begins = hn::Or(hn::Lt(hn::Abs(hn::Sub(from_, at)), near), hn::Lt(hn::Abs(hn::Sub(to_, at)), near));
    horizon_.start(hn::And(horizon_.active(), begins), at, hn::Set(d, height));
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
  void store() { horizon_.store(); }

 private:
  // Walks a block whose extents are known: lanes that enter or leave it make its ends slower, not its middle.
  template <bool kUp>
  void walk_block(int first, int last) {
    if (all_inside(std::min(first, last), std::max(first, last))) return step_as<kUp, true>(first, last);
    const D d;
    const V far = hn::Set(d, T(1e30));
    // A lane has started two lines after it enters.
    const T low = hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElse(horizon_.alive(), from_, hn::Neg(far))));
    const T high = hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(horizon_.alive(), to_, far)));
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

  struct Extent {
    T low;
    T high;
  };
  Extent extent(V position) const {
    const D d;
    const V far = hn::Set(d, T(1e30));
    return {hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(horizon_.alive(), position, far))),
            hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElse(horizon_.alive(), position, hn::Neg(far))))};
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
    const V a = horizon_.rest_at(hn::Set(d, static_cast<T>(low)));
    const V b = horizon_.rest_at(hn::Set(d, static_cast<T>(high)));
    const V top = hn::Add(hn::Max(a, b), hn::Set(d, highest));
    return hn::AllFalse(d, hn::And(horizon_.alive(), hn::Ge(top, hn::Zero(d))));
  }

  // Returns true if all lanes that are alive have started and are inside the grid, in front of the camera, at
  // both lines.
  bool all_inside(int low, int high) const {
    const D d;
    if (at_low_.low < reader_.first_position(low) || at_low_.high >= reader_.last_position(low)) return false;
    if (at_high_.low < reader_.first_position(high) || at_high_.high >= reader_.last_position(high))
      return false;
    const M ready =
        hn::And(horizon_.progress().started, hn::And(horizon_.in_front(hn::Set(d, static_cast<T>(low))),
                                                     horizon_.in_front(hn::Set(d, static_cast<T>(high)))));
    return hn::AllFalse(d, hn::AndNot(ready, horizon_.alive()));
  }

  // Starts the lanes that are on line k, after hidden blocks or at the border of the grid.
  void enter(int k) {
    const D d;
    const typename PathReader<D>::Line line = reader_.gather(k);
    const V x = hn::Set(d, static_cast<T>(k));
    const M here = hn::And(horizon_.active(), hn::And(reader_.on_line(x, line), horizon_.in_front(x)));
    horizon_.begin_path(here, x, reader_.height_on(line));
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

  // Walks a block in which lanes may enter or leave the grid. Both events of a line are told together, so that rows are resolved
  // in one place.
  template <bool kUp, Reach kReach>
  void step_masked(int first, int last) {
    const D d;
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, T(1));
    const int base = PathReader<D>::window_base(window_from_);
    const auto read = [&](V x, int k) { return reader_.template read<kReach>(x, base, reader_.posts(k)); };
    constexpr int kStep = kUp ? 1 : -1;
    const M active = horizon_.active();
    Progress<D> done = horizon_.progress();
    V last_line = reader_.line_number(first);
    typename PathReader<D>::Line line = read(last_line, first);
    for (int k = first + kStep; k != last + kStep; k += kStep) {
      const V x = hn::Add(last_line, hn::Set(d, T(kStep)));
      const typename PathReader<D>::Line next = read(x, k);
      const V low_line = kUp ? last_line : x;
      const V high_line = kUp ? x : last_line;
      const auto& lower = kUp ? line : next;
      const auto& upper = kUp ? next : line;
      const auto c = reader_.between(low_line, lower, upper);
      // Both ends of the edge must be posts of this grid.
      const V high_post = hn::Add(lower.whole, one);
      const V low_post = hn::IfThenElse(c.other, high_post, lower.whole);
      const M edge = hn::And(reader_.has_post(low_line, low_post), reader_.has_post(high_line, high_post));
      // A path that begins at the camera's foot has no events before it.
      const M here =
          hn::And(hn::And(edge, active), hn::And(horizon_.in_front(c.x), done.template outward<kUp>(c.x)));
      const V height = reader_.height_on(next);
      const Progress<D> at_edge = done.with(here, c.x, c.height);
      const M there = hn::And(hn::And(active, reader_.on_line(x, next)),
                              hn::And(horizon_.in_front(x), at_edge.template outward<kUp>(x)));
      const V rest_c = hn::Add(c.height, horizon_.rest_at(c.x));
      const V rest = hn::Add(height, horizon_.rest_at(x));
      const M at_c = hn::And(here, hn::Ge(rest_c, zero));
      M lanes = hn::And(horizon_.alive(), hn::Or(at_c, hn::And(there, hn::Ge(rest, zero))));
      if (!hn::AllFalse(d, lanes)) {
        const FacetEvent<D> at_line = at_edge.event(x, height);
        M first_lanes = hn::And(lanes, at_c);
        FacetEvent<D> event = merge<D>(first_lanes, done.event(c.x, c.height), at_line);
        for (;;) {
          horizon_.resolve(lanes, event);
          lanes = hn::And(hn::And(first_lanes, there),
                          hn::And(horizon_.alive(), hn::Ge(hn::Add(height, horizon_.rest_at(x)), zero)));
          if (hn::AllFalse(d, lanes)) break;
          first_lanes = hn::MaskFromVec(zero);
          event = at_line;
        }
      }
      done = at_edge.with(there, x, height);
      last_line = x;
      line = next;
    }
    horizon_.set_progress(done);
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
    // Copies, which stay in registers.
    V base_s0 = horizon_.base_s0();
    V base_s1 = horizon_.base_s1();
    M alive = horizon_.alive();
    V last_h = horizon_.progress().height;
    V last_event_x = horizon_.progress().x;
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
        FacetEvent<D> event =
            merge<D>(first_lanes, {c.x, c.height, last_event_x, last_h}, {x, height, c.x, c.height});
        for (;;) {
          horizon_.resolve(lanes, event);
          base_s0 = horizon_.base_s0();
          base_s1 = horizon_.base_s1();
          alive = horizon_.alive();
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
    horizon_.set_progress({horizon_.progress().started, last_event_x, last_h});
  }

  PathReader<D> reader_;
  Horizon<D, kKind> horizon_;
  V from_, to_;  // lines between which a lane is inside the grid
  Extent at_low_{};
  Extent at_high_{};
  T window_from_ = 0;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
