#include "vpe/warp/row_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vpe/core/frame.h"

// Highway compiles this file once for each instruction set and selects the best one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/warp/row_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "vpe/warp/colour_words-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace vpe::warp::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, RowBuffers::kPad>;
using Ints = hn::RebindToSigned<Floats>;
using Words = hn::RebindToUnsigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;
using WordVec = hn::Vec<Words>;

// Neighbours of which one is sky are a skyline. Its place between them is unknown, so each pixel takes the nearer one as
// long as they are hardly farther apart than in the first image.
constexpr float kMostPartedSkyline_px = 0.125F;

// Returns z times a polynomial in the square of radius z.
HWY_INLINE FloatVec times_even(const Scan& scan, FloatVec z, float second, float fourth, float sixth) {
  const Floats d;
  const FloatVec y = hn::Mul(hn::Set(d, scan.radius_m), z);
  const FloatVec square = hn::Mul(y, y);
  FloatVec sum = hn::Add(hn::Set(d, fourth), hn::Mul(square, hn::Set(d, sixth)));
  sum = hn::Add(hn::Set(d, second), hn::Mul(square, sum));
  return hn::Mul(z, hn::Add(hn::Set(d, 1.0F), hn::Mul(square, sum)));
}

// Return atan(radius z) / radius, and tan(radius z) / radius; within 1e-7 for radius z up to 0.14.
HWY_INLINE FloatVec round_of(const Scan& scan, FloatVec z) {
  return times_even(scan, z, -1.0F / 3, 1.0F / 5, -1.0F / 7);
}
HWY_INLINE FloatVec straight_of(const Scan& scan, FloatVec z) {
  return times_even(scan, z, 1.0F / 3, 2.0F / 15, 17.0F / 315);
}

// Finds the places of the first image's pixels.
HWY_INLINE void move_pixels(const Scan& scan, RowBuffers& row) {
  const Floats d;
  const Ints di;
  const FloatVec zero = hn::Zero(d);
  const FloatVec none = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  const FloatVec end = hn::Set(d, static_cast<float>(scan.count));
  const FloatVec base = hn::Set(d, scan.base_px_m);
  for (int i = 0; i < scan.count; i += static_cast<int>(hn::Lanes(d))) {
    const auto at = static_cast<std::size_t>(i);
    const FloatVec range = hn::LoadU(d, &row.range[at]);
    // No number where the range is none: neither that pixel nor what lies beside it is carried.
    const auto has_range = hn::Gt(range, zero);
    const FloatVec divisor = hn::IfThenElse(has_range, range, hn::Set(d, 1.0F));
    FloatVec inverse = hn::IfThenElse(has_range, hn::Div(hn::LoadU(d, &row.length[at]), divisor), none);
    if (scan.radius_m > 0) inverse = round_of(scan, inverse);
    const FloatVec still = hn::Add(hn::Iota(d, static_cast<float>(i) + 0.5F), hn::Set(d, scan.shift_px));
    const FloatVec place = hn::Sub(still, hn::Mul(base, inverse));
    // A pixel without a number comes after the end: the first comparison is false for it.
    const FloatVec from = hn::Sub(place, hn::Set(d, 0.5F));
    const FloatVec before_end = hn::IfThenElse(hn::Lt(from, end), from, end);
    const IntVec first = hn::ConvertTo(di, hn::Ceil(hn::Max(before_end, zero)));
    hn::StoreU(inverse, d, &row.inverse_depth[at]);
    hn::StoreU(place, d, &row.place[at]);
    hn::StoreU(first, di, &row.first[at]);
  }
}

// Finds for each pixel of the new image between which neighbours of the first one it lies.
HWY_INLINE void find_neighbours(const Scan& scan, RowBuffers& row) {
  const int n = scan.count;
  std::fill_n(row.left.begin(), n, -1);
  const float last = row.place[static_cast<std::size_t>(n - 1)];
  if (n < 2 || std::isnan(last)) return;
  // The last pixel has no neighbour beyond it: only a pixel at its very place shows it.
  const float reach = std::min(last + static_cast<float>(kCarriedPosition_px), scan.open_from);
  int end = static_cast<int>(std::ceil(std::clamp(reach - 0.5F, 0.0F, static_cast<float>(n))));
  int* const left = row.left.data();
  const int* const first = row.first.data();
  while (end > first[n - 1]) left[--end] = n - 2;
  // What lies behind the places that came before is hidden: no pixel is left for it.
  for (int i = n - 2; i >= 0; --i)
    while (end > first[i]) left[--end] = i;
}

// Makes a word of each colour, so that they can be gathered.
HWY_INLINE void widen_colours(const Scan& scan, RowBuffers& row) {
  const Words d;
  for (int i = 0; i < scan.count; i += static_cast<int>(hn::Lanes(d))) {
    const auto at = static_cast<std::size_t>(i);
    hn::StoreU(load_words(d, &row.colour[at]), d, &row.word[at]);
  }
}

