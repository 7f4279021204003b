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

// The search for crests. In posts: the step at first, and the share of the way so far that a later step is.
constexpr int kCrestSamples = 64;
constexpr double kLeastStep = 0.5;
constexpr double kStepGrowth = 0.05;
// Shares of a range: how far before the sample of its surface a crest may begin, and how much before the ground behind it the search
// ends.
constexpr double kBeforeSample = 0.002;
constexpr double kBeforeRange = 1e-5;

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

  // Returns where the ray of one lane first meets ground from just before near_m, the range of a sample beside it, to range_m, what
  // it meets at the latest; range_m itself where it meets none. Looks at kCrestSamples places, half a post apart at first and farther
  // apart later on, and at the facet below each, so it passes over narrower ground. Stays in the height grid where it begins, so that it
  // needs no tile that is hidden; does nothing if that is of the other precision (passed_other_kind()). refine() serves again after
  // set_rays().
  T first_crest(std::size_t lane, T near_m, T range_m) {
    const D d;
    lane_ = static_cast<int>(lane);
    if (facets_ != nullptr) set_directions();
    const T end_m = range_m * static_cast<T>(1 - kBeforeRange);
    T before_m = near_m * static_cast<T>(1 - kBeforeSample);
    const T begin_m = before_m;
    const T post_m = post_along(begin_m);
    ends_ = passed_other_kind_ = (facets_->exact_lines != nullptr) != kExact;
    const int lanes = static_cast<int>(hn::Lanes(d));
    alignas(64) T offsets[64 / sizeof(T)];
    T met_m = range_m;
    T from_start = 0;  // posts
    for (int n = 0; n < kCrestSamples && before_m < end_m && !ends_; n += lanes) {
      for (int k = 0; k < lanes; ++k) {
        offsets[k] = from_start;
        from_start += std::max(static_cast<T>(kLeastStep), static_cast<T>(kStepGrowth) * from_start);
      }
      const V t = hn::MulAdd(hn::Load(d, offsets), hn::Set(d, post_m), hn::Set(d, begin_m));
      if (look(t, begin_m + from_start * post_m, end_m, before_m, met_m)) break;
    }
    lane_ = -1;
    return met_m;
  }

  // Returns whether the last first_crest() did nothing.
  bool passed_other_kind() const { return passed_other_kind_; }

 private:
  struct GridPosition {
    V x, y, z;
  };

  static V set(double x) { return hn::Set(D(), static_cast<T>(x)); }

  // Returns how long a post is along the ray of lane_ at a range: between two lines of the family that it crosses more often.
  T post_along(T range_m) {
    const D d;
    const V t = hn::Set(d, range_m);
    if (facets_ == nullptr || hn::AllFalse(d, inside(position_at(t)))) select_grid(hn::FirstN(d, 1), t);
    const GridPosition p = position_at(t);
    const V x = hn::Abs(hn::NegMulAdd(p.x, dz_, dx_));
    const V y = hn::Abs(hn::NegMulAdd(p.y, dz_, dy_));
    return hn::GetLane(hn::Div(p.z, hn::Max(x, y)));
  }

  // Looks at the ground below places t of the ray of lane_, which rise; `after` follows the last one. Returns true if the search ends:
  // sets met_m where the ray meets ground before end_m. Else sets before_m to the last place.
  bool look(V t, T after_m, T end_m, T& before_m, T& met_m) {
    const D d;
    const std::size_t lanes = hn::Lanes(d);
    for (int round = 0; round < kMaxRounds; ++round) {
      alignas(64) T places[64 / sizeof(T) + 1];
      alignas(64) T under[64 / sizeof(T)];
      alignas(64) T crossings[64 / sizeof(T)];
      hn::Store(t, d, places);
      places[lanes] = after_m;
      V crossing = t;
      const M is_under = look_below(t, hn::LoadU(d, places + 1), crossing);
      hn::Store(hn::IfThenElse(is_under, hn::Set(d, T(1)), hn::Zero(d)), d, under);
      hn::Store(crossing, d, crossings);
      std::size_t k = 0;
      while (k < lanes && under[k] == 0 && crossings[k] == places[k]) ++k;
      if (k == lanes) {
        before_m = places[lanes - 1];
        return false;
      }
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
    const GridPosition position = position_at(t);
    const M here = inside(position);
    ends_ = !hn::AllTrue(d, here);
    const FacetPlace facet = facet_at(here, position);
    const FacetPlane plane = plane_of(facet);
    const M below = hn::Ge(hn::MulAdd(t, plane.slope, plane.at_camera), hn::Zero(d));
    const V at = hn::Neg(hn::Div(plane.at_camera, plane.slope));
    const M ahead = hn::And(hn::Gt(plane.slope, hn::Zero(d)), hn::And(hn::Gt(at, t), hn::Le(at, next)));
    const M meets = hn::And(hn::AndNot(below, here), ahead);
    if (!hn::AllFalse(d, meets)) {
      const GridPosition there = position_at(at);
      const M on_facet = hn::RebindMask(d, hn::Eq(facet_at(meets, there).number, facet.number));
      crossing = hn::IfThenElse(hn::And(hn::And(meets, inside(there)), on_facet), at, crossing);
    }
    return hn::And(here, below);
  }

  // Selects the height grid of the first lane in `todo`.
  void select_grid(M todo, V t) {
    const D d;
    const auto lane = static_cast<std::size_t>(hn::FindFirstTrue(d, todo));
    alignas(64) T ts[64 / sizeof(T)];
    hn::Store(t, d, ts);
    const int ray_lane = lane_ >= 0 ? lane_ : static_cast<int>(lane);
    const glm::dvec3 ray = glm::normalize(row_.first + static_cast<double>(first_ + ray_lane) * row_.step);
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
    if (lane_ < 0) return;
    for (V* const v : {&dx_, &dy_, &dz_, &ray_rise_}) {
      alignas(64) T lanes[64 / sizeof(T)];
      hn::Store(*v, D(), lanes);
      *v = hn::Set(D(), lanes[lane_]);
    }
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

  // Holds facets: a cell's corner, which of its two facets it is, and a number that differs between facets.
  struct FacetPlace {
    V i, j;
    VI xi, yj;
    M lower;
    VI number;
  };
  FacetPlace facet_at(M here, const GridPosition& position) const {
    const D d;
    const DI di;
    const V zero = hn::Zero(d);
    FacetPlace f;
    f.i = hn::IfThenElse(here, hn::Min(hn::Max(hn::Floor(position.x), zero), last_), zero);
    f.j = hn::IfThenElse(here, hn::Min(hn::Max(hn::Floor(position.y), zero), last_), zero);
    f.lower = hn::Ge(hn::Sub(position.x, f.i), hn::Sub(position.y, f.j));
    f.xi = hn::ConvertTo(di, f.i);
    f.yj = hn::ConvertTo(di, f.j);
    const VI is_lower = hn::IfThenElse(hn::RebindMask(di, f.lower), hn::Set(di, 1), hn::Zero(di));
    f.number =
        hn::Add(hn::Add(hn::ShiftLeft<1>(f.xi), hn::ShiftLeft<9>(f.yj)), hn::Add(is_lower, grid_number_));
    return f;
  }

  // Holds how far below a facet's plane a ray is: at the camera, and how much more for each metre along the ray.
  struct FacetPlane {
    V at_camera;
    V slope;
  };
  FacetPlane plane_of(const FacetPlace& f) const {
    const Corners c = corners(f.xi, f.yj, f.lower);
    const V first = hn::Sub(c.between, c.first);
    const V second = hn::Sub(c.across, c.between);
    const V p = hn::IfThenElse(f.lower, first, second);
    const V q = hn::IfThenElse(f.lower, second, first);
    // By way of the reference plane.
    const V per_r = set(1.0 / row_.radius_m);
    const auto below = [&](V x, V y, V z, V reference) {
      const V px = hn::NegMulAdd(f.i, z, x);
      const V py = hn::NegMulAdd(f.j, z, y);
      return hn::MulAdd(per_r, hn::MulAdd(c.first, z, hn::MulAdd(p, px, hn::Mul(q, py))), reference);
    };
    return {below(camera_x_, camera_y_, camera_z_, camera_rise_), below(dx_, dy_, dz_, ray_rise_)};
  }

  // Intersects the rays with the planes of the facets at `position`. Moves lanes whose facet stays the same
  // from `todo` to `found`, and drops lanes whose intersection is not usable from `todo`.
  void step(M here, const GridPosition& position, M& todo, M& found, V low, V high, V& t) {
    const D d;
    const DI di;
    const FacetPlace facet = facet_at(here, position);
    const M same = hn::And(here, hn::RebindMask(d, hn::Eq(facet.number, last_facet_)));
    found = hn::Or(found, same);
    todo = hn::AndNot(same, todo);
    here = hn::AndNot(same, here);
    if (hn::AllFalse(d, here)) return;
    last_facet_ = hn::IfThenElse(hn::RebindMask(di, here), facet.number, last_facet_);
    const FacetPlane plane = plane_of(facet);
    const V next = hn::Neg(hn::Div(plane.at_camera, plane.slope));
    const M good = hn::And(hn::Gt(plane.slope, hn::Zero(d)), hn::And(hn::Ge(next, low), hn::Le(next, high)));
    t = hn::IfThenElse(hn::And(here, good), next, t);
    // The facet faces away from the camera, or the place is far from the hints.
    todo = hn::AndNot(hn::AndNot(good, here), todo);
  }

  const RayRow& row_;
  FacetSource& source_;
  const Facets* facets_ = nullptr;
  int first_ = 0;
  bool passed_other_kind_ = false;
  bool ends_ = false;  // the search, at the border of the height grid
  int lane_ = -1;      // the lane whose ray all lanes have; -1: each its own
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
