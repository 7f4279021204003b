#include "vpe/voxel/cast/tile_usage.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace vpe::voxel {

void update_totals(const lod::TileTree& tree, TileUsage& usage) {
  usage.tiles_by_level.clear();
  usage.screen_space_error_px = usage.geometric_error_m = 0;
  usage.tiles_replaced = 0;
  std::unordered_set<lod::TileTree::Index> sources;
  for (const TileUse& use : usage.tiles) {
    const auto level = static_cast<std::size_t>(tree[use.source].key.level);
    if (usage.tiles_by_level.size() <= level) usage.tiles_by_level.resize(level + 1);
    if (use.source == use.tile || sources.insert(use.source).second) ++usage.tiles_by_level[level];
    if (use.source != use.tile) ++usage.tiles_replaced;
    usage.geometric_error_m = std::max(usage.geometric_error_m, use.geometric_error_m);
    usage.screen_space_error_px = std::max(usage.screen_space_error_px, use.screen_space_error_px);
  }
}

void TileUsage::add(const TileUsage& other, const lod::TileTree& tree) {
  std::vector<TileUse> merged;
  merged.reserve(tiles.size() + other.tiles.size());
  auto a = tiles.begin();
  auto b = other.tiles.begin();
  while (a != tiles.end() || b != other.tiles.end()) {
    if (b == other.tiles.end() || (a != tiles.end() && a->tile < b->tile)) {
      merged.push_back(*a++);
    } else if (a == tiles.end() || b->tile < a->tile) {
      merged.push_back(*b++);
    } else {
      merged.push_back(a->screen_space_error_px < b->screen_space_error_px ? *b : *a);
      ++a;
      ++b;
    }
  }
  tiles = std::move(merged);
  steepest_slope = std::max(steepest_slope, other.steepest_slope);
  update_totals(tree, *this);
}

void TileUsage::scale_px(double factor) {
  for (TileUse& use : tiles) use.screen_space_error_px *= factor;
  screen_space_error_px *= factor;
}

}  // namespace vpe::voxel
