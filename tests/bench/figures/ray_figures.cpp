// Draws how the ray backend works, from its own numbers: docs/pictures/rays-*.svg,
// sticks-rays.svg and warp-gaps.svg.
//
//   vpe_ray_figures docs/pictures
//
// Builds a small planet in a temporary folder: the embedded Mars at the foot of a wall of Valles Marineris. Prints a line for
// each figure.
#include "tests/bench/figures/ray_figures.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <glm/geometric.hpp>

#include "mars/embedded/embedded.h"
#include "mars/geodesy/pose.h"
#include "paging/build/builder.h"
#include "paging/surface/section.h"
#include "tests/support/support.h"

namespace bench {

namespace {

constexpr mars::LonLat kPlace{-60.12, -13.6};
constexpr double kPosts_m = 45;
constexpr double kFine_deg = 0.12;  // half a side of the region of fine posts
constexpr std::size_t kMemory = std::size_t{1} << 27;

struct Figure {
  const char* name;
  std::string (*draw)(const Scene&, const std::string&);
};
constexpr Figure kFigures[] = {{"rays-footprint.svg", draw_footprint},
                               {"rays-column.svg", draw_column},
                               {"rays-sectors.svg", draw_sectors},
                               {"rays-hints.svg", draw_hints},
                               {"rays-discrete.svg", draw_discrete},
                               {"sticks-rays.svg", draw_sticks},
                               {"warp-gaps.svg", draw_gaps}};

Scene make_scene(const std::string& file) {
  paging::BuildOptions options;
  options.output = file;
  options.base_spacing_m = 50000;
  options.regions = {{kPlace.lon_deg - kFine_deg, kPlace.lat_deg - kFine_deg, kPlace.lon_deg + kFine_deg,
                      kPlace.lat_deg + kFine_deg}};
  options.resampling_posts = 1000;
  paging::build_planet(options, *mars::embedded_elevation({.finest_m = kPosts_m}), nullptr);
  Scene scene;
  scene.place = kPlace;
  scene.caster = std::make_unique<vpe::voxel::RangeCaster>(paging::PlanetFile::open(file), kMemory);
  scene.pool = std::make_unique<vpe::base::ThreadPool>(1);
  const lod::TileKey tile = scene.surface().at(mars::direction(kPlace)).tile;
  scene.spacing_m = lod::post_spacing_m(tile.level, scene.surface().planet().tree().shape().intervals(),
                                        scene.surface().planet_radius_m());
  return scene;
}

}  // namespace

vpe::core::View make_view(const Scene& scene, const CameraSpec& camera, int width, int height, double fov_deg) {
  const double radius_m = scene.surface().planet_radius_m();
  const double bearing_deg = std::atan2(camera.east_m, camera.north_m) / mars::kRadiansPerDegree;
  const mars::LonLat at =
      mars::destination(scene.place, bearing_deg, std::hypot(camera.east_m, camera.north_m) / radius_m);
  vpe::core::View view;
  view.width = width;
  view.height = height;
  view.fov_deg = fov_deg;
  mars::Pose pose{at.lon_deg, at.lat_deg, 0, camera.yaw_deg, camera.pitch_deg, camera.roll_deg};
  pose.alt_m = scene.surface().at(mars::direction(at)).height_m + camera.above_ground_m;
  view.camera = mars::to_camera(pose, radius_m);
  return view;
}

std::vector<float> cast_image(const Scene& scene, const vpe::core::View& view) {
  const glm::ivec2 size = vpe::core::drawn_size(view);
  std::vector<float> range_m(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  scene.caster->cast(view, {}, *scene.pool, range_m);
  return range_m;
}

SidePlane::SidePlane(const vpe::core::View& view, const glm::dvec3& ray)
    : camera_m(view.camera.position_m), up(glm::normalize(view.camera.position_m)) {
  ahead = glm::normalize(ray - glm::dot(ray, up) * up);
}

glm::dvec2 SidePlane::at(const glm::dvec3& point_m) const {
  const glm::dvec3 from_camera = point_m - camera_m;
  return {glm::dot(ahead, from_camera), glm::dot(up, from_camera)};
}

std::vector<glm::dvec2> ground_line(const paging::Surface& surface, const SidePlane& plane, double begin_m,
                                    double end_m) {
  std::vector<glm::dvec2> corners;
  paging::section(surface, plane.camera_m + begin_m * plane.ahead, plane.camera_m + end_m * plane.ahead,
                  [&](const paging::SectionPiece& piece) {
                    if (corners.empty()) corners.push_back(plane.at(piece.begin_m));
                    corners.push_back(plane.at(piece.end_m));
                  });
  return corners;
}

void draw_ground(Drawing& out, const Panel& panel, const std::vector<glm::dvec2>& ground) {
  std::vector<glm::dvec2> points;
  points.reserve(ground.size());
  for (const glm::dvec2& corner : ground) points.push_back(panel.at(corner));
  std::vector<glm::dvec2> area = points;
  area.push_back({points.back().x, panel.y_px + panel.height_px});
  area.push_back({points.front().x, panel.y_px + panel.height_px});
  out.path(area, {.fill = kSoil}, true);
  out.path(points, {.stroke = kSoilEdge, .width_px = 1.2});
}

}  // namespace bench

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: vpe_ray_figures FOLDER\n");
    return 2;
  }
  try {
    const test_support::TempDir temporary;
    const bench::Scene scene = bench::make_scene((temporary / "planet.vpe").string());
    const std::string folder = std::string(argv[1]) + "/";
    // A figure that the ground here does not show any more leaves the others alone.
    bool is_complete = true;
    for (const bench::Figure& figure : bench::kFigures) {
      try {
        std::printf("%s: %s\n", figure.name, figure.draw(scene, folder + figure.name).c_str());
      } catch (const std::exception& error) {
        std::fprintf(stderr, "vpe_ray_figures: %s: %s\n", figure.name, error.what());
        is_complete = false;
      }
    }
    return is_complete ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vpe_ray_figures: %s\n", error.what());
    return 1;
  }
}
