// Finds the facets under a block's places, and their normals, values and middles, for flat shading.
//
// Part of paint_kernel.cpp: locate_facets() runs when a block begins, take_facets() one block later, when the memory that
// it prefetched has arrived. facet_tile.h has the formula.
#if defined(VPE_VOXEL_PAINT_FACETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VPE_VOXEL_PAINT_FACETS_INL_H_
#undef VPE_VOXEL_PAINT_FACETS_INL_H_
#else
#define VPE_VOXEL_PAINT_FACETS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#include "lod/tree/facet_mask.h"
#include "vpe/voxel/paint/paint_ground-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vpe::voxel {
namespace HWY_NAMESPACE {

// Returns the bits of those pixels of `left` whose place is in the square. Sets their places in the grid, and those of the
// lowest pixel of `left`.
inline HWY_NOINLINE std::uint32_t inside_facets(const FacetSquare& square, const Chart& chart,
                                                std::uint32_t left, FacetPlaces& at) {
  const Doubles d;
  const Halves dh;
  const hn::Rebind<std::int32_t, Doubles> di;
  const auto zero = hn::Zero(d);
  const auto one = hn::Set(d, 1.0);
  const auto last = hn::Set(d, static_cast<double>(square.tile->side - 1));
  const auto lines = hn::Set(d, static_cast<double>(square.tile->side));
  const auto cell = [&](auto share, double first, double span) HWY_ATTR {
    return hn::Min(hn::Max(hn::Add(hn::Set(d, first), hn::Mul(share, hn::Set(d, span))), zero), last);
  };
  const std::uint32_t lowest = left & (~left + 1);
  const std::uint32_t lanes = (std::uint32_t{1} << hn::Lanes(d)) - 1;
  std::uint32_t bits = 0;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const auto x = hn::Mul(hn::Sub(hn::Load(d, chart.u + i), hn::Set(d, square.u0)), hn::Set(d, square.per_u));
    const auto y = hn::Mul(hn::Sub(hn::Load(d, chart.v + i), hn::Set(d, square.v0)), hn::Set(d, square.per_v));
    const auto low = hn::And(hn::Ge(x, zero), hn::Ge(y, zero));
    const std::uint32_t here = left & bits_of(d, hn::And(low, hn::And(hn::Lt(x, one), hn::Lt(y, one))), i);
    bits |= here;
    if ((here | (lowest & (lanes << i))) == 0) continue;
    const auto x_line = cell(x, square.first_x, square.span_x);
    const auto y_line = cell(y, square.first_y, square.span_y);
    const auto column = hn::Min(hn::Trunc(x_line), hn::Sub(last, one));
    const auto row = hn::Min(hn::Trunc(y_line), hn::Sub(last, one));
    hn::Store(hn::DemoteTo(di, hn::Add(hn::Mul(row, lines), column)), di, at.corner + i);
    hn::Store(hn::DemoteTo(dh, hn::Sub(column, hn::Set(d, square.west.number))), dh, at.column + i);
    hn::Store(hn::DemoteTo(dh, hn::Sub(row, hn::Set(d, square.south.number))), dh, at.row + i);
    const auto x_rest = hn::DemoteTo(dh, hn::Sub(x_line, column));
    const auto y_rest = hn::DemoteTo(dh, hn::Sub(y_line, row));
    hn::Store(x_rest, dh, at.x + i);
    hn::Store(y_rest, dh, at.y + i);
    const auto above = hn::RebindMask(di, hn::Lt(x_rest, y_rest));
    hn::Store(hn::IfThenElse(above, hn::Set(di, square.tile->side), hn::Set(di, 1)), di, at.second + i);
  }
  return bits;
}

