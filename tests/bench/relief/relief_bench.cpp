// Time of casting relief against the resolution of its height map (the table of Vyatkin and Dolgovesov 2002), and images of
// one map on three bases. docs/measurements/relief.md has the figures.
//
//   relief_bench table ROUNDS [TOLERANCE_PX]   medians of interleaved rounds at 512x512 pixels, one thread
//   relief_bench once POSTS bilinear|bicubic TOLERANCE_PX   one cast, for callgrind
//   relief_bench images FOLDER                 plane, sphere, paraboloid and close-ups as PNG files
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "relief/cast/caster.h"
#include "relief/field/height_map.h"
#include "vpe/app/report/papers/relief_hills.h"
#include "vpe/base/quantile.h"
#include "vpe/core/image/image.h"

namespace {

using Clock = std::chrono::steady_clock;
using relief::Base;
using relief::HeightMap;
using relief::Interpolation;
using vpe::app::hills_map;
using vpe::app::hills_view;
using vpe::app::kHillsSide_m;
using vpe::app::on_plane;
using vpe::app::view_towards;

void table(int rounds, double tolerance_px) {
  vpe::base::ThreadPool pool(1);
  std::printf(
      "| map | interpolation | time ms | of 64x64 | bundles | steps | patches |\n|---|---|---|---|---|---|---|\n");
  const std::vector<int> sides{64, 128, 512, 1024};
  for (const Interpolation interpolation : {Interpolation::kBilinear, Interpolation::kBicubic}) {
    std::vector<relief::Surface> surfaces;
    for (const int posts : sides)
      surfaces.push_back(on_plane(hills_map({.posts = posts, .interpolation = interpolation})));
    std::vector<std::vector<double>> times(sides.size());
    std::vector<relief::CastCounts> counts(sides.size());
    for (int round = -1; round < rounds; ++round) {
      for (std::size_t n = 0; n < sides.size(); ++n) {
        const auto start = Clock::now();
        counts[n] = relief::cast(surfaces[n], hills_view(), {.tolerance_px = tolerance_px}, pool).counts;
        if (round >= 0)
          times[n].push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
      }
    }
    std::vector<double> medians;
    for (std::vector<double>& each : times) medians.push_back(vpe::base::median_upper(each));
    for (std::size_t n = 0; n < sides.size(); ++n)
      std::printf("| %dx%d | %s | %.1f | %.3f | %lld | %lld | %lld |\n", sides[n], sides[n],
                  interpolation == Interpolation::kBilinear ? "bilinear" : "bicubic", medians[n],
                  medians[n] / medians[0], static_cast<long long>(counts[n].bundles),
                  static_cast<long long>(counts[n].steps), static_cast<long long>(counts[n].patches));
  }
}

void once(int posts, Interpolation interpolation, double tolerance_px) {
  vpe::base::ThreadPool pool(1);
  const relief::Surface surface = on_plane(hills_map({.posts = posts, .interpolation = interpolation}));
  const relief::CastResult result = relief::cast(surface, hills_view(), {.tolerance_px = tolerance_px}, pool);
  const auto hits =
      std::count_if(result.range_m.begin(), result.range_m.end(), [](double r) { return r < relief::kNoHit; });
  std::printf("%lld hits, %lld bundles, %lld steps, %lld patches\n", static_cast<long long>(hits),
              static_cast<long long>(result.counts.bundles), static_cast<long long>(result.counts.steps),
              static_cast<long long>(result.counts.patches));
}

void write(const relief::Surface& surface, const vpe::core::View& view, const std::filesystem::path& path) {
  vpe::base::ThreadPool pool(0);
  const vpe::core::RgbImage image = vpe::app::draw_relief(surface, view, {}, pool);
  vpe::core::write_image(path, image.pixels, image.width, image.height);
}

void images(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write(on_plane(hills_map({200, Interpolation::kBilinear})), hills_view(), folder / "plane.png");
  write(on_plane(hills_map({64, Interpolation::kBilinear})), hills_view(), folder / "plane-64.png");
  write(on_plane(hills_map({64, Interpolation::kBicubic})), hills_view(), folder / "plane-64-bicubic.png");
  const auto ball_map = hills_map({200, Interpolation::kBicubic, 700, 0.5, true});
  const Base ball = Base::sphere({0, 0, 0}, 500);
  const vpe::core::View view = view_towards({900, -900, 900}, {60, -60, 60}, 512, 512, 45);
  write(relief::parallel_surface(ball, {0, 0, 0}, glm::normalize(glm::dvec3(1, 1, 0)),
                                 glm::normalize(glm::cross(glm::normalize(glm::dvec3(1, -1, 1)),
                                                           glm::normalize(glm::dvec3(1, 1, 0)))),
                                 ball_map),
        view, folder / "sphere.png");
  std::array<std::shared_ptr<const relief::Shape>, mars::kFaces> faces;
  faces.fill(hills_map({200, Interpolation::kBicubic, 600, 0.5, true}));
  write(relief::cube_surface(Base::ellipsoid({0, 0, 0}, {600, 450, 350}), 500, faces), view,
        folder / "ellipsoid.png");
  relief::Quadratic bowl;
  bowl.matrix[0][0] = bowl.matrix[1][1] = -1.0 / 1600;
  bowl.linear = {0, 0, 0.5};
  write(relief::parallel_surface(Base::quadric(bowl, {0, 0, 0}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                 hills_map({200, Interpolation::kBicubic, kHillsSide_m, 0.6, false}),
                                 {-500, -500, 500, 500}),
        view_towards({-900, -850, 900}, {0, 0, 130}, 512, 512, 50), folder / "paraboloid.png");
  const vpe::core::View close = view_towards({-30, -60, 75}, {60, 60, 20}, 512, 512, 40);
  write(on_plane(hills_map({64, Interpolation::kBilinear})), close, folder / "close-bilinear.png");
  write(on_plane(hills_map({64, Interpolation::kBicubic})), close, folder / "close-bicubic.png");
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string_view> words(argv + 1, argv + argc);
  if (words.size() >= 2 && words[0] == "table") {
    table(std::max(1, std::atoi(argv[2])), words.size() > 2 ? std::atof(argv[3]) : 0);
  } else if (words.size() == 4 && words[0] == "once") {
    once(std::max(2, std::atoi(argv[2])),
         words[2] == "bicubic" ? Interpolation::kBicubic : Interpolation::kBilinear, std::atof(argv[4]));
  } else if (words.size() == 2 && words[0] == "images") {
    images(argv[2]);
  } else {
    std::fprintf(
        stderr,
        "relief_bench table ROUNDS [TOLERANCE_PX] | once POSTS bilinear|bicubic TOLERANCE_PX | images FOLDER\n");
    return 2;
  }
  return 0;
}
