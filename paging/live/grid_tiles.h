// Tiles of a patch without new meshes: full grids, and the planet's meshes with new heights.
//
// Their errors are bounds. Where the planet's tile has the terms E, its mesh M and the surface S, and the patch has M' and
// S', then |M' - S'| <= |M' - M| + |M - S| + |S - S'|. For the first: M and M' have the same triangles, and over one the
// radius r of vertices p with the radii r_v changes with each by dr / dr_v = l_v (|p_v| / |p|) (r / r_v)^2, where the l_v
// sum to 1. So it is at most the largest change of a vertex times the ratio of |p| in the tile's chart and the squared ratio
// of its radii. The same holds for the last over a finest tile: from level 5 on the facets of a finer grid divide those of
// the planet, so that both surfaces are flat over them. Spheres over both grids differ by less than the sagitta of the
// coarser one. Below level 5 lines are not even, and lod::GridMeter measures the planet's posts against the new ones.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "lod/mesh/error_meter.h"
#include "paging/live/base_tiles.h"
#include "paging/live/changed_leaf.h"
#include "paging/planet/tile_store.h"

namespace paging {

// Holds a tile that a patch makes.
struct GridTile {
  Node node;
  std::vector<std::int32_t> quanta;  // of its own posts, as stored
  std::vector<bool> nodata;          // empty: none
  lod::ErrorTerms change;            // of the surface over it
  int coarsest_level = 0;            // of the finest tiles below that the patch makes
  bool is_own_grid = false;          // its mesh is the full grid of its own posts
};

// Stores a finest tile with its full grid alone. `ground` is that of the planet at its posts.
GridTile make_grid_leaf(const PlanetMeta& meta, const BaseTiles& base, const SampledLeaf& leaf,
                        const GroundGrid& ground, TileStore& store);

// Holds the children of a tile: their nodes, and which of them the patch makes.
struct GridChildren {
  std::array<const Node*, 4> nodes{};
  std::array<const GridTile*, 4> made{};  // null: as in the planet
};

// Stores a tile that has children in the planet too: its posts are those of its children, its mesh is the planet's.
GridTile make_grid_inner(const PlanetMeta& meta, const BaseTiles& base, const GridChildren& children,
                         const lod::TileKey& key, TileStore& store);

// Stores a tile that has no children in the planet. Its mesh is the grid of its own posts; on borders with tiles of the
// planet that keep a mesh it has the vertices of that mesh. `is_made` says which tiles the patch makes. Its error terms
// are 0 until they have been measured.
using IsMade = std::function<bool(const lod::TileKey& key)>;
GridTile make_divided_tile(const PlanetMeta& meta, const BaseTiles& base, const GridChildren& children,
                           const lod::TileKey& key, const IsMade& is_made, TileStore& store);

// Computes the errors of all tiles that have no children in the planet over finest tiles below them, given in Morton order.
// `tiles` are those that the patch makes.
std::map<lod::TileKey, InnerTerms> measure_divided_tiles(const StoredTiles& stored, const lod::TileTree& planet,
                                                         const std::map<lod::TileKey, GridTile>& tiles,
                                                         std::span<const lod::TileKey> leaves);

}  // namespace paging
