// Intersects rays with the facets of one height grid after the other.
//
// Part of refine_kernel.cpp and round_refine_kernel.cpp.
#if defined(VPE_VOXEL_FACET_REFINER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_FACET_REFINER_INL_H_
#undef VPE_VOXEL_FACET_REFINER_INL_H_
#else
#define VPE_VOXEL_FACET_REFINER_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "vpe/voxel/columns/grid_facets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kMaxRounds = 8;  // facets that are tried in one grid
constexpr int kMaxGrids = 12;

// Refines as many pixels as D has lanes. D is a vector of float or, for grids below the camera, of double. Rays<D> (BlockRays,
// RoundRays) gives their directions.
template <class D, template <class> class Rays>
class FacetRefiner {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using Grid = GridFacets<D>;
  static constexpr std::size_t kRoom = 64 / sizeof(T);

  FacetRefiner(const typename Rays<D>::Source& row, FacetSource& source)
      : rays_(row), camera_m_(row.camera_m), grid_(row.camera_m, row.radius_m, source) {
    const V zero = hn::Zero(D());
    ray_ = {zero, zero, zero, zero};
    last_facet_ = hn::Zero(DI());
    other_kind_ = hn::MaskFromVec(zero);
  }

  // Takes the rays of pixels, one for each lane; `pixels` must outlive their use.
  void take(const int* pixels) {
    pixels_ = pixels;
    rays_.take(pixels);
    express();
  }
  // Takes the rays of pixels k, k + 1, ...
  void take_from(int k) {
    pixels_ = nullptr;
    first_pixel_ = k;
    rays_.take_from(k);
    express();
  }

  // Replaces the estimates t of the lanes in `todo` by their ranges, where these are within [low, high]. Returns the lanes that were
  // found. Lanes over grids of the other precision are left alone and returned by other_kind().
  M refine(M todo, V low, V high, V& t) {
    const D d;
    M found = hn::MaskFromVec(hn::Zero(d));
    other_kind_ = found;
    last_facet_ = hn::Set(DI(), -1);
    for (int grids = 0; grids < kMaxGrids && !hn::AllFalse(d, todo); ++grids) {
      if (!grid_.is_selected()) select_grid(todo, t);
      typename Grid::Position position = grid_.position_at(ray_, t);
      M here = hn::And(todo, grid_.inside(position));
      if (hn::AllFalse(d, here)) {
        select_grid(todo, t);
        position = grid_.position_at(ray_, t);
        here = hn::And(todo, grid_.inside(position));
      }
      if (grid_.is_other_kind()) {
        other_kind_ = hn::Or(other_kind_, here);
        todo = hn::AndNot(here, todo);
        continue;
      }
      for (int round = 0; round < kMaxRounds && !hn::AllFalse(d, here); ++round) {
        meet_facets(here, position, todo, found, low, high, t);
        position = grid_.position_at(ray_, t);
        here = hn::And(todo, grid_.inside(position));
      }
    }
    return found;
  }

  M other_kind() const { return other_kind_; }

  // Meets one facet for each lane in `todo`: does what the first round of refine() does and tests whether the second one would find
  // the lane, all without branches. Returns the lanes that were found; lanes beside borders of grids may be left out. Those in `dropped`
  // refine() would give up; it serves for the others. Those in `other_kind` are over a grid of the other kind; others may be, too.
  HWY_INLINE M meet_once(M todo, V low, V high, V& t, M& dropped, M& other_kind) {
    const D d;
    if (HWY_UNLIKELY(!grid_.is_selected())) select_grid(todo, t);
    M here;
    typename Grid::Position position = grid_.position_at(ray_, t);
    typename Grid::Cell cell = grid_.cell_at(position, here);
    here = hn::And(todo, here);
    if (HWY_UNLIKELY(hn::AllFalse(d, here))) {
      select_grid(todo, t);
      position = grid_.position_at(ray_, t);
      cell = grid_.cell_at(position, here);
      here = hn::And(todo, here);
    }
    dropped = other_kind = hn::MaskFromVec(hn::Zero(d));
    if (HWY_UNLIKELY(grid_.is_other_kind())) {
      other_kind = here;
      return dropped;
    }
    const Meeting meeting = meet(cell, low, high);
    const M moved = hn::And(here, meeting.is_good);
    dropped = hn::AndNot(meeting.is_good, here);
    t = hn::IfThenElse(moved, meeting.t, t);
    return hn::And(moved, grid_.is_on(cell, grid_.position_at(ray_, t)));
  }

