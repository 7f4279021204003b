// Times painting an image whose ranges are known (vpe/voxel/paint/image_painter.h) against
// TerrainShader::colour_at, sky and haze pixel by pixel. docs/measurements/painting.md has the figures, section
// "Painting".
//
//   painting_bench PLANET.vpe [ROUNDS [CAMERA [APPEARANCE]]]
//   painting_bench PLANET.vpe count CAMERA APPEARANCE
//
// CAMERA and APPEARANCE select cases by a part of their name. "count" takes whole names and paints one image on one thread,
// after one that loads: `valgrind --tool=callgrind --toggle-collect=*counted_paint*` tells its instructions.
//
// All sides paint the same ranges on two threads with warm caches; rounds alternate; figures are medians. "Bare" is
// the painter's lit image of one colour, in the same rounds.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>

#include "mars/geodesy/sun.h"
#include "paging/surface/surface.h"
#include "tests/voxel/painted_by_point.h"
#include "vpe/voxel/cast/range_caster.h"
#include "vpe/voxel/paint/image_painter.h"

namespace {

namespace core = vpe::core;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMemory = std::size_t{1} << 29;
constexpr int kThreads = 2;

double median(std::vector<double> all) {
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
  return all[all.size() / 2];
}

// Holds wall-clock times, and processor times, which other programs on the machine disturb less.
struct Times {
  std::vector<double> wall_ms, cpu_ms;

