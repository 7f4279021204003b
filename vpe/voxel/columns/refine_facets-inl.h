// Intersects neighbouring rays with the facets of one height grid after the other.
//
// Part of refine_kernel.cpp, called by refine_row() (refine.h).
#if defined(VPE_VOXEL_REFINE_FACETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_REFINE_FACETS_INL_H_
#undef VPE_VOXEL_REFINE_FACETS_INL_H_
#else
#define VPE_VOXEL_REFINE_FACETS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "vpe/voxel/columns/refine.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kMaxRounds = 8;  // facets that are tried in one grid
constexpr int kMaxGrids = 12;

// Refines as many neighbouring pixels as D has lanes. D is a vector of float or, for grids below the camera, of
// double.
template <class D>
class RowRefiner {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;
  static constexpr bool kExact = sizeof(T) == 8;

  RowRefiner(const RayRow& row, FacetSource& source) : row_(row), source_(source) {
    const V zero = hn::Zero(D());
    camera_x_ = camera_y_ = camera_z_ = dx_ = dy_ = dz_ = camera_rise_ = ray_rise_ = last_ = zero;
    grid_number_ = last_facet_ = hn::Zero(DI());
    other_kind_ = hn::MaskFromVec(zero);
  }

  // Selects rays k, k + 1, ...
  void set_rays(int k) {
    const D d;
    first_ = k;
    // Relative to the first ray, not to the row's: in wide fields of view that is many times as long.
    const V index = hn::Iota(d, T(0));
    const glm::dvec3 a = row_.first + static_cast<double>(k) * row_.step;
    const glm::dvec3& b = row_.step;
    // |a + index b|^2
    const V square =
        hn::MulAdd(index, hn::MulAdd(index, set(glm::dot(b, b)), set(2 * glm::dot(a, b))), set(glm::dot(a, a)));
    per_length_ = hn::Div(hn::Set(d, T(1)), hn::Sqrt(square));
    if (facets_ != nullptr) set_directions();
  }

  // Replaces the estimates t of the lanes in `todo` by their ranges, where these are within [low, high].
  // Returns the lanes that were found. Lanes over grids of the other precision are left alone and returned by
  // other_kind().
  M refine(M todo, V low, V high, V& t) {
    const D d;
    M found = hn::MaskFromVec(hn::Zero(d));
    other_kind_ = found;
    last_facet_ = hn::Set(DI(), -1);
    for (int grids = 0; grids < kMaxGrids && !hn::AllFalse(d, todo); ++grids) {
      GridPosition position = position_at(t);
      M here = hn::And(todo, inside(position));
      if (facets_ == nullptr || hn::AllFalse(d, here)) {
        select_grid(todo, t);
        position = position_at(t);
        here = hn::And(todo, inside(position));
      }
      if ((facets_->exact_lines != nullptr) != kExact) {
        other_kind_ = hn::Or(other_kind_, here);
        todo = hn::AndNot(here, todo);
        continue;
      }
      for (int round = 0; round < kMaxRounds && !hn::AllFalse(d, here); ++round) {
        step(here, position, todo, found, low, high, t);
        position = position_at(t);
        here = hn::And(todo, inside(position));
      }
    }
    return found;
  }

  M other_kind() const { return other_kind_; }

 private:
  struct GridPosition {
    V x, y, z;
  };

  static V set(double x) { return hn::Set(D(), static_cast<T>(x)); }

