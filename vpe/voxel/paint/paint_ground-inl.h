// Colours the ground of a block from the posts and texels of its tiles.
//
// Part of paint_kernel.cpp: locate() runs when a block begins, paint_ground() one block later, when the memory
// that locate() prefetched has arrived.
#if defined(VPE_VOXEL_PAINT_GROUND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_PAINT_GROUND_INL_H_
#undef VPE_VOXEL_PAINT_GROUND_INL_H_
#else
#define VPE_VOXEL_PAINT_GROUND_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstring>

#include "lod/tree/facet_mask.h"
#include "vpe/voxel/paint/paint_block-inl.h"
#include "vpe/voxel/paint/paint_shading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel {
namespace HWY_NAMESPACE {

// The four floats of a post or texel are loaded at once: vector gathers are slower on many machines.
using Fours = hn::CappedTag<float, 4>;

struct alignas(64) Chart {
  double u[kBlock], v[kBlock];
};

constexpr int kTexels = paging::kImageIntervals + 1;

struct alignas(64) Fractions {
  float x[kBlock], y[kBlock];  // of a square's sides
};

// Sets chart coordinates on the square's face, and coordinates outside any square for places on the other side of
// the planet.
inline HWY_NOINLINE void set_chart(const ChartSquare& tile, const Block& block, Chart& chart) {
  const Doubles d;
  const double* const p[3] = {block.shown[tile.axis[0]], block.shown[tile.axis[1]], block.shown[tile.axis[2]]};
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const auto out = hn::Mul(hn::Load(d, p[2] + i), hn::Set(d, tile.sign[2]));
    const auto before = hn::Gt(out, hn::Zero(d));
    const auto per = inverse(d, hn::IfThenElse(before, out, hn::Set(d, 1.0)));
    const auto far = hn::Set(d, 1e6);
    const auto u = hn::Mul(hn::Mul(hn::Load(d, p[0] + i), hn::Set(d, tile.sign[0])), per);
    const auto v = hn::Mul(hn::Mul(hn::Load(d, p[1] + i), hn::Set(d, tile.sign[1])), per);
    hn::Store(hn::IfThenElse(before, u, far), d, chart.u + i);
    hn::Store(hn::IfThenElse(before, v, far), d, chart.v + i);
  }
}

// Returns the bits of the pixels whose place and level are those of the square, and sets the positions of all.
inline HWY_NOINLINE std::uint32_t inside(const PaintTile& tile, const Block& block, const Chart& chart,
                                         Fractions& at) {
  const Doubles dd;
  const Halves dh;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(dd))) {
    const auto u = hn::Mul(hn::Sub(hn::Load(dd, chart.u + i), hn::Set(dd, tile.u0)), hn::Set(dd, tile.per_u));
    const auto v = hn::Mul(hn::Sub(hn::Load(dd, chart.v + i), hn::Set(dd, tile.v0)), hn::Set(dd, tile.per_v));
    hn::Store(hn::DemoteTo(dh, u), dh, at.x + i);
    hn::Store(hn::DemoteTo(dh, v), dh, at.y + i);
  }
  const Floats d;
  const Ints di;
  const auto one = hn::Set(d, 1.0F);
  std::uint32_t bits = 0;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const auto x = hn::Load(d, at.x + i);
    const auto y = hn::Load(d, at.y + i);
    const auto low = hn::And(hn::Ge(x, hn::Zero(d)), hn::Ge(y, hn::Zero(d)));
    const auto high = hn::And(hn::Lt(x, one), hn::Lt(y, one));
    const auto level = hn::Eq(hn::Load(di, block.level + i), hn::Set(di, tile.level));
    bits |= bits_of(d, hn::And(hn::And(low, high), hn::RebindMask(d, level)), i);
  }
  return bits;
}

