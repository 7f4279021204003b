// Times of the steps of a finest tile's meshing over a planet's posts, by step, and of measuring with pieces left out against
// measuring all. Errors must be equal to the bit. Processor time; for docs/measurements/build.md.
//
//   tile_mesh_bench PLANET.vpe [TILES [ROUNDS]]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "lod/mesh/error_meter.h"
#include "lod/mesh/grid_meter.h"
#include "paging/planet/planet_file.h"
#include "tests/bench/compare_rounds.h"

namespace {

constexpr double kMeshRatio = 256;  // as BuildOptions::mesh_ratio
constexpr double kLastShare = 0.1;  // of the full grid: the last mesh has more triangles

double processor_ms(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// A tile's posts, those of the tiles above it, and the tile's meshes.
struct Tile {
  lod::Posts posts;
  std::vector<lod::Posts> above;
  std::vector<lod::TileMesh> meshes;
};

std::vector<lod::TileMesh> meshes_of(lod::Mesher& mesher, const lod::Posts& posts, double radius_m) {
  std::vector<lod::TileMesh> meshes;
  double tolerance_m = lod::nominal_side_m(posts.key.level, radius_m) / kMeshRatio;
  const auto full = static_cast<std::size_t>(2 * posts.intervals * posts.intervals);
  while (meshes.empty() ||
         (static_cast<double>(meshes.back().triangle_count()) < kLastShare * static_cast<double>(full) &&
          meshes.size() < 12)) {
    const lod::BorderPosts borders = lod::choose_borders(posts, tolerance_m, radius_m);
    meshes.push_back(meshes.empty() ? mesher.mesh(posts, borders, tolerance_m, radius_m)
                                    : mesher.refine(borders, tolerance_m));
    tolerance_m *= meshes.size() == 1 ? 0.25 : 0.5;
  }
  return meshes;
}

std::vector<Tile> tiles_of(const paging::PlanetFile& planet, std::size_t count) {
  std::vector<lod::TileKey> leaves;
  for (const lod::TileInfo& tile : planet.tree().tiles())
    if (!tile.has_children) leaves.push_back(tile.key);
  count = std::min(count, leaves.size());
  std::vector<Tile> tiles;
  for (std::size_t k = 0; k < count; ++k) {
    const lod::TileKey key = leaves[k * leaves.size() / count];
    Tile tile{planet.heights(key).posts, {}, {}};
    for (int level = 0; level < key.level; ++level)
      tile.above.push_back(planet.heights(lod::ancestor(key, level)).posts);
    tiles.push_back(std::move(tile));
  }
  return tiles;
}

bool is_same(const lod::ErrorTerms& a, const lod::ErrorTerms& b) {
  return a.total_m == b.total_m && a.sagitta_m == b.sagitta_m && a.height_error_m == b.height_error_m;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: tile_mesh_bench PLANET.vpe [TILES [ROUNDS]]\n");
    return 2;
  }
  const std::size_t count = argc > 2 ? static_cast<std::size_t>(std::atoi(argv[2])) : 24;
  const int rounds = argc > 3 ? std::atoi(argv[3]) : 5;
  const auto planet = paging::PlanetFile::open(argv[1]);
  const double radius_m = planet->tree().radius_m();
  std::vector<Tile> tiles = tiles_of(*planet, count);

  enum Step { kMeshing, kPreparing, kMeshPlanes, kMeasuring, kMeasuringAll, kGrid, kGridAll, kSteps };
  const char* const name[kSteps] = {"meshing",       "posts prepared", "meshes prepared", "measured",
                                    "measured, all", "grids above",    "grids above, all"};
  std::vector<std::vector<double>> ms(kSteps);
  std::vector<double> ratios;
  std::vector<double> grid_ratios;
  std::size_t meshes = 0;
  std::size_t triangles = 0;
  std::size_t differences = 0;
  double grid_total_m = 0;
  lod::Mesher mesher;
  for (int round = 0; round <= rounds; ++round) {
    std::vector<double> now(kSteps);
    meshes = triangles = 0;
    grid_total_m = 0;
    for (Tile& tile : tiles) {
      now[kMeshing] += processor_ms([&] { tile.meshes = meshes_of(mesher, tile.posts, radius_m); });
      std::vector<lod::FinePosts> fine;
      now[kPreparing] += processor_ms([&] { fine.emplace_back(tile.posts, radius_m); });
      for (const lod::TileMesh& mesh : tile.meshes) {
        const std::vector<double> height_m = lod::vertex_heights(mesh, tile.posts);
        std::optional<lod::ErrorMeter> meter;
        lod::ErrorTerms terms;
        lod::ErrorTerms all;
        now[kMeshPlanes] += processor_ms([&] { meter.emplace(tile.posts.key, mesh, height_m, radius_m); });
        now[kMeasuring] += processor_ms([&] { terms = meter->measure(fine.front()); });
        now[kMeasuringAll] += processor_ms([&] { all = meter->measure_all(fine.front()); });
        differences += !is_same(terms, all);
      }
      std::vector<lod::GridMeter> grids;
      for (const lod::Posts& posts : tile.above) grids.emplace_back(posts, radius_m);
      for (const lod::GridMeter& grid : grids) {
        lod::ErrorTerms terms;
        lod::ErrorTerms all;
        now[kGrid] += processor_ms([&] { terms = grid.measure(fine.front()); });
        now[kGridAll] += processor_ms([&] { all = grid.measure_all(fine.front()); });
        grid_total_m += terms.total_m;
        differences += !is_same(terms, all);
      }
      meshes += tile.meshes.size();
      for (const lod::TileMesh& mesh : tile.meshes) triangles += mesh.triangle_count();
    }
    if (round == 0) continue;
    for (std::size_t s = 0; s < kSteps; ++s) ms[s].push_back(now[s] / static_cast<double>(tiles.size()));
    ratios.push_back(now[kMeasuring] / now[kMeasuringAll]);
    grid_ratios.push_back(now[kGrid] / now[kGridAll]);
  }
  std::printf("%zu tiles, %zu meshes, %zu triangles, sum of grids' errors %.17g m, %zu errors differ\n",
              tiles.size(), meshes, triangles, grid_total_m, differences);
  std::printf("| step | processor time of a tile, ms |\n|---|---|\n");
  for (std::size_t s = 0; s < kSteps; ++s) std::printf("| %s | %.3f |\n", name[s], bench::median_of(ms[s]));
  for (const auto& [what, of] : {std::pair("meshes", &ratios), std::pair("grids", &grid_ratios)}) {
    const auto [least, most] = std::minmax_element(of->begin(), of->end());
    std::printf("%s, measured / all: %.2f (%.2f..%.2f)\n", what, bench::median_of(*of), *least, *most);
  }
  return differences == 0 ? 0 : 1;
}