// Keeps the facets of some pixels, marks those with a nodata post, and prefetches their posts.
inline HWY_NOINLINE void find_facets(const FacetSquare& square, const FacetPlaces& at, std::uint32_t pixels,
                                     Block& block) {
  const FacetTile& tile = *square.tile;
  const auto side = static_cast<std::size_t>(tile.side);
  Facets& facets = block.facets;
  facets.square[facets.squares] = &square;
  facets.pixels[facets.squares] = pixels;
  ++facets.squares;
  const bool is_all = pixels == block.ground;
  if (is_all) facets.places = at;
  for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const auto corner = static_cast<std::size_t>(at.corner[i]);
    __builtin_prefetch(&tile.posts[corner]);
    __builtin_prefetch(&tile.posts[corner + side]);
    if (!tile.nodata.empty() &&
        lod::is_flagged(tile.nodata, corner, side, static_cast<double>(at.x[i]), static_cast<double>(at.y[i])))
      block.nodata |= std::uint32_t{1} << i;
    if (is_all) continue;
    facets.places.corner[i] = at.corner[i];
    facets.places.second[i] = at.second[i];
    facets.places.column[i] = at.column[i];
    facets.places.row[i] = at.row[i];
  }
}

// Finds the facets of the block's ground. `square` is the one that was used last, or null.
inline HWY_NOINLINE void locate_facets(PaintTiles& tiles, const FacetSquare*& square, Block& block) {
  Chart chart;
  int charted = square == nullptr ? -1 : static_cast<int>(square->face);
  if (square != nullptr) set_chart(*square, block, chart);
  FacetPlaces at;
  for (std::uint32_t left = block.ground; left != 0;) {
    std::uint32_t here = square == nullptr ? 0 : inside_facets(*square, chart, left, at);
    if (here == 0) {
      const int i = __builtin_ctz(left);
      square = &tiles.find_facets({block.place[0][i], block.place[1][i], block.place[2][i]});
      if (charted != static_cast<int>(square->face)) set_chart(*square, block, chart);
      charted = static_cast<int>(square->face);
      // The pixel that the square was found for belongs to it, even if rounding puts it just outside.
      here = inside_facets(*square, chart, left, at) | (std::uint32_t{1} << i);
    }
    left &= ~here;
    find_facets(*square, at, here, block);
  }
}

// Sets the visible shares of the sun of pixels in a square, from the facets' normals in `post`.
inline HWY_NOINLINE void take_facet_sun(const PaintJob& job, const FacetTile& tile, std::uint32_t pixels,
                                        Block& block) {
  const glm::dvec3& sun = job.shading->sun;
  for (std::uint32_t left = pixels & ~block.nodata; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const bool lower = block.facets.places.second[i] == 1;
    const auto corner = static_cast<std::size_t>(block.facets.places.corner[i]);
    std::atomic<std::uint8_t>& kept = tile.sun[2 * corner + (lower ? 1 : 0)];
    std::uint8_t seen = kept.load(std::memory_order_relaxed);
    if (seen == FacetTile::kUnknown) {
      const float* const n = block.post[i];
      const bool faces = glm::dot(glm::dvec3(n[0], n[1], n[2]), sun) > 0.0;
      const double spacing_m = lod::nominal_side_m(tile.key.level, job.radius_m) / (tile.side - 1);
      const bool is_seen =
          faces && job.shader->sees_sun(tile.middle(corner, lower, job.radius_m), spacing_m, *job.shading);
      seen = is_seen ? FacetTile::kSeen : FacetTile::kHidden;
      kept.store(seen, std::memory_order_relaxed);
    }
    block.sun[i] = seen == FacetTile::kSeen ? 1.0F : 0.0F;
  }
}

// Holds the facets' first, second and third posts: relief and value.
struct alignas(64) FacetPosts {
  float at[3][kBlock][2];
};

