#include "vpe/map/viewshed/fan_kernel.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "vpe/map/viewshed/rise.h"

// Highway compiles this file once for each instruction set and selects the best one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/map/viewshed/fan_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace vpe::map::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Posts so many rays apart have their rays in two vectors of them.
constexpr float kMostStepOfTwoVectors = 1.99F;

using Floats = hn::CappedTag<float, RayFan::kPad>;
using Ints = hn::RebindToSigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;

void raise_kernel(const RingCrossing& c, RayFan& fan) {
  const Floats d;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const float* HWY_RESTRICT rises = fan.rises_m.data();
  // From the same post on as the ring's own.
  const float* HWY_RESTRICT before = fan.rises_before_m.data() + c.shift_before;
  const FloatVec ring = hn::Set(d, static_cast<float>(c.ring));
  const FloatVec last_ring = hn::Set(d, static_cast<float>(c.ring - 1));
  const FloatVec ring_inverse = hn::Set(d, 1.0F / static_cast<float>(c.ring));
  const FloatVec one = hn::Set(d, 1.0F);
  const IntVec last_lane = hn::Set(di, lanes - 1);
  for (int ray = 0; ray < c.rays; ray += lanes) {
    const auto at = static_cast<std::size_t>(ray);
    const FloatVec place =
        hn::Add(hn::Set(d, c.start), hn::Mul(hn::Iota(d, static_cast<float>(ray)), hn::Set(d, c.step)));
    // Neighbouring rays are at most a post apart: the posts of a vector of rays lie in one vector from the first.
    const float first_place = c.start + static_cast<float>(ray) * c.step;
    const auto first = static_cast<std::size_t>(first_place);
    const FloatVec first_post = hn::Set(d, static_cast<float>(first));
    const IntVec post = hn::Min(hn::ConvertTo(di, hn::Sub(place, first_post)), last_lane);
    const FloatVec part = hn::Sub(hn::Sub(place, first_post), hn::ConvertTo(d, post));
    const auto lookup = hn::IndicesFromVec(d, post);
    const FloatVec left = hn::TableLookupLanes(hn::LoadU(d, rises + first), lookup);
    const FloatVec right = hn::TableLookupLanes(hn::LoadU(d, rises + first + 1), lookup);
    FloatVec horizon = hn::LoadU(d, &fan.horizon[at]);
    FloatVec ridge = hn::LoadU(d, &fan.ridge[at]);

    const FloatVec slope = hn::LoadU(d, &fan.slope[at]);
    const auto crosses = hn::Lt(part, slope);
    if (c.ring > 1 && !hn::AllFalse(d, crosses)) {
      // The ray crosses the line of `post` before the ring, at this share of the way from ring to ring.
      const FloatVec share = hn::Sub(one, hn::Mul(part, hn::LoadU(d, &fan.slope_inverse[at])));
      const FloatVec nearer = hn::TableLookupLanes(hn::LoadU(d, before + first), lookup);
      const FloatVec rise = hn::Add(nearer, hn::Mul(share, hn::Sub(left, nearer)));
      const FloatVec tangent = hn::Div(rise, hn::Add(last_ring, share));
      const auto rises_over = hn::And(crosses, hn::Gt(tangent, horizon));
      horizon = hn::IfThenElse(rises_over, tangent, horizon);
      const FloatVec row = hn::Add(hn::ConvertTo(d, post),
                                   hn::Set(d, static_cast<float>(c.first_post + static_cast<int>(first))));
      ridge = hn::IfThenElse(rises_over, hn::Neg(row), ridge);
    }

    const FloatVec rise = hn::Add(left, hn::Mul(part, hn::Sub(right, left)));
    const FloatVec tangent = hn::Mul(rise, ring_inverse);
    const auto rises_over = hn::Gt(tangent, horizon);
    hn::StoreU(hn::IfThenElse(rises_over, tangent, horizon), d, &fan.horizon[at]);
    hn::StoreU(hn::IfThenElse(rises_over, ring, ridge), d, &fan.ridge[at]);
  }
}

HWY_INLINE void store_sights(FloatVec target, FloatVec needed, Sight* sights) {
  const Floats d;
  const Ints di;
  const hn::Rebind<std::uint8_t, Floats> d8;
  const auto number = [&](Sight sight) HWY_ATTR { return hn::Set(di, static_cast<int>(sight)); };
  const IntVec known =
      hn::IfThenElse(hn::RebindMask(di, hn::Ge(target, needed)), number(Sight::seen), number(Sight::hidden));
  const auto is_unknown = hn::RebindMask(di, hn::Eq(target, hn::Set(d, kNoRise)));
  hn::StoreU(hn::DemoteTo(d8, hn::IfThenElse(is_unknown, number(Sight::unknown), known)), d8,
             reinterpret_cast<std::uint8_t*>(sights));
}

