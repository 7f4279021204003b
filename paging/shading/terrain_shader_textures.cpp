// Textures of tiles: put together of blocks, and made again in part where a patch has changed the ground.
#include <algorithm>
#include <bit>
#include <cmath>

#include "paging/shading/terrain_grid.h"
#include "paging/shading/terrain_shader.h"
#include "paging/shading/texel_block.h"
#include "vpe/core/appearance/shading.h"

namespace paging {

namespace {

// Returns the number of blocks along a side of a texture.
std::size_t blocks_along(int intervals, int block_intervals) {
  return static_cast<std::size_t>(intervals / block_intervals);
}

// Resamples texels from post lines to lines even in u and v, in the cells of those blocks that `is_wanted` names. Below level
// 5 a tile spans several knots of the warp, and only on even lines are texture coordinates a projective function of the
// position on every flat triangle.
void make_even(const lod::TileKey& key, int block_intervals, const std::vector<bool>& is_wanted,
               const ShadedTile& tile, std::vector<std::uint8_t>& even) {
  const auto side = static_cast<std::size_t>(tile.intervals) + 1;
  const std::size_t blocks = blocks_along(tile.intervals, block_intervals);
  const auto n = static_cast<std::size_t>(block_intervals);
  const mars::ChartRect rect = lod::chart_rect(key);
  const double tiles = std::ldexp(1.0, key.level);
  const auto positions = [&](double from, double to, std::int32_t index) {
    std::vector<GridPosition> at(side);
    for (std::size_t x = 0; x < side; ++x) {
      const double u = from + (to - from) * static_cast<double>(x) / tile.intervals;
      const double s = (mars::face_parameter(u) * tiles - index) * tile.intervals;
      const auto cell = static_cast<std::size_t>(std::clamp(s, 0.0, tile.intervals - 1.0));
      at[x] = {cell, static_cast<float>(std::clamp(s - static_cast<double>(cell), 0.0, 1.0))};
    }
    return at;
  };
  const auto columns = positions(rect.u0, rect.u1, key.i);
  const auto rows = positions(rect.v0, rect.v1, key.j);
  const auto channels = static_cast<std::size_t>(tile.channels);
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      if (!is_wanted[rows[y].index / n * blocks + columns[x].index / n]) continue;
      std::uint8_t* texel = &even[channels * (y * side + x)];
      for (std::size_t c = 0; c < channels; ++c) {
        texel[c] = to_byte(bilinear<float>(columns[x], rows[y], side, [&](std::size_t at) {
          return static_cast<float>(tile.texels[channels * at + c]);
        }));
      }
      if (channels == 4) texel[3] = texel[3] < 128 ? 0 : 255;
    }
  }
}

// Adds to named blocks those beside and diagonal to them, towards smaller indices or larger ones.
std::vector<bool> widened(const std::vector<bool>& named, std::size_t blocks, bool to_smaller) {
  std::vector<bool> out = named;
  for (std::size_t by = 0; by < blocks; ++by) {
    for (std::size_t bx = 0; bx < blocks; ++bx) {
      const bool at_end_x = to_smaller ? bx + 1 == blocks : bx == 0;
      const bool at_end_y = to_smaller ? by + 1 == blocks : by == 0;
      const std::size_t x = at_end_x ? bx : to_smaller ? bx + 1 : bx - 1;
      const std::size_t y = at_end_y ? by : to_smaller ? by + 1 : by - 1;
      if (named[by * blocks + x] || named[y * blocks + bx] || named[y * blocks + x])
        out[by * blocks + bx] = true;
    }
  }
  return out;
}

// Copies the texels of named blocks that no later block has too.
void copy_blocks(const ShadedTile& from, int block_intervals, const std::vector<bool>& named,
                 std::vector<std::uint8_t>& texels) {
  const auto side = static_cast<std::size_t>(from.intervals) + 1;
  const std::size_t blocks = blocks_along(from.intervals, block_intervals);
  const auto n = static_cast<std::size_t>(block_intervals);
  const auto channels = static_cast<std::size_t>(from.channels);
  for (std::size_t by = 0; by < blocks; ++by) {
    for (std::size_t bx = 0; bx < blocks; ++bx) {
      if (!named[by * blocks + bx]) continue;
      const std::size_t width = n + (bx + 1 == blocks ? 1 : 0);
      const std::size_t height = n + (by + 1 == blocks ? 1 : 0);
      for (std::size_t y = by * n; y < by * n + height; ++y) {
        const auto at = static_cast<std::ptrdiff_t>(channels * (y * side + bx * n));
        std::copy_n(from.texels.begin() + at, channels * width, texels.begin() + at);
      }
    }
  }
}

std::size_t texel_bytes(const ShadedTile& tile) {
  const auto side = static_cast<std::size_t>(tile.intervals) + 1;
  return static_cast<std::size_t>(tile.channels) * side * side;
}

}  // namespace

std::size_t TerrainShader::KeptTexture::bytes() const {
  return sizeof(KeptTexture) + tile.bytes() + sources.capacity() * sizeof(BlockSource) + nodata.capacity() / 8;
}

TerrainShader::BlockSource TerrainShader::block_source(const lod::TileKey& block,
                                                       const ShadingParams& params) const {
  const lod::TileKey ground = deepest(block);
  BlockSource source{{ground, shading_version(*planet_, ground, MadeOf::kBorders, params)}, {}};
  if (!shows_image(params.colour_source)) return source;
  if (const auto image = planet_->image_key(block))
    source.image = {*image, planet_->version(*image, MadeOf::kImage)};
  return source;
}