// Sets `middle` of pixels in a square.
inline HWY_NOINLINE void take_middles(const FacetSquare& square, const FacetPosts& posts, std::uint32_t pixels,
                                      Block& block) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const FacetTile::Slopes& slopes = square.tile->slopes;
  const auto one = hn::Set(d, 1.0F);
  const auto slope_u = hn::Set(d, slopes.u);
  const auto slope_v = hn::Set(d, slopes.v);
  const auto west = hn::Set(d, static_cast<float>(square.west.at));
  const auto south = hn::Set(d, static_cast<float>(square.south.at));
  const auto width = hn::Set(d, static_cast<float>(square.west.width));
  const auto height = hn::Set(d, static_cast<float>(square.south.width));
  const auto rise_u = hn::Mul(slope_u, width);
  const auto rise_v = hn::Mul(slope_v, height);
  alignas(64) float across[kBlock], up[kBlock];  // from the lines `west` and `south`, in cells
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    hn::Vec<Floats> r0, r1, r2, unused;
    hn::LoadInterleaved2(d, posts.at[0][i], r0, unused);
    hn::LoadInterleaved2(d, posts.at[1][i], r1, unused);
    hn::LoadInterleaved2(d, posts.at[2][i], r2, unused);
    const auto lower = hn::RebindMask(d, hn::Eq(hn::Load(di, block.facets.places.second + i), hn::Set(di, 1)));
    const auto column = hn::Load(d, block.facets.places.column + i);
    const auto row = hn::Load(d, block.facets.places.row + i);
    const auto u = hn::Add(west, hn::Mul(column, width));
    const auto v = hn::Add(south, hn::Mul(row, height));
    // The mean of the corners (u, v, 1) z.
    const auto plane = hn::Add(hn::Set(d, slopes.base), hn::Add(hn::Mul(slope_u, u), hn::Mul(slope_v, v)));
    const auto z0 = hn::Div(one, hn::Add(plane, r0));
    const auto z1 = hn::Div(one, hn::Add(hn::Add(plane, r1), hn::IfThenElse(lower, rise_u, rise_v)));
    const auto z2 = hn::Div(one, hn::Add(hn::Add(plane, r2), hn::Add(rise_u, rise_v)));
    const auto two = hn::Add(z1, z2);
    const auto per_sum = hn::Div(one, hn::Add(z0, two));
    hn::Store(hn::Add(column, hn::Mul(hn::IfThenElse(lower, two, z2), per_sum)), d, across + i);
    hn::Store(hn::Add(row, hn::Mul(hn::IfThenElse(lower, z2, two), per_sum)), d, up + i);
  }
  if (pixels == block.ground && block.nodata == 0) {
    const Doubles dd;
    const Halves dh;
    const auto along = [&](double sign, const FacetSquare::Line& line, const float* cells,
                           double* out) HWY_ATTR {
      for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(dd))) {
        const auto from_line = hn::Mul(hn::Set(dd, line.width), hn::PromoteTo(dd, hn::Load(dh, cells + i)));
        hn::Store(hn::Mul(hn::Set(dd, sign), hn::Add(hn::Set(dd, line.at), from_line)), dd, out + i);
      }
    };
    along(square.sign[0], square.west, across, block.middle[square.axis[0]]);
    along(square.sign[1], square.south, up, block.middle[square.axis[1]]);
    std::fill_n(block.middle[square.axis[2]], kBlock, square.sign[2]);
    return;
  }
  for (std::uint32_t left = pixels & ~block.nodata; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    block.middle[square.axis[0]][i] =
        square.sign[0] * (square.west.at + square.west.width * static_cast<double>(across[i]));
    block.middle[square.axis[1]][i] =
        square.sign[1] * (square.south.at + square.south.width * static_cast<double>(up[i]));
    block.middle[square.axis[2]][i] = square.sign[2];
  }
}

