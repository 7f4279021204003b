// Measures whether terrain stands still while the camera moves by a millimetre a frame.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "tests/paging/planet_fixture.h"
#include "vpe/core/view.h"

namespace test_support {

inline constexpr double kJitterBound_px = 0.05;

// Describes bumps 0.15 m high and a few metres wide over hills, with posts half a metre apart around a place.
struct FinePlace {
  explicit FinePlace(mars::LonLat place) : at(place), frame(mars::local_frame(place)) {}

  double height_m(const glm::dvec3& d) const {
    const glm::dvec3 off = (d - frame.up) * mars::kMarsRadius_m;
    const double east_m = glm::dot(off, frame.east);
    const double north_m = glm::dot(off, frame.north);
    if (std::hypot(east_m, north_m) > 300) return bumpy_height(d);
    return bumpy_height(d) + 0.15 * std::sin(east_m / 1.1) * std::cos(north_m / 1.7) +
           0.02 * std::sin(3 * east_m + north_m);
  }
  std::shared_ptr<const paging::PlanetFile> build(const std::filesystem::path& path) const {
    const FakeElevation source([this](const glm::dvec3& d) { return height_m(d); },
                               fine_around(frame.up, 15.0 / mars::kMarsRadius_m, 0.5));
    paging::BuildOptions options;
    options.output = path.string();
    options.tile_k = 5;
    options.base_spacing_m = 200000;
    options.quantum_m = 1.0 / 4096;
    options.threads = 2;
    options.resampling_posts = 1000;
    paging::build_planet(options, source, nullptr);
    return paging::PlanetFile::open(path.string());
  }

  mars::LonLat at;
  mars::LocalFrame frame;
};

// Returns a view from a metre over the ground, a millimetre further each frame: a part of an image of 1280 x
// 720.
inline vpe::core::View millimetre_view(const FinePlace& place, const paging::Surface& surface, double yaw_deg,
                                       int frame) {
  const mars::LonLat at = mars::destination(place.at, yaw_deg, frame * 1e-3 / mars::kMarsRadius_m);
  const double ground_m = surface.at(place.frame.up).height_m;
  vpe::core::View view;
  view.camera = mars::to_camera({at.lon_deg, at.lat_deg, ground_m + 1, yaw_deg, -25, 7}, mars::kMarsRadius_m);
  view.width = 1280;
  view.height = 720;
  view.fov_deg = 60;
  view.part = {608, 300, 64, 128};
  return view;
}

struct Jitter {
  double off_px = 0;    // distance of a pixel's ground from the reference surface, across it
  double step_px = 0;   // change of that distance from frame to frame
  double measured = 0;  // pixels
  double outlines = 0;  // pixels at the outline of nearer ground, of which none is measured
};

// Compares ranges(view), the ranges of the drawn part row by row, with exact casts.
inline Jitter measure_jitter(const FinePlace& place, const paging::Surface& surface, int frames,
                             const std::function<std::vector<float>(const vpe::core::View&)>& ranges) {
  Jitter jitter;
  for (const double yaw_deg : {20.0, 113.0}) {
    std::vector<double> before;
    for (int frame = 0; frame < frames; ++frame) {
      const vpe::core::View view = millimetre_view(place, surface, yaw_deg, frame);
      const std::vector<float> range_m = ranges(view);
      const double f = vpe::core::focal_px(view);
      const int width = view.part.width;
      std::vector<double> exact(range_m.size());
      std::vector<glm::dvec3> ray(range_m.size());
      for (std::size_t k = 0; k < range_m.size(); ++k) {
        const int x = static_cast<int>(k) % width;
        const int y = static_cast<int>(k) / width;
        ray[k] = vpe::core::pixel_ray(view, view.part.x + x + 0.5, view.part.y + y + 0.5);
        exact[k] = surface.cast(view.camera.position_m, ray[k]);
      }
      std::vector<double> off(range_m.size(), std::nan(""));
      for (std::size_t k = 0; k < range_m.size(); ++k) {
        // A neighbouring pixel is much farther or nearer: an outline runs through this one.
        bool outline = false;
        for (const int step : {-1, 1, -width, width}) {
          const auto other = static_cast<std::ptrdiff_t>(k) + step;
          if (other < 0 || other >= static_cast<std::ptrdiff_t>(exact.size())) continue;
          const double ratio = exact[static_cast<std::size_t>(other)] / exact[k];
          outline = outline || !(ratio < 1.2 && ratio > 1 / 1.2);
        }
        if (outline) {
          jitter.outlines += 1;
          continue;
        }
        const glm::dvec3 normal = surface.at(view.camera.position_m + exact[k] * ray[k]).normal;
        off[k] =
            (static_cast<double>(range_m[k]) - exact[k]) * std::abs(glm::dot(normal, ray[k])) * f / exact[k];
        jitter.measured += 1;
        jitter.off_px = std::max(jitter.off_px, std::isnan(off[k]) ? INFINITY : std::abs(off[k]));
        if (!before.empty() && !std::isnan(before[k]))
          jitter.step_px = std::max(jitter.step_px, std::abs(off[k] - before[k]));
      }
      before = std::move(off);
    }
  }
  return jitter;
}

}  // namespace test_support
