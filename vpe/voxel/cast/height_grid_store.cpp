#include "vpe/voxel/cast/height_grid_store.h"

namespace vpe::voxel {

namespace {

// Few tiles lie below the camera.
constexpr double kExactShare = 0.05;

std::size_t budget_share(std::size_t bytes, double share) {
  return static_cast<std::size_t>(share * static_cast<double>(bytes));
}

}  // namespace

HeightGridStore::HeightGridStore(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes)
    : planet_(std::move(planet)),
      budget_(budget_bytes),
      grids_(budget_share(budget_bytes, 1.0 - kExactShare)),
      exact_(budget_share(budget_bytes, kExactShare)) {}

template <typename T>
std::shared_ptr<const TileHeightGrids<T>> HeightGridStore::get(Cache<T>& cache, const Key& key) const {
  return cache.get(key, [&] {
    auto tile_grids = std::make_shared<const TileHeightGrids<T>>(
        planet_->heights(planet_->tree()[key.tile].key, key.exaggeration), planet_->radius_m(),
        key.exaggeration, key.family);
    const std::size_t bytes = tile_grids->bytes();
    ++tiles_made_;
    bytes_made_ += bytes;
    return std::pair(std::move(tile_grids), bytes);
  });
}

std::shared_ptr<const TileHeightGrids<float>> HeightGridStore::grids(lod::TileTree::Index tile,
                                                                     LineFamily family,
                                                                     double exaggeration) const {
  return get(grids_, {tile, family, exaggeration});
}

std::shared_ptr<const TileHeightGrids<double>> HeightGridStore::exact_grids(lod::TileTree::Index tile,
                                                                            LineFamily family,
                                                                            double exaggeration) const {
  return get(exact_, {tile, family, exaggeration});
}

std::size_t HeightGridStore::bytes_resident() const { return grids_.bytes() + exact_.bytes(); }

std::shared_ptr<const TileHeightGrids<float>> HeightGridStore::any_grids(lod::TileTree::Index tile,
                                                                         double exaggeration,
                                                                         LineFamily& family) const {
  for (const LineFamily f : {LineFamily::kColumns, LineFamily::kRows, LineFamily::kDiagonals}) {
    family = f;
    if (auto found = grids_.find({tile, f, exaggeration})) return found;
  }
  family = LineFamily::kColumns;
  return grids(tile, family, exaggeration);
}

const TileHeightGrids<float>& ThreadLocalTiles::grids(lod::TileTree::Index tile, LineFamily family) {
  Slot<float>& slot = slots_[number(tile, family) % slots_.size()];
  if (!slot.is(tile, family)) slot = {tile, family, store_.grids(tile, family, exaggeration_)};
  return *slot.held;
}

const TileHeightGrids<double>& ThreadLocalTiles::exact_grids(lod::TileTree::Index tile, LineFamily family) {
  Slot<double>& slot = exact_[number(tile, family) % exact_.size()];
  if (!slot.is(tile, family)) slot = {tile, family, store_.exact_grids(tile, family, exaggeration_)};
  return *slot.held;
}

const TileHeightGrids<float>& ThreadLocalTiles::any_grids(lod::TileTree::Index tile, LineFamily& family) {
  for (const LineFamily f : {LineFamily::kColumns, LineFamily::kRows, LineFamily::kDiagonals}) {
    family = f;
    const Slot<float>& slot = slots_[number(tile, f) % slots_.size()];
    if (slot.is(tile, f)) return *slot.held;
  }
  auto found = store_.any_grids(tile, exaggeration_, family);
  Slot<float>& slot = slots_[number(tile, family) % slots_.size()];
  slot = {tile, family, std::move(found)};
  return *slot.held;
}

}  // namespace vpe::voxel
