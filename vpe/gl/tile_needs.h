// Which mesh and which texture a tile is to be drawn with: pure functions of the view and the settings.
#pragma once

#include <span>
#include <vector>

#include "lod/select.h"
#include "vpe/core/frame.h"
#include "vpe/gl/residency.h"
#include "vpe/gl/tile_page.h"

namespace vpe::gl {

// How an appearance paints ground.
enum class PaintMethod {
  kColour,   // one colour
  kPalette,  // colour of the height of what is drawn, by the program; where its meshes are too coarse for the
             // palette a texture
  kTexture,  // ShadedTile: a grid, or with flat shading facets
};

struct TileMaterial {
  PaintMethod by = PaintMethod::kTexture;
  bool shows_nodata = true;    // ground without data looks different: such tiles have textures in any case
  double palette_error_m = 0;  // relief that a palette may be off: a 256th of its range
  ShadingParams shading;       // of textures
  bool operator==(const TileMaterial&) const = default;
};

// scale: of the appearance; null where it shows none (paging::needs_scale).
TileMaterial material(const core::Appearance& appearance, const glm::dvec3& sun, bool has_image,
                      std::shared_ptr<const core::ColourScale> scale);

inline constexpr int kSmallestTexture = 128;

bool is_textured(const lod::TileKey& tile, const paging::PlanetFile& planet, const TileMaterial& material);

// Whether vertices need to know where they are in their tile.
bool needs_charts(const lod::TileKey& tile, const paging::PlanetFile& planet, const TileMaterial& material);

struct TileNeed {
  MeshDetail mesh;
  int paint = 0;  // 0: no texture; > 0: intervals of its grid; < 0: facet_paint(variant)
};

struct NeedOptions {
  TileMaterial material;
  std::size_t texture_bytes = 0;  // for the textures of all the tiles
};

// One for each tile. Textures have one texel a pixel at the tile's nearest point, unless the data or the memory
// has less.
std::vector<TileNeed> tile_needs(std::span<const lod::SelectedTile> tiles, const core::View& view,
                                 const paging::PlanetFile& planet, const TerrainShader& painter,
                                 const NeedOptions& options);

}  // namespace vpe::gl
