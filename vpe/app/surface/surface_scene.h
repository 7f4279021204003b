// A surface file, read and put together.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>

#include "relief/field/surface.h"

namespace vpe::app {

// Immutable but for being moved; any number of threads may read it.
struct SurfaceScene {
  relief::Surface surface;
  bool is_round = true;          // a sphere or an ellipsoid, with its centre at (0, 0, 0)
  glm::dvec3 middle_m{0, 0, 0};  // of a ball that holds the ground
  double radius_m = 0;           // of that ball
  double facet_deviation_m = 0;  // bounds how far the maps lie from flat facets through their posts
  std::size_t posts = 0;         // of all maps
  std::size_t reliefs = 0;
};

// Reads a surface file, its maps and its reliefs. Throws what reading them throws, and std::runtime_error for a quadric
// without ground over its area, as seen against z.
SurfaceScene open_surface(const std::filesystem::path& path);

}  // namespace vpe::app
