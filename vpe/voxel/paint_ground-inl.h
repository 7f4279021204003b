// Colours of the ground of a block: posts and texels of its tiles, and the look over them.
#if defined(VPE_VOXEL_PAINT_GROUND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_PAINT_GROUND_INL_H_
#undef VPE_VOXEL_PAINT_GROUND_INL_H_
#else
#define VPE_VOXEL_PAINT_GROUND_INL_H_
#endif

#include <hwy/highway.h>

#include "vpe/voxel/paint_block-inl.h"
#include "vpe/voxel/paint_look-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel {
namespace HWY_NAMESPACE {

// Four floats of a post or texel at once: vector gathers are slower on many machines.
using Fours = hn::CappedTag<float, 4>;

// Grid cells of a block's pixels, and where in them.
struct alignas(64) Cells {
  std::int32_t index[kBlock];  // of the cell's south-west corner
  float x[kBlock], y[kBlock];  // 0 to 1
};

constexpr int kTexels = paging::kImageIntervals + 1;

struct alignas(64) Shares {
  float x[kBlock], y[kBlock];  // of a square's sides
};

// Chart coordinates on the tile's face; beyond any square's where the place is on the other side.
HWY_INLINE void set_chart(const PaintTile& tile, Block& block) {
  const Doubles d;
  const double* const p[3] = {block.place[tile.axis[0]], block.place[tile.axis[1]], block.place[tile.axis[2]]};
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const auto out = hn::Mul(hn::Load(d, p[2] + i), hn::Set(d, tile.sign[2]));
    const auto before = hn::Gt(out, hn::Zero(d));
    const auto per = inverse(d, hn::IfThenElse(before, out, hn::Set(d, 1.0)));
    const auto far = hn::Set(d, 1e6);
    const auto u = hn::Mul(hn::Mul(hn::Load(d, p[0] + i), hn::Set(d, tile.sign[0])), per);
    const auto v = hn::Mul(hn::Mul(hn::Load(d, p[1] + i), hn::Set(d, tile.sign[1])), per);
    hn::Store(hn::IfThenElse(before, u, far), d, block.u + i);
    hn::Store(hn::IfThenElse(before, v, far), d, block.v + i);
  }
}

// Bits of the pixels whose places and levels are the square's.
HWY_INLINE std::uint32_t inside(const PaintTile& tile, const Block& block, Shares& at) {
  const Doubles dd;
  const Halves dh;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(dd))) {
    const auto u = hn::Mul(hn::Sub(hn::Load(dd, block.u + i), hn::Set(dd, tile.u0)), hn::Set(dd, tile.per_u));
    const auto v = hn::Mul(hn::Sub(hn::Load(dd, block.v + i), hn::Set(dd, tile.v0)), hn::Set(dd, tile.per_v));
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

// Where pixels lie in a grid of `side` lines. Cut to the grid, so that pixels of other squares do no harm.
HWY_INLINE void find_cells(const Shares& at, const WindowAxis& across, const WindowAxis& up, int side,
                           Cells& out) {
  const Floats d;
  const Ints di;
  const auto last = hn::Set(d, static_cast<float>(side - 1));
  const auto before_last = hn::Set(d, static_cast<float>(side - 2));
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const auto place = [&](const float* share, const WindowAxis& axis) HWY_ATTR {
      const auto x = hn::Add(hn::Set(d, axis.first), hn::Mul(hn::Load(d, share + i), hn::Set(d, axis.span)));
      return hn::Min(hn::Max(x, hn::Zero(d)), last);
    };
    const auto x = place(at.x, across);
    const auto y = place(at.y, up);
    const auto column = hn::Min(hn::Trunc(x), before_last);
    const auto row = hn::Min(hn::Trunc(y), before_last);
    hn::Store(hn::Sub(x, column), d, out.x + i);
    hn::Store(hn::Sub(y, row), d, out.y + i);
    const auto index = hn::Add(hn::Mul(row, hn::Set(d, static_cast<float>(side))), column);
    hn::Store(hn::ConvertTo(di, index), di, out.index + i);
  }
}

// Straight between four corners.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V between(D d, V south_west, V south_east, V north_west, V north_east, float x, float y) {
  const V across = hn::Set(d, x);
  const V south = hn::Add(south_west, hn::Mul(across, hn::Sub(south_east, south_west)));
  const V north = hn::Add(north_west, hn::Mul(across, hn::Sub(north_east, north_west)));
  return hn::Add(south, hn::Mul(hn::Set(d, y), hn::Sub(north, south)));
}

// Asks the memory for the corners of all cells before the first is needed.
template <class T>
HWY_INLINE void prefetch(const T* grid, std::size_t step, std::size_t side, const Cells& cells,
                         std::uint32_t pixels) {
  for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
    const T* const south = grid + step * static_cast<std::size_t>(cells.index[__builtin_ctz(left)]);
    __builtin_prefetch(south);
    __builtin_prefetch(south + step * side);
  }
}

HWY_INLINE void take_posts(const paging::NormalTile& tile, const Cells& cells, std::uint32_t pixels,
                           Block& block) {
  const Fours d;
  const auto side = static_cast<std::size_t>(tile.side);
  const float* const posts = &tile.posts.data()->normal.x;
  for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const float* const south = posts + 4 * static_cast<std::size_t>(cells.index[i]);
    const float* const north = south + 4 * side;
    for (std::size_t c = 0; c < 4; c += hn::Lanes(d))
      hn::Store(between(d, hn::LoadU(d, south + c), hn::LoadU(d, south + 4 + c), hn::LoadU(d, north + c),
                        hn::LoadU(d, north + 4 + c), cells.x[i], cells.y[i]),
                d, block.post[i] + c);
  }
}