// Finds the cells of some pixels in a grid of `side` lines with `step` values for each corner, and prefetches
// them.
template <class T>
inline HWY_NOINLINE void find_sources(const Fractions& at, const WindowAxis& across, const WindowAxis& up,
                                      const T* grid, int side, std::size_t step, std::uint32_t pixels,
                                      Sources<T>& out) {
  const Floats d;
  const Ints di;
  const auto zero = hn::Zero(d);
  const auto last = hn::Set(d, static_cast<float>(side - 1));
  const auto before_last = hn::Set(d, static_cast<float>(side - 2));
  alignas(64) std::int32_t index[kBlock];
  alignas(64) float x_in[kBlock];
  alignas(64) float y_in[kBlock];
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const auto x_line =
        hn::Add(hn::Set(d, across.first), hn::Mul(hn::Load(d, at.x + i), hn::Set(d, across.span)));
    const auto y_line = hn::Add(hn::Set(d, up.first), hn::Mul(hn::Load(d, at.y + i), hn::Set(d, up.span)));
    // Clamped to the grid, as the pixels of other squares are computed too.
    const auto x = hn::Min(hn::Max(x_line, zero), last);
    const auto y = hn::Min(hn::Max(y_line, zero), last);
    const auto column = hn::Min(hn::Trunc(x), before_last);
    const auto row = hn::Min(hn::Trunc(y), before_last);
    hn::Store(hn::Sub(x, column), d, x_in + i);
    hn::Store(hn::Sub(y, row), d, y_in + i);
    const auto corner = hn::Add(hn::Mul(row, hn::Set(d, static_cast<float>(side))), column);
    hn::Store(hn::ConvertTo(di, corner), di, index + i);
  }
  const std::size_t up_one = step * static_cast<std::size_t>(side);
  for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const T* const corner = grid + step * static_cast<std::size_t>(index[i]);
    __builtin_prefetch(corner);
    __builtin_prefetch(corner + up_one);
    out.at[i] = corner;
    out.x[i] = x_in[i];
    out.y[i] = y_in[i];
  }
}

// Interpolates bilinearly between four corners.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V between(D d, V south_west, V south_east, V north_west, V north_east, float x, float y) {
  const V across = hn::Set(d, x);
  const V south = hn::Add(south_west, hn::Mul(across, hn::Sub(south_east, south_west)));
  const V north = hn::Add(north_west, hn::Mul(across, hn::Sub(north_east, north_west)));
  return hn::Add(south, hn::Mul(hn::Set(d, y), hn::Sub(north, south)));
}

// Sets `post` of the block's ground.
inline HWY_NOINLINE void take_posts(std::size_t side, Block& block) {
  const Fours d;
  for (std::uint32_t left = block.ground; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const float* const south = block.posts.at[i];
    const float* const north = south + 4 * side;
    for (std::size_t c = 0; c < 4; c += hn::Lanes(d))
      hn::Store(between(d, hn::LoadU(d, south + c), hn::LoadU(d, south + 4 + c), hn::LoadU(d, north + c),
                        hn::LoadU(d, north + 4 + c), block.posts.x[i], block.posts.y[i]),
                d, block.post[i] + c);
  }
}

// Sets `texel` of the block's ground.
inline HWY_NOINLINE void take_texels(Block& block) {
  static_assert(std::endian::native == std::endian::little);
  const Fours d;
  const hn::Rebind<std::int32_t, Fours> di;
  const hn::Rebind<std::uint8_t, Fours> du;
  const auto texel = [&](const std::uint8_t* at, std::size_t c)
                         HWY_ATTR { return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(du, at + c))); };
  for (std::uint32_t left = block.ground; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const std::uint8_t* const south = block.texels.at[i];
    const std::uint8_t* const north = south + 3 * kTexels;
    // Four bytes are loaded, but no byte follows the last texel. So it is loaded with the byte before it.
    std::uint32_t last;
    std::memcpy(&last, north + 2, sizeof last);
    last >>= 8;
    std::uint8_t north_east[4];
    std::memcpy(north_east, &last, sizeof last);
    for (std::size_t c = 0; c < 4; c += hn::Lanes(d))
      hn::Store(between(d, texel(south, c), texel(south + 3, c), texel(north, c), texel(north_east, c),
                        block.texels.x[i], block.texels.y[i]),
                d, block.texel[i] + c);
  }
}

// Marks pixels on facets with a nodata post, and sets the visible share of the sun.
inline HWY_NOINLINE void take_nodata_and_sun(const paging::NormalTile& tile, std::uint32_t pixels,
                                             Block& block) {
  const auto side = static_cast<std::size_t>(tile.side);
  for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const auto at = static_cast<std::size_t>(block.posts.at[i] - &tile.posts.data()->normal.x) / 4;
    const float x = block.posts.x[i], y = block.posts.y[i];
    if (!tile.nodata.empty()) {
      if (lod::is_flagged(tile.nodata, at, side, static_cast<double>(x), static_cast<double>(y)))
        block.nodata |= std::uint32_t{1} << i;
    }
    if (!tile.sees_sun.empty()) {
      const auto seen = [&](std::size_t k) { return static_cast<float>(tile.sees_sun[at + k]); };
      const float south = seen(0) * (1 - x) + seen(1) * x;
      const float north = seen(side) * (1 - x) + seen(side + 1) * x;
      block.sun[i] = south * (1 - y) + north * y;
    }
  }
}