  // Selects the height grid of the first lane in `todo`.
  void select_grid(M todo, V t) {
    const D d;
    const auto lane = static_cast<std::size_t>(hn::FindFirstTrue(d, todo));
    alignas(64) T ts[64 / sizeof(T)];
    hn::Store(t, d, ts);
    const glm::dvec3 ray =
        glm::normalize(row_.first + static_cast<double>(first_ + static_cast<int>(lane)) * row_.step);
    facets_ = &source_.at(row_.camera_m + static_cast<double>(ts[lane]) * ray);
    const Facets& f = *facets_;
    grid_count_ = (grid_count_ + 1) & 0x1fff;
    // Above the bits of 2^8 x 2^8 cells of two facets each.
    grid_number_ = hn::Set(DI(), static_cast<hn::TFromD<DI>>(grid_count_ << 18));
    last_ = set(f.frame.intervals - 1);
    const mars::FaceAxes& axes = mars::face_axes(f.face);
    const DepthPlane& plane = f.exact_lines != nullptr ? f.exact_lines->reference : f.lines->reference;
    const auto from = [&](const glm::dvec3& p) {
      const double z = glm::dot(p, axes.out);
      const double x = (glm::dot(p, axes.right) - f.frame.u0 * z) / f.frame.du;
      const double y = (glm::dot(p, axes.up) - f.frame.v0 * z) / f.frame.dv;
      return glm::dvec4(x, y, z, -row_.radius_m * (plane.w0 * z + plane.wx * x + plane.wy * y));
    };
    const glm::dvec4 camera = from(row_.camera_m);
    camera_x_ = set(camera.x);
    camera_y_ = set(camera.y);
    camera_z_ = set(camera.z);
    camera_rise_ = set(row_.radius_m + camera.w);
    ray0_ = from(row_.first);
    ray1_ = from(row_.step);
    set_directions();
  }

  // Expresses the rays' directions in the coordinates of the current grid.
  void set_directions() {
    const V index = hn::Iota(D(), T(0));
    const auto along = [&](double a, double b) {
      return hn::Mul(hn::MulAdd(index, set(b), set(a + static_cast<double>(first_) * b)), per_length_);
    };
    dx_ = along(ray0_.x, ray1_.x);
    dy_ = along(ray0_.y, ray1_.y);
    dz_ = along(ray0_.z, ray1_.z);
    ray_rise_ = along(ray0_.w, ray1_.w);
  }

  GridPosition position_at(V t) const {
    const D d;
    if (facets_ == nullptr) return {t, t, t};
    const V z = hn::MulAdd(t, dz_, camera_z_);
    const V per_z = hn::Div(hn::Set(d, T(1)), z);
    return {hn::Mul(hn::MulAdd(t, dx_, camera_x_), per_z), hn::Mul(hn::MulAdd(t, dy_, camera_y_), per_z), z};
  }

  // Returns the lanes over the current grid. A position on a border belongs to both sides.
  M inside(const GridPosition& p) const {
    const D d;
    constexpr double kSlack = kExact ? 1e-11 : 1e-4;
    const V low = set(-kSlack);
    const V high = hn::Add(last_, set(1 + kSlack));
    const M x = hn::And(hn::Ge(p.x, low), hn::Le(p.x, high));
    const M y = hn::And(hn::Ge(p.y, low), hn::Le(p.y, high));
    return hn::And(hn::Gt(p.z, hn::Zero(d)), hn::And(x, y));
  }

  // Returns the index of post (x, y) of each lane.
  VI index_of(VI x, VI y) const {
    const DI di;
    const VI side = hn::Set(di, facets_->frame.intervals + 1);
    if (facets_->family == LineFamily::kColumns) return hn::Add(hn::Mul(x, side), y);
    if (facets_->family == LineFamily::kRows) return hn::Add(hn::Mul(y, side), x);
    VI line = hn::Sub(x, y);
    line = hn::IfThenElse(hn::Lt(line, hn::Zero(di)), hn::Add(line, side), line);
    return hn::Add(hn::Mul(line, side), x);
  }

