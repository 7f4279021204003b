// Parts of the grids of tiles that textures are put together of.
#pragma once

#include "paging/shading/terrain_shader.h"

namespace paging {

// Describes a square part of a tile's grid of posts. Its crossings are texels. Where the planet has no such tile, the
// deepest one above it is interpolated.
struct TexelBlock {
  lod::TileKey tile;
  lod::TileKey image;  // at or above `tile`: imagery is that of its level, or of the deepest above that exists
  int first_x = 0;     // crossings before the block
  int first_y = 0;
  int intervals = 0;
  bool shows_nodata = true;  // false: every texel counts as data
};

// Returns the whole grid of a tile.
TexelBlock whole_block(const lod::TileKey& tile, int post_intervals);

// Returns the part of the grid of a tile, or of one above it, that lies over the tile, with `intervals` a power of two from
// least_intervals() to post_intervals. Imagery is that of the level whose texels are as far apart as the block's, so that
// none are skipped. shows_nodata is true.
TexelBlock coarse_block(const lod::TileKey& tile, int intervals, int post_intervals);

// Textures of tiles above this level are interpolated once more, to even lines.
inline constexpr int kFirstEvenTexture = 5;

// Returns the intervals over a tile of the coarsest posts, those of a tile of level 0; at least 1.
int least_intervals(const lod::TileKey& tile, int post_intervals);

// Names what a texture of a tile is made of: textures of one tile, intervals and parameters with equal versions are equal.
struct TextureVersion {
  std::uint64_t area = 0;  // of the tile, MadeOf::kArea
  std::uint64_t posts =
      0;  // of the tile above of a coarse_block(), whose posts lie farther across the borders; else 0
  std::uint64_t image = 0;  // of the image tile above of a coarse_block(); else 0
  bool operator==(const TextureVersion&) const = default;
};

// Returns the version of the texture that TerrainShader::shade() makes, or shade_facets() where params.flat.
TextureVersion texture_version(const PlanetFile& planet, const lod::TileKey& tile, int intervals,
                               const ShadingParams& params);

}  // namespace paging
