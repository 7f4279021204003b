// The facets of the reference surface within a polygon: whole ones, and those that its outline cuts.
//
// Seen from the planet's centre, edges of the polygon, grid lines and diagonals of cells are all great circles,
// so they are straight in the chart of a cube face. The polygon is cut along the borders of faces, the middle
// lines of tiles and blocks, and the diagonals, until each piece lies on one facet.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <stop_token>
#include <vector>

#include "paging/surface/surface.h"

namespace vpe::explore {

// Handles the pieces of a walk.
class FacetVisitor {
 public:
  virtual ~FacetVisitor() = default;
  // Handles all facets of a block of cells: columns [i0, i1), rows [j0, j1). `winding` is how often the polygon
  // winds about them, counterclockwise positive.
  virtual void block(const paging::SurfaceTile& tile, int i0, int i1, int j0, int j1, int winding) = 0;
  // Handles the part of one facet, as a polygon in space in the facet's plane, metres from the planet's centre,
  // in the polygon's orientation. Its outline may run along itself where the part is in several pieces.
  virtual void part(const paging::SurfaceTile& tile, int i, int j, std::span<const glm::dvec3> piece_m) = 0;
};

// Visits the facets within a polygon of unit directions that lies in an open half of the sphere. Tiles of
// `level` stand for finer ones. Reads tiles; throws paging::PlanetError. Returns false as soon as it was asked
// to stop.
bool walk_facets(const paging::Surface& surface, std::span<const glm::dvec3> polygon, int level,
                 FacetVisitor& visitor, const std::stop_token& stop);
// Visits all facets of the planet, with winding 1.
bool walk_all_facets(const paging::Surface& surface, int level, FacetVisitor& visitor,
                     const std::stop_token& stop);

// Returns about how many cells walk_facets() visits, from the tree alone; any larger number once it exceeds
// `most`.
double count_cells(const paging::PlanetFile& planet, std::span<const glm::dvec3> polygon, int level,
                   double most);

}  // namespace vpe::explore
