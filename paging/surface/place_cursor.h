// Answers at many places of a planet, neighbours after each other.
#pragma once

#include <memory>
#include <optional>

#include "lod/tree/facet.h"
#include "mars/geodesy/cube.h"
#include "paging/surface/surface.h"

namespace paging {

// Keeps the tile of the last place, so that the next one in it costs no look-up. Values are those of Surface::at() and
// query(), to the bit. One thread uses it at a time; the surface must outlive it.
//
// Typical usage:
//   PlaceCursor cursor(surface);
//   for (const glm::dvec3& direction : row) heights_m.push_back(cursor.move_to(direction).height_m);
class PlaceCursor {
 public:
  explicit PlaceCursor(const Surface& surface) : surface_(surface) {}

  // Goes to a direction of any length but 0. Returns the point of the surface there. Throws PlanetError.
  const SurfacePoint& move_to(const glm::dvec3& direction);

  // Goes to a unit direction that is known within `error_rad`, at most 1e-6. Returns the point there, or null where another
  // direction within the error could be on another facet or have another nearest post: then the cursor is at no place.
  // Throws PlanetError.
  const SurfacePoint* move_near(const glm::dvec3& direction, double error_rad);

  // Returns the sources of the tile of the last place. Throws PlanetError.
  const TileSources& sources();

  // Returns the source of the nearest post, as PlaceAnswer::source. Throws PlanetError.
  std::optional<int> source();

  // Holds what is known of the error against a source's own posts.
  struct Resampling {
    ResamplingError error;  // posts = 0: it is not known
    bool of_level = false;  // of all finest tiles of the level, since the tile has none of the source's posts
  };
  // Returns PlaceAnswer::resampling of a source at the last place. Throws PlanetError.
  Resampling resampling(int source);

 private:
  bool is_on_facet() const;
  void find_facet();
  void find_point();

  const Surface& surface_;
  mars::ChartPoint chart_;
  SurfacePoint point_;
  std::shared_ptr<const SurfaceTile> tile_;
  std::optional<lod::Facet> facet_;  // of tile_
  std::shared_ptr<const TileSources> sources_;
  // The last answer of resampling(), in tile_.
  std::optional<int> resampled_source_;
  Resampling resampling_;
};

}  // namespace paging
