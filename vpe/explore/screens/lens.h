// The lens between an eye and a screen close before it: its distortion, and the image that it needs.
//
// Positions are measured from the lens's axis in units of half the height of the screen, x right and y down. A
// position p of the screen is seen where an undistorted image has q = p (1 + k1 r^2 + k2 r^4 + ...), r = |p|: a lens
// that magnifies has coefficients above 0. The undistorted image is a perspective one, with a focal length of
// lens_focal() such units, so the angle off the axis is atan(|q| / lens_focal()). All functions are pure.
//
// Typical usage:
//   const LensImage wanted = lens_image(lens, 960, 1080, -1);
//   ...                                                  // draw that image
//   const LensTable table(lens, 960, 1080, -1);           // lens_table.h
//   show(through_lens(image, table));
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

namespace vpe::explore {

// Describes a lens before one eye.
struct ScreenLens {
  static constexpr std::size_t kCoefficients = 4;
  static constexpr double kMostCoefficient = 10;
  static constexpr double kLeastField_deg = 1;
  static constexpr double kMostField_deg = 150;

  // Angle between the upper and the lower edge of the screen as seen through the lens, on a line through its axis; of a
  // screen whose axis is in the middle of its height.
  double field_deg = 90;
  std::array<double, kCoefficients> distortion{0, 0, 0, 0};  // k1 to k4
  double axes_m = 0.063;                                     // distance between the axes of both lenses
  double width_m = 0;  // of one eye's screen; 0: the axis is in its middle
};

// Returns where the undistorted image has what is seen at position p of the screen.
glm::dvec2 undistorted(const ScreenLens& lens, glm::dvec2 p);

// Returns the inverse within 1e-12 of the units, or nullopt beyond `most_radius`, up to which undistorted() must grow.
std::optional<glm::dvec2> distorted(const ScreenLens& lens, glm::dvec2 q, double most_radius);

// Returns true if |undistorted(p)| grows strictly with |p| up to a radius, so that it has an inverse.
bool is_invertible(const ScreenLens& lens, double most_radius);

// Returns the focal length of the undistorted image.
double lens_focal(const ScreenLens& lens);

// Returns "" for a lens that can be used with a screen of this size, else what is wrong. `side` is -1 for a left eye,
// 1 for a right one, 0 for a middle one.
std::string check(const ScreenLens& lens, int width_px, int height_px, int side);

// Returns the position of the lens's axis on the screen, pixels: towards the nose for an eye.
glm::dvec2 lens_axis_px(const ScreenLens& lens, int width_px, int height_px, int side);

// Returns the largest distance of a point of the screen from the axis, units of half its height.
double lens_radius(const ScreenLens& lens, int width_px, int height_px, int side);

// Describes the undistorted image that a screen needs: it covers all that the screen shows, and a pixel more on each
// side for filters. On the axis its pixels are as large as the screen's.
struct LensImage {
  int width_px = 0;
  int height_px = 0;
  glm::dvec2 axis_px{0, 0};  // of the principal point, from the upper left corner
  double focal_px = 0;
};

// Returns the image for a lens that check() accepts.
LensImage lens_image(const ScreenLens& lens, int width_px, int height_px, int side);

}  // namespace vpe::explore
