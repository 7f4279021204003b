#include "panorama/match/fit_drawing.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace panorama {

namespace {

using vpe::core::RgbImage;

void dot(RgbImage& image, double x_px, double y_px, int size, const vpe::base::Rgb& colour) {
  const int left = static_cast<int>(std::floor(x_px - 0.5 * (size - 1)));
  const int top = static_cast<int>(std::floor(y_px - 0.5 * (size - 1)));
  for (int y = std::max(0, top); y < std::min(image.height, top + size); ++y) {
    for (int x = std::max(0, left); x < std::min(image.width, left + size); ++x)
      image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                   static_cast<std::size_t>(x)] = colour;
  }
}

// Places farther apart than a seam are not joined.
void join(RgbImage& image, const glm::dvec2& a, const glm::dvec2& b, int size) {
  const double length = std::max(std::abs(a.x - b.x), std::abs(a.y - b.y));
  if (length > 0.25 * std::max(image.width, image.height)) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(length)));
  for (int k = 0; k <= steps; ++k) {
    const double t = static_cast<double>(k) / steps;
    dot(image, a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), size, kComputedColour);
  }
}

}  // namespace

RgbImage draw_fit(const RgbImage& photo, const PhotoShape& shape, const SkyLine& line,
                  const SkylineMatch& match, const SkylineProfile& profile) {
  RgbImage image = photo;
  const int size = 1 + image.width / 1000;
  if (match.failure != MatchFailure::kFewColumns && match.failure != MatchFailure::kLittleRelief) {
    // At least a sample for each pixel of the circle.
    const double step_deg = std::min(profile.step_deg(), 57.3 / pixels_per_radian(shape, match.pose.fov_deg));
    const auto steps = static_cast<int>(std::ceil(360 / step_deg));
    std::optional<glm::dvec2> before;
    for (int k = 0; k <= steps; ++k) {
      const double azimuth_deg = match.pose.yaw_deg - 180 + 360.0 * k / steps;
      const auto here = photo_place(shape, match.pose, {azimuth_deg, profile.elevation_deg(azimuth_deg)});
      if (here && before) join(image, *before, *here, 3 * size);
      before = here;
    }
  }
  for (const SkyPoint& point : line.points) dot(image, point.x_px, point.y_px, size, kFoundColour);
  return image;
}

}  // namespace panorama
