// Compares the discrete caster (Cohen-Or 1996) with exact casts over the same tiles, its time at several pixel-to-voxel ratios, and
// several rays a pixel with one: casts alone, and whole images.
//
// docs/measurements/rays.md has the figures.
//
//   discrete_bench DIR [ROUNDS]
//
// DIR holds the planets of ray_bench, or receives them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "mars/geodesy/sun.h"
#include "tests/bench/compare_rounds.h"
#include "tests/bench/ray_bench_scenes.h"
#include "vpe/base/parallel.h"
#include "vpe/voxel/cast/range_caster.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

using vpe::core::DrawRequest;
using vpe::core::View;
using vpe::voxel::RangeCaster;
using vpe::voxel::RangeOptions;

RangeOptions discrete(double ratio, int rays = 1, bool blends = false) {
  RangeOptions options;
  options.method = RangeOptions::Method::kDiscrete;
  options.cell_px = ratio;
  options.discrete.rays = rays;
  options.discrete.blends = blends;
  return options;
}

struct NamedView {
  std::string name;
  View view;
};

std::vector<NamedView> views(const bench::RayScene& scene, const RangeCaster& caster) {
  const double radius = caster.surface().planet_radius_m();
  const mars::LonLat place = mars::lon_lat(scene.middle);
  const double ground = caster.surface().at(scene.middle).height_m;
  std::vector<NamedView> out;
  const auto add = [&](const char* name, int width, int height, double fov_deg, double pitch_deg,
                       double above_m = 1000) {
    View v;
    v.width = width;
    v.height = height;
    v.fov_deg = fov_deg;
    v.camera = mars::to_camera({place.lon_deg, place.lat_deg, ground + above_m, 22.5, pitch_deg, 0}, radius);
    out.push_back({name, v});
  };
  add("500x400, -30", 500, 400, 60, -30);
  add("1920x1080, -10", 1920, 1080, 36, -10);
  add("1920x1080, -45", 1920, 1080, 36, -45);
  // Voxels are narrower than pixels from here on.
  add("500x400, -80 from 60 km", 500, 400, 30, -80, 60000);
  add("cylinder 6000x2000", 6000, 2000, 60, 0);
  out.back().view.projection = vpe::core::Projection::kCylinder;
  return out;
}

// Prints how far pixels are off those of exact casts.
void differences(const std::string& name, const View& view, RangeCaster& caster, vpe::base::ThreadPool& pool) {
  const auto pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  std::vector<float> exact(pixels);
  std::vector<float> seen(pixels);
  caster.cast(view, {}, pool, exact);
  caster.cast(view, discrete(0), pool, seen);
  std::size_t over_a_row = 0;
  const auto width = static_cast<std::size_t>(view.width);
  for (std::size_t k = width; k + width < pixels; ++k) {
    // Between the ranges of the rows above and below in the exact image.
    const auto [low, high] = std::minmax({exact[k - width], exact[k], exact[k + width]});
    if (seen[k] < low * (1 - 1e-6F) || seen[k] > high * (1 + 1e-6F)) ++over_a_row;
  }
  std::printf("%s: %.2f %% of pixels over a row off\n", name.c_str(),
              100.0 * static_cast<double>(over_a_row) / static_cast<double>(pixels));
}

void run(const std::string& dir, int rounds) {
  vpe::base::ThreadPool pool(1);
  for (const bench::PatchSpec& spec : bench::patch_specs()) {
    if (spec.name != "2049") continue;
    const bench::RayScene scene = bench::patch_scene(spec, dir, 2);
    RangeCaster caster(scene.planet, std::size_t{3} << 30);
    const std::vector<NamedView> all = views(scene, caster);
    for (const NamedView& v : all) differences(spec.name + ", " + v.name, v.view, caster, pool);
    std::printf("| %s, casts, 1 thread | ms | ratio of times (lowest..highest) |\n|---|---|---|\n",
                spec.name.c_str());
    std::vector<float> out(std::size_t{6000} * 2000 * 4);
    for (const NamedView& v : all) {
      const auto pixels = static_cast<std::size_t>(v.view.width) * static_cast<std::size_t>(v.view.height);
      const auto cast = [&](const RangeOptions& options) {
        return [&, options] {
          const std::size_t rays = options.method == RangeOptions::Method::kDiscrete
                                       ? static_cast<std::size_t>(options.discrete.rays)
                                       : 1;
          caster.cast(v.view, options, pool, std::span<float>(out).first(pixels * rays));
        };
      };
      bench::compare_rounds(v.name + ": exact; discrete, finest tiles", cast({}), cast(discrete(0)), rounds);
      bench::compare_rounds(v.name + ": multires 1; discrete 1", cast({1, 1}), cast(discrete(1)), rounds);
      for (const double ratio : {0.25, 0.5, 2.0, 4.0, 8.0})
        bench::compare_rounds(v.name + ": ratio 1; " + std::to_string(ratio), cast(discrete(1)),
                              cast(discrete(ratio)), rounds);
      bench::compare_rounds(v.name + ": 1 ray; 4 rays", cast(discrete(1)), cast(discrete(1, 4)), rounds);
      bench::compare_rounds(v.name + ": sharp; blended", cast(discrete(1)), cast(discrete(1, 1, true)), rounds);
    }
    std::printf("| %s, images, 1 thread | ms | ratio of times (lowest..highest) |\n|---|---|---|\n",
                spec.name.c_str());
    const auto renderer = vpe::voxel::make_ray_renderer(scene.planet, {std::size_t{3} << 30, 1});
    for (const NamedView& v : all) {
      const auto draw = [&](vpe::core::RayMode mode, int vertical, bool blends, int samples) {
        return [&, mode, vertical, blends, samples] {
          DrawRequest request;
          request.view = v.view;
          request.settings.ray_mode = mode;
          request.settings.ray_vertical = vertical;
          request.settings.ray_blend = blends;
          request.settings.samples = samples;
          request.settings.mode = vpe::core::Mode::kColoured;
          request.sun = mars::sun_direction(mars::lon_lat(scene.middle), 315, 40);
          renderer->draw(request);
        };
      };
      using Mode = vpe::core::RayMode;
      bench::compare_rounds(v.name + ": exact; discrete", draw(Mode::kExact, 1, false, 1),
                            draw(Mode::kDiscrete, 1, false, 1), rounds);
      bench::compare_rounds(v.name + ": 1 ray; 4 rays", draw(Mode::kDiscrete, 1, false, 1),
                            draw(Mode::kDiscrete, 4, false, 1), rounds);
      bench::compare_rounds(v.name + ": exact, 1 sample; 4 samples", draw(Mode::kExact, 1, false, 1),
                            draw(Mode::kExact, 1, false, 4), rounds);
      bench::compare_rounds(v.name + ": sharp; blended", draw(Mode::kDiscrete, 1, false, 1),
                            draw(Mode::kDiscrete, 1, true, 1), rounds);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "discrete_bench DIR [ROUNDS]\n");
    return 2;
  }
  try {
    run(argv[1], argc > 2 ? std::atoi(argv[2]) : 9);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "discrete_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
