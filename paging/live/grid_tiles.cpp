#include "paging/live/grid_tiles.h"

#include <algorithm>
#include <cmath>

#include "lod/mesh/grid_meter.h"
#include "paging/live/stitched_grid.h"

namespace paging {

namespace {

// The meters raise what they find by their bound of how much a radius varies over a cell, about (cell angle) (1 + slope).
// So are terms here, that a measurement never exceeds them.
constexpr double kCellRaise = 4;
// From here on the lines of tiles are even, so that finer grids have their diagonals too.
constexpr int kFirstEvenLevel = 5;

// Returns by how much a change of heights may grow between posts of a tile.
double growth(const PlanetMeta& meta, const lod::TileKey& key, double min_m, double max_m) {
  const mars::ChartRect rect = lod::chart_rect(key);
  const double near =
      mars::cube_length({std::clamp(0.0, rect.u0, rect.u1), std::clamp(0.0, rect.v0, rect.v1), 1.0});
  const double far = mars::cube_length(
      {std::max(std::abs(rect.u0), std::abs(rect.u1)), std::max(std::abs(rect.v0), std::abs(rect.v1)), 1.0});
  const double radii = (meta.radius_m + max_m) / (meta.radius_m + min_m);
  return far / near * radii * radii;
}

// Returns the factor by which terms are raised over cells of a level.
double raise_over_cell(int level, const PlanetMeta& meta, double steepest_slope) {
  return 1 + kCellRaise * lod::post_spacing_m(level, meta.tile.intervals(), 1.0) * (1 + steepest_slope);
}

// Bounds the errors of a tile whose posts moved by up to shift_m, with the terms that it had and those of the surface.
lod::ErrorTerms bound(const lod::ErrorTerms& had, const lod::ErrorTerms& change, double shift_m, double raise) {
  return {raise * (had.height_error_m + change.height_error_m + shift_m),
          raise * (had.sagitta_m + change.sagitta_m), raise * (had.total_m + change.total_m + shift_m)};
}

// Takes what a parent has of its children.
GridTile parent_of(const GridChildren& children) {
  GridTile tile;
  tile.coarsest_level = lod::kMaxLevel;
  Node& node = tile.node;
  node.inner = true;
  for (std::size_t c = 0; c < 4; ++c) {
    const Node& below = *children.nodes[c];
    node.sources.insert(below.sources.begin(), below.sources.end());
    node.min_m = c == 0 ? below.min_m : std::min(node.min_m, below.min_m);
    node.max_m = c == 0 ? below.max_m : std::max(node.max_m, below.max_m);
    node.slope = std::max(node.slope, below.slope);
    if (children.made[c] == nullptr) continue;
    tile.change.include(children.made[c]->change);
    tile.coarsest_level = std::min(tile.coarsest_level, children.made[c]->coarsest_level);
  }
  return tile;
}

// Puts every second post of the children that are made into their quarters. Returns the largest change in quanta.
std::int64_t take_posts(const GridChildren& children, int n, GridTile& tile) {
  const auto side = static_cast<std::size_t>(n + 1);
  std::int64_t most = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    const GridTile* child = children.made[c];
    if (child == nullptr) continue;
    const std::size_t x0 = (c & 1) * side / 2;
    const std::size_t y0 = (c >> 1) * side / 2;
    if (!child->nodata.empty() && tile.nodata.empty()) tile.nodata.resize(tile.quanta.size());
    for (std::size_t j = 0; j < side; j += 2) {
      for (std::size_t i = 0; i < side; i += 2) {
        const std::size_t own = (y0 + j / 2) * side + x0 + i / 2;
        const std::int32_t q = child->quanta[j * side + i];
        most = std::max(most, std::abs(std::int64_t{q} - tile.quanta[own]));
        tile.quanta[own] = q;
        if (!tile.nodata.empty()) tile.nodata[own] = !child->nodata.empty() && child->nodata[j * side + i];
      }
    }
  }
  return most;
}

// Gives the vertices of a mesh the heights of the children that are made. Returns the largest change in quanta.
std::int64_t take_vertices(const GridChildren& children, int n, PackedMesh& mesh) {
  std::int64_t most = 0;
  for (std::size_t v = 0; v < mesh.mesh.vertices.size(); ++v) {
    const int i = mesh.mesh.vertices[v].i;
    const int j = mesh.mesh.vertices[v].j;
    for (int c = 0; c < 4; ++c) {
      const GridTile* child = children.made[static_cast<std::size_t>(c)];
      const int x = i - (c & 1) * n;
      const int y = j - (c >> 1) * n;
      if (child == nullptr || x < 0 || x > n || y < 0 || y > n) continue;
      const std::int32_t q = child->quanta[static_cast<std::size_t>(y * (n + 1) + x)];
      most = std::max(most, std::abs(std::int64_t{q} - mesh.height_q[v]));
      mesh.height_q[v] = q;
      break;
    }
  }
  return most;
}

void put_inner(const lod::TileKey& key, const GridTile& tile, const PackedMesh& mesh, int n, TileStore& store) {
  TilePayload payload;
  payload.heights = encode_heights(tile.quanta, n + 1);
  if (std::find(tile.nodata.begin(), tile.nodata.end(), true) != tile.nodata.end())
    payload.nodata = encode_mask(tile.nodata);
  payload.meshes.push_back(encode_mesh(mesh));
  store.put_tile(to_row(key, tile.node), payload);
}

// Returns true for a border of 2 n intervals that has every second post.
bool is_every_second(const std::vector<int>& border, int n) {
  return border.size() == static_cast<std::size_t>(n) + 1 &&
         std::ranges::all_of(border, [](int along) { return along % 2 == 0; });
}

// Returns the border vertices of a neighbour's mesh, in positions along the own edge of a grid of `intervals`.
std::vector<int> vertices_across(const PackedMesh& mesh, const lod::Neighbour& next, int intervals) {
  const int last = mesh.mesh.intervals;
  const int step = intervals / last;  // 2 beside a finest tile
  std::vector<int> along;
  for (const lod::MeshVertex& v : mesh.mesh.vertices) {
    const bool on_edge = next.edge == lod::Edge::kWest    ? v.i == 0
                         : next.edge == lod::Edge::kEast  ? v.i == last
                         : next.edge == lod::Edge::kSouth ? v.j == 0
                                                          : v.j == last;
    if (!on_edge) continue;
    const int at = next.edge == lod::Edge::kWest || next.edge == lod::Edge::kEast ? v.j : v.i;
    along.push_back(step * (next.reversed ? last - at : at));
  }
  std::sort(along.begin(), along.end());
  return along;
}

// Measures a tile's own posts, and its mesh where that is not their grid: beside its borders.
struct DividedMeters {
  std::unique_ptr<const lod::ErrorMeter> strips;  // null: the mesh is the grid
  lod::GridMeter posts;
  double raise = 1;  // bounds how much more a meter of the whole mesh may raise what it finds
};

// Returns the triangles of a mesh that have a vertex on the border.
PackedMesh border_strips(const PackedMesh& mesh) {
  PackedMesh out = mesh;
  out.mesh.triangles.clear();
  const int last = mesh.mesh.intervals;
  for (std::size_t t = 0; t + 2 < mesh.mesh.triangles.size(); t += 3) {
    const auto begin = mesh.mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t);
    const bool at_border = std::any_of(begin, begin + 3, [&](std::uint16_t corner) {
      const lod::MeshVertex& v = mesh.mesh.vertices[corner];
      return v.i == 0 || v.j == 0 || v.i == last || v.j == last;
    });
    if (at_border) out.mesh.triangles.insert(out.mesh.triangles.end(), begin, begin + 3);
  }
  return out;
}

