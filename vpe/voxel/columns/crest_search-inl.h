// Searches single rays for crests that they meet before their ranges.
//
// Part of refine_kernel.cpp and round_refine_kernel.cpp.
#if defined(VPE_VOXEL_CREST_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_CREST_SEARCH_INL_H_
#undef VPE_VOXEL_CREST_SEARCH_INL_H_
#else
#define VPE_VOXEL_CREST_SEARCH_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <algorithm>

#include "vpe/voxel/columns/facet_refiner-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// In posts: the step at first, and the share of the way so far that a later step is.
constexpr int kCrestSamples = 64;
constexpr double kLeastStep = 0.5;
constexpr double kStepGrowth = 0.05;
// Shares of a range: how far before the sample of its surface a crest may begin, and how much before the ground behind it the search
// ends.
constexpr double kBeforeSample = 0.002;
constexpr double kBeforeRange = 1e-5;

// Holds the places' distances from the first one, in posts, and that of the place after the last.
template <class T>
struct CrestOffsets {
  constexpr CrestOffsets() {
    T offset = 0;
    for (T& o : posts) {
      o = offset;
      offset += std::max(static_cast<T>(kLeastStep), static_cast<T>(kStepGrowth) * offset);
    }
  }
  T posts[kCrestSamples + 1] = {};
};

// Looks at as many places of one ray at once as D has lanes.
template <class D, template <class> class Rays>
class CrestSearch {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using Grid = GridFacets<D>;
  static constexpr std::size_t kRoom = 64 / sizeof(T);

  // `refiner` has taken rays, and must outlive this.
  explicit CrestSearch(FacetRefiner<D, Rays>& refiner) : refiner_(refiner) {
    const V zero = hn::Zero(D());
    ray_ = {zero, zero, zero, zero};
  }

  // Returns where the ray of one lane first meets ground from just before near_m, the range of a sample beside it, to range_m, what
  // it meets at the latest; range_m itself where it meets none. Looks at kCrestSamples places, half a post apart at first and farther
  // apart later on, and at the facet below each, so it passes over narrower ground. Stays in the height grid where it begins, so that it
  // needs no tile that is hidden; does nothing if that is of the other precision (passed_other_kind()).
  T first_crest(std::size_t lane, T near_m, T range_m) {
    const D d;
    const T end_m = range_m * static_cast<T>(1 - kBeforeRange);
    T before_m = near_m * static_cast<T>(1 - kBeforeSample);
    const T begin_m = before_m;
    enter_grid(lane, begin_m);
    const T post_m = hn::GetLane(grid().post_along(ray_, hn::Set(d, begin_m)));
    ends_ = passed_other_kind_ = grid().is_other_kind();
    static constexpr CrestOffsets<T> kOffsets;
    const int lanes = static_cast<int>(hn::Lanes(d));
    T met_m = range_m;
    for (int n = 0; n < kCrestSamples && before_m < end_m && !ends_; n += lanes) {
      const V t = hn::MulAdd(hn::LoadU(d, kOffsets.posts + n), hn::Set(d, post_m), hn::Set(d, begin_m));
      if (look(t, begin_m + kOffsets.posts[n + lanes] * post_m, end_m, before_m, met_m)) break;
    }
    return met_m;
  }

  // Returns whether the last first_crest() did nothing.
  bool passed_other_kind() const { return passed_other_kind_; }

 private:
  const Grid& grid() const { return refiner_.grid(); }

  // Expresses the ray of a lane in the grid that it is over at a range.
  void enter_grid(std::size_t lane, T range_m) {
    const D d;
    const V t = hn::Set(d, range_m);
    if (grid().is_selected()) ray_ = refiner_.ray_of(lane);
    if (grid().is_selected() && !hn::AllFalse(d, grid().inside(grid().position_at(ray_, t)))) return;
    refiner_.select_grid(lane, range_m);
    ray_ = refiner_.ray_of(lane);
  }

  // Looks at the ground below places t, which rise; `after` follows the last one. Returns true if the search ends: sets met_m where
  // the ray meets ground before end_m. Else sets before_m to the last place.
  bool look(V t, T after_m, T end_m, T& before_m, T& met_m) {
    const D d;
    const std::size_t lanes = hn::Lanes(d);
    for (int round = 0; round < kMaxRounds; ++round) {
      alignas(64) T places[kRoom + 1];
      alignas(64) T under[kRoom];
      alignas(64) T crossings[kRoom];
      hn::Store(t, d, places);
      places[lanes] = after_m;
      V crossing = t;
      const M is_under = look_below(t, hn::LoadU(d, places + 1), crossing);
      if (hn::AllFalse(d, hn::Or(is_under, hn::Ne(crossing, t)))) {
        before_m = places[lanes - 1];
        return false;
      }
      hn::Store(hn::IfThenElse(is_under, hn::Set(d, T(1)), hn::Zero(d)), d, under);
      hn::Store(crossing, d, crossings);
      std::size_t k = 0;
      while (under[k] == 0 && crossings[k] == places[k]) ++k;
      if (under[k] == 0) {
        if (crossings[k] < end_m) met_m = crossings[k];
        return true;
      }
      // The ray comes below the ground between two places.
      if (k > 0) before_m = places[k - 1];
      after_m = places[k];
      if (!(before_m < after_m) || before_m >= end_m) return true;
      const T step = (after_m - before_m) / static_cast<T>(lanes + 1);
      t = hn::MulAdd(hn::Iota(d, T(0)), hn::Set(d, step), hn::Set(d, before_m));
    }
    met_m = std::min(after_m, met_m);
    return true;
  }

  // Returns the lanes whose place t is below the ground. Sets `crossing` for others, above the ground, whose ray meets the facet
  // below t before `next`.
  M look_below(V t, V next, V& crossing) {
    const D d;
    const typename Grid::Position position = grid().position_at(ray_, t);
    const M here = grid().inside(position);
    ends_ = !hn::AllTrue(d, here);
    const typename Grid::Facet facet = grid().facet_at(here, position);
    const typename Grid::Plane plane = grid().plane_of(facet, ray_);
    const M below = hn::Ge(hn::MulAdd(t, plane.slope, plane.at_camera), hn::Zero(d));
    const V at = hn::Neg(hn::Div(plane.at_camera, plane.slope));
    const M ahead = hn::And(hn::Gt(plane.slope, hn::Zero(d)), hn::And(hn::Gt(at, t), hn::Le(at, next)));
    const M meets = hn::And(hn::AndNot(below, here), ahead);
    if (!hn::AllFalse(d, meets)) {
      const typename Grid::Position there = grid().position_at(ray_, at);
      const M on_facet = hn::RebindMask(d, hn::Eq(grid().facet_at(meets, there).number, facet.number));
      crossing = hn::IfThenElse(hn::And(hn::And(meets, grid().inside(there)), on_facet), at, crossing);
    }
    return hn::And(here, below);
  }

  FacetRefiner<D, Rays>& refiner_;
  OnGrid<D> ray_;
  bool passed_other_kind_ = false;
  bool ends_ = false;  // at the border of the height grid
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