HWY_INLINE void take_texels(const paging::ImageTile& tile, const Cells& cells, std::uint32_t pixels,
                            Block& block) {
  const Fours d;
  const hn::Rebind<std::int32_t, Fours> di;
  const hn::Rebind<std::uint8_t, Fours> du;
  const std::uint8_t* const texels = &tile.texels.data()->r;
  const std::uint8_t* const last = &tile.texels.back().r;
  const auto texel = [&](const std::uint8_t* at, std::size_t c)
                         HWY_ATTR { return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(du, at + c))); };
  for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const std::uint8_t* const south = texels + 3 * static_cast<std::size_t>(cells.index[i]);
    const std::uint8_t* const north = south + 3 * kTexels;
    // Four bytes are loaded, and after the last texel there is none.
    std::uint8_t copy[4] = {last[0], last[1], last[2], 0};
    const std::uint8_t* const north_east = north + 3 == last ? copy : north + 3;
    for (std::size_t c = 0; c < 4; c += hn::Lanes(d))
      hn::Store(between(d, texel(south, c), texel(south + 3, c), texel(north, c), texel(north_east, c),
                        cells.x[i], cells.y[i]),
                d, block.texel[i] + c);
  }
}

// Bits of the pixels whose nearest post has no data; shares of the sun that is seen.
HWY_INLINE std::uint32_t take_rest(const paging::NormalTile& tile, const Cells& cells, std::uint32_t pixels,
                                   Block& block) {
  const auto side = static_cast<std::size_t>(tile.side);
  std::uint32_t missing = 0;
  for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const auto at = static_cast<std::size_t>(cells.index[i]);
    const float x = cells.x[i], y = cells.y[i];
    if (!tile.missing.empty()) {
      const std::size_t nearest = at + (x >= 0.5F ? 1 : 0) + (y >= 0.5F ? side : 0);
      if (tile.missing[nearest]) missing |= std::uint32_t{1} << i;
    }
    if (!tile.sees_sun.empty()) {
      const auto seen = [&](std::size_t k) { return static_cast<float>(tile.sees_sun[at + k]); };
      const float south = seen(0) * (1 - x) + seen(1) * x;
      const float north = seen(side) * (1 - x) + seen(side + 1) * x;
      block.sun[i] = south * (1 - y) + north * y;
    }
  }
  return missing;
}

// Colours the block's ground; returns the bits of pixels without data. `tile` is what was used last, or null.
HWY_INLINE std::uint32_t paint_ground(const PaintJob& job, PaintTiles& tiles, const PaintTile*& tile,
                                      Block& block) {
  std::uint32_t missing = 0;
  int charted = tile == nullptr ? -1 : static_cast<int>(tile->face);
  if (tile != nullptr) set_chart(*tile, block);
  Shares at;
  Cells cells, texels;
  for (std::uint32_t left = block.ground; left != 0;) {
    std::uint32_t here = tile == nullptr ? 0 : inside(*tile, block, at) & left;
    if (here == 0) {
      const int i = __builtin_ctz(left);
      tile = &tiles.find({block.place[0][i], block.place[1][i], block.place[2][i]}, block.level[i]);
      if (charted != static_cast<int>(tile->face)) set_chart(*tile, block);
      charted = static_cast<int>(tile->face);
      // Its own pixel belongs to it even where rounding has it just outside.
      here = (inside(*tile, block, at) & left) | (std::uint32_t{1} << i);
    }
    left &= ~here;
    if (tile->ground) {
      const paging::NormalTile& ground = *tile->ground;
      find_cells(at, tile->ground_x, tile->ground_y, ground.side, cells);
      prefetch(&ground.posts.data()->normal.x, 4, static_cast<std::size_t>(ground.side), cells, here);
    }
    if (tile->image) {
      find_cells(at, tile->image_x, tile->image_y, kTexels, texels);
      prefetch(&tile->image->texels.data()->r, 3, kTexels, texels, here);
    }
    if (tile->ground) {
      const paging::NormalTile& ground = *tile->ground;
      take_posts(ground, cells, here, block);
      if (!ground.missing.empty() || !ground.sees_sun.empty()) missing |= take_rest(ground, cells, here, block);
    }
    if (tile->image) take_texels(*tile->image, texels, here, block);
  }
  paint_look(job, block);
  return missing;
}

// The same by GroundPainter::colour_at, pixel by pixel.
inline std::uint32_t paint_by_point(const PaintJob& job, PaintTiles& tiles, Block& block) {
  std::uint32_t missing = 0;
  for (std::uint32_t left = block.ground; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const glm::dvec3 place{block.place[0][i], block.place[1][i], block.place[2][i]};
    const auto colour = job.painter->colour_at(
        glm::normalize(place), static_cast<double>(block.range[i]) / job.focal_px, *job.look, tiles.cursor);
    if (!colour) missing |= std::uint32_t{1} << i;
    const glm::vec3 rgb = colour ? glm::vec3(*colour) : glm::vec3(0);
    block.red[i] = rgb.x;
    block.green[i] = rgb.y;
    block.blue[i] = rgb.z;
  }
  return missing;
}

}  // namespace HWY_NAMESPACE
}  // namespace vpe::voxel
HWY_AFTER_NAMESPACE();

#endif
