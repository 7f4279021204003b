// Planes through points.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>

namespace objects {

// Gathers points and fits the plane to them that has the least squares of distances.
class PlaneFit {
 public:
  void add(const glm::dvec3& point);
  std::size_t size() const { return count_; }

  // Returns one of the two unit normals of the plane, or nullopt where points leave it undecided: fewer than three, or
  // on one line.
  std::optional<glm::dvec3> normal() const;

 private:
  std::size_t count_ = 0;
  glm::dvec3 sum_{0, 0, 0};
  std::array<double, 6> products_{};  // xx, yy, zz, xy, xz, yz
};

}  // namespace objects
