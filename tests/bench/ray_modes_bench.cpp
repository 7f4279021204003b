// Compares modes of the ray backend: the gain of coherence (columns against single rays down the same pyramids
// and against fixed steps), the gain of coarser cells and of rings of lines, and the cost of roll, pitch and a larger grid.
// docs/measurements/rays.md has the figures.
//
//   ray_modes_bench DIR [ROUNDS] [NAME]
//
// DIR holds the planets of ray_bench, or receives them. With NAME, only rows whose name holds it are measured. Rows of rings and
// of nearest samples are processor time of one thread.
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>

#include "mars/geodesy/pose.h"
#include "tests/bench/compare_rounds.h"
#include "tests/bench/ray_bench_scenes.h"
#include "vpe/base/parallel.h"
#include "vpe/voxel/cast/range_caster.h"

namespace {

using vpe::core::View;
using vpe::voxel::RangeCaster;
using vpe::voxel::RangeOptions;

const RangeOptions kExact{};
const RangeOptions kMultires{1, 1};
const RangeOptions kSingleRays{1, 0, RangeOptions::Method::kSingleRays};
const RangeOptions kReference{1, 0, RangeOptions::Method::kReference};

RangeOptions volumes(double near_m) {
  RangeOptions options{1, 0, RangeOptions::Method::kVolume};
  options.volume.near_m = near_m;
  return options;
}

struct Scene {
  bench::RayScene scene;
  RangeCaster caster;
  explicit Scene(bench::RayScene s) : scene(s), caster(s.planet, std::size_t{3} << 30) {}

