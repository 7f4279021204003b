// Mesh and texture that a tile is to be drawn with: pure functions of the view and the settings.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "lod/select.h"
#include "vpe/core/frame.h"
#include "vpe/gl/residency.h"
#include "vpe/gl/tile_page.h"

namespace vpe::gl {

// Ways to colour ground.
enum class PaintMethod {
  kColour,   // one colour
  kPalette,  // the program computes the colour from the height of what is drawn; a texture where meshes are too
             // coarse for the palette
  kTexture,  // ShadedTile: a grid, or facets with flat shading
};

// Describes the light that is computed at the vertices of the drawn triangles and interpolated over them (Shading::kVertex).
struct VertexLight {
  glm::dvec3 sun{1, 0, 0};  // unit, body-fixed, towards the sun
  double ambient = 0;       // core::light()
  double diffuse = 1;
  bool shadows = false;
  bool operator==(const VertexLight&) const = default;
};

// Describes how ground is drawn in an appearance.
struct TileMaterial {
  PaintMethod method = PaintMethod::kTexture;
  bool shows_nodata = true;    // nodata ground looks different: its tiles have textures with every method
  double palette_error_m = 0;  // height error that a palette may show: a 256th of its range
  ShadingParams shading;       // of textures
  // None: light, if any, is in the textures. Else the textures have none, and do not depend on the sun.
  std::optional<VertexLight> light = {};
  bool operator==(const TileMaterial&) const = default;
};

// Returns the material of an appearance. scale: the scale of its colours; null where it shows none
// (paging::needs_scale).
TileMaterial material(const core::Appearance& appearance, const glm::dvec3& sun, bool has_image,
                      std::shared_ptr<const core::ColourScale> scale);

// Returns the sun whose shadows are in the normals of vertices; none for materials without such shadows. Meshes of two
// suns cannot be mixed.
std::optional<glm::dvec3> shadow_sun(const TileMaterial& material);

// Intervals of the smallest texture that is not coarser than posts, if these are no finer.
inline constexpr int kSmallestTexture = 128;

// Returns true if a tile needs a texture.
bool is_textured(const lod::TileKey& tile, const paging::PlanetFile& planet, const TileMaterial& material);

// Returns true if a tile's vertices need chart coordinates.
bool needs_charts(const lod::TileKey& tile, const paging::PlanetFile& planet, const TileMaterial& material);

struct TileNeed {
  MeshDetail mesh;
  int texture = 0;  // 0: none; > 0: intervals of its grid; < 0: facet_texture(variant)
};

struct NeedOptions {
  TileMaterial material;
  std::size_t texture_bytes = 0;  // for the textures of all the tiles
};

// Returns the need of each tile. Textures have about one texel a pixel at the tile's nearest point, unless the data
// or the memory allows less, so that tiles that are small in the image do not flicker.
std::vector<TileNeed> tile_needs(std::span<const lod::SelectedTile> tiles, const core::View& view,
                                 const paging::PlanetFile& planet, const TerrainShader& terrain_shader,
                                 const NeedOptions& options);

}  // namespace vpe::gl
