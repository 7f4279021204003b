// Keeps what the painter makes of tiles beside paging::TerrainShader: facets for flat shading, and the image's colours
// at posts.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): under PaintTiles.
#pragma once

#include <memory>

#include "vpe/base/lru_cache.h"
#include "vpe/voxel/paint/facet_tile.h"
#include "vpe/voxel/paint/post_colours.h"

namespace vpe::voxel {

// Any thread may call get functions.
class MadeTiles {
 public:
  // Smaller budgets make tiles again more often.
  explicit MadeTiles(std::size_t budget_bytes) : tiles_(budget_bytes) {}

  // Return what make_facet_tile() and make_post_colours() do, of equal planets between two calls of clear(). Throw
  // paging::PlanetError.
  std::shared_ptr<const FacetTile> facets(const paging::PlanetFile& planet, const paging::TerrainShader& shader,
                                          const lod::TileKey& key, const paging::ShadingParams& shading);
  std::shared_ptr<const PostColours> colours(const paging::PlanetFile& planet,
                                             const paging::TerrainShader& shader, const lod::TileKey& key,
                                             int image_level, const paging::ShadingParams& shading);

  void clear() { tiles_.clear(); }
  std::size_t bytes() const { return tiles_.bytes(); }

 private:
  struct Key {
    lod::TileKey tile;
    int image_level;  // -1: facets
    // Of facets: 1 or the exaggeration, the sun where shadows are cast, else 0, and whether heights are differences.
    double exaggeration = 1;
    glm::dvec3 sun{0, 0, 0};
    bool differences = false;
    paging::ImageStretch stretch = {};  // of colours
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const {
      return lod::TileKeyHash()(key.tile) ^
             (static_cast<std::size_t>(key.image_level) * std::size_t{0x9e3779b9});
    }
  };
  base::LruCache<Key, void, KeyHash> tiles_;
};

}  // namespace vpe::voxel
