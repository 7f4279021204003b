// What terrain occlusion removes and costs: of the tiles selected for views on a canyon floor, in a crater,
// over a plain and from orbit, how many the pass hides, how many brute force finds hidden, and the time of the
// pass beside that of selecting. docs/culling.md has the table.
//
//   occlusion_bench PLANET.vpe [MARGIN_PX] [NAME LON LAT HEIGHT PITCH]...
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "lod/occlusion.h"
#include "mars/pose.h"
#include "paging/surface.h"
#include "tests/paging/drawn_ground.h"

namespace {

namespace core = vpe::core;
using Clock = std::chrono::steady_clock;

struct Place {
  std::string name;
  double lon, lat, height_m, pitch_deg;
};

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

template <class Work>
double median_ms(Work&& work) {
  std::vector<double> times;
  for (int round = 0; round < 7; ++round) {
    const auto start = Clock::now();
    work();
    times.push_back(ms_since(start));
  }
  std::nth_element(times.begin(), times.begin() + 3, times.end());
  return times[3];
}

void measure(test_support::MeshStore& store, const paging::Surface& surface, const Place& place,
             double margin_px) {
  const paging::PlanetFile& planet = store.planet();
  int tiles = 0, hidden = 0, found = 0;
  double select_ms = 0, pass_ms = 0;
  lod::OcclusionPass pass;
  constexpr int kYaws = 6;
  for (int n = 0; n < kYaws; ++n) {
    core::View view;
    view.width = 1280;
    view.height = 720;
    view.fov_deg = 60;
    const double ground = surface.at(mars::direction({place.lon, place.lat})).height_m;
    view.eye =
        mars::to_eye({place.lon, place.lat, ground + place.height_m, 360.0 * n / kYaws, place.pitch_deg, 0},
                     planet.radius_m());
    lod::SelectScratch scratch;
    lod::Selection selection;
    select_ms += median_ms([&] { lod::select({}, planet.tree(), lod::select_view(view), scratch, selection); });
    const test_support::DrawnGround drawn(store, selection, view.eye.eye_m);
    std::vector<lod::OccludingTile> given;
    for (const lod::SelectedTile& t : selection.tiles) {
      given.push_back({t.key, planet.tree().shell(t.index, 1.0, t.error_m), &store.mesh(t, 1.0).walls});
    }
    std::vector<std::uint8_t> out;
    const double margin_rad = margin_px / core::focal_px(view);
    pass_ms +=
        median_ms([&] { lod::occlude(given, view.eye.eye_m, true, margin_rad, planet.radius_m(), pass, out); });
    tiles += static_cast<int>(out.size());
    for (std::size_t tile = 0; tile < out.size(); ++tile) {
      const test_support::DrawnMesh& mesh = drawn.mesh(tile);
      const std::size_t step = std::max<std::size_t>(1, mesh.vertices.size() / 50);
      bool seen = false;
      for (std::size_t v = 0; v < mesh.vertices.size() && !seen; v += step)
        seen = !drawn.blocked(mesh.vertices[v]);
      hidden += seen ? 0 : 1;
      found += out[tile];
      if (seen && out[tile] != 0) std::printf("WRONG: %s is seen\n", lod::to_string(given[tile].key).c_str());
    }
  }
  std::printf(
      "%-12s %9.1f m  tiles %5d  hidden %5d  found %5d (%3.0f %% of tiles, %3.0f %% of hidden)  select %.3f ms "
      " pass %.3f ms\n",
      place.name.c_str(), place.height_m, tiles / kYaws, hidden / kYaws, found / kYaws,
      100.0 * found / std::max(1, tiles), 100.0 * found / std::max(1, hidden), select_ms / kYaws,
      pass_ms / kYaws);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "occlusion_bench PLANET.vpe [MARGIN_PX] [NAME LON LAT HEIGHT PITCH]...\n");
    return 2;
  }
  const auto planet = paging::PlanetFile::open(argv[1]);
  const double margin_px = argc > 2 ? std::atof(argv[2]) : 0.25;
  std::vector<Place> places;
  for (int n = 3; n + 4 < argc; n += 5) {
    places.push_back({argv[n], std::atof(argv[n + 1]), std::atof(argv[n + 2]), std::atof(argv[n + 3]),
                      std::atof(argv[n + 4])});
  }
  if (places.empty()) {
    places = {{"canyon", -72.0, -12.5, 100, 0},    {"canyon", -72.0, -12.5, 2, 0},
              {"crater", 137.4, -5.0, 100, 0},     {"crater", 137.4, -5.0, 2, 0},
              {"plain", 118.0, 48.0, 100, 0},      {"volcano", -133.8, 18.6, 1000, -10},
              {"flight", -74.0, -13.5, 8000, -15}, {"orbit", -72.0, -12.5, 400000, -30}};
  }
  test_support::MeshStore store(planet);
  const paging::Surface surface(planet, std::size_t{64} << 20);
  for (const Place& place : places) measure(store, surface, place, margin_px);
}
