// Effect and cost of terrain occlusion: for views on a canyon floor, in a crater, over a plain and from orbit,
// the number of selected tiles that the pass hides and that brute force finds hidden, and the time of the pass
// beside that of selection. docs/measurements/culling.md has the table.
//
//   occlusion_bench PLANET.vpe [MARGIN_PX] [NAME LON LAT HEIGHT PITCH]...
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "lod/occlusion.h"
#include "paging/surface/surface.h"
#include "tests/bench/culling_views.h"
#include "tests/paging/drawn_terrain.h"

namespace {

namespace core = vpe::core;

void measure(test_support::MeshStore& store, const paging::Surface& surface, const bench::Place& place,
             double margin_px) {
  const paging::PlanetFile& planet = store.planet();
  int tiles = 0, hidden = 0, found = 0;
  double select_ms = 0, pass_ms = 0;
  lod::OcclusionPass pass;
  constexpr int kYaws = 6;
  for (int n = 0; n < kYaws; ++n) {
    const core::View view = bench::view_at(place, surface, n, kYaws);
    lod::SelectScratch scratch;
    lod::Selection selection;
    select_ms +=
        bench::median_ms([&] { lod::select({}, planet.tree(), lod::select_view(view), scratch, selection); });
    const test_support::DrawnTerrain drawn(store, selection, view.camera.position_m);
    std::vector<lod::OccludingTile> given;
    for (const lod::SelectedTile& t : selection.tiles) {
      given.push_back(
          {t.key, planet.tree().region(t.index, 1.0, t.geometric_error_m), &store.mesh(t, 1.0).occluders});
    }
    std::vector<std::uint8_t> out;
    const double margin_rad = margin_px / core::focal_px(view);
    pass_ms += bench::median_ms(
        [&] { lod::occlude(given, view.camera.position_m, true, margin_rad, planet.radius_m(), pass, out); });
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
  std::vector<bench::Place> places;
  for (int n = 3; n + 4 < argc; n += 5) {
    places.push_back({argv[n], std::atof(argv[n + 1]), std::atof(argv[n + 2]), std::atof(argv[n + 3]),
                      std::atof(argv[n + 4])});
  }
  if (places.empty()) places = bench::culling_places();
  test_support::MeshStore store(planet);
  const paging::Surface surface(planet, std::size_t{64} << 20);
  for (const bench::Place& place : places) measure(store, surface, place, margin_px);
}
