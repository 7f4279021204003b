// Holds the image's colours at the posts of a tile, for ground between whose posts they are interpolated
// (paging::ColourSource::kImageAtPosts).
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): MadeTiles keeps them for PaintTiles.
#pragma once

#include <memory>
#include <vector>

#include "paging/shading/terrain_shader.h"

namespace vpe::voxel {

struct PostColours {
  static constexpr int kPerUnit = 257;  // values of 65535 stand for 255
  int side = 0;                         // lines
  std::vector<std::uint16_t> texels;    // red, green, blue, 0 of each post, row 0 at the south
  std::size_t bytes() const { return sizeof(*this) + texels.capacity() * sizeof(std::uint16_t); }
};

// Samples the image at the posts of a tile that the planet has, in tiles of a level or the deepest above it. Throws
// paging::PlanetError.
std::shared_ptr<const PostColours> make_post_colours(const paging::PlanetFile& planet,
                                                     const paging::TerrainShader& shader,
                                                     const lod::TileKey& key, int image_level,
                                                     const paging::ShadingParams& shading);

}  // namespace vpe::voxel
