#include "vpe/gl/tile_page.h"

#include <algorithm>
#include <span>

namespace vpe::gl {

void PageLoader::make_mesh(const PageKey& key, Page& page) const {
  const double radius_m = planet_->radius_m();
  const auto make = [&](const lod::TileMesh& mesh, std::span<const double> height_m) {
    page.geometry = make_geometry(key.tile, mesh, height_m, key.exaggeration, radius_m, key.origin);
    page.walls =
        lod::make_walls(key.tile, mesh, height_m, key.exaggeration, radius_m, page.geometry.quantisation_m);
  };
  if (lod::is_full_grid(*planet_->tree().find(key.tile), key.detail)) {
    const paging::TileHeights heights = planet_->heights(key.tile);
    make(lod::mesh_full(heights.posts.intervals), heights.posts.height_m);
    return;
  }
  const paging::PackedMesh packed = planet_->mesh(key.tile, key.detail);
  std::vector<double> heights(packed.height_q.size());
  std::transform(packed.height_q.begin(), packed.height_q.end(), heights.begin(),
                 [q = planet_->meta().quantum_m](std::int32_t n) { return n * q; });
  make(packed.mesh, heights);
}

std::pair<Page, std::size_t> PageLoader::load(const PageKey& key) const {
  Page page;
  switch (key.kind) {
    case PageKind::kMesh: {
      make_mesh(key, page);
      const std::size_t bytes = page.geometry.bytes();
      return {std::move(page), bytes};
    }
    case PageKind::kTexture: {
      page.shaded = shader_->shade(key.tile, key.detail, *key.look);
      const std::size_t bytes = page.shaded.bytes();
      return {std::move(page), bytes};
    }
    case PageKind::kGround: break;
  }
  page.ground = std::make_shared<const paging::TileHeights>(planet_->heights(key.tile));
  return {page, page.ground->posts.height_m.size() * sizeof(double)};
}

}  // namespace vpe::gl
