// The planets of `vpe report scaling`: built while their builder is measured, and removed at the end.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "vpe/app/planet/fractal_terrain.h"
#include "vpe/report/law.h"
#include "vpe/report/table.h"

namespace vpe::app {

// Return a grid of 10 m posts whose patch grows with side_posts, and a grid over one patch of 42 km whose posts
// get finer. side_posts is 2^n + 1 with n from 8 to 14. Both are the same planet at 4097 posts.
PatchSpec grid_patch(int side_posts);
PatchSpec depth_patch(int side_posts);
// Returns true for a valid side_posts.
bool is_side(int posts);

// Builds planets and keeps them until the end. Use it from one thread at a time.
class ScalingPlanets {
 public:
  // Makes the folder; the destructor removes it with its content.
  ScalingPlanets(std::filesystem::path folder, int threads);
  ~ScalingPlanets();
  ScalingPlanets(const ScalingPlanets&) = delete;
  ScalingPlanets& operator=(const ScalingPlanets&) = delete;

  // Builds the planets that do not exist yet, small ones `rounds` times. Calls `step` with the fraction of the
  // work that is done; it may throw to stop.
  void build(const std::vector<PatchSpec>& specs, int rounds, const std::function<void(double)>& step);

  std::shared_ptr<const paging::PlanetFile> planet(const PatchSpec& spec) const;

  // Returns a row for each planet.
  report::Table table() const;
  // Returns the laws of the builder over all planets: processor time, bytes and cells.
  std::vector<report::Law> laws() const;

 private:
  struct Built {
    PatchSpec spec;
    PatchBuild build;  // of the last round
    std::vector<double> processor_s;
    std::vector<double> wall_s;
  };
  using Name = std::pair<int, int>;  // levels of patch and of finest tiles
  static Name name(const PatchSpec& spec) { return {spec.patch.level, spec.levels_below}; }

  std::filesystem::path folder_;
  int threads_;
  std::map<Name, Built> built_;
};

}  // namespace vpe::app
