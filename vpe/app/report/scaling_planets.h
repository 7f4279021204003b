// The planets of `vpe report scaling`: built while their builder is measured, and removed at the end.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "vpe/app/report/fractal_terrain.h"
#include "vpe/report/law.h"
#include "vpe/report/table.h"

namespace vpe::app {

// Grids of 10 m posts whose patch grows, and grids over one patch of 42 km whose posts get finer. `side_posts`
// is 2^n + 1 with n from 8 to 14. Both are the same planet at 4097 posts.
PatchSpec grid_patch(int side_posts);
PatchSpec depth_patch(int side_posts);
bool is_side(int posts);

// One thread.
class ScalingPlanets {
 public:
  // `folder` is made, and removed again with all that is in it.
  ScalingPlanets(std::filesystem::path folder, int threads);
  ~ScalingPlanets();
  ScalingPlanets(const ScalingPlanets&) = delete;
  ScalingPlanets& operator=(const ScalingPlanets&) = delete;

  // Builds those that are not there yet, small ones `rounds` times. `step` is called with the fraction of the
  // work that is done, and may throw.
  void build(const std::vector<PatchSpec>& specs, int rounds, const std::function<void(double)>& step);

  std::shared_ptr<const paging::PlanetFile> planet(const PatchSpec& spec) const;

  // A row a planet.
  report::Table table() const;
  // Of all planets: the builder's processor time, posts and bytes.
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
