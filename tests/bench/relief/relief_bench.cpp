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
#include "vpe/base/quantile.h"
#include "vpe/core/image/image.h"
#include "vpe/report/value_noise.h"

namespace {

using Clock = std::chrono::steady_clock;
using relief::Base;
using relief::HeightMap;
using relief::Interpolation;

constexpr double kSide_m = 1000;

// The same hills for every resolution: seven octaves, the finest of which 1024 posts resolve.
double hills_m(double x, double y) {
  double height = 0;
  double size = 90;
  double frequency = 3;
  for (std::uint64_t octave = 0; octave < 7; ++octave) {
    height += size * vpe::report::value_noise({x * frequency, y * frequency, 0.5}, octave);
    size *= 0.45;
    frequency *= 2;
  }
  return height;
}

std::shared_ptr<const HeightMap> make_map(int posts, Interpolation interpolation, double side_m, double scale,
                                          bool is_tapered) {
  std::vector<float> heights;
  for (int j = 0; j < posts; ++j)
    for (int i = 0; i < posts; ++i)
      heights.push_back(static_cast<float>(
          scale * hills_m(static_cast<double>(i) / (posts - 1), static_cast<double>(j) / (posts - 1))));
  if (is_tapered) heights = relief::tapered(heights, posts, posts, posts / 8);
  const double spacing_m = side_m / (posts - 1);
  const relief::MapLayout layout{posts, posts, -side_m / 2, -side_m / 2, spacing_m, spacing_m};
  return std::make_shared<HeightMap>(layout, std::move(heights), interpolation);
}

relief::Surface on_plane(const std::shared_ptr<const HeightMap>& map) {
  return relief::parallel_surface(Base::plane({0, 0, 0}, {0, 0, 1}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, map,
                                  map->support());
}

vpe::core::View look(const glm::dvec3& from_m, const glm::dvec3& at_m, int width, int height, double fov_deg) {
  vpe::core::View view;
  view.camera.position_m = from_m;
  const glm::dvec3 forward = glm::normalize(at_m - from_m);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
  view.camera.axes = {right, glm::cross(right, forward), forward};
  view.width = width;
  view.height = height;
  view.fov_deg = fov_deg;
  return view;
}

vpe::core::View table_view() { return look({-560, -520, 330}, {30, 40, -40}, 512, 512, 50); }

void table(int rounds, double tolerance_px) {
  vpe::base::ThreadPool pool(1);
  std::printf(
      "| map | interpolation | time ms | of 64x64 | bundles | steps | patches |\n|---|---|---|---|---|---|---|\n");
  const std::vector<int> sides{64, 128, 512, 1024};
  for (const Interpolation interpolation : {Interpolation::kBilinear, Interpolation::kBicubic}) {
    std::vector<relief::Surface> surfaces;
    for (const int posts : sides)
      surfaces.push_back(on_plane(make_map(posts, interpolation, kSide_m, 1, false)));
    std::vector<std::vector<double>> times(sides.size());
    std::vector<relief::CastCounts> counts(sides.size());
    for (int round = -1; round < rounds; ++round) {
      for (std::size_t n = 0; n < sides.size(); ++n) {
        const auto start = Clock::now();
        counts[n] = relief::cast(surfaces[n], table_view(), {.tolerance_px = tolerance_px}, pool).counts;
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
  const relief::Surface surface = on_plane(make_map(posts, interpolation, kSide_m, 1, false));
  const relief::CastResult result = relief::cast(surface, table_view(), {.tolerance_px = tolerance_px}, pool);
  const auto hits =
      std::count_if(result.range_m.begin(), result.range_m.end(), [](double r) { return r < relief::kNoHit; });
  std::printf("%lld hits, %lld bundles, %lld steps, %lld patches\n", static_cast<long long>(hits),
              static_cast<long long>(result.counts.bundles), static_cast<long long>(result.counts.steps),
              static_cast<long long>(result.counts.patches));
}

void write(const relief::Surface& surface, const vpe::core::View& view, const std::filesystem::path& path) {
  vpe::base::ThreadPool pool(0);
  const relief::CastResult result = relief::cast(surface, view, {}, pool);
  // From the side of the camera.
  const glm::dvec3 sun =
      glm::normalize(view.camera.axes.up - view.camera.axes.right - 0.6 * view.camera.axes.forward);
  std::vector<vpe::base::Rgb> pixels;
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) {
      const double range_m = result.range_m[pixels.size()];
      if (!(range_m < relief::kNoHit)) {
        pixels.push_back({200, 215, 235});
        continue;
      }
      const glm::dvec3 ray = vpe::core::pixel_ray(view, x + 0.5, y + 0.5);
      const glm::dvec3 normal = surface.normal(view.camera.position_m + range_m * ray);
      const double light = 0.12 + 0.88 * std::max(0.0, glm::dot(normal, sun));
      const auto tone = [light](double full) { return static_cast<std::uint8_t>(std::lround(full * light)); };
      pixels.push_back({tone(235), tone(190), tone(145)});
    }
  }
  vpe::core::write_image(path, pixels, result.width, result.height);
}

void images(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write(on_plane(make_map(200, Interpolation::kBilinear, kSide_m, 1, false)), table_view(),
        folder / "plane.png");
  write(on_plane(make_map(64, Interpolation::kBilinear, kSide_m, 1, false)), table_view(),
        folder / "plane-64.png");
  write(on_plane(make_map(64, Interpolation::kBicubic, kSide_m, 1, false)), table_view(),
        folder / "plane-64-bicubic.png");
  const auto ball_map = make_map(200, Interpolation::kBicubic, 700, 0.5, true);
  const Base ball = Base::sphere({0, 0, 0}, 500);
  const vpe::core::View view = look({900, -900, 900}, {60, -60, 60}, 512, 512, 45);
  write(relief::parallel_surface(ball, {0, 0, 0}, glm::normalize(glm::dvec3(1, 1, 0)),
                                 glm::normalize(glm::cross(glm::normalize(glm::dvec3(1, -1, 1)),
                                                           glm::normalize(glm::dvec3(1, 1, 0)))),
                                 ball_map),
        view, folder / "sphere.png");
  std::array<std::shared_ptr<const relief::Shape>, mars::kFaces> faces;
  faces.fill(make_map(200, Interpolation::kBicubic, 600, 0.5, true));
  write(relief::cube_surface(Base::ellipsoid({0, 0, 0}, {600, 450, 350}), 500, faces), view,
        folder / "ellipsoid.png");
  relief::Quadratic bowl;
  bowl.matrix[0][0] = bowl.matrix[1][1] = -1.0 / 1600;
  bowl.linear = {0, 0, 0.5};
  write(relief::parallel_surface(Base::quadric(bowl, {0, 0, 0}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                 make_map(200, Interpolation::kBicubic, kSide_m, 0.6, false),
                                 {-500, -500, 500, 500}),
        look({-900, -850, 900}, {0, 0, 130}, 512, 512, 50), folder / "paraboloid.png");
  const vpe::core::View close = look({-30, -60, 75}, {60, 60, 20}, 512, 512, 40);
  write(on_plane(make_map(64, Interpolation::kBilinear, kSide_m, 1, false)), close,
        folder / "close-bilinear.png");
  write(on_plane(make_map(64, Interpolation::kBicubic, kSide_m, 1, false)), close,
        folder / "close-bicubic.png");
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
