#include "vpe/app/report/scaling_planets.h"

#include "vpe/app/cli/output.h"
#include "vpe/report/interleaved_timing.h"

namespace vpe::app {
namespace {

namespace fs = std::filesystem;

constexpr lod::TileKey kPlace{mars::Face::kPlusX, 7, 75, 52};
constexpr int kGridFinestLevel = 12;  // posts of 10 m
// Planets of fewer posts are built several times, as each build takes seconds.
constexpr double kFewPosts = 4e6;

int levels_below(int side_posts) {
  int levels = 0;
  while ((1 << (kPatchTileK + levels)) + 1 < side_posts) ++levels;
  return levels;
}

// Returns an estimate of a planet's posts, in the patch and the tiles around it, for the progress.
double estimated_posts(const PatchSpec& spec) {
  const double side = spec.side_posts();
  return side * side + 16641.0 * 9 * spec.finest_level();
}

}  // namespace

bool is_side(int posts) {
  for (int n = 8; n <= 14; ++n) {
    if (posts == (1 << n) + 1) return true;
  }
  return false;
}

PatchSpec depth_patch(int side_posts) { return {kPlace, levels_below(side_posts)}; }

PatchSpec grid_patch(int side_posts) {
  const int below = levels_below(side_posts);
  // The tile of the patch's level at the middle of the place.
  const mars::ChartRect rect = lod::chart_rect(kPlace);
  const mars::ChartPoint middle{kPlace.face, (rect.u0 + rect.u1) / 2, (rect.v0 + rect.v1) / 2};
  return {lod::tile_at(middle, kGridFinestLevel - below), below};
}

ScalingPlanets::ScalingPlanets(fs::path folder, int threads) : folder_(std::move(folder)), threads_(threads) {
  make_folder(folder_);
}

ScalingPlanets::~ScalingPlanets() {
  built_.clear();
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void ScalingPlanets::build(const std::vector<PatchSpec>& specs, int rounds,
                           const std::function<void(double)>& step) {
  struct PlannedBuild {
    PatchSpec spec;
    int round;
  };
  std::vector<PlannedBuild> builds;
  double all = 0;
  for (int round = 0; round < rounds; ++round) {
    for (const PatchSpec& spec : specs) {
      if (built_.contains(name(spec)) || (round > 0 && estimated_posts(spec) > kFewPosts)) continue;
      builds.push_back({spec, round});
      all += estimated_posts(spec);
    }
  }
  double done = 0;
  for (const auto& [spec, round] : builds) {
    const double part = estimated_posts(spec);
    const fs::path file = folder_ / ("patch-" + std::to_string(spec.patch.level) + "-" +
                                     std::to_string(spec.side_posts()) + ".vpe");
    if (round == 0 && built_.contains(name(spec))) continue;  // both series have it
    Built& built = built_[name(spec)];
    built.spec = spec;
    built.build.planet.reset();
    std::error_code ignored;
    fs::remove(file, ignored);
    built.build =
        build_patch(spec, file, threads_, [&](double fraction) { step((done + fraction * part) / all); });
    built.processor_s.push_back(built.build.processor_s);
    built.wall_s.push_back(built.build.wall_s);
    done += part;
  }
}

std::shared_ptr<const paging::PlanetFile> ScalingPlanets::planet(const PatchSpec& spec) const {
  return built_.at(name(spec)).build.planet;
}

report::Table ScalingPlanets::table() const {
  report::Table table{
      "scaling-planets",
      "The planets. Processor time is the builder's, without the time for the made-up terrain; wall time "
      "includes it.",
      {{"side_posts", "posts a side of the patch"},
       {"spacing_m", "between its posts"},
       {"patch_level", "level of the tile that the patch covers; 0 = a cube face"},
       {"finest_level", "finest level of the planet; 0 = a cube face"},
       {"finest_posts", "posts of all finest tiles, also outside the patch"},
       {"tiles", "tiles in the file"},
       {"bytes", "size of the file"},
       {"processor_s", "processor time of a build, median"},
       {"wall_s", "wall time of a build, median"},
       {"processor_us_per_post", "processor time a finest post, median"},
       {"rounds", "number of builds"}},
      {}};
  for (const auto& [key, built] : built_) {
    const double processor_s = report::median(built.processor_s);
    const auto posts = static_cast<double>(built.build.finest_posts);
    table.add({static_cast<double>(built.spec.side_posts()), built.spec.spacing_m(),
               static_cast<double>(built.spec.patch.level), static_cast<double>(built.spec.finest_level()),
               posts, static_cast<double>(built.build.planet->tree().size()),
               static_cast<double>(built.build.bytes), processor_s, report::median(built.wall_s),
               1e6 * processor_s / posts, static_cast<double>(built.processor_s.size())});
  }
  return table;
}

std::vector<report::Law> ScalingPlanets::laws() const {
  report::Law time{"builder", "processor time of a build", "finest posts", "processor_s", 0.95, 1.05, {}};
  report::Law bytes{"builder", "size of the file", "finest posts", "bytes", {}, {}, {}};
  report::Law cells{"builder", "cells of the patch", "cells a side", "cells", {}, {}, {}};
  for (const auto& [key, built] : built_) {
    const auto posts = static_cast<double>(built.build.finest_posts);
    time.samples.push_back({posts, built.processor_s});
    bytes.samples.push_back({posts, {static_cast<double>(built.build.bytes)}});
    cells.samples.push_back(
        {static_cast<double>(built.spec.side_posts() - 1), {static_cast<double>(built.build.patch_cells)}});
  }
  return {time, bytes, cells};
}

}  // namespace vpe::app
