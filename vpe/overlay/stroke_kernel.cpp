#include "vpe/overlay/stroke_kernel.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

// Highway compiles this file once for each instruction set and selects the best one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vpe/overlay/stroke_kernel.cpp"
// clang-format off
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace vpe::overlay::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kStrokeLanes>;
using FloatVec = hn::Vec<Floats>;

int whole(float x) { return static_cast<int>(std::clamp(x, -1e6F, 1e6F)); }

// Holds a position as a whole pixel and the rest, from which centres of pixels have the same distance in any part of an image.
struct Origin {
  explicit Origin(glm::dvec2 at) : pixel(glm::floor(glm::clamp(at, -1e6, 1e6))), rest(at - glm::dvec2(pixel)) {}
  glm::vec2 centre(int x, int y) const { return glm::vec2(x - pixel.x, y - pixel.y) + 0.5F - rest; }

  glm::ivec2 pixel;
  glm::vec2 rest;
};

struct Extent {
  int left, right, top, bottom;
};

Extent extent_of(glm::vec2 low, glm::vec2 high, StrokeRows& rows) {
  const Extent e{std::max(0, whole(std::floor(low.x))), std::min(rows.width, whole(std::ceil(high.x))),
                 std::max(0, whole(std::floor(low.y))), std::min(rows.height, whole(std::ceil(high.y)))};
  if (e.left >= e.right || e.top >= e.bottom) return {0, 0, 0, 0};
  rows.top = std::min(rows.top, e.top);
  rows.bottom = std::max(rows.bottom, e.bottom);
  return e;
}

std::uint8_t* touch(int y, int begin, int end, StrokeRows& rows) {
  TouchedRow& touched = rows.touched[y];
  touched.begin = std::min(touched.begin, begin);
  touched.end = std::max(touched.end, end);
  return rows.coverage + static_cast<std::size_t>(y) * rows.stride + static_cast<std::size_t>(begin);
}

// Computes the part of a pixel on one side of a straight edge.
class EdgeCoverage {
 public:
  HWY_INLINE explicit EdgeCoverage(glm::vec2 normal) {
    constexpr float kLeast = 1e-6F;
    const float x = std::abs(normal.x), y = std::abs(normal.y);
    const float longer = std::max(x, y), shorter = std::max(std::min(x, y), kLeast);
    reach_ = 0.5F * (longer + shorter);
    flat_ = 0.5F * (longer - shorter);
    per_longer_ = 1 / longer;
    per_corner_ = 0.5F / shorter;
  }

  HWY_INLINE float reach_px() const { return reach_; }
  // Returns the part inside, less a half, of a pixel whose centre is this far inside.
  HWY_INLINE FloatVec over_half(FloatVec inside_px) const {
    const Floats d;
    const FloatVec from_edge = hn::Min(hn::Abs(inside_px), hn::Set(d, reach_));
    const FloatVec in_corner = hn::Max(hn::Sub(from_edge, hn::Set(d, flat_)), hn::Zero(d));
    const FloatVec lost = hn::Mul(hn::Mul(in_corner, in_corner), hn::Set(d, per_corner_));
    return hn::CopySign(hn::Mul(hn::Sub(from_edge, lost), hn::Set(d, per_longer_)), inside_px);
  }
  // Returns the part that a band with this edge and the opposite one covers.
  HWY_INLINE FloatVec of_band(float half_width_px, FloatVec from_middle_px) const {
    const FloatVec half = hn::Set(Floats(), half_width_px);
    return hn::Add(over_half(hn::Sub(half, from_middle_px)), over_half(hn::Add(half, from_middle_px)));
  }

 private:
  float reach_, flat_, per_longer_, per_corner_;
};

// Raises the coverage of a vector of pixels.
HWY_INLINE void raise(FloatVec part, std::uint8_t* coverage) {
  const Floats d;
  const hn::Rebind<std::uint8_t, Floats> bytes;
  const FloatVec scaled = hn::Add(hn::Mul(hn::Max(part, hn::Zero(d)), hn::Set(d, 255.0F)), hn::Set(d, 0.5F));
  const auto covered = hn::DemoteTo(bytes, hn::ConvertTo(hn::Rebind<std::int32_t, Floats>(), scaled));
  hn::StoreU(hn::Max(covered, hn::LoadU(bytes, coverage)), bytes, coverage);
}

