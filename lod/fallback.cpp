#include "lod/fallback.h"

#include <algorithm>
#include <optional>

namespace lod {

namespace {

constexpr int kLevelsDown = 2;

// A tile and mesh that replaces another.
struct Replacement {
  TileTree::Index index;
  int variant;
};

class ReplacementFinder {
 public:
  ReplacementFinder(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                    const IsResident& resident)
      : options_(options), tree_(tree), view_(view), resident_(resident) {}

  // Finds a replacement that does not affect other tiles. Returns false if there is none.
  bool replace(const SelectedTile& tile, std::vector<Replacement>& out) const {
    const TileInfo& info = tree_[tile.index];
    const int variants = static_cast<int>(info.variants.size());
    for (int v = tile.variant + 1; v < variants; ++v) {
      if (take(tile.index, v, out)) return true;
    }
    for (int v = tile.variant - 1; v >= 0; --v) {
      if (take(tile.index, v, out)) return true;
    }
    return by_children(tile.index, kLevelsDown, out);
  }

  // Returns the nearest resident ancestor.
  std::optional<TileTree::Index> ancestor(const TileKey& key) const {
    std::optional<TileTree::Index> nearest;
    TileTree::Index at = static_cast<TileTree::Index>(key.face);
    for (int level = 0; level < key.level; ++level) {
      if (resident_(tree_[at], 0)) nearest = at;
      const int down = key.level - level - 1;
      at = tree_.first_child(at) + static_cast<TileTree::Index>((key.i >> down & 1) + 2 * (key.j >> down & 1));
    }
    return nearest;
  }

 private:
  bool take(TileTree::Index index, int variant, std::vector<Replacement>& out) const {
    if (!resident_(tree_[index], variant)) return false;
    out.push_back({index, variant});
    return true;
  }

  // Replaces a tile by its children, each by any mesh or by its own children. One that cannot be seen needs none:
  // at the border of an image the others alone are resident. Leaves `out` unchanged if one has no replacement.
  bool by_children(TileTree::Index index, int levels, std::vector<Replacement>& out) const {
    if (levels == 0 || !tree_[index].has_children) return false;
    const std::size_t before = out.size();
    const TileTree::Index first = tree_.first_child(index);
    for (TileTree::Index child = first; child < first + 4; ++child) {
      bool found = false;
      for (int v = 0; v < static_cast<int>(tree_[child].variants.size()) && !found; ++v)
        found = take(child, v, out);
      if (found || by_children(child, levels - 1, out) || !may_be_seen(options_, tree_, view_, child)) continue;
      out.resize(before);
      return false;
    }
    return true;
  }

  const SelectOptions& options_;
  const TileTree& tree_;
  const SelectView& view_;
  const IsResident& resident_;
};

// Sorts tiles in Morton order and removes those inside others.
void drop_nested(const TileTree& tree, std::vector<TileTree::Index>& tiles) {
  std::sort(tiles.begin(), tiles.end(), [&](TileTree::Index a, TileTree::Index b) {
    const std::int64_t za = morton_position(tree[a].key);
    const std::int64_t zb = morton_position(tree[b].key);
    return za != zb ? za < zb : tree[a].key.level < tree[b].key.level;
  });
  std::size_t kept = 0;
  for (const TileTree::Index t : tiles) {
    if (kept == 0 || !contains(tree[tiles[kept - 1]].key, tree[t].key)) tiles[kept++] = t;
  }
  tiles.resize(kept);
}

}  // namespace

void select_fallbacks(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                      const Selection& selection, const IsResident& resident, FallbackSelection& result) {
  result.missing.clear();
  result.substituted = result.uncovered = 0;
  const ReplacementFinder finder(options, tree, view, resident);

  // Finds ancestors first: they decide which of the other tiles are drawn at all.
  std::vector<TileTree::Index> ancestors;
  std::vector<std::vector<Replacement>> replacements(selection.tiles.size());
  for (std::size_t n = 0; n < selection.tiles.size(); ++n) {
    const SelectedTile& tile = selection.tiles[n];
    if (resident(tree[tile.index], tile.variant)) continue;
    result.missing.push_back(n);
    if (finder.replace(tile, replacements[n])) continue;
    if (const auto above = finder.ancestor(tile.key)) {
      ancestors.push_back(*above);
    } else {
      ++result.uncovered;
    }
  }
  if (result.missing.empty()) {
    result.drawn = selection;
    return;
  }
  drop_nested(tree, ancestors);

  std::vector<SelectedTile> drawn;
  const auto draw = [&](const Replacement& replacement) {
    drawn.push_back(measure_tile(options, tree, view, replacement.index, replacement.variant));
    ++result.substituted;
  };
  std::size_t next_missing = 0;
  auto above = ancestors.begin();
  bool above_is_drawn = false;
  std::vector<std::size_t> missing;
  for (std::size_t n = 0; n < selection.tiles.size(); ++n) {
    const SelectedTile& tile = selection.tiles[n];
    const bool is_missing = next_missing < result.missing.size() && result.missing[next_missing] == n;
    if (is_missing) ++next_missing;
    while (above != ancestors.end() &&
           morton_position(tree[*above].key) + morton_extent(tree[*above].key.level) <=
               morton_position(tile.key)) {
      ++above;
      above_is_drawn = false;
    }
    if (above != ancestors.end() && contains(tree[*above].key, tile.key)) {
      if (!above_is_drawn) draw({*above, 0});
      above_is_drawn = true;
      missing.push_back(n);
    } else if (is_missing) {
      for (const Replacement& replacement : replacements[n]) draw(replacement);
      missing.push_back(n);
    } else {
      drawn.push_back(tile);
    }
  }
  result.missing = std::move(missing);
  const Selection& s = selection;
  Selection& d = result.drawn;
  d.tiles = std::move(drawn);
  d.exaggeration = s.exaggeration;
  d.visited = s.visited;
  d.culled_frustum = s.culled_frustum;
  d.culled_horizon = s.culled_horizon;
  d.refined = s.refined;
  d.capped = s.capped;
  update_totals(tree, d);
}

}  // namespace lod
