// A view: where the camera is, how it projects, and which pixels are asked for.
//
// Image positions are in pixels of the full image: x right, y down, (0, 0) its upper left corner, pixel
// centres at +0.5. The principal point c is the middle plus principal_offset_px; f is focal_px(). In the
// camera's axes (right, up, forward) a position (x, y) looks along
//   kPerspective      (x - cx, cy - y, f)
//   kCylinder         (sin a, (cy - y) / f, cos a),        a = (x - cx) 360 deg / width
//   kEquirectangular  (cos e sin a, sin e, cos e cos a),   e = (cy - y) fov / height
// so the cylinder's rows are even in tan(elevation), and both round images span 360 degrees of azimuth.
// All functions are pure, may be called from any thread, and expect a view that check() accepts.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "mars/geodesy/pose.h"

namespace vpe::core {

enum class Projection : std::uint8_t { kPerspective, kCylinder, kEquirectangular };

struct ViewLimits {
  static constexpr double kMinFov_deg = 0.001;
  static constexpr double kMaxFov_deg = 179.0;       // kEquirectangular: 180
  static constexpr int kMaxSide_px = 32768;          // of the drawn part
  static constexpr int kMaxFullSide_px = 1'000'000;  // of the full image, when only a part is drawn
  static constexpr double kMaxOffset_px = 1e6;
  static constexpr double kMaxCameraDistance_m = 1e15;  // from the planet's centre
};

// Part of the full image that is drawn, pixels, row 0 at the top. width 0 = the whole image.
struct SubRectangle {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

struct View {
  mars::CameraPose camera;  // body-fixed, metres from the planet's centre
  Projection projection = Projection::kPerspective;
  double fov_deg = 60.0;  // vertical, of the full image without its offset
  int width = 1280;
  int height = 720;
  glm::dvec2 principal_offset_px{0, 0};  // of the principal point from the middle; +x right, +y down
  SubRectangle part;
};

// Empty when the view can be drawn, else what is wrong with it and what is allowed.
std::string check(const View& view);

// Pixels per unit of tangent down the image: (height / 2) / tan(fov / 2) for perspective and cylinder;
// pixels per radian, height / fov, for equirectangular. What is e metres tall at distance d about the
// principal point covers e f / d pixels.
double focal_px(const View& view);

// Direction, unit, body-fixed, through image position (x, y) (also outside the image). Error of the
// angle <= kPixelRayError_rad; length 1 within 4e-16.
inline constexpr double kPixelRayError_rad = 2e-15;
glm::dvec3 pixel_ray(const View& view, double x, double y);

// Image position of a body-fixed point, x in [0, width) for the round projections. behind = true where the
// point does not project: not in front of a perspective camera, on the axis of a cylinder, or at the camera itself.
// project(camera + d * pixel_ray(x, y)) is (x, y) within 8e-16 (|camera| / d + 4) (1 + t^2) s pixels, t = tangent
// of the angle off the principal ray (0 for equirectangular), s = larger of f and the image's sides.
struct Projected {
  glm::dvec2 xy{0, 0};
  double depth_m = 0;  // along forward
  bool behind = false;
};
Projected project(const View& view, const glm::dvec3& point_m);

// The part that is drawn: part if set, else the full image; and its size.
SubRectangle drawn_part(const View& view);
glm::ivec2 drawn_size(const View& view);

// Half-space {x : dot(normal, x) >= offset_m}, normal unit, body-fixed.
struct Plane {
  glm::dvec3 normal;
  double offset_m = 0;
};

// The four side planes (left, right, bottom, top) of a perspective view's drawn part, through the camera: a
// point in front of the camera projects into the part exactly when it is in all four, up to rounding. Throws
// std::invalid_argument for other projections, which have no flat sides.
std::array<Plane, 4> side_planes(const View& view);

// Whether the horizon of a sphere about the planet's centre, or anything above it, is in the drawn part of a
// perspective view; then the image may show ground of any distance. True for round views, and for a camera at
// or within the sphere.
bool reaches_horizon(const View& view, double radius_m);

}  // namespace vpe::core
