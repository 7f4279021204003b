#include "vpe/gl/tile_page.h"

#include <algorithm>

namespace vpe::gl {

TileGeometry PageLoader::geometry(const PageKey& key) const {
  const lod::TileInfo* info = planet_->tree().find(key.tile);
  if (lod::is_full_grid(*info, key.detail)) {
    const paging::TileHeights heights = planet_->heights(key.tile);
    return make_geometry(key.tile, lod::mesh_full(heights.posts.intervals), heights.posts.height_m,
                         key.exaggeration, planet_->radius_m(), key.origin);
  }
  const paging::PackedMesh packed = planet_->mesh(key.tile, key.detail);
  std::vector<double> heights(packed.height_q.size());
  std::transform(packed.height_q.begin(), packed.height_q.end(), heights.begin(),
                 [q = planet_->meta().quantum_m](std::int32_t n) { return n * q; });
  return make_geometry(key.tile, packed.mesh, heights, key.exaggeration, planet_->radius_m(), key.origin);
}

std::pair<Page, std::size_t> PageLoader::load(const PageKey& key) const {
  Page page;
  switch (key.kind) {
    case PageKind::kMesh: {
      page.geometry = geometry(key);
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
