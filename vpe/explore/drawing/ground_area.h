// The area of the reference surface within a polygon: that of its facets, cut by the outline.
//
// Typical usage:
//   const auto area = ground_area(surface, directions_of(places), {}, stop);
//   if (area) show(area->area_m2);
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <stop_token>

#include "paging/surface/surface.h"

namespace vpe::explore {

struct GroundAreaOptions {
  // Most cells (of two facets) that are read. Smaller: faster; large polygons are measured on coarser posts.
  // About 20 million cells take a second on one core, and reading them as long again.
  double most_cells = 2e7;
  // Called now and then with the share that is done, 0 to 1, on the calling thread. May be empty.
  std::function<void(double share)> progress;
};

struct GroundArea {
  double area_m2 = 0;
  // False where the polygon has more than most_cells cells. Then area_m2 is that of coarser tiles' own posts,
  // and coarser_area_m2 that of posts twice as far apart. Rough ground has more area on finer posts: their
  // difference tells how much about the next finer posts would add, and is no bound.
  bool is_exact = true;
  double spacing_m = 0;  // of the finest posts that were used
  double coarser_area_m2 = 0;
  bool has_nodata = false;  // in part of it no source has data; the surface is drawn there nevertheless
};

// Computes the area of S within a closed outline of unit directions that does not cross itself; the inside is
// the smaller side. If is_exact, the error is that of rounding: at most 1e-8 m / spacing_m of the area. Returns
// nullopt if it was asked to stop. Throws paging::PlanetError. Any thread may call it.
std::optional<GroundArea> ground_area(const paging::Surface& surface, std::span<const glm::dvec3> polygon,
                                      const GroundAreaOptions& options = {}, const std::stop_token& stop = {});

}  // namespace vpe::explore
