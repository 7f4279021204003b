// Intersects the rays of round images with the facets of one height grid after the other.
//
// Part of round_refine_kernel.cpp. The method is that of refine_facets-inl.h; rays are given one by one.
#if defined(VPE_VOXEL_ROUND_FACETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_ROUND_FACETS_INL_H_
#undef VPE_VOXEL_ROUND_FACETS_INL_H_
#else
#define VPE_VOXEL_ROUND_FACETS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "vpe/voxel/columns/round_refine.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kRoundFacets = 8;  // that are tried in one grid
constexpr int kRoundGrids = 12;

// Refines as many pixels as D has lanes. D is a vector of float or, for grids below the camera, of double.
template <class D>
class RoundRefiner {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;
  static constexpr bool kExact = sizeof(T) == 8;
  static constexpr std::size_t kRoom = 64 / sizeof(T);

  RoundRefiner(const RoundRow& row, FacetSource& source) : row_(row), source_(source) {
    const V zero = hn::Zero(D());
    camera_ = ray_ = {zero, zero, zero, zero};
    last_ = zero;
    last_facet_ = grid_number_ = hn::Zero(DI());
    other_kind_ = hn::MaskFromVec(zero);
  }

  // Selects rays k, k + 1, ...; lanes beyond the row take its last one.
  void set_rays(int k) {
    first_ = k;
    is_set_ = false;
  }

  // Replaces the estimates t of the lanes in `todo` by their ranges, where these are within [low, high]. Returns the lanes that
  // were found. Lanes over grids of the other precision are left alone and returned by other_kind().
  M refine(M todo, V low, V high, V& t) {
    const D d;
    M found = hn::MaskFromVec(hn::Zero(d));
    other_kind_ = found;
    last_facet_ = hn::Set(DI(), -1);
    for (int grids = 0; grids < kRoundGrids && !hn::AllFalse(d, todo); ++grids) {
      if (facets_ == nullptr) select_grid(todo, t);
      if (!is_set_) set_directions();
      Place place = place_at(t);
      M here = hn::And(todo, inside(place));
      if (hn::AllFalse(d, here)) {
        select_grid(todo, t);
        set_directions();
        place = place_at(t);
        here = hn::And(todo, inside(place));
      }
      if ((facets_->exact_lines != nullptr) != kExact) {
        other_kind_ = hn::Or(other_kind_, here);
        todo = hn::AndNot(here, todo);
        continue;
      }
      for (int facet = 0; facet < kRoundFacets && !hn::AllFalse(d, here); ++facet) {
        meet_facet(here, place, todo, found, low, high, t);
        place = place_at(t);
        here = hn::And(todo, inside(place));
      }
    }
    return found;
  }

  M other_kind() const { return other_kind_; }

 private:
  struct Place {
    V x, y, z;
  };
  // Holds a vector in the coordinates of the current grid: columns, lines, depth, and metres below the reference plane.
  struct OnGrid {
    V x, y, z, below;
  };

  static V set(double x) { return hn::Set(D(), static_cast<T>(x)); }

  int ray_of(std::size_t lane) const { return std::min(first_ + static_cast<int>(lane), row_.count - 1); }

