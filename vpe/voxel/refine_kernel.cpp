#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/voxel/refine.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/voxel/refine_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using DI = hn::RebindToSigned<D>;
using VI = hn::Vec<DI>;

constexpr int kLanes = 8;
constexpr int kRounds = 8;
// Hints farther apart than this share of the nearer one are not taken for one surface.
constexpr double kApart = 0.04;
// Cells by which rounding may put a place outside its lattice.
constexpr double kBorder = 1e-11;

struct Vector3 {
  V x, y, z;
};

Vector3 spread(const glm::dvec3& a) {
  const D d;
  return {hn::Set(d, a.x), hn::Set(d, a.y), hn::Set(d, a.z)};
}
V dot(const Vector3& a, const glm::dvec3& b) {
  const D d;
  return hn::MulAdd(a.x, hn::Set(d, b.x), hn::MulAdd(a.y, hn::Set(d, b.y), hn::Mul(a.z, hn::Set(d, b.z))));
}

class RowRefiner {
 public:
  RowRefiner(const RayRow& row, FacetSource& source) : row_(row), source_(source) {
    const V zero = hn::Zero(D());
    ex_ = ey_ = ez_ = dx_ = dy_ = dz_ = zero;
    u0_ = v0_ = du_ = dv_ = per_du_ = per_dv_ = last_ = w0_ = wx_ = wy_ = zero;
  }

  // Rays of the next lanes, unit.
  void set_rays(const Vector3& ray) {
    ray_ = ray;
    turned_ = false;
  }

  // t holds first guesses of the lanes in `todo` and takes their ranges. Returns who was found.
  M refine(M todo, V low, V high, V& t) {
    const D d;
    const DI di;
    M found = hn::MaskFromVec(hn::Zero(d));
    VI last_facet = hn::Set(di, -1);
    for (int round = 0; round < kRounds && !hn::AllFalse(d, todo); ++round) {
      Place place = place_of(t);
      M here = hn::And(todo, inside(place));
      if (facets_ == nullptr || hn::AllFalse(d, here)) {
        aim(todo, t);
        last_facet = hn::Set(di, -1);
        place = place_of(t);
        here = hn::And(todo, inside(place));
      }
      step(here, place, todo, found, low, high, t, last_facet);
    }
    return found;
  }

 private:
  struct Place {
    V x, y, z;
  };

  // To the lattice of the first lane that is left.
  void aim(M todo, V t) {
    const D d;
    const auto lane = static_cast<std::size_t>(hn::FindFirstTrue(d, todo));
    alignas(64) double values[4][kLanes];
    hn::Store(t, d, values[0]);
    hn::Store(ray_.x, d, values[1]);
    hn::Store(ray_.y, d, values[2]);
    hn::Store(ray_.z, d, values[3]);
    const mars::Face before = facets_ != nullptr ? facets_->face : mars::Face::kPlusX;
    const bool first = facets_ == nullptr;
    facets_ = &source_.at(row_.eye_m +
                          values[0][lane] * glm::dvec3(values[1][lane], values[2][lane], values[3][lane]));
    const Facets& f = *facets_;
    if (first || f.face != before) turned_ = false;
    turn();
    u0_ = hn::Set(d, f.frame.u0);
    v0_ = hn::Set(d, f.frame.v0);
    du_ = hn::Set(d, f.frame.du);
    dv_ = hn::Set(d, f.frame.dv);
    per_du_ = hn::Set(d, 1.0 / f.frame.du);
    per_dv_ = hn::Set(d, 1.0 / f.frame.dv);
    last_ = hn::Set(d, static_cast<double>(f.frame.intervals - 1));
    const DepthPlane& plane = f.exact_lines != nullptr ? f.exact_lines->reference : f.lines->reference;
    w0_ = hn::Set(d, plane.w0);
    wx_ = hn::Set(d, plane.wx);
    wy_ = hn::Set(d, plane.wy);
  }

