#include "vpe/warp/block_kernel.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "vpe/core/frame.h"
#include "vpe/warp/cubic_taps.h"

// Highway compiles this file once for each instruction set and selects the best one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/warp/block_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "vpe/warp/colour_words-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace vpe::warp::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kVectorPad>;
using Ints = hn::RebindToSigned<Floats>;
using Words = hn::RebindToUnsigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;
using WordVec = hn::Vec<Words>;

// Inverse depths beyond this, 1 / m, are none.
constexpr float kMostInverseDepth = 1e9F;

DepthRest rest_kernel(const float* depth, std::size_t stride, int columns, int rows, const DepthPlane& plane) {
  const Floats d;
  const FloatVec zero = hn::Zero(d);
  const FloatVec step = hn::Set(d, plane.by_column);
  const FloatVec most = hn::Set(d, kMostInverseDepth);
  FloatVec least = most;
  FloatVec largest = zero;
  FloatVec rest = zero;
  auto all = hn::Eq(zero, zero);
  for (int y = 0; y < rows; ++y) {
    const float* const row = depth + static_cast<std::size_t>(y) * stride;
    const FloatVec first = hn::Set(d, plane.at_first + plane.by_row * static_cast<float>(y));
    for (int x = 0; x < columns; x += static_cast<int>(hn::Lanes(d))) {
      const FloatVec column = hn::Iota(d, static_cast<float>(x));
      const auto counts = hn::Lt(column, hn::Set(d, static_cast<float>(columns)));
      const FloatVec expected = hn::Add(first, hn::Mul(step, column));
      const FloatVec is = hn::IfThenElse(counts, hn::LoadU(d, row + x), expected);
      all = hn::And(all, hn::Or(hn::Not(counts), hn::And(hn::Ge(is, zero), hn::Lt(is, most))));
      least = hn::Min(least, hn::IfThenElse(counts, is, most));
      largest = hn::Max(largest, hn::IfThenElseZero(counts, is));
      rest = hn::Max(rest, hn::Abs(hn::Sub(is, expected)));
    }
  }
  if (!hn::AllTrue(d, all)) return {0, 0, std::numeric_limits<float>::infinity()};
  return {hn::GetLane(hn::MinOfLanes(d, least)), hn::GetLane(hn::MaxOfLanes(d, largest)),
          hn::GetLane(hn::MaxOfLanes(d, rest))};
}

