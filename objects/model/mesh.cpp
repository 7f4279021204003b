#include "objects/model/mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace objects {

namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

bool fits(std::size_t entries, std::size_t count) { return entries == 0 || entries == count; }

bool is_drawable(const glm::vec3& p) {
  const auto ok = [](float x) {
    return std::isfinite(x) && std::abs(static_cast<double>(x)) <= MeshLimits::kMostExtent_m;
  };
  return ok(p.x) && ok(p.y) && ok(p.z);
}

// The arrays must fit.
std::string check_vertices(const Mesh& mesh) {
  for (std::size_t n = 0; n < mesh.positions_m.size(); ++n) {
    if (!is_drawable(mesh.positions_m[n]))
      return "the coordinates of vertex " + std::to_string(n) + " are not finite or over 1e9 m";
    if (!mesh.normals.empty() && !is_drawable(mesh.normals[n]))
      return "the normal of vertex " + std::to_string(n) + " is not finite";
    if (!mesh.uvs.empty() && !(std::isfinite(mesh.uvs[n].x) && std::isfinite(mesh.uvs[n].y)))
      return "the texture coordinates of vertex " + std::to_string(n) + " are not finite";
  }
  return "";
}

}  // namespace

std::size_t Mesh::bytes() const {
  std::size_t sum = bytes_of(positions_m) + bytes_of(normals) + bytes_of(uvs) + bytes_of(colours) +
                    bytes_of(triangles) + bytes_of(materials) + bytes_of(material_table);
  for (const Texture& t : textures) sum += bytes_of(t.texels);
  return sum;
}

std::string check(const Mesh& mesh) {
  const std::size_t vertices = mesh.positions_m.size();
  const std::size_t triangles = mesh.triangles.size();
  if (triangles == 0) return "it has no triangle";
  if (vertices > MeshLimits::kMostVertices || triangles > MeshLimits::kMostTriangles)
    return "it has " + std::to_string(vertices) + " vertices and " + std::to_string(triangles) +
           " triangles; at most " + std::to_string(MeshLimits::kMostVertices) + " of each are drawn";
  if (!fits(mesh.normals.size(), vertices) || !fits(mesh.uvs.size(), vertices) ||
      !fits(mesh.colours.size(), vertices) || mesh.materials.size() != triangles)
    return "its arrays have different sizes";
  if (mesh.material_table.empty() || mesh.material_table.size() > MeshLimits::kMostMaterials)
    return "it has " + std::to_string(mesh.material_table.size()) + " materials; 1 to " +
           std::to_string(MeshLimits::kMostMaterials) + " are allowed";
  if (std::string reason = check_vertices(mesh); !reason.empty()) return reason;
  for (std::size_t n = 0; n < triangles; ++n) {
    const glm::uvec3 t = mesh.triangles[n];
    if (std::max({t.x, t.y, t.z}) >= vertices)
      return "triangle " + std::to_string(n) + " names a vertex beyond the last one";
    if (mesh.materials[n] >= mesh.material_table.size())
      return "triangle " + std::to_string(n) + " names a material beyond the last one";
  }
  if (mesh.textures.size() > MeshLimits::kMostTextures)
    return "it has " + std::to_string(mesh.textures.size()) + " textures; at most " +
           std::to_string(MeshLimits::kMostTextures) + " are allowed";
  std::size_t texels = 0;
  for (const Texture& t : mesh.textures) {
    if (t.width <= 0 || t.height <= 0 ||
        t.texels.size() != static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height))
      return "a texture has not the size that it states";
    texels += t.texels.size();
  }
  if (texels > MeshLimits::kMostTexels)
    return "its textures have " + std::to_string(texels) + " texels together; at most " +
           std::to_string(MeshLimits::kMostTexels) + " are allowed";
  for (const Material& m : mesh.material_table) {
    if (m.texture < -1 || m.texture >= static_cast<int>(mesh.textures.size()))
      return "a material names a texture beyond the last one";
  }
  return "";
}

std::string check_points(const Mesh& mesh) {
  const std::size_t points = mesh.positions_m.size();
  if (!mesh.triangles.empty() || !mesh.materials.empty() || !mesh.uvs.empty() || !mesh.material_table.empty() ||
      !mesh.textures.empty())
    return "it has more than points";
  if (points == 0) return "it has no point";
  if (points > MeshLimits::kMostVertices)
    return "it has " + std::to_string(points) + " points; at most " +
           std::to_string(MeshLimits::kMostVertices) + " are read";
  if (!fits(mesh.normals.size(), points) || !fits(mesh.colours.size(), points))
    return "its arrays have different sizes";
  return check_vertices(mesh);
}

// Ritter's ball of two far points, then grown; the better of that and the ball of the box.
Ball bounding_ball(const Mesh& mesh) {
  const std::vector<glm::vec3>& points = mesh.positions_m;
  if (points.empty()) return {};
  const auto farthest = [&](const glm::dvec3& from) {
    return *std::max_element(points.begin(), points.end(), [&](const glm::vec3& a, const glm::vec3& b) {
      return glm::distance(glm::dvec3(a), from) < glm::distance(glm::dvec3(b), from);
    });
  };
  const auto radius_about = [&](const glm::dvec3& centre) {
    double r = 0;
    for (const glm::vec3& p : points) r = std::max(r, glm::distance(glm::dvec3(p), centre));
    return r;
  };
  const glm::dvec3 a(farthest(glm::dvec3(points.front())));
  const glm::dvec3 b(farthest(a));
  glm::dvec3 centre = 0.5 * (a + b);
  // Steps towards the farthest point, each shorter, end within a hundredth of the smallest ball (Badoiu and Clarkson
  // 2003).
  for (int step = 1; step <= 100; ++step) centre += (glm::dvec3(farthest(centre)) - centre) / (step + 1.0);
  const glm::vec3 stored(centre);
  const double radius = radius_about(glm::dvec3(stored));
  return {stored, std::nextafter(static_cast<float>(radius), std::numeric_limits<float>::infinity())};
}

}  // namespace objects
