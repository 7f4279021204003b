// Which mesh and which texture a tile is to be drawn with: pure functions of the view and the settings.
#pragma once

#include <span>
#include <vector>

#include "lod/select.h"
#include "vpe/core/frame.h"
#include "vpe/gl/residency.h"

namespace vpe::gl {

ShadeParams shade_params(const core::DrawRequest& request, bool has_image);

inline constexpr int kSmallestTexture = 128;

// Whether a tile is drawn with a texture. Unlit ground has one colour; its textures only say where there is no
// data.
bool is_textured(const lod::TileKey& tile, const paging::PlanetFile& planet, core::Mode mode);

struct TileNeed {
  MeshDetail mesh;
  int texture_intervals = 0;  // 0: none
};

struct NeedOptions {
  core::Mode mode = core::Mode::kTextured;
  Surfacing surfacing = Surfacing::kImage;
  std::size_t texture_bytes = 0;  // for the textures of all the tiles
};

// One for each tile. Textures have one texel a pixel at the tile's nearest point, unless the data or the memory
// has less.
std::vector<TileNeed> tile_needs(std::span<const lod::SelectedTile> tiles, const core::View& view,
                                 const paging::PlanetFile& planet, const Shader& shader,
                                 const NeedOptions& options);

}  // namespace vpe::gl
