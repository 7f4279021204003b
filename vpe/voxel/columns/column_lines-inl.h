// Reads posts, and the edges between them, along straight paths through a height grid.
//
// Part of column_kernel.cpp, below column_steps-inl.h.
#if defined(VPE_VOXEL_COLUMN_LINES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_COLUMN_LINES_INL_H_
#undef VPE_VOXEL_COLUMN_LINES_INL_H_
#else
#define VPE_VOXEL_COLUMN_LINES_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <algorithm>
#include <cstdint>

#include "vpe/voxel/columns/columns.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Selects how the posts of all active lanes are read: from a window of two or four vectors, or each by itself.
enum class Reach { kNear, kWide, kAny };

// Reads posts along the paths of lanes that cross one height grid by the same family of lines.
template <class D>
class PathReader {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

  // position0, position1: the lanes' position at line 0 and its change from line to line.
  PathReader(const HeightGridLines<T>& lines, LineFamily family, int intervals, V position0, V position1)
      : lines_(lines),
        family_(family),
        n_(intervals),
        per_line_(hn::Set(D(), T(family == LineFamily::kDiagonals ? 1 : 0))),
        position0_(position0),
        position1_(position1) {
    const D d;
    // The limit keeps the product with 0 from becoming NaN.
    const V limit = hn::Set(d, T(1e30));
    per_position1_ = hn::Min(hn::Div(hn::Set(d, T(1)), position1_), limit);
    per_rest_ = hn::Min(hn::Div(hn::Set(d, T(1)), hn::Sub(hn::Set(d, T(1)), position1_)), limit);
  }

  int intervals() const { return n_; }
  const T* maxima(int block) const { return lines_.maxima(block); }

  V position_at(int k) const { return position_at(line_number(k)); }
  V position_at(V k) const { return hn::MulAdd(position1_, k, position0_); }
  static V line_number(int k) { return hn::Set(D(), static_cast<T>(k)); }
  T first_position(int k) const {
    return family_ == LineFamily::kDiagonals ? static_cast<T>(std::max(0, k)) : T(0);
  }
  T last_position(int k) const {
    return static_cast<T>(family_ == LineFamily::kDiagonals ? n_ + std::min(0, k) : n_);
  }

  // Holds what is read of one line at each lane's position: the posts on either side, and the position between
  // them.
  struct Line {
    V whole;
    V part;
    V low;
    V high;
  };

  // Reads a line at any positions. Indices are clamped to the line and one post beside it.
  Line gather(int k) const { return gather(line_number(k), lines_.line(k)); }
  Line gather(V k, const T* at) const {
    const D d;
    const DI di;
    Line line;
    const V y = position_at(k);
    line.whole = hn::Floor(y);
    line.part = hn::Sub(y, line.whole);
    const V safe = hn::Min(hn::Max(line.whole, hn::Set(d, T(-1))), hn::Set(d, static_cast<T>(n_)));
    const VI index = hn::ConvertTo(di, safe);
#if HWY_TARGET == HWY_AVX2
    if constexpr (sizeof(T) == 4) {
      // Both posts of a lane by one load.
      alignas(32) std::int32_t first[8];
      hn::Store(index, di, first);
      const auto two = [&](int lane) {
        __m128 out = _mm_loadl_pi(_mm_undefined_ps(), reinterpret_cast<const __m64*>(at + first[lane]));
        return _mm_loadh_pi(out, reinterpret_cast<const __m64*>(at + first[lane + 1]));
      };
      const __m256 a = _mm256_insertf128_ps(_mm256_castps128_ps256(two(0)), two(4), 1);
      const __m256 b = _mm256_insertf128_ps(_mm256_castps128_ps256(two(2)), two(6), 1);
      line.low = V{_mm256_shuffle_ps(a, b, 0x88)};
      line.high = V{_mm256_shuffle_ps(a, b, 0xdd)};
      return line;
    }
#endif
    line.low = hn::GatherIndex(d, at, index);
    line.high = hn::GatherIndex(d, at + 1, index);
    return line;
  }