  // The rays in the axes of the face at hand.
  void turn() {
    if (turned_) return;
    const D d;
    const mars::FaceAxes& axes = mars::face_axes(facets_->face);
    ex_ = hn::Set(d, glm::dot(row_.eye_m, axes.right));
    ey_ = hn::Set(d, glm::dot(row_.eye_m, axes.up));
    ez_ = hn::Set(d, glm::dot(row_.eye_m, axes.out));
    dx_ = dot(ray_, axes.right);
    dy_ = dot(ray_, axes.up);
    dz_ = dot(ray_, axes.out);
    turned_ = true;
  }

  Place place_of(V t) {
    if (facets_ == nullptr) return {t, t, t};
    turn();
    const V z = hn::MulAdd(t, dz_, ez_);
    const V per_z = hn::Div(hn::Set(D(), 1.0), z);
    return {hn::Mul(hn::MulSub(hn::MulAdd(t, dx_, ex_), per_z, u0_), per_du_),
            hn::Mul(hn::MulSub(hn::MulAdd(t, dy_, ey_), per_z, v0_), per_dv_), z};
  }

  // A place on a border belongs to both sides.
  M inside(const Place& p) const {
    const D d;
    const V low = hn::Set(d, -kBorder);
    const V high = hn::Add(last_, hn::Set(d, 1 + kBorder));
    const M x = hn::And(hn::Ge(p.x, low), hn::Le(p.x, high));
    const M y = hn::And(hn::Ge(p.y, low), hn::Le(p.y, high));
    return hn::And(hn::Gt(p.z, hn::Zero(d)), hn::And(x, y));
  }

  // Post (x, y) of each lane.
  V post(VI x, VI y) const {
    const D d;
    const DI di;
    const Facets& f = *facets_;
    const int side = f.frame.intervals + 1;
    VI line = f.family == Family::kColumns ? x : (f.family == Family::kRows ? y : hn::Sub(x, y));
    const VI position = f.family == Family::kColumns ? y : x;
    if (f.family == Family::kDiagonals)
      line = hn::IfThenElse(hn::Lt(line, hn::Zero(di)), hn::Add(line, hn::Set(di, side)), line);
#if HWY_TARGET <= HWY_AVX3
    const __m512i at = _mm512_add_epi64(_mm512_mul_epi32(line.raw, _mm512_set1_epi64(side)), position.raw);
    if (f.exact_lines != nullptr) return V{_mm512_i64gather_pd(at, f.exact_lines->posts, 8)};
    return V{_mm512_cvtps_pd(_mm512_i64gather_ps(at, f.lines->posts, 4))};
#else
    alignas(64) std::int64_t lines[kLanes];
    alignas(64) std::int64_t positions[kLanes];
    hn::Store(line, di, lines);
    hn::Store(position, di, positions);
    alignas(64) double values[kLanes];
    for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
      const std::ptrdiff_t at = lines[k] * side + positions[k];
      values[k] = f.exact_lines != nullptr ? f.exact_lines->posts[at] : static_cast<double>(f.lines->posts[at]);
    }
    return hn::Load(d, values);
#endif
  }

  void step(M here, const Place& place, M& todo, M& found, V low, V high, V& t, VI& last_facet) const {
    const D d;
    const DI di;
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, 1.0);
    const V i = hn::IfThenElse(here, hn::Min(hn::Max(hn::Floor(place.x), zero), last_), zero);
    const V j = hn::IfThenElse(here, hn::Min(hn::Max(hn::Floor(place.y), zero), last_), zero);
    const M lower = hn::Ge(hn::Sub(place.x, i), hn::Sub(place.y, j));
    const VI xi = hn::ConvertTo(di, i);
    const VI yj = hn::ConvertTo(di, j);
    const VI one_i = hn::Set(di, 1);
    const VI lower_i = hn::IfThenElse(hn::RebindMask(di, lower), one_i, hn::Zero(di));
    // The facet's number in the lattice.
    const VI facet = hn::Add(hn::Add(hn::ShiftLeft<1>(xi), hn::ShiftLeft<16>(yj)), lower_i);
    const M same = hn::And(here, hn::RebindMask(d, hn::Eq(facet, last_facet)));
    found = hn::Or(found, same);
    todo = hn::AndNot(same, todo);
    here = hn::AndNot(same, here);
    if (hn::AllFalse(d, here)) return;
    last_facet = hn::IfThenElse(hn::RebindMask(di, here), facet, last_facet);
    const V h00 = post(xi, yj);
    const V h11 = post(hn::Add(xi, one_i), hn::Add(yj, one_i));
    const V hm = post(hn::Add(xi, lower_i), hn::Sub(hn::Add(yj, one_i), lower_i));
    const V per_r2 = hn::Set(d, 1.0 / (row_.radius_m * row_.radius_m));
    const V w00 = hn::NegMulAdd(h00, per_r2, hn::MulAdd(wx_, i, hn::MulAdd(wy_, j, w0_)));
    const V first = hn::Mul(hn::Sub(hm, h00), per_r2);
    const V second = hn::Mul(hn::Sub(h11, hm), per_r2);
    const V ws = hn::Mul(hn::Sub(wx_, hn::IfThenElse(lower, first, second)), per_du_);
    const V wt = hn::Mul(hn::Sub(wy_, hn::IfThenElse(lower, second, first)), per_dv_);
    const V u = hn::MulAdd(du_, i, u0_);
    const V v = hn::MulAdd(dv_, j, v0_);
    // 1 - Z w: negative above the facet's plane.
    const V c = hn::NegMulAdd(ws, u, hn::NegMulAdd(wt, v, w00));
    const V at_eye = hn::NegMulAdd(ws, ex_, hn::NegMulAdd(wt, ey_, hn::NegMulAdd(c, ez_, one)));
    const V slope = hn::Neg(hn::MulAdd(ws, dx_, hn::MulAdd(wt, dy_, hn::Mul(c, dz_))));
    const V next = hn::Neg(hn::Div(at_eye, slope));
    const M good = hn::And(hn::Gt(slope, zero), hn::And(hn::Ge(next, low), hn::Le(next, high)));
    t = hn::IfThenElse(hn::And(here, good), next, t);
    // Back to back with the ray, or far from its hints: not this way.
    todo = hn::AndNot(hn::AndNot(good, here), todo);
  }

  const RayRow& row_;
  FacetSource& source_;
  const Facets* facets_ = nullptr;
  bool turned_ = false;
  Vector3 ray_{};
  V ex_, ey_, ez_, dx_, dy_, dz_;
  V u0_, v0_, du_, dv_, per_du_, per_dv_, last_, w0_, wx_, wy_;
};

