// Edges of facets that one column crosses, read by the parts of the column kernel.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "tests/bench/figures/ray_figures.h"
#include "vpe/voxel/cast/column_walk.h"

namespace bench {

// Describes the crossing of a column with an edge.
struct EdgeCrossing {
  double distance_m = 0;                                             // horizontal
  double slope = 0;                                                  // z / sigma
  vpe::voxel::LineFamily family = vpe::voxel::LineFamily::kColumns;  // the edge lies on one of its lines
  bool walked = false;  // by line of the family that the kernel walks; else the one edge between two lines
  glm::dvec2 in_grid{0, 0};
  lod::TileKey tile;
};

// Returns the crossings of a column with the finest tiles, from near to far. Each tile must be one height grid
// (level 5 and finer). Throws std::runtime_error otherwise.
std::vector<EdgeCrossing> edges_of_column(const Scene& scene, const vpe::voxel::ColumnCamera& camera,
                                          const glm::dvec3& azimuth, double reach_m);

}  // namespace bench