  // Reads a line whose active lanes have positions in [from, from + width]; other lanes read anything. The
  // window begins one post before `from` and includes the upper neighbour of the last lane.
#if HWY_TARGET == HWY_AVX2
  static constexpr int kNearWidth = 5;
  static constexpr int kWideWidth = 13;
#else
  static constexpr int kNearWidth = 28;
  static constexpr int kWideWidth = 60;
#endif
  template <Reach kReach>
  Line window(V k, int base, const T* posts) const {
    const D d;
    const DI di;
    Line line;
    const V y = position_at(k);
    line.whole = hn::Floor(y);
    line.part = hn::Sub(y, line.whole);
    const T* at = posts + base;
#if HWY_TARGET <= HWY_AVX3
    if constexpr (sizeof(T) == 4) {
      const __m512 a = _mm512_loadu_ps(at);
      const __m512 b = _mm512_loadu_ps(at + 16);
      const __m512i low = _mm512_sub_epi32(_mm512_cvttps_epi32(line.whole.raw), _mm512_set1_epi32(base));
      const __m512i high = _mm512_add_epi32(low, _mm512_set1_epi32(1));
      line.low = V{_mm512_permutex2var_ps(a, low, b)};
      line.high = V{_mm512_permutex2var_ps(a, high, b)};
      if constexpr (kReach == Reach::kWide) {
        const __m512 c = _mm512_loadu_ps(at + 32);
        const __m512 e = _mm512_loadu_ps(at + 48);
        const __m512i half = _mm512_set1_epi32(32);
        const __mmask16 low_far = _mm512_test_epi32_mask(low, half);
        const __mmask16 high_far = _mm512_test_epi32_mask(high, half);
        line.low = V{_mm512_mask_blend_ps(low_far, line.low.raw, _mm512_permutex2var_ps(c, low, e))};
        line.high = V{_mm512_mask_blend_ps(high_far, line.high.raw, _mm512_permutex2var_ps(c, high, e))};
      }
      return line;
    }
#endif
#if HWY_TARGET == HWY_AVX2
    if constexpr (sizeof(T) == 4) {
      const __m256i at_low = _mm256_sub_epi32(_mm256_cvttps_epi32(line.whole.raw), _mm256_set1_epi32(base));
      line.low = V{_mm256_permutevar8x32_ps(_mm256_loadu_ps(at), at_low)};
      line.high = V{_mm256_permutevar8x32_ps(_mm256_loadu_ps(at + 1), at_low)};
      if constexpr (kReach == Reach::kWide) {
        // Bit 3 of the index selects the half.
        const __m256 far = _mm256_castsi256_ps(_mm256_slli_epi32(at_low, 28));
        const __m256 low = _mm256_permutevar8x32_ps(_mm256_loadu_ps(at + 8), at_low);
        const __m256 high = _mm256_permutevar8x32_ps(_mm256_loadu_ps(at + 9), at_low);
        line.low = V{_mm256_blendv_ps(line.low.raw, low, far)};
        line.high = V{_mm256_blendv_ps(line.high.raw, high, far)};
      }
      return line;
    }
#endif
    const VI index = hn::ConvertTo(di, hn::Sub(line.whole, hn::Set(d, static_cast<T>(base))));
    const VI safe = hn::Min(hn::Max(index, hn::Zero(di)), hn::Set(di, kReadAhead - 2));
    line.low = hn::GatherIndex(d, at, safe);
    line.high = hn::GatherIndex(d, at + 1, safe);
    return line;
  }

  // Returns where the window begins whose lowest position is `from`.
  static int window_base(T from) { return std::max(static_cast<int>(from) - 1, -1); }

  // Reads a line by a window that begins at post `base`, or at any positions. `posts` is line(k).
  template <Reach kReach>
  Line read(V k, int base, const T* posts) const {
    if constexpr (kReach == Reach::kAny) {
      return gather(k, posts);
    } else {
      return window<kReach>(k, base, posts);
    }
  }
  const T* posts(int k) const { return lines_.line(k); }
  int side() const { return lines_.side; }

  // Describes where a path crosses the one edge between two neighbouring lines.
  struct Crossing {
    V x;
    V height;
    M other;  // an edge along the lines' normal, not a diagonal of the family's cells
  };
  // Returns the crossing between line k (`lower`) and line k + 1 (`upper`).
  Crossing between(V k, const Line& lower, const Line& upper) const {
    const D d;
    const V one = hn::Set(d, T(1));
    Crossing c;
    c.other = hn::Ne(lower.whole, upper.whole);
    const V numerator = hn::IfThenElse(c.other, hn::Sub(one, lower.part), lower.part);
    const V factor = hn::IfThenElse(c.other, per_position1_, per_rest_);
    const V s = hn::Min(hn::Max(hn::Mul(numerator, factor), hn::Zero(d)), one);
    const V a = hn::IfThenElse(c.other, lower.high, lower.low);
    const V b = hn::IfThenElse(c.other, upper.low, upper.high);
    c.height = hn::MulAdd(s, hn::Sub(b, a), a);
    c.x = hn::Add(k, s);
    return c;
  }

  static V height_on(const Line& line) { return hn::MulAdd(line.part, hn::Sub(line.high, line.low), line.low); }

  // Returns the lanes whose position on line k is between two posts.
  M on_line(V k, const Line& line) const {
    const Span span = positions(k);
    return hn::And(hn::Ge(line.whole, span.first), hn::Lt(line.whole, span.last));
  }
  // Returns the lanes for which line k has a post at this position.
  M has_post(V k, V position) const {
    const Span span = positions(k);
    return hn::And(hn::Ge(position, span.first), hn::Le(position, span.last));
  }

 private:
  // Holds the first and the last position of posts on a line, the same as first_position() and last_position().
  struct Span {
    V first, last;
  };
  Span positions(V k) const {
    const V shift = hn::Mul(k, per_line_);
    const V zero = hn::Zero(D());
    return {hn::Max(zero, shift), hn::Add(hn::Set(D(), static_cast<T>(n_)), hn::Min(zero, shift))};
  }

  const HeightGridLines<T>& lines_;
  LineFamily family_;
  int n_;
  V per_line_;  // by how much the first position rises from line to line: 1 on diagonals, else 0
  V position0_, position1_, per_position1_, per_rest_;
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
