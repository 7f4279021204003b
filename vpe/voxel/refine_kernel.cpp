#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/voxel/refine.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/voxel/refine_kernel.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

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

// Post (x, y) of each lane.
V post(const Facets& f, VI x, VI y) {
  const D d;
  const DI di;
  const int side = f.frame.intervals + 1;
  VI line = f.family == Family::kColumns ? x : (f.family == Family::kRows ? y : hn::Sub(x, y));
  const VI position = f.family == Family::kColumns ? y : x;
  if (f.family == Family::kDiagonals)
    line = hn::IfThenElse(hn::Lt(line, hn::Zero(di)), hn::Add(line, hn::Set(di, side)), line);
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
}

class RowRefiner {
 public:
  RowRefiner(const RayRow& row, FacetSource& source) : row_(row), source_(source) {}

  // `todo` lanes of pixels that start at `k`; t holds first guesses and takes the ranges. Returns who was
  // found.
  M refine(M todo, const Vector3& ray, V low, V high, V& t) {
    const D d;
    const DI di;
    M found = hn::MaskFromVec(hn::Zero(d));
    VI last_cell = hn::Set(di, -1);
    std::uint64_t last = ~std::uint64_t{0};
    for (int round = 0; round < kRounds && !hn::AllFalse(d, todo); ++round) {
      // All lanes that lie over the lattice of the first one.
      alignas(64) double ts[kLanes];
      hn::Store(t, d, ts);
      const auto lane = static_cast<std::size_t>(hn::FindFirstTrue(d, todo));
      alignas(64) double px[kLanes];
      alignas(64) double py[kLanes];
      alignas(64) double pz[kLanes];
      hn::Store(ray.x, d, px);
      hn::Store(ray.y, d, py);
      hn::Store(ray.z, d, pz);
      const Facets& f = source_.at(row_.eye_m + ts[lane] * glm::dvec3(px[lane], py[lane], pz[lane]));
      if (f.id != last) last_cell = hn::Set(di, -1);
      last = f.id;
      step(f, todo, found, ray, low, high, t, last_cell);
    }
    return found;
  }