  // Meets one facet for each lane in `todo` as meet_once() does, in as many grids as they lie over.
  M meet_each(M todo, V low, V high, V& t, M& dropped, M& other_kind) {
    const D d;
    M found = hn::MaskFromVec(hn::Zero(d));
    dropped = other_kind = found;
    for (int grids = 0; grids < kMaxGrids && !hn::AllFalse(d, todo); ++grids) {
      if (!grid_.is_selected()) select_grid(todo, t);
      M here;
      typename Grid::Position position = grid_.position_at(ray_, t);
      typename Grid::Cell cell = grid_.cell_at(position, here);
      here = hn::And(todo, here);
      if (hn::AllFalse(d, here)) {
        select_grid(todo, t);
        position = grid_.position_at(ray_, t);
        cell = grid_.cell_at(position, here);
        here = hn::And(todo, here);
        // On the border of two grids.
        if (hn::AllFalse(d, here)) break;
      }
      todo = hn::AndNot(here, todo);
      if (grid_.is_other_kind()) {
        other_kind = hn::Or(other_kind, here);
        continue;
      }
      const Meeting meeting = meet(cell, low, high);
      const M moved = hn::And(here, meeting.is_good);
      dropped = hn::Or(dropped, hn::AndNot(meeting.is_good, here));
      t = hn::IfThenElse(moved, meeting.t, t);
      found = hn::Or(found, hn::And(moved, grid_.is_on(cell, grid_.position_at(ray_, t))));
    }
    return found;
  }

  const Grid& grid() const { return grid_; }
  // Forgets the grid that is selected.
  void leave_grid() { grid_.leave(); }
  // Selects the height grid that the ray of a lane is over at a range.
  void select_grid(std::size_t lane, T range_m) {
    grid_.select(camera_m_ + static_cast<double>(range_m) * rays_.direction(pixel_of(lane)));
    rays_.enter(grid_);
    ray_ = rays_.on_grid();
  }
  hn::Vec<DI> grids_at(V t, int side) const { return grid_.number_of(grid_.position_at(ray_, t), side); }
  // Returns the ray of one lane in all lanes, in the terms of the grid that is selected.
  OnGrid<D> ray_of(std::size_t lane) const {
    const D d;
    const auto only = [&](V v) {
      alignas(64) T lanes[kRoom];
      hn::Store(v, d, lanes);
      return hn::Set(d, lanes[lane]);
    };
    return {only(ray_.x), only(ray_.y), only(ray_.z), only(ray_.below)};
  }

 private:
  void express() {
    if (grid_.is_selected()) ray_ = rays_.on_grid();
  }

  int pixel_of(std::size_t lane) const {
    return pixels_ != nullptr ? pixels_[lane] : first_pixel_ + static_cast<int>(lane);
  }

  // Selects the height grid of the first lane in `todo`.
  void select_grid(M todo, V t) {
    const D d;
    const auto lane = static_cast<std::size_t>(hn::FindFirstTrue(d, todo));
    alignas(64) T ts[kRoom];
    hn::Store(t, d, ts);
    select_grid(lane, ts[lane]);
  }

  // Holds where rays meet facets' planes. Not good: the facet faces away from the camera, or the place is far from the samples.
  struct Meeting {
    V t;
    M is_good;
  };
  template <class Place>  // Grid::Facet or Grid::Cell
  HWY_INLINE Meeting meet(const Place& facet, V low, V high) const {
    const D d;
    const typename Grid::Plane plane = grid_.plane_of(facet, ray_);
    const V next = hn::Neg(hn::Div(plane.at_camera, plane.slope));
    return {next, hn::And(hn::Gt(plane.slope, hn::Zero(d)), hn::And(hn::Ge(next, low), hn::Le(next, high)))};
  }

  // Intersects the rays with the planes of the facets at positions. Moves lanes whose facet stays the same from `todo` to `found`,
  // and drops lanes whose intersection is not good from `todo`.
  void meet_facets(M here, const typename Grid::Position& position, M& todo, M& found, V low, V high, V& t) {
    const D d;
    const DI di;
    const typename Grid::Facet facet = grid_.facet_at(here, position);
    const M same = hn::And(here, hn::RebindMask(d, hn::Eq(facet.number, last_facet_)));
    found = hn::Or(found, same);
    todo = hn::AndNot(same, todo);
    here = hn::AndNot(same, here);
    if (hn::AllFalse(d, here)) return;
    last_facet_ = hn::IfThenElse(hn::RebindMask(di, here), facet.number, last_facet_);
    const Meeting meeting = meet(facet, low, high);
    t = hn::IfThenElse(hn::And(here, meeting.is_good), meeting.t, t);
    todo = hn::AndNot(hn::AndNot(meeting.is_good, here), todo);
  }

  Rays<D> rays_;
  glm::dvec3 camera_m_;
  Grid grid_;
  const int* pixels_ = nullptr;  // of the lanes; null: neighbours
  int first_pixel_ = 0;
  OnGrid<D> ray_;
  hn::Vec<DI> last_facet_;  // of each lane
  M other_kind_;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
