// Where somebody looks who stands in a panorama and turns: a level perspective view of it.
//
// Directions are those of the panorama: azimuth clockwise from north, elevation up. Screen positions are in
// pixels, (0, 0) the upper left corner, pixel centres at +0.5. The screen's columns of the horizon at pitch 0
// are azimuth = yaw + atan((x - width / 2) / f), f = (height / 2) / tan(fov / 2).
// Pure: nothing here reads images. One thread at a time changes a Viewer.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "mars/geodesy/sphere.h"
#include "panorama/projection.h"
#include "vpe/core/view.h"

namespace panorama {

struct ViewerLimits {
  static constexpr double kMinFov_deg = 0.001;
  static constexpr double kMaxFov_deg = 120;
  static constexpr double kDefaultFov_deg = 60;
  // Screen pixels that a pixel of the image may be wide; narrower fields of view are widened to that.
  static constexpr double kMaxMagnification = 16;
};

// Elevations that an image shows at every azimuth of it.
struct ElevationRange {
  double low_deg = -90;
  double high_deg = 90;
};
ElevationRange elevations_of(const PanoramaMap& map);

class Viewer {
 public:
  // Looks at the middle of the map's elevations that is nearest to the horizon, yaw at the image's middle.
  // The map must pass check(); sides are 1 to ViewLimits::kMaxSide_px.
  Viewer(const PanoramaMap& map, int width_px, int height_px);

  // Azimuth of the screen's middle, any number of turns: what was turned is kept.
  double yaw_deg() const { return yaw_deg_; }
  // So that the middle column ends at the image's edges, or in the middle of an image that is lower than the
  // field of view. An image that reaches the zenith or nadir may be looked at straight up or down.
  double pitch_deg() const { return pitch_deg_; }
  double fov_deg() const { return fov_deg_; }  // vertical
  glm::ivec2 size() const { return size_; }
  const PanoramaMap& map() const { return map_; }

  double min_fov_deg() const;
  ElevationRange pitch_range() const;

  // All of these keep to the limits; numbers that are not finite change nothing.
  void resize(int width_px, int height_px);
  void look_at(double yaw_deg, double pitch_deg);
  void turn(double yaw_deg, double pitch_deg) { look_at(yaw_deg_ + yaw_deg, pitch_deg_ + pitch_deg); }
  void set_fov(double fov_deg);
  // Divides the tangent of half the field of view by a factor > 0; what is at (x, y) stays there unless a limit
  // of the pitch is reached.
  void zoom(double factor, double x, double y);
  // Turns, without roll, so that a direction is at (x, y): to drag the image. As near to it as can be.
  void hold(const Direction& direction, double x, double y);

  // The view, its axes in the panorama's frame: x east, y north, z up.
  vpe::core::View view() const;
  Direction direction(double x, double y) const;
  // Nothing for what is not in front of the screen; positions beside it are given. direction() of it is the
  // same within 1e-12 degrees at fields of view up to 120.
  std::optional<glm::dvec2> screen(const Direction& direction) const;

 private:
  void clamp_pitch();

  PanoramaMap map_;
  glm::ivec2 size_;
  double yaw_deg_ = 0;
  double pitch_deg_ = 0;
  double fov_deg_ = ViewerLimits::kDefaultFov_deg;
};

// Unit vector (east, north, up) of a direction, and back.
glm::dvec3 to_vector(const Direction& direction);
Direction to_direction(const glm::dvec3& vector);

// North and up of views whose axes are in the panorama's frame.
inline constexpr mars::LocalFrame kViewerFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

// A level perspective view of a panorama, its axes in the panorama's frame.
vpe::core::View view_of(double yaw_deg, double pitch_deg, double fov_deg, int width_px, int height_px);

}  // namespace panorama
