#include "paging/build/build_grid.h"

#include <algorithm>
#include <cmath>

namespace paging {

namespace {

bool along_j(lod::Edge edge) { return edge == lod::Edge::kWest || edge == lod::Edge::kEast; }

}  // namespace

std::size_t edge_post(lod::Edge edge, int along, int side) {
  const auto n = static_cast<std::size_t>(side);
  const auto a = static_cast<std::size_t>(along);
  switch (edge) {
    case lod::Edge::kWest: return a * n;
    case lod::Edge::kEast: return a * n + n - 1;
    case lod::Edge::kSouth: return a;
    case lod::Edge::kNorth: return (n - 1) * n + a;
  }
  return 0;
}

std::vector<glm::dvec3> post_directions(const lod::TileKey& key, const lod::GridLines& lines) {
  std::vector<glm::dvec3> directions;
  directions.reserve(lines.u.size() * lines.v.size());
  for (const double v : lines.v) {
    for (const double u : lines.u) directions.push_back(mars::chart_direction(key.face, u, v));
  }
  return directions;
}

lod::BorderPosts borders_of(const lod::Posts& posts, const lod::GridLines& lines,
                            const std::array<int, 4>& step, double tolerance_m, double radius_m) {
  lod::BorderPosts out;
  for (const lod::Edge edge : lod::kEdges) {
    const auto e = static_cast<std::size_t>(edge);
    const std::vector<double>& along = along_j(edge) ? lines.v : lines.u;
    const std::vector<double>& fixed = along_j(edge) ? lines.u : lines.v;
    const bool far = edge == lod::Edge::kEast || edge == lod::Edge::kNorth;
    std::vector<double> heights;
    std::vector<double> line;
    for (int a = 0; a < posts.side(); a += step[e]) {
      heights.push_back(posts.height_m[edge_post(edge, a, posts.side())]);
      line.push_back(along[static_cast<std::size_t>(a)]);
    }
    out[e] = lod::choose_border(heights, line, far ? fixed.back() : fixed.front(), tolerance_m, radius_m);
    for (int& a : out[e]) a *= step[e];
  }
  return out;
}

// Heights of the mesh's vertices in quanta. Its vertices are never posts that lie on a coarser edge, so the
// rounding only undoes the multiplication by the quantum.
PackedMesh pack_mesh(lod::TileMesh mesh, const lod::Posts& posts, double quantum_m) {
  PackedMesh packed;
  packed.height_q.reserve(mesh.vertices.size());
  for (const lod::MeshVertex& v : mesh.vertices) {
    packed.height_q.push_back(static_cast<std::int32_t>(std::llround(posts.at(v.i, v.j) / quantum_m)));
  }
  packed.mesh = std::move(mesh);
  return packed;
}

std::vector<std::int32_t> to_quanta(const std::vector<double>& heights, double quantum_m) {
  std::vector<std::int32_t> quanta(heights.size());
  for (std::size_t n = 0; n < heights.size(); ++n) {
    // std::round(), which is a call for each post. What is cut off is exact.
    const double q = heights[n] / quantum_m;
    const auto whole = static_cast<std::int32_t>(q);
    const double rest = q - whole;
    quanta[n] = whole + static_cast<std::int32_t>(rest >= 0.5) - static_cast<std::int32_t>(rest <= -0.5);
  }
  return quanta;
}

std::vector<double> vertex_heights(const PackedMesh& mesh, double quantum_m) {
  std::vector<double> heights(mesh.height_q.size());
  std::transform(mesh.height_q.begin(), mesh.height_q.end(), heights.begin(),
                 [quantum_m](std::int32_t q) { return q * quantum_m; });
  return heights;
}

lod::Posts read_posts(const StoredTiles& stored, const lod::TileKey& key) {
  return posts_of_quanta(stored, key, decode_heights(stored.store.heights(key), stored.meta.tile.posts()));
}

lod::Posts posts_of_quanta(const StoredTiles& stored, const lod::TileKey& key,
                           std::span<const std::int32_t> quanta) {
  lod::Posts posts{key, stored.meta.tile.intervals(), std::vector<double>(quanta.size())};
  std::transform(quanta.begin(), quanta.end(), posts.height_m.begin(),
                 [q = stored.meta.quantum_m](std::int32_t n) { return n * q; });
  const int coarser_neighbour_mask = stored.nodes.at(key).coarser_neighbour_mask;
  if (coarser_neighbour_mask != 0) {
    const lod::GridLines lines = lod::grid_lines(key, posts.intervals);
    for (const lod::Edge edge : lod::kEdges) {
      if ((coarser_neighbour_mask >> static_cast<int>(edge) & 1) != 0)
        lod::constrain_edge(posts, lines, edge, 2, stored.meta.radius_m);
    }
  }
  return posts;
}

double mesh_tolerance_m(const MeshInputs& meshing, int level) {
  return lod::nominal_side_m(level, meshing.meta.radius_m) / meshing.mesh_ratio;
}

}  // namespace paging