// Bounds what a meter of the whole mesh finds over posts. Vertices of the overlay that the strips do not have, those on the
// line where they end, are posts of the grid.
lod::ErrorTerms measure_mesh(const DividedMeters& meters, const lod::FinePosts& posts,
                             const lod::ErrorTerms& of_posts) {
  if (!meters.strips) return of_posts;
  lod::ErrorTerms terms = meters.strips->measure(posts);
  terms.include(of_posts);
  const double height_error_m =
      meters.raise * terms.height_error_m + (meters.raise - 1) * (terms.total_m + terms.sagitta_m);
  return {height_error_m, meters.raise * terms.sagitta_m, meters.raise * terms.total_m};
}

}  // namespace

GridTile make_grid_leaf(const PlanetMeta& meta, const BaseTiles& base, const SampledLeaf& leaf,
                        const GroundGrid& ground, TileStore& store) {
  const lod::TileKey& key = leaf.posts.key;
  const int n = leaf.posts.intervals;
  auto [node, payload] = pack_leaf(meta, leaf);
  node.variants.push_back({{}, static_cast<std::uint32_t>(2 * n * n)});
  store.put_tile(to_row(key, node), payload);
  const lod::TileInfo& was = base.planet().tree().deepest(key);
  lod::ErrorTerms change;
  if (was.key.level < kFirstEvenLevel) {
    change = base.meter(was.key)->measure(lod::FinePosts(leaf.posts, meta.radius_m));
  } else {
    double shift_m = 0;
    for (std::size_t p = 0; p < ground.height_m.size(); ++p)
      shift_m = std::max(shift_m, std::abs(leaf.posts.height_m[p] - ground.height_m[p]));
    shift_m *=
        growth(meta, key, std::min(was.min_height_m, node.min_m), std::max(was.max_height_m, node.max_m));
    // Posts on a border with a coarser tile lie on edges of twice the spacing.
    const double spacing_m = lod::post_spacing_m(std::min(was.key.level, key.level - 1), n, meta.radius_m);
    const double sagitta_m = facet_sagitta_m(spacing_m, meta.radius_m);
    change = {shift_m + sagitta_m, sagitta_m, shift_m};
  }
  GridTile tile{std::move(node), leaf.quanta, {}, change, key.level};
  if (leaf.any_nodata) tile.nodata = leaf.nodata;
  return tile;
}

