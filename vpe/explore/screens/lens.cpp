#include "vpe/explore/screens/lens.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "vpe/base/number.h"
#include "vpe/core/view.h"

namespace vpe::explore {

namespace {

constexpr int kGrowthSteps = 4096;
constexpr double kMostExtent_px = 1e8;

double magnified(const ScreenLens& lens, double square) {
  double sum = 0;
  for (std::size_t n = lens.distortion.size(); n-- > 0;) sum = (sum + lens.distortion[n]) * square;
  return 1 + sum;
}

// Derivative of r * magnified(r^2).
double radial_growth(const ScreenLens& lens, double square) {
  double sum = 0;
  for (std::size_t n = lens.distortion.size(); n-- > 0;)
    sum = (sum + static_cast<double>(2 * n + 3) * lens.distortion[n]) * square;
  return 1 + sum;
}

}  // namespace

glm::dvec2 undistorted(const ScreenLens& lens, glm::dvec2 p) { return p * magnified(lens, glm::dot(p, p)); }

// Newton's method, kept within bisected bounds.
std::optional<glm::dvec2> distorted(const ScreenLens& lens, glm::dvec2 q, double most_radius) {
  const double wanted = glm::length(q);
  if (!(wanted > 0)) return wanted == 0 ? std::optional(glm::dvec2{0, 0}) : std::nullopt;
  if (wanted > most_radius * magnified(lens, most_radius * most_radius)) return std::nullopt;
  double low = 0;
  double high = most_radius;
  double r = std::min(wanted, most_radius);
  for (int n = 0; n < 100; ++n) {
    const double off = r * magnified(lens, r * r) - wanted;
    (off > 0 ? high : low) = r;
    double next = r - off / radial_growth(lens, r * r);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - r) < 1e-15) return q * (next / wanted);
    r = next;
  }
  return q * (r / wanted);
}

bool is_invertible(const ScreenLens& lens, double most_radius) {
  for (int n = 0; n <= kGrowthSteps; ++n) {
    const double r = most_radius * n / kGrowthSteps;
    if (!(radial_growth(lens, r * r) > 0)) return false;
  }
  return true;
}

double lens_focal(const ScreenLens& lens) {
  return magnified(lens, 1) / std::tan(0.5 * lens.field_deg * mars::kRadiansPerDegree);
}

glm::dvec2 lens_axis_px(const ScreenLens& lens, int width_px, int height_px, int side) {
  glm::dvec2 axis{0.5 * width_px, 0.5 * height_px};
  if (lens.width_m > 0) axis.x -= side * 0.5 * (lens.width_m - lens.axes_m) / lens.width_m * width_px;
  return axis;
}

double lens_radius(const ScreenLens& lens, int width_px, int height_px, int side) {
  const glm::dvec2 axis = lens_axis_px(lens, width_px, height_px, side);
  const glm::dvec2 far{std::max(axis.x, width_px - axis.x), std::max(axis.y, height_px - axis.y)};
  return glm::length(far) / (0.5 * height_px);
}

std::string check(const ScreenLens& lens, int width_px, int height_px, int side) {
  using L = ScreenLens;
  if (!(lens.field_deg >= L::kLeastField_deg && lens.field_deg <= L::kMostField_deg))
    return "field of view of the lens: must be " + base::format_number(L::kLeastField_deg) + " to " +
           base::format_number(L::kMostField_deg) + " degrees";
  for (const double k : lens.distortion)
    if (!(std::abs(k) <= L::kMostCoefficient))
      return "distortion: each coefficient must be -" + base::format_number(L::kMostCoefficient) + " to " +
             base::format_number(L::kMostCoefficient);
  if (!(lens.axes_m >= 0 && lens.axes_m <= 1 && lens.width_m >= 0 && lens.width_m <= 1))
    return "distance of the axes and width of an eye's screen: each must be 0 to 1 m";
  const glm::dvec2 axis = lens_axis_px(lens, width_px, height_px, side);
  if (!(axis.x >= 0 && axis.x <= width_px))
    return "the axis of the lens lies beside the screen: the distance of the axes must be less than twice the width";
  if (!is_invertible(lens, lens_radius(lens, width_px, height_px, side)))
    return "the distortion turns back before the corner of the screen: a farther point of the screen would show a "
           "nearer one of the image; use smaller negative coefficients";
  const LensImage image = lens_image(lens, width_px, height_px, side);
  const int most = core::ViewLimits::kMaxSide_px;
  if (image.width_px > most || image.height_px > most)
    return "the distortion needs an image of " + std::to_string(image.width_px) + "x" +
           std::to_string(image.height_px) + " pixels, and a side may have " + std::to_string(most) +
           ": use smaller coefficients or fewer pixels";
  const double fov_deg = 2 * std::atan(0.5 * image.height_px / image.focal_px) / mars::kRadiansPerDegree;
  if (fov_deg > core::ViewLimits::kMaxFov_deg)
    return "the distortion needs an image of " + base::format_number(fov_deg) + " degrees, and one may have " +
           base::format_number(core::ViewLimits::kMaxFov_deg) + ": use a smaller field or smaller coefficients";
  return {};
}

// The scale changes little between two neighbouring pixels of the border, which the margin covers.
LensImage lens_image(const ScreenLens& lens, int width_px, int height_px, int side) {
  const glm::dvec2 axis = lens_axis_px(lens, width_px, height_px, side);
  const double unit_px = 0.5 * height_px;
  glm::dvec2 low{0, 0};
  glm::dvec2 high{0, 0};
  const auto cover = [&](double x, double y) {
    const glm::dvec2 q = undistorted(lens, (glm::dvec2(x, y) - axis) / unit_px) * unit_px;
    low = glm::min(low, q);
    high = glm::max(high, q);
  };
  for (int x = 0; x <= width_px; ++x) {
    cover(x, 0);
    cover(x, height_px);
  }
  for (int y = 0; y <= height_px; ++y) {
    cover(0, y);
    cover(width_px, y);
  }
  const auto with_margin = [](double length) { return std::ceil(std::min(length, kMostExtent_px)) + 1; };
  LensImage image;
  image.axis_px = {with_margin(-low.x), with_margin(-low.y)};
  image.width_px = static_cast<int>(image.axis_px.x + with_margin(high.x));
  image.height_px = static_cast<int>(image.axis_px.y + with_margin(high.y));
  image.focal_px = lens_focal(lens) * unit_px;
  return image;
}

}  // namespace vpe::explore
