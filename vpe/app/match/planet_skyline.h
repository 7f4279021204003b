// Skylines of a planet for many places, from a height above its ground.
#pragma once

#include <memory>

#include "mars/geodesy/pose.h"
#include "paging/planet/planet_file.h"
#include "paging/surface/surface.h"
#include "panorama/match/place_search.h"
#include "vpe/base/parallel.h"

namespace vpe::app {

// Computes skylines about a place. One thread at a time; the casts take all threads of the pool.
class PlanetSkyline {
 public:
  // height_m: of the camera above the ground. The surface and the pool must live as long. Throws
  // std::invalid_argument for a height below a millimetre.
  PlanetSkyline(const paging::Surface& surface, mars::LonLat middle, double height_m, base::ThreadPool& pool);

  // Returns the place at an offset, metres to the east and north, along great circles on the sphere.
  mars::LonLat place(const glm::dvec2& offset_m) const;
  // Returns the pose of a level camera there, looking north.
  mars::Pose pose(const glm::dvec2& offset_m) const;
  // Returns the skyline there (panorama::ProfileAt). Throws what the surface throws, and Interrupted.
  panorama::SkylineProfile profile(const glm::dvec2& offset_m, double step_deg) const;

 private:
  const paging::Surface& surface_;
  mars::LonLat middle_;
  double height_m_;
  base::ThreadPool& pool_;
};

}  // namespace vpe::app