  // Loads one by one: since the mitigations of 2023 vector gathers take longer than loads on many processors.
  V posts_at(VI index) const {
    alignas(64) hn::TFromD<DI> at[64 / sizeof(T)];
    alignas(64) T values[64 / sizeof(T)];
    hn::Store(index, DI(), at);
    const T* posts = nullptr;
    if constexpr (kExact) {
      posts = facets_->exact_lines->posts;
    } else {
      posts = facets_->lines->posts;
    }
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k) values[k] = posts[at[k]];
    return hn::Load(D(), values);
  }

  // Holds a facet's posts: its cell's corner, the opposite corner, and the one between.
  struct Corners {
    V first;
    V across;
    V between;
  };
  Corners corners(VI x, VI y, M lower) const {
    const DI di;
    const VI one = hn::Set(di, 1);
    const auto low = hn::RebindMask(di, lower);
    const VI index = index_of(x, y);
    if (facets_->family == LineFamily::kDiagonals) {
      const VI step = hn::IfThenElse(low, one, hn::Zero(di));
      return {posts_at(index), posts_at(hn::Add(index, one)),
              posts_at(index_of(hn::Add(x, step), hn::Sub(hn::Add(y, one), step)))};
    }
    const int side = facets_->frame.intervals + 1;
    const VI east = hn::Set(di, facets_->family == LineFamily::kColumns ? side : 1);
    const VI north = hn::Set(di, facets_->family == LineFamily::kColumns ? 1 : side);
    return {posts_at(index), posts_at(hn::Add(index, hn::Set(di, side + 1))),
            posts_at(hn::Add(index, hn::IfThenElse(low, east, north)))};
  }

  // Intersects the rays with the planes of the facets at `position`. Moves lanes whose facet stays the same
  // from `todo` to `found`, and drops lanes whose intersection is not usable from `todo`.
  void step(M here, const GridPosition& position, M& todo, M& found, V low, V high, V& t) {
    const D d;
    const DI di;
    const V zero = hn::Zero(d);
    const V i = hn::IfThenElse(here, hn::Min(hn::Max(hn::Floor(position.x), zero), last_), zero);
    const V j = hn::IfThenElse(here, hn::Min(hn::Max(hn::Floor(position.y), zero), last_), zero);
    const M lower = hn::Ge(hn::Sub(position.x, i), hn::Sub(position.y, j));
    const VI xi = hn::ConvertTo(di, i);
    const VI yj = hn::ConvertTo(di, j);
    const VI lower_i = hn::IfThenElse(hn::RebindMask(di, lower), hn::Set(di, 1), hn::Zero(di));
    const VI facet =
        hn::Add(hn::Add(hn::ShiftLeft<1>(xi), hn::ShiftLeft<9>(yj)), hn::Add(lower_i, grid_number_));
    const M same = hn::And(here, hn::RebindMask(d, hn::Eq(facet, last_facet_)));
    found = hn::Or(found, same);
    todo = hn::AndNot(same, todo);
    here = hn::AndNot(same, here);
    if (hn::AllFalse(d, here)) return;
    last_facet_ = hn::IfThenElse(hn::RebindMask(di, here), facet, last_facet_);
    const Corners c = corners(xi, yj, lower);
    const V first = hn::Sub(c.between, c.first);
    const V second = hn::Sub(c.across, c.between);
    const V p = hn::IfThenElse(lower, first, second);
    const V q = hn::IfThenElse(lower, second, first);
    // Metres below the facet's plane, by way of the reference plane.
    const V per_r = set(1.0 / row_.radius_m);
    const auto below = [&](V x, V y, V z, V reference) {
      const V px = hn::NegMulAdd(i, z, x);
      const V py = hn::NegMulAdd(j, z, y);
      return hn::MulAdd(per_r, hn::MulAdd(c.first, z, hn::MulAdd(p, px, hn::Mul(q, py))), reference);
    };
    const V at_camera = below(camera_x_, camera_y_, camera_z_, camera_rise_);
    const V slope = below(dx_, dy_, dz_, ray_rise_);
    const V next = hn::Neg(hn::Div(at_camera, slope));
    const M good = hn::And(hn::Gt(slope, zero), hn::And(hn::Ge(next, low), hn::Le(next, high)));
    t = hn::IfThenElse(hn::And(here, good), next, t);
    // The facet faces away from the camera, or the place is far from the hints.
    todo = hn::AndNot(hn::AndNot(good, here), todo);
  }

  const RayRow& row_;
  FacetSource& source_;
  const Facets* facets_ = nullptr;
  int first_ = 0;
  int grid_count_ = 0;
  glm::dvec4 ray0_{};
  glm::dvec4 ray1_{};
  V per_length_ = hn::Zero(D());
  V camera_x_, camera_y_, camera_z_, dx_, dy_, dz_;
  V camera_rise_, ray_rise_;  // metres below the reference plane
  V last_;
  VI grid_number_;  // of the current grid
  VI last_facet_;   // of each lane
  M other_kind_;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