// Horizons of the rays on both sides of posts. Vectors are not gathered from memory: processors that guard against leaks by
// that take very long for it.
struct Sides {
  FloatVec left;
  FloatVec right;
};

HWY_INLINE Sides sides_one_by_one(const float* horizon, IntVec ray) {
  const Floats d;
  const Ints di;
  alignas(64) std::int32_t rays[RayFan::kPad];
  alignas(64) float pairs[2 * RayFan::kPad];
  hn::Store(ray, di, rays);
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane)
    std::memcpy(&pairs[2 * lane], horizon + rays[lane], 2 * sizeof(float));
  Sides sides;
  hn::LoadInterleaved2(d, pairs, sides.left, sides.right);
  return sides;
}

// Takes horizons from two vectors that begin with that of the ray `first`.
HWY_INLINE Sides sides_of_two_vectors(const float* horizon, IntVec ray, int first) {
  const Floats d;
  const Ints di;
  const std::size_t lanes = hn::Lanes(d);
  const IntVec entry = hn::Sub(ray, hn::Set(di, first));
  const IntVec beyond = hn::Set(di, static_cast<int>(lanes));
  const auto in_second = hn::RebindMask(d, hn::Gt(entry, hn::Sub(beyond, hn::Set(di, 1))));
  const auto lookup = hn::IndicesFromVec(d, hn::And(entry, hn::Set(di, static_cast<int>(lanes) - 1)));
  const auto taken = [&](const float* from) HWY_ATTR {
    return hn::IfThenElse(in_second, hn::TableLookupLanes(hn::LoadU(d, from + lanes), lookup),
                          hn::TableLookupLanes(hn::LoadU(d, from), lookup));
  };
  return {taken(horizon + first), taken(horizon + first + 1)};
}

int judge_kernel(const RingPosts& p, float doubt, RayFan& fan) {
  const Floats d;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const float* HWY_RESTRICT horizon = fan.horizon.data();
  const IntVec last = hn::Set(di, p.rays - 2);
  const FloatVec distance = hn::Set(d, static_cast<float>(p.ring));
  const FloatVec doubted = hn::Set(d, static_cast<float>(p.ring) * doubt);
  const IntVec end = hn::Set(di, p.posts);
  const bool is_dense = p.step < kMostStepOfTwoVectors;
  std::size_t found = 0;
  for (int n = 0; n < p.posts; n += lanes) {
    const auto at = static_cast<std::size_t>(p.first + n);
    const FloatVec place =
        hn::Add(hn::Set(d, p.start), hn::Mul(hn::Iota(d, static_cast<float>(n)), hn::Set(d, p.step)));
    const IntVec ray = hn::Min(hn::ConvertTo(di, place), last);
    const FloatVec part = hn::Sub(place, hn::ConvertTo(d, ray));
    const Sides sides =
        is_dense ? sides_of_two_vectors(horizon, ray, hn::GetLane(ray)) : sides_one_by_one(horizon, ray);
    const FloatVec difference = hn::Sub(sides.right, sides.left);
    const FloatVec needed = hn::Mul(distance, hn::Add(sides.left, hn::Mul(part, difference)));
    const FloatVec target = hn::LoadU(d, p.targets_m + at);
    hn::StoreU(needed, d, &fan.needed_m[at]);
    store_sights(target, needed, &fan.sights[at]);
    const IntVec number = hn::Iota(di, n);
    const FloatVec middle =
        hn::Mul(hn::Set(d, 0.5F * static_cast<float>(p.ring)), hn::Add(sides.left, sides.right));
    const auto near = hn::Lt(hn::Abs(hn::Sub(target, middle)), hn::Mul(doubted, hn::Abs(difference)));
    const auto in_doubt = hn::And(hn::RebindMask(di, near), hn::Lt(number, end));
    found += hn::CompressStore(number, in_doubt, di, fan.doubts.data() + found);
  }
  return static_cast<int>(found);
}

}  // namespace
}  // namespace vpe::map::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::map {

HWY_EXPORT(raise_kernel);
HWY_EXPORT(judge_kernel);

void raise_horizons(const RingCrossing& crossing, RayFan& fan) {
  HWY_DYNAMIC_DISPATCH(raise_kernel)(crossing, fan);
}

int judge_posts(const RingPosts& posts, float doubt, RayFan& fan) {
  return HWY_DYNAMIC_DISPATCH(judge_kernel)(posts, doubt, fan);
}

}  // namespace vpe::map
#endif
