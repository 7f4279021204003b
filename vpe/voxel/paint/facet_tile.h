// Holds the facets of a tile of the reference surface, for flat shading.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): MadeTiles keeps them, PaintTiles finds them, and take_facets()
// (paint_facets-inl.h) turns them into normals. On a face with axes (right, up, out) and chart coordinates (u, v)
// = (x, y) / z a flat facet has 1 / z = a u + b v + c, so (a, b, c) is its normal: two differences between posts give
// it, without places of corners.
#pragma once

#include <atomic>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "paging/shading/terrain_shader.h"

namespace vpe::voxel {

struct FacetTile {
  // 8 bytes, so that one load takes all of a post.
  struct Post {
    float relief;  // radius / z of the post less base + slope_u u + slope_v v
    float value;   // height, metres; where paging::shows_difference(), that above the earlier ground
  };
  struct Slopes {
    float u, v, base;
  };

  lod::TileKey key;
  int side = 0;              // lines
  Slopes slopes;             // of 1 / z, in units of 1 / radius
  std::vector<Post> posts;   // row 0 at the south
  std::vector<bool> nodata;  // by post; empty when every post has data
  std::size_t bytes() const;

  // Returns the middle of a facet of the cell whose south-west post is `corner`: below the diagonal from there, or
  // above. Body-fixed, metres.
  glm::dvec3 middle(std::size_t corner, bool lower, double radius_m) const;

  // Says whether the sun is seen from the middle of a facet: found out when it is first asked for, as few of a far tile's
  // facets are. 2 * corner + 1 is the number of the facet below the diagonal, 2 * corner of the one above. Empty without
  // shadows.
  enum Sun : std::uint8_t { kUnknown, kHidden, kSeen };
  std::unique_ptr<std::atomic<std::uint8_t>[]> sun;
};

// Makes the facets of a tile that the planet has, with heights times shading.exaggeration. Throws paging::PlanetError.
std::shared_ptr<const FacetTile> make_facet_tile(const paging::PlanetFile& planet,
                                                 const paging::TerrainShader& shader, const lod::TileKey& key,
                                                 const paging::ShadingParams& shading);

}  // namespace vpe::voxel
