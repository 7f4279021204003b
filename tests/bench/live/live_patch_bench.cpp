// Time of patches that are made in memory, and of frames of animated ground against frames of still ground.
// docs/measurements/patches.md has the figures.
//
//   live_patch_bench PLANET.vpe LON LAT [POSTS] [WIDTHxHEIGHT] [FRAMES]
//
// A pad of POSTS x POSTS posts (default 513) with the spacing of the planet's finest ground there lies at the place. Its
// height differs from frame to frame.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "mars/geodesy/sun.h"
#include "paging/live/relief_patch.h"
#include "paging/planet/planet_user.h"
#include "paging/surface/surface.h"
#include "vpe/base/quantile.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

using Clock = std::chrono::steady_clock;
using Planet = std::shared_ptr<const paging::PlanetFile>;

constexpr std::size_t kMemory = std::size_t{512} << 20;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double median(std::vector<double> values) { return vpe::base::quantile_round(values, 0.5); }

struct Scene {
  mars::LonLat place;
  double spacing_m = 0;
  double pad_m = 0;  // its side
  int width = 1280;
  int height = 720;
  int frames = 30;
};

std::vector<relief::ReliefSpec> pad(const Scene& scene, double height_m) {
  relief::ReliefSpec spec;
  spec.kind = relief::ReliefKind::kPad;
  spec.place = scene.place;
  spec.length_m = 0.8 * scene.pad_m;
  spec.width_m = 0.8 * scene.pad_m;
  spec.falloff_m = 0.1 * scene.pad_m;
  spec.rise_m = height_m;
  spec.spacing_m = scene.spacing_m;
  return {spec};
}

vpe::core::DrawRequest request_of(const Scene& scene, const Planet& planet) {
  vpe::core::DrawRequest request;
  const paging::Surface surface(planet, std::size_t{1} << 24);
  const double ground_m = surface.at(mars::direction(scene.place)).height_m;
  const double away_deg = 1.2 * scene.pad_m / planet->radius_m() / mars::kRadiansPerDegree;
  request.view.camera = mars::to_camera(
      {scene.place.lon_deg, scene.place.lat_deg - away_deg, ground_m + 0.5 * scene.pad_m, 0, -25, 0},
      planet->radius_m());
  request.view.width = scene.width;
  request.view.height = scene.height;
  request.view.fov_deg = 60;
  request.sun = mars::sun_direction(scene.place, 315, 40);
  return request;
}

void time_patches(const paging::ReliefPatcher& patcher, const Scene& scene, bool full_grids) {
  paging::MadePatch made;
  std::vector<double> make_ms;
  for (int n = 0; n < 6; ++n) {
    const auto begin = Clock::now();
    patcher.with(pad(scene, 0.02 * scene.pad_m + n), {.full_grids = full_grids}, &made);
    make_ms.push_back(ms_since(begin));
    if (!full_grids && n == 1) break;
  }
  std::printf("%-12s first %8.1f ms, then %8.1f ms: %lld finest tiles, %lld tiles\n",
              full_grids ? "full grids" : "meshes", make_ms.front(),
              median({make_ms.begin() + 1, make_ms.end()}), static_cast<long long>(made.finest_tiles),
              static_cast<long long>(made.tiles));
}

void time_frames(const char* name, vpe::core::Renderer& draw, const paging::ReliefPatcher& patcher,
                 const Scene& scene) {
  const paging::PatchOptions options{.full_grids = true};
  const Planet still = patcher.with(pad(scene, 0.02 * scene.pad_m), options);
  const vpe::core::DrawRequest request = request_of(scene, patcher.base());
  draw.draw(request);  // of the planet, complete
  const auto begin = Clock::now();
  paging::change_planet(draw, patcher.with(pad(scene, 0.02 * scene.pad_m), options));
  draw.draw(request);
  const double first_ms = ms_since(begin);
  std::vector<double> still_ms;
  std::vector<double> animated_ms;
  std::vector<double> patch_ms;
  for (int n = 0; n < scene.frames; ++n) {
    // Turned by turns, so that nothing is drawn from the image before.
    vpe::core::DrawRequest other = request;
    other.view.fov_deg += 0.01 * (n % 7);
    auto at = Clock::now();
    draw.draw(other);
    still_ms.push_back(ms_since(at));
    at = Clock::now();
    const Planet next = patcher.with(pad(scene, 0.02 * scene.pad_m + 0.5 * n), options);
    patch_ms.push_back(ms_since(at));
    paging::change_planet(draw, next);
    draw.draw(other);
    animated_ms.push_back(ms_since(at));
  }
  std::printf("%-12s first image %7.1f ms, still %7.1f ms, animated %7.1f ms (patch %6.1f): %.2f of the rate\n",
              name, first_ms, median(still_ms), median(animated_ms), median(patch_ms),
              median(still_ms) / median(animated_ms));
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) {
    std::fprintf(stderr, "live_patch_bench PLANET.vpe LON LAT [POSTS] [WIDTHxHEIGHT] [FRAMES]\n");
    return 2;
  }
  const Planet planet = paging::PlanetFile::open(arguments[1]);
  Scene scene;
  scene.place = {std::atof(arguments[2]), std::atof(arguments[3])};
  const lod::TileInfo& tile =
      planet->tree().deepest(lod::tile_at(mars::chart_point(mars::direction(scene.place)), lod::kMaxLevel));
  scene.spacing_m =
      lod::post_spacing_m(tile.key.level, planet->meta().tile.intervals(), planet->radius_m()) * 1.001;
  scene.pad_m = (count > 4 ? std::atof(arguments[4]) : 513) * scene.spacing_m;
  if (count > 5) std::sscanf(arguments[5], "%dx%d", &scene.width, &scene.height);
  if (count > 6) scene.frames = std::atoi(arguments[6]);
  std::printf("pad of %.0f m, posts %.1f m apart, on a planet of %zu tiles\n", scene.pad_m, scene.spacing_m,
              planet->tree().size());
  const paging::ReliefPatcher patcher(planet);
  time_patches(patcher, scene, true);
  time_patches(patcher, scene, false);
  const std::shared_ptr<vpe::gl::Context> context = vpe::gl::Context::create();
  const auto polygons = vpe::gl::make_polygon_renderer(context, planet, {kMemory, 2, {}});
  time_frames("triangles", *polygons, patcher, scene);
  const auto rays = vpe::voxel::make_ray_renderer(planet, {kMemory, 2});
  time_frames("rays", *rays, patcher, scene);
  return 0;
}