  // Selects the height grid of the first lane in `todo`.
  void select_grid(M todo, V t) {
    const D d;
    const auto lane = static_cast<std::size_t>(hn::FindFirstTrue(d, todo));
    alignas(64) T ts[kRoom];
    hn::Store(t, d, ts);
    facets_ = &source_.at(row_.camera_m + static_cast<double>(ts[lane]) * row_.direction(ray_of(lane)));
    const Facets& f = *facets_;
    grid_count_ = (grid_count_ + 1) & 0x1fff;
    // Above the bits of 2^8 x 2^8 cells of two facets each.
    grid_number_ = hn::Set(DI(), static_cast<hn::TFromD<DI>>(grid_count_ << 18));
    last_ = set(f.frame.intervals - 1);
    const mars::FaceAxes& axes = mars::face_axes(f.face);
    const DepthPlane& plane = f.exact_lines != nullptr ? f.exact_lines->reference : f.lines->reference;
    const auto on_grid = [&](const glm::dvec3& p) {
      const double z = glm::dot(p, axes.out);
      const double x = (glm::dot(p, axes.right) - f.frame.u0 * z) / f.frame.du;
      const double y = (glm::dot(p, axes.up) - f.frame.v0 * z) / f.frame.dv;
      return glm::dvec4(x, y, z, -row_.radius_m * (plane.w0 * z + plane.wx * x + plane.wy * y));
    };
    const glm::dvec4 camera = on_grid(row_.camera_m);
    camera_ = {set(camera.x), set(camera.y), set(camera.z), set(row_.radius_m + camera.w)};
    right_ = on_grid(row_.right);
    forward_ = on_grid(row_.forward);
    up_ = on_grid(row_.up);
    is_set_ = false;
  }

  // Expresses the rays' directions in the coordinates of the current grid.
  void set_directions() {
    alignas(64) T x[kRoom];
    alignas(64) T y[kRoom];
    alignas(64) T z[kRoom];
    alignas(64) T below[kRoom];
    for (std::size_t lane = 0; lane < hn::Lanes(D()); ++lane) {
      const int k = ray_of(lane);
      const glm::dvec4 ray = row_.sine[k] * right_ + row_.cosine[k] * forward_ + up_;
      x[lane] = static_cast<T>(ray.x);
      y[lane] = static_cast<T>(ray.y);
      z[lane] = static_cast<T>(ray.z);
      below[lane] = static_cast<T>(ray.w);
    }
    const D d;
    ray_ = {hn::Load(d, x), hn::Load(d, y), hn::Load(d, z), hn::Load(d, below)};
    is_set_ = true;
  }

  Place place_at(V t) const {
    const V z = hn::MulAdd(t, ray_.z, camera_.z);
    const V per_z = hn::Div(hn::Set(D(), T(1)), z);
    return {hn::Mul(hn::MulAdd(t, ray_.x, camera_.x), per_z), hn::Mul(hn::MulAdd(t, ray_.y, camera_.y), per_z),
            z};
  }

  // Returns the lanes over the current grid. A place on a border belongs to both sides.
  M inside(const Place& p) const {
    constexpr double kSlack = kExact ? 1e-11 : 1e-4;
    const V low = set(-kSlack);
    const V high = hn::Add(last_, set(1 + kSlack));
    const M x = hn::And(hn::Ge(p.x, low), hn::Le(p.x, high));
    const M y = hn::And(hn::Ge(p.y, low), hn::Le(p.y, high));
    return hn::And(hn::Gt(p.z, hn::Zero(D())), hn::And(x, y));
  }

  // Holds a facet's posts: its cell's corner, the opposite corner, and the one between.
  struct Corners {
    V first, across, between;
  };

