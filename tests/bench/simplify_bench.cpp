// Which simplification, which tile size, which tolerance: the tables of docs/simplifiers.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <numbers>

#include "lod/mesh/error_meter.h"
#include "tests/bench/simplify_methods.h"
#include "tests/lod/mesh_terrain.h"
#include "tests/lod/mesh_twin.h"
#include "tests/support/support.h"

namespace {

using lod_test::kRadius;
using lod_test::Terrain;

// Processor time: other programs on the machine disturb it less.
double seconds(const auto& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

struct Ground {
  const char* name;
  lod::Posts posts;
};

// MOLA at 8 pixels a degree, bilinear.
lod::Posts mola(const lod::TileKey& key, int intervals, const std::vector<unsigned char>& bytes) {
  const auto sample = [&](int row, int column) {
    const auto at = 2 * (static_cast<std::size_t>(std::clamp(row, 0, 1439)) * 2880 +
                         static_cast<std::size_t>((column + 2880) % 2880));
    return static_cast<double>(static_cast<std::int16_t>(bytes[at] << 8 | bytes[at + 1]));
  };
  const lod::GridLines lines = lod::grid_lines(key, intervals);
  return lod_test::make_posts(key, intervals, [&](int i, int j) {
    const glm::dvec3 d = mars::chart_direction(key.face, lines.u[static_cast<std::size_t>(i)],
                                               lines.v[static_cast<std::size_t>(j)]);
    const double x = (std::atan2(d.y, d.x) / std::numbers::pi * 180 + 360) * 8 - 0.5;
    const double y = (90 - std::asin(d.z) / std::numbers::pi * 180) * 8 - 0.5;
    const int column = static_cast<int>(std::floor(x));
    const int row = static_cast<int>(std::floor(y));
    const double fx = x - column;
    const double fy = y - row;
    return (1 - fy) * ((1 - fx) * sample(row, column) + fx * sample(row, column + 1)) +
           fy * ((1 - fx) * sample(row + 1, column) + fx * sample(row + 1, column + 1));
  });
}

Terrain cratered(std::uint64_t seed, const lod::TileKey& key) {
  const double side = lod::nominal_side_m(key.level, kRadius);
  const mars::Cap cap = lod::bounding_cap(key);
  Terrain terrain(seed, 0.03 * side, side);
  terrain.add_craters(cap.centre, cap.radius_rad, 150, side / 60, side / 6);
  return terrain;
}

// Largest tolerance whose mesh measures at most `target_m`.
struct Fit {
  lod::TileMesh mesh;
  double tolerance_m = 0;
  double geometric_error_m = 0;
};
Fit fit(const lod::Posts& posts, double target_m, const auto& make) {
  const lod::FinePosts fine(posts, kRadius);
  Fit best;
  double low = target_m / 64;
  double high = target_m;
  for (int step = 0; step < 9; ++step) {
    const double tolerance = step == 0 ? low : std::sqrt(low * high);
    const lod::TileMesh mesh = make(tolerance);
    const double error =
        lod::ErrorMeter(posts.key, mesh, lod::vertex_heights(mesh, posts), kRadius).measure(fine).total_m;
    if (error <= target_m) {
      best = {mesh, tolerance, error};
      low = tolerance;
    } else {
      if (step == 0) break;
      high = tolerance;
    }
  }
  return best;
}

void print(const char* method, const lod::TileMesh& mesh, double geometric_error_m, std::size_t reference,
           double time_s) {
  if (mesh.triangle_count() == 0) {
    std::printf("| %s | - | - | - | - |\n", method);
    return;
  }
  std::printf("| %s | %zu | %.2f | %.1f | %.2f |\n", method, mesh.triangle_count(),
              static_cast<double>(mesh.triangle_count()) / static_cast<double>(reference), geometric_error_m,
              time_s * 1e3);
}

void compare_methods(const Ground& ground, double target_m) {
  const lod::Posts& posts = ground.posts;
  const auto posts_count = static_cast<double>(posts.height_m.size());
  std::printf(
      "\n%s, %d^2 posts, true error <= %.3g m\n\n| method | triangles | x greedy | error m | ms "
      "|\n|---|---|---|---|---|\n",
      ground.name, posts.side(), target_m);
  lod::Mesher mesher;
  lod::GreedyMesher<lod_test::ArrayTopology> twin;
  const auto borders = [&](double tolerance) { return lod::choose_borders(posts, tolerance, kRadius); };
  const Fit greedy = fit(posts, target_m, [&](double tolerance) {
    return mesher.mesh(posts, borders(tolerance), tolerance, kRadius);
  });
  if (greedy.mesh.triangle_count() == 0) {
    std::printf("| greedy: not reached | | | | |\n");
    return;
  }
  std::vector<double> open_mesh, array, ratio;
  const lod::BorderPosts kept = borders(greedy.tolerance_m);
  for (int round = 0; round < 7; ++round) {
    open_mesh.push_back(seconds([&] { mesher.mesh(posts, kept, greedy.tolerance_m, kRadius); }));
    array.push_back(seconds([&] { twin.mesh(posts, kept, greedy.tolerance_m, kRadius); }));
    ratio.push_back(open_mesh.back() / array.back());
  }
  const std::size_t reference = greedy.mesh.triangle_count();
  print("greedy insertion, OpenMesh", greedy.mesh, greedy.geometric_error_m, reference, median(open_mesh));
  print("greedy insertion, arrays", twin.mesh(posts, kept, greedy.tolerance_m, kRadius),
        greedy.geometric_error_m, reference, median(array));

  std::unique_ptr<bench::Rtin> rtin;
  const double prepare = seconds([&] { rtin = std::make_unique<bench::Rtin>(posts, kRadius); });
  const Fit right = fit(posts, target_m, [&](double tolerance) { return rtin->mesh(tolerance); });
  print("RTIN, true triangle error", right.mesh, right.geometric_error_m, reference, prepare);

  const lod::FinePosts fine(posts, kRadius);
  const auto measure = [&](const lod::TileMesh& mesh) {
    return lod::ErrorMeter(posts.key, mesh, lod::vertex_heights(mesh, posts), kRadius).measure(fine).total_m;
  };
  lod::TileMesh coarse;
  double coarse_error = 0;
  double threshold = 0;
  {
    // Quadrics are distances squared times areas; the error need not rise with every step.
    bench::Decimater decimater(posts, kRadius);
    const double spacing = lod::post_spacing_m(posts.key.level, posts.intervals, kRadius);
    int beyond = 0;
    for (double q = std::pow(target_m * spacing, 2) * 1e-4; beyond < 2; q *= 2) {
      decimater.decimate(q);
      const auto mesh = decimater.mesh();
      if (!mesh) continue;
      const double error = measure(*mesh);
      if (error > target_m) {
        ++beyond;
        continue;
      }
      coarse = *mesh;
      coarse_error = error;
      threshold = q;
    }
  }
  const double decimation = seconds([&] { bench::Decimater(posts, kRadius).decimate(threshold); });
  print("OpenMesh decimater, ModQuadric", coarse, coarse_error, reference, decimation);

  lod::TileMesh grid;
  double grid_error = 0;
  for (int step = posts.intervals / 4; step >= 2; step /= 2) {
    grid = bench::regular_grid(posts.intervals, step);
    grid_error = measure(grid);
    if (grid_error <= target_m) break;
    grid = {};
  }
  print("regular grid", grid, grid_error, reference, 0);
  if (grid.triangle_count() == 0)
    std::printf("  (regular grid: all %d triangles are needed)\n", 2 * posts.intervals * posts.intervals);
  std::printf("tolerance %.3g m, 1 vertex to %.0f posts, %.0f ns a post; OpenMesh / arrays %.2f\n",
              greedy.tolerance_m, posts_count / static_cast<double>(greedy.mesh.vertices.size()),
              median(open_mesh) / posts_count * 1e9, median(ratio));
}

// The same 1024 x 1024 intervals cut into tiles of 2^k.
void compare_tile_sizes() {
  const lod::TileKey area{mars::Face::kPlusX, 6, 40, 24};
  const Terrain terrain = cratered(5, area);
  const lod::Posts all = terrain.posts(area, 1024);
  std::printf(
      "\nTile sizes, 1024^2 intervals\n\n| k | tolerance m | tiles | triangles | skirts | ms | draw ms (8 "
      "Mtri/s + 5 us) |\n|---|---|---|---|---|---|---|\n");
  for (const double tolerance : {400.0, 100.0, 50.0, 25.0}) {
    for (const int k : {6, 7, 8}) {
      const int n = 1 << k;
      const int tiles = 1024 / n;
      lod::Mesher mesher;
      std::size_t triangles = 0;
      std::size_t skirts = 0;
      double time = 0;
      for (int tj = 0; tj < tiles; ++tj) {
        for (int ti = 0; ti < tiles; ++ti) {
          const lod::TileKey key{area.face, area.level + 10 - k, area.i * tiles + ti, area.j * tiles + tj};
          const lod::Posts posts =
              lod_test::make_posts(key, n, [&](int i, int j) { return all.at(ti * n + i, tj * n + j); });
          time += seconds([&] {
            const lod::BorderPosts borders = lod::choose_borders(posts, tolerance, kRadius);
            triangles += mesher.mesh(posts, borders, tolerance, kRadius).triangle_count();
            for (const auto& kept : borders) skirts += 2 * (kept.size() - 1);
          });
        }
      }
      std::printf("| %d | %.0f | %d | %zu | %zu | %.0f | %.2f |\n", k, tolerance, tiles * tiles, triangles,
                  skirts, time * 1e3, static_cast<double>(triangles + skirts) / 8e3 + tiles * tiles * 5e-3);
    }
  }
}

// Tiles of a flat quadtree that a view of 60 degrees width draws, by level, when a tile of side s and error e
// is used from the distance e * focal_px / tolerance_px on.
struct Drawn {
  double tiles = 0;
  double triangles = 0;
};
Drawn draw(int level, int finest, double x, double y, double side, const std::vector<double>& geometric_error_m,
           const std::vector<double>& triangles, double camera_height) {
  const double reach_x = std::max(0.0, std::abs(x) - side / 2);
  const double reach_y = std::max(0.0, std::abs(y) - side / 2);
  // Outside the wedge |angle| <= 30 degrees about +x, up to the tile's circle.
  const double circle = side * 0.7072;
  const double sine = std::sqrt(0.75);
  if (y * sine - x * 0.5 > circle || -y * sine - x * 0.5 > circle) return {};
  const double distance = std::sqrt(reach_x * reach_x + reach_y * reach_y + camera_height * camera_height);
  constexpr double kFocalPx = 1663;  // 1920 pixels over 60 degrees
  const auto at = static_cast<std::size_t>(level);
  if (level == finest || geometric_error_m[at] * kFocalPx <= distance) return {1, triangles[at]};
  Drawn sum;
  for (int c = 0; c < 4; ++c) {
    const Drawn d = draw(level + 1, finest, x + (c % 2 - 0.5) * side / 2, y + (c / 2 - 0.5) * side / 2,
                         side / 2, geometric_error_m, triangles, camera_height);
    sum.tiles += d.tiles;
    sum.triangles += d.triangles;
  }
  return sum;
}

void compare_tolerances() {
  constexpr int kTop = 5;
  constexpr int kFinest = 12;
  std::printf(
      "\nTolerance of a level = side / K; tiles of k = 7 meshed over 257^2 posts; 1920 pixels, 1 px, eye 2 km "
      "up\n\n"
      "| K | triangles a tile | measured / tolerance | tiles drawn | triangles drawn | draw ms "
      "|\n|---|---|---|---|---|---|\n");
  const Terrain terrain = cratered(21, {mars::Face::kPlusX, kTop, 18, 14});
  std::vector<lod::Posts> posts;
  for (int level = kTop; level <= kFinest; ++level) {
    for (int sample = 0; sample < 2; ++sample) {
      const int shift = level - kTop;
      posts.push_back(
          terrain.posts({mars::Face::kPlusX, level, (18 << shift) + ((1 << shift) * (1 + sample)) / 3,
                         (14 << shift) + (1 << shift) / 2},
                        256));
    }
  }
  lod::Mesher mesher;
  for (const double fraction : {64., 96., 128., 192., 256., 384., 512., 768., 1024.}) {
    std::vector<double> error(kFinest + 1), triangles(kFinest + 1);
    double ratio = 0;
    double per_tile = 0;
    for (const lod::Posts& p : posts) {
      const auto level = static_cast<std::size_t>(p.key.level);
      const double tolerance = lod::nominal_side_m(p.key.level, kRadius) / fraction;
      const lod::TileMesh mesh = mesher.mesh(p, lod::choose_borders(p, tolerance, kRadius), tolerance, kRadius);
      const double measured =
          lod::ErrorMeter(p.key, mesh, lod::vertex_heights(mesh, p), kRadius).measure(p).total_m;
      error[level] += measured / 2;
      triangles[level] += static_cast<double>(mesh.triangle_count()) / 2;
      ratio += measured / tolerance / static_cast<double>(posts.size());
      per_tile += static_cast<double>(mesh.triangle_count()) / static_cast<double>(posts.size());
    }
    const double side = lod::nominal_side_m(kTop, kRadius);
    Drawn drawn;
    for (int j = -2; j < 2; ++j) {
      for (int i = -2; i < 2; ++i) {
        const Drawn d = draw(kTop, kFinest, (i + 0.37) * side, (j + 0.41) * side, side, error, triangles, 2000);
        drawn.tiles += d.tiles;
        drawn.triangles += d.triangles;
      }
    }
    std::printf("| %.0f | %.0f | %.2f | %.0f | %.0f | %.1f |\n", fraction, per_tile, ratio, drawn.tiles,
                drawn.triangles, drawn.triangles / 8e3 + drawn.tiles * 5e-3);
  }
}

}  // namespace

int main() {
  std::vector<Ground> grounds;
  const lod::TileKey fractal{mars::Face::kPlusX, 8, 150, 100};
  grounds.push_back({"fractal with craters, 81 m posts", cratered(3, fractal).posts(fractal, 256)});
  const std::filesystem::path path = test_support::shared_data("mola8/mola8_topo.img");
  if (path.empty()) {
    std::printf("skipped: no data mola8/mola8_topo.img\n");
  } else {
    std::ifstream file(path, std::ios::binary);
    const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), {}};
    if (bytes.size() == 2880 * 1440 * 2) {
      // RTIN needs an even grid, so level 5 at least, whose posts are finer than the data.
      const lod::TileKey key{mars::Face::kMinusY, 5, 15, 13};
      grounds.push_back({"MOLA 8 px/deg, 651 m posts", mola(key, 256, bytes)});
    }
  }
  for (const Ground& ground : grounds) {
    const double side = lod::nominal_side_m(ground.posts.key.level, kRadius);
    for (const double share : {150.0, 300.0, 600.0}) compare_methods(ground, side / share);
  }
  compare_tile_sizes();
  compare_tolerances();
}
