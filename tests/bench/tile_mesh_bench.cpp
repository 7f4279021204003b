// Times of the steps of a finest tile's meshing over a planet's posts, by step, and of measuring with pieces left out against
// measuring all. Errors must be equal to the bit. Processor time; for docs/measurements/build.md.
//
// Two ways that builds do not take (docs/design/tried.md) are timed in the same rounds: last meshes of half the triangles, and
// first meshes of smooth tiles, which have no vertex inside, so that nothing need be searched.
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

std::vector<lod::TileMesh> meshes_of(lod::Mesher& mesher, const lod::Posts& posts, double radius_m,
                                     double last_share) {
  std::vector<lod::TileMesh> meshes;
  double tolerance_m = lod::nominal_side_m(posts.key.level, radius_m) / kMeshRatio;
  const auto full = static_cast<std::size_t>(2 * posts.intervals * posts.intervals);
  while (meshes.empty() ||
         (static_cast<double>(meshes.back().triangle_count()) < last_share * static_cast<double>(full) &&
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

bool is_smooth(const lod::TileMesh& mesh) {
  return std::ranges::all_of(mesh.vertices, [n = mesh.intervals](const lod::MeshVertex& v) {
    return v.i == 0 || v.j == 0 || v.i == n || v.j == n;
  });
}

std::size_t triangles_of(const std::vector<lod::TileMesh>& meshes) {
  std::size_t count = 0;
  for (const lod::TileMesh& mesh : meshes) count += mesh.triangle_count();
  return count;
}

void print_ratios(const char* what, const std::vector<double>& ratios) {
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  std::printf("%s: %.4f (%.4f..%.4f)\n", what, bench::median_of(ratios), *least, *most);
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

  enum Step {
    kMeshing,
    kPreparing,
    kMeshPlanes,
    kMeasuring,
    kMeasuringAll,
    kGrid,
    kGridAll,
    kHalf,
    kSmooth,
    kSteps
  };
  const char* const name[kSteps] = {"meshing",          "posts prepared", "meshes prepared",
                                    "measured",         "measured, all",  "grids above",
                                    "grids above, all", "half as many",   "first meshes of smooth tiles"};
  std::vector<std::vector<double>> ms(kSteps);
  std::vector<double> ratios;
  std::vector<double> grid_ratios;
  std::vector<double> half_ratios;
  std::vector<double> smooth_shares;
  std::size_t half_triangles = 0;
  std::size_t smooth_tiles = 0;
  std::size_t meshes = 0;
  std::size_t triangles = 0;
  std::size_t differences = 0;
  double grid_total_m = 0;
  lod::Mesher mesher;
  for (int round = 0; round <= rounds; ++round) {
    std::vector<double> now(kSteps);
    meshes = triangles = half_triangles = smooth_tiles = 0;
    grid_total_m = 0;
    for (Tile& tile : tiles) {
      now[kMeshing] += processor_ms([&] { tile.meshes = meshes_of(mesher, tile.posts, radius_m, kLastShare); });
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
      now[kHalf] += processor_ms([&] {
        const std::vector<lod::TileMesh> half = meshes_of(mesher, tile.posts, radius_m, kLastShare / 2);
        for (const lod::TileMesh& mesh : half)
          lod::ErrorMeter(tile.posts.key, mesh, lod::vertex_heights(mesh, tile.posts), radius_m)
              .measure(fine.front());
        half_triangles += triangles_of(half);
      });
      if (is_smooth(tile.meshes.front())) {
        ++smooth_tiles;
        now[kSmooth] += processor_ms([&] { meshes_of(mesher, tile.posts, radius_m, 0); });
      }
      meshes += tile.meshes.size();
      triangles += triangles_of(tile.meshes);
    }
    if (round == 0) continue;
    for (std::size_t s = 0; s < kSteps; ++s) ms[s].push_back(now[s] / static_cast<double>(tiles.size()));
    ratios.push_back(now[kMeasuring] / now[kMeasuringAll]);
    grid_ratios.push_back(now[kGrid] / now[kGridAll]);
    const double made_ms = now[kMeshing] + now[kMeshPlanes] + now[kMeasuring];
    half_ratios.push_back(now[kHalf] / made_ms);
    smooth_shares.push_back(now[kSmooth] / made_ms);
  }
  std::printf("%zu tiles, %zu meshes, %zu triangles, sum of grids' errors %.17g m, %zu errors differ\n",
              tiles.size(), meshes, triangles, grid_total_m, differences);
  std::printf("| step | processor time of a tile, ms |\n|---|---|\n");
  for (std::size_t s = 0; s < kSteps; ++s) std::printf("| %s | %.3f |\n", name[s], bench::median_of(ms[s]));
  print_ratios("meshes, measured / all", ratios);
  print_ratios("grids, measured / all", grid_ratios);
  std::printf("last meshes of half as many triangles: %.2f of all triangles\n",
              static_cast<double>(half_triangles) / static_cast<double>(triangles));
  print_ratios("their meshing and measuring / that of all", half_ratios);
  std::printf("%zu smooth tiles\n", smooth_tiles);
  print_ratios("their first meshes / meshing and measuring of all tiles", smooth_shares);
  return differences == 0 ? 0 : 1;
}
