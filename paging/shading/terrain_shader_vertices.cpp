#include <array>
#include <glm/geometric.hpp>

#include "paging/shading/terrain_grid.h"
#include "paging/shading/terrain_shader.h"

namespace paging {

std::vector<glm::vec3> TerrainShader::vertex_normals(const lod::TileKey& key, const lod::TileMesh& mesh,
                                                     std::span<const double> height_m,
                                                     const ShadingParams& params) const {
  const double radius = planet_->radius_m();
  const lod::GridLines lines = lod::grid_lines(key, mesh.intervals);
  std::vector<glm::dvec3> places;
  places.reserve(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    places.push_back(mars::chart_direction(key.face, lines.u[mesh.vertices[v].i], lines.v[mesh.vertices[v].j]) *
                     (radius + params.exaggeration * height_m[v]));
  }
  // The length of a cross product is twice the area, which weights the sum.
  std::vector<glm::dvec3> sums(places.size(), glm::dvec3(0));
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const std::array<std::uint32_t, 3> v{mesh.triangles[t], mesh.triangles[t + 1], mesh.triangles[t + 2]};
    const glm::dvec3 normal = glm::cross(places[v[1]] - places[v[0]], places[v[2]] - places[v[0]]);
    for (const std::uint32_t corner : v) sums[corner] += normal;
  }
  ShadingParams of_posts;
  of_posts.exaggeration = params.exaggeration;
  of_posts.lit = false;
  const std::shared_ptr<const NormalTile> ground = normals(key, of_posts);
  const int n = ground->side - 1;
  const auto side = static_cast<std::size_t>(ground->side);
  const double spacing_m = lod::nominal_side_m(key.level, radius) / mesh.intervals;
  std::vector<glm::vec3> out;
  out.reserve(places.size());
  for (std::size_t v = 0; v < places.size(); ++v) {
    const int i = mesh.vertices[v].i;
    const int j = mesh.vertices[v].j;
    glm::dvec3 normal = sums[v];
    if (i == 0 || j == 0 || i == mesh.intervals || j == mesh.intervals) {
      normal = glm::dvec3(bilinear<glm::vec3>(grid_position(0, i, mesh.intervals, n),
                                              grid_position(0, j, mesh.intervals, n), side,
                                              [&](std::size_t k) { return ground->posts[k].normal; }));
    }
    normal = glm::normalize(normal);
    if (params.lit && params.shadows && glm::dot(normal, params.sun) > 0.0 &&
        !sees_sun(places[v], spacing_m, params))
      normal = -params.sun;
    out.emplace_back(normal);
  }
  return out;
}

}  // namespace paging