 private:
  void step(const Facets& f, M& todo, M& found, const Vector3& ray, V low, V high, V& t, VI& last_cell) {
    const D d;
    const DI di;
    const mars::FaceAxes& axes = mars::face_axes(f.face);
    const V ex = hn::Set(d, glm::dot(row_.eye_m, axes.right));
    const V ey = hn::Set(d, glm::dot(row_.eye_m, axes.up));
    const V ez = hn::Set(d, glm::dot(row_.eye_m, axes.out));
    const V dx = dot(ray, axes.right);
    const V dy = dot(ray, axes.up);
    const V dz = dot(ray, axes.out);
    const V n = hn::Set(d, static_cast<double>(f.frame.intervals));
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, 1.0);
    const V z = hn::MulAdd(t, dz, ez);
    const V per_z = hn::Div(one, z);
    const V u0 = hn::Set(d, f.frame.u0);
    const V v0 = hn::Set(d, f.frame.v0);
    const V x = hn::Mul(hn::MulSub(hn::MulAdd(t, dx, ex), per_z, u0), hn::Set(d, 1.0 / f.frame.du));
    const V y = hn::Mul(hn::MulSub(hn::MulAdd(t, dy, ey), per_z, v0), hn::Set(d, 1.0 / f.frame.dv));
    // A place on the border belongs to both sides.
    const V slack = hn::Set(d, 1e-6);
    M here = hn::And(todo, hn::Gt(z, zero));
    here = hn::And(here, hn::And(hn::Ge(x, hn::Neg(slack)), hn::Le(x, hn::Add(n, slack))));
    here = hn::And(here, hn::And(hn::Ge(y, hn::Neg(slack)), hn::Le(y, hn::Add(n, slack))));
    const V last = hn::Sub(n, one);
    const V i = hn::IfThenElse(here, hn::Min(hn::Max(hn::Floor(x), zero), last), zero);
    const V j = hn::IfThenElse(here, hn::Min(hn::Max(hn::Floor(y), zero), last), zero);
    const M lower = hn::Ge(hn::Sub(x, i), hn::Sub(y, j));
    const VI xi = hn::ConvertTo(di, i);
    const VI yj = hn::ConvertTo(di, j);
    const VI one_i = hn::Set(di, 1);
    // The facet's number in the lattice.
    const VI cell = hn::Add(hn::Add(hn::ShiftLeft<1>(xi), hn::ShiftLeft<16>(yj)),
                            hn::ConvertTo(di, hn::IfThenElse(lower, one, zero)));
    const M same = hn::And(here, hn::RebindMask(d, hn::Eq(cell, last_cell)));
    found = hn::Or(found, same);
    todo = hn::AndNot(same, todo);
    here = hn::AndNot(same, here);
    last_cell = hn::IfThenElse(hn::RebindMask(di, here), cell, last_cell);
    if (hn::AllFalse(d, here)) return;
    const V h00 = post(f, xi, yj);
    const V h11 = post(f, hn::Add(xi, one_i), hn::Add(yj, one_i));
    const VI lower_i = hn::ConvertTo(di, hn::IfThenElse(lower, one, zero));
    const V hm = post(f, hn::Add(xi, lower_i), hn::Sub(hn::Add(yj, one_i), lower_i));
    const DepthPlane& plane = f.exact_lines != nullptr ? f.exact_lines->reference : f.lines->reference;
    const V per_r2 = hn::Set(d, 1.0 / (row_.radius_m * row_.radius_m));
    const V wx = hn::Set(d, plane.wx);
    const V wy = hn::Set(d, plane.wy);
    const V w00 = hn::NegMulAdd(h00, per_r2, hn::MulAdd(wx, i, hn::MulAdd(wy, j, hn::Set(d, plane.w0))));
    const V first = hn::Mul(hn::Sub(hm, h00), per_r2);
    const V second = hn::Mul(hn::Sub(h11, hm), per_r2);
    const V ws = hn::Mul(hn::Sub(wx, hn::IfThenElse(lower, first, second)), hn::Set(d, 1.0 / f.frame.du));
    const V wt = hn::Mul(hn::Sub(wy, hn::IfThenElse(lower, second, first)), hn::Set(d, 1.0 / f.frame.dv));
    const V u = hn::MulAdd(hn::Set(d, f.frame.du), i, u0);
    const V v = hn::MulAdd(hn::Set(d, f.frame.dv), j, v0);
    // 1 - Z w: negative above the facet's plane.
    const V c = hn::Sub(hn::Sub(w00, hn::Mul(ws, u)), hn::Mul(wt, v));
    const V at_eye = hn::NegMulAdd(ws, ex, hn::NegMulAdd(wt, ey, hn::NegMulAdd(c, ez, one)));
    const V slope = hn::Neg(hn::MulAdd(ws, dx, hn::MulAdd(wt, dy, hn::Mul(c, dz))));
    const V next = hn::Neg(hn::Div(at_eye, slope));
    const M good = hn::And(hn::Gt(slope, zero), hn::And(hn::Ge(next, low), hn::Le(next, high)));
    t = hn::IfThenElse(hn::And(here, good), next, t);
    // Back to back with the ray, or far from its hints: not this way.
    todo = hn::AndNot(hn::AndNot(good, here), todo);
  }

  const RayRow& row_;
  FacetSource& source_;
};

