// The ground of a planet at the posts of tiles that it need not have.
//
// Typical usage:
//   const PlanetGround ground(planet, 64 << 20);
//   const auto grid = ground.grid(key);
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "paging/planet/planet_file.h"
#include "paging/surface/surface.h"

namespace paging {

// Holds the reference surface at the posts of a tile's grid, row by row.
struct GroundGrid {
  lod::GridLines lines;
  std::vector<glm::dvec3> directions;
  std::vector<double> height_m;  // that of the planet's fill at nodata
  std::vector<bool> nodata;      // empty: all have data
  std::vector<int> source;       // in PlanetMeta::sources, -1 at nodata; empty: 0 everywhere

  std::size_t bytes() const;
};

// The value at a place is a function of its direction alone, so that all grids with a post there agree on it. Any thread
// may call its members. They throw PlanetError.
class PlanetGround {
 public:
  // Keeps at most about `budget_bytes`. Smaller: tiles are read and sampled again more often.
  PlanetGround(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes);

  const PlanetFile& planet() const { return surface_.planet(); }

  // Returns the height in a unit direction in metres above the planet's datum, NaN for nodata.
  double height_m(const glm::dvec3& direction) const;

  // Returns the grid of a tile, which the planet may have, or have coarser or finer tiles in its place.
  std::shared_ptr<const GroundGrid> grid(const lod::TileKey& key) const;

 private:
  GroundGrid sample(const lod::TileKey& key) const;

  Surface surface_;
  mutable vpe::base::LruCache<lod::TileKey, GroundGrid, lod::TileKeyHash> grids_;
};

}  // namespace paging
