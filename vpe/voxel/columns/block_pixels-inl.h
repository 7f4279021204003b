// Refines the pixels of a block of a perspective image: those on one facet with a sample first, then the others.
//
// Part of refine_kernel.cpp; refine.h has the contract of refine_block().
#if defined(VPE_VOXEL_BLOCK_PIXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_BLOCK_PIXELS_INL_H_
#undef VPE_VOXEL_BLOCK_PIXELS_INL_H_
#else
#define VPE_VOXEL_BLOCK_PIXELS_INL_H_
#endif

// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "vpe/voxel/columns/block_rays-inl.h"
#include "vpe/voxel/columns/pixel_estimate-inl.h"
#include "vpe/voxel/columns/pixel_refiner-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Limits how many facets open pixels meet, one in each pass, before what is left is refined vector by vector.
constexpr int kPasses = 8;
// Room for the lanes of a vector.
constexpr int kVectorRoom = 16;

// Refines a block of pixels. Pixels that lie on the facet of their estimate are found in one round, a row after the other, without
// branches; the others are gathered, put in order of the height grids that they are over and take as many facets as they need, so
// that few vectors lie over several grids, and no pixel waits for its neighbours.
class BlockPixels {
 public:
  using V = hn::Vec<FloatTag>;
  using M = hn::Mask<FloatTag>;

  BlockPixels(const RayBlock& block, FacetSource& source, FacetSource& exact_source, float* range,
              std::ptrdiff_t stride)
      : block_(block), range_(range), stride_(stride), refiner_(block, source, exact_source) {}

  // Refines all. Appends those that are not resolved to `unresolved`.
  void refine(BlockHints& hints, std::vector<UnresolvedPixel>& unresolved) {
    const int lanes = static_cast<int>(hn::Lanes(FloatTag()));
    for (int row = 0; row < block_.rows; ++row) {
      hints.get(row, a_, b_, share_);
      const int row_open = open_count_;
      for (int k = 0; k < block_.columns; k += lanes) meet_first(row, k, std::min(lanes, block_.columns - k));
      const float* const seen = range_ + row * stride_;
      for (int n = row_open; n < open_count_; ++n) {
        const int k = open_[n].pixel - row * kRayBlockColumns;
        open_[n].a = a_[k];
        open_[n].b = b_[k];
        open_[n].share = share_[k];
        open_[n].t = seen[k];
      }
    }
    if (open_count_ == 0) return;
    refiner_.leave_grid();
    failed_count_ = 0;
    int count = 0;
    for (int n = 0; n < open_count_; ++n) {
      const bool waits = open_[n].waits;
      failed_[failed_count_] = listed_[count] = static_cast<std::uint16_t>(n);
      failed_count_ += waits ? 1 : 0;
      count += waits ? 0 : 1;
    }
    if (count > 0) order_by_grid(count);
    for (int pass = 0; pass < kPasses && count > 0; ++pass) count = meet_open(count);
    std::copy_n(order_, count, failed_ + failed_count_);
    failed_count_ += count;
    for (int k = 0; k < failed_count_; k += lanes)
      refine_open(k, std::min(lanes, failed_count_ - k), unresolved);
  }

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  static constexpr int kPixels = kRayBlockColumns * kRayBlockRows;
  // Grids a side about the first open pixel that are told apart.
  static constexpr int kGrids = 16;

  struct Open {
    int pixel;
    float a, b, share;
    float t;     // where to go on; negative: nowhere
    bool waits;  // is over a grid of doubles
  };

