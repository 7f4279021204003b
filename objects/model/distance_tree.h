// A tree of boxes over the triangles of a mesh, for the nearest point of its surface.
//
// Typical usage:
//   const DistanceTree tree(mesh);
//   const double away_m = tree.nearest(point_m).distance_m;
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "objects/model/mesh.h"

namespace objects {

// Returns the distance from a point to a triangle. Triangles without area are segments or points. Pure.
double distance_to_triangle(const glm::dvec3& point_m, const std::array<glm::dvec3, 3>& corners_m);

// Immutable after it is built. Any thread may call any member. The same on every machine.
class DistanceTree {
 public:
  // Triangles are numbered from 0 in an order of the tree's own: those near each other have numbers near each
  // other.
  struct Nearest {
    double distance_m = 0;
    std::uint32_t triangle = 0;
  };

  // Only positions and triangles of the mesh count. Coordinates must be finite.
  explicit DistanceTree(const Mesh& mesh);

  // Returns the nearest triangle. The hint, any triangle, makes that quicker if it is near the point. The tree
  // must have a triangle.
  Nearest nearest(const glm::dvec3& point_m, std::uint32_t hint = 0) const;
  // Returns the distance from a point to one triangle.
  double distance_m(const glm::dvec3& point_m, std::uint32_t triangle) const {
    return distance_to_triangle(point_m, corners_m(triangle));
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(triangles_.size()); }
  // Returns the numbers, in the mesh, of the corners of a triangle.
  const glm::uvec3& vertices(std::uint32_t triangle) const { return triangles_[triangle].vertices; }
  std::array<glm::dvec3, 3> corners_m(std::uint32_t triangle) const {
    const std::array<glm::vec3, 3>& at = triangles_[triangle].at_m;
    return {glm::dvec3(at[0]), glm::dvec3(at[1]), glm::dvec3(at[2])};
  }
  // Returns the largest coordinate, without sign, of any corner.
  double extent_m() const { return extent_m_; }

 private:
  // Holds a box; one with count 0 is inner: its second child is `first`, its first child follows it.
  struct Node {
    glm::vec3 low_m;
    std::uint32_t first = 0;
    glm::vec3 high_m;
    std::uint32_t count = 0;
  };
  struct Triangle {
    std::array<glm::vec3, 3> at_m;
    glm::uvec3 vertices;
  };

  void build(std::uint32_t first, std::uint32_t count, std::vector<glm::vec3>& middles,
             std::vector<std::uint32_t>& order);

  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
  double extent_m_ = 0;
};

}  // namespace objects
