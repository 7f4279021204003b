// Scenes whose images are known in closed form, for tests of vpe/warp.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <random>
#include <vector>

#include "vpe/core/frame.h"
#include "vpe/core/view.h"

namespace vpe::test_support {

struct Sphere {
  glm::dvec3 centre_m{};
  double radius_m = 1;
};

struct Box {
  glm::dvec3 low_m{};
  glm::dvec3 high_m{};
};

struct Floor {
  glm::dvec3 normal{0, 0, 1};  // unit; air is on this side
  double offset_m = 0;
};

// A scene of opaque bodies below a sky. Coordinates are those of the camera's position.
struct Scene {
  std::vector<Floor> floors;
  std::vector<Sphere> spheres;
  std::vector<Box> boxes;

  // Returns the distance along a unit ray to the nearest surface, or infinity.
  double cast_m(const glm::dvec3& from_m, const glm::dvec3& ray) const {
    double nearest = std::numeric_limits<double>::infinity();
    const auto meet = [&nearest](double t) {
      if (t > 0 && t < nearest) nearest = t;
    };
    for (const Floor& f : floors) meet((f.offset_m - glm::dot(f.normal, from_m)) / glm::dot(f.normal, ray));
    for (const Sphere& s : spheres) {
      const glm::dvec3 to = s.centre_m - from_m;
      const double along = glm::dot(to, ray);
      const double half = s.radius_m * s.radius_m - (glm::dot(to, to) - along * along);
      if (half >= 0) meet(along - std::sqrt(half));
    }
    for (const Box& b : boxes) {
      double enter = 0;
      double leave = std::numeric_limits<double>::infinity();
      for (int k = 0; k < 3; ++k) {
        const double t0 = (b.low_m[k] - from_m[k]) / ray[k];
        const double t1 = (b.high_m[k] - from_m[k]) / ray[k];
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
      }
      if (enter < leave) meet(enter);
    }
    return nearest;
  }
};

// Returns the colour of a surface: smooth, so that a small shift is a small difference; the wave length is 2 pi / 0.05 m.
inline base::Rgb texture_at(const glm::dvec3& point_m) {
  const auto wave = [](double x) { return static_cast<std::uint8_t>(127.5 + 100 * std::sin(0.05 * x)); };
  return {wave(point_m.x), wave(point_m.y), wave(point_m.z)};
}

inline core::Frame image_of(const Scene& scene, const core::View& view) {
  const core::SubRectangle part = core::drawn_part(view);
  core::Frame frame;
  frame.width = part.width;
  frame.height = part.height;
  for (int y = 0; y < part.height; ++y) {
    for (int x = 0; x < part.width; ++x) {
      const glm::dvec3 ray = core::pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5);
      const double range_m = scene.cast_m(view.camera.position_m, ray);
      frame.range_m.push_back(static_cast<float>(range_m));
      const bool is_sky = !(range_m < std::numeric_limits<double>::infinity());
      frame.colour.push_back(is_sky ? base::Rgb{200, 180, 160}
                                    : texture_at(view.camera.position_m + range_m * ray));
    }
  }
  return frame;
}

// Returns a view that looks along +y with z up, turned by degrees of heading, pitch and roll.
inline core::View view_at(const glm::dvec3& position_m, double heading_deg = 0, double pitch_deg = 0,
                          double roll_deg = 0) {
  core::View view;
  view.width = 160;
  view.height = 120;
  view.fov_deg = 60;
  view.camera.position_m = position_m;
  const mars::LocalFrame level{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // east, north, up
  view.camera.axes = mars::oriented_axes(level, heading_deg, pitch_deg, roll_deg);
  return view;
}

// Returns a floor with twelve hills, seen along +y from some 20 m above the origin.
inline Scene hills() {
  Scene scene;
  scene.floors.push_back({{0, 0, 1}, 0});
  for (int n = 0; n < 12; ++n)
    scene.spheres.push_back({{-220.0 + 40 * n, 150.0 + 37 * (n % 5), -12}, 24.0 + 3 * (n % 4)});
  return scene;
}

inline double random_in(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

}  // namespace vpe::test_support
