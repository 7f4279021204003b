// Finds the facets of one height grid, and how far rays are below their planes.
//
// Part of refine_kernel.cpp and round_refine_kernel.cpp, below facet_refiner-inl.h.
#if defined(VPE_VOXEL_GRID_FACETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_GRID_FACETS_INL_H_
#undef VPE_VOXEL_GRID_FACETS_INL_H_
#else
#define VPE_VOXEL_GRID_FACETS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "vpe/voxel/columns/lane_pairs-inl.h"
#include "vpe/voxel/columns/refine.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Holds a vector of each lane in the terms of a height grid: its position times its depth, its depth, and the metres by which it
// leads below the reference plane.
template <class D>
struct OnGrid {
  hn::Vec<D> x, y, z, below;
};

// Holds the height grid that is selected. Lanes are rays from one camera. D is a vector of float or, for grids below the camera, of
// double.
template <class D>
class GridFacets {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;
  static constexpr bool kExact = sizeof(T) == 8;

  GridFacets(const glm::dvec3& camera_m, double radius_m, FacetSource& source)
      : camera_m_(camera_m), radius_m_(radius_m), source_(source), per_radius_(set(1.0 / radius_m)) {
    const V zero = hn::Zero(D());
    camera_ = {zero, zero, zero, zero};
    last_ = side_ = zero;
    number_ = hn::Zero(DI());
  }

  // Selects the height grid over or under a place.
  void select(const glm::dvec3& place_m) {
    facets_ = &source_.at(place_m);
    const Facets& f = *facets_;
    axes_ = &mars::face_axes(f.face);
    plane_ = f.exact_lines != nullptr ? f.exact_lines->reference : f.lines->reference;
    count_ = (count_ + 1) & 0x1fff;
    // Above the bits of 2^8 x 2^8 cells of two facets each.
    number_ = hn::Set(DI(), static_cast<hn::TFromD<DI>>(count_ << 18));
    last_ = set(f.frame.intervals - 1);
    side_ = set(f.frame.intervals + 1);
    const glm::dvec4 camera = on_grid(camera_m_);
    camera_ = {set(camera.x), set(camera.y), set(camera.z), set(radius_m_ + camera.w)};
  }

  // Selects none.
  void leave() { facets_ = nullptr; }
  bool is_selected() const { return facets_ != nullptr; }
  // Returns true if the selected grid has posts of the other precision, so that only on_grid() and positions serve.
  bool is_other_kind() const { return (facets_->exact_lines != nullptr) != kExact; }

  // Returns a vector in the terms of the selected grid: x, y, z, below.
  glm::dvec4 on_grid(const glm::dvec3& v) const {
    const HeightGridFrame& f = facets_->frame;
    const double z = glm::dot(v, axes_->out);
    const double x = (glm::dot(v, axes_->right) - f.u0 * z) / f.du;
    const double y = (glm::dot(v, axes_->up) - f.v0 * z) / f.dv;
    return {x, y, z, -radius_m_ * (plane_.w0 * z + plane_.wx * x + plane_.wy * y)};
  }

  struct Position {
    V x, y, z;
  };
  Position position_at(const OnGrid<D>& ray, V t) const {
    const V z = hn::MulAdd(t, ray.z, camera_.z);
    const V per_z = hn::Div(hn::Set(D(), T(1)), z);
    return {hn::Mul(hn::MulAdd(t, ray.x, camera_.x), per_z), hn::Mul(hn::MulAdd(t, ray.y, camera_.y), per_z),
            z};
  }

  // Returns the lanes over the selected grid. A position on a border belongs to both sides.
  M inside(const Position& p) const {
    constexpr double kSlack = kExact ? 1e-11 : 1e-4;
    const V low = set(-kSlack);
    const V high = hn::Add(last_, set(1 + kSlack));
    const M x = hn::And(hn::Ge(p.x, low), hn::Le(p.x, high));
    const M y = hn::And(hn::Ge(p.y, low), hn::Le(p.y, high));
    return hn::And(hn::Gt(p.z, hn::Zero(D())), hn::And(x, y));
  }

  // Numbers grids of the size of the selected one, which is in the middle of side x side, row by row. Positions beyond belong to the
  // outermost grids.
  VI number_of(const Position& p, int side) const {
    const D d;
    const DI di;
    const V per_grid = hn::Div(hn::Set(d, T(1)), hn::Add(last_, hn::Set(d, T(1))));
    const V half = hn::Set(d, static_cast<T>(side / 2));
    const V most = hn::Set(d, static_cast<T>(side - 1));
    const auto whole = [&](V x) {
      return hn::Min(hn::Max(hn::Floor(hn::MulAdd(x, per_grid, half)), hn::Zero(d)), most);
    };
    return hn::ConvertTo(di, hn::MulAdd(whole(p.y), hn::Set(d, static_cast<T>(side)), whole(p.x)));
  }

  // Returns how long a post is along a ray at a range, in each lane: between two lines of the family that it crosses more often.
  V post_along(const OnGrid<D>& ray, V t) const {
    const Position p = position_at(ray, t);
    const V x = hn::Abs(hn::NegMulAdd(p.x, ray.z, ray.x));
    const V y = hn::Abs(hn::NegMulAdd(p.y, ray.z, ray.y));
    return hn::Div(p.z, hn::Max(x, y));
  }