void RefineRow(const RayRow& row, const float* a, const float* b, const float* share, FacetSource& source,
               float* range, std::vector<int>& open) {
  const D d;
  const hn::Rebind<float, D> df;
  const int lanes = static_cast<int>(hn::Lanes(d));
  RowRefiner refiner(row, source);
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0);
  const V inf = hn::Set(d, std::numeric_limits<double>::infinity());
  const Vector3 first = spread(row.first);
  const Vector3 step = spread(row.step);
  alignas(64) float as[kLanes];
  alignas(64) float bs[kLanes];
  alignas(64) float shares[kLanes];
  for (int k = 0; k < row.count; k += lanes) {
    const int used = std::min(lanes, row.count - k);
    V ha;
    V hb;
    V part;
    if (used == lanes) {
      ha = hn::PromoteTo(d, hn::LoadU(df, a + k));
      hb = hn::PromoteTo(d, hn::LoadU(df, b + k));
      part = hn::PromoteTo(d, hn::LoadU(df, share + k));
    } else {
      for (int lane = 0; lane < lanes; ++lane) {
        as[lane] = lane < used ? a[k + lane] : std::numeric_limits<float>::infinity();
        bs[lane] = lane < used ? b[k + lane] : std::numeric_limits<float>::infinity();
        shares[lane] = lane < used ? share[k + lane] : 0.0F;
      }
      ha = hn::PromoteTo(d, hn::Load(df, as));
      hb = hn::PromoteTo(d, hn::Load(df, bs));
      part = hn::PromoteTo(d, hn::Load(df, shares));
    }
    const V near = hn::Min(ha, hb);
    const V far = hn::Max(ha, hb);
    const M sky = hn::Eq(near, inf);
    if (hn::AllTrue(d, sky)) {
      std::fill_n(range + k, used, std::numeric_limits<float>::infinity());
      continue;
    }
    const V index = hn::Add(hn::Iota(d, 0.0), hn::Set(d, static_cast<double>(k)));
    const Vector3 ray{hn::MulAdd(index, step.x, first.x), hn::MulAdd(index, step.y, first.y),
                      hn::MulAdd(index, step.z, first.z)};
    const V per =
        hn::Div(one, hn::Sqrt(hn::MulAdd(ray.x, ray.x, hn::MulAdd(ray.y, ray.y, hn::Mul(ray.z, ray.z)))));
    refiner.set_rays({hn::Mul(ray.x, per), hn::Mul(ray.y, per), hn::Mul(ray.z, per)});
    const V reach = hn::Mul(near, hn::Set(d, kApart));
    const M close = hn::Le(hn::Sub(far, near), reach);
    // On one facet the inverse range is all but even from sample to sample.
    const V inverse = hn::MulAdd(part, hn::Sub(hn::Div(one, hb), hn::Div(one, ha)), hn::Div(one, ha));
    V t = hn::IfThenElse(close, hn::Div(one, inverse), zero);
    const M found = refiner.refine(hn::AndNot(sky, close), hn::Sub(near, reach), hn::Add(far, reach), t);
    const M done = hn::Or(found, sky);
    const V seen = hn::IfThenElse(found, t, near);
    if (used == lanes) {
      hn::StoreU(hn::DemoteTo(df, seen), df, range + k);
    } else {
      hn::Store(hn::DemoteTo(df, seen), df, as);
      std::copy_n(as, used, range + k);
    }
    if (!hn::AllTrue(d, done)) {
      alignas(64) double marks[kLanes];
      hn::Store(hn::IfThenElse(done, zero, one), d, marks);
      for (int lane = 0; lane < used; ++lane) {
        if (marks[lane] != 0) open.push_back(k + lane);
      }
    }
  }
}

