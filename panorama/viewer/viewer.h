// The state of a panorama viewer: a perspective view that turns and zooms within the image's limits. It is level unless
// the head that looks is tilted.
//
// Directions are those of the panorama: azimuth clockwise from north, elevation up. Screen positions are in
// pixels, (0, 0) the upper left corner, pixel centres at +0.5. The screen's columns of the horizon at pitch 0
// are azimuth = yaw + atan((x - width / 2) / f), f = (height / 2) / tan(fov / 2), without roll.
// Pure: nothing here reads images. One thread at a time changes a Viewer.
//
// Typical usage:
//   Viewer viewer(map, 1280, 720);
//   viewer.zoom(1.1, mouse.x, mouse.y);
//   const vpe::core::RgbImage image = render_view(tiled_image, map, viewer.view(), {});
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

// Describes a range of elevations.
struct ElevationRange {
  double low_deg = -90;
  double high_deg = 90;
};
// Returns the elevations that an image shows at every one of its azimuths.
ElevationRange elevations_of(const PanoramaMap& map);

// Keeps yaw, pitch and field of view within the limits of an image.
class Viewer {
 public:
  // Looks at the elevation nearest to the horizon that the limits allow, with yaw at the image's middle. The
  // map must pass check(); sides are 1 to ViewLimits::kMaxSide_px.
  Viewer(const PanoramaMap& map, int width_px, int height_px);

  // Returns the azimuth of the screen's middle. It is not reduced to one full circle.
  double yaw_deg() const { return yaw_deg_; }
  // Returns the elevation of the screen's middle. It is limited so that the middle column ends at the image's
  // edges; an image that is lower than the field of view is centred. An image that reaches the zenith or nadir
  // may be viewed straight up or down.
  double pitch_deg() const { return pitch_deg_; }
  double fov_deg() const { return fov_deg_; }  // vertical
  // Returns the tilt of the head to its right, about the direction of the middle. The limits are those of a level view.
  double roll_deg() const { return roll_deg_; }
  glm::ivec2 size() const { return size_; }
  const PanoramaMap& map() const { return map_; }

  double min_fov_deg() const;
  ElevationRange pitch_range() const;

  // Change the view. All keep to the limits; numbers that are not finite change nothing.
  void resize(int width_px, int height_px);
  void look_at(double yaw_deg, double pitch_deg);
  void turn(double yaw_deg, double pitch_deg) { look_at(yaw_deg_ + yaw_deg, pitch_deg_ + pitch_deg); }
  void set_fov(double fov_deg);
  void set_roll(double roll_deg);
  // Divides the tangent of half the field of view by a factor > 0. The direction at (x, y) stays there unless a
  // limit of the pitch is reached.
  void zoom(double factor, double x, double y);
  // Turns, and keeps the roll, so that a direction is at (x, y), or as near to it as the limits allow. Use it to drag
  // the image.
  void hold(const Direction& direction, double x, double y);

  // Returns the view, its axes in the panorama's frame: x east, y north, z up.
  vpe::core::View view() const;
  // Returns the direction at a screen position.
  Direction direction(double x, double y) const;
  // Returns the screen position of a direction, also beside the screen; nullopt for a direction that is not in
  // front of it. direction() of the result is the same within 1e-12 degrees at fields of view up to 120
  // degrees.
  std::optional<glm::dvec2> screen(const Direction& direction) const;

 private:
  void clamp_pitch();

  PanoramaMap map_;
  glm::ivec2 size_;
  double yaw_deg_ = 0;
  double pitch_deg_ = 0;
  double fov_deg_ = ViewerLimits::kDefaultFov_deg;
  double roll_deg_ = 0;
};

// Convert between directions and unit vectors (east, north, up).
glm::dvec3 to_vector(const Direction& direction);
Direction to_direction(const glm::dvec3& vector);

// Holds north and up of views whose axes are in the panorama's frame.
inline constexpr mars::LocalFrame kViewerFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

// Returns a perspective view of a panorama, its axes in the panorama's frame; level unless it has a roll.
vpe::core::View view_of(double yaw_deg, double pitch_deg, double fov_deg, int width_px, int height_px,
                        double roll_deg = 0);

}  // namespace panorama
