// Cost and savings of the cullers inside selection: selection with both, without the horizon and without the
// frustum, for views on a canyon floor, in a crater, over a plain and from orbit. docs/measurements/culling.md
// has the table.
//
//   culling_bench PLANET.vpe
#include <cstdio>

#include "lod/select.h"
#include "paging/planet/planet_file.h"
#include "tests/bench/culling_views.h"

namespace {

struct Total {
  double ms = 0;
  long visited = 0, horizon = 0, frustum = 0, tiles = 0;

  void add(const lod::SelectOptions& options, const lod::TileTree& tree, const lod::SelectView& view) {
    lod::SelectScratch scratch;
    lod::Selection selection;
    ms += bench::median_ms([&] { lod::select(options, tree, view, scratch, selection); }, 31);
    visited += selection.visited;
    horizon += selection.culled_horizon;
    frustum += selection.culled_frustum;
    tiles += static_cast<long>(selection.tiles.size());
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "culling_bench PLANET.vpe\n");
    return 2;
  }
  const auto planet = paging::PlanetFile::open(argv[1]);
  const paging::Surface surface(planet, std::size_t{64} << 20);
  constexpr int kYaws = 6;
  std::printf(
      "a view: tiles visited, culled by each (tiles that their absence adds to the image), time of "
      "selecting\n");
  for (const bench::Place& place : bench::culling_places()) {
    Total both, without_horizon, without_frustum;
    for (int n = 0; n < kYaws; ++n) {
      lod::SelectView view = lod::select_view(bench::view_at(place, surface, n, kYaws));
      both.add({}, planet->tree(), view);
      lod::SelectOptions options;
      options.cull_horizon = false;
      without_horizon.add(options, planet->tree(), view);
      view.frustum = {};
      without_frustum.add({}, planet->tree(), view);
    }
    std::printf(
        "%-8s %7.0f m: %4ld visited, horizon %3.0f %% (%5ld), frustum %3.0f %% (%5ld), %4ld drawn; %.3f ms, "
        "without horizon %.3f, without frustum %.3f\n",
        place.name.c_str(), place.height_m, both.visited / kYaws,
        100.0 * static_cast<double>(both.horizon) / static_cast<double>(both.visited),
        (without_horizon.tiles - both.tiles) / kYaws,
        100.0 * static_cast<double>(both.frustum) / static_cast<double>(both.visited),
        (without_frustum.tiles - both.tiles) / kYaws, both.tiles / kYaws, both.ms / kYaws,
        without_horizon.ms / kYaws, without_frustum.ms / kYaws);
  }
}