// Finds the sources of the block's colours. `tile` is the square that was used last, or null.
inline HWY_NOINLINE void locate(PaintTiles& tiles, const PaintTile*& tile, Block& block) {
  Chart chart;
  int charted = tile == nullptr ? -1 : static_cast<int>(tile->face);
  if (tile != nullptr) set_chart(*tile, block, chart);
  Fractions at;
  for (std::uint32_t left = block.ground; left != 0;) {
    std::uint32_t here = tile == nullptr ? 0 : inside(*tile, block, chart, at) & left;
    if (here == 0) {
      const int i = __builtin_ctz(left);
      tile = &tiles.find({block.shown[0][i], block.shown[1][i], block.shown[2][i]}, block.level[i]);
      if (charted != static_cast<int>(tile->face)) set_chart(*tile, block, chart);
      charted = static_cast<int>(tile->face);
      // The pixel that the square was found for belongs to it, even if rounding puts it just outside.
      here = (inside(*tile, block, chart, at) & left) | (std::uint32_t{1} << i);
    }
    left &= ~here;
    if (tile->ground) {
      const paging::NormalTile& ground = *tile->ground;
      find_sources(at, tile->ground_x, tile->ground_y, &ground.posts.data()->normal.x, ground.side, 4, here,
                   block.posts);
      if (!ground.nodata.empty() || !ground.sees_sun.empty()) take_nodata_and_sun(ground, here, block);
    }
    if (tile->image)
      find_sources(at, tile->image_x, tile->image_y, &tile->image->texels.data()->r, kTexels, 3, here,
                   block.texels);
    if (tile->colours)
      find_sources(at, tile->ground_x, tile->ground_y, tile->colours->texels.data(), tile->colours->side, 4,
                   here, block.colours);
  }
}

// Sets the normals in `post`, and the shares of the sun, of pixels that have their own.
inline HWY_NOINLINE void take_normals(const PaintJob& job, Block& block) {
  const bool has_sun = job.shading->lit && job.shading->shadows;
  const PixelNormal* const normals = job.normals + static_cast<std::ptrdiff_t>(block.y) * job.width + block.x;
  for (std::uint32_t left = block.ground; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const PixelNormal& own = normals[i];
    float* const post = block.post[i];
    post[0] += own.share * (own.x - post[0]);
    post[1] += own.share * (own.y - post[1]);
    post[2] += own.share * (own.z - post[2]);
    if (has_sun && own.sun_share > 0) block.sun[i] += own.sun_share * (own.sun - block.sun[i]);
  }
}

// Sets `texel` of the block's ground to the image's colours between posts; of nodata ground to those at the place.
inline HWY_NOINLINE void take_colours(const PaintJob& job, PaintTiles& tiles, Block& block) {
  const Fours d;
  const hn::Rebind<std::int32_t, Fours> di;
  const hn::Rebind<std::uint16_t, Fours> du;
  const auto unit = hn::Set(d, 1.0F / PostColours::kPerUnit);
  const auto colour = [&](const std::uint16_t* at)
                          HWY_ATTR { return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(du, at))); };
  const std::size_t step = 4 * static_cast<std::size_t>(job.posts_side);
  for (std::uint32_t left = block.ground & ~block.nodata; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const std::uint16_t* const south = block.colours.at[i];
    const std::uint16_t* const north = south + step;
    for (std::size_t c = 0; c < 4; c += hn::Lanes(d))
      hn::Store(hn::Mul(unit, between(d, colour(south + c), colour(south + 4 + c), colour(north + c),
                                      colour(north + 4 + c), block.colours.x[i], block.colours.y[i])),
                d, block.texel[i] + c);
  }
  for (std::uint32_t left = block.nodata; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const glm::dvec3 place =
        glm::normalize(glm::dvec3(block.place[0][i], block.place[1][i], block.place[2][i]));
    const double footprint_m = static_cast<double>(block.range[i]) / job.focal_px;
    const glm::dvec3 image =
        job.shader->nodata_image_at(place, footprint_m, *job.shading, tiles.cursor).value();
    for (int c = 0; c < 3; ++c) block.texel[i][c] = static_cast<float>(image[c]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vpe::voxel
HWY_AFTER_NAMESPACE();

#endif
