// Holds a block of kBlock pixels of a row, and computes its places on the ground and the angles of its rays.
//
// Part of paint_kernel.cpp: the first step of a block.
#if defined(VPE_VOXEL_PAINT_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_PAINT_BLOCK_INL_H_
#undef VPE_VOXEL_PAINT_BLOCK_INL_H_
#else
#define VPE_VOXEL_PAINT_BLOCK_INL_H_
#endif

#include <hwy/highway.h>

#include "vpe/voxel/paint/paint_job.h"
#include "vpe/voxel/paint/paint_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel {
namespace HWY_NAMESPACE {

using Floats = hn::CappedTag<float, kBlock>;
using Ints = hn::RebindToSigned<Floats>;
using Doubles = hn::CappedTag<double, kBlock>;
using Halves = hn::Rebind<float, Doubles>;  // as many floats as there are doubles in a vector

// Holds where the pixels' colours come from: the south-west corner of a pixel's cell in a grid, and the
// position in the cell, 0 to 1.
template <class T>
struct alignas(64) Sources {
  const T* at[kBlock];
  float x[kBlock], y[kBlock];
};

// Holds where pixels lie in the grid of a tile of facets.
struct alignas(64) FacetPlaces {
  std::int32_t corner[kBlock];        // the south-west post of the cell
  std::int32_t second[kBlock];        // from there to the facet's second post: 1 below the diagonal
  float column[kBlock], row[kBlock];  // of the cell, from the lines FacetSquare::west and south
  float x[kBlock], y[kBlock];         // in the cell, 0 to 1
};

// Holds which facets colour the pixels.
struct Facets {
  FacetPlaces places;
  // The squares, and the pixels of each.
  const FacetSquare* square[kBlock];
  std::uint32_t pixels[kBlock];
  int squares;
};

// Holds the pixels' values, an array for each kind. Arrays come first, as all of them are whole vectors.
// Functions over a block are not inlined: inlining gains nothing, and compilers take minutes with sanitizers.
struct alignas(64) Block {
  // Set by begin_block(). At sky pixels the range is 0 and the place the camera. Places and per_length are set
  // only if the image needs them.
  double place[3][kBlock];
  double per_length[kBlock];  // 1 / length of the row's direction
  float range[kBlock];
  float is_sky[kBlock];  // 1 or 0
  std::int32_t level[kBlock];
  // Set by locate().
  Sources<float> posts;
  Sources<std::uint8_t> texels;
  Sources<std::uint16_t> colours;
  float sun[kBlock];  // share of the sun that is visible; set with shadows only
  // Set by locate_facets(), and with `middles` by take_facets().
  Facets facets;
  double middle[3][kBlock];
  // Set by take_posts() or take_facets(), and by take_texels(), take_colours() and take_scale().
  float post[kBlock][4];
  float texel[kBlock][4];
  // Set by ray_angles(): cosines between the ray and the vertical of the camera, and the sun.
  double rise[kBlock];
  double sunward[kBlock];
  float red[kBlock], green[kBlock], blue[kBlock];

  const double* shown[3];  // the places whose colours are shown: `place`, or `middle`
  const RowRays* row;
  const double* c0;
  const double* c1;
  int x, y, count;
  std::uint32_t sky, ground, nodata;  // a bit for each pixel, lowest first
};

// Returns the bits of a mask of the pixels from `at` on.
template <class D, class M>
HWY_INLINE std::uint32_t bits_of(D d, M mask, int at) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  const std::uint32_t bits = bytes[0] | (static_cast<std::uint32_t>(bytes[1]) << 8);
  const std::uint32_t valid = (std::uint32_t{1} << hn::Lanes(d)) - 1;
  return (bits & valid) << at;
}

// Returns 1 / sqrt(x) of doubles within the range of float: from floats and one step of Newton's method, with
// relative error 1e-13.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V inverse_root(D d, V x) {
  const hn::Rebind<float, D> half;
  const auto rough = hn::Div(hn::Set(half, 1.0F), hn::Sqrt(hn::DemoteTo(half, x)));
  const V y = hn::PromoteTo(d, rough);
  return hn::Mul(y, hn::Sub(hn::Set(d, 1.5), hn::Mul(hn::Mul(hn::Set(d, 0.5), x), hn::Mul(y, y))));
}

// Returns 1 / x in the same way.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V inverse(D d, V x) {
  const hn::Rebind<float, D> half;
  const V y = hn::PromoteTo(d, hn::Div(hn::Set(half, 1.0F), hn::DemoteTo(half, x)));
  return hn::Mul(y, hn::Sub(hn::Set(d, 2.0), hn::Mul(x, y)));
}

