// Refines vectors of pixels over height grids of both precisions.
//
// Part of refine_kernel.cpp and round_refine_kernel.cpp.
#if defined(VPE_VOXEL_PIXEL_REFINER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_PIXEL_REFINER_INL_H_
#undef VPE_VOXEL_PIXEL_REFINER_INL_H_
#else
#define VPE_VOXEL_PIXEL_REFINER_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "vpe/voxel/columns/crest_search-inl.h"
#include "vpe/voxel/columns/facet_refiner-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;
using DoubleTag = hn::CappedTag<double, 8>;

// Lanes are pixels, in float; those over grids of doubles are refined in double.
template <template <class> class Rays>
class PixelRefiner {
 public:
  using V = hn::Vec<FloatTag>;
  using M = hn::Mask<FloatTag>;
  using Row = typename Rays<FloatTag>::Source;

  PixelRefiner(const Row& row, FacetSource& source, FacetSource& exact_source)
      : floats_(row, source), doubles_(row, exact_source), crests_(floats_), exact_crests_(doubles_) {}

  // Takes the rays of pixels, one for each lane, which must outlive their use.
  void take(const int* pixels) {
    pixels_ = pixels;
    floats_.take(pixels);
  }

  // Takes the rays of pixels k, k + 1, ..., for meet_once() alone.
  void take_from(int k) { floats_.take_from(k); }

  // Does what FacetRefiner::meet_once() does; refine() serves for the lanes over grids of doubles too.
  M meet_once(M todo, V low, V high, V& t, M& dropped, M& other_kind) {
    return floats_.meet_once(todo, low, high, t, dropped, other_kind);
  }

  // Does what FacetRefiner::meet_each() does.
  M meet_each(M todo, V low, V high, V& t, M& dropped, M& other_kind) {
    return floats_.meet_each(todo, low, high, t, dropped, other_kind);
  }

  // Selects the height grid that the ray of a pixel is over at a range.
  void select_grid_of(int pixel, float range_m) {
    const int only[kRoom] = {pixel};
    floats_.leave_grid();
    take(only);
    floats_.select_grid(0, range_m);
  }
  // Takes the rays of pixels, one for each lane, and returns numbers of the grids below their places t: numbers of one row after the
  // other, `side` a row, if the selected grid is in the middle and all are as large as that.
  hn::Vec<hn::RebindToSigned<FloatTag>> grids_at(const int* pixels, V t, int side) {
    take(pixels);
    return floats_.grids_at(t, side);
  }

  // Forgets the height grid at hand, so that what follows does not depend on the pixels before.
  void leave_grid() { floats_.leave_grid(); }

  // Replaces the estimates t of the lanes in `todo` by their ranges, where these are within [low, high]. Returns the lanes that were
  // found.
  M refine(M todo, V low, V high, V& t) {
    const FloatTag d;
    if (hn::AllFalse(d, todo)) return todo;
    const M found = floats_.refine(todo, low, high, t);
    const M left = floats_.other_kind();
    if (HWY_LIKELY(hn::AllFalse(d, left))) return found;
    return hn::Or(found, refine_exactly(left, low, high, t));
  }

  // Returns the ranges of the lanes in `todo` as CrestSearch::first_crest() does, and those of the others as they are.
  V first_crests(M todo, V near, V range) {
    const FloatTag d;
    if (hn::AllFalse(d, todo)) return range;
    alignas(64) float marks[16];
    alignas(64) float nears[16];
    alignas(64) float ranges[16];
    hn::Store(hn::IfThenElse(todo, hn::Set(d, 1.0F), hn::Zero(d)), d, marks);
    hn::Store(near, d, nears);
    hn::Store(range, d, ranges);
    const std::size_t step = hn::Lanes(DoubleTag());
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      if (marks[lane] == 0) continue;
      ranges[lane] = crests_.first_crest(lane, nears[lane], ranges[lane]);
      if (HWY_LIKELY(!crests_.passed_other_kind())) continue;
      doubles_.take(pixels_ + lane / step * step);
      ranges[lane] = static_cast<float>(exact_crests_.first_crest(lane % step, static_cast<double>(nears[lane]),
                                                                  static_cast<double>(ranges[lane])));
    }
    return hn::Load(d, ranges);
  }

 private:
  M refine_exactly(M todo, V low, V high, V& t) {
    const FloatTag d;
    const DoubleTag dd;
    const hn::Rebind<float, DoubleTag> df;
    alignas(64) float marks[16];
    alignas(64) float lows[16];
    alignas(64) float highs[16];
    alignas(64) float ts[16];
    hn::Store(hn::IfThenElse(todo, hn::Set(d, 1.0F), hn::Zero(d)), d, marks);
    hn::Store(low, d, lows);
    hn::Store(high, d, highs);
    hn::Store(t, d, ts);
    for (std::size_t lane = 0; lane < hn::Lanes(d); lane += hn::Lanes(dd)) {
      const auto load = [&](const float* from) { return hn::PromoteTo(dd, hn::LoadU(df, from + lane)); };
      const auto wanted = hn::Gt(load(marks), hn::Zero(dd));
      auto found = wanted;
      if (!hn::AllFalse(dd, wanted)) {
        doubles_.take(pixels_ + lane);
        auto at = load(ts);
        found = doubles_.refine(wanted, load(lows), load(highs), at);
        hn::StoreU(hn::DemoteTo(df, hn::IfThenElse(found, at, load(ts))), df, ts + lane);
      }
      hn::StoreU(hn::DemoteTo(df, hn::IfThenElse(found, hn::Set(dd, 1.0), hn::Zero(dd))), df, marks + lane);
    }
    t = hn::Load(d, ts);
    return hn::Gt(hn::Load(d, marks), hn::Zero(d));
  }

  static constexpr std::size_t kRoom = 16;
  const int* pixels_ = nullptr;  // of the lanes
  FacetRefiner<FloatTag, Rays> floats_;
  FacetRefiner<DoubleTag, Rays> doubles_;
  CrestSearch<FloatTag, Rays> crests_;
  CrestSearch<DoubleTag, Rays> exact_crests_;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
