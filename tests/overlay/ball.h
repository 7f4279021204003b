// A sphere with a cone on it, and its range image by marching along rays.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "vpe/overlay/overlay.h"

namespace overlay_test {

using vpe::core::Overlays;
using vpe::core::View;
using vpe::overlay::Layer;
using vpe::overlay::Scene;

inline constexpr double kRadius_m = 3.4e6;

struct Ball {
  mars::LonLat top{0, 0};
  double cone_m = 0;      // height of the cone
  double foot_rad = 0.1;  // angle from its top to its foot
  double exaggeration = 1;

  double height_m(const glm::dvec3& direction) const { return height_m(direction, mars::direction(top)); }
  double height_m(const glm::dvec3& direction, const glm::dvec3& top_direction) const {
    if (cone_m == 0) return 0;
    return std::max(0.0, cone_m * (1 - mars::angle_between_rad(direction, top_direction) / foot_rad));
  }

  // Distance along a unit ray; infinity when it misses.
  double cast(const glm::dvec3& camera, const glm::dvec3& ray) const {
    const double outer = kRadius_m + std::max(0.0, cone_m * exaggeration) + 1;
    const double along = -glm::dot(camera, ray);
    const double off2 = glm::dot(camera, camera) - along * along;
    if (off2 > outer * outer) return std::numeric_limits<double>::infinity();
    const double half = std::sqrt(outer * outer - off2);
    const glm::dvec3 top_direction = mars::direction(top);
    double t = std::max(0.0, along - half);
    while (t <= along + half) {
      const glm::dvec3 p = camera + ray * t;
      const double above = glm::length(p) - kRadius_m - exaggeration * height_m(p, top_direction);
      if (above < 1e-4) return t;
      t += 0.75 * above;  // slopes stay under 40 degrees
    }
    return std::numeric_limits<double>::infinity();
  }

  std::vector<float> range(const View& view) const {
    const vpe::core::SubRectangle part = vpe::core::drawn_part(view);
    std::vector<float> out;
    for (int y = 0; y < part.height; ++y) {
      for (int x = 0; x < part.width; ++x) {
        out.push_back(static_cast<float>(
            cast(view.camera.position_m, vpe::core::pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5))));
      }
    }
    return out;
  }
};

inline View view_at(const mars::Pose& pose, int width = 320, int height = 180, double fov_deg = 60) {
  View view;
  view.camera = mars::to_camera(pose, kRadius_m);
  view.width = width;
  view.height = height;
  view.fov_deg = fov_deg;
  return view;
}

// A scene that owns its range image.
struct Sight {
  Ball ball;
  View view;
  std::vector<float> range_m;

  Sight(const Ball& b, const View& v) : ball(b), view(v), range_m(b.range(v)) {}

  Scene scene() const {
    Scene s;
    s.view = view;
    s.range_m = range_m;
    s.radius_m = kRadius_m;
    s.appearance.exaggeration = ball.exaggeration;
    s.height_m = [this](const vpe::core::Place& place) {
      return ball.height_m(mars::direction({place.lon_deg, place.lat_deg}));
    };
    return s;
  }
  Layer draw(const Overlays& overlays) const { return vpe::overlay::draw(overlays, scene()); }
};

inline std::size_t painted(const Layer& layer) {
  std::size_t count = 0;
  for (const vpe::core::Rgba& p : layer.pixels) count += p.a > 0 ? 1 : 0;
  return count;
}

inline vpe::core::Rgba at(const Layer& layer, int x, int y) {
  return layer.pixels.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(layer.width) +
                         static_cast<std::size_t>(x));
}

}  // namespace overlay_test
