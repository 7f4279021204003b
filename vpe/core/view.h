// A view: where the eye is, how it projects, and which pixels are asked for.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "mars/pose.h"

namespace vpe::core {

enum class Projection { kPerspective, kCylinder, kEquirectangular };

struct ViewLimits {
  static constexpr double kMinFov_deg = 0.001;
  static constexpr double kMaxFov_deg = 179.0;
  static constexpr int kMaxSide_px = 32768;
};

// Part of the full picture that is drawn, pixels, row 0 at the top. width 0 = the whole picture.
struct SubRectangle {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

// Row 0 is the top, pixel centres lie at +0.5. Focal length in pixels is (height / 2) / tan(fov / 2).
struct View {
  mars::EyePose eye;  // body-fixed, metres from the planet's centre
  Projection projection = Projection::kPerspective;
  double fov_deg = 60.0;  // vertical, of the full picture
  int width = 1280;
  int height = 720;
  glm::dvec2 principal_offset_px{0, 0};  // of the principal point from the middle; +x right, +y down
  SubRectangle part;
};

// Empty when the view can be drawn, else what is wrong with it and what is allowed.
std::string check(const View& view);

// Focal length in pixels (perspective).
double focal_px(const View& view);

// Direction, unit, body-fixed, through picture position (x, y) in pixels of the full picture
// (pixel centre of column i: x = i + 0.5).
glm::dvec3 pixel_ray(const View& view, double x, double y);

// Picture position of a body-fixed point, pixels of the full picture; behind = true where the point does not
// project (behind a perspective eye).
struct Projected {
  glm::dvec2 xy{0, 0};
  double depth_m = 0;  // along forward
  bool behind = false;
};
Projected project(const View& view, const glm::dvec3& point_m);

// Size of what is drawn: part if set, else the full picture.
glm::ivec2 drawn_size(const View& view);

// Half-space {x : dot(normal, x) >= offset_m}, normal unit, body-fixed.
struct Plane {
  glm::dvec3 normal;
  double offset_m = 0;
};

// The four side planes (left, right, bottom, top) of a perspective view's drawn part, through the eye.
std::array<Plane, 4> side_planes(const View& view);

}  // namespace vpe::core