HWY_INLINE float fill(const Scan& scan, RowBuffers& row, bool has_colour) {
  const Floats d;
  const Ints di;
  const hn::Rebind<std::uint8_t, Floats> d8;
  const FloatVec zero = hn::Zero(d);
  const FloatVec one = hn::Set(d, 1.0F);
  const FloatVec half = hn::Set(d, 0.5F);
  const IntVec no_pixel = hn::Set(di, -1);
  FloatVec added = zero;
  for (int k = 0; k < scan.count; k += static_cast<int>(hn::Lanes(d))) {
    const auto at = static_cast<std::size_t>(k);
    const IntVec found = hn::LoadU(di, &row.left[at]);
    const IntVec left = hn::Max(found, hn::Zero(di));
    const auto is_known = hn::RebindMask(d, hn::Gt(found, no_pixel));
    const FloatVec x = hn::GatherIndex(d, row.place.data(), left);
    const FloatVec width = hn::Sub(hn::GatherIndex(d, row.place.data() + 1, left), x);
    const FloatVec near = hn::GatherIndex(d, row.inverse_depth.data(), left);
    const FloatVec next = hn::GatherIndex(d, row.inverse_depth.data() + 1, left);
    const auto is_left_sky = hn::Eq(near, zero);
    const auto is_skyline = hn::Xor(is_left_sky, hn::Eq(next, zero));
    // How much farther than its neighbour a pixel moves.
    const FloatVec parted = hn::Abs(hn::Sub(width, one));
    const FloatVec most =
        hn::IfThenElse(is_skyline, hn::Set(d, kMostPartedSkyline_px), hn::Set(d, scan.most_parted_px));
    const auto is_carried = hn::And(is_known, hn::Le(parted, most));
    const FloatVec moved = hn::IfThenElse(hn::AndNot(is_skyline, is_left_sky), zero, parted);
    added = hn::Max(added, hn::IfThenElse(is_carried, moved, zero));

    const FloatVec centre = hn::Iota(d, static_cast<float>(k) + 0.5F);
    const FloatVec step = hn::IfThenElse(is_carried, width, one);
    FloatVec share = hn::Min(hn::Div(hn::Sub(centre, x), step), one);
    const FloatVec nearer = hn::Mul(hn::Min(share, hn::Sub(one, share)), step);
    const auto is_left = hn::Lt(share, half);
    share = hn::IfThenElse(is_skyline, hn::IfThenElse(is_left, zero, one), share);
    const auto is_sky = hn::Xor(is_left_sky, hn::AndNot(is_left, is_skyline));

    // Where the pixel is open: no nearer than the nearer neighbour, as silhouettes may reach a pixel farther than their last
    // sample. Numbers that are none are smaller than all others.
    const FloatVec mixed = hn::Add(near, hn::Mul(share, hn::Sub(next, near)));
    const FloatVec nearest = hn::IfThenElse(hn::Gt(next, near), next, near);
    FloatVec inverse = hn::IfThenElse(is_carried, mixed, hn::IfThenElse(is_known, nearest, zero));
    if (scan.radius_m > 0) inverse = straight_of(scan, inverse);
    const auto has_depth = hn::Gt(inverse, zero);
    const FloatVec divisor = hn::IfThenElse(has_depth, inverse, one);
    const FloatVec range = hn::Div(hn::LoadU(d, &row.new_length[at]), divisor);
    const FloatVec ground = hn::IfThenElse(is_sky, hn::Set(d, core::kSkyRange), range);
    hn::StoreU(hn::IfThenElse(is_carried, ground, hn::IfThenElseZero(has_depth, range)), d, &row.new_range[at]);

    const auto number = [&](Origin origin) HWY_ATTR { return hn::Set(d, static_cast<float>(origin)); };
    const FloatVec of_ground =
        hn::IfThenElse(hn::Le(nearer, half), number(Origin::kCarried), number(Origin::kBetween));
    const FloatVec origin = hn::IfThenElse(is_sky, number(Origin::kSky), of_ground);
    hn::StoreU(hn::DemoteTo(d8, hn::ConvertTo(di, hn::IfThenElse(is_carried, origin, number(Origin::kOpen)))),
               d8, reinterpret_cast<std::uint8_t*>(&row.origin[at]));
    if (!has_colour) continue;

    const FloatVec share_256 = scan.filters ? hn::Floor(hn::Add(hn::Mul(share, hn::Set(d, 256.0F)), half))
                                            : hn::IfThenElse(hn::Lt(share, half), zero, hn::Set(d, 256.0F));
    const Words dw;
    const WordVec own = hn::GatherIndex(dw, row.word.data(), left);
    const WordVec other = hn::GatherIndex(dw, row.word.data() + 1, left);
    // Any share where nothing is carried.
    const FloatVec used = hn::IfThenElseZero(is_carried, share_256);
    const WordVec colour = mix(dw, own, other, hn::BitCast(dw, hn::ConvertTo(di, used)));
    store_words(dw, hn::IfThenElseZero(hn::RebindMask(dw, is_carried), colour), &row.new_colour[at]);
  }
  return hn::GetLane(hn::MaxOfLanes(d, added));
}

float carry_row_kernel(const Scan& scan, RowBuffers& row, bool has_colour) {
  move_pixels(scan, row);
  if (has_colour) widen_colours(scan, row);
  find_neighbours(scan, row);
  return fill(scan, row, has_colour);
}

}  // namespace
}  // namespace vpe::warp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::warp {

HWY_EXPORT(carry_row_kernel);

RowBuffers::RowBuffers(const Scan& scan) {
  const std::size_t size = static_cast<std::size_t>(scan.count) + kPad;
  for (std::vector<float>* member : {&length, &new_length, &range, &new_range, &inverse_depth, &place})
    member->resize(size);
  for (std::vector<base::Rgb>* member : {&colour, &new_colour}) member->resize(size);
  word.resize(size);
  first.resize(size);
  left.resize(size, -1);
  origin.resize(size);
}

float carry_row(const Scan& scan, RowBuffers& row, bool has_colour) {
  return HWY_DYNAMIC_DISPATCH(carry_row_kernel)(scan, row, has_colour);
}

}  // namespace vpe::warp
#endif