  View view(int width, int height, double fov_deg, double pitch_deg, double roll_deg) const {
    View v;
    v.width = width;
    v.height = height;
    v.fov_deg = fov_deg;
    const double radius = caster.surface().planet_radius_m();
    const mars::LonLat place = mars::lon_lat(scene.middle);
    const double ground = caster.surface().at(scene.middle).height_m;
    v.camera =
        mars::to_camera({place.lon_deg, place.lat_deg, ground + 1000, 22.5, pitch_deg, roll_deg}, radius);
    return v;
  }
};

struct Run {
  Scene* scene;
  View view;
  RangeOptions options;
};

std::string wanted;  // part of the names of rows to measure

// Compares two casts (compare_rounds.h). Each allocates its image, as its peer does.
void compare(const char* name, const Run& a, const Run& b, int rounds, vpe::base::ThreadPool& pool,
             bench::Clock clock = bench::Clock::kWall) {
  if (std::string(name).find(wanted) == std::string::npos) return;
  const auto cast = [&pool](const Run& run) {
    return [&run, &pool] {
      std::vector<float> out(static_cast<std::size_t>(run.view.width) *
                             static_cast<std::size_t>(run.view.height));
      run.scene->caster.cast(run.view, run.options, pool, out);
    };
  };
  bench::compare_rounds(name, cast(a), cast(b), rounds, clock);
}

// Compares one set of lines on each side of the vertical's vanishing point with rings of them.
void compare_rings(Scene& scene, int rounds) {
  vpe::base::ThreadPool alone(1);
  for (const bool is_nearest : {false, true}) {
    for (const double pitch : {-10.0, -30.0, -60.0, -90.0}) {
      for (const double roll : {0.0, 45.0}) {
        RangeOptions rings = kExact;
        rings.sectors.is_nearest = is_nearest;
        RangeOptions one = rings;
        one.sectors.most_rings = 1;
        const View view = scene.view(1920, 1080, 36, pitch, roll);
        const std::string name = "1920x1080, " + std::string(is_nearest ? "nearest" : "exact") + ", " +
                                 std::to_string(static_cast<int>(pitch)) + ", roll " +
                                 std::to_string(static_cast<int>(roll)) + ": rings; one";
        compare(name.c_str(), {&scene, view, rings}, {&scene, view, one}, rounds, alone,
                bench::Clock::kProcessor);
      }
    }
  }
}

// Compares nearest samples with the rays of pixels.
void compare_nearest(Scene& scene, int rounds) {
  vpe::base::ThreadPool alone(1);
  RangeOptions nearest = kExact;
  nearest.sectors.is_nearest = true;
  for (const double pitch : {-0.5, -10.0, -30.0, -60.0, -90.0}) {
    const View view = scene.view(1920, 1080, 36, pitch, 0);
    char name[80];
    std::snprintf(name, sizeof name, "1920x1080, pitch %g: pixel; nearest", pitch);
    compare(name, {&scene, view, kExact}, {&scene, view, nearest}, rounds, alone, bench::Clock::kProcessor);
  }
}

void run(const std::string& dir, int rounds) {
  vpe::base::ThreadPool pool(2);
  std::map<std::string, Scene> scenes;
  for (const bench::PatchSpec& spec : bench::patch_specs()) {
    if (spec.name != "513") scenes.try_emplace(spec.name, bench::patch_scene(spec, dir, 2));
  }
  Scene& small = scenes.at("2049");
  Scene& large = scenes.at("8193");
  const View wan = small.view(500, 400, 60, -30, 0);
  const View p10 = small.view(1920, 1080, 36, -10, 0);
  const View p10_large = large.view(1920, 1080, 36, -10, 0);
  View pano = small.view(6000, 2000, 60, 0, 0);
  pano.projection = vpe::core::Projection::kCylinder;
  View pano_large = large.view(6000, 2000, 60, 0, 0);
  pano_large.projection = vpe::core::Projection::kCylinder;

  std::printf("| view, 2 threads | ms | ratio of times (lowest..highest) |\n|---|---|---|\n");
  compare("wan 2049: exact; single rays", {&small, wan, kExact}, {&small, wan, kSingleRays}, rounds, pool);
  compare("p10 2049: exact; single rays", {&small, p10, kExact}, {&small, p10, kSingleRays}, rounds, pool);
  compare("pano 2049: exact; single rays", {&small, pano, kExact}, {&small, pano, kSingleRays}, rounds, pool);
  compare("wan 2049: exact; reference", {&small, wan, kExact}, {&small, wan, kReference}, 3, pool);
  const RangeOptions volume = volumes(std::numeric_limits<double>::infinity());
  compare("wan 2049: exact; volume", {&small, wan, kExact}, {&small, wan, volume}, rounds, pool);
  compare("wan 2049: volume; boundary", {&small, wan, volume}, {&small, wan, volumes(0)}, rounds, pool);
  compare("wan 2049: volume; reference", {&small, wan, volume}, {&small, wan, kReference}, 3, pool);
  compare("p10 2049: exact; volume", {&small, p10, kExact}, {&small, p10, volume}, rounds, pool);
  compare("p10 2049: multires; exact", {&small, p10, kMultires}, {&small, p10, kExact}, rounds, pool);
  compare("p10 8193: multires; exact", {&large, p10_large, kMultires}, {&large, p10_large, kExact}, rounds,
          pool);
  compare("pano 8193: multires; exact", {&large, pano_large, kMultires}, {&large, pano_large, kExact}, rounds,
          pool);
  compare("p10 multires: 2049; 8193", {&small, p10, kMultires}, {&large, p10_large, kMultires}, rounds, pool);
  compare("pano multires: 2049; 8193", {&small, pano, kMultires}, {&large, pano_large, kMultires}, rounds,
          pool);
  for (const RangeOptions& options : {kExact, kMultires}) {
    const char* name = options.cell_px == 0 ? "exact" : "multires";
    for (double roll : {-15.0, -45.0, -90.0}) {
      const std::string what =
          "800x800, pitch -40, " + std::string(name) + ": roll 0; " + std::to_string(static_cast<int>(roll));
      compare(what.c_str(), {&small, small.view(800, 800, 40, -40, 0), options},
              {&small, small.view(800, 800, 40, -40, roll), options}, rounds, pool);
    }
    for (double pitch : {-15.0, -30.0, -45.0, -60.0, -75.0, -90.0}) {
      const std::string what =
          "1920x1080, " + std::string(name) + ": pitch 0; " + std::to_string(static_cast<int>(pitch));
      compare(what.c_str(), {&small, small.view(1920, 1080, 36, 0, 0), options},
              {&small, small.view(1920, 1080, 36, pitch, 0), options}, rounds, pool);
    }
  }
  compare_nearest(small, rounds);
  compare_rings(small, rounds);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "ray_modes_bench DIR [ROUNDS] [NAME]\n");
    return 2;
  }
  try {
    if (argc > 3) wanted = argv[3];
    run(argv[1], argc > 2 ? std::max(1, std::atoi(argv[2])) : 9);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ray_modes_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
