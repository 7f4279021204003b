// Estimates what a build will take, before it starts.
#pragma once

#include "paging/build/builder.h"

namespace paging {

struct BuildEstimate {
  std::int64_t leaf_tiles = 0;   // exact, from the plan
  std::int64_t inner_tiles = 0;  // exact
  std::int64_t image_tiles = 0;  // exact
  std::int64_t layer_tiles = 0;  // exact, of all image layers
  std::int64_t posts = 0;
  std::int64_t bytes = 0;         // of the finished file
  double processor_s = 0;         // of all threads together
  double wall_s = 0;              // when the threads have a core each
  std::int64_t memory_bytes = 0;  // that the tile index takes while it is built, caches not included
  double coarsest_spacing_m = 0;  // of the finest posts anywhere
  // Largest distance of the flat facets there below the sphere through their posts. Stated errors of tiles do not
  // include it: they are measured from these facets.
  double largest_sagitta_m = 0;
};

// Estimates a build from its plan and from rates measured on one machine (docs/measurements/scaling.md).
// Numbers of tiles are exact. Bytes are within a factor of two on terrain, less on plains. Time is as good as
// this machine resembles that one, and leaves out slow disks and networks. Covers options.shard alone where
// the build is divided. `plan` is what plan_tiles() returned. Reads no more of the sources than their
// footprints. Throws PlanetError when the planet has fewer finest tiles than shards.
BuildEstimate estimate_build(const BuildOptions& options, const BuildPlan& plan,
                             const mars::ElevationSource& elevation, const mars::ImageSource* image);

}  // namespace paging
