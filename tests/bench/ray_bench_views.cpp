#include "tests/bench/ray_bench_views.h"

#include <algorithm>
#include <cmath>

#include "paging/surface/surface.h"

namespace bench {

namespace {

constexpr double kYaw_deg = 30;
constexpr double kAcross_deg = 60;

struct CameraHeight {
  const char* name;
  double height_m;
};
constexpr CameraHeight kCameras[] = {{"2m", 2}, {"1km", 1e3}, {"10km", 1e4}, {"300km", 3e5}};

}  // namespace

std::vector<RayCase> ray_cases(const RayScene& scene, double scale) {
  const paging::Surface surface(scene.planet, std::size_t{64} << 20);
  const mars::LonLat place = mars::lon_lat(scene.middle);
  const double ground_m = surface.at(scene.middle).height_m;
  const bool whole_planet = scene.name == "mars";
  std::vector<RayCase> cases;
  const auto add = [&](std::string name, const CameraHeight& camera, double pitch_deg, double roll_deg,
                       int width, int height) {
    RayCase& c = cases.emplace_back();
    c.name = scene.name + "/" + std::move(name) + "/" + camera.name;
    c.view.camera = mars::to_camera(
        {place.lon_deg, place.lat_deg, ground_m + camera.height_m, kYaw_deg, pitch_deg, roll_deg},
        surface.planet_radius_m());
    c.view.width = std::max(1, static_cast<int>(std::lround(scale * width)));
    c.view.height = std::max(1, static_cast<int>(std::lround(scale * height)));
    c.view.fov_deg = 2.0 / mars::kRadiansPerDegree *
                     std::atan(std::tan(0.5 * kAcross_deg * mars::kRadiansPerDegree) * height / width);
  };
  for (const CameraHeight& camera : kCameras) {
    if (whole_planet && camera.height_m < 1e5) continue;
    add("pano", camera, 0, 0, 6000, 2000);
    cases.back().view.projection = vpe::core::Projection::kCylinder;
    cases.back().view.fov_deg = kAcross_deg;
    if (!whole_planet && camera.height_m != 1e3) continue;
    add("wan", camera, -30, 0, 500, 400);
    for (const auto& [name, pitch_deg] :
         {std::pair{"p05", -0.5}, {"p10", -10.0}, {"p30", -30.0}, {"p60", -60.0}, {"p90", -90.0}}) {
      for (const int roll_deg : {0, 15, 45})
        add(std::string(name) + "/r" + std::to_string(roll_deg), camera, pitch_deg, roll_deg, 1920, 1080);
    }
  }
  return cases;
}

}  // namespace bench
