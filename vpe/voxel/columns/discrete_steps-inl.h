// Steps a group of columns from line to line through one height grid, with one voxel at each line.
//
// Part of discrete_kernel.cpp, called by walk_grid_discretely(). No step uses fused operations or estimates.
#if defined(VPE_VOXEL_DISCRETE_STEPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_DISCRETE_STEPS_INL_H_
#undef VPE_VOXEL_DISCRETE_STEPS_INL_H_
#else
#define VPE_VOXEL_DISCRETE_STEPS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <algorithm>
#include <cmath>

#include "vpe/voxel/columns/column_rows-inl.h"
#include "vpe/voxel/columns/column_scatter-inl.h"
#include "vpe/voxel/columns/discrete_paths-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using StepTag = hn::CappedTag<float, kMaxLanes>;

// Returns the posts of the lanes at whole positions of a line, which a window of kReadAhead posts from `base` on holds.
template <bool kIsNear>
hn::Vec<StepTag> read_posts(const float* line, int base, hn::Vec<hn::RebindToSigned<StepTag>> position) {
  const StepTag d;
  const hn::RebindToSigned<StepTag> di;
  const float* const at = line + base;
  const auto index = hn::Sub(position, hn::Set(di, base));
#if HWY_TARGET <= HWY_AVX3
  const __m512 a = _mm512_loadu_ps(at);
  const __m512 b = _mm512_loadu_ps(at + 16);
  hn::Vec<StepTag> posts{_mm512_permutex2var_ps(a, index.raw, b)};
  if constexpr (!kIsNear) {
    const __m512 c = _mm512_loadu_ps(at + 32);
    const __m512 e = _mm512_loadu_ps(at + 48);
    const __mmask16 far = _mm512_test_epi32_mask(index.raw, _mm512_set1_epi32(32));
    posts.raw = _mm512_mask_blend_ps(far, posts.raw, _mm512_permutex2var_ps(c, index.raw, e));
  }
  return posts;
#else
  // Lanes that are not on the line may have any position.
  const auto safe = hn::Min(hn::Max(index, hn::Zero(di)), hn::Set(di, kReadAhead - 1));
  return hn::GatherIndex(d, at, safe);
#endif
}

// Walks the lanes that cross one height grid by the same family of lines in the same direction.
template <RowKind kKind, bool kBlends>
class DiscreteWalk {
 public:
  using D = StepTag;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

  DiscreteWalk(const HeightGridLines<float>& lines, int intervals, const DiscretePaths& paths, int kind,
               const ColumnCamera& camera, const Rows& rows, double blend_from_m, ColumnGroup& group)
      : lines_(lines), n_(intervals), group_(group), model_(rows, group, 0) {
    const D d;
    const DI di;
    sigma0_ = rounded(paths.affine.sigma0);
    sigma1_ = rounded(paths.affine.sigma1);
    base0_ = rounded(paths.affine.base0);
    base1_ = rounded(paths.affine.base1);
    depth0_ = rounded(paths.affine.depth0);
    depth1_ = rounded(paths.affine.depth1);
    position0_ = hn::Load(di, paths.position0);
    position1_ = hn::Load(di, paths.position1);
    first_ = hn::Load(d, paths.first);
    last_ = hn::Load(d, paths.last);
    per_distance_ = hn::Set(d, static_cast<float>(1.0 / camera.distance_m));
    per_blend_ = hn::Set(d, kBlends ? static_cast<float>(1.0 / blend_from_m) : 0.0F);
    row_ = hn::Load(d, group.row);
    end_ = hn::Load(d, group.row_end);
    active_ = hn::Eq(rounded(paths.affine.kind), hn::Set(d, static_cast<float>(kind)));
    update_slope();
  }

  // Walks outward from line `first` to line `last`, both included. Skips blocks in which nothing can be seen.
  void run(int first, int last) {
    const bool up = last >= first;
    const int last_block = (n_ - 1) / kBlockLines;
    int k = first;
    while (!hn::AllFalse(D(), alive_)) {
      // The line between two blocks belongs to both.
      const int block = std::min((up ? k : std::max(k - 1, 0)) / kBlockLines, last_block);
      const int end = up ? (block == last_block ? n_ : (block + 1) * kBlockLines - 1) : block * kBlockLines;
      const int block_end = up ? std::min(last, end) : std::max(last, end);
      walk_block(block, k, block_end);
      if (block_end == last) break;
      k = block_end + (up ? 1 : -1);
    }
  }

