// Compares images that are carried from another one (vpe/warp) with images that are drawn in full by rays: processor time of
// a pixel, and what is left to draw. The first image has the margin that the other view asks for. docs/measurements/carrying.md has the figures.
//
//   carry_bench PLANET [ROUNDS [SIZE [MOST_ADDED_PX [CASE]]]]
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sun.h"
#include "paging/planet/planet_file.h"
#include "paging/surface/distance.h"
#include "paging/surface/surface.h"
#include "vpe/app/picture/carried_drawer.h"
#include "vpe/core/margin.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/report/processor_time.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
namespace warp = vpe::warp;

struct Case {
  const char* what;
  mars::Pose from;
  mars::Pose to;
};

core::DrawRequest request_for(const mars::Pose& pose, double radius_m, int width, int height) {
  core::DrawRequest request;
  request.view.camera = mars::to_camera(pose, radius_m);
  request.view.width = width;
  request.view.height = height;
  request.view.fov_deg = 50;
  request.settings.mode = core::Mode::kColoured;
  request.sun = mars::sun_direction({pose.lon_deg, pose.lat_deg}, 315, 35);
  request.want_range = true;
  return request;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 6) {
    std::fprintf(stderr, "usage: carry_bench PLANET [ROUNDS [SIZE [MOST_ADDED_PX [CASE]]]]\n");
    return 2;
  }
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 7;
  const int width = argc > 3 ? std::atoi(argv[3]) : 1280;
  const int height = width * 9 / 16;
  const double most_added_px = argc > 4 ? std::atof(argv[4]) : 0.5;
  const auto planet = paging::PlanetFile::open(argv[1]);
  const double radius_m = planet->radius_m();
  paging::Surface surface(planet, std::size_t{64} << 20);
  const auto above = [&](double lon, double lat, double height_m, double yaw, double pitch, double roll = 0) {
    return mars::Pose{lon, lat,   surface.at(mars::direction({lon, lat}), 1).height_m + height_m,
                      yaw, pitch, roll};
  };
  const std::vector<Case> cases{
      {"turn by 1 degree", above(-59.2, -13.7, 2000, 90, -10), above(-59.2, -13.7, 2000, 91, -10)},
      {"a hundredth of the height ahead", above(-59.2, -13.7, 2000, 90, -10),
       above(-59.1997, -13.7, 2000, 90, -10)},
      {"a tenth of the height ahead, 2 degrees", above(-59.2, -13.7, 2000, 90, -10),
       above(-59.1966, -13.7, 2000, 92, -11, 1)},
      {"down, a tenth of the height aside", above(-59.2, -13.7, 20000, 0, -85),
       above(-59.166, -13.7, 20000, 0, -85)},
      {"globe, 1 degree on", {-60, 0, 6e6, 0, -90, 0}, {-61, 0, 6e6, 0, -90, 0}}};
  const auto rays = vpe::voxel::make_ray_renderer(planet, {std::size_t{1} << 30, 1});
  const double pixels = static_cast<double>(width) * height;
  std::printf("%d x %d, one thread, at most %.2f px added\n\n", width, height, most_added_px);
  std::printf("| motion | full, ns a pixel | carrying | with what is drawn | of full | open | added, px |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  const int only = argc > 5 ? std::atoi(argv[5]) : -1;
  for (const Case& one : cases) {
    if (only >= 0 && &one != &cases[static_cast<std::size_t>(only)]) continue;
    const core::DrawRequest from = request_for(one.from, radius_m, width, height);
    const core::DrawRequest to = request_for(one.to, radius_m, width, height);
    vpe::app::CarriedDrawer drawer(
        *rays, planet, {.most_added_px = most_added_px, .memory_bytes = std::size_t{64} << 20, .threads = 1});
    const std::vector<core::View> others{to.view};
    const glm::ivec2 margin_px = core::margin_for(from.view, others, 2000, {width / 8, height / 8});
    core::DrawRequest wide = from;
    wide.view = core::with_margin(from.view, margin_px);
    drawer.draw_first(from, margin_px);
    const core::Frame frame = rays->draw(wide).frame;
    warp::CarryOptions options;
    options.most_added_px = static_cast<float>(most_added_px);
    options.nearest_m = 0.95 * paging::distance_to_ground_m(surface, to.view.camera.position_m, 1);
    vpe::base::ThreadPool pool(1);
    warp::Carrier carrier;
    warp::CarriedImage carried;
    const std::vector<std::function<void()>> runs{
        [&] { (void)rays->draw(to); },
        [&] { carrier.carry(wide.view, frame, to.view, options, pool, carried); },
        [&] { (void)drawer.draw_carried(to); }};
    const auto timings = vpe::report::time_interleaved(runs, rounds, vpe::report::processor_s);
    const auto ns = [&](std::size_t n) { return 1e9 * timings[n].median_s() / pixels; };
    std::printf("| %s | %.1f | %.1f | %.1f | %.2f | %.2f %% | %.3f |\n", one.what, ns(0), ns(1), ns(2),
                vpe::report::ratio(timings[2], timings[0]),
                100 * static_cast<double>(carried.count(warp::Origin::kOpen)) / pixels, carried.added_px);
    std::fflush(stdout);
  }
  return 0;
}
