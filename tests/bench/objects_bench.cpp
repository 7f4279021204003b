// Measures what objects cost: frames of one view without and with them, by turns.
//   objects_bench PLANET LON,LAT [ROUNDS [volumes]]      e.g. /tmp/gale.vpe 137.4415,-4.5895
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "mars/geodesy/sun.h"
#include "objects/model/shapes.h"
#include "paging/surface/surface.h"
#include "vpe/app/scene/object_renderer.h"
#include "vpe/gl/context.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
namespace fs = std::filesystem;

void write_obj(const objects::Mesh& mesh, const fs::path& file) {
  std::ofstream out(file);
  for (const glm::vec3& p : mesh.positions_m) out << "v " << -p.x << ' ' << p.z << ' ' << p.y << '\n';
  for (const glm::uvec3& t : mesh.triangles) out << "f " << t.x + 1 << ' ' << t.y + 1 << ' ' << t.z + 1 << '\n';
}

constexpr double kMetre_deg = 1.0 / 59274.7;  // of latitude on Mars

struct Scenes {
  fs::path folder = fs::temp_directory_path() / "vpe-objects-bench";
  double lon_deg = 0;
  double lat_deg = 0;

  fs::path write(const std::string& name, const std::string& objects) const {
    const fs::path file = folder / (name + ".scene.toml");
    std::ofstream(file) << "version = 1\n[[model]]\nname = \"fine\"\nfile = \"fine.obj\"\n"
                           "[[model]]\nname = \"coarse\"\nfile = \"coarse.obj\"\n"
                        << objects;
    return file;
  }
  std::string polygon(double west_m, double south_m, double east_m, double north_m) const {
    char text[200];
    std::snprintf(text, sizeof text, "[[%.8f, %.8f], [%.8f, %.8f], [%.8f, %.8f], [%.8f, %.8f]]",
                  lon_deg + west_m * kMetre_deg, lat_deg + south_m * kMetre_deg, lon_deg + east_m * kMetre_deg,
                  lat_deg + south_m * kMetre_deg, lon_deg + east_m * kMetre_deg, lat_deg + north_m * kMetre_deg,
                  lon_deg + west_m * kMetre_deg, lat_deg + north_m * kMetre_deg);
    return text;
  }
  // A dust devil north of the camera; its image is 1.2 times as high as its height over its distance, in frames.
  std::string devil(double height_m, double distance_m) const {
    char text[400];
    std::snprintf(text, sizeof text,
                  "[[volume]]\nname = \"devil\"\nkind = \"dust-devil\"\nheight_m = %g\nradius_m = %g\n"
                  "[[object]]\nmodel = \"devil\"\nlon = %.8f\nlat = %.8f\n",
                  height_m, height_m / 6, lon_deg, lat_deg + distance_m * kMetre_deg);
    return text;
  }
  // A row of `count` objects in rows of 40, from 20 m north of the camera on, `step_m` apart.
  std::string rows(const std::string& model, int count, double scale, double first_m, double step_m) const {
    std::string text = "[[object]]\nmodel = \"" + model + "\"\nscale = " + std::to_string(scale) + "\nat = [";
    for (int n = 0; n < count; ++n) {
      char place[80];
      std::snprintf(place, sizeof place, "[%.8f, %.8f, %d],", lon_deg + (n % 40 - 19.5) * step_m * kMetre_deg,
                    lat_deg + (first_m + n / 40 * step_m) * kMetre_deg, n * 37 % 360);
      text += place;
    }
    return text + "]\n";
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: objects_bench PLANET LON,LAT [ROUNDS [volumes]]\n");
    return 2;
  }
  const auto planet = paging::PlanetFile::open(argv[1]);
  Scenes scenes;
  if (std::sscanf(argv[2], "%lf,%lf", &scenes.lon_deg, &scenes.lat_deg) != 2) return 2;
  const int rounds = argc > 3 ? std::atoi(argv[3]) : 9;
  fs::create_directories(scenes.folder);
  write_obj(objects::make_rock(3, 5), scenes.folder / "fine.obj");
  write_obj(objects::make_rock(3, 0), scenes.folder / "coarse.obj");
  std::printf("models: %zu and %zu triangles\n", objects::make_rock(3, 5).triangles.size(),
              objects::make_rock(3, 0).triangles.size());