  // Loads one by one, as refine_facets-inl.h does. `lower`: the facet of a cell that holds its x-axis.
  template <class Lines>
  Corners corners(const Lines& lines, VI x, VI y, VI lower) const {
    const D d;
    using I = hn::TFromD<DI>;
    alignas(64) I xs[kRoom];
    alignas(64) I ys[kRoom];
    alignas(64) I lowers[kRoom];
    alignas(64) T first[kRoom];
    alignas(64) T across[kRoom];
    alignas(64) T between[kRoom];
    hn::Store(x, DI(), xs);
    hn::Store(y, DI(), ys);
    hn::Store(lower, DI(), lowers);
    const int side = facets_->frame.intervals + 1;
    if (facets_->family == LineFamily::kDiagonals) {
      for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
        const int i = static_cast<int>(xs[k]);
        const int j = static_cast<int>(ys[k]);
        const T* const on_line = lines.line(i - j) + i;
        first[k] = on_line[0];
        across[k] = on_line[1];
        between[k] = lowers[k] != 0 ? lines.line(i + 1 - j)[i + 1] : lines.line(i - j - 1)[i];
      }
    } else {
      const bool columns = facets_->family == LineFamily::kColumns;
      const int east = columns ? side : 1;
      const int north = columns ? 1 : side;
      for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
        const T* const at = lines.posts + static_cast<int>(xs[k]) * east + static_cast<int>(ys[k]) * north;
        first[k] = at[0];
        across[k] = at[side + 1];
        between[k] = at[lowers[k] != 0 ? east : north];
      }
    }
    return {hn::Load(d, first), hn::Load(d, across), hn::Load(d, between)};
  }

  Corners corners(VI x, VI y, VI lower) const {
    if constexpr (kExact) {
      return corners(*facets_->exact_lines, x, y, lower);
    } else {
      return corners(*facets_->lines, x, y, lower);
    }
  }

  // Intersects the rays with the planes of the facets at `place`. Moves lanes whose facet stays the same from `todo` to `found`,
  // and drops lanes whose intersection is not usable from `todo`.
  void meet_facet(M here, const Place& place, M& todo, M& found, V low, V high, V& t) {
    const D d;
    const DI di;
    const V zero = hn::Zero(d);
    const V i = hn::IfThenElse(here, hn::Min(hn::Max(hn::Floor(place.x), zero), last_), zero);
    const V j = hn::IfThenElse(here, hn::Min(hn::Max(hn::Floor(place.y), zero), last_), zero);
    const M lower = hn::Ge(hn::Sub(place.x, i), hn::Sub(place.y, j));
    const VI xi = hn::ConvertTo(di, i);
    const VI yj = hn::ConvertTo(di, j);
    const VI is_lower = hn::IfThenElse(hn::RebindMask(di, lower), hn::Set(di, 1), hn::Zero(di));
    const VI facet =
        hn::Add(hn::Add(hn::ShiftLeft<1>(xi), hn::ShiftLeft<9>(yj)), hn::Add(is_lower, grid_number_));
    const M same = hn::And(here, hn::RebindMask(d, hn::Eq(facet, last_facet_)));
    found = hn::Or(found, same);
    todo = hn::AndNot(same, todo);
    here = hn::AndNot(same, here);
    if (hn::AllFalse(d, here)) return;
    last_facet_ = hn::IfThenElse(hn::RebindMask(di, here), facet, last_facet_);
    const Corners c = corners(xi, yj, is_lower);
    const V first = hn::Sub(c.between, c.first);
    const V second = hn::Sub(c.across, c.between);
    const V p = hn::IfThenElse(lower, first, second);
    const V q = hn::IfThenElse(lower, second, first);
    // Metres below the facet's plane, by way of the reference plane.
    const V per_r = set(1.0 / row_.radius_m);
    const auto below = [&](const OnGrid& v) {
      const V px = hn::NegMulAdd(i, v.z, v.x);
      const V py = hn::NegMulAdd(j, v.z, v.y);
      return hn::MulAdd(per_r, hn::MulAdd(c.first, v.z, hn::MulAdd(p, px, hn::Mul(q, py))), v.below);
    };
    const V slope = below(ray_);
    const V next = hn::Neg(hn::Div(below(camera_), slope));
    const M good = hn::And(hn::Gt(slope, zero), hn::And(hn::Ge(next, low), hn::Le(next, high)));
    t = hn::IfThenElse(hn::And(here, good), next, t);
    // The facet faces away from the camera, or the place is far from the samples.
    todo = hn::AndNot(hn::AndNot(good, here), todo);
  }

  const RoundRow& row_;
  FacetSource& source_;
  const Facets* facets_ = nullptr;
  int first_ = 0;
  int grid_count_ = 0;
  bool is_set_ = false;  // ray_ holds the selected rays
  glm::dvec4 right_{}, forward_{}, up_{};
  OnGrid camera_, ray_;
  V last_;
  VI grid_number_;  // of the current grid
  VI last_facet_;   // of each lane
  M other_kind_;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