void TerrainShader::shade_blocks(const lod::TileKey& key, const std::vector<bool>& is_wanted,
                                 const ShadingParams& params, ShadedTile& out,
                                 std::vector<bool>& nodata) const {
  const int n = planet_->meta().tile.intervals();
  const int blocks = out.intervals / n;
  const int level = key.level + std::countr_zero(static_cast<unsigned>(blocks));
  for (int by = 0; by < blocks; ++by) {
    for (int bx = 0; bx < blocks; ++bx) {
      const auto at = static_cast<std::size_t>(by * blocks + bx);
      if (!is_wanted[at]) continue;
      out.nodata = false;
      shade_block(whole_block({key.face, level, key.i * blocks + bx, key.j * blocks + by}, n), bx * n, by * n,
                  out.intervals + 1, params, out);
      nodata[at] = out.nodata;
    }
  }
}

// An even texel lies in a cell of one block. The corners of the cell may belong to the blocks after it, which shade the
// texels that both have last.
void TerrainShader::shade_changed(const lod::TileKey& key, const ShadingParams& params, const KeptTexture& kept,
                                  const std::vector<BlockSource>& sources, ShadedTile& out,
                                  std::vector<bool>& nodata) const {
  const int n = planet_->meta().tile.intervals();
  const std::size_t blocks = blocks_along(out.intervals, n);
  out.texels = kept.tile.texels;
  nodata = kept.nodata;
  std::vector<bool> changed(sources.size());
  for (std::size_t at = 0; at < sources.size(); ++at) changed[at] = sources[at] != kept.sources[at];
  if (std::ranges::count(changed, true) == 0) return;
  const bool is_even = key.level < kFirstEvenTexture;
  if (is_even) changed = widened(changed, blocks, true);
  ShadedTile raw = out;
  raw.texels.assign(texel_bytes(raw), 0);
  shade_blocks(key, is_even ? widened(changed, blocks, false) : changed, params, raw, nodata);
  if (is_even) {
    make_even(key, n, changed, raw, out.texels);
  } else {
    copy_blocks(raw, n, changed, out.texels);
  }
}

void TerrainShader::shade_coarse(const lod::TileKey& key, const ShadingParams& params, ShadedTile& out) const {
  const int n = planet_->meta().tile.intervals();
  TexelBlock block = coarse_block(key, out.intervals, n);
  // However near the camera is, these textures are no finer than posts.
  if (params.colour_source == ColourSource::kImageAtPosts && out.intervals == n) block.image = key;
  // The posts above are those of neighbours too.
  block.shows_nodata = planet_->has_nodata(key) || shows_difference(params);
  out.texels.resize(texel_bytes(out));
  shade_block(block, 0, 0, out.intervals + 1, params, out);
  if (key.level >= kFirstEvenTexture) return;
  std::vector<std::uint8_t> even(out.texels.size());
  make_even(key, out.intervals, {true}, out, even);
  out.texels = std::move(even);
}

ShadedTile TerrainShader::shade(const lod::TileKey& key, int intervals, const ShadingParams& params) const {
  const int n = planet_->meta().tile.intervals();
  ShadedTile out;
  out.intervals = intervals;
  out.nodata_image = shows_image(params.colour_source);
  // Light alone takes a quarter of the bytes, but has no alpha for nodata.
  if (params.colour_source == ColourSource::kPlain && params.lit && !planet_->has_nodata(key)) {
    out.channels = 1;
    out.brightest = vpe::core::light(params.ambient, params.diffuse, 1.0);
  }
  if (intervals <= n) {
    shade_coarse(key, params, out);
    return out;
  }
  const int blocks = out.intervals / n;
  std::vector<bool> nodata(static_cast<std::size_t>(blocks) * static_cast<std::size_t>(blocks));
  const bool is_kept = shares_.textures > 0 && blocks > 1 && planet_->is_patched(key, MadeOf::kArea);
  std::vector<BlockSource> sources;
  const TextureKey texture{key, out.intervals, is_kept ? params : ShadingParams()};
  std::shared_ptr<const KeptTexture> kept;
  if (is_kept) {
    const int level = key.level + std::countr_zero(static_cast<unsigned>(blocks));
    for (int by = 0; by < blocks; ++by)
      for (int bx = 0; bx < blocks; ++bx)
        sources.push_back(block_source({key.face, level, key.i * blocks + bx, key.j * blocks + by}, params));
    kept = textures_.find(texture);
  }
  if (kept && kept->tile.channels == out.channels) {
    shade_changed(key, params, *kept, sources, out, nodata);
  } else {
    out.texels.resize(texel_bytes(out));
    const std::vector<bool> all(nodata.size(), true);
    shade_blocks(key, all, params, out, nodata);
    if (key.level < kFirstEvenTexture) {
      std::vector<std::uint8_t> even(out.texels.size());
      make_even(key, n, all, out, even);
      out.texels = std::move(even);
    }
  }
  out.nodata = std::ranges::count(nodata, true) > 0;
  if (is_kept) {
    auto keep = std::make_shared<const KeptTexture>(KeptTexture{out, std::move(sources), std::move(nodata)});
    const std::size_t bytes = keep->bytes();
    textures_.erase(texture);  // of the planet before
    textures_.insert(texture, std::move(keep), bytes);
  }
  return out;
}

}  // namespace paging