  // Writes the lanes' next rows back to the group.
  void store() const { hn::Store(row_, D(), group_.row); }

 private:
  static V rounded(const double* from) {
    alignas(64) float values[kMaxLanes];
    for (std::size_t k = 0; k < hn::Lanes(D()); ++k) values[k] = static_cast<float>(from[k]);
    return hn::Load(D(), values);
  }

  // Describes the rays of the lanes' next rows as heights over the path: minus (base_s0_ + base_s1_ line).
  void update_slope() {
    const V slope = model_.slope(row_);
    base_s0_ = hn::Sub(base0_, hn::Mul(slope, sigma0_));
    base_s1_ = hn::Sub(base1_, hn::Mul(slope, sigma1_));
    alive_ = hn::And(active_, hn::Lt(row_, end_));
  }

  static V affine(V at_zero, V per_line, V line) { return hn::Add(at_zero, hn::Mul(per_line, line)); }
  VI position_at(int line) const { return hn::Add(position0_, hn::Mul(position1_, hn::Set(DI(), line))); }
  VI whole(VI position) const {
    return hn::Min(hn::Max(hn::ShiftRight<kDiscreteFraction>(position), hn::Zero(DI())), hn::Set(DI(), n_));
  }

  struct Extent {
    int low;
    int high;
  };
  // Returns the whole positions of the lanes that may be on a line.
  Extent extent(VI position) const {
    const DI di;
    const auto alive = hn::RebindMask(di, alive_);
    const VI at = whole(position);
    return {hn::GetLane(hn::MinOfLanes(di, hn::IfThenElse(alive, at, hn::Set(di, n_)))),
            hn::GetLane(hn::MaxOfLanes(di, hn::IfThenElse(alive, at, hn::Zero(di))))};
  }

  void walk_block(int block, int first, int last) {
    const int low = std::min(first, last);
    const int high = std::max(first, last);
    const Extent a = extent(position_at(low));
    const Extent b = extent(position_at(high));
    const Extent both{std::min(a.low, b.low), std::max(a.high, b.high)};
    if (is_hidden(block, low, high, both)) return;
    // Wider voxels may lie a post to either side.
    base_ = std::max(both.low - 1, 0);
    const int width = both.high + 1 - base_;
    const bool up = last >= first;
    if (width < kReadAhead / 2) {
      up ? step<true, Read::kNear>(first, last) : step<false, Read::kNear>(first, last);
    } else if (width < kReadAhead) {
      up ? step<true, Read::kWide>(first, last) : step<false, Read::kWide>(first, last);
    } else {
      up ? step<true, Read::kAny>(first, last) : step<false, Read::kAny>(first, last);
    }
  }

  // Returns true if no voxel of these lines can reach any lane's next row.
  bool is_hidden(int block, int low, int high, Extent at) const {
    const D d;
    const float* maxima = lines_.maxima(block);
    const int c1 = std::min(at.high / kBlockLines, lines_.blocks - 1);
    const int c0 = std::min(at.low / kBlockLines, c1);
    const float highest = *std::max_element(maxima + c0, maxima + c1 + 1);
    const V most = hn::Max(affine(base_s0_, base_s1_, hn::Set(d, static_cast<float>(low))),
                           affine(base_s0_, base_s1_, hn::Set(d, static_cast<float>(high))));
    // The sums of lines between may be rounded up by more than those of the ends.
    const V ray = hn::Add(hn::Abs(base_s0_), hn::Mul(hn::Abs(base_s1_), hn::Set(d, static_cast<float>(high))));
    const V size = hn::Add(ray, hn::Set(d, std::abs(highest)));
    const V top = hn::Add(hn::Add(most, hn::Set(d, highest)), hn::Mul(size, hn::Set(d, 1e-6F)));
    return hn::AllFalse(d, hn::And(alive_, hn::Ge(top, hn::Zero(d))));
  }

  enum class Read { kNear, kWide, kAny };
  template <Read kRead>
  V read(int line, VI position) const {
    if constexpr (kRead == Read::kAny) {
      return hn::GatherIndex(D(), lines_.line(line), position);
    } else {
      return read_posts<kRead == Read::kNear>(lines_.line(line), base_, position);
    }
  }

