// Pages: what a tile needs to be drawn, made on the CPU. No OpenGL.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "lod/occluder_profile.h"
#include "paging/planet/planet_file.h"
#include "paging/shading/terrain_shader.h"
#include "vpe/gl/tile_geometry.h"

namespace vpe::gl {

using paging::ShadedTile;
using paging::ShadingParams;
using paging::TerrainShader;

enum class PageKind : std::uint8_t {
  kMesh,     // geometry of a variant, relative to an origin, at an exaggeration
  kTexture,  // colours or light with given shading
  kGround,   // posts of a finest tile, as drawn at an exaggeration
};

struct PageKey {
  PageKind kind = PageKind::kMesh;
  lod::TileKey tile;
  int detail = 0;                                // variant, or TileNeed::texture
  int origin = kTileCentre;                      // meshes only
  bool charts = true;                            // meshes only
  double exaggeration = 1;                       // meshes and posts only
  std::shared_ptr<const ShadingParams> shading;  // textures only; equal shading is one object
  bool occluders = false;                        // meshes only: with their occluder profile
  bool normals = false;                          // meshes only
  // Meshes with normals only: towards the sun that the ground may hide from vertices. None: no shadows.
  std::optional<glm::dvec3> shadow_sun = {};
  bool operator==(const PageKey&) const = default;
};
struct PageKeyHash {
  std::size_t operator()(const PageKey& k) const {
    return (lod::TileKeyHash()(k.tile) * 31 + static_cast<std::size_t>(k.detail)) * 4 +
           static_cast<std::size_t>(k.kind) + (k.charts ? 7 : 0) +
           1009 * static_cast<std::size_t>(k.origin + 1);
  }
};

// Returns the parameters of the normals of vertices (TerrainShader::vertex_normals) at an exaggeration, with the shadows of
// a sun or without.
ShadingParams normal_params(double exaggeration, const std::optional<glm::dvec3>& shadow_sun);

// Converts a variant to the TileNeed::texture of the facets of its mesh, and back.
constexpr int facet_texture(int variant) { return -1 - variant; }
constexpr int variant_of_facets(int texture) { return -1 - texture; }

// Holds the member of the key's kind; the others are empty.
struct Page {
  TileGeometry geometry;
  std::shared_ptr<const lod::OccluderProfile> occluders;  // of the geometry; null unless requested
  ShadedTile shaded;
  std::shared_ptr<const paging::TileHeights> ground;
  std::string coarse_because;  // why the texture has fewer texels than asked for; "" if it has not
};

// Makes pages from a planet file. Thread rule: any thread may call load().
class PageLoader {
 public:
  PageLoader(std::shared_ptr<const paging::PlanetFile> planet,
             std::shared_ptr<const TerrainShader> terrain_shader)
      : planet_(std::move(planet)), terrain_shader_(std::move(terrain_shader)) {}

  // Returns the page and its bytes. Throws paging::PlanetError that names the tile.
  std::pair<Page, std::size_t> load(const PageKey& key) const;

 private:
  ShadedTile shade(const PageKey& key, std::string& coarse_because) const;
  // Calls visit(mesh, heights of its vertices as drawn) for one of a tile's meshes. Its triangles are in the order of
  // pieces (mesh_pieces.h), which facets share.
  template <typename Visit>
  void with_mesh(const lod::TileKey& tile, int variant, double exaggeration, Visit&& visit) const;

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::shared_ptr<const TerrainShader> terrain_shader_;
};

}  // namespace vpe::gl