GridTile make_grid_inner(const PlanetMeta& meta, const BaseTiles& base, const GridChildren& children,
                         const lod::TileKey& key, TileStore& store) {
  const int n = meta.tile.intervals();
  const auto was = base.tile(key);
  const lod::TileInfo& had = *base.planet().tree().find(key);
  GridTile tile = parent_of(children);
  tile.quanta = was->quanta;
  tile.nodata = was->nodata;
  PackedMesh mesh = was->mesh;
  const double steepest = std::max(had.steepest_slope, tile.node.slope);
  const auto raise = [&](int level) { return raise_over_cell(level, meta, steepest); };
  const double grows = growth(meta, key, std::min(had.min_height_m, tile.node.min_m),
                              std::max(had.max_height_m, tile.node.max_m)) *
                       meta.quantum_m * raise(key.level + 1);
  const double posts_m = grows * static_cast<double>(take_posts(children, n, tile));
  const double mesh_m = grows * static_cast<double>(take_vertices(children, n, mesh));
  const double raised = raise(tile.coarsest_level);
  tile.node.variants.push_back({bound(had.variants.front().terms, tile.change, mesh_m, raised),
                                static_cast<std::uint32_t>(mesh.mesh.triangle_count())});
  if (had.posts_terms.known())
    tile.node.posts_terms = bound(had.posts_terms.terms(), tile.change, posts_m, raised);
  put_inner(key, tile, mesh, n, store);
  return tile;
}

GridTile make_divided_tile(const PlanetMeta& meta, const BaseTiles& base, const GridChildren& children,
                           const lod::TileKey& key, const IsMade& is_made, TileStore& store) {
  const int n = meta.tile.intervals();
  GridTile tile = parent_of(children);
  tile.quanta.resize(static_cast<std::size_t>(meta.tile.post_count()));
  take_posts(children, n, tile);
  lod::BorderPosts borders;
  for (const lod::Edge edge : lod::kEdges) {
    std::vector<int>& border = borders[static_cast<std::size_t>(edge)];
    const lod::Neighbour next = lod::neighbour(key, edge);
    const lod::TileInfo* beside = base.planet().tree().find(next.key);
    const bool has_mesh =
        beside != nullptr && (beside->has_children || (beside->variants.size() > 1 && !is_made(next.key)));
    if (has_mesh) {
      border = vertices_across(base.tile(next.key)->mesh, next, 2 * n);
    } else {
      for (int a = 0; a <= 2 * n; a += 2) border.push_back(a);
    }
  }
  tile.is_own_grid =
      std::ranges::all_of(borders, [&](const std::vector<int>& border) { return is_every_second(border, n); });
  PackedMesh mesh;
  mesh.mesh = stitched_grid(2 * n, borders);
  mesh.height_q.resize(mesh.mesh.vertices.size());
  take_vertices(children, n, mesh);
  tile.node.variants.push_back({{}, static_cast<std::uint32_t>(mesh.mesh.triangle_count())});
  put_inner(key, tile, mesh, n, store);
  return tile;
}

std::map<lod::TileKey, InnerTerms> measure_divided_tiles(const StoredTiles& stored, const lod::TileTree& planet,
                                                         const std::map<lod::TileKey, GridTile>& tiles,
                                                         std::span<const lod::TileKey> leaves) {
  const double radius_m = stored.meta.radius_m;
  const auto posts_of = [&](const lod::TileKey& key) {
    return posts_of_quanta(stored, key, tiles.at(key).quanta);
  };
  const auto meters_of = [&](const lod::TileKey& key) {
    std::unique_ptr<const lod::ErrorMeter> strips;
    if (!tiles.at(key).is_own_grid) {
      const PackedMesh mesh =
          border_strips(decode_mesh(stored.store.mesh(key, 0), mesh_intervals(stored.meta.tile, true)));
      strips = std::make_unique<const lod::ErrorMeter>(key, mesh.mesh,
                                                       vertex_heights(mesh, stored.meta.quantum_m), radius_m);
    }
    const double raise = raise_over_cell(key.level, stored.meta, stored.nodes.at(key).slope);
    return std::make_unique<DividedMeters>(
        DividedMeters{std::move(strips), lod::GridMeter(posts_of(key), radius_m), raise});
  };
  std::map<lod::TileKey, InnerTerms> found;
  std::map<lod::TileKey, std::unique_ptr<DividedMeters>> meters;
  for (const lod::TileKey& leaf : leaves) {
    const int first = planet.deepest(leaf).key.level;
    if (first >= leaf.level) continue;
    std::erase_if(meters, [&](const auto& meter) { return !lod::contains(meter.first, leaf); });
    const lod::FinePosts posts(posts_of(leaf), radius_m);
    for (int level = first; level < leaf.level; ++level) {
      const lod::TileKey key = lod::ancestor(leaf, level);
      auto& meter = meters[key];
      if (!meter) meter = meters_of(key);
      const lod::ErrorTerms of_posts = meter->posts.measure(posts);
      found[key].include({measure_mesh(*meter, posts, of_posts), of_posts});
    }
  }
  return found;
}

}  // namespace paging
