// Times casts of range images of a patch planet (ray_bench makes them), so that two builds of the ray caster can be compared:
//
//   cast_bench PLANET.vpe [CASTS [VIEW [MODE]]]
//   bench_ratio.sh FORMER_CAST_BENCH CAST_BENCH ROUNDS PLANET.vpe ...
//
// VIEW and MODE (exact, multires) select rows by a part of their name. Views are those of ray_bench, at the middle of the finest
// tiles. Each row is the least processor time of CASTS casts on one thread, after one that loads. tests/bench/former_bench.sh makes a
// former build. For counts of instructions run it under
// `valgrind --tool=callgrind --toggle-collect=*counted_cast*`, with SIZE in the environment below 1 for smaller images.
// docs/measurements/rays.md has the figures.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "lod/tree/tile_key.h"
#include "mars/geodesy/pose.h"
#include "vpe/base/number.h"
#include "vpe/base/parallel.h"
#include "vpe/voxel/cast/range_caster.h"

namespace {

using vpe::core::View;
using vpe::voxel::RangeCaster;
using vpe::voxel::RangeOptions;

struct ViewCase {
  const char* name;
  double height_m;
  double pitch_deg;
  double roll_deg;
};

constexpr ViewCase kPanoramas[] = {
    {"pano 2m", 2, 0, 0}, {"pano 1km", 1e3, 0, 0}, {"pano 10km", 1e4, 0, 0}, {"pano 300km", 3e5, 0, 0}};
constexpr ViewCase kPictures[] = {{"p10 r0", 1e3, -10, 0},  {"p10 r45", 1e3, -10, 45}, {"p30 r0", 1e3, -30, 0},
                                  {"p60 r0", 1e3, -60, 0},  {"p60 r45", 1e3, -60, 45}, {"p90 r0", 1e3, -90, 0},
                                  {"p90 r45", 1e3, -90, 45}};

// Returns the direction of the middle of the planet's finest tiles.
glm::dvec3 finest_middle(const lod::TileTree& tree) {
  int finest = 0;
  glm::dvec3 sum{0};
  for (lod::TileTree::Index n = 0; n < static_cast<lod::TileTree::Index>(tree.size()); ++n) {
    const lod::TileKey& key = tree[n].key;
    if (key.level < finest) continue;
    if (key.level > finest) sum = glm::dvec3{0};
    finest = key.level;
    sum += lod::bounding_cap(key).centre;
  }
  return glm::normalize(sum);
}

// Has a name of its own for callgrind.
__attribute__((noinline)) void counted_cast(RangeCaster& caster, const View& view, const RangeOptions& options,
                                            vpe::base::ThreadPool& pool, std::vector<float>& range_m) {
  caster.cast(view, options, pool, range_m);
}

View view_of(const ViewCase& one, bool is_panorama, const paging::Surface& surface, const glm::dvec3& middle,
             double size) {
  constexpr double kYaw_deg = 30, kAcross_deg = 60;
  View view;
  const mars::LonLat place = mars::lon_lat(middle);
  view.camera = mars::to_camera({place.lon_deg, place.lat_deg, surface.at(middle).height_m + one.height_m,
                                 kYaw_deg, one.pitch_deg, one.roll_deg},
                                surface.planet_radius_m());
  const double width = is_panorama ? 6000 : 1920, height = is_panorama ? 2000 : 1080;
  view.width = static_cast<int>(std::lround(size * width));
  view.height = static_cast<int>(std::lround(size * height));
  view.fov_deg = kAcross_deg;
  if (is_panorama) {
    view.projection = vpe::core::Projection::kCylinder;
  } else {
    view.fov_deg = 2.0 / mars::kRadiansPerDegree *
                   std::atan(std::tan(0.5 * kAcross_deg * mars::kRadiansPerDegree) * height / width);
  }
  return view;
}

void time_row(const std::string& name, RangeCaster& caster, const View& view, const RangeOptions& options,
              int casts) {
  vpe::base::ThreadPool alone(1);
  std::vector<float> range_m(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
  caster.cast(view, options, alone, range_m);
  double least_ms = 1e300;
  for (int n = 0; n < casts; ++n) {
    const std::clock_t start = std::clock();
    counted_cast(caster, view, options, alone, range_m);
    least_ms = std::min(least_ms, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::printf("| %s | %.2f |\n", name.c_str(), least_ms);
  std::fflush(stdout);
}

void run(const char* file, int casts, const std::string& wanted_view, const std::string& wanted_mode,
         double size) {
  RangeCaster caster(paging::PlanetFile::open(file), std::size_t{3} << 30);
  const glm::dvec3 middle = finest_middle(caster.surface().planet().tree());
  std::puts("| view | processor time, ms |\n|---|---|");
  const auto rows = [&](const ViewCase& one, bool is_panorama) {
    if (std::string(one.name).find(wanted_view) == std::string::npos) return;
    const View view = view_of(one, is_panorama, caster.surface(), middle, size);
    for (const bool is_exact : {true, false}) {
      const std::string mode = is_exact ? "exact" : "multires";
      if (mode.find(wanted_mode) == std::string::npos) continue;
      RangeOptions options;
      options.cell_px = is_exact ? 0 : 1;
      time_row(std::string(one.name) + ", " + mode, caster, view, options, casts);
    }
  };
  for (const ViewCase& one : kPanoramas) rows(one, true);
  for (const ViewCase& one : kPictures) rows(one, false);
}

}  // namespace

int main(int argc, char** argv) try {
  const auto casts = argc > 2 ? vpe::base::parse_integer(argv[2]) : 3;
  const char* const text = std::getenv("SIZE");
  const auto size = text != nullptr ? vpe::base::parse_number(text) : 1.0;
  if (argc < 2 || argc > 5 || !casts || *casts < 1 || *casts > 1000 || !size ||
      !(*size >= 0.01 && *size <= 1)) {
    std::fputs("usage: cast_bench PLANET.vpe [CASTS [VIEW [MODE]]]\n", stderr);
    return 2;
  }
  run(argv[1], static_cast<int>(*casts), argc > 3 ? argv[3] : "", argc > 4 ? argv[4] : "", *size);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "cast_bench: %s\n", e.what());
  return 1;
}
