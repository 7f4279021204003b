// Makes patches of a planet in memory: the tiles that differ when its ground changes.
//
// Typical usage:
//   const PatchMaker maker(planet);
//   const MadePatch made = maker.make(*change);
//   if (made.patch) change_planet(*renderer, planet->with(made.patch));
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "paging/live/ground_change.h"
#include "paging/planet/planet_file.h"
#include "paging/planet/tile_patch.h"

namespace paging {

// The defaults suit a change that is seen for long. An animated one takes full_grids.
struct PatchOptions {
  // Finest tiles have no mesh but their full grid, and inner tiles take the planet's meshes with new heights; errors are
  // bounds instead of measurements. Much quicker to make. Rays lose nothing; triangles draw more of them near the
  // change. False: meshes and errors are those that the builder would make.
  bool full_grids = false;
  // Has the meaning of BuildOptions::mesh_ratio. Larger: more triangles and smaller errors.
  double mesh_ratio = 256;
  // Finest distance of posts in metres; 0: what the change asks for. Larger: quicker and coarser.
  double finest_spacing_m = 0;
  // Bounds the number of finest tiles in a patch. Posts are twice as far apart, and again, until it holds. Smaller: less
  // memory and time for changes that ask for much.
  std::size_t most_finest_tiles = 2048;
  int threads = 0;  // 0: all cores
};

struct MadePatch {
  std::shared_ptr<const TilePatch> patch;  // null: the ground does not change
  double spacing_m = 0;                    // of the finest posts of the patch
  bool is_coarser = false;                 // posts are farther apart than wanted, for most_finest_tiles
  std::int64_t finest_tiles = 0;
  std::int64_t tiles = 0;
};

// Makes patches of one planet, one after the other, as an animation does: what a patch reads of the planet is kept for
// the next one. The ground below the change is the planet's own surface, so that no rasters are needed. Any number of
// threads may call make() at once.
//
// The result, for one planet, change and options, does not depend on the number of threads nor on earlier calls:
//   - A post has the height of the changed surface at its direction, rounded to the planet's step of heights. A build from
//     the planet's sources rounds once and not twice, so posts of the planet's spacing differ by one step at most. Finer
//     posts lie on the planet's flat facets, changed.
//   - Where there is no data the height is the planet's, which no place shows.
//   - Errors that tiles state are bounds, with either kind of meshes. Borders meet as those of built tiles do.
class PatchMaker {
 public:
  // Keeps at most about `budget_bytes` of the planet's ground. Smaller: it is sampled again more often.
  explicit PatchMaker(std::shared_ptr<const PlanetFile> planet,
                      std::size_t budget_bytes = std::size_t{256} << 20);
  ~PatchMaker();
  PatchMaker(PatchMaker&&) noexcept;
  PatchMaker& operator=(PatchMaker&&) noexcept;

  const std::shared_ptr<const PlanetFile>& planet() const;

  // Returns the planet's height at a unit direction in metres above its datum, as posts of a patch take it; NaN for
  // nodata. Throws PlanetError.
  double ground_m(const glm::dvec3& direction) const;

  // Returns the patch that makes the planet's ground that of the change. Throws PlanetError when the change needs more
  // finest tiles than allowed even at the planet's own spacing, when a height cannot be stored, or when the planet
  // cannot be read; mars::SourceError; std::invalid_argument for options out of range.
  MadePatch make(const GroundChange& change, const PatchOptions& options = {}) const;

  // Returns what make() would, with a null `patch`, in a small part of the time: it finds the tiles and makes none. Throws
  // what make() throws, except for heights that cannot be stored.
  MadePatch plan(const GroundChange& change, const PatchOptions& options = {}) const;

 private:
  class Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace paging