  static unsigned bits_of(M lanes) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(FloatTag(), lanes, bits);
    return bits[0] | static_cast<unsigned>(bits[1]) << 8;
  }

  // Refines pixels k, k + 1, ... of a row by the facets of their estimates.
  void meet_first(int row, int k, int used) {
    const FloatTag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    if (HWY_UNLIKELY(used < lanes)) {
      std::fill_n(a_ + k + used, lanes - used, kInfinity);
      std::fill_n(b_ + k + used, lanes - used, kInfinity);
      std::fill_n(share_ + k + used, lanes - used, 0.0F);
    }
    float* const range = range_ + row * stride_ + k;
    const PixelEstimate e(hn::LoadU(d, a_ + k), hn::LoadU(d, b_ + k), hn::LoadU(d, share_ + k));
    if (hn::AllTrue(d, e.sky)) {
      std::fill_n(range, used, kInfinity);
      return;
    }
    const int first = row * kRayBlockColumns + k;
    refiner_.take_from(first);
    V t = e.start;
    M dropped, other_kind;
    const M found = refiner_.meet_once(hn::Not(e.sky), e.low, e.high, t, dropped, other_kind);
    // Negative: refine() would give up.
    const V seen = hn::IfThenElse(e.sky, e.near, hn::IfThenElse(dropped, hn::Neg(t), t));
    if (HWY_LIKELY(used == lanes)) {
      hn::StoreU(seen, d, range);
    } else {
      alignas(64) float some[kVectorRoom];
      hn::Store(seen, d, some);
      std::copy_n(some, used, range);
    }
    const unsigned open = bits_of(hn::Not(hn::Or(found, e.sky)));
    if (open == 0) return;
    const unsigned waits = bits_of(other_kind);
    // Without a branch for each lane, which would be guessed wrong too often.
    int count = open_count_;
    for (int lane = 0; lane < lanes; ++lane) {
      open_[count].pixel = first + lane;
      open_[count].waits = (waits >> lane & 1U) != 0;
      count += static_cast<int>(open >> lane & 1U);
    }
    open_count_ = count;
  }

  // Sets order_: the first `count` pixels in listed_ by the grid that their place is over, as if all grids were as large as that of the first one.
  void order_by_grid(int count) {
    const FloatTag d;
    const hn::RebindToSigned<FloatTag> di;
    const int lanes = static_cast<int>(hn::Lanes(d));
    constexpr int kKeys = kGrids * kGrids;
    std::uint16_t begin[kKeys + 1] = {};
    const Open& middle = open_[listed_[0]];
    refiner_.select_grid_of(middle.pixel, std::abs(middle.t));
    for (int k = 0; k < count; k += lanes) {
      alignas(64) int pixels[kVectorRoom];
      alignas(64) float ts[kVectorRoom];
      for (int lane = 0; lane < lanes; ++lane) {
        const Open& open = open_[listed_[std::min(k + lane, count - 1)]];
        pixels[lane] = open.pixel;
        ts[lane] = open.t;
      }
      hn::StoreU(refiner_.grids_at(pixels, hn::Abs(hn::Load(d, ts)), kGrids), di, keys_ + k);
      for (int n = k; n < std::min(k + lanes, count); ++n) ++begin[keys_[n] + 1];
    }
    for (int key = 0; key < kKeys; ++key)
      begin[key + 1] = static_cast<std::uint16_t>(begin[key + 1] + begin[key]);
    for (int n = 0; n < count; ++n) order_[begin[keys_[n]]++] = listed_[n];
  }

  // Meets one more facet for each of the first `count` open pixels in order_, and keeps there those that need more of them; returns how
  // many. Appends those that refine() would give up, or has to begin in doubles, to failed_.
  int meet_open(int count) {
    const FloatTag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    int kept = 0;
    for (int k = 0; k < count; k += lanes) {
      alignas(64) int pixels[kVectorRoom];
      alignas(64) float some[3][kVectorRoom];
      const int used = std::min(lanes, count - k);
      for (int lane = 0; lane < lanes; ++lane) {
        const Open& open = open_[order_[k + std::min(lane, used - 1)]];
        pixels[lane] = open.pixel;
        some[0][lane] = open.a;
        some[1][lane] = open.b;
        some[2][lane] = open.t;
      }
      const PixelEstimate e(hn::Load(d, some[0]), hn::Load(d, some[1]), hn::Zero(d));
      V t = hn::Load(d, some[2]);
      refiner_.take(pixels);
      const M todo = hn::Gt(t, hn::Zero(d));
      M dropped, other_kind;
      const M found = refiner_.meet_each(todo, e.low, e.high, t, dropped, other_kind);
      hn::Store(hn::IfThenElse(dropped, hn::Neg(t), t), d, some[2]);
      const unsigned is_found = bits_of(found);
      const unsigned leaves = bits_of(hn::Or(dropped, other_kind));
      for (int lane = 0; lane < used; ++lane) {
        const std::uint16_t n = order_[k + lane];
        if ((is_found >> lane & 1U) != 0) {
          range_[pixels[lane] / kRayBlockColumns * stride_ + pixels[lane] % kRayBlockColumns] = some[2][lane];
          continue;
        }
        open_[n].t = some[2][lane];
        const bool is_failed = (leaves >> lane & 1U) != 0;
        failed_[failed_count_] = n;
        order_[kept] = n;
        failed_count_ += is_failed ? 1 : 0;
        kept += is_failed ? 0 : 1;
      }
    }
    return kept;
  }

  // Refines failed pixels k, k + 1, ... as far as they need.
  void refine_open(int k, int used, std::vector<UnresolvedPixel>& unresolved) {
    const FloatTag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const V inf = hn::Set(d, kInfinity);
    alignas(64) int pixels[kVectorRoom];
    alignas(64) float some[4][kVectorRoom];
    for (int lane = 0; lane < lanes; ++lane) {
      const Open& open = open_[failed_[k + std::min(lane, used - 1)]];
      pixels[lane] = open.pixel;
      some[0][lane] = lane < used ? open.a : kInfinity;
      some[1][lane] = lane < used ? open.b : kInfinity;
      some[2][lane] = open.share;
      some[3][lane] = open.t;
    }
    const PixelEstimate e(hn::Load(d, some[0]), hn::Load(d, some[1]), hn::Load(d, some[2]));
    V t = hn::Load(d, some[3]);
    const M wanted = hn::AndNot(e.sky, hn::Gt(t, hn::Zero(d)));
    refiner_.take(pixels);
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
      const int row = pixels[lane] / kRayBlockColumns;
      const int column = pixels[lane] % kRayBlockColumns;
      range_[row * stride_ + column] = some[0][lane];
      if (some[1][lane] == 0) continue;
      const Open& open = open_[failed_[k + lane]];
      unresolved.push_back({row, column, open.a, open.b});
    }
  }

  const RayBlock& block_;
  float* range_;
  std::ptrdiff_t stride_;
  PixelRefiner<BlockRays> refiner_;
  // Hold the hints of the row at hand.
  alignas(64) float a_[kRayBlockColumns + kVectorRoom];
  alignas(64) float b_[kRayBlockColumns + kVectorRoom];
  alignas(64) float share_[kRayBlockColumns + kVectorRoom];
  // Holds the pixels that meet_first() did not find.
  Open open_[kPixels + kVectorRoom];
  int open_count_ = 0;
  alignas(64) int keys_[kPixels + kVectorRoom];
  std::uint16_t listed_[kPixels + 1];
  std::uint16_t order_[kPixels];
  // Holds those that are refined last.
  std::uint16_t failed_[kPixels + 1];
  int failed_count_ = 0;
};

void refine_block_kernel(const RayBlock& block, BlockHints& hints, FacetSource& source,
                         FacetSource& exact_source, float* range, std::ptrdiff_t stride,
                         std::vector<UnresolvedPixel>& unresolved) {
  BlockPixels(block, source, exact_source, range, stride).refine(hints, unresolved);
}

}  // namespace
}  // namespace vpe::voxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
