#include "paging/planet/verify_tile.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "lod/mesh/grid_meter.h"

namespace paging {

namespace {

// A damaged neighbour is reported by its own check; here it only ends the comparison.
template <class Check>
void unless_damaged(const Check& check) {
  try {
    check();
  } catch (const PlanetError&) {
  }
}

double edge_post(const lod::Posts& posts, lod::Edge edge, int along) {
  const int last = posts.intervals;
  switch (edge) {
    case lod::Edge::kWest: return posts.at(0, along);
    case lod::Edge::kEast: return posts.at(last, along);
    case lod::Edge::kSouth: return posts.at(along, 0);
    case lod::Edge::kNorth: return posts.at(along, last);
  }
  return 0;
}

// Returns the positions of a mesh's vertices along an edge, in units of half a post interval of the tile.
std::vector<int> edge_vertices(const lod::TileMesh& mesh, int tile_intervals, lod::Edge edge) {
  const int last = mesh.intervals;
  const int unit = 2 * tile_intervals / last;
  std::vector<int> found;
  for (const lod::MeshVertex& v : mesh.vertices) {
    if (edge == lod::Edge::kWest && v.i == 0) found.push_back(v.j * unit);
    if (edge == lod::Edge::kEast && v.i == last) found.push_back(v.j * unit);
    if (edge == lod::Edge::kSouth && v.j == 0) found.push_back(v.i * unit);
    if (edge == lod::Edge::kNorth && v.j == last) found.push_back(v.i * unit);
  }
  std::sort(found.begin(), found.end());
  return found;
}

// Returns what is wrong with a mesh, or an empty text.
std::string mesh_problem(const PackedMesh& packed, const lod::MeshVariant& stated, const TileHeights* own,
                         double quantum_m) {
  const lod::TileMesh& mesh = packed.mesh;
  if (mesh.triangle_count() != stated.triangles) return "its number of triangles differs from the index";
  // Counter-clockwise triangles whose areas add up to the tile's cover it once: borders are complete.
  std::int64_t area2 = 0;
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const auto a = mesh.vertices[mesh.triangles[t]];
    const auto b = mesh.vertices[mesh.triangles[t + 1]];
    const auto c = mesh.vertices[mesh.triangles[t + 2]];
    const std::int64_t twice = std::int64_t{b.i - a.i} * (c.j - a.j) - std::int64_t{b.j - a.j} * (c.i - a.i);
    if (twice <= 0) return "a triangle is reversed or degenerate";
    area2 += twice;
  }
  if (area2 != 2 * std::int64_t{mesh.intervals} * mesh.intervals) return "its triangles do not cover the tile";
  if (own == nullptr) return "";
  const int step = mesh.intervals / own->posts.intervals;  // 1, or 2 over the children's posts
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
    const lod::MeshVertex v = mesh.vertices[n];
    if (v.i % step != 0 || v.j % step != 0) continue;
    if (packed.height_q[n] * quantum_m != own->posts.at(v.i / step, v.j / step))
      return "a vertex is not on its post";
  }
  return "";
}

void check_borders(const PlanetFile& planet, const lod::TileInfo& tile, const TileHeights& own,
                   const PackedMesh& mesh, TileFindings& out) {
  const int n = own.posts.intervals;
  for (const lod::Edge edge : lod::kEdges) {
    const lod::Neighbour next = lod::neighbour(tile.key, edge);
    const lod::TileInfo* other = planet.tree().find(next.key);
    if (other != nullptr) {
      if (lod::pack(next.key) < lod::pack(tile.key)) continue;
      unless_damaged([&] {
        const TileHeights heights = planet.heights(next.key);
        bool equal = true;
        for (int a = 0; a <= n; ++a) {
          const int b = next.reversed ? n - a : a;
          equal = equal && edge_post(own.posts, edge, a) == edge_post(heights.posts, next.edge, b);
        }
        if (!equal)
          out.problem(tile.key,
                      "its posts differ from those of " + lod::to_string(next.key) + " on their border");
        std::vector<int> theirs = edge_vertices(planet.mesh(next.key, 0).mesh, n, next.edge);
        if (next.reversed) {
          for (int& b : theirs) b = 2 * n - b;
          std::reverse(theirs.begin(), theirs.end());
        }
        if (edge_vertices(mesh.mesh, n, edge) != theirs) {
          out.problem(tile.key,
                      "its mesh differs from that of " + lod::to_string(next.key) + " on their border");
        }
        ++out.report.borders;
      });
      continue;
    }
    // A finest tile one level coarser: its posts are every second of these.
    unless_damaged([&] {
      const lod::Neighbour wide = lod::neighbour(lod::parent(tile.key), edge);
      const TileHeights heights = planet.heights(wide.key);
      const bool along_j = edge == lod::Edge::kWest || edge == lod::Edge::kEast;
      const int half = (along_j ? tile.key.j : tile.key.i) % 2;
      bool equal = true;
      for (int a = 0; a <= n; a += 2) {
        const int at = half * n / 2 + a / 2;
        const int b = wide.reversed ? n - at : at;
        equal = equal && edge_post(own.posts, edge, a) == edge_post(heights.posts, wide.edge, b);
      }
      if (!equal)
        out.problem(tile.key,
                    "its posts differ from those of " + lod::to_string(wide.key) + " on their border");
      ++out.report.borders;
    });
  }
}

