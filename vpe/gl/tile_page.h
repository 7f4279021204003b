// What a tile needs to be drawn, made on the CPU by any thread. No OpenGL.
#pragma once

#include <cstdint>
#include <memory>
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
  kMesh,     // of a variant, relative to an origin, at an exaggeration
  kTexture,  // as a look paints it
  kGround,   // posts of a finest tile, as drawn at an exaggeration
};

struct PageKey {
  PageKind kind = PageKind::kMesh;
  lod::TileKey tile;
  int detail = 0;  // variant, or TileNeed::paint
  int origin = kTileCentre;
  bool charts = true;                            // of meshes
  double exaggeration = 1;                       // of meshes and posts
  std::shared_ptr<const ShadingParams> shading;  // of textures; equal looks are one object
  bool occluders = false;                        // of meshes: with them
  bool operator==(const PageKey&) const = default;
};
struct PageKeyHash {
  std::size_t operator()(const PageKey& k) const {
    return (lod::TileKeyHash()(k.tile) * 31 + static_cast<std::size_t>(k.detail)) * 4 +
           static_cast<std::size_t>(k.kind) + (k.charts ? 7 : 0) +
           1009 * static_cast<std::size_t>(k.origin + 1);
  }
};

// TileNeed::paint of the facets of a variant's mesh, and back.
constexpr int facet_paint(int variant) { return -1 - variant; }
constexpr int painted_variant(int paint) { return -1 - paint; }

// The member of the key's kind is there.
struct Page {
  TileGeometry geometry;
  std::shared_ptr<const lod::OccluderProfile> occluders;  // of the geometry; null unless asked for
  ShadedTile shaded;
  std::shared_ptr<const paging::TileHeights> ground;
};

// Thread rule: any thread may load.
class PageLoader {
 public:
  PageLoader(std::shared_ptr<const paging::PlanetFile> planet, std::shared_ptr<const TerrainShader> painter)
      : planet_(std::move(planet)), painter_(std::move(painter)) {}

  // The page and its bytes. Throws paging::PlanetError that names the tile.
  std::pair<Page, std::size_t> load(const PageKey& key) const;

 private:
  // visit(mesh, heights of its vertices, drawn so many times as high) for one of a tile's meshes.
  template <typename Visit>
  void with_mesh(const lod::TileKey& tile, int variant, double exaggeration, Visit&& visit) const;

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::shared_ptr<const TerrainShader> painter_;
};

}  // namespace vpe::gl
