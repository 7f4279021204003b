// Draws frames without objects by rays, by the renderer alone or by the one that also draws objects, to count the
// instructions of a frame that has none:
//   valgrind --tool=callgrind build/release/tests/bench/objects_absent PLANET LON,LAT alone|objects FRAMES
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "mars/geodesy/sun.h"
#include "paging/surface/surface.h"
#include "vpe/app/scene/object_renderer.h"
#include "vpe/voxel/ray_renderer.h"

int main(int argc, char** argv) {
  namespace core = vpe::core;
  double lon_deg = 0;
  double lat_deg = 0;
  const std::string kind = argc > 3 ? argv[3] : "";
  if (argc != 5 || std::sscanf(argv[2], "%lf,%lf", &lon_deg, &lat_deg) != 2 ||
      (kind != "alone" && kind != "objects")) {
    std::fprintf(stderr, "usage: objects_absent PLANET LON,LAT alone|objects FRAMES\n");
    return 2;
  }
  const auto planet = paging::PlanetFile::open(argv[1]);
  const double ground_m = paging::Surface(planet, 1 << 20).at(mars::direction({lon_deg, lat_deg})).height_m;
  core::DrawRequest request;
  request.view.camera = mars::to_camera({lon_deg, lat_deg, ground_m + 6, 0, -8, 0}, planet->radius_m());
  request.view.width = 320;
  request.view.height = 180;
  request.sun = mars::sun_direction({lon_deg, lat_deg}, 120, 35);
  request.settings.ray_mode = core::RayMode::kMultires;
  std::unique_ptr<core::PixelRenderer> renderer =
      vpe::voxel::make_ray_renderer(planet, {std::size_t{256} << 20, 1});
  if (kind == "objects") renderer = vpe::app::with_objects(std::move(renderer), planet, {});
  double sum = 0;
  for (int n = std::atoi(argv[4]); n > 0; --n) {
    const core::DrawResult result = renderer->draw(request);
    sum += result.frame.colour.front().r;
  }
  std::printf("%s %.0f\n", kind.c_str(), sum);
  return 0;
}
