// Holds the floating horizon of the columns that cross one height grid.
//
// Part of column_kernel.cpp, below column_steps-inl.h. Events (crossings with edges) resolve rows: column_runs-inl.h.
#if defined(VPE_VOXEL_COLUMN_HORIZON_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_COLUMN_HORIZON_INL_H_
#undef VPE_VOXEL_COLUMN_HORIZON_INL_H_
#else
#define VPE_VOXEL_COLUMN_HORIZON_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <cstddef>

#include "vpe/voxel/columns/column_paths-inl.h"
#include "vpe/voxel/columns/column_rows-inl.h"
#include "vpe/voxel/columns/column_runs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Returns the values of the lanes from `lane0` on.
template <class D, typename S>
hn::Vec<D> load_lanes(const S* from, int lane0) {
  using T = hn::TFromD<D>;
#if HWY_TARGET != HWY_SCALAR
  if constexpr (sizeof(T) < sizeof(S)) {
    const hn::Half<D> half;
    const hn::Rebind<S, hn::Half<D>> wide;
    const auto part = [&](std::size_t lane) {
      return hn::DemoteTo(half, hn::LoadU(wide, from + lane0 + lane));
    };
    return hn::Combine(D(), part(hn::Lanes(half)), part(0));
  }
#endif
  alignas(64) T values[kMaxLanes];
  for (std::size_t k = 0; k < hn::Lanes(D()); ++k)
    values[k] = static_cast<T>(from[lane0 + static_cast<int>(k)]);
  return hn::Load(D(), values);
}

// Holds the last event of each lane that has had one in a height grid.
template <class D>
struct Progress {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  M started;
  V x, height;

  // Returns the lanes for which line `at` does not lie before the last event. A path that begins at the camera's foot has no
  // events before it.
  template <bool kUp>
  M outward(V at) const {
    return hn::Or(kUp ? hn::Ge(at, x) : hn::Le(at, x), hn::Not(started));
  }
  // Returns this with a further event of some lanes.
  Progress with(M lanes, V at, V ground) const {
    return {hn::Or(started, lanes), hn::IfThenElse(lanes, at, x), hn::IfThenElse(lanes, ground, height)};
  }
  // Returns an event with what lies before it. Nothing of this grid lies before the first one of a lane, so rows are resolved at the
  // event itself.
  FacetEvent<D> event(V at, V ground) const {
    return {at, ground, hn::IfThenElse(started, x, at),
            hn::IfThenElse(started, height, hn::Sub(ground, hn::Set(D(), T(1))))};
  }
};

// Holds how far the lanes that cross a height grid by the same family of lines in the same direction are resolved, and what they
// met last. A lane starts with its first event in the grid, and is alive while it has unresolved rows.
template <class D, RowKind kKind>
class Horizon {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

  Horizon(const Paths& paths, int kind, int lane0, const ColumnCamera& camera, const Rows& rows,
          ColumnGroup& group)
      : lane0_(lane0),
        group_(group),
        model_(rows, group, lane0),
        terms_{load_lanes<D>(paths.sigma0, lane0),
               load_lanes<D>(paths.sigma1, lane0),
               load_lanes<D>(paths.base0, lane0),
               load_lanes<D>(paths.base1, lane0),
               load_lanes<D>(paths.depth0, lane0),
               load_lanes<D>(paths.depth1, lane0),
               hn::Set(D(), static_cast<T>(1.0 / camera.distance_m))},
        runs_(terms_, model_, rows, group, lane0) {
    const D d;
    row_ = load_lanes<D>(group.row, lane0);
    end_ = load_lanes<D>(group.row_end, lane0);
    active_ = hn::Eq(load_lanes<D>(paths.kind, lane0), hn::Set(d, static_cast<T>(kind)));
    progress_ = {hn::MaskFromVec(hn::Zero(d)), hn::Zero(d), hn::Zero(d)};
    update_slope();
  }
  // The writer of runs refers to this.
  Horizon(const Horizon&) = delete;
  Horizon& operator=(const Horizon&) = delete;

  // Returns true if some lane has unresolved rows.
  bool any() const { return !hn::AllFalse(D(), alive_); }
  M active() const { return active_; }  // the lanes of the family and direction
  M alive() const { return alive_; }
  const Progress<D>& progress() const { return progress_; }
  void set_progress(const Progress<D>& progress) { progress_ = progress; }

  // Return what rest_at() is made of. Both change with each row that is resolved.
  V base_s0() const { return base_s0_; }
  V base_s1() const { return base_s1_; }
  // Returns by how much the path at line x lies above the ray of a lane's next row; ground there adds its height.
  V rest_at(V x) const { return hn::MulAdd(base_s1_, x, base_s0_); }

  M in_front(V x) const { return hn::Gt(hn::MulAdd(terms_.sigma1, x, terms_.sigma0), hn::Zero(D())); }

  // Starts lanes at line x, on ground of this height.
  void start(M lanes, V x, V height) { progress_ = {lanes, x, height}; }

  // Begins the paths of lanes at line x: nothing of this grid lies before it that they could show.
  void begin_path(M lanes, V x, V height) {
    const D d;
    const V rest = hn::Add(height, rest_at(x));
    const M reached = hn::And(hn::And(lanes, alive_), hn::Ge(rest, hn::Zero(d)));
    const V below = hn::Sub(height, hn::Set(d, T(1)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, reached))) resolve(reached, {x, height, x, below});
    progress_ = progress_.with(lanes, x, height);
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
  // Subtracts the line z = slope sigma of the next row from the paths' heights, and updates which lanes are
  // alive.
  void update_slope() {
    slope_ = model_.slope(row_);
    base_s0_ = hn::NegMulAdd(slope_, terms_.sigma0, terms_.base0);
    base_s1_ = hn::NegMulAdd(slope_, terms_.sigma1, terms_.base1);
    alive_ = hn::And(active_, hn::Lt(row_, end_));
  }

  int lane0_;
  ColumnGroup& group_;
  RowModel<D, kKind> model_;
  PathTerms<D> terms_;
  RunWriter<D, kKind> runs_;
  V row_, end_, slope_, base_s0_, base_s1_;
  M active_, alive_;
  Progress<D> progress_;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