// Returns a c0 + b c1 + c at columns i and after.
template <class D>
HWY_INLINE hn::Vec<D> along_row(D d, const Block& block, int i, double a, double b, double c) {
  const auto first = hn::Mul(hn::Set(d, a), hn::LoadU(d, block.c0 + i));
  const auto second = hn::Mul(hn::Set(d, b), hn::LoadU(d, block.c1 + i));
  return hn::Add(hn::Add(first, second), hn::Set(d, c));
}

template <class D>
HWY_INLINE hn::Vec<D> inverse_length(D d, const Block& block, int i) {
  const auto c0 = hn::LoadU(d, block.c0 + i);
  const RowRays& row = *block.row;
  return inverse_root(d, hn::Add(hn::Set(d, row.m0),
                                 hn::Mul(c0, hn::Add(hn::Set(d, row.m1), hn::Mul(c0, hn::Set(d, row.m2))))));
}

// Sets sky, places and levels of `count` pixels from (x, y) on.
inline HWY_NOINLINE void begin_block(const PaintJob& job, int max_level, int x, int y, int count,
                                     Block& block) {
  const std::size_t at =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(job.width) + static_cast<std::size_t>(x);
  block.row = &job.rays.rows[static_cast<std::size_t>(y)];
  block.c0 = job.rays.c0.data() + x;
  block.c1 = job.rays.c1.data() + x;
  block.x = x;
  block.y = y;
  block.count = count;
  block.nodata = 0;
  block.facets.squares = 0;
  for (int c = 0; c < 3; ++c) block.shown[c] = block.place[c];
  const std::uint32_t all = count >= kBlock ? ~std::uint32_t{0} : (std::uint32_t{1} << count) - 1;
  // Whole blocks are read in place: loads from a copy would wait for its stores.
  const float* ranges = job.range_m + at;
  // Prefetches the next row, which is pages away, so that the processor does not fetch it by itself.
  if (y + 1 < job.height) {
    __builtin_prefetch(ranges + job.width);
    __builtin_prefetch(ranges + job.width + kBlock / 2);
  }
  float padded[kBlock];
  if (count < kBlock) {
    for (int i = 0; i < kBlock; ++i) padded[i] = i < count ? ranges[i] : core::kSkyRange;
    ranges = padded;
  }

  const Floats d;
  const Ints di;
  block.sky = 0;
  const auto root = hn::Set(d, static_cast<float>(job.root_range_m));
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const auto range = hn::LoadU(d, ranges + i);
    const auto sky = hn::Eq(range, hn::Set(d, core::kSkyRange));
    block.sky |= bits_of(d, sky, i);
    hn::Store(hn::IfThenElse(sky, hn::Set(d, 1.0F), hn::Zero(d)), d, block.is_sky + i);
    hn::Store(hn::IfThenElse(sky, hn::Zero(d), range), d, block.range + i);
    // The level is the exponent, rounded up.
    const auto ratio = hn::BitCast(di, hn::Div(root, range));
    const auto level = hn::Sub(hn::ShiftRight<23>(hn::Add(ratio, hn::Set(di, 0x7fffff))), hn::Set(di, 127));
    hn::Store(hn::Min(hn::Max(level, hn::Zero(di)), hn::Set(di, max_level)), di, block.level + i);
  }
  block.ground = all & ~block.sky;
  block.sky &= all;

  const core::SettingsValues& settings = job.request->settings;
  if (job.one_colour && settings.haze_visibility_m <= 0.0 && settings.background != core::Background::kSky)
    return;
  const Doubles dd;
  const Halves dh;
  const RowRays& row = *block.row;
  const glm::dvec3& camera = job.request->view.camera.position_m;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(dd))) {
    const auto range = hn::PromoteTo(dd, hn::Load(dh, block.range + i));
    const auto per_length = inverse_length(dd, block, i);
    hn::Store(per_length, dd, block.per_length + i);
    if (block.ground == 0) continue;
    const auto scale = hn::Mul(range, per_length);
    for (int c = 0; c < 3; ++c) {
      const auto ray = along_row(dd, block, i, row.a[c], row.b[c], row.c[c]);
      hn::Store(hn::Add(hn::Set(dd, camera[c]), hn::Mul(scale, ray)), dd, block.place[c] + i);
    }
  }
}

// Sets `rise` and `sunward`.
inline HWY_NOINLINE void ray_angles(const PaintJob& job, Block& block) {
  const Doubles d;
  const RowRays& row = *block.row;
  const auto set = [&](const glm::dvec3& to, double* out) HWY_ATTR {
    const double a = glm::dot(row.a, to), b = glm::dot(row.b, to), c = glm::dot(row.c, to);
    for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d)))
      hn::Store(hn::Mul(along_row(d, block, i, a, b, c), hn::Load(d, block.per_length + i)), d, out + i);
  };
  set(job.up, block.rise);
  set(job.request->sun, block.sunward);
}

}  // namespace HWY_NAMESPACE
}  // namespace vpe::voxel
HWY_AFTER_NAMESPACE();

#endif