void draw_block_kernel(const FlatBlock& block, Hits& hits) {
  const Floats d;
  const Ints di;
  const auto set = [&](float value) HWY_ATTR { return hn::Set(d, value); };
  const FloatVec zero = hn::Zero(d);
  const FloatVec low = set(-block.margin);
  const FloatVec width = set(block.size.x + block.margin);
  const FloatVec height = set(block.size.y + block.margin);
  const IntVec carried = hn::Set(di, block.is_sky ? kFlatSky : kFlatCarried);
  const IntVec between = hn::Set(di, block.is_sky ? kFlatSky : kFlatBetween);
  const int end_row = std::min(block.end.y, hits.end_row);
  for (int y = std::max(block.low.y, hits.first_row); y < end_row; ++y) {
    const float down = static_cast<float>(y - block.origin.y) + 0.5F;
    const auto at_row = [&](const Linear& value) HWY_ATTR { return set(value.y * down + value.at_origin); };
    const FloatVec column_row = at_row(block.column);
    const FloatVec row_row = at_row(block.row);
    const FloatVec divisor_row = at_row(block.divisor);
    const FloatVec depth_row = at_row(block.inverse_depth);
    for (int x = block.low.x; x < block.end.x; x += static_cast<int>(hn::Lanes(d))) {
      const FloatVec across = hn::Iota(d, static_cast<float>(x - block.origin.x) + 0.5F);
      const auto at = [&](const Linear& value, FloatVec row)
                          HWY_ATTR { return hn::Add(row, hn::Mul(set(value.x), across)); };
      const FloatVec divisor = at(block.divisor, divisor_row);
      const FloatVec inverse = hn::Div(set(1.0F), divisor);
      const FloatVec column = hn::Mul(at(block.column, column_row), inverse);
      const FloatVec row = hn::Mul(at(block.row, row_row), inverse);
      const auto within_column = hn::And(hn::Ge(column, low), hn::Le(column, width));
      const auto within_row = hn::And(hn::Ge(row, low), hn::Le(row, height));
      const auto is_within = hn::And(hn::Gt(divisor, zero), hn::And(within_column, within_row));
      const FloatVec depth = hn::Max(at(block.inverse_depth, depth_row), zero);
      const std::size_t n = hits.index(x, y);
      const auto is_shown = hn::And(is_within, hn::Gt(depth, hn::LoadU(d, &hits.inverse_depth[n])));
      if (hn::AllFalse(d, is_shown)) continue;
      const FloatVec aside = hn::Sub(column, hn::Round(column));
      const FloatVec below = hn::Sub(row, hn::Round(row));
      const auto off = [&](float by_column, float by_row) HWY_ATTR {
        return hn::Abs(hn::Add(hn::Mul(set(by_column), aside), hn::Mul(set(by_row), below)));
      };
      const FloatVec nearest =
          hn::Max(off(block.column_step.x, block.row_step.x), off(block.column_step.y, block.row_step.y));
      const auto is_carried = hn::RebindMask(di, hn::Le(nearest, set(0.5F)));
      hn::BlendedStore(depth, is_shown, d, &hits.inverse_depth[n]);
      hn::BlendedStore(hn::Add(column, set(static_cast<float>(block.first.x))), is_shown, d, &hits.u[n]);
      hn::BlendedStore(hn::Add(row, set(static_cast<float>(block.first.y))), is_shown, d, &hits.v[n]);
      hn::BlendedStore(hn::IfThenElse(is_carried, carried, between), hn::RebindMask(di, is_shown), di,
                       &hits.half[n]);
    }
  }
}

void invert_kernel(std::span<const float> range_m, std::span<float> length) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const auto inverse = [&](FloatVec range, FloatVec of) HWY_ATTR {
    const auto has_range = hn::Gt(range, hn::Zero(d));
    const FloatVec none = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
    return hn::IfThenElse(has_range, hn::Div(of, hn::IfThenElse(has_range, range, hn::Set(d, 1.0F))), none);
  };
  std::size_t n = 0;
  for (; n + lanes <= length.size(); n += lanes)
    hn::StoreU(inverse(hn::LoadU(d, &range_m[n]), hn::LoadU(d, &length[n])), d, &length[n]);
  for (; n < length.size(); ++n)
    length[n] = hn::GetLane(inverse(hn::Set(d, range_m[n]), hn::Set(d, length[n])));
}

void widen_kernel(std::span<const base::Rgb> colour, std::uint32_t* words) {
  const Words d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t n = 0;
  for (; n + lanes <= colour.size(); n += lanes) hn::StoreU(load_words(d, &colour[n]), d, words + n);
  for (; n < colour.size(); ++n)
    words[n] = static_cast<std::uint32_t>(colour[n].r) | static_cast<std::uint32_t>(colour[n].g) << 8U |
               static_cast<std::uint32_t>(colour[n].b) << 16U;
}

// Splits places along a side into the first of the two pixels that they lie between, and 64ths of the way to the other.
HWY_INLINE void split(FloatVec place, int size, bool filters, std::int32_t* first, std::int32_t* share_64) {
  const Floats d;
  const Ints di;
  const FloatVec last = hn::Set(d, static_cast<float>(size - 1));
  const FloatVec clamped = hn::Min(hn::Max(place, hn::Zero(d)), last);
  const IntVec pixel = hn::Min(hn::ConvertTo(di, hn::Floor(clamped)), hn::Set(di, size - 2));
  const FloatVec share = hn::Sub(clamped, hn::ConvertTo(d, pixel));
  const FloatVec in_64 = filters ? hn::Floor(hn::Add(hn::Mul(share, hn::Set(d, 64.0F)), hn::Set(d, 0.5F)))
                                 : hn::IfThenElseZero(hn::Ge(share, hn::Set(d, 0.5F)), hn::Set(d, 64.0F));
  hn::StoreU(pixel, di, first);
  hn::StoreU(hn::ConvertTo(di, in_64), di, share_64);
}

