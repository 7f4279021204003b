#include "vpe/gl/tile_geometry.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

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

}  // namespace

TileGeometry make_geometry(const lod::TileKey& key, const lod::TileMesh& mesh, std::span<const double> height_m,
                           double exaggeration, double radius_m) {
  const lod::GridLines lines = lod::grid_lines(key, mesh.intervals);
  const mars::ChartRect rect = lod::chart_rect(key);
  TileGeometry out;
  const double middle = height_m.empty() ? 0.0 : height_m[height_m.size() / 2];
  out.centre_m = mars::chart_direction(key.face, 0.5 * (rect.u0 + rect.u1), 0.5 * (rect.v0 + rect.v1)) *
                 (radius_m + exaggeration * middle);
  const auto texel = [](double x, double low, double high) {
    return static_cast<std::uint16_t>(std::lround(65535.0 * (x - low) / (high - low)));
  };
  double worst2 = 0;
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
    const double u = lines.u[mesh.vertices[n].i];
    const double v = lines.v[mesh.vertices[n].j];
    const glm::dvec3 exact =
        mars::chart_direction(key.face, u, v) * (radius_m + exaggeration * height_m[n]) - out.centre_m;
    const glm::vec3 stored(exact);
    const glm::dvec3 error = glm::dvec3(stored) - exact;
    worst2 = std::max(worst2, glm::dot(error, error));
    out.vertices.push_back({stored, texel(u, rect.u0, rect.u1), texel(v, rect.v0, rect.v1)});
  }
  out.quantisation_m = std::sqrt(worst2);
  out.surface_vertices = static_cast<std::uint32_t>(out.vertices.size());
  out.indices.assign(mesh.triangles.begin(), mesh.triangles.end());
  out.surface_indices = static_cast<std::uint32_t>(out.indices.size());
  for (const lod::Edge edge : lod::kEdges) {
    const std::vector<std::uint32_t> top = border(mesh, edge);
    const auto foot = static_cast<std::uint32_t>(out.vertices.size());
    for (const std::uint32_t v : top) out.vertices.push_back(out.vertices[v]);
    for (std::uint32_t n = 0; n + 1 < top.size(); ++n) {
      for (const std::uint32_t index : {top[n], foot + n, foot + n + 1, top[n], foot + n + 1, top[n + 1]}) {
        out.indices.push_back(index);
      }
    }
  }
  return out;
}

}  // namespace vpe::gl
