// Lines of pixels: they cover images of all sizes at all angles, each pixel once.
#include "vpe/voxel/columns/pixel_lines.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <rapidcheck/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace vpe::voxel {
namespace {

// Returns what is wrong with the lines, or "".
std::string problem_of(int width, int height, const glm::dvec2& along) {
  const PixelLines lines(width, height, along);
  std::vector<int> count(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<PixelLines::Pixel> pixels;
  const double length = std::max(std::abs(along.x), std::abs(along.y));
  for (int n = 0; n < lines.count(); ++n) {
    lines.get(n, pixels);
    if (pixels.empty()) return "an empty line";
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const PixelLines::Pixel& p = pixels[k];
      if (p.x < 0 || p.y < 0 || p.x >= width || p.y >= height) return "a pixel beyond the image";
      ++count[static_cast<std::size_t>(p.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(p.x)];
      if (k == 0) continue;
      const int dx = p.x - pixels[k - 1].x;
      const int dy = p.y - pixels[k - 1].y;
      if (std::abs(dx) > 1 || std::abs(dy) > 1) return "a gap";
      if (length > 0 && dx * along.x + dy * along.y <= 0) return "a step back";
      // Not farther from the straight line than a pixel.
      const double aside = (p.x - pixels[0].x) * along.y - (p.y - pixels[0].y) * along.x;
      if (std::abs(aside) > 1.0001 * length) return "a bend";
    }
  }
  return std::all_of(count.begin(), count.end(), [](int c) { return c == 1; }) ? "" : "a pixel not once";
}

TEST(PixelLines, CoverImagesAtAllAngles) {
  for (int degrees = 0; degrees < 360; ++degrees) {
    const double angle = degrees * 3.14159265358979323846 / 180;
    for (const auto& [width, height] : {std::pair(7, 5), std::pair(5, 7), std::pair(64, 48), std::pair(1, 9)})
      EXPECT_EQ(problem_of(width, height, {std::sin(angle), -std::cos(angle)}), "") << degrees;
  }
  for (const glm::dvec2& along :
       {glm::dvec2(0, -1), glm::dvec2(0, 0), glm::dvec2(1, -1), glm::dvec2(1e-300, -1)})
    EXPECT_EQ(problem_of(31, 17, along), "");
}

RC_GTEST_PROP(PixelLinesProperty, CoverImagesOfAllSizes, ()) {
  const int width = *rc::gen::inRange(1, 90);
  const int height = *rc::gen::inRange(1, 90);
  const double x = *rc::gen::inRange(-1000, 1001);
  const double y = *rc::gen::inRange(-1000, 1001);
  RC_ASSERT(problem_of(width, height, {x, y}).empty());
}

// As the paper has it: of an image that is rolled by up to 45 degrees, as many lines as columns and shifts.
TEST(PixelLines, AreAsManyAsColumnsAndShifts) {
  const PixelLines upright(50, 40, {0, -1});
  EXPECT_EQ(upright.count(), 50);
  EXPECT_EQ(std::count(upright.shifts().begin(), upright.shifts().end(), 1), 0);
  const PixelLines rolled(50, 40, {0.5, -1});
  EXPECT_EQ(rolled.count(), 50 + std::count(rolled.shifts().begin(), rolled.shifts().end(), 1));
  EXPECT_EQ(rolled.shifts().size(), 40U);
  EXPECT_EQ(PixelLines(50, 40, {1, -1}).count(), 50 + 39);
  EXPECT_THROW(PixelLines(0, 4, {0, -1}), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::voxel