// Returns the colour of four by four pixels from `word` on, by weights in 64ths: within a step of 8 bits. `across` holds
// each of the four weights four times, once for each byte of a word.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE std::uint32_t mixed_pixels(const std::uint32_t* word, std::size_t stride, const std::int16_t* across,
                                      const std::int16_t* down) {
  std::uint32_t colour = 0;
  for (unsigned byte = 0; byte < 32; byte += 8) {
    int sum = 32;
    for (std::size_t column = 0; column < 4; ++column) {
      int of_column = 32;
      for (std::size_t row = 0; row < 4; ++row)
        of_column += static_cast<int>(word[row * stride + column] >> byte & 0xFFU) * down[row];
      sum += (of_column >> 6) * across[4 * column];
    }
    colour |= static_cast<std::uint32_t>(std::clamp(sum >> 6, 0, 255)) << byte;
  }
  return colour;
}
#else
HWY_INLINE std::uint32_t mixed_pixels(const std::uint32_t* word, std::size_t stride, const std::int16_t* across,
                                      const std::int16_t* down) {
  const hn::FixedTag<std::uint8_t, 16> d8;
  const hn::FixedTag<std::int16_t, 8> d16;
  const hn::FixedTag<std::uint8_t, 8> half8;
  auto left = hn::Set(d16, 32);
  auto right = left;
  for (std::size_t row = 0; row < 4; ++row) {
    const auto four = hn::LoadU(d8, reinterpret_cast<const std::uint8_t*>(word + row * stride));
    const auto weight = hn::Set(d16, down[row]);
    left = hn::Add(left, hn::Mul(hn::PromoteTo(d16, hn::LowerHalf(half8, four)), weight));
    right = hn::Add(right, hn::Mul(hn::PromoteTo(d16, hn::UpperHalf(half8, four)), weight));
  }
  left = hn::Mul(hn::ShiftRight<6>(left), hn::LoadU(d16, across));
  right = hn::Mul(hn::ShiftRight<6>(right), hn::LoadU(d16, across + 8));
  const auto pairs = hn::Add(left, right);
  const auto sum = hn::Add(hn::Add(pairs, hn::ShiftRightBytes<8>(d16, pairs)), hn::Set(d16, 32));
  const auto bytes = hn::DemoteTo(half8, hn::ShiftRight<6>(sum));
  std::uint8_t out[8];
  hn::StoreU(bytes, half8, out);
  std::uint32_t colour = 0;
  std::memcpy(&colour, out, sizeof colour);
  return colour;
}
#endif

// Returns the colours at places of an image, for the lanes that are wanted.
HWY_INLINE WordVec colours_at(const MixedImage& image, FloatVec u, FloatVec v, std::uint32_t wanted) {
  static const TapTable taps;
  const Words dw;
  HWY_ALIGN std::int32_t column[kVectorPad];
  HWY_ALIGN std::int32_t across[kVectorPad];
  HWY_ALIGN std::int32_t row[kVectorPad];
  HWY_ALIGN std::int32_t down[kVectorPad];
  HWY_ALIGN std::uint32_t colour[kVectorPad] = {};
  split(u, image.width, image.filters, column, across);
  split(v, image.height, image.filters, row, down);
  const auto stride = static_cast<std::size_t>(image.width);
  for (std::size_t n = 0; n < hn::Lanes(dw); ++n) {
    if ((wanted >> n & 1U) == 0) continue;
    const auto x = static_cast<std::size_t>(TapTable::first(column[n], image.width));
    const auto y = static_cast<std::size_t>(TapTable::first(row[n], image.height));
    colour[n] = mixed_pixels(image.words + y * stride + x, stride,
                             taps.at(column[n], image.width, across[n]).by_byte.data(),
                             taps.at(row[n], image.height, down[n]).weight.data());
  }
  return hn::Load(dw, colour);
}