  template <bool kUp, Read kRead>
  void step(int first, int last) {
    const D d;
    const V zero = hn::Zero(d);
    VI position = position_at(first);
    for (int k = first;; k += kUp ? 1 : -1) {
      const V line = hn::Set(d, static_cast<float>(k));
      V height = read<kRead>(k, whole(position));
      if constexpr (kBlends) height = blended<kRead>(k, line, position, height);
      const V rest = hn::Add(height, affine(base_s0_, base_s1_, line));
      const M reached = hn::And(alive_, hn::Ge(rest, zero));
      if (HWY_UNLIKELY(!hn::AllFalse(d, reached))) {
        const M here = hn::And(hn::And(reached, hn::Gt(affine(sigma0_, sigma1_, line), zero)),
                               hn::And(hn::Ge(line, first_), hn::Le(line, last_)));
        if (!hn::AllFalse(d, here)) resolve(here, line, height);
      }
      if (k == last) break;
      position = kUp ? hn::Add(position, position1_) : hn::Sub(position, position1_);
    }
  }

  // Returns the mean of a voxel and the one twice as wide that holds it, weighted by distance.
  template <Read kRead>
  V blended(int k, V line, VI position, V height) const {
    const D d;
    const DI di;
    const int wide_line = std::min((k + 1) & ~1, n_);
    const VI half = hn::Set(di, 1 << (kDiscreteFraction - 1));
    const VI wide = hn::ShiftLeft<1>(hn::ShiftRight<kDiscreteFraction + 1>(hn::Add(position, half)));
    const V wide_height = read<kRead>(wide_line, hn::Min(hn::Max(wide, hn::Zero(di)), hn::Set(di, n_)));
    const V one = hn::Set(d, 1.0F);
    const V weight =
        hn::Min(hn::Max(hn::Sub(hn::Mul(range_m(line, height), per_blend_), one), hn::Zero(d)), one);
    return hn::Add(height, hn::Mul(weight, hn::Sub(wide_height, height)));
  }

  // Returns the distance from the camera to the top of a voxel on a line.
  V range_m(V line, V height) const {
    const V sigma = affine(sigma0_, sigma1_, line);
    const V rise = hn::Add(height, affine(base0_, base1_, line));
    const V inverse = hn::Sub(affine(depth0_, depth1_, line), hn::Mul(height, per_distance_));
    return hn::Div(hn::Sqrt(hn::Add(hn::Mul(sigma, sigma), hn::Mul(rise, rise))), inverse);
  }

  // Gives the voxel to the rows whose rays meet it, of which each lane's next one is the first.
  void resolve(M lanes, V line, V height) {
    const D d;
    const V one = hn::Set(d, 1.0F);
    const V zero = hn::Zero(d);
    const V sigma = affine(sigma0_, sigma1_, line);
    const auto meets = [&](V row) {
      const V slope = model_.slope(row);
      const V at_zero = hn::Sub(base0_, hn::Mul(slope, sigma0_));
      const V per_line = hn::Sub(base1_, hn::Mul(slope, sigma1_));
      return hn::Ge(hn::Add(height, affine(at_zero, per_line, line)), zero);
    };
    // The rows that the slope of the voxel's top gives, but for rounding.
    const V top = hn::Div(hn::Add(height, affine(base0_, base1_, line)), sigma);
    V rows = hn::Min(hn::Max(model_.count_up_to(top), hn::Add(row_, one)), end_);
    rows = hn::IfThenElse(lanes, rows, row_);
    for (;;) {
      const M too_many = hn::AndNot(meets(hn::Max(hn::Sub(rows, one), zero)),
                                    hn::And(lanes, hn::Gt(rows, hn::Add(row_, one))));
      if (hn::AllFalse(d, too_many)) break;
      rows = hn::IfThenElse(too_many, hn::Sub(rows, one), rows);
    }
    for (;;) {
      const M too_few = hn::And(hn::And(lanes, hn::Lt(rows, end_)), meets(rows));
      if (hn::AllFalse(d, too_few)) break;
      rows = hn::IfThenElse(too_few, hn::Add(rows, one), rows);
    }
    scatter(d, group_.start, 0, lanes, hn::Sub(rows, one), range_m(line, height));
    row_ = rows;
    update_slope();
  }

  const HeightGridLines<float>& lines_;
  int n_;
  ColumnGroup& group_;
  RowModel<D, kKind> model_;
  V sigma0_, sigma1_, base0_, base1_, depth0_, depth1_, per_distance_, per_blend_;
  V first_, last_;
  VI position0_, position1_;
  V row_, end_, base_s0_, base_s1_;
  M active_, alive_;
  int base_ = 0;  // first post of the windows of the block
};

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
