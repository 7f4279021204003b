#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <limits>

#include "vpe/voxel/columns/refine.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/voxel/columns/refine_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

#include "vpe/voxel/columns/refine_facets-inl.h"
#include "vpe/voxel/columns/refine_hints-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Hints that differ by more than this share of the nearer one belong to different surfaces.
constexpr double kApart = 0.04;
// Between hints that differ by more than this there may be a crest, with ground behind it that is as well between them.
constexpr double kMaybeCrest = 0.003;

using FloatTag = hn::CappedTag<float, 16>;
using DoubleTag = hn::CappedTag<double, 8>;

// Refines a vector of floats over height grids of both precisions.
class PixelRefiner {
 public:
  using V = hn::Vec<FloatTag>;
  using M = hn::Mask<FloatTag>;

  PixelRefiner(const RayRow& row, FacetSource& source, FacetSource& exact_source)
      : floats_(row, source), doubles_(row, exact_source) {}

  void set_rays(int k) {
    first_ = k;
    floats_.set_rays(k);
  }

  M refine(M todo, V low, V high, V& t) {
    const FloatTag d;
    const M found = floats_.refine(todo, low, high, t);
    const M left = floats_.other_kind();
    if (HWY_LIKELY(hn::AllFalse(d, left))) return found;
    const DoubleTag dd;
    alignas(64) float marks[16];
    alignas(64) float lows[16];
    alignas(64) float highs[16];
    alignas(64) float ts[16];
    const V one = hn::Set(d, 1.0F);
    const V zero = hn::Zero(d);
    hn::Store(hn::IfThenElse(left, one, zero), d, marks);
    hn::Store(low, d, lows);
    hn::Store(high, d, highs);
    hn::Store(t, d, ts);
    const std::size_t step = hn::Lanes(dd);
    alignas(64) double part[4][8];
    for (std::size_t lane = 0; lane < hn::Lanes(d); lane += step) {
      for (std::size_t k = 0; k < step; ++k) {
        part[0][k] = static_cast<double>(marks[lane + k]);
        part[1][k] = static_cast<double>(lows[lane + k]);
        part[2][k] = static_cast<double>(highs[lane + k]);
        part[3][k] = static_cast<double>(ts[lane + k]);
      }
      const auto wanted = hn::Gt(hn::Load(dd, part[0]), hn::Zero(dd));
      if (hn::AllFalse(dd, wanted)) continue;
      doubles_.set_rays(first_ + static_cast<int>(lane));
      auto at = hn::Load(dd, part[3]);
      const auto met = doubles_.refine(wanted, hn::Load(dd, part[1]), hn::Load(dd, part[2]), at);
      hn::Store(at, dd, part[3]);
      hn::Store(hn::IfThenElse(met, hn::Set(dd, 2.0), hn::Load(dd, part[0])), dd, part[0]);
      for (std::size_t k = 0; k < step; ++k) {
        marks[lane + k] = static_cast<float>(part[0][k]);
        if (marks[lane + k] == 2.0F) ts[lane + k] = static_cast<float>(part[3][k]);
      }
    }
    t = hn::Load(d, ts);
    return hn::Or(found, hn::Eq(hn::Load(d, marks), hn::Set(d, 2.0F)));
  }

  // Returns the ranges of the lanes in `todo` as RowRefiner::first_crest() does, and those of the others as they are. set_rays() must
  // follow.
  V first_crests(M todo, V near, V range) {
    const FloatTag d;
    alignas(64) float marks[16];
    alignas(64) float nears[16];
    alignas(64) float ranges[16];
    hn::Store(hn::IfThenElse(todo, hn::Set(d, 1.0F), hn::Zero(d)), d, marks);
    hn::Store(near, d, nears);
    hn::Store(range, d, ranges);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      if (marks[lane] == 0) continue;
      ranges[lane] = floats_.first_crest(lane, nears[lane], ranges[lane]);
      if (HWY_LIKELY(!floats_.passed_other_kind())) continue;
      doubles_.set_rays(first_ + static_cast<int>(lane));
      ranges[lane] = static_cast<float>(
          doubles_.first_crest(0, static_cast<double>(nears[lane]), static_cast<double>(ranges[lane])));
    }
    return hn::Load(d, ranges);
  }

 private:
  int first_ = 0;
  RowRefiner<FloatTag> floats_;
  RowRefiner<DoubleTag> doubles_;
};