bool show_flat_kernel(const Hits& hits, std::size_t first, int count, const MixedImage& image,
                      const ShownRow& row) {
  const Floats d;
  const Ints di;
  const Words dw;
  const hn::Rebind<std::uint8_t, Floats> d8;
  const FloatVec zero = hn::Zero(d);
  const FloatVec one = hn::Set(d, 1.0F);
  const auto number = [&](Origin origin) HWY_ATTR { return hn::Set(di, static_cast<int>(origin)); };
  bool has_cells = false;
  for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d))) {
    const auto at = static_cast<std::size_t>(x);
    const IntVec half = hn::LoadU(di, &hits.half[first + at]);
    has_cells = has_cells || !hn::AllFalse(di, hn::Gt(half, hn::Set(di, kNothing)));
    const auto is_flat = hn::Lt(half, hn::Set(di, kHidden));
    const auto is_sky = hn::Eq(half, hn::Set(di, kFlatSky));
    const auto flat = hn::RebindMask(d, is_flat);
    const FloatVec depth = hn::LoadU(d, &hits.inverse_depth[first + at]);
    const auto has_depth = hn::And(flat, hn::Gt(depth, zero));
    const FloatVec range = hn::Div(hn::LoadU(d, row.length + x), hn::IfThenElse(has_depth, depth, one));
    const FloatVec shown = hn::IfThenElse(has_depth, range, hn::Set(d, core::kSkyRange));
    hn::StoreU(hn::IfThenElseZero(flat, shown), d, row.range_m + x);
    const IntVec of_ground = hn::IfThenElse(hn::Eq(half, hn::Set(di, kFlatCarried)), number(Origin::kCarried),
                                            number(Origin::kBetween));
    const IntVec origin = hn::IfThenElse(is_sky, number(Origin::kSky), of_ground);
    hn::StoreU(hn::DemoteTo(d8, hn::IfThenElse(is_flat, origin, number(Origin::kOpen))), d8,
               reinterpret_cast<std::uint8_t*>(row.origin + x));
    if (image.words == nullptr) continue;
    if (hn::AllFalse(d, flat)) {
      store_words(dw, hn::Zero(dw), row.colour + x);
      continue;
    }
    const FloatVec u = hn::IfThenElseZero(flat, hn::LoadU(d, &hits.u[first + at]));
    const FloatVec v = hn::IfThenElseZero(flat, hn::LoadU(d, &hits.v[first + at]));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, flat, bits);
    const auto wanted = static_cast<std::uint32_t>(bits[0] | bits[1] << 8);
    store_words(dw, colours_at(image, u, v, wanted), row.colour + x);
  }
  return has_cells;
}

}  // namespace
}  // namespace vpe::warp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::warp {

HWY_EXPORT(rest_kernel);
HWY_EXPORT(draw_block_kernel);
HWY_EXPORT(invert_kernel);
HWY_EXPORT(widen_kernel);
HWY_EXPORT(show_flat_kernel);

DepthRest rest_of(const float* depth, std::size_t stride, int columns, int rows, const DepthPlane& plane) {
  return HWY_DYNAMIC_DISPATCH(rest_kernel)(depth, stride, columns, rows, plane);
}

void draw_block(const FlatBlock& block, Hits& hits) { HWY_DYNAMIC_DISPATCH(draw_block_kernel)(block, hits); }

void invert(std::span<const float> range_m, std::span<float> length) {
  HWY_DYNAMIC_DISPATCH(invert_kernel)(range_m, length);
}

void widen(std::span<const base::Rgb> colour, std::uint32_t* words) {
  HWY_DYNAMIC_DISPATCH(widen_kernel)(colour, words);
}

bool show_flat(const Hits& hits, std::size_t first, int count, const MixedImage& image, const ShownRow& row) {
  return HWY_DYNAMIC_DISPATCH(show_flat_kernel)(hits, first, count, image, row);
}

}  // namespace vpe::warp
#endif
