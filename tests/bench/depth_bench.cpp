// Time of a frame against the depth of the planet, at a fixed view and tolerance. docs/measurements/paging.md
// has the figures.
//
//   depth_bench LON,LAT,ALT,YAW,PITCH,ROLL WIDTHxHEIGHT ROUNDS PLANET.vpe PLANET.vpe...
//
// The planets should differ in their finest spacing alone. Every planet has its own renderer, all tiles are
// resident, and each round draws every planet once. The exponent is the slope of the line through (doublings of
// resolution, log2 of the median time).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "lod/tree/tile_key.h"
#include "mars/geodesy/sun.h"
#include "paging/planet/planet_file.h"
#include "vpe/base/heap.h"
#include "vpe/base/number.h"
#include "vpe/base/quantile.h"
#include "vpe/gl/polygon_renderer.h"

namespace {

using Clock = std::chrono::steady_clock;
using vpe::base::median_upper;

struct Planet {
  std::string file;
  std::shared_ptr<const paging::PlanetFile> planet;
  std::unique_ptr<vpe::core::Renderer> renderer;
  double spacing_m = 0;
  vpe::core::FrameStats stats;
  std::vector<double> frame_ms;
  std::vector<double> select_ms;
};

double finest_spacing_m(const paging::PlanetFile& planet) {
  int level = 0;
  const lod::TileTree& tree = planet.tree();
  for (lod::TileTree::Index n = 0; n < static_cast<lod::TileTree::Index>(tree.size()); ++n) {
    level = std::max(level, static_cast<int>(tree[n].key.level));
  }
  return lod::nominal_side_m(level, planet.radius_m()) / planet.meta().tile.intervals();
}

void run(const mars::Pose& pose, int width, int height, int rounds, char** files, int count) {
  vpe::base::keep_heap_compact();  // as `vpe` does
  const std::shared_ptr<vpe::gl::Context> context = vpe::gl::Context::create();
  std::printf("%s, %dx%d\n\n", context->info().renderer.c_str(), width, height);
  std::vector<Planet> planets;
  for (int n = 0; n < count; ++n) {
    Planet& p = planets.emplace_back();
    p.file = files[n];
    p.planet = paging::PlanetFile::open(files[n]);
    p.renderer = vpe::gl::make_polygon_renderer(context, p.planet, {std::size_t{1} << 30, 0, {}});
    p.spacing_m = finest_spacing_m(*p.planet);
  }
  vpe::core::DrawRequest request;
  request.view.camera = mars::to_camera(pose, planets[0].planet->radius_m());
  request.view.width = width;
  request.view.height = height;
  request.sun = mars::sun_direction({pose.lon_deg, pose.lat_deg}, 315, 35);
  for (int round = -1; round < rounds; ++round) {
    for (Planet& p : planets) {
      const auto start = Clock::now();
      p.stats = p.renderer->draw(request).stats;
      if (round < 0) continue;  // loads
      p.frame_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
      p.select_ms.push_back(p.stats.select_ms);
    }
  }
  std::printf(
      "| finest spacing m | tiles in the file | tiles drawn | triangles | in sight | select ms | frame ms |\n"
      "|---|---|---|---|---|---|---|\n");
  double x_mean = 0, y_mean = 0, xx = 0, xy = 0;
  for (Planet& p : planets) {
    std::printf("| %.1f | %zu | %d | %lld | %lld | %.3f | %.2f |\n", p.spacing_m,
                static_cast<std::size_t>(p.planet->tree().size()), p.stats.tiles_drawn,
                static_cast<long long>(p.stats.triangles), static_cast<long long>(p.stats.triangles_in_sight),
                median_upper(p.select_ms), median_upper(p.frame_ms));
    x_mean -= std::log2(p.spacing_m) / count;
    y_mean += std::log2(median_upper(p.frame_ms)) / count;
  }
  for (Planet& p : planets) {
    const double x = -std::log2(p.spacing_m) - x_mean;
    xx += x * x;
    xy += x * (std::log2(median_upper(p.frame_ms)) - y_mean);
  }
  std::printf("\ntime grows with resolution to the power %.3f (aim at most 0.1)\n", xy / xx);
}

}  // namespace

int main(int argc, char** argv) {
  mars::Pose pose;
  int width = 0, height = 0;
  char rest = 0;
  const auto rounds = argc > 3 ? vpe::base::parse_integer(argv[3]) : std::nullopt;
  if (argc < 6 ||
      std::sscanf(argv[1], "%lf,%lf,%lf,%lf,%lf,%lf%c", &pose.lon_deg, &pose.lat_deg, &pose.alt_m,
                  &pose.yaw_deg, &pose.pitch_deg, &pose.roll_deg, &rest) != 6 ||
      std::sscanf(argv[2], "%dx%d%c", &width, &height, &rest) != 2 || !rounds || *rounds < 1) {
    std::fprintf(
        stderr, "usage: depth_bench LON,LAT,ALT,YAW,PITCH,ROLL WIDTHxHEIGHT ROUNDS PLANET.vpe PLANET.vpe...\n");
    return 2;
  }
  try {
    run(pose, width, height, static_cast<int>(*rounds), argv + 4, argc - 4);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "depth_bench: %s\n", e.what());
    return 1;
  }
  return 0;
}
