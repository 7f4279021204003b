#include "vpe/explore/screens/placed_screen.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

using L = ScreenLimits;

bool is_placed(const glm::dvec3& v) {
  for (int n = 0; n < 3; ++n)
    if (!(std::abs(v[n]) <= L::kMostCoordinate_m)) return false;
  return true;
}

// Describes a screen by its sides.
struct ScreenSides {
  explicit ScreenSides(const ScreenCorners& corners)
      : across(corners.upper_right_m - corners.upper_left_m),
        down(corners.lower_left_m - corners.upper_left_m),
        width_m(glm::length(across)),
        height_m(glm::length(down)) {}
  // Returns the sine of what the corner is off a right angle.
  double skew() const { return glm::dot(across, down) / (width_m * height_m); }
  // Returns width by height of a pixel.
  double pixel_ratio(int width_px, int height_px) const { return width_m / width_px / (height_m / height_px); }

  glm::dvec3 across;
  glm::dvec3 down;
  double width_m;
  double height_m;
};

std::string problem_of_pixels(int width_px, int height_px) {
  const auto is_side = [](int side) { return side >= L::kLeastSide_px && side <= L::kMostSide_px; };
  if (is_side(width_px) && is_side(height_px)) return {};
  return "pixels " + std::to_string(width_px) + "x" + std::to_string(height_px) + ": each side must be " +
         std::to_string(L::kLeastSide_px) + " to " + std::to_string(L::kMostSide_px);
}

std::string problem_of_corners(const ScreenCorners& corners, double tolerance) {
  if (!is_placed(corners.upper_left_m) || !is_placed(corners.upper_right_m) || !is_placed(corners.lower_left_m))
    return "corners: each coordinate must be within " + base::format_number(L::kMostCoordinate_m) + " m";
  const ScreenSides sides(corners);
  if (!(sides.width_m >= L::kLeastSide_m && sides.height_m >= L::kLeastSide_m))
    return "the corners are " + base::format_fixed(sides.width_m, 4) + " and " +
           base::format_fixed(sides.height_m, 4) + " m apart: each side must be at least " +
           base::format_number(L::kLeastSide_m) + " m";
  const double skew = sides.skew();
  if (std::abs(skew) > tolerance)
    return "the upper left corner has " +
           base::format_fixed(std::acos(std::clamp(skew, -1.0, 1.0)) / mars::kRadiansPerDegree, 6) +
           " degrees: it must be a right angle; measure the corners again";
  return {};
}

std::string problem_of_place(const PlacedScreen& screen, double tolerance) {
  if (const auto* corners = std::get_if<ScreenCorners>(&screen.place))
    return problem_of_corners(*corners, tolerance);
  const int side = screen.eye == ScreenEye::kLeft ? -1 : screen.eye == ScreenEye::kRight ? 1 : 0;
  return check(std::get<ScreenLens>(screen.place), screen.width_px, screen.height_px, side);
}

// Puts right angles into the corners, and the height that makes pixels square.
ScreenCorners squared(const ScreenCorners& corners, int width_px, int height_px) {
  const ScreenSides sides(corners);
  const glm::dvec3 right = sides.across / sides.width_m;
  const glm::dvec3 straight = sides.down - right * glm::dot(sides.down, right);
  const glm::dvec3 down = straight / glm::length(straight);
  const double height_m = sides.width_m * height_px / width_px;
  const glm::dvec3 shift = down * (0.5 * (glm::length(straight) - height_m));
  const glm::dvec3 corner = corners.upper_left_m + shift;
  return {corner, corner + sides.across, corner + down * height_m};
}

}  // namespace

const char* to_string(ScreenEye eye) {
  switch (eye) {
    case ScreenEye::kLeft: return "left";
    case ScreenEye::kRight: return "right";
    case ScreenEye::kBoth: return "both";
    case ScreenEye::kMiddle: break;
  }
  return "middle";
}

std::string check(const PlacedScreen& screen) {
  if (std::string problem = problem_of_pixels(screen.width_px, screen.height_px); !problem.empty())
    return problem;
  if (std::string problem = problem_of_place(screen, L::kExact); !problem.empty()) return problem;
  const auto* corners = std::get_if<ScreenCorners>(&screen.place);
  if (corners == nullptr) return {};
  const double ratio = ScreenSides(*corners).pixel_ratio(screen.width_px, screen.height_px);
  if (std::abs(ratio - 1) > L::kExact)
    return "pixels are " + base::format_number(ratio) + " times as wide as high: fit() makes square ones";
  return {};
}

FittedScreen fit(const PlacedScreen& screen) {
  FittedScreen fitted{screen, {screen.width_px, screen.height_px}, {}};
  fitted.problem = problem_of_pixels(screen.width_px, screen.height_px);
  if (fitted.problem.empty()) fitted.problem = problem_of_place(screen, L::kSquareTolerance);
  if (!fitted.problem.empty()) return fitted;
  const auto* corners = std::get_if<ScreenCorners>(&screen.place);
  if (corners == nullptr) {
    const int side = screen.eye == ScreenEye::kLeft ? -1 : screen.eye == ScreenEye::kRight ? 1 : 0;
    const LensImage image =
        lens_image(std::get<ScreenLens>(screen.place), screen.width_px, screen.height_px, side);
    fitted.drawn_px = {image.width_px, image.height_px};
    return fitted;
  }
  const ScreenSides sides(*corners);
  const double ratio = sides.pixel_ratio(screen.width_px, screen.height_px);
  if (std::abs(ratio - 1) > L::kSquareTolerance) {
    // Finer pixels along the side where they are longer.
    const double width_px = screen.width_px * std::max(ratio, 1.0);
    const double height_px = screen.height_px * std::max(1 / ratio, 1.0);
    if (!(std::max(width_px, height_px) <= L::kMostSide_px)) {
      fitted.problem = "pixels are " + base::format_number(ratio) +
                       " times as wide as high, and an image with square ones would have a side of more than " +
                       std::to_string(L::kMostSide_px) + ": check corners and pixels";
      return fitted;
    }
    fitted.drawn_px = {static_cast<int>(std::lround(width_px)), static_cast<int>(std::lround(height_px))};
    fitted.screen.width_px = fitted.drawn_px.x;
    fitted.screen.height_px = fitted.drawn_px.y;
  }
  fitted.screen.place = squared(*corners, fitted.screen.width_px, fitted.screen.height_px);
  return fitted;
}

}  // namespace vpe::explore
