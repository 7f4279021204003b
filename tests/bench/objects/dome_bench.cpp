// Measures what a dome in place of the ground saves: frames of one view with the ground, with a dome that replaces it, and with
// one that stands on it, by turns.
//   dome_bench PLANET PANORAMA [ROUNDS]     PANORAMA: by vpe panorama, of a place of PLANET, with all directions of the view
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "mars/geodesy/sun.h"
#include "panorama/metadata/open_panorama.h"
#include "vpe/app/scene/object_renderer.h"
#include "vpe/gl/context.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
namespace fs = std::filesystem;

std::string write_scene(const fs::path& folder, const std::string& name, const fs::path& panorama,
                        const std::string& more) {
  const fs::path file = folder / (name + ".scene.toml");
  std::ofstream(file) << "version = 1\n[[picture]]\nfile = \"" << fs::absolute(panorama).string()
                      << "\"\nform = \"dome\"\nradius_m = 1000\n"
                      << more;
  return file.string();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: dome_bench PLANET PANORAMA [ROUNDS]\n");
    return 2;
  }
  const auto planet = paging::PlanetFile::open(argv[1]);
  const auto viewpoint = panorama::describe(argv[2]).viewpoint;
  if (!viewpoint || !viewpoint->alt_m) {
    std::fprintf(stderr, "%s does not state its place\n", argv[2]);
    return 1;
  }
  const int rounds = argc > 3 ? std::atoi(argv[3]) : 9;
  const fs::path folder = fs::temp_directory_path() / "vpe-dome-bench";
  fs::create_directories(folder);

  core::DrawRequest request;
  request.view.camera = mars::to_camera({viewpoint->lon_deg, viewpoint->lat_deg, *viewpoint->alt_m, 20, -8, 0},
                                        planet->radius_m());
  request.view.width = 1280;
  request.view.height = 720;
  request.view.fov_deg = 55;
  request.sun = mars::sun_direction({viewpoint->lon_deg, viewpoint->lat_deg}, 120, 35);
  const std::vector<std::pair<std::string, std::string>> cases{
      {"ground", ""},
      {"dome in its place", write_scene(folder, "instead", argv[2], "replaces_ground = true\n")},
      {"dome on it", write_scene(folder, "beside", argv[2], "")}};
  const auto measure = [&](const std::string& what, core::Renderer& renderer) {
    std::vector<std::function<void()>> runs;
    for (const auto& [name, scene] : cases) {
      runs.emplace_back([&request, &renderer, file = scene] {
        request.settings.scene = file;
        (void)renderer.draw(request);
      });
    }
    for (const auto& run : runs) run();  // tiles and images are read before
    const std::vector<vpe::report::Timing> times = vpe::report::time_interleaved(runs, rounds);
    std::printf("%s\n", what.c_str());
    for (std::size_t n = 0; n < cases.size(); ++n)
      std::printf("  %-20s %8.1f ms, %.3f of the frame of ground\n", cases[n].first.c_str(),
                  1000 * times[n].median_s(), vpe::report::ratio(times[n], times[0]));
  };
  const auto rays =
      vpe::app::with_objects(vpe::voxel::make_ray_renderer(planet, {std::size_t{512} << 20, 0}), planet, {});
  for (const auto& [mode, name] : {std::pair(core::RayMode::kExact, "rays, exact"),
                                   std::pair(core::RayMode::kMultires, "rays, multires")}) {
    request.settings.ray_mode = mode;
    measure(name, *rays);
  }
  const auto triangles = vpe::app::with_objects(
      vpe::gl::make_polygon_renderer(vpe::gl::Context::create(), planet, {std::size_t{512} << 20, 0, {}}),
      planet, {});
  measure("triangles", *triangles);
  return 0;
}
