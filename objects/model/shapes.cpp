#include "objects/model/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/scalar_constants.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "objects/model/normals.h"

namespace objects {

namespace {

void add_triangle(Mesh& mesh, int a, int b, int c) {
  mesh.triangles.emplace_back(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                              static_cast<std::uint32_t>(c));
}

void add_quad(Mesh& mesh, int a, int b, int c, int d) {
  add_triangle(mesh, a, b, c);
  add_triangle(mesh, a, c, d);
}

// The point of a circle of radius 1 after n of its `segments` parts.
glm::dvec2 on_circle(int n, int segments) {
  const double angle = 2 * glm::pi<double>() * n / segments;
  return {std::cos(angle), std::sin(angle)};
}

Mesh finished_shape(Mesh mesh) {
  mesh.materials.assign(mesh.triangles.size(), 0);
  mesh.material_table = {Material{}};
  add_normals(mesh);
  return mesh;
}

}  // namespace

Mesh make_box(const glm::vec3& size_m) {
  Mesh mesh;
  for (int n = 0; n < 8; ++n)
    mesh.positions_m.emplace_back(((n & 1) != 0 ? 0.5F : -0.5F) * size_m.x,
                                  ((n & 2) != 0 ? 0.5F : -0.5F) * size_m.y, (n & 4) != 0 ? size_m.z : 0.0F);
  add_quad(mesh, 0, 2, 3, 1);
  add_quad(mesh, 4, 5, 7, 6);
  add_quad(mesh, 0, 1, 5, 4);
  add_quad(mesh, 2, 6, 7, 3);
  add_quad(mesh, 0, 4, 6, 2);
  add_quad(mesh, 1, 3, 7, 5);
  return finished_shape(std::move(mesh));
}

Mesh make_ellipsoid(const glm::vec3& radii_m, int segments) {
  segments = std::max(segments, 4);
  const int rings = segments / 2;
  Mesh mesh;
  mesh.positions_m.emplace_back(0.0F, 0.0F, -radii_m.z);
  mesh.positions_m.emplace_back(0.0F, 0.0F, radii_m.z);
  const auto at = [&](int ring, int n) { return 2 + (ring - 1) * segments + n % segments; };
  for (int ring = 1; ring < rings; ++ring) {
    const glm::dvec2 up = on_circle(ring, 2 * rings);  // from the lower pole
    for (int n = 0; n < segments; ++n) {
      const glm::dvec2 around = on_circle(n, segments);
      mesh.positions_m.emplace_back(
          glm::vec3(glm::dvec3(around.x * up.y, around.y * up.y, -up.x) * glm::dvec3(radii_m)));
    }
  }
  for (int n = 0; n < segments; ++n) {
    add_triangle(mesh, 0, at(1, n + 1), at(1, n));
    for (int ring = 1; ring + 1 < rings; ++ring)
      add_quad(mesh, at(ring, n), at(ring, n + 1), at(ring + 1, n + 1), at(ring + 1, n));
    add_triangle(mesh, at(rings - 1, n), at(rings - 1, n + 1), 1);
  }
  return finished_shape(std::move(mesh));
}

Mesh make_cylinder(float radius_m, float height_m, int segments) {
  segments = std::max(segments, 3);
  Mesh mesh;
  mesh.positions_m = {{0, 0, 0}, {0, 0, height_m}};
  for (int n = 0; n < segments; ++n) {
    const glm::vec2 p = radius_m * glm::vec2(on_circle(n, segments));
    mesh.positions_m.emplace_back(p.x, p.y, 0.0F);
    mesh.positions_m.emplace_back(p.x, p.y, height_m);
  }
  for (int n = 0; n < segments; ++n) {
    const int a = 2 + 2 * n;
    const int b = 2 + 2 * ((n + 1) % segments);
    add_triangle(mesh, 0, b, a);
    add_quad(mesh, a, b, b + 1, a + 1);
    add_triangle(mesh, 1, a + 1, b + 1);
  }
  return finished_shape(std::move(mesh));
}

Mesh make_cone(float radius_m, float height_m, int segments) {
  segments = std::max(segments, 3);
  Mesh mesh;
  mesh.positions_m = {{0, 0, 0}, {0, 0, height_m}};
  for (int n = 0; n < segments; ++n)
    mesh.positions_m.emplace_back(radius_m * glm::vec2(on_circle(n, segments)), 0.0F);
  for (int n = 0; n < segments; ++n) {
    const int a = 2 + n;
    const int b = 2 + (n + 1) % segments;
    add_triangle(mesh, 0, b, a);
    add_triangle(mesh, a, b, 1);
  }
  return finished_shape(std::move(mesh));
}

Mesh make_torus(float ring_radius_m, float tube_radius_m, int ring_segments, int tube_segments) {
  ring_segments = std::max(ring_segments, 3);
  tube_segments = std::max(tube_segments, 3);
  Mesh mesh;
  for (int r = 0; r < ring_segments; ++r) {
    const glm::dvec2 ring = on_circle(r, ring_segments);
    for (int t = 0; t < tube_segments; ++t) {
      const glm::dvec2 tube = static_cast<double>(tube_radius_m) * on_circle(t, tube_segments);
      const double away = static_cast<double>(ring_radius_m) + tube.x;
      mesh.positions_m.emplace_back(glm::vec3(glm::dvec3(away * ring.x, away * ring.y, tube.y)));
    }
  }
  const auto at = [&](int r, int t) { return r % ring_segments * tube_segments + t % tube_segments; };
  for (int r = 0; r < ring_segments; ++r)
    for (int t = 0; t < tube_segments; ++t)
      add_quad(mesh, at(r, t), at(r + 1, t), at(r + 1, t + 1), at(r, t + 1));
  return finished_shape(std::move(mesh));
}

void append(Mesh& to, const Mesh& part, const glm::mat4& placed, Rgba colour) {
  Mesh added;
  added.triangles = part.triangles;
  added.normals = part.normals;
  const glm::mat3 turned(placed);
  const float determinant = glm::determinant(turned);
  for (const glm::vec3& p : part.positions_m) added.positions_m.emplace_back(placed * glm::vec4(p, 1.0F));
  if (determinant < 0)
    for (glm::uvec3& t : added.triangles) std::swap(t.y, t.z);
  if (!added.normals.empty() && determinant != 0) {
    const glm::mat3 of_normals = glm::transpose(glm::inverse(turned));
    for (glm::vec3& n : added.normals) n = glm::normalize(of_normals * n);
  }
  if (added.normals.empty() != to.normals.empty() && !to.triangles.empty()) {
    if (added.normals.empty()) add_normals(added);
    if (to.normals.empty()) add_normals(to);
  }
  const auto first = static_cast<std::uint32_t>(to.positions_m.size());
  to.positions_m.insert(to.positions_m.end(), added.positions_m.begin(), added.positions_m.end());
  to.normals.insert(to.normals.end(), added.normals.begin(), added.normals.end());
  if (!to.uvs.empty()) to.uvs.resize(to.positions_m.size(), glm::vec2(0));
  if (!to.colours.empty()) to.colours.resize(to.positions_m.size(), Rgba{255, 255, 255, 255});
  for (const glm::uvec3& t : added.triangles) to.triangles.push_back(t + first);

  const auto is_plain = [&](const Material& m) {
    return m.colour == colour && m.texture < 0 && m.alpha == AlphaMode::kOpaque && m.double_sided;
  };
  const auto found = std::find_if(to.material_table.begin(), to.material_table.end(), is_plain);
  const auto material = static_cast<std::uint16_t>(found - to.material_table.begin());
  if (found == to.material_table.end())
    to.material_table.push_back({colour, -1, AlphaMode::kOpaque, 128, true});
  to.materials.resize(to.triangles.size(), material);
}

}  // namespace objects
