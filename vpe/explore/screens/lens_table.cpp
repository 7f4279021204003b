#include "vpe/explore/screens/lens_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vpe::explore {

namespace {

void check_pixels(const core::RgbImage& image) {
  const auto width = static_cast<std::size_t>(std::max(image.width, 0));
  const auto height = static_cast<std::size_t>(std::max(image.height, 0));
  if (width == 0 || height == 0 || image.pixels.size() != width * height)
    throw std::invalid_argument("an image through a lens must have pixels");
}

// Positions beyond the middle of the outermost pixels have the colour of the border.
base::Rgb filtered_colour(const core::RgbImage& image, glm::vec2 xy) {
  const float x = std::clamp(xy.x - 0.5F, 0.0F, static_cast<float>(image.width - 1));
  const float y = std::clamp(xy.y - 0.5F, 0.0F, static_cast<float>(image.height - 1));
  const auto left = static_cast<std::size_t>(x);
  const auto top = static_cast<std::size_t>(y);
  const auto width = static_cast<std::size_t>(image.width);
  const std::size_t right = std::min(left + 1, width - 1);
  const std::size_t bottom = std::min(top + 1, static_cast<std::size_t>(image.height) - 1);
  const float u = x - static_cast<float>(left);
  const float v = y - static_cast<float>(top);
  const base::Rgb& a = image.pixels[top * width + left];
  const base::Rgb& b = image.pixels[top * width + right];
  const base::Rgb& c = image.pixels[bottom * width + left];
  const base::Rgb& d = image.pixels[bottom * width + right];
  const auto mix = [u, v](std::uint8_t p, std::uint8_t q, std::uint8_t r, std::uint8_t s) {
    const float above = static_cast<float>(p) + u * (static_cast<float>(q) - static_cast<float>(p));
    const float below = static_cast<float>(r) + u * (static_cast<float>(s) - static_cast<float>(r));
    return static_cast<std::uint8_t>(above + v * (below - above) + 0.5F);
  };
  return {mix(a.r, b.r, c.r, d.r), mix(a.g, b.g, c.g, d.g), mix(a.b, b.b, c.b, d.b)};
}

core::RgbImage black_image(int width_px, int height_px) {
  core::RgbImage image{width_px, height_px, {}};
  image.pixels.resize(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  return image;
}

}  // namespace

LensTable::LensTable(const ScreenLens& lens, int width_px, int height_px, int side)
    : width_px_(width_px), height_px_(height_px), image_(lens_image(lens, width_px, height_px, side)) {
  const glm::dvec2 axis = lens_axis_px(lens, width_px, height_px, side);
  const double unit_px = 0.5 * height_px;
  positions_.reserve(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const glm::dvec2 p = (glm::dvec2(x + 0.5, y + 0.5) - axis) / unit_px;
      positions_.emplace_back(image_.axis_px + undistorted(lens, p) * unit_px);
    }
  }
}

glm::vec2 LensTable::at(int x, int y) const {
  return positions_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px_) +
                    static_cast<std::size_t>(x)];
}

core::RgbImage through_lens(const core::RgbImage& undistorted_image, const LensTable& table) {
  check_pixels(undistorted_image);
  const glm::vec2 scale{
      static_cast<float>(undistorted_image.width) / static_cast<float>(table.image().width_px),
      static_cast<float>(undistorted_image.height) / static_cast<float>(table.image().height_px)};
  core::RgbImage image = black_image(table.width_px(), table.height_px());
  std::size_t n = 0;
  for (int y = 0; y < table.height_px(); ++y)
    for (int x = 0; x < table.width_px(); ++x)
      image.pixels[n++] = filtered_colour(undistorted_image, table.at(x, y) * scale);
  return image;
}

core::RgbImage without_lens(const core::RgbImage& screen_image, const ScreenLens& lens, int side) {
  check_pixels(screen_image);
  const int width_px = screen_image.width;
  const int height_px = screen_image.height;
  const LensImage whole = lens_image(lens, width_px, height_px, side);
  const glm::dvec2 axis = lens_axis_px(lens, width_px, height_px, side);
  const double unit_px = 0.5 * height_px;
  const double most_radius = lens_radius(lens, width_px, height_px, side);
  core::RgbImage image = black_image(whole.width_px, whole.height_px);
  std::size_t n = 0;
  for (int y = 0; y < whole.height_px; ++y) {
    for (int x = 0; x < whole.width_px; ++x, ++n) {
      const glm::dvec2 q = (glm::dvec2(x + 0.5, y + 0.5) - whole.axis_px) / unit_px;
      const auto p = distorted(lens, q, most_radius);
      if (!p) continue;
      const glm::dvec2 xy = axis + *p * unit_px;
      if (xy.x >= 0 && xy.y >= 0 && xy.x <= width_px && xy.y <= height_px)
        image.pixels[n] = filtered_colour(screen_image, xy);
    }
  }
  return image;
}

}  // namespace vpe::explore
