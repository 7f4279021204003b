#include "vpe/gl/tile_geometry.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <unordered_map>

namespace vpe::gl {

namespace {

// Border vertices of one edge in order along it.
std::vector<std::uint32_t> border(const lod::TileMesh& mesh, lod::Edge edge) {
  const bool vertical = edge == lod::Edge::kWest || edge == lod::Edge::kEast;
  const int line = edge == lod::Edge::kWest || edge == lod::Edge::kSouth ? 0 : mesh.intervals;
  std::vector<std::uint32_t> out;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if ((vertical ? mesh.vertices[v].i : mesh.vertices[v].j) == line) out.push_back(v);
  }
  std::sort(out.begin(), out.end(), [&](std::uint32_t a, std::uint32_t b) {
    return vertical ? mesh.vertices[a].j < mesh.vertices[b].j : mesh.vertices[a].i < mesh.vertices[b].i;
  });
  return out;
}

std::size_t nearest_vertex(const lod::TileMesh& mesh, int origin) {
  const int side = mesh.intervals + 1;
  std::size_t best = 0;
  int least = std::numeric_limits<int>::max();
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
    const int di = mesh.vertices[n].i - origin % side;
    const int dj = mesh.vertices[n].j - origin / side;
    if (di * di + dj * dj >= least) continue;
    least = di * di + dj * dj;
    best = n;
  }
  return best;
}

float sign_of(float x) { return x >= 0.0F ? 1.0F : -1.0F; }

// The fold of the octahedron's lower half over the upper one; its own inverse.
glm::vec2 folded(const glm::vec2& p) {
  return {(1.0F - std::abs(p.y)) * sign_of(p.x), (1.0F - std::abs(p.x)) * sign_of(p.y)};
}

}  // namespace

VertexNormal pack_normal(const glm::vec3& unit) {
  glm::vec2 p = glm::vec2(unit.x, unit.y) / (std::abs(unit.x) + std::abs(unit.y) + std::abs(unit.z));
  if (unit.z < 0.0F) p = folded(p);
  const auto step = [](float x) { return static_cast<std::int16_t>(std::lround(32767.0F * x)); };
  return {step(p.x), step(p.y)};
}

glm::vec3 unpack_normal(const VertexNormal& normal) {
  const glm::vec2 p(static_cast<float>(normal.x) / 32767.0F, static_cast<float>(normal.y) / 32767.0F);
  const float z = 1.0F - std::abs(p.x) - std::abs(p.y);
  return glm::normalize(glm::vec3(z < 0.0F ? folded(p) : p, z));
}

TileGeometry make_geometry(const lod::TileKey& key, const lod::TileMesh& mesh, std::span<const double> height_m,
                           double radius_m, const GeometryOptions& options) {
  const auto& [exaggeration, origin, with_charts, normals] = options;
  const lod::GridLines lines = lod::grid_lines(key, mesh.intervals);
  const mars::ChartRect rect = lod::chart_rect(key);
  TileGeometry out;
  const auto texel = [](double x, double low, double high) {
    return static_cast<std::uint16_t>(std::lround(65535.0 * (x - low) / (high - low)));
  };
  std::vector<glm::dvec3> places;
  places.reserve(mesh.vertices.size());
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
    places.push_back(mars::chart_direction(key.face, lines.u[mesh.vertices[n].i], lines.v[mesh.vertices[n].j]) *
                     (radius_m + exaggeration * height_m[n]));
  }
  const double middle_m = height_m.empty() ? 0.0 : height_m[height_m.size() / 2];
  out.centre_m = origin == kTileCentre
                     ? mars::chart_direction(key.face, 0.5 * (rect.u0 + rect.u1), 0.5 * (rect.v0 + rect.v1)) *
                           (radius_m + exaggeration * middle_m)
                     : places[nearest_vertex(mesh, origin)];
  double worst2 = 0;
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
    const double u = lines.u[mesh.vertices[n].i];
    const double v = lines.v[mesh.vertices[n].j];
    const glm::dvec3 exact = places[n] - out.centre_m;
    const glm::vec3 stored(exact);
    const glm::dvec3 error = glm::dvec3(stored) - exact;
    worst2 = std::max(worst2, glm::dot(error, error));
    out.positions_m.push_back(stored);
    if (with_charts) out.charts.push_back({texel(u, rect.u0, rect.u1), texel(v, rect.v0, rect.v1)});
    if (!normals.empty()) out.normals.push_back(pack_normal(normals[n]));
  }
  out.quantisation_m = std::sqrt(worst2);
  out.surface_vertices = static_cast<std::uint32_t>(out.positions_m.size());
  out.indices.assign(mesh.triangles.begin(), mesh.triangles.end());
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const std::array<glm::dvec3, 3> corners{places[mesh.triangles[t]], places[mesh.triangles[t + 1]],
                                            places[mesh.triangles[t + 2]]};
    for (std::size_t k = 0; k < 3; ++k) {
      out.longest_edge_m = std::max(out.longest_edge_m, glm::length(corners[k] - corners[(k + 1) % 3]));
    }
  }
  const auto end = [&out] { return static_cast<std::uint32_t>(out.indices.size()); };
  out.ranges.surface = end();
  out.frame = piece_frame(out.centre_m);
  out.pieces = mesh_pieces(mesh, out.positions_m, out.frame);
  std::vector<std::uint32_t> lines_of_border;
  for (std::size_t e = 0; e < lod::kEdges.size(); ++e) {
    const std::vector<std::uint32_t> top = border(mesh, lod::kEdges[e]);
    out.ranges.skirts[e] = end();
    const auto foot = static_cast<std::uint32_t>(out.positions_m.size());
    for (const std::uint32_t v : top) {
      out.positions_m.push_back(out.positions_m[v]);
      if (with_charts) out.charts.push_back(out.charts[v]);
      if (!normals.empty()) out.normals.push_back(out.normals[v]);
    }
    for (std::uint32_t n = 0; n + 1 < top.size(); ++n) {
      for (const std::uint32_t index : {top[n], top[n + 1], foot + n, foot + n + 1}) {
        out.indices.push_back(index);
      }
      lines_of_border.insert(lines_of_border.end(), {top[n], top[n + 1]});
    }
  }
  out.ranges.skirts[4] = end();
  out.indices.insert(out.indices.end(), lines_of_border.begin(), lines_of_border.end());
  out.ranges.border_end = end();
  return out;
}

std::vector<std::uint32_t> border_triangles(const lod::TileMesh& mesh) {
  const auto side = [](std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
  };
  std::unordered_map<std::uint64_t, std::uint32_t> beside;
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const lod::MeshVertex a = mesh.vertices[mesh.triangles[t + k]];
      const lod::MeshVertex b = mesh.vertices[mesh.triangles[t + (k + 1) % 3]];
      const bool on_border = (a.i == b.i && (a.i == 0 || a.i == mesh.intervals)) ||
                             (a.j == b.j && (a.j == 0 || a.j == mesh.intervals));
      if (on_border)
        beside.emplace(side(mesh.triangles[t + k], mesh.triangles[t + (k + 1) % 3]),
                       static_cast<std::uint32_t>(t / 3));
    }
  }
  std::vector<std::uint32_t> out;
  for (const lod::Edge edge : lod::kEdges) {
    const std::vector<std::uint32_t> line = border(mesh, edge);
    for (std::size_t n = 0; n + 1 < line.size(); ++n) out.push_back(beside.at(side(line[n], line[n + 1])));
  }
  return out;
}

}  // namespace vpe::gl
