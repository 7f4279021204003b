#include "vpe/voxel/cast/height_grid_store.h"

#include <utility>

#include "paging/planet/planet_user.h"
#include "vpe/voxel/cast/tile_fallbacks.h"

namespace vpe::voxel {

namespace {

constexpr LineFamily kAllFamilies[] = {LineFamily::kColumns, LineFamily::kRows, LineFamily::kDiagonals};

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

void HeightGridStore::set_budget(std::size_t bytes) const {
  budget_ = bytes;
  grids_.set_limit(budget_share(bytes, 1.0 - kExactShare));
  exact_.set_limit(budget_share(bytes, kExactShare));
}

void HeightGridStore::change_planet(std::shared_ptr<const paging::PlanetFile> planet) {
  paging::require_same_grid(*planet_, *planet);
  planet_ = std::move(planet);
  failures_.clear();
  any_failed_ = false;
}

HeightGridStore::Key HeightGridStore::key(Tile tile, Tile posts_of, LineFamily family, double exaggeration,
                                          bool is_half) const {
  const lod::TileKey& of = planet_->tree()[tile].key;
  const std::uint64_t version = planet_->version(of);
  if (posts_of == tile) return {{of, version}, of.level, version, is_half, family, exaggeration};
  const lod::TileKey& posts = planet_->tree()[posts_of].key;
  return {{of, version}, posts.level, planet_->version(posts), is_half, family, exaggeration};
}

template <typename T>
HeightGridStore::Pointer<T> HeightGridStore::find(Cache<T>& cache, Tile tile, double exaggeration) const {
  Key wanted = key(tile, tile, kAllFamilies[0], exaggeration);
  for (const LineFamily family : kAllFamilies) {
    wanted.family = family;
    if (auto found = cache.find(wanted)) return found;
  }
  return nullptr;
}

template <typename T, typename Make>
HeightGridStore::Pointer<T> HeightGridStore::get(Cache<T>& cache, const Key& key, const Make& make) const {
  return cache.get(key, [&] {
    Pointer<T> made = make();
    const std::size_t bytes = made->bytes();
    ++tiles_made_;
    bytes_made_ += bytes;
    return std::pair(std::move(made), bytes);
  });
}

paging::TileHeights HeightGridStore::heights(Tile tile, double exaggeration) const {
  return planet_->heights(planet_->tree()[tile].key, exaggeration);
}

HeightGridStore::Pointer<float> HeightGridStore::grids(Tile tile, LineFamily family,
                                                       double exaggeration) const {
  return get(grids_, key(tile, tile, family, exaggeration), [&] {
    if (const auto other = held_grids(tile, exaggeration))
      return std::make_shared<const TileHeightGrids<float>>(*other, family);
    return std::make_shared<const TileHeightGrids<float>>(heights(tile, exaggeration), planet_->radius_m(),
                                                          exaggeration, family);
  });
}

HeightGridStore::Pointer<double> HeightGridStore::exact_grids(Tile tile, LineFamily family,
                                                              double exaggeration) const {
  return get(exact_, key(tile, tile, family, exaggeration), [&] {
    if (const auto other = find(exact_, tile, exaggeration))
      return std::make_shared<const TileHeightGrids<double>>(*other, family);
    const paging::TileHeights posts = heights(tile, exaggeration);
    if (!held_grids(tile, exaggeration)) {
      get(grids_, key(tile, tile, family, exaggeration), [&] {
        return std::make_shared<const TileHeightGrids<float>>(posts, planet_->radius_m(), exaggeration, family);
      });
    }
    return std::make_shared<const TileHeightGrids<double>>(posts, planet_->radius_m(), exaggeration, family);
  });
}

std::size_t HeightGridStore::bytes_resident() const { return grids_.bytes() + exact_.bytes(); }

HeightGridStore::Pointer<float> HeightGridStore::any_grids(Tile tile, double exaggeration) const {
  if (auto found = held_grids(tile, exaggeration)) return found;
  return grids(tile, LineFamily::kColumns, exaggeration);
}

HeightGridStore::Pointer<float> HeightGridStore::held_grids(Tile tile, double exaggeration) const {
  return find(grids_, tile, exaggeration);
}

template <typename T>
HeightGridStore::Pointer<T> HeightGridStore::fallback(Cache<T>& cache, Tile tile, Tile coarser,
                                                      LineFamily family, double exaggeration,
                                                      bool is_half) const {
  return get(cache, key(tile, coarser, family, exaggeration, is_half), [&] {
    const lod::TileTree& tree = planet_->tree();
    const lod::TileInfo& info = tree[tile];
    const int intervals = tree.shape().intervals();
    return std::make_shared<const TileHeightGrids<T>>(
        *any_grids(coarser, exaggeration),
        FallbackTile{info.key, tree[coarser].key, is_half ? intervals / 2 : intervals, info.min_height_m,
                     info.max_height_m, intervals},
        planet_->radius_m(), exaggeration, family);
  });
}

HeightGridStore::Pointer<float> HeightGridStore::fallback_grids(Tile tile, Tile coarser, LineFamily family,
                                                                double exaggeration) const {
  return fallback(grids_, tile, coarser, family, exaggeration, false);
}

HeightGridStore::Pointer<double> HeightGridStore::exact_fallback_grids(Tile tile, Tile coarser,
                                                                       LineFamily family,
                                                                       double exaggeration) const {
  return fallback(exact_, tile, coarser, family, exaggeration, false);
}

HeightGridStore::Pointer<float> HeightGridStore::half_grids(Tile tile, Tile coarser, LineFamily family,
                                                            double exaggeration) const {
  return fallback(grids_, tile, coarser, family, exaggeration, true);
}

HeightGridStore::Pointer<double> HeightGridStore::exact_half_grids(Tile tile, Tile coarser, LineFamily family,
                                                                   double exaggeration) const {
  return fallback(exact_, tile, coarser, family, exaggeration, true);
}

std::optional<std::string> HeightGridStore::failure(Tile tile) const {
  if (!any_failed_) return std::nullopt;
  const std::lock_guard lock(failures_mutex_);
  const auto at = failures_.find(tile);
  return at == failures_.end() ? std::nullopt : std::optional(at->second);
}

bool HeightGridStore::read(Tile tile, LineFamily family, double exaggeration) const {
  if (failure(tile)) return false;
  try {
    if (!held_grids(tile, exaggeration)) grids(tile, family, exaggeration);
    return true;
  } catch (const paging::PlanetError& e) {
    record_failure(tile, e.what());
    return false;
  }
}

void HeightGridStore::record_failure(Tile tile, const std::string& why) const {
  const std::lock_guard lock(failures_mutex_);
  failures_.emplace(tile, why);
  any_failed_ = true;
}

const HeightGridStore::Pointer<float>& ThreadLocalTiles::grids(lod::TileTree::Index tile, LineFamily family) {
  Slot<float>& slot = slots_[number(tile, family) % slots_.size()];
  if (!slot.is(tile, family)) {
    slot = {
        tile, family,
        fallbacks_ != nullptr ? fallbacks_->grids(tile, family) : store_.grids(tile, family, exaggeration_)};
  }
  return slot.held;
}

const HeightGridStore::Pointer<double>& ThreadLocalTiles::exact_grids(lod::TileTree::Index tile,
                                                                      LineFamily family) {
  Slot<double>& slot = exact_[number(tile, family) % exact_.size()];
  if (!slot.is(tile, family)) {
    slot = {tile, family,
            fallbacks_ != nullptr ? fallbacks_->exact_grids(tile, family)
                                  : store_.exact_grids(tile, family, exaggeration_)};
  }
  return slot.held;
}

const HeightGridStore::Pointer<float>& ThreadLocalTiles::any_grids(lod::TileTree::Index tile) {
  for (const LineFamily family : kAllFamilies) {
    const Slot<float>& slot = slots_[number(tile, family) % slots_.size()];
    if (slot.is(tile, family)) return slot.held;
  }
  auto found = fallbacks_ != nullptr ? fallbacks_->any_grids(tile) : store_.any_grids(tile, exaggeration_);
  const LineFamily family = found->family();
  Slot<float>& slot = slots_[number(tile, family) % slots_.size()];
  slot = {tile, family, std::move(found)};
  return slot.held;
}

const HeightGridStore::Pointer<float>& ThreadLocalTiles::grids(lod::TileTree::Index tile,
                                                               lod::TileTree::Index posts_of,
                                                               LineFamily family) {
  if (posts_of == tile) return grids(tile, family);
  Slot<float>& slot = slots_[number(tile, family) % slots_.size()];
  if (!slot.is(tile, family)) {
    slot = {tile, family,
            fallbacks_ != nullptr ? fallbacks_->half_grids(tile, posts_of, family)
                                  : store_.half_grids(tile, posts_of, family, exaggeration_)};
  }
  return slot.held;
}

const HeightGridStore::Pointer<double>& ThreadLocalTiles::exact_grids(lod::TileTree::Index tile,
                                                                      lod::TileTree::Index posts_of,
                                                                      LineFamily family) {
  if (posts_of == tile) return exact_grids(tile, family);
  Slot<double>& slot = exact_[number(tile, family) % exact_.size()];
  if (!slot.is(tile, family)) {
    slot = {tile, family,
            fallbacks_ != nullptr ? fallbacks_->exact_half_grids(tile, posts_of, family)
                                  : store_.exact_half_grids(tile, posts_of, family, exaggeration_)};
  }
  return slot.held;
}

const HeightGridStore::Pointer<float>& ThreadLocalTiles::any_grids(lod::TileTree::Index tile,
                                                                   lod::TileTree::Index posts_of) {
  if (posts_of == tile) return any_grids(tile);
  for (const LineFamily family : kAllFamilies) {
    const Slot<float>& slot = slots_[number(tile, family) % slots_.size()];
    if (slot.is(tile, family)) return slot.held;
  }
  return grids(tile, posts_of, LineFamily::kColumns);
}

}  // namespace vpe::voxel