void RefineRow(const RayRow& row, const float* a, const float* b, FacetSource& source, float* range,
               std::vector<int>& open) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  RowRefiner refiner(row, source);
  const V zero = hn::Zero(d);
  const double infinite = std::numeric_limits<double>::infinity();
  for (int k = 0; k < row.count; k += lanes) {
    alignas(64) double as[kLanes];
    alignas(64) double bs[kLanes];
    const int used = std::min(lanes, row.count - k);
    bool any = false;
    for (int lane = 0; lane < lanes; ++lane) {
      as[lane] = lane < used ? static_cast<double>(a[k + lane]) : infinite;
      bs[lane] = lane < used ? static_cast<double>(b[k + lane]) : infinite;
      any = any || as[lane] < infinite || bs[lane] < infinite;
    }
    if (!any) {
      std::fill_n(range + k, used, std::numeric_limits<float>::infinity());
      continue;
    }
    const V ha = hn::Load(d, as);
    const V hb = hn::Load(d, bs);
    const V near = hn::Min(ha, hb);
    const V far = hn::Max(ha, hb);
    const V inf = hn::Set(d, infinite);
    const V index = hn::Add(hn::Iota(d, 0.0), hn::Set(d, static_cast<double>(k)));
    const Vector3 first = spread(row.first);
    const Vector3 step = spread(row.step);
    Vector3 ray{hn::MulAdd(index, step.x, first.x), hn::MulAdd(index, step.y, first.y),
                hn::MulAdd(index, step.z, first.z)};
    const V per = hn::Div(hn::Set(d, 1.0),
                          hn::Sqrt(hn::MulAdd(ray.x, ray.x, hn::MulAdd(ray.y, ray.y, hn::Mul(ray.z, ray.z)))));
    ray = {hn::Mul(ray.x, per), hn::Mul(ray.y, per), hn::Mul(ray.z, per)};
    const M sky = hn::Eq(near, inf);
    const V reach = hn::Mul(near, hn::Set(d, kApart));
    const M close = hn::Le(hn::Sub(far, near), reach);
    V t = hn::IfThenElse(close, hn::Mul(hn::Set(d, 0.5), hn::Add(near, far)), zero);
    const M found = refiner.refine(hn::AndNot(sky, close), ray, hn::Sub(near, reach), hn::Add(far, reach), t);
    alignas(64) double ts[kLanes];
    hn::Store(hn::IfThenElse(found, t, near), d, ts);
    alignas(64) double marks[kLanes];
    hn::Store(hn::IfThenElse(hn::Or(found, sky), zero, hn::Set(d, 1.0)), d, marks);
    for (int lane = 0; lane < used; ++lane) {
      range[k + lane] = static_cast<float>(ts[lane]);
      if (marks[lane] != 0) open.push_back(k + lane);
    }
  }
}

void HintsFromRow(const float* samples, int sample_count, double first, double step, int count, float* a,
                  float* b) {
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
  alignas(64) float some[2][16];
  for (int k = 0; k < count; k += lanes) {
    const auto x = hn::Add(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(k)));
    const auto at = hn::Floor(hn::MulAdd(x, per, start));
    const auto index = hn::Add(hn::ConvertTo(di, at), offset);
    const auto va = hn::GatherIndex(d, samples, hn::Min(hn::Max(index, none), last));
    const auto vb = hn::GatherIndex(d, samples, hn::Min(hn::Max(hn::Add(index, hn::Set(di, 1)), none), last));
    if (k + lanes <= count) {
      hn::StoreU(va, d, a + k);
      hn::StoreU(vb, d, b + k);
    } else {
      hn::Store(va, d, some[0]);
      hn::Store(vb, d, some[1]);
      std::copy_n(some[0], count - k, a + k);
      std::copy_n(some[1], count - k, b + k);
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

void refine_row(const RayRow& row, const float* a, const float* b, FacetSource& source, float* range,
                std::vector<int>& open) {
  HWY_DYNAMIC_DISPATCH(RefineRow)(row, a, b, source, range, open);
}
void hints_from_row(const float* samples, int sample_count, double first, double step, int count, float* a,
                    float* b) {
  HWY_DYNAMIC_DISPATCH(HintsFromRow)(samples, sample_count, first, step, count, a, b);
}

}  // namespace vpe::voxel
#endif
