// Changes of a planet's ground from which patches are made in memory.
//
// Typical usage:
//   const auto change = mixed_ground(mars::open_elevation("strip.tif"), 0.5);
//   const MadePatch made = PatchMaker(planet).make(*change);
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "mars/sources/source.h"

namespace paging {

// Says how ground differs from that of a planet. All members are pure: the value at a place does not depend on the
// batch or the thread. Any number of threads may call them at once.
class GroundChange {
 public:
  virtual ~GroundChange() = default;

  // Returns one info for each source that the change adds to those of the planet.
  virtual std::vector<mars::SourceInfo> infos() const = 0;

  // Returns true if the ground of a cap may differ. It may say so of a cap in which nothing differs, never the reverse.
  virtual bool touches(const mars::Cap& cap) const = 0;

  // Returns the least distance of posts that the change wants in a cap, in metres; infinity if it wants none.
  virtual double spacing_in(const mars::Cap& cap) const = 0;

  // Turns the planet's heights at unit directions, in metres above its datum and NaN for nodata, into those of the
  // changed ground for posts that are spacing_m apart. Sets decided_by[i] to n where infos()[n] decides, to -1 where
  // what was there does. Sizes must be equal. Throws mars::SourceError.
  virtual void change(std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m,
                      std::span<int> decided_by) const = 0;
};

// Returns the change to ground between that of the planet and that of a source, whose heights must have the planet's
// datum: h + share * (source - h) where the source has data. A share of 0 changes nothing, 1 is the source. Where only the
// source has data the ground is its own from a share of 1/2 on, else nodata. Throws std::invalid_argument for a share that
// is not 0 to 1, and for no source.
std::shared_ptr<const GroundChange> mixed_ground(std::shared_ptr<const mars::ElevationSource> source,
                                                 double share);

}  // namespace paging