  // Holds facets: a cell's corner, which of its two facets it is, and a number that differs between facets.
  struct Facet {
    V i, j;
    M lower;
    VI number;
  };
  // Returns the facets at positions, any for lanes that are not `here`.
  Facet facet_at(M here, const Position& p) const {
    const D d;
    const DI di;
    const V zero = hn::Zero(d);
    Facet f;
    f.i = hn::IfThenElseZero(here, hn::Min(hn::Max(hn::Floor(p.x), zero), last_));
    f.j = hn::IfThenElseZero(here, hn::Min(hn::Max(hn::Floor(p.y), zero), last_));
    f.lower = hn::Ge(hn::Sub(p.x, f.i), hn::Sub(p.y, f.j));
    const VI x = hn::ConvertTo(di, f.i);
    const VI y = hn::ConvertTo(di, f.j);
    const VI is_lower = hn::IfThenElseZero(hn::RebindMask(di, f.lower), hn::Set(di, 1));
    f.number = hn::Add(hn::Add(hn::ShiftLeft<1>(x), hn::ShiftLeft<9>(y)), hn::Add(is_lower, number_));
    return f;
  }

  // Holds facets of lanes for plane_of(), without their numbers.
  struct Cell {
    V i, j;
    M lower;
  };
  // Returns the facets at positions, and in `here` the lanes over the selected grid without what lies on its far borders.
  Cell cell_at(const Position& p, M& here) const {
    const D d;
    const V zero = hn::Zero(d);
    const V x = hn::Floor(p.x);
    const V y = hn::Floor(p.y);
    Cell c;
    // Also where x is not a number.
    c.i = hn::Min(hn::Max(x, zero), last_);
    c.j = hn::Min(hn::Max(y, zero), last_);
    here = hn::And(hn::And(hn::Eq(x, c.i), hn::Eq(y, c.j)), hn::Gt(p.z, zero));
    c.lower = hn::Ge(hn::Sub(p.x, c.i), hn::Sub(p.y, c.j));
    return c;
  }
  // Returns the lanes whose position is on the facet.
  M is_on(const Cell& c, const Position& p) const {
    const D d;
    const V x = hn::Sub(p.x, c.i);
    const V y = hn::Sub(p.y, c.j);
    const M in_cell = hn::And(hn::Ge(hn::Min(x, y), hn::Zero(d)), hn::Lt(hn::Max(x, y), hn::Set(d, T(1))));
    return hn::AndNot(hn::Xor(hn::Ge(x, y), c.lower), in_cell);
  }

  // Holds how far below a facet's plane a ray is: at the camera, and how much more for each metre along the ray.
  struct Plane {
    V at_camera, slope;
  };
  template <class Place>  // Facet or Cell
  HWY_INLINE Plane plane_of(const Place& f, const OnGrid<D>& ray) const {
    const Corners c = corners(f.i, f.j, f.lower);
    const V first = hn::Sub(c.between, c.first);
    const V second = hn::Sub(c.across, c.between);
    const V p = hn::IfThenElse(f.lower, first, second);
    const V q = hn::IfThenElse(f.lower, second, first);
    // By way of the reference plane.
    const auto below = [&](const OnGrid<D>& v) {
      const V px = hn::NegMulAdd(f.i, v.z, v.x);
      const V py = hn::NegMulAdd(f.j, v.z, v.y);
      return hn::MulAdd(per_radius_, hn::MulAdd(c.first, v.z, hn::MulAdd(p, px, hn::Mul(q, py))), v.below);
    };
    return {below(camera_), below(ray)};
  }

 private:
  static V set(double x) { return hn::Set(D(), static_cast<T>(x)); }

  const T* posts() const {
    if constexpr (kExact) {
      return facets_->exact_lines->posts;
    } else {
      return facets_->lines->posts;
    }
  }

  // Holds a facet's posts: its cell's corner, the opposite corner, and the one between.
  struct Corners {
    V first, across, between;
  };
  HWY_INLINE Corners corners(V i, V j, M lower) const {
    const D d;
    const DI di;
    const T* const from = posts();
    if (facets_->family == LineFamily::kDiagonals) {
      const V one = hn::Set(d, T(1));
      const V step = hn::IfThenElseZero(lower, one);
      const LanePairs<D> on_line = load_pairs(d, from, on_diagonal(i, j));
      const V x = hn::Add(i, step);
      const V y = hn::Sub(hn::Add(j, one), step);
      return {on_line.first, on_line.second, load_pairs(d, from, on_diagonal(x, y)).first};
    }
    const bool columns = facets_->family == LineFamily::kColumns;
    const VI index = hn::ConvertTo(di, columns ? hn::MulAdd(i, side_, j) : hn::MulAdd(j, side_, i));
    const LanePairs<D> line = load_pairs(d, from, index);
    const LanePairs<D> next = load_pairs(d, from + facets_->frame.intervals + 1, index);
    return {line.first, next.second,
            columns ? hn::IfThenElse(lower, next.first, line.second)
                    : hn::IfThenElse(lower, line.second, next.first)};
  }
  // Returns the index of post (x, y) of each lane among diagonals. Whole numbers below 2^24 are exact in float.
  VI on_diagonal(V x, V y) const {
    const D d;
    V line = hn::Sub(x, y);
    line = hn::IfThenElse(hn::Lt(line, hn::Zero(d)), hn::Add(line, side_), line);
    return hn::ConvertTo(DI(), hn::MulAdd(line, side_, x));
  }

  glm::dvec3 camera_m_;
  double radius_m_;
  FacetSource& source_;
  const Facets* facets_ = nullptr;
  const mars::FaceAxes* axes_ = nullptr;
  DepthPlane plane_;
  int count_ = 0;
  V per_radius_;
  OnGrid<D> camera_;  // `below`: of the camera itself
  V last_;
  V side_;     // posts
  VI number_;  // of the selected grid
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