void check_children(const PlanetFile& planet, const lod::TileInfo& tile, const TileHeights& own,
                    TileFindings& out) {
  const int n = own.posts.intervals;
  for (int c = 0; c < 4; ++c) {
    unless_damaged([&] {
      const TileHeights below = planet.heights(lod::child(tile.key, c));
      const int i0 = (c & 1) * n / 2;
      const int j0 = (c >> 1) * n / 2;
      for (int j = 0; j <= n / 2; ++j) {
        for (int i = 0; i <= n / 2; ++i) {
          if (own.posts.at(i0 + i, j0 + j) == below.posts.at(2 * i, 2 * j)) continue;
          return out.problem(tile.key, "its posts are not those of " + lod::to_string(below.posts.key));
        }
      }
    });
  }
}

void check_sources(const PlanetFile& planet, const lod::TileKey& key, const TileHeights& own,
                   TileFindings& out) {
  try {
    const TileSources sources = planet.sources(key);
    if (sources.of_post.empty()) return;
    std::vector<bool> is_used(sources.of_tile.size());
    for (std::size_t n = 0; n < sources.of_post.size(); ++n) {
      const std::size_t number = sources.of_post[n];
      if (number > 0) is_used[number - 1] = true;
      if ((number == 0) != (!own.nodata.empty() && own.nodata[n]))
        return out.problem(key, "the sources of its posts differ from its nodata mask");
    }
    if (std::find(is_used.begin(), is_used.end(), false) != is_used.end())
      out.problem(key, "the sources of its posts differ from the index");
  } catch (const PlanetError& e) {
    out.problem(key, e.what());
  }
}

}  // namespace

void TileFindings::problem(const lod::TileKey& key, const std::string& what) {
  report.problems.push_back({lod::to_string(key), what});
}

TileFindings check_tile(const PlanetFile& planet, const lod::TileInfo& tile) {
  TileFindings out;
  const double quantum_m = planet.meta().quantum_m;
  ++out.report.tiles;
  std::optional<TileHeights> own;
  try {
    own = planet.heights(tile.key);
  } catch (const PlanetError& e) {
    out.problem(tile.key, e.what());
  }
  std::optional<PackedMesh> first;
  const std::size_t meshes = tile.variants.size() - (tile.has_children ? 0 : 1);
  for (std::size_t v = 0; v < meshes; ++v) {
    try {
      ++out.report.meshes;
      PackedMesh mesh = planet.mesh(tile.key, static_cast<int>(v));
      const std::string wrong = mesh_problem(mesh, tile.variants[v], own ? &*own : nullptr, quantum_m);
      if (!wrong.empty()) out.problem(tile.key, "mesh " + std::to_string(v) + ": " + wrong);
      if (v == 0) first = std::move(mesh);
    } catch (const PlanetError& e) {
      out.problem(tile.key, e.what());
    }
  }
  if (!own) return out;
  if (tile.has_children) {
    check_children(planet, tile, *own, out);
  } else {
    check_sources(planet, tile.key, *own, out);
    const auto [low, high] = std::minmax_element(own->posts.height_m.begin(), own->posts.height_m.end());
    const lod::GridLines lines = lod::grid_lines(tile.key, own->posts.intervals);
    if (*low != tile.min_height_m || *high != tile.max_height_m ||
        lod::steepest_slope(own->posts, lines, planet.radius_m()) > tile.steepest_slope) {
      out.problem(tile.key, "its heights or slopes differ from the index");
    }
  }
  if (first) check_borders(planet, tile, *own, *first, out);
  return out;
}

TileFindings measure_tile(const PlanetFile& planet, const lod::TileInfo& leaf) {
  TileFindings out;
  unless_damaged([&] {
    const lod::FinePosts fine(planet.heights(leaf.key).posts, planet.radius_m());
    for (int level = leaf.key.level; level >= 0; --level) {
      const lod::TileInfo& tile = *planet.tree().find(lod::ancestor(leaf.key, level));
      const auto compare = [&](const lod::ErrorTerms& found, const lod::ErrorTerms& stated,
                               const std::string& what) {
        ++out.report.measured;
        if (found.total_m > stated.total_m || found.height_error_m > stated.height_error_m ||
            found.sagitta_m > stated.sagitta_m) {
          out.problem(tile.key,
                      what + " farther from the surface below " + lod::to_string(leaf.key) + " than it states");
        }
        if (stated.total_m > 0) {
          out.report.largest_share = std::max(out.report.largest_share, found.total_m / stated.total_m);
        }
      };
      if (tile.posts_terms.known()) {
        const lod::GridMeter posts(planet.heights(tile.key).posts, planet.radius_m());
        compare(posts.measure(fine), tile.posts_terms.terms(), "its grid of posts is");
      }
      const std::size_t meshes = tile.variants.size() - (tile.has_children ? 0 : 1);
      for (std::size_t v = 0; v < meshes; ++v) {
        const PackedMesh mesh = planet.mesh(tile.key, static_cast<int>(v));
        std::vector<double> heights;
        for (const std::int32_t q : mesh.height_q) heights.push_back(q * planet.meta().quantum_m);
        compare(lod::ErrorMeter(tile.key, mesh.mesh, heights, planet.radius_m()).measure(fine),
                tile.variants[v].terms, "mesh " + std::to_string(v) + " is");
      }
    }
  });
  return out;
}

TileFindings check_image(const PlanetFile& planet, const lod::TileKey& key) {
  TileFindings out;
  ++out.report.images;
  try {
    planet.image(key);
  } catch (const PlanetError& e) {
    out.problem(key, e.what());
  }
  return out;
}

}  // namespace paging
