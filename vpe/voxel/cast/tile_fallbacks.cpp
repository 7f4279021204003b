#include "vpe/voxel/cast/tile_fallbacks.h"

#include <algorithm>
#include <utility>

namespace vpe::voxel {

namespace {

// Children this far down may stand in for a tile.
constexpr int kFinerLevels = 2;

}  // namespace

TileFallbacks::TileFallbacks(const HeightGridStore& store, double exaggeration, ReadingRule rule,
                             Purpose purpose)
    : store_(store),
      tree_(store.planet().tree()),
      exaggeration_(exaggeration),
      rule_(std::move(rule)),
      purpose_(purpose) {}

TileFallbacks::Tile TileFallbacks::parent(Tile tile) const {
  const lod::TileKey& key = tree_[tile].key;
  return static_cast<Tile>(tree_.find(lod::ancestor(key, key.level - 1)) - tree_.tiles().data());
}

bool TileFallbacks::is_there(Tile tile, LineFamily family) const {
  if (store_.held_grids(tile, exaggeration_)) return true;
  return rule_.may_read() && read(tile, family);
}

bool TileFallbacks::read(Tile tile, LineFamily family) const {
  return rule_.timed([&] { return store_.read(tile, family, exaggeration_); });
}

TileFallbacks::Tile TileFallbacks::nearest_ancestor(Tile tile, LineFamily family) {
  while (tree_[tile].key.level > 0) {
    tile = parent(tile);
    if (is_there(tile, family)) return tile;
  }
  store_.any_grids(tile, exaggeration_);  // reads the root, or throws
  return tile;
}

std::optional<TileFallbacks::Tile> TileFallbacks::replacement(Tile tile, LineFamily family) {
  if (any_replaced_) {
    const std::shared_lock lock(mutex_);
    if (const auto at = replaced_.find(tile); at != replaced_.end() && at->second.source != tile)
      return at->second.source;
  }
  if (is_there(tile, family) || tree_[tile].key.level == 0) return std::nullopt;
  const Tile ancestor = nearest_ancestor(tile, family);
  const std::unique_lock lock(mutex_);
  any_replaced_ = true;
  const auto [at, is_first] = replaced_.emplace(tile, Replacement{ancestor, family});
  if (at->second.source == tile) at->second.source = ancestor;
  return at->second.source;
}

std::shared_ptr<const TileHeightGrids<float>> TileFallbacks::grids(Tile tile, LineFamily family) {
  if (const auto coarser = replacement(tile, family))
    return store_.fallback_grids(tile, *coarser, family, exaggeration_);
  return store_.grids(tile, family, exaggeration_);
}

std::shared_ptr<const TileHeightGrids<float>> TileFallbacks::any_grids(Tile tile) {
  if (const auto coarser = replacement(tile, LineFamily::kColumns))
    return store_.fallback_grids(tile, *coarser, LineFamily::kColumns, exaggeration_);
  return store_.any_grids(tile, exaggeration_);
}

std::shared_ptr<const TileHeightGrids<double>> TileFallbacks::exact_grids(Tile tile, LineFamily family) {
  if (const auto coarser = replacement(tile, family))
    return store_.exact_fallback_grids(tile, *coarser, family, exaggeration_);
  return store_.exact_grids(tile, family, exaggeration_);
}

std::shared_ptr<const TileHeightGrids<float>> TileFallbacks::half_grids(Tile tile, Tile parent,
                                                                        LineFamily family) {
  return store_.half_grids(tile, replacement(parent, family).value_or(parent), family, exaggeration_);
}

std::shared_ptr<const TileHeightGrids<double>> TileFallbacks::exact_half_grids(Tile tile, Tile parent,
                                                                               LineFamily family) {
  return store_.exact_half_grids(tile, replacement(parent, family).value_or(parent), family, exaggeration_);
}

bool TileFallbacks::are_children_held(Tile tile, int levels) const {
  if (!tree_[tile].has_children || levels == 0) return false;
  const Tile first = tree_.first_child(tile);
  for (Tile child = first; child < first + 4; ++child) {
    if (!store_.held_grids(child, exaggeration_) && !are_children_held(child, levels - 1)) return false;
  }
  return true;
}

bool TileFallbacks::prefers_children(Tile tile) {
  if (rule_.may_read() || store_.held_grids(tile, exaggeration_) || !are_children_held(tile, kFinerLevels))
    return false;
  const std::unique_lock lock(mutex_);
  any_replaced_ = true;
  replaced_.emplace(tile, Replacement{tile, LineFamily::kColumns});
  return true;
}

std::shared_ptr<const paging::SurfaceTile> TileFallbacks::surface_tile(const paging::Surface& surface,
                                                                       const lod::TileKey& key) {
  const auto tile = static_cast<Tile>(tree_.find(key) - tree_.tiles().data());
  if (!store_.failure(tile)) {
    if (auto held = surface.held_tile(key, exaggeration_)) return held;
    if (rule_.may_read()) {
      try {
        return rule_.timed([&] { return surface.tile(key, exaggeration_); });
      } catch (const paging::PlanetError& e) {
        store_.record_failure(tile, e.what());
      }
    }
  }
  const std::unique_lock lock(mutex_);
  absent_for_single_rays_.insert(tile);
  return nullptr;
}

TileFallbacks::Tile TileFallbacks::source_of(Tile tile) const {
  if (!any_replaced_) return tile;
  const std::shared_lock lock(mutex_);
  const auto at = replaced_.find(tile);
  return at == replaced_.end() ? tile : at->second.source;
}

std::vector<AbsentTile> TileFallbacks::absent() const {
  std::vector<AbsentTile> out;
  const std::shared_lock lock(mutex_);
  for (const auto& [tile, by] : replaced_)
    out.push_back({tile, by.source, by.family, false, store_.failure(tile)});
  for (const Tile tile : absent_for_single_rays_)
    out.push_back({tile, tile, LineFamily::kColumns, true, store_.failure(tile)});
  std::sort(out.begin(), out.end(), [](const AbsentTile& a, const AbsentTile& b) {
    return a.tile != b.tile ? a.tile < b.tile : a.for_single_rays < b.for_single_rays;
  });
  return out;
}

}  // namespace vpe::voxel
