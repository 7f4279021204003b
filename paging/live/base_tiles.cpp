#include "paging/live/base_tiles.h"

#include "paging/build/build_grid.h"

namespace paging {

namespace {

// A meter holds the inverse depths of its posts and little more.
constexpr std::size_t kMeterBytesOfPost = 5 * sizeof(double);

}  // namespace

std::size_t BaseInner::bytes() const {
  return sizeof(BaseInner) + (quanta.capacity() + mesh.height_q.capacity()) * sizeof(std::int32_t) +
         nodata.capacity() / 8 + mesh.mesh.vertices.capacity() * sizeof(lod::MeshVertex) +
         mesh.mesh.triangles.capacity() * sizeof(std::uint16_t);
}

BaseTiles::BaseTiles(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes)
    : planet_(std::move(planet)), inner_(budget_bytes / 2), meters_(budget_bytes / 2) {}

std::shared_ptr<const BaseInner> BaseTiles::inner(const lod::TileKey& key) const {
  return inner_.get(key, [&] {
    TileHeights heights = planet_->heights(key);
    auto made = std::make_shared<const BaseInner>(
        BaseInner{to_quanta(heights.posts.height_m, planet_->meta().quantum_m), std::move(heights.nodata),
                  planet_->mesh(key, 0)});
    const std::size_t bytes = made->bytes();
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const lod::GridMeter> BaseTiles::meter(const lod::TileKey& leaf) const {
  return meters_.get(leaf, [&] {
    auto made = std::make_shared<const lod::GridMeter>(planet_->heights(leaf).posts, planet_->radius_m());
    return std::pair(std::move(made),
                     kMeterBytesOfPost * static_cast<std::size_t>(planet_->meta().tile.post_count()));
  });
}

Node BaseTiles::node(const lod::TileKey& key, int coarser_neighbour_mask, bool with_sources) const {
  const lod::TileInfo& tile = *planet_->tree().find(key);
  const PlanetMeta& meta = planet_->meta();
  Node node;
  node.min_m = node.lowest_m = tile.min_height_m;
  node.max_m = tile.max_height_m;
  node.slope = tile.steepest_slope;
  node.inner = tile.has_children;
  node.coarser_neighbour_mask = coarser_neighbour_mask;
  node.variants = tile.variants;
  if (tile.posts_terms.known()) node.posts_terms = tile.posts_terms.terms();
  if (!node.inner) {
    node.lowest_m -=
        facet_sagitta_m(lod::post_spacing_m(key.level, meta.tile.intervals(), meta.radius_m), meta.radius_m);
  }
  if (!with_sources) return node;
  if (meta.sources.size() == 1) {
    node.sources = {0};
    return node;
  }
  {
    const std::lock_guard lock(mutex_);
    if (const auto at = sources_.find(key); at != sources_.end()) node.sources = at->second;
  }
  if (!node.sources.empty()) return node;
  const std::vector<int> of_tile = planet_->sources(key).of_tile;
  node.sources.insert(of_tile.begin(), of_tile.end());
  const std::lock_guard lock(mutex_);
  sources_[key] = node.sources;
  return node;
}

}  // namespace paging
