// Heights of the ground at many places, as exact as each of them asks for.
#pragma once

#include <memory>
#include <optional>

#include "lod/tree/facet.h"
#include "mars/geodesy/cube.h"
#include "paging/surface/surface.h"

namespace paging {

// Looks up heights in the coarsest tiles whose posts are as exact as is asked for, so that places far from a camera do not read
// the finest tiles. Heights do not depend on those that were asked for before. Neighbours after each other are fastest. One
// thread uses it at a time; the surface must outlive it.
//
// Typical usage:
//   HeightCursor cursor(surface);
//   const double height_m = cursor.height_m(direction, 0.1 * distance_m / focal_px);
class HeightCursor {
 public:
  explicit HeightCursor(const Surface& surface) : surface_(surface) {}

  // Returns the height of the ground above the sphere in a direction of any length but 0, within most_error_m of
  // Surface::at() by the errors that the planet file states of its tiles' posts. 0, and any in files that state none: that
  // height to the bit. Throws PlanetError.
  double height_m(const glm::dvec3& direction, double most_error_m);

 private:
  bool is_within(double most_error_m) const;
  void find_tile(const mars::ChartPoint& place, double most_error_m);

  const Surface& surface_;
  std::shared_ptr<const SurfaceTile> tile_;
  // Hold the errors of tile_ and of its parent: the tile serves all bounds between.
  double geometric_error_m_ = 0;
  double parent_error_m_ = 0;
  std::optional<lod::Facet> facet_;  // of tile_
};

}  // namespace paging