  template <typename Paint>
  void add(Paint&& paint) {
    const auto start = Clock::now();
    const std::clock_t cpu = std::clock();
    paint();
    cpu_ms.push_back(1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
    wall_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
};

// Has a name of its own for callgrind.
__attribute__((noinline)) void counted_paint(vpe::voxel::ImagePainter& painter,
                                             const core::DrawRequest& request,
                                             const std::vector<float>& range_m,
                                             std::vector<vpe::base::Rgb>& out, vpe::base::ThreadPool& pool) {
  painter.paint(request, range_m, out, {}, pool);
}

struct AppearanceCase {
  const char* name;
  core::Mode mode;
  core::Colour colour;
  double haze_m = 0;
  bool colourise = false;
  core::Shading shading = core::Shading::kGouraud;
};

}  // namespace

int main(int argc, char** argv) {
  const bool counts = argc == 5 && std::strcmp(argv[2], "count") == 0;
  const int rounds = argc > 2 && !counts ? std::atoi(argv[2]) : 7;
  if (argc < 2 || argc > 5 || rounds < 1) {
    std::fprintf(stderr,
                 "usage: painting_bench PLANET.vpe [ROUNDS [CAMERA [APPEARANCE]]]\n"
                 "       painting_bench PLANET.vpe count CAMERA APPEARANCE\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const auto planet = paging::PlanetFile::open(argv[1]);
  core::DrawRequest request;
  request.view.width = 1920;
  request.view.height = 1080;
  request.sun = mars::sun_direction({-67, -13}, 315, 35);
  const int threads = counts ? 1 : kThreads;
  vpe::base::ThreadPool pool(threads);
  const paging::Surface surface(planet, kMemory);
  const test_support::PaintedByPoint by_point(planet, kMemory);
  vpe::voxel::ImagePainter painter(planet, kMemory);
  struct CameraCase {
    const char* name;
    mars::Pose pose;
  };
  const CameraCase cameras[] = {{"Coprates from 20 km", {-67, -13, 20000, 90, -20, 0}},
                                {"Coprates from 20 km, rolled", {-67, -13, 20000, 90, -20, 40}},
                                {"Coprates from 20 km, horizon", {-67, -13, 20000, 90, 0, 0}},
                                {"Coprates from 500 km", {-67, -13, 500000, 90, -60, 0}},
                                {"the planet", {-67, -13, 1e7, 0, -90, 0}}};
  const AppearanceCase appearances[] = {
      {"lit", core::Mode::kLit, core::Colour::kNone},
      {"textured", core::Mode::kTextured, core::Colour::kNone},
      {"lit elevation", core::Mode::kColoured, core::Colour::kElevation},
      {"lit slope", core::Mode::kColoured, core::Colour::kSlope},
      {"lit aspect", core::Mode::kColoured, core::Colour::kAspect},
      {"textured, colourised", core::Mode::kTextured, core::Colour::kElevation, 0, true},
      {"textured, haze", core::Mode::kTextured, core::Colour::kNone, 150000},
      {"unlit elevation", core::Mode::kUnlit, core::Colour::kElevation},
      {"lit, image at posts", core::Mode::kColoured, core::Colour::kImage},
      {"unlit, image at posts", core::Mode::kUnlit, core::Colour::kImage},
      {"lit flat", core::Mode::kLit, core::Colour::kNone, 0, false, core::Shading::kFlat},
      {"lit flat slope", core::Mode::kColoured, core::Colour::kSlope, 0, false, core::Shading::kFlat},
      {"textured flat", core::Mode::kTextured, core::Colour::kNone, 0, false, core::Shading::kFlat}};
  const auto pixels =
      static_cast<std::size_t>(request.view.width) * static_cast<std::size_t>(request.view.height);
  std::printf("%dx%d, %d threads, median of %d rounds; off: share of pixels over 1 / over 2 of 255 apart\n",
              request.view.width, request.view.height, threads, rounds);
  const auto wanted = [&](const char* name, int argument) {
    if (argc <= argument) return true;
    return counts ? std::strcmp(name, argv[argument]) == 0 : std::strstr(name, argv[argument]) != nullptr;
  };
  for (const CameraCase& camera : cameras) {
    if (!wanted(camera.name, 3)) continue;
    request.view.camera = mars::to_camera(camera.pose, planet->radius_m());
    std::vector<float> range_m(pixels);
    if (counts) {
      // Single rays would take most of the time under callgrind.
      vpe::voxel::RangeCaster(planet, kMemory).cast(request.view, {}, pool, range_m);
    } else {
      pool.run(static_cast<std::size_t>(request.view.height), [&](std::size_t y) {
        for (int x = 0; x < request.view.width; ++x)
          range_m[y * static_cast<std::size_t>(request.view.width) + static_cast<std::size_t>(x)] =
              static_cast<float>(
                  surface.cast(request.view.camera.position_m,
                               core::pixel_ray(request.view, x + 0.5, static_cast<double>(y) + 0.5)));
      });
    }
    const auto sky = static_cast<double>(std::count(range_m.begin(), range_m.end(), core::kSkyRange));
    std::printf("%s (%.0f %% sky)\n", camera.name, 100 * sky / static_cast<double>(pixels));
    for (const AppearanceCase& appearance : appearances) {
      if (!wanted(appearance.name, 4)) continue;
      request.settings = {};
      core::DrawRequest bare_request = request;
      bare_request.settings.mode = core::Mode::kLit;
      request.settings.mode = appearance.mode;
      request.settings.colour = appearance.colour;
      request.settings.colourise = appearance.colourise;
      request.settings.shading = appearance.shading;
      request.settings.haze_visibility_m = appearance.haze_m;
      std::vector<vpe::base::Rgb> a(pixels), b(pixels);
      if (counts) {
        painter.paint(request, range_m, a, {}, pool);
        counted_paint(painter, request, range_m, a, pool);
        std::printf("  %s painted\n", appearance.name);
        continue;
      }
      Times caches, bare, ours, theirs;
      std::vector<double> of_bare;
      for (int n = 0; n <= rounds; ++n) {
        (n == 0 ? caches : bare).add([&] { painter.paint(bare_request, range_m, a, {}, pool); });
        (n == 0 ? caches : ours).add([&] { painter.paint(request, range_m, a, {}, pool); });
        if (n > 0) of_bare.push_back(ours.cpu_ms.back() / bare.cpu_ms.back());
        (n == 0 ? caches : theirs).add([&] { b = by_point.paint(request, range_m, pool); });
      }
      std::size_t one = 0, two = 0;
      for (std::size_t n = 0; n < pixels; ++n) {
        const int off =
            std::max({std::abs(a[n].r - b[n].r), std::abs(a[n].g - b[n].g), std::abs(a[n].b - b[n].b)});
        one += off > 1 ? 1 : 0;
        two += off > 2 ? 1 : 0;
      }
      const double per_pixel = 1e6 / static_cast<double>(pixels);
      std::printf(
          "  %-22s %6.1f ms, %5.1f ns a pixel of one core, %.2f of bare (%.2f..%.2f); colour_at %7.1f ms, %6.1f ns, "
          "%5.1f x; off %.4f %% / %.4f %%\n",
          appearance.name, median(ours.wall_ms), median(ours.cpu_ms) * per_pixel, median(of_bare),
          *std::min_element(of_bare.begin(), of_bare.end()), *std::max_element(of_bare.begin(), of_bare.end()),
          median(theirs.wall_ms), median(theirs.cpu_ms) * per_pixel,
          median(theirs.cpu_ms) / median(ours.cpu_ms), 100e-6 * static_cast<double>(one) * per_pixel,
          100e-6 * static_cast<double>(two) * per_pixel);
    }
  }
}