void refine_row_kernel(const RayRow& row, const float* a, const float* b, const float* share,
                       FacetSource& source, FacetSource& exact_source, float* range,
                       std::vector<int>& unresolved) {
  const FloatTag d;
  using V = hn::Vec<FloatTag>;
  using M = hn::Mask<FloatTag>;
  const int lanes = static_cast<int>(hn::Lanes(d));
  PixelRefiner refiner(row, source, exact_source);
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0F);
  const V inf = hn::Set(d, std::numeric_limits<float>::infinity());
  const V apart = hn::Set(d, static_cast<float>(kApart));
  const V maybe_crest = hn::Set(d, static_cast<float>(kMaybeCrest));
  alignas(64) float some[3][16];
  for (int k = 0; k < row.count; k += lanes) {
    const int used = std::min(lanes, row.count - k);
    const auto load = [&](const float* from, float* room, float rest) {
      if (used == lanes) return hn::LoadU(d, from + k);
      std::fill_n(room, lanes, rest);
      std::copy_n(from + k, used, room);
      return hn::Load(d, room);
    };
    const V ha = load(a, some[0], std::numeric_limits<float>::infinity());
    const V hb = load(b, some[1], std::numeric_limits<float>::infinity());
    const V part = load(share, some[2], 0.0F);
    const V near = hn::Min(ha, hb);
    const V far = hn::Max(ha, hb);
    const M sky = hn::Eq(near, inf);
    if (hn::AllTrue(d, sky)) {
      std::fill_n(range + k, used, std::numeric_limits<float>::infinity());
      continue;
    }
    refiner.set_rays(k);
    const V reach = hn::Mul(near, apart);
    const V gap = hn::Sub(far, near);
    const M close = hn::Le(gap, reach);
    const M smooth = hn::Le(gap, hn::Mul(near, maybe_crest));
    // On one facet the inverse range changes almost linearly from sample to sample.
    const V inverse = hn::MulAdd(part, hn::Sub(hn::Div(one, hb), hn::Div(one, ha)), hn::Div(one, ha));
    const V between = hn::Div(one, inverse);
    // Between two surfaces the nearer one comes first.
    V t = hn::IfThenElse(smooth, between, near);
    const V low = hn::Sub(near, reach);
    const V high = hn::IfThenElse(close, hn::Add(far, reach), hn::Add(near, reach));
    M found = refiner.refine(hn::Not(sky), low, high, t);
    const M passed = hn::Not(hn::Or(found, hn::Or(sky, smooth)));
    // On rough ground the iteration may fail from between two samples. A sample's own facet faces the camera.
    const V starts[] = {hn::IfThenElse(smooth, near, between), far};
    for (const V& start : starts) {
      const M again = hn::And(close, hn::Not(hn::Or(found, sky)));
      if (hn::AllFalse(d, again)) break;
      V other = start;
      const M met = refiner.refine(again, low, high, other);
      t = hn::IfThenElse(met, other, t);
      found = hn::Or(found, met);
    }
    // A ray that misses the nearer surface meets the farther one, unless that is the sky.
    const M missed = hn::Not(hn::Or(found, hn::Or(sky, close)));
    V seen = hn::IfThenElse(found, t, near);
    M done = hn::Or(found, sky);
    if (!hn::AllFalse(d, missed)) {
      const M open_sky = hn::And(missed, hn::Eq(far, inf));
      const M beyond = hn::AndNot(open_sky, missed);
      V behind = far;
      const V slack = hn::Mul(far, apart);
      const M met = refiner.refine(beyond, hn::Sub(far, slack), hn::Add(far, slack), behind);
      seen = hn::IfThenElse(met, behind, hn::IfThenElse(open_sky, inf, seen));
      done = hn::Or(done, hn::Or(met, open_sky));
    }
    const M crest = hn::And(passed, done);
    if (!hn::AllFalse(d, crest)) seen = refiner.first_crests(crest, near, seen);
    if (used == lanes) {
      hn::StoreU(seen, d, range + k);
    } else {
      hn::Store(seen, d, some[0]);
      std::copy_n(some[0], used, range + k);
    }
    if (!hn::AllTrue(d, done)) {
      hn::Store(hn::IfThenElse(done, zero, one), d, some[0]);
      for (int lane = 0; lane < used; ++lane) {
        if (some[0][lane] != 0) unresolved.push_back(k + lane);
      }
    }
  }
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::voxel {

HWY_EXPORT(refine_row_kernel);
HWY_EXPORT(hints_from_row_kernel);
HWY_EXPORT(hints_from_columns_kernel);

void refine_row(const RayRow& row, const float* a, const float* b, const float* share, FacetSource& source,
                FacetSource& exact_source, float* range, std::vector<int>& unresolved) {
  HWY_DYNAMIC_DISPATCH(refine_row_kernel)(row, a, b, share, source, exact_source, range, unresolved);
}
void hints_from_row(const float* samples, int sample_count, double first, double step, int count, float* a,
                    float* b, float* share) {
  HWY_DYNAMIC_DISPATCH(hints_from_row_kernel)(samples, sample_count, first, step, count, a, b, share);
}
void hints_from_columns(const float* samples, int lines, const float* scale, const float* shift, float y,
                        int count, float* a, float* b, float* share) {
  HWY_DYNAMIC_DISPATCH(hints_from_columns_kernel)(samples, lines, scale, shift, y, count, a, b, share);
}

}  // namespace vpe::voxel
#endif
