#include "paging/plan/kept_tiles.h"

#include <algorithm>

namespace paging {

namespace {

bool has_equal_borders(const lod::TileKey& key, const BuildPlan& a, const BuildPlan& b) {
  for (const lod::Edge edge : lod::kEdges)
    if (a.edge_step(key, edge) != b.edge_step(key, edge)) return false;
  for (const bool east : {false, true}) {
    for (const bool north : {false, true}) {
      if (a.coarsest_level_at_corner(key, east, north) != b.coarsest_level_at_corner(key, east, north))
        return false;
    }
  }
  return true;
}

bool has_equal_neighbours(const lod::TileKey& key, const BuildPlan& a, const BuildPlan& b) {
  return std::ranges::all_of(lod::kEdges, [&](lod::Edge edge) {
    const lod::TileKey beside = lod::neighbour(key, edge).key;
    return a.is_inner(beside) == b.is_inner(beside);
  });
}

}  // namespace

mars::Cap surroundings(const lod::TileKey& key, int intervals) {
  mars::Cap cap = lod::bounding_cap(key);
  cap.radius_rad += 2 * lod::post_spacing_m(key.level, intervals, 1.0);
  return cap;
}

std::set<lod::TileKey> kept_tiles(const FinishedTiles& finished, const BuildPlan& plan, const PlanetMeta& meta,
                                  const ChangedIn& changes) {
  std::vector<lod::TileKey> leaves;
  for (const NodeRow& row : finished.rows)
    if (!row.inner) leaves.push_back(lod::unpack(row.key).value());
  const BuildPlan before(std::move(leaves));
  std::set<lod::TileKey> kept;
  for (const lod::TileKey& key : plan.leaves()) {
    if (before.is_leaf(key) && !finished.with_nodata.contains(lod::pack(key)) &&
        has_equal_borders(key, before, plan) && !changes(surroundings(key, meta.tile.intervals())))
      kept.insert(key);
  }
  for (const lod::TileKey& key : plan.inner()) {
    bool is_kept = before.is_inner(key) && has_equal_neighbours(key, before, plan);
    for (int c = 0; c < 4 && is_kept; ++c) is_kept = kept.contains(lod::child(key, c));
    if (is_kept) kept.insert(key);
  }
  return kept;
}

}  // namespace paging
