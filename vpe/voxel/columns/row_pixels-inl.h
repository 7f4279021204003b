// Refines the pixels of a row of a perspective image: those on one facet with a sample first, then the others.
//
// Part of refine_kernel.cpp; refine.h has the contract of refine_row().
#if defined(VPE_VOXEL_ROW_PIXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_ROW_PIXELS_INL_H_
#undef VPE_VOXEL_ROW_PIXELS_INL_H_
#else
#define VPE_VOXEL_ROW_PIXELS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <algorithm>
#include <limits>

#include "vpe/voxel/columns/pixel_refiner-inl.h"
#include "vpe/voxel/columns/row_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Hints that differ by more than this share of the nearer one belong to different surfaces.
constexpr double kApart = 0.04;
// Between hints that differ by more than this there may be a crest, with ground behind it that is as well between them.
constexpr double kMaybeCrest = 0.002;
// Pixels of a row that are refined together.
constexpr int kRowPixels = 128;

// Holds what the samples on either side of pixels say.
struct RowEstimate {
  using V = hn::Vec<FloatTag>;
  using M = hn::Mask<FloatTag>;

  RowEstimate(V a, V b, V share) {
    const FloatTag d;
    near = hn::Min(a, b);
    far = hn::Max(a, b);
    sky = hn::Eq(near, hn::Set(d, std::numeric_limits<float>::infinity()));
    reach = hn::Mul(near, hn::Set(d, static_cast<float>(kApart)));
    const V gap = hn::Sub(far, near);
    is_close = hn::Le(gap, reach);
    is_smooth = hn::Le(gap, hn::Mul(near, hn::Set(d, static_cast<float>(kMaybeCrest))));
    // On one facet the inverse range changes almost linearly from sample to sample.
    between = hn::Div(hn::Mul(a, b), hn::MulAdd(share, hn::Sub(a, b), b));
    // Between two surfaces the nearer one comes first.
    start = hn::IfThenElse(is_smooth, between, near);
    low = hn::Sub(near, reach);
    high = hn::Add(hn::IfThenElse(is_close, far, near), reach);
  }

  V near, far;
  V reach;      // how far a surface may be from a sample of it
  V between;    // interpolated; of lanes that are close
  V start;      // the first estimate
  V low, high;  // of the surface that is met first
  M sky;        // both
  M is_close;   // on one surface, or nearly
  M is_smooth;  // on one surface
};

// Refines up to kRowPixels pixels of a row. Pixels that lie on the facet of their estimate are found in one round, without branches;
// the others are gathered and take as many as they need, so that none waits for its neighbours.
class RowPixels {
 public:
  using V = hn::Vec<FloatTag>;
  using M = hn::Mask<FloatTag>;

  RowPixels(const RayRow& row, const float* a, const float* b, const float* share, FacetSource& source,
            FacetSource& exact_source, float* range)
      : count_(row.count), a_(a), b_(b), share_(share), range_(range), refiner_(row, source, exact_source) {}

  // Refines all. Appends those that are not resolved to `unresolved`, counted from `first`.
  void refine(int first, std::vector<int>& unresolved) {
    const int lanes = static_cast<int>(hn::Lanes(FloatTag()));
    for (int k = 0; k < count_; k += lanes) meet_first(k, std::min(lanes, count_ - k));
    if (open_count_ == 0) return;
    refiner_.leave_grid();
    for (int k = 0; k < open_count_; k += lanes)
      refine_open(k, std::min(lanes, open_count_ - k), first, unresolved);
  }

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();