// Sets `post` of pixels in a square to the facets' normals, of any length, and values.
inline HWY_NOINLINE void take_facet_normals(const FacetSquare& square, const FacetPosts& posts,
                                            std::uint32_t pixels, Block& block) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const FacetTile::Slopes& slopes = square.tile->slopes;
  const auto per_u = hn::Set(d, static_cast<float>(1 / square.west.width));
  const auto per_v = hn::Set(d, static_cast<float>(1 / square.south.width));
  const auto west = hn::Set(d, static_cast<float>(square.west.at));
  const auto south = hn::Set(d, static_cast<float>(square.south.at));
  const auto width = hn::Set(d, static_cast<float>(square.west.width));
  const auto height = hn::Set(d, static_cast<float>(square.south.width));
  const auto sign_u = hn::Set(d, static_cast<float>(square.sign[0]));
  const auto sign_v = hn::Set(d, static_cast<float>(square.sign[1]));
  const auto sign_out = hn::Set(d, static_cast<float>(square.sign[2]));
  alignas(64) float normal[3][kBlock];
  alignas(64) float of_all[kBlock][4];
  const bool is_all = pixels == block.ground;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    hn::Vec<Floats> r0, r1, r2, h0, h1, h2;
    hn::LoadInterleaved2(d, posts.at[0][i], r0, h0);
    hn::LoadInterleaved2(d, posts.at[1][i], r1, h1);
    hn::LoadInterleaved2(d, posts.at[2][i], r2, h2);
    const auto lower = hn::RebindMask(d, hn::Eq(hn::Load(di, block.facets.places.second + i), hn::Set(di, 1)));
    const auto u = hn::Add(west, hn::Mul(hn::Load(d, block.facets.places.column + i), width));
    const auto v = hn::Add(south, hn::Mul(hn::Load(d, block.facets.places.row + i), height));
    const auto before = hn::Sub(r1, r0);
    const auto after = hn::Sub(r2, r1);
    const auto extra_u = hn::Mul(per_u, hn::IfThenElse(lower, before, after));
    const auto extra_v = hn::Mul(per_v, hn::IfThenElse(lower, after, before));
    const auto out =
        hn::Sub(hn::Add(hn::Set(d, slopes.base), r0), hn::Add(hn::Mul(extra_u, u), hn::Mul(extra_v, v)));
    hn::Store(hn::Mul(sign_u, hn::Add(hn::Set(d, slopes.u), extra_u)), d, normal[square.axis[0]] + i);
    hn::Store(hn::Mul(sign_v, hn::Add(hn::Set(d, slopes.v), extra_v)), d, normal[square.axis[1]] + i);
    hn::Store(hn::Mul(sign_out, out), d, normal[square.axis[2]] + i);
    const auto value = hn::Mul(hn::Add(hn::Add(h0, h1), h2), hn::Set(d, 1.0F / 3));
    hn::StoreInterleaved4(hn::Load(d, normal[0] + i), hn::Load(d, normal[1] + i), hn::Load(d, normal[2] + i),
                          value, d, is_all ? block.post[i] : of_all[i]);
  }
  if (is_all) return;
  for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    std::memcpy(block.post[i], of_all[i], sizeof of_all[i]);
  }
}

// Sets `post` of the block's ground, and with `middles` also the places whose colours are shown. Requires
// locate_facets().
inline HWY_NOINLINE void take_facets(const PaintJob& job, bool middles, Block& block) {
  if (middles) {
    const bool sets_all = block.facets.squares == 1 && block.nodata == 0;
    for (int c = 0; c < 3; ++c) {
      if (!sets_all) std::memcpy(block.middle[c], block.place[c], sizeof block.middle[c]);
      block.shown[c] = block.middle[c];
    }
  }
  FacetPosts posts;
  for (int n = 0; n < block.facets.squares; ++n) {
    const FacetSquare& square = *block.facets.square[n];
    const std::uint32_t pixels = block.facets.pixels[n];
    const FacetTile::Post* const all = square.tile->posts.data();
    const int third = square.tile->side + 1;
    for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
      const int i = __builtin_ctz(left);
      const FacetTile::Post* const corner = all + block.facets.places.corner[i];
      std::memcpy(posts.at[0][i], corner, sizeof *corner);
      std::memcpy(posts.at[1][i], corner + block.facets.places.second[i], sizeof *corner);
      std::memcpy(posts.at[2][i], corner + third, sizeof *corner);
    }
    take_facet_normals(square, posts, pixels, block);
    if (middles) take_middles(square, posts, pixels, block);
    if (job.shading->lit && job.shading->shadows) take_facet_sun(job, *square.tile, pixels, block);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vpe::voxel
HWY_AFTER_NAMESPACE();

#endif
