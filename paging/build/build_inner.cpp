#include <algorithm>
#include <cmath>

#include "paging/build/build_grid.h"
#include "paging/build/nodata_fill.h"
#include "paging/build/source_heights.h"

namespace paging {

namespace {

// Copies a child's posts to their place in its parent's mesh grid.
void put_child(lod::Posts& posts, int child, const lod::Posts& fine) {
  const int n = fine.intervals;
  const auto side = static_cast<std::size_t>(fine.side());
  const auto wide = static_cast<std::size_t>(posts.side());
  const auto x0 = static_cast<std::size_t>((child & 1) * n);
  const auto y0 = static_cast<std::size_t>((child >> 1) * n);
  for (std::size_t j = 0; j < side; ++j) {
    std::copy_n(fine.height_m.begin() + static_cast<std::ptrdiff_t>(j * side), side,
                posts.height_m.begin() + static_cast<std::ptrdiff_t>((y0 + j) * wide + x0));
  }
}

// Returns an inner tile's own posts out of those that it is meshed over.
std::vector<double> every_second(const lod::Posts& posts) {
  std::vector<double> own;
  for (int j = 0; j < posts.side(); j += 2) {
    for (int i = 0; i < posts.side(); i += 2) own.push_back(posts.at(i, j));
  }
  return own;
}

// Marks the nodata posts of a child that are posts of its parent: every second one is.
void put_child_mask(std::vector<bool>& nodata, int child, const Bytes& packed, std::size_t side) {
  if (packed.empty()) return;
  const std::vector<bool> below = decode_mask(packed, side * side);
  const std::size_t x0 = (child & 1) != 0 ? side / 2 : 0;
  const std::size_t y0 = (child >> 1) != 0 ? side / 2 : 0;
  for (std::size_t j = 0; j < side; j += 2) {
    for (std::size_t i = 0; i < side; i += 2) {
      if (below[j * side + i]) nodata[(y0 + j / 2) * side + x0 + i / 2] = true;
    }
  }
}

// Returns an inner tile's own posts as the finest tiles below it have them: they are posts of these tiles that
// no border moves.
lod::Posts sample_inner(const SampleInputs& sampling, const lod::TileKey& key) {
  const PlanetMeta& meta = sampling.meta;
  const int n = meta.tile.intervals();
  const lod::GridLines lines = lod::grid_lines(key, n);
  const std::vector<glm::dvec3> directions = post_directions(key, lines);
  lod::Posts posts{key, n, std::vector<double>(directions.size())};
  std::map<int, std::vector<std::size_t>> by_level;
  std::vector<int> levels;
  for (std::size_t p = 0; p < directions.size(); ++p) {
    levels.push_back(
        sampling.plan.coarsest_level_at(key.face, lines.u[p % lines.u.size()], lines.v[p / lines.u.size()]));
    by_level[levels.back()].push_back(p);
  }
  bool has_nodata = false;
  for (const auto& [level, some] : by_level) {
    std::vector<glm::dvec3> at;
    for (const std::size_t p : some) at.push_back(directions[p]);
    std::vector<double> heights(at.size());
    sampling.elevation.sample(at, lod::post_spacing_m(level, n, meta.radius_m), heights);
    check_heights(at, heights, meta, sampling.elevation);
    for (std::size_t m = 0; m < some.size(); ++m) {
      posts.height_m[some[m]] = heights[m];
      has_nodata = has_nodata || !std::isfinite(heights[m]);
    }
  }
  if (has_nodata) fill_nodata(sampling, key, levels, posts.height_m);
  const std::vector<std::int32_t> quanta = to_quanta(posts.height_m, meta.quantum_m);
  for (std::size_t p = 0; p < quanta.size(); ++p) posts.height_m[p] = quanta[p] * meta.quantum_m;
  return posts;
}

}  // namespace

SharedAncestor sample_shared_ancestor(const SampleInputs& sampling, const MeshInputs& meshing,
                                      const lod::TileKey& key) {
  const int n = 2 * sampling.meta.tile.intervals();
  lod::Posts posts{key, n,
                   std::vector<double>(static_cast<std::size_t>(n + 1) * static_cast<std::size_t>(n + 1))};
  for (int c = 0; c < 4; ++c) {
    const lod::TileKey child = lod::child(key, c);
    put_child(
        posts, c,
        sampling.plan.is_inner(child) ? sample_inner(sampling, child) : sample_leaf(sampling, child).posts);
  }
  return {mesh_inner(meshing, posts), {key, n / 2, every_second(posts)}};
}

PackedMesh mesh_inner(const MeshInputs& meshing, const lod::Posts& posts) {
  // A finest tile beside this one has only every second of these border posts.
  std::array<int, 4> border_step{1, 1, 1, 1};
  for (const lod::Edge edge : lod::kEdges) {
    if (!meshing.plan.is_inner(lod::neighbour(posts.key, edge).key))
      border_step[static_cast<std::size_t>(edge)] = 2;
  }
  const auto mesher = meshing.meshers.acquire();
  const double tolerance = mesh_tolerance_m(meshing, posts.key.level);
  const lod::GridLines lines = lod::grid_lines(posts.key, posts.intervals);
  const lod::BorderPosts borders = borders_of(posts, lines, border_step, tolerance, meshing.meta.radius_m);
  return pack_mesh(mesher->mesh(posts, borders, tolerance, meshing.meta.radius_m), posts,
                   meshing.meta.quantum_m);
}

Node build_inner(const MeshInputs& meshing, const StoredTiles& stored, const lod::TileKey& key) {
  const PlanetMeta& meta = stored.meta;
  const int n = meta.tile.intervals();
  const auto wide = static_cast<std::size_t>(2 * n + 1);
  Node node;
  node.inner = true;
  lod::Posts posts{key, 2 * n, std::vector<double>(wide * wide)};
  std::vector<bool> nodata(static_cast<std::size_t>(meta.tile.post_count()));
  for (int c = 0; c < 4; ++c) {
    const lod::TileKey child = lod::child(key, c);
    const lod::Posts fine = read_posts(stored, child);
    put_child(posts, c, fine);
    put_child_mask(nodata, c, stored.store.nodata(child), static_cast<std::size_t>(n + 1));
    const Node& below = stored.nodes.at(child);
    node.sources.insert(below.sources.begin(), below.sources.end());
    node.min_m = c == 0 ? below.min_m : std::min(node.min_m, below.min_m);
    node.lowest_m = c == 0 ? below.lowest_m : std::min(node.lowest_m, below.lowest_m);
    node.max_m = c == 0 ? below.max_m : std::max(node.max_m, below.max_m);
    node.slope = std::max(node.slope, below.slope);
  }
  const std::vector<double> own = every_second(posts);
  TilePayload payload;
  payload.heights = encode_heights(to_quanta(own, meta.quantum_m), n + 1);
  if (std::find(nodata.begin(), nodata.end(), true) != nodata.end()) payload.nodata = encode_mask(nodata);

  const PackedMesh mesh = mesh_inner(meshing, posts);
  payload.meshes.push_back(encode_mesh(mesh));
  node.variants.push_back({{}, static_cast<std::uint32_t>(mesh.mesh.triangle_count())});
  stored.store.put_tile(to_row(key, node), payload);
  return node;
}

}  // namespace paging