  // Refines pixels k, k + 1, ... by the facets of their estimates.
  void meet_first(int k, int used) {
    const FloatTag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    alignas(64) float some[16];
    const auto load = [&](const float* from, float rest) {
      if (HWY_LIKELY(used == lanes)) return hn::LoadU(d, from + k);
      std::fill_n(some, lanes, rest);
      std::copy_n(from + k, used, some);
      return hn::Load(d, some);
    };
    const V a = load(a_, kInfinity);
    const RowEstimate e(a, load(b_, kInfinity), load(share_, 0));
    if (hn::AllTrue(d, e.sky)) {
      std::fill_n(range_ + k, used, kInfinity);
      return;
    }
    refiner_.take_from(k);
    V t = e.start;
    M dropped;
    const M found = refiner_.meet_once(hn::Not(e.sky), e.low, e.high, t, dropped);
    // Negative: refine() would give up.
    const V seen = hn::IfThenElse(e.sky, e.near, hn::IfThenElse(dropped, hn::Neg(t), t));
    if (HWY_LIKELY(used == lanes)) {
      hn::StoreU(seen, d, range_ + k);
    } else {
      hn::Store(seen, d, some);
      std::copy_n(some, used, range_ + k);
    }
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Not(hn::Or(found, e.sky)), bits);
    const unsigned open = bits[0] | static_cast<unsigned>(bits[1]) << 8;
    if (open == 0) return;
    // Without a branch for each lane, which would be guessed wrong too often.
    int count = open_count_;
    for (int lane = 0; lane < lanes; ++lane) {
      pixel_[count] = k + lane;
      count += static_cast<int>(open >> lane & 1U);
    }
    open_count_ = count;
  }

  // Refines open pixels k, k + 1, ... as far as they need.
  void refine_open(int k, int used, int first, std::vector<int>& unresolved) {
    const FloatTag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const V inf = hn::Set(d, kInfinity);
    std::fill_n(pixel_ + k + used, lanes - used, pixel_[k + used - 1]);
    alignas(64) float some[4][16];
    for (int lane = 0; lane < lanes; ++lane) {
      const int pixel = pixel_[k + lane];
      some[0][lane] = lane < used ? a_[pixel] : kInfinity;
      some[1][lane] = lane < used ? b_[pixel] : kInfinity;
      some[2][lane] = share_[pixel];
      some[3][lane] = range_[pixel];
    }
    const RowEstimate e(hn::Load(d, some[0]), hn::Load(d, some[1]), hn::Load(d, some[2]));
    V t = hn::Load(d, some[3]);
    const M wanted = hn::AndNot(e.sky, hn::Gt(t, hn::Zero(d)));
    refiner_.take(pixel_ + k);
    M found = refiner_.refine(wanted, e.low, e.high, t);
    const M passed = hn::Not(hn::Or(found, hn::Or(e.sky, e.is_smooth)));
    // On rough ground the iteration may fail from between two samples. A sample's own facet faces the camera.
    const V starts[] = {hn::IfThenElse(e.is_smooth, e.near, e.between), e.far};
    for (const V& start : starts) {
      const M again = hn::And(e.is_close, hn::Not(hn::Or(found, e.sky)));
      if (hn::AllFalse(d, again)) break;
      V other = start;
      const M met = refiner_.refine(again, e.low, e.high, other);
      t = hn::IfThenElse(met, other, t);
      found = hn::Or(found, met);
    }
    // A ray that misses the nearer surface meets the farther one, unless that is the sky.
    const M missed = hn::Not(hn::Or(found, hn::Or(e.sky, e.is_close)));
    V seen = hn::IfThenElse(found, t, e.near);
    M done = hn::Or(found, e.sky);
    if (!hn::AllFalse(d, missed)) {
      const M open_sky = hn::And(missed, hn::Eq(e.far, inf));
      const M beyond = hn::AndNot(open_sky, missed);
      V behind = e.far;
      const V slack = hn::Mul(e.far, hn::Set(d, static_cast<float>(kApart)));
      const M met = refiner_.refine(beyond, hn::Sub(e.far, slack), hn::Add(e.far, slack), behind);
      seen = hn::IfThenElse(met, behind, hn::IfThenElse(open_sky, inf, seen));
      done = hn::Or(done, hn::Or(met, open_sky));
    }
    seen = refiner_.first_crests(hn::And(passed, done), e.near, seen);
    hn::Store(seen, d, some[0]);
    hn::Store(hn::IfThenElse(done, hn::Zero(d), hn::Set(d, 1.0F)), d, some[1]);
    for (int lane = 0; lane < used; ++lane) {
      range_[pixel_[k + lane]] = some[0][lane];
      if (some[1][lane] != 0) unresolved.push_back(first + pixel_[k + lane]);
    }
  }

  int count_;
  const float* a_;
  const float* b_;
  const float* share_;
  float* range_;
  PixelRefiner<RowRays> refiner_;
  alignas(64) int pixel_[kRowPixels + 16];  // that meet_first() did not find
  int open_count_ = 0;
};

void refine_row_kernel(const RayRow& row, const float* a, const float* b, const float* share,
                       FacetSource& source, FacetSource& exact_source, float* range,
                       std::vector<int>& unresolved) {
  for (int first = 0; first < row.count; first += kRowPixels) {
    RayRow some = row;
    some.first = row.first + static_cast<double>(first) * row.step;
    some.count = std::min(kRowPixels, row.count - first);
    RowPixels(some, a + first, b + first, share + first, source, exact_source, range + first)
        .refine(first, unresolved);
  }
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
