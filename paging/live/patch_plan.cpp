#include "paging/live/patch_plan.h"

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <unordered_set>

namespace paging {

namespace {

using KeySet = std::unordered_set<lod::TileKey, lod::TileKeyHash>;

std::vector<lod::TileKey> leaves_of(const lod::TileTree& tree) {
  std::vector<lod::TileKey> leaves;
  for (const lod::TileInfo& tile : tree.tiles())
    if (!tile.has_children) leaves.push_back(tile.key);
  return leaves;
}

// Returns the finest tiles of the planet that a change touches.
std::vector<lod::TileKey> touched_leaves(const lod::TileTree& tree, const GroundChange& change) {
  std::vector<lod::TileKey> touched;
  std::vector<lod::TileTree::Index> open;
  for (lod::TileTree::Index face = 0; face < mars::kFaces; ++face) open.push_back(face);
  while (!open.empty()) {
    const lod::TileTree::Index at = open.back();
    open.pop_back();
    const lod::TileInfo& tile = tree[at];
    if (!change.touches(lod::bounding_cap(tile.key))) continue;
    if (!tile.has_children) {
      touched.push_back(tile.key);
      continue;
    }
    for (lod::TileTree::Index c = 0; c < 4; ++c) open.push_back(tree.first_child(at) + c);
  }
  return touched;
}

bool has_same_borders(const lod::TileKey& key, const BuildPlan& a, const BuildPlan& b) {
  for (const lod::Edge edge : lod::kEdges)
    if (a.edge_step(key, edge) != b.edge_step(key, edge)) return false;
  for (const bool east : {false, true}) {
    for (const bool north : {false, true})
      if (a.coarsest_level_at_corner(key, east, north) != b.coarsest_level_at_corner(key, east, north))
        return false;
  }
  return true;
}

// Adds the finest tiles of a plan that lie in a tile, or the one that it lies in.
void add_leaves(const BuildPlan& plan, lod::TileKey key, std::set<lod::TileKey>& leaves) {
  while (!plan.exists(key)) key = lod::parent(key);
  if (!plan.is_inner(key)) {
    leaves.insert(key);
    return;
  }
  for (int c = 0; c < 4; ++c) add_leaves(plan, lod::child(key, c), leaves);
}

// Returns the keys of a tile's level that share an edge or a corner with it.
std::set<lod::TileKey> around(const lod::TileKey& key) {
  std::set<lod::TileKey> keys;
  for (const lod::Edge edge : lod::kEdges) {
    const lod::TileKey beside = lod::neighbour(key, edge).key;
    keys.insert(beside);
    for (const lod::Edge next : lod::kEdges) keys.insert(lod::neighbour(beside, next).key);
  }
  return keys;
}

}  // namespace

PatchPlanner::PatchPlanner(const lod::TileTree& tree)
    : tree_(tree), base_(std::make_shared<BuildPlan>(leaves_of(tree))) {}

std::shared_ptr<const PatchPlanner::Divided> PatchPlanner::divided(std::vector<lod::TileKey> keys) const {
  if (keys.empty()) return std::make_shared<Divided>(Divided{{}, base_, {}});
  {
    const std::lock_guard lock(mutex_);
    if (last_ && last_->keys == keys) return last_;
  }
  auto tiles = std::make_shared<const BuildPlan>(*base_, keys);
  std::set<lod::TileKey> near;
  std::vector<lod::TileKey> leaves;
  for (const lod::TileKey& key : tiles->inner()) {
    if (base_->is_inner(key)) continue;
    for (int c = 0; c < 4; ++c)
      if (const lod::TileKey child = lod::child(key, c); !tiles->is_inner(child)) leaves.push_back(child);
    for (const lod::TileKey& beside : around(key)) add_leaves(*tiles, beside, near);
  }
  for (const lod::TileKey& key : near)
    if (base_->is_leaf(key) && !has_same_borders(key, *base_, *tiles)) leaves.push_back(key);
  auto made = std::make_shared<const Divided>(Divided{std::move(keys), std::move(tiles), std::move(leaves)});
  const std::lock_guard lock(mutex_);
  last_ = made;
  return made;
}

PatchPlan PatchPlanner::plan(const GroundChange& change, const PatchOptions& options) const {
  const int n = tree_.shape().intervals();
  std::vector<lod::TileKey> leaves = touched_leaves(tree_, change);
  if (leaves.size() > options.most_finest_tiles) {
    throw PlanetError("the change of the ground reaches " + std::to_string(leaves.size()) +
                      " finest tiles of the planet, and a patch may have " +
                      std::to_string(options.most_finest_tiles) + "; make it smaller, or allow more tiles");
  }
  // Coarse tiles are divided before fine ones, so that all are equally fine if they may not be as fine as wanted.
  PatchPlan plan;
  std::vector<lod::TileKey> divided_keys;
  std::size_t count = leaves.size();
  for (int level = 0; level < PlanLimits().max_level; ++level) {
    const double spacing_m = lod::post_spacing_m(level, n, tree_.radius_m());
    std::vector<lod::TileKey> keys;
    for (const lod::TileKey& key : leaves) {
      if (key.level != level) continue;
      const double wanted_m = std::max(change.spacing_in(lod::bounding_cap(key)), options.finest_spacing_m);
      if (spacing_m > wanted_m) keys.push_back(key);
    }
    if (keys.empty()) continue;
    if (count + 3 * keys.size() > options.most_finest_tiles) {
      plan.is_coarser = true;
      break;
    }
    count += 3 * keys.size();
    for (const lod::TileKey& key : keys) {
      for (int c = 0; c < 4; ++c)
        if (const lod::TileKey child = lod::child(key, c); change.touches(lod::bounding_cap(child)))
          leaves.push_back(child);
    }
    divided_keys.insert(divided_keys.end(), keys.begin(), keys.end());
  }
  const std::shared_ptr<const Divided> tree = divided(std::move(divided_keys));
  plan.tiles = tree->tiles;
  KeySet made(tree->leaves.begin(), tree->leaves.end());
  for (const lod::TileKey& key : leaves)
    if (!plan.tiles->is_inner(key)) made.insert(key);
  plan.leaves.assign(made.begin(), made.end());
  std::sort(plan.leaves.begin(), plan.leaves.end(), morton_less);
  KeySet above;
  for (lod::TileKey key : plan.leaves) {
    while (key.level > 0) {
      key = lod::parent(key);
      if (!above.insert(key).second) break;
    }
  }
  plan.inner.assign(above.begin(), above.end());
  std::sort(plan.inner.begin(), plan.inner.end(), [](const lod::TileKey& a, const lod::TileKey& b) {
    return a.level != b.level ? a.level > b.level : morton_less(a, b);
  });
  return plan;
}

}  // namespace paging
