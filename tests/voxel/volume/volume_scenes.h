// Made-up terrain volumes, and views of them.
#pragma once

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/core/view.h"
#include "vpe/voxel/volume/terrain_volume.h"

namespace vpe::voxel::volume_scenes {

inline VolumeHeights heights_of(int columns, int rows,
                                const std::function<double(double x, double y)>& height) {
  VolumeHeights grid{columns, rows, {}};
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) grid.heights.push_back(static_cast<float>(height(i, j)));
  return grid;
}

// Hills of several sizes between about 6 and 40 voxels.
inline double hill(double x, double y) {
  return 22 + 9 * std::sin(x / 11) * std::cos(y / 13) + 5 * std::sin((x + 2 * y) / 7) +
         2 * std::cos((3 * x - y) / 4.1);
}

inline VolumeHeights hills(int side) { return heights_of(side, side, hill); }

// Returns a view in voxels: yaw from +y towards +x, pitch up, and roll clockwise, degrees.
inline core::View view_from(const glm::dvec3& eye, double yaw_deg, double pitch_deg, double roll_deg, int width,
                            int height, double fov_deg) {
  constexpr double kRad = 3.14159265358979323846 / 180;
  const double yaw = yaw_deg * kRad;
  const double pitch = pitch_deg * kRad;
  const double roll = roll_deg * kRad;
  const glm::dvec3 forward{std::cos(pitch) * std::sin(yaw), std::cos(pitch) * std::cos(yaw), std::sin(pitch)};
  const glm::dvec3 right{std::cos(yaw), -std::sin(yaw), 0};
  const glm::dvec3 up = glm::cross(right, forward);
  core::View view;
  view.camera.position_m = eye;
  view.camera.axes = {std::cos(roll) * right - std::sin(roll) * up,
                      std::sin(roll) * right + std::cos(roll) * up, forward};
  view.width = width;
  view.height = height;
  view.fov_deg = fov_deg;
  return view;
}

// Returns the first point of a ray in the ground of a volume, by steps of `step` with the trilinear density alone.
inline double brute_range(const TerrainVolume& volume, const glm::dvec3& origin, const glm::dvec3& direction,
                          double step) {
  const glm::dvec3 last{volume.columns() - 1.0, volume.rows() - 1.0, volume.levels() - 1.0};
  for (double t = 0; t < 2000; t += step) {
    const glm::dvec3 p = origin + t * direction;
    bool is_inside = true;
    for (int axis = 0; axis < 3; ++axis) is_inside = is_inside && p[axis] >= 0 && p[axis] <= last[axis];
    if (is_inside && volume.density(p) > volume.threshold() + 0.5) return t;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace vpe::voxel::volume_scenes