void HintsFromRow(const float* samples, int sample_count, double first, double step, int count, float* a,
                  float* b, float* share) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  // Relative to the row's first sample, which keeps positions small enough for float.
  const double base = std::floor(first);
  const auto start = hn::Set(d, static_cast<float>(first - base));
  const auto per = hn::Set(d, static_cast<float>(step));
  const auto offset = hn::Set(di, static_cast<std::int32_t>(base));
  const auto last = hn::Set(di, sample_count - 1);
  const auto none = hn::Zero(di);
  alignas(64) float some[3][16];
  for (int k = 0; k < count; k += lanes) {
    const auto x = hn::Add(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(k)));
    const auto place = hn::MulAdd(x, per, start);
    const auto at = hn::Floor(place);
    const auto part = hn::Sub(place, at);
    const auto index = hn::Add(hn::ConvertTo(di, at), offset);
    const auto va = hn::GatherIndex(d, samples, hn::Min(hn::Max(index, none), last));
    const auto vb = hn::GatherIndex(d, samples, hn::Min(hn::Max(hn::Add(index, hn::Set(di, 1)), none), last));
    if (k + lanes <= count) {
      hn::StoreU(va, d, a + k);
      hn::StoreU(vb, d, b + k);
      hn::StoreU(part, d, share + k);
    } else {
      hn::Store(va, d, some[0]);
      hn::Store(vb, d, some[1]);
      hn::Store(part, d, some[2]);
      std::copy_n(some[0], count - k, a + k);
      std::copy_n(some[1], count - k, b + k);
      std::copy_n(some[2], count - k, share + k);
    }
  }
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::voxel {

HWY_EXPORT(RefineRow);
HWY_EXPORT(HintsFromRow);

void refine_row(const RayRow& row, const float* a, const float* b, const float* share, FacetSource& source,
                float* range, std::vector<int>& open) {
  HWY_DYNAMIC_DISPATCH(RefineRow)(row, a, b, share, source, range, open);
}
void hints_from_row(const float* samples, int sample_count, double first, double step, int count, float* a,
                    float* b, float* share) {
  HWY_DYNAMIC_DISPATCH(HintsFromRow)(samples, sample_count, first, step, count, a, b, share);
}

}  // namespace vpe::voxel
#endif
