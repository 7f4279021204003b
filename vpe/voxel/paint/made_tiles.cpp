#include "vpe/voxel/paint/made_tiles.h"

namespace vpe::voxel {

std::shared_ptr<const FacetTile> MadeTiles::facets(const paging::PlanetFile& planet,
                                                   const paging::TerrainShader& shader, const lod::TileKey& key,
                                                   const paging::ShadingParams& shading) {
  const Key name{
      key,
      -1,
      shading.exaggeration,
      shading.lit && shading.shadows ? shading.sun : glm::dvec3(0),
      paging::shows_difference(shading),
  };
  return std::static_pointer_cast<const FacetTile>(tiles_.get(name, [&] {
    const auto made = make_facet_tile(planet, shader, key, shading);
    return std::pair(std::shared_ptr<const void>(made), made->bytes());
  }));
}

std::shared_ptr<const PostColours> MadeTiles::colours(const paging::PlanetFile& planet,
                                                      const paging::TerrainShader& shader,
                                                      const lod::TileKey& key, int image_level,
                                                      const paging::ShadingParams& shading) {
  Key name{key, image_level};
  name.stretch = shading.stretch;
  return std::static_pointer_cast<const PostColours>(tiles_.get(name, [&] {
    const auto made = make_post_colours(planet, shader, key, image_level, shading);
    return std::pair(std::shared_ptr<const void>(made), made->bytes());
  }));
}

}  // namespace vpe::voxel