template <bool kIsCut>
HWY_INLINE void cover_piece(const StrokePiece& piece, StrokeRows& rows) {
  const Floats d;
  const glm::vec2 along = piece.along, across(-along.y, along.x);
  const EdgeCoverage side(across), cut(along);
  const float radius = piece.radius_px, length = piece.length_px;
  const Origin origin(piece.from);
  const glm::vec2 from(piece.from), to = from + along * length;
  const float around = radius + kPixelCorner_px;
  const Extent all = extent_of(glm::min(from, to) - around, glm::max(from, to) + around, rows);
  const float start_t = piece.start.is_cut ? -kPixelCorner_px : -piece.start.extent_px;
  const float end_t = length + (piece.end.is_cut ? kPixelCorner_px : piece.end.extent_px);
  const bool is_level = std::abs(across.x) < 1e-3F;
  const float slant = is_level ? 0 : 1 / across.x;
  const float reach = is_level ? 1e6F : std::abs((radius + side.reach_px()) * slant);
  const FloatVec columns = hn::Iota(d, 0.5F);
  for (int y = all.top; y < all.bottom; ++y) {
    const float down = origin.centre(0, y).y;
    // The pixels whose centres are within reach of the line through the piece.
    const float middle = from.x - down * across.y * slant - 0.5F;
    const int begin = std::max(all.left, whole(std::ceil(middle - reach)));
    const int end = std::min(all.right, whole(std::floor(middle + reach)) + 1);
    if (begin >= end) continue;
    std::uint8_t* const row = touch(y, begin, end, rows);
    const FloatVec down_t = hn::Set(d, down * along.y), down_s = hn::Set(d, down * across.y);
    for (int n = 0; n < end - begin; n += static_cast<int>(hn::Lanes(d))) {
      const FloatVec centre = hn::Add(columns, hn::Set(d, static_cast<float>(begin + n - origin.pixel.x)));
      const FloatVec aside = hn::Sub(centre, hn::Set(d, origin.rest.x));
      const FloatVec t = hn::Add(hn::Mul(aside, hn::Set(d, along.x)), down_t);
      FloatVec part = side.of_band(radius, hn::Add(hn::Mul(aside, hn::Set(d, across.x)), down_s));
      if constexpr (kIsCut) {
        const FloatVec half = hn::Set(d, 0.5F);
        if (piece.start.is_cut) part = hn::Mul(part, hn::Add(half, cut.over_half(t)));
        if (piece.end.is_cut)
          part = hn::Mul(part, hn::Add(half, cut.over_half(hn::Sub(hn::Set(d, length), t))));
      }
      const auto is_on = hn::And(hn::Ge(t, hn::Set(d, start_t)), hn::Le(t, hn::Set(d, end_t)));
      raise(hn::IfThenElseZero(is_on, part), row + n);
    }
  }
}

void cover_pieces_kernel(std::span<const StrokePiece> pieces, StrokeRows& rows) {
  for (const StrokePiece& piece : pieces) {
    if (piece.start.is_cut || piece.end.is_cut)
      cover_piece<true>(piece, rows);
    else
      cover_piece<false>(piece, rows);
  }
}

void cover_corner_kernel(const StrokeCorner& corner, StrokeRows& rows) {
  const Floats d;
  const float around = corner.radius_px + kPixelCorner_px;
  const Origin origin(corner.at);
  const Extent all = extent_of(glm::vec2(corner.at) - around, glm::vec2(corner.at) + around, rows);
  for (int y = all.top; y < all.bottom; ++y) {
    std::uint8_t* const row = touch(y, all.left, all.right, rows);
    for (int x = all.left; x < all.right; ++x) {
      const glm::vec2 away = origin.centre(x, y);
      const float distance = glm::length(away);
      if (distance >= around || glm::dot(away, corner.along) < 0 || glm::dot(away, corner.next) > 0) continue;
      const glm::vec2 outward = distance > 0 ? away / distance : corner.along;
      const FloatVec part = EdgeCoverage(outward).of_band(corner.radius_px, hn::Set(d, distance));
      raise(hn::IfThenElseZero(hn::FirstN(d, 1), part), row + (x - all.left));
    }
  }
}

}  // namespace
}  // namespace vpe::overlay::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vpe::overlay {

HWY_EXPORT(cover_pieces_kernel);
HWY_EXPORT(cover_corner_kernel);

void cover_pieces(std::span<const StrokePiece> pieces, StrokeRows& rows) {
  HWY_DYNAMIC_DISPATCH(cover_pieces_kernel)(pieces, rows);
}

void cover_corner(const StrokeCorner& corner, StrokeRows& rows) {
  HWY_DYNAMIC_DISPATCH(cover_corner_kernel)(corner, rows);
}

}  // namespace vpe::overlay
#endif