  core::DrawRequest request;
  const double ground_m =
      paging::Surface(planet, 1 << 20).at(mars::direction({scenes.lon_deg, scenes.lat_deg})).height_m;
  request.view.camera =
      mars::to_camera({scenes.lon_deg, scenes.lat_deg, ground_m + 6, 0, -8, 0}, planet->radius_m());
  request.view.width = 1280;
  request.view.height = 720;
  request.view.fov_deg = 55;
  request.sun = mars::sun_direction({scenes.lon_deg, scenes.lat_deg}, 120, 35);

  struct Case {
    std::string name;
    std::string scene;
  };
  const std::string rocks =
      "[[scatter]]\nmodels = [\"fine\"]\npolygon = " + scenes.polygon(-150, 0, 150, 300) +
      "\ndensity_per_m2 = 1.1112\nexponent = 2.5\ndiameter_m = [0.05, 2]\ntumble = true\n";
  std::vector<Case> cases{
      {"no objects", ""},
      {"1000 replicas of the fine one, 1 m, 8 m apart",
       scenes.write("thousand", scenes.rows("fine", 1000, 1, 20, 8))},
      {"1000 replicas of the fine one, 1 m, 2 m apart",
       scenes.write("dense", scenes.rows("fine", 1000, 1, 12, 2))},
      {"100 000 rocks", scenes.write("rocks", rocks)},
      {"1000 fine ones of some pixels", scenes.write("far-fine", scenes.rows("fine", 1000, 0.5, 60, 3))},
      {"1000 coarse ones of some pixels", scenes.write("far-coarse", scenes.rows("coarse", 1000, 0.5, 60, 3))},
  };
  const bool is_of_volumes = argc > 4 && std::string(argv[4]) == "volumes";
  if (is_of_volumes) {
    cases = {{"no objects", ""},
             {"one rock", scenes.write("rock", scenes.rows("fine", 1, 0.3, 30, 1))},
             {"a dust devil of a sixth of the height", scenes.write("devil-far", scenes.devil(45, 320))},
             {"a dust devil of two thirds of the height", scenes.write("devil", scenes.devil(45, 80))},
             {"a camera in a dust devil", scenes.write("devil-around", scenes.devil(45, 2))}};
  }
  const auto measure = [&](const std::string& what, core::Renderer& renderer) {
    std::vector<std::function<void()>> runs;
    std::vector<core::Certificate> said(cases.size());
    for (std::size_t n = 0; n < cases.size(); ++n) {
      runs.emplace_back([&, n] {
        request.settings.scene = cases[n].scene;
        said[n] = renderer.draw(request).certificate;
      });
    }
    const std::vector<vpe::report::Timing> times = vpe::report::time_interleaved(runs, rounds);
    std::printf("%s\n", what.c_str());
    for (std::size_t n = 0; n < cases.size(); ++n) {
      std::printf("  %-48s %8.1f ms, %.3f of the frame without; %lld objects show\n", cases[n].name.c_str(),
                  1000 * times[n].median_s(), vpe::report::ratio(times[n], times[0]),
                  said[n].objects ? static_cast<long long>(said[n].objects->drawn) : 0LL);
    }
    if (is_of_volumes) {
      for (std::size_t n = 2; n < cases.size(); ++n)
        std::printf("  %-48s %.3f of that with one rock\n", cases[n].name.c_str(),
                    vpe::report::ratio(times[n], times[1]));
    }
    if (!is_of_volumes)
      std::printf("  fine over coarse at some pixels: %.3f\n", vpe::report::ratio(times[4], times[5]));
  };
  const auto rays =
      vpe::app::with_objects(vpe::voxel::make_ray_renderer(planet, {std::size_t{512} << 20, 0}), planet, {});
  request.settings.ray_mode = core::RayMode::kMultires;
  measure("rays, multires", *rays);
  const auto triangles = vpe::app::with_objects(
      vpe::gl::make_polygon_renderer(vpe::gl::Context::create(), planet, {std::size_t{512} << 20, 0, {}}),
      planet, {});
  measure("triangles", *triangles);
  return 0;
}
