#include <algorithm>
#include <cmath>
#include <limits>

#include "lod/select.h"
#include "vpe/base/mutation.h"

namespace lod {

using vpe::base::Guard;
using vpe::base::mutated;

namespace {

// Returns true if a tile inside `outer` lies along that edge of it.
bool touches(const TileKey& inner, const TileKey& outer, Edge edge) {
  const int shift = inner.level - outer.level;
  const std::int32_t last = (std::int32_t{1} << shift) - 1;
  switch (edge) {
    case Edge::kWest: return (inner.i & last) == 0;
    case Edge::kEast: return (inner.i & last) == last;
    case Edge::kSouth: return (inner.j & last) == 0;
    case Edge::kNorth: return (inner.j & last) == last;
  }
  return false;
}

bool meet_exactly(const TileTree& tree, const SelectedTile& a, const SelectedTile& b) {
  if (a.key.level != b.key.level) return false;
  const TileInfo& info_a = tree[a.index];
  const TileInfo& info_b = tree[b.index];
  if (info_a.has_children || info_b.has_children) return info_a.has_children == info_b.has_children;
  const bool full = is_full_grid(info_a, a.variant);
  return full == is_full_grid(info_b, b.variant) && (full || a.variant == b.variant);
}

// Returns the widest gap across an edge: the sum of both errors, 0 where all tiles drawn there meet the tile
// exactly.
double gap_m(const Selection& selection, const TileTree& tree, const SelectedTile& tile, Edge edge) {
  const Neighbour next = neighbour(tile.key, edge);
  const std::int64_t begin = morton_position(next.key);
  const std::int64_t end = begin + morton_extent(next.key.level);
  const auto gap_to = [&](const SelectedTile& other) {
    return meet_exactly(tree, tile, other)   ? 0.0
           : mutated(Guard::kSkirtNeighbour) ? tile.geometric_error_m
                                             : tile.geometric_error_m + other.geometric_error_m;
  };
  // Of disjoint tiles in Morton order, only the last one that begins at or before a position may contain it.
  const auto after =
      std::partition_point(selection.tiles.begin(), selection.tiles.end(),
                           [&](const SelectedTile& t) { return morton_position(t.key) <= begin; });
  auto other = after == selection.tiles.begin() ? after : after - 1;
  if (other != after && contains(other->key, next.key)) return gap_to(*other);
  double widest = 0.0;
  for (; other != selection.tiles.end() && morton_position(other->key) < end; ++other) {
    if (contains(next.key, other->key) && touches(other->key, next.key, next.edge)) {
      widest = std::max(widest, gap_to(*other));
    }
  }
  return widest;
}

}  // namespace

void skirt_depths(const Selection& selection, const TileTree& tree,
                  std::vector<std::array<float, 4>>& depths_m) {
  depths_m.assign(selection.tiles.size(), {});
  for (std::size_t n = 0; n < selection.tiles.size(); ++n) {
    const SelectedTile& tile = selection.tiles[n];
    const cull::BoundingRegion region = tree.region(tile.index, selection.exaggeration, tile.geometric_error_m);
    for (const Edge edge : kEdges) {
      const double gap = gap_m(selection, tree, tile, edge);
      if (gap == 0.0) continue;
      // If its vertices are lowered by d, an edge's radius r shrinks to at most r / (1 + d / max radius). So d
      // must be this for a gap anywhere below r >= min radius.
      const double room = region.min_radius_m - gap;
      const double depth = room > 0.0 ? gap * region.max_radius_m / room : region.min_radius_m;
      depths_m[n][static_cast<std::size_t>(edge)] = std::nextafter(
          static_cast<float>(std::min(depth, region.min_radius_m)), std::numeric_limits<float>::max());
    }
  }
}

}  // namespace lod
