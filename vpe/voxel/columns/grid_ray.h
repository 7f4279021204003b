// A ray in the terms of a height grid. Straight lines stay straight in the chart, so a point of it takes one division.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "mars/geodesy/cube.h"
#include "vpe/voxel/columns/height_grid.h"

namespace vpe::voxel {

// Holds a ray from the distance `begin_m` on. On the way of s metres from there its position in the grid is
// (x + s dx) / (w + s dw), likewise y, and its height in the terms of posts (H in height_grid.h) is (z + s dz) / (w + s dw).
// The error of a height is about 1e-16 of the planet's radius. A pure value.
class GridRay {
 public:
  GridRay(const glm::dvec3& camera_m, const glm::dvec3& ray, double begin_m, mars::Face face,
          const HeightGridFrame& frame, const DepthPlane& reference, double radius_m) {
    const mars::FaceAxes& axes = mars::face_axes(face);
    const glm::dvec3 place = camera_m + begin_m * ray;
    const auto on_grid = [&](const glm::dvec3& p, double constant) {
      const double w = glm::dot(p, axes.out);
      const double x = (glm::dot(p, axes.right) - frame.u0 * w) / frame.du;
      const double y = (glm::dot(p, axes.up) - frame.v0 * w) / frame.dv;
      const double z =
          (reference.w0 * w + reference.wx * x + reference.wy * y - constant) * (radius_m * radius_m);
      return glm::dvec4(x, y, z, w);
    };
    at_ = on_grid(place, 1);
    per_m_ = on_grid(ray, 0);
    const double length = glm::length(place) / at_.w;
    cell_m_ = radius_m * std::sqrt(frame.du * frame.dv) / (length * std::sqrt(length));
  }

  const glm::dvec4& at() const { return at_; }        // x, y, z, w
  const glm::dvec4& per_m() const { return per_m_; }  // their changes a metre
  // Returns the side of a cell where the ray begins, projected to the sphere.
  double cell_m() const { return cell_m_; }

 private:
  glm::dvec4 at_;
  glm::dvec4 per_m_;
  double cell_m_ = 0;
};

}  // namespace vpe::voxel
