// Voxels that hold points, and the means of their points.
//
// Typical usage:
//   const PointVoxels points(cloud, voxels);
//   for (std::uint32_t n = 0; n < points.size(); ++n) use(points.places()[n], points.colour(n));
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "objects/model/mesh.h"
#include "objects/sticks/voxel_grid.h"

namespace objects {

// Returns the voxel of a grid that holds a point, the nearest one of the grid for a point outside. Pure.
glm::ivec3 voxel_of_point(const StickGrid& grid, const glm::vec3& point_m);

// Immutable. Voxels are numbered in the order of their places. Sums are of whole numbers, so nothing that is told of a
// voxel depends on the order of points.
class PointVoxels {
 public:
  // `points` must pass check_points(), and lie in the grid.
  PointVoxels(const Mesh& points, const VoxelGrid& grid);

  std::uint32_t size() const { return static_cast<std::uint32_t>(sums_.size()); }
  const std::vector<std::uint64_t>& places() const { return places_; }  // VoxelGrid::place(), ascending
  // Returns the number of a place, which must be one of places().
  std::uint32_t number(std::uint64_t place) const {
    const std::uint64_t column = place / height_;
    const auto first = places_.begin() + first_[column];
    return static_cast<std::uint32_t>(std::lower_bound(first, places_.begin() + first_[column + 1], place) -
                                      places_.begin());
  }

  // Returns the mean of the points of a voxel, in voxels from the corner of the grid; exact to 1e-6.
  const glm::dvec3& middle(std::uint32_t number) const { return middles_[number]; }
  // Returns the mean colour, grey (160) without colours.
  Rgba colour(std::uint32_t number) const;
  // Returns the mean normal, or 0 if there is none or opposite ones cancel out.
  glm::vec3 normal(std::uint32_t number) const;
  Rgba mean_colour() const;  // of all points

 private:
  struct Sum {
    std::uint32_t points = 0;
    std::uint32_t normals = 0;
    std::array<std::uint64_t, 3> place{};  // within the voxel
    std::array<std::int64_t, 3> normal{};
    std::array<std::uint64_t, 3> colour{};
  };
  void add_points(const Mesh& points, const VoxelGrid& grid);
  Rgba colour_of(const Sum& sum) const;

  bool has_colours_ = false;
  std::uint64_t height_ = 1;
  std::vector<std::uint64_t> places_;
  std::vector<std::uint32_t> first_;  // number of each column, and behind the last one
  std::vector<Sum> sums_;
  std::vector<glm::dvec3> middles_;
};

}  // namespace objects
