#include "vpe/app/report/papers/relief_hills.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/report/value_noise.h"

namespace vpe::app {
namespace {

// x and y are 0 to 1 over the map.
double hill_m(double x, double y) {
  double height = 0;
  double size = 90;
  double frequency = 3;
  for (std::uint64_t octave = 0; octave < 7; ++octave) {
    height += size * report::value_noise({x * frequency, y * frequency, 0.5}, octave);
    size *= 0.45;
    frequency *= 2;
  }
  return height;
}

}  // namespace

std::shared_ptr<const relief::HeightMap> hills_map(const HillsSpec& spec) {
  std::vector<float> heights;
  const double last = spec.posts - 1;
  for (int j = 0; j < spec.posts; ++j)
    for (int i = 0; i < spec.posts; ++i)
      heights.push_back(static_cast<float>(spec.vertical_scale * hill_m(i / last, j / last)));
  if (spec.is_tapered) heights = relief::tapered(heights, spec.posts, spec.posts, spec.posts / 8);
  const double spacing_m = spec.side_m / last;
  const relief::MapLayout layout{spec.posts,       spec.posts, -spec.side_m / 2,
                                 -spec.side_m / 2, spacing_m,  spacing_m};
  return std::make_shared<relief::HeightMap>(layout, std::move(heights), spec.interpolation);
}

relief::Surface on_plane(const std::shared_ptr<const relief::HeightMap>& map) {
  return relief::parallel_surface(relief::Base::plane({0, 0, 0}, {0, 0, 1}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                  map, map->support());
}

core::View view_towards(const glm::dvec3& from_m, const glm::dvec3& at_m, int width, int height,
                        double fov_deg) {
  core::View view;
  view.camera.position_m = from_m;
  const glm::dvec3 forward = glm::normalize(at_m - from_m);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
  view.camera.axes = {right, glm::cross(right, forward), forward};
  view.width = width;
  view.height = height;
  view.fov_deg = fov_deg;
  return view;
}

core::View hills_view() { return view_towards({-560, -520, 330}, {30, 40, -40}, 512, 512, 50); }

core::RgbImage draw_relief(const relief::Surface& surface, const core::View& view,
                           const relief::CastOptions& options, base::ThreadPool& pool) {
  constexpr base::Rgb kSky{200, 215, 235};
  const relief::CastResult result = relief::cast(surface, view, options, pool);
  const glm::dvec3 sun =
      glm::normalize(view.camera.axes.up - view.camera.axes.right - 0.6 * view.camera.axes.forward);
  core::RgbImage image{result.width, result.height, {}};
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) {
      const double range_m = result.range_m[image.pixels.size()];
      if (!(range_m < relief::kNoHit)) {
        image.pixels.push_back(kSky);
        continue;
      }
      const glm::dvec3 ray = core::pixel_ray(view, x + 0.5, y + 0.5);
      const glm::dvec3 normal = surface.normal(view.camera.position_m + range_m * ray);
      const double light = 0.12 + 0.88 * std::max(0.0, glm::dot(normal, sun));
      const auto tone = [light](double full) { return static_cast<std::uint8_t>(std::lround(full * light)); };
      image.pixels.push_back({tone(235), tone(190), tone(145)});
    }
  }
  return image;
}

}  // namespace vpe::app
