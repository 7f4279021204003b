// Time of a frame against the depth of the planet, at a fixed view and tolerance. docs/measurements/paging.md
// has the figures.
//
//   depth_bench LON,LAT,ALT,YAW,PITCH,ROLL WIDTHxHEIGHT ROUNDS PLANET.vpe PLANET.vpe...
//   depth_bench LON,LAT,ALT,around WIDTHxHEIGHT ROUNDS PLANET.vpe PLANET.vpe...
//
// The planets should differ in their finest spacing alone. Every planet has its own renderer, all tiles are
// resident, and each round draws every planet once. The exponent is the slope of the line through (doublings of
// resolution, log2 of the median time); planets of one spacing have none. "around" draws 24 views, with 6 pitches from
// -90 to -10 degrees and 4 headings: triangles are then means over the views, and the most in one view stands beside
// them.
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

// Sums up the triangles of views.
struct Triangles {
  double views = 0, drawn = 0, in_sight = 0;
  long long most_drawn = 0, most_in_sight = 0;

  void add(const vpe::core::FrameStats& stats) {
    const auto all = static_cast<long long>(stats.triangles);
    const auto seen = static_cast<long long>(stats.triangles_in_sight);
    views += 1;
    drawn += static_cast<double>(all);
    in_sight += static_cast<double>(seen);
    most_drawn = std::max(most_drawn, all);
    most_in_sight = std::max(most_in_sight, seen);
  }
};

struct Planet {
  std::string file;
  std::shared_ptr<const paging::PlanetFile> planet;
  std::unique_ptr<vpe::core::Renderer> renderer;
  double spacing_m = 0;
  int tiles_drawn = 0;  // in the last view
  Triangles triangles;
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

std::vector<mars::Pose> poses_around(const mars::Pose& place) {
  std::vector<mars::Pose> poses;
  for (const double pitch_deg : {-90.0, -60.0, -45.0, -30.0, -20.0, -10.0}) {
    for (const double yaw_deg : {0.0, 90.0, 180.0, 270.0})
      poses.push_back({place.lon_deg, place.lat_deg, place.alt_m, yaw_deg, pitch_deg, 0});
  }
  return poses;
}

void run(const std::vector<mars::Pose>& poses, int width, int height, int rounds, char** files, int count) {
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
  for (const mars::Pose& pose : poses) {
    vpe::core::DrawRequest request;
    request.view.camera = mars::to_camera(pose, planets[0].planet->radius_m());
    request.view.width = width;
    request.view.height = height;
    request.sun = mars::sun_direction({pose.lon_deg, pose.lat_deg}, 315, 35);
    for (int round = -1; round < rounds; ++round) {
      for (Planet& p : planets) {
        const auto start = Clock::now();
        const vpe::core::FrameStats stats = p.renderer->draw(request).stats;
        if (round < 0) continue;  // loads
        p.frame_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
        p.select_ms.push_back(stats.select_ms);
        if (round > 0) continue;
        p.tiles_drawn = stats.tiles_drawn;
        p.triangles.add(stats);
      }
    }
  }
  std::printf(
      "| finest spacing m | tiles in the file | tiles drawn | triangles; most | in sight; most | select ms | frame ms |\n"
      "|---|---|---|---|---|---|---|\n");
  double x_mean = 0, y_mean = 0, xx = 0, xy = 0;
  for (Planet& p : planets) {
    const Triangles& t = p.triangles;
    std::printf("| %.1f | %zu | %d | %.0f; %lld | %.0f; %lld | %.3f | %.2f |\n", p.spacing_m,
                static_cast<std::size_t>(p.planet->tree().size()), p.tiles_drawn, t.drawn / t.views,
                t.most_drawn, t.in_sight / t.views, t.most_in_sight, median_upper(p.select_ms),
                median_upper(p.frame_ms));
    x_mean -= std::log2(p.spacing_m) / count;
    y_mean += std::log2(median_upper(p.frame_ms)) / count;
  }
  for (Planet& p : planets) {
    const double x = -std::log2(p.spacing_m) - x_mean;
    xx += x * x;
    xy += x * (std::log2(median_upper(p.frame_ms)) - y_mean);
  }
  if (xx > 0) std::printf("\ntime grows with resolution to the power %.3f (aim at most 0.1)\n", xy / xx);
}

// Returns nothing where the text is no place or pose.
std::vector<mars::Pose> parse_poses(const char* text) {
  mars::Pose pose;
  char rest = 0;
  if (std::sscanf(text, "%lf,%lf,%lf,%lf,%lf,%lf%c", &pose.lon_deg, &pose.lat_deg, &pose.alt_m, &pose.yaw_deg,
                  &pose.pitch_deg, &pose.roll_deg, &rest) == 6)
    return {pose};
  int read = 0;
  if (std::sscanf(text, "%lf,%lf,%lf,around%n", &pose.lon_deg, &pose.lat_deg, &pose.alt_m, &read) == 3 &&
      read > 0 && text[read] == 0)
    return poses_around(pose);
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<mars::Pose> poses = argc > 1 ? parse_poses(argv[1]) : std::vector<mars::Pose>{};
  int width = 0, height = 0;
  char rest = 0;
  const auto rounds = argc > 3 ? vpe::base::parse_integer(argv[3]) : std::nullopt;
  if (argc < 6 || poses.empty() || std::sscanf(argv[2], "%dx%d%c", &width, &height, &rest) != 2 || !rounds ||
      *rounds < 1) {
    std::fprintf(
        stderr,
        "usage: depth_bench LON,LAT,ALT,YAW,PITCH,ROLL|LON,LAT,ALT,around WIDTHxHEIGHT ROUNDS PLANET.vpe "
        "PLANET.vpe...\n");
    return 2;
  }
  try {
    run(poses, width, height, static_cast<int>(*rounds), argv + 4, argc - 4);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "depth_bench: %s\n", e.what());
    return 1;
  }
  return 0;
}
