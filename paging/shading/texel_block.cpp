#include "paging/shading/texel_block.h"

#include <algorithm>
#include <bit>

namespace paging {

namespace {

int levels_between(int fewer, int more) {
  return std::countr_zero(static_cast<unsigned>(more)) - std::countr_zero(static_cast<unsigned>(fewer));
}

}  // namespace

TexelBlock whole_block(const lod::TileKey& tile, int post_intervals) {
  TexelBlock block;
  block.tile = block.image = tile;
  block.intervals = post_intervals;
  return block;
}

TexelBlock coarse_block(const lod::TileKey& tile, int intervals, int post_intervals) {
  const int up = levels_between(intervals, post_intervals);
  TexelBlock block;
  block.tile = lod::ancestor(tile, tile.level - up);
  const int finer = std::max(0, levels_between(post_intervals, kImageIntervals));
  block.image = lod::ancestor(tile, std::max(0, block.tile.level - finer));
  block.first_x = (tile.i - (block.tile.i << up)) * intervals;
  block.first_y = (tile.j - (block.tile.j << up)) * intervals;
  block.intervals = intervals;
  return block;
}

int least_intervals(const lod::TileKey& tile, int post_intervals) {
  return std::max(1, post_intervals >> tile.level);
}

TextureVersion texture_version(const PlanetFile& planet, const lod::TileKey& tile, int intervals,
                               const ShadingParams& params) {
  TextureVersion version;
  version.area = shading_version(planet, tile, MadeOf::kArea, params);
  const int n = planet.meta().tile.intervals();
  if (params.flat || intervals > n) return version;
  const TexelBlock block = coarse_block(tile, intervals, n);
  version.posts = shading_version(planet, planet.tree().deepest(block.tile).key, MadeOf::kBorders, params);
  if (!shows_image(params.colour_source)) return version;
  if (const auto image = planet.image_key(block.image)) version.image = planet.version(*image, MadeOf::kImage);
  return version;
}

}  // namespace paging
