#include "vpe/gl/tile_page.h"

#include <algorithm>
#include <span>

namespace vpe::gl {

ShadingParams normal_params(double exaggeration, const std::optional<glm::dvec3>& shadow_sun) {
  ShadingParams params;
  params.exaggeration = exaggeration;
  params.lit = params.shadows = shadow_sun.has_value();
  if (shadow_sun) params.sun = *shadow_sun;
  return params;
}

template <typename Visit>
void PageLoader::with_mesh(const lod::TileKey& tile, int variant, double exaggeration, Visit&& visit) const {
  if (lod::is_full_grid(*planet_->tree().find(tile), variant)) {
    const paging::TileHeights heights = planet_->heights(tile, exaggeration);
    lod::TileMesh mesh = lod::mesh_full(heights.posts.intervals);
    order_by_pieces(mesh);
    visit(mesh, std::span<const double>(heights.posts.height_m));
    return;
  }
  paging::PackedMesh packed = planet_->mesh(tile, variant);
  order_by_pieces(packed.mesh);
  std::vector<double> heights(packed.height_q.size());
  std::transform(packed.height_q.begin(), packed.height_q.end(), heights.begin(),
                 [q = planet_->meta().quantum_m](std::int32_t n) { return n * q; });
  visit(packed.mesh, std::span<const double>(heights));
}

// Finer texels need the posts of tiles below this one, coarser ones those of a tile above. Where these cannot be read, texels
// nearer to the tile's own posts serve.
ShadedTile PageLoader::shade(const PageKey& key, std::string& coarse_because) const {
  const int posts = planet_->meta().tile.intervals();
  for (int intervals = key.detail;;) {
    try {
      return terrain_shader_->shade(key.tile, intervals, *key.shading);
    } catch (const paging::PlanetError& e) {
      if (intervals == posts) throw;
      if (intervals > posts) coarse_because = e.what();
      intervals = intervals > posts ? intervals / 2 : posts;
    }
  }
}

std::pair<Page, std::size_t> PageLoader::load(const PageKey& key) const {
  Page page;
  switch (key.kind) {
    case PageKind::kMesh: {
      const double radius_m = planet_->radius_m();
      with_mesh(key.tile, key.detail, key.exaggeration,
                [&](const lod::TileMesh& mesh, std::span<const double> height_m) {
                  std::vector<glm::vec3> normals;
                  if (key.normals)
                    normals = terrain_shader_->vertex_normals(key.tile, mesh, height_m,
                                                              normal_params(key.exaggeration, key.shadow_sun));
                  page.geometry = make_geometry(key.tile, mesh, height_m, radius_m,
                                                {key.exaggeration, key.origin, key.charts, normals});
                  if (!key.occluders) return;
                  page.occluders = std::make_shared<const lod::OccluderProfile>(lod::make_occluder_profile(
                      key.tile, mesh, height_m, key.exaggeration, radius_m, page.geometry.quantisation_m));
                });
      const std::size_t bytes = page.geometry.bytes();
      return {std::move(page), bytes};
    }
    case PageKind::kTexture: {
      if (key.shading->flat) {
        with_mesh(key.tile, variant_of_facets(key.detail), key.shading->exaggeration,
                  [&](const lod::TileMesh& mesh, std::span<const double> height_m) {
                    page.shaded = terrain_shader_->shade_facets(key.tile, mesh, height_m, *key.shading);
                    for (const std::uint32_t triangle : border_triangles(mesh)) {
                      for (std::size_t c = 0; c < 4; ++c)
                        page.shaded.texels.push_back(page.shaded.texels[4 * triangle + c]);
                    }
                  });
      } else {
        page.shaded = shade(key, page.coarse_because);
      }
      const std::size_t bytes = page.shaded.bytes();
      return {std::move(page), bytes};
    }
    case PageKind::kGround: break;
  }
  page.ground = std::make_shared<const paging::TileHeights>(planet_->heights(key.tile, key.exaggeration));
  return {page, page.ground->posts.height_m.size() * sizeof(double)};
}

}  // namespace vpe::gl
