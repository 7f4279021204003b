// Pixels of the textures of a panorama.
#pragma once

#include <cstdint>
#include <vector>

#include "panorama/image/tiled_image.h"
#include "panorama/viewer/level_grid.h"
#include "vpe/overlook/parts.h"

namespace vpe::overlook {

// Side of a texture with its border of one pixel, which lets colours be interpolated up to the edges.
inline constexpr int kBorderedSide_px = kTextureSide_px + 2;

// Returns a texture's pixels, row by row from the top, with its border: red, green, blue, 255. Beyond the end of a full
// circle the image begins again; beyond other ends its last pixels are repeated. Any thread. Throws what
// panorama::TiledImage::tile() throws.
std::vector<std::uint8_t> texture_pixels(const panorama::TiledImage& image, const panorama::LevelGrid& grid,
                                         const TextureKey& key);

}  // namespace vpe::overlook
