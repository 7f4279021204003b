// Compares foveated images (rays.fovea) with uniform ones: processor time of whole images, cast and painted, and the
// bound of the error in the middle. docs/measurements/rays.md has the figures.
//
//   fovea_bench DIR [ROUNDS [SHARE]]
//
// DIR holds the planets of ray_bench, or receives them.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sun.h"
#include "tests/bench/ray_bench_scenes.h"
#include "vpe/report/processor_time.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Timed {
  double processor_s = 0;
  core::Certificate certificate;
};

Timed once(core::Renderer& renderer, const core::DrawRequest& request) {
  const double start_s = vpe::report::processor_s();
  const core::DrawResult result = renderer.draw(request);
  return {vpe::report::processor_s() - start_s, result.certificate};
}

core::DrawRequest request_for(const bench::RayScene& scene, double height_m, double pitch_deg,
                              double roll_deg) {
  core::DrawRequest request;
  const double radius_m = scene.planet->radius_m();
  const mars::LonLat place = mars::lon_lat(scene.middle);
  const double ground_m = paging::Surface(scene.planet, std::size_t{8} << 20).at(scene.middle).height_m;
  request.view.camera =
      mars::to_camera({place.lon_deg, place.lat_deg, ground_m + height_m, 22.5, pitch_deg, roll_deg}, radius_m);
  request.view.width = 1920;
  request.view.height = 1080;
  request.view.fov_deg = 45;
  request.settings.mode = core::Mode::kColoured;
  request.settings.ray_mode = core::RayMode::kMultires;
  request.sun = mars::sun_direction(place, 315, 35);
  return request;
}

// Rounds alternate; the first one loads and does not count.
void compare(const bench::RayScene& scene, core::Renderer& renderer, double share, int rounds) {
  std::printf("| view | processor time, ms | foveated : uniform (lowest..highest) | middle, px | all, px |\n");
  std::printf("|---|---|---|---|---|\n");
  struct Pose {
    double height_m;
    double pitch_deg;
    double roll_deg;
  };
  for (const Pose& pose : {Pose{1000, -10, 0}, Pose{1000, -10, 30}, Pose{1000, -45, 0}, Pose{1000, -85, 0},
                           Pose{10000, -20, 0}, Pose{2, 0, 0}}) {
    const core::DrawRequest uniform = request_for(scene, pose.height_m, pose.pitch_deg, pose.roll_deg);
    core::DrawRequest foveated = uniform;
    foveated.settings.ray_fovea = share;
    std::vector<double> times_s;
    std::vector<double> ratios;
    Timed of_uniform;
    Timed of_foveated;
    for (int r = 0; r <= rounds; ++r) {
      of_uniform = once(renderer, uniform);
      of_foveated = once(renderer, foveated);
      if (r == 0) continue;
      times_s.push_back(of_uniform.processor_s);
      ratios.push_back(of_foveated.processor_s / of_uniform.processor_s);
    }
    const auto [low, high] = std::minmax_element(ratios.begin(), ratios.end());
    std::printf("| %g m up, pitch %g, roll %g | %.0f | %.2f (%.2f..%.2f) | %.3f of %.3f | %.2f |\n",
                pose.height_m, pose.pitch_deg, pose.roll_deg, 1e3 * median(times_s), median(ratios), *low,
                *high, of_foveated.certificate.middle_bound_px.value_or(0),
                of_uniform.certificate.shift_bound_px, of_foveated.certificate.shift_bound_px);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    std::fprintf(stderr, "usage: fovea_bench DIR [ROUNDS [SHARE]]\n");
    return 2;
  }
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 5;
  const double share = argc > 3 ? std::atof(argv[3]) : 1.0 / 3;
  for (const bench::PatchSpec& spec : bench::patch_specs()) {
    if (spec.name != "2049") continue;
    const bench::RayScene scene = bench::patch_scene(spec, argv[1], 2);
    const auto renderer = vpe::voxel::make_ray_renderer(scene.planet, {std::size_t{1} << 30, 1});
    compare(scene, *renderer, share, rounds);
  }
  return 0;
}
