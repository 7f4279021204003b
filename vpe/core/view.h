// The view of a camera: its pose, its projection, and the pixels to draw.
//
// Image positions are in pixels of the full image: x right, y down, (0, 0) is the upper left corner, pixel
// centres lie at +0.5. The principal point c is the middle of the image plus principal_offset_px; f is
// focal_px(). In the camera's axes (right, up, forward) the ray through position (x, y) has the direction
//   kPerspective      (x - cx, cy - y, f)
//   kCylinder         (sin a, (cy - y) / f, cos a),        a = (x - cx) 360 deg / width
//   kEquirectangular  (cos e sin a, sin e, cos e cos a),   e = (cy - y) fov / height
// The rows of a cylinder are even in tan(elevation). Both round projections span 360 degrees of azimuth.
// All functions are pure, may be called from any thread, and expect a view that check() accepts.
//
// Typical usage:
//   View view;
//   view.camera = mars::to_camera(pose, planet_radius_m);
//   view.fov_deg = 50;
//   if (const std::string problem = check(view); !problem.empty()) throw std::runtime_error(problem);
//   const glm::dvec3 ray = pixel_ray(view, 640.5, 360.5);
//   const Projected back = project(view, view.camera.position_m + 1000.0 * ray);  // back.xy is (640.5, 360.5)
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "mars/geodesy/pose.h"

namespace vpe::core {

enum class Projection : std::uint8_t { kPerspective, kCylinder, kEquirectangular };

// Limits that check() enforces.
struct ViewLimits {
  static constexpr double kMinFov_deg = 0.001;
  static constexpr double kMaxFov_deg = 179.0;       // kEquirectangular: 180
  static constexpr int kMaxSide_px = 32768;          // of the drawn part
  static constexpr int kMaxFullSide_px = 1'000'000;  // of the full image, when only a part is drawn
  static constexpr double kMaxOffset_px = 1e6;
  static constexpr double kMaxCameraDistance_m = 1e15;  // from the planet's centre
};

// The part of the full image that is drawn, in pixels, row 0 at the top. Width 0 means the whole image.
struct SubRectangle {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  bool operator==(const SubRectangle&) const = default;
};

// Describes the camera and the image. Tiles of posters, facets of panoramas and images of stereo pairs are
// views too.
struct View {
  mars::CameraPose camera;  // body-fixed, metres from the planet's centre
  Projection projection = Projection::kPerspective;
  double fov_deg = 60.0;  // vertical, of the full image without its offset
  int width = 1280;
  int height = 720;
  glm::dvec2 principal_offset_px{0, 0};  // of the principal point from the middle; +x right, +y down
  SubRectangle part;
};

// Returns "" if the view can be drawn, else what is wrong with it and what is allowed.
std::string check(const View& view);

// Returns f: for perspective and cylinder the pixels per unit of tangent down the image, (height / 2) / tan(fov
// / 2); for equirectangular the pixels per radian, height / fov. An object e metres tall at distance d near the
// principal point covers e f / d pixels.
double focal_px(const View& view);

// Returns the largest length in the drawn part of what is one pixel long at the principal point and as far away:
// 1 / cos^2 of the angle to the farthest corner of a perspective image, 1 for other projections.
double corner_stretch(const View& view);

// Returns the unit direction, body-fixed, of the ray through image position (x, y), which may lie outside the
// image. The error of the angle is at most kPixelRayError_rad; the length is 1 within 4e-16.
inline constexpr double kPixelRayError_rad = 2e-15;
glm::dvec3 pixel_ray(const View& view, double x, double y);

// The image position of a point.
struct Projected {
  glm::dvec2 xy{0, 0};  // x is in [0, width) for the round projections
  double depth_m = 0;   // along forward
  // True if the point does not project: it is not in front of a perspective camera, lies on the axis of a
  // cylinder, or is the camera itself.
  bool behind = false;
};

// Returns the image position of a body-fixed point. project(camera + d * pixel_ray(x, y)) is (x, y) within
// 8e-16 (|camera| / d + 4) (1 + t^2) s pixels, where t is the tangent of the angle off the principal ray (0 for
// equirectangular) and s the larger of f and the image's sides.
Projected project(const View& view, const glm::dvec3& point_m);

// Return the part that is drawn (`part` if set, else the full image), and its size.
SubRectangle drawn_part(const View& view);
glm::ivec2 drawn_size(const View& view);

// The half-space {x : dot(normal, x) >= offset_m}; normal is a body-fixed unit vector.
struct Plane {
  glm::dvec3 normal;
  double offset_m = 0;
};

// Returns the four side planes (left, right, bottom, top) of a perspective view's drawn part. They pass through
// the camera. A point in front of the camera projects into the part exactly if it lies in all four, up to
// rounding. Throws std::invalid_argument for other projections, which have no flat sides.
std::array<Plane, 4> side_planes(const View& view);

// Returns true if the drawn part shows the horizon of a sphere about the planet's centre, or a direction above
// it; then the image may show ground at any distance. Always true for round projections and for a camera on or
// within the sphere.
bool reaches_horizon(const View& view, double radius_m);

}  // namespace vpe::core
