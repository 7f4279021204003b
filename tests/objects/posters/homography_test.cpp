// A drawn image against the homography of its four corners, in closed form (Heckbert 1989, Fundamentals of Texture Mapping and
// Image Warping, section 2.2.3).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "tests/objects/posters/poster_fixture.h"

namespace objects {
namespace {

using namespace test;

// Returns the matrix that takes (u, v, 1), of the unit square, to places of the corners (0, 0), (1, 0), (1, 1), (0, 1).
glm::dmat3 square_to_quad(const std::array<glm::dvec2, 4>& q) {
  const glm::dvec2 sum = q[0] - q[1] + q[2] - q[3];
  const glm::dvec2 d1 = q[1] - q[2];
  const glm::dvec2 d2 = q[3] - q[2];
  const double det = d1.x * d2.y - d2.x * d1.y;
  const double g = (sum.x * d2.y - d2.x * sum.y) / det;
  const double h = (d1.x * sum.y - sum.x * d1.y) / det;
  return glm::transpose(glm::dmat3(q[1].x - q[0].x + g * q[1].x, q[3].x - q[0].x + h * q[3].x, q[0].x,
                                   q[1].y - q[0].y + g * q[1].y, q[3].y - q[0].y + h * q[3].y, q[0].y, g, h,
                                   1));
}

PlacedPoster random_pane(const core::DrawRequest& r, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  PlacedPoster p = pane_before(r, ramp_image(256, 256), {unit(random), unit(random), 9 + 2 * unit(random)},
                               3 + unit(random), 2.5 + unit(random));
  mars::LocalFrame frame{p.axes.right, p.axes.forward, p.axes.up};
  p.axes = mars::oriented_axes(frame, 55 * unit(random), 45 * unit(random), 180 * unit(random));
  return p;
}

TEST(PosterHomography, PixelsAgreeWithTheFourCorners) {
  constexpr unsigned kSeed = 20261127;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random(kSeed);
  std::int64_t inside_pixels = 0;
  for (int n = 0; n < 40; ++n) {
    const core::DrawRequest r = request_of();
    const PlacedPoster p = random_pane(r, random);
    std::array<glm::dvec2, 4> corners;
    constexpr std::array<glm::dvec2, 4> kUv{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t c = 0; c < 4; ++c) {
      const glm::dvec3 at =
          p.middle_m + (kUv[c].x - 0.5) * p.width_m * p.axes.right + (0.5 - kUv[c].y) * p.tall_m * p.axes.up;
      const core::Projected projected = core::project(r.view, at);
      ASSERT_FALSE(projected.behind);
      corners[c] = projected.xy;
    }
    const glm::dmat3 to_uv = glm::inverse(square_to_quad(corners));
    const SeenPosters seen({&p, 1}, r.view, 1);
    core::Frame frame = empty_frame(r);
    (void)draw_posters(r, {&p, 1}, frame);
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        const glm::dvec3 h = to_uv * glm::dvec3(x + 0.5, y + 0.5, 1);
        const glm::dvec2 uv(h.x / h.z, h.y / h.z);
        constexpr double kBorder = 1e-6;
        const auto within = [](const glm::dvec2& at, double margin) {
          return at.x > margin && at.x < 1 - margin && at.y > margin && at.y < 1 - margin;
        };
        const std::size_t pixel = pixel_at(frame, x, y);
        const bool is_drawn = std::isfinite(frame.range_m[pixel]);
        if (within(uv, kBorder)) {
          EXPECT_TRUE(is_drawn) << x << " " << y;
        }
        if (!within(uv, -kBorder)) {
          EXPECT_FALSE(is_drawn) << x << " " << y;
        }
        if (!is_drawn) continue;
        ++inside_pixels;
        // The place in closed form, to single precision.
        const auto hit = seen.meet(0, core::pixel_ray(r.view, x + 0.5, y + 0.5), 1e9);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->uv.x, uv.x, 1e-6);
        EXPECT_NEAR(hit->uv.y, uv.y, 1e-6);
        // Colours count columns and rows; what a pixel covers is averaged, which at borders is less than the whole.
        constexpr double kInner = 0.05;
        if (!within(uv, kInner)) continue;
        EXPECT_NEAR(frame.colour[pixel].r, 255 * (uv.x * 256 - 0.5) / 255, 2.0);
        EXPECT_NEAR(frame.colour[pixel].g, 255 * (uv.y * 256 - 0.5) / 255, 2.0);
      }
    }
  }
  EXPECT_GT(inside_pixels, 40'000);
}

}  // namespace
}  // namespace objects
