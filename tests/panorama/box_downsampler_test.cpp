// Smaller copies: means over areas, for odd sizes too.
#include "panorama/image/box_downsampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using panorama::BoxDownsampler;

// The definition, in floating point.
double mean_over(const std::vector<vpe::base::Rgb>& pixels, int width, int height, int x, int y) {
  const double across = width / std::ceil(width / 2.0);
  const double down = height / std::ceil(height / 2.0);
  double sum = 0;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double w = std::min(column + 1.0, (x + 1) * across) - std::max<double>(column, x * across);
      const double h = std::min(row + 1.0, (y + 1) * down) - std::max<double>(row, y * down);
      if (w > 0 && h > 0)
        sum += w * h *
               pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(column)]
                   .g;
    }
  }
  return sum / (across * down);
}

TEST(BoxDownsampler, IsTheMeanOverTheArea) {
  for (const auto& [width, height] :
       {std::pair(8, 6), {7, 6}, {8, 5}, {9, 7}, {1, 1}, {1, 5}, {3, 1}, {2, 2}}) {
    std::vector<vpe::base::Rgb> pixels(static_cast<std::size_t>(width * height));
    for (std::size_t n = 0; n < pixels.size(); ++n)
      pixels[n] = {0, static_cast<std::uint8_t>((n * n * 37 + n * 11) % 256), 255};
    std::vector<vpe::base::Rgb> half;
    BoxDownsampler downsampler(width, height, [&](std::span<const vpe::base::Rgb> row) {
      half.insert(half.end(), row.begin(), row.end());
    });
    for (int y = 0; y < height; ++y)
      downsampler.take(
          std::span(pixels).subspan(static_cast<std::size_t>(y * width), static_cast<std::size_t>(width)));
    const int half_width = (width + 1) / 2;
    ASSERT_EQ(half.size(), static_cast<std::size_t>(half_width * ((height + 1) / 2)));
    for (std::size_t n = 0; n < half.size(); ++n) {
      const int x = static_cast<int>(n) % half_width;
      const int y = static_cast<int>(n) / half_width;
      EXPECT_NEAR(half[n].g, mean_over(pixels, width, height, x, y), 0.5 + 1e-9) << width << "x" << height;
      EXPECT_EQ(half[n].r, 0);
      EXPECT_EQ(half[n].b, 255);
    }
  }
}

}  // namespace
