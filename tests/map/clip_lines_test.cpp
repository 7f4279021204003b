// Lines cut at boxes of longitudes and latitudes.
#include "vpe/map/clip_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/support.h"

namespace vpe::map {
namespace {

using Vertices = std::vector<glm::dvec2>;
using Parts = std::vector<Vertices>;

constexpr PlaceBox kBox{10, -5, 20, 5};

TEST(ClipLines, KeepsWhatIsInside) {
  const Vertices line{{11, 0}, {15, 4}, {19, -4}};
  EXPECT_EQ(clip_line(line, kBox), Parts{line});
  EXPECT_TRUE(clip_line(Vertices{{21, 0}, {25, 4}}, kBox).empty());
  EXPECT_TRUE(clip_line(Vertices{{5, 8}, {25, 8}}, kBox).empty());
  EXPECT_TRUE(clip_line(Vertices{}, kBox).empty());
  EXPECT_TRUE(clip_line(Vertices{{15, 0}}, kBox).empty());
}

TEST(ClipLines, CutsAtEdges) {
  EXPECT_EQ(clip_line(Vertices{{5, 0}, {15, 0}, {15, 10}}, kBox), (Parts{Vertices{{10, 0}, {15, 0}, {15, 5}}}));
  const auto parts = clip_line(Vertices{{5, 0}, {25, 0}, {25, 2}, {5, 2}}, kBox);
  EXPECT_EQ(parts, (Parts{Vertices{{10, 0}, {20, 0}}, Vertices{{20, 2}, {10, 2}}}));
}

TEST(ClipLines, TurnsLongitudesToTheBox) {
  const PlaceBox box{170, -10, 190, 10};
  EXPECT_EQ(clip_line(Vertices{{-185, 0}, {-175, 0}}, box), (Parts{Vertices{{175, 0}, {185, 0}}}));
  EXPECT_EQ(clip_line(Vertices{{-185, 0}, {-160, 0}}, box), (Parts{Vertices{{175, 0}, {190, 0}}}));
  // A line on the far side of the planet, over the box's antimeridian.
  EXPECT_TRUE(clip_line(Vertices{{-10, 0}, {10, 0}}, box).empty());
}

TEST(ClipLines, ARingStaysOne) {
  const Vertices inside{{12, 0}, {14, 2}, {16, 0}, {12, 0}};
  EXPECT_EQ(clip_line(inside, kBox), Parts{inside});
  // Its seam is inside, and it leaves the box once: one part over the seam.
  const Vertices over{{19, 0}, {19, 2}, {22, 2}, {22, -2}, {19, -2}, {19, 0}};
  EXPECT_EQ(clip_line(over, kBox), (Parts{Vertices{{20, -2}, {19, -2}, {19, 0}, {19, 2}, {20, 2}}}));
}

TEST(ClipLines, AroundThePoleLinesTurnOnAndOn) {
  const PlaceBox cap{-180, 60, 180, 90};
  Vertices ring;
  for (int n = 0; n <= 12; ++n) ring.emplace_back(100 + 30 * n, 75);
  const auto parts = clip_line(ring, cap);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0], ring);
  // A ring that dips below the cap at its seam.
  ring.front().y = 50;
  ring.back().y = 50;
  const auto cut = clip_line(ring, cap);
  ASSERT_EQ(cut.size(), 1U);
  EXPECT_EQ(cut[0].size(), 13U);
  EXPECT_EQ(cut[0].front().y, 60);
  EXPECT_EQ(cut[0].back().y, 60);
  EXPECT_NEAR(cut[0].back().x - cut[0].front().x, 360 - 2 * 12, 1e-9);
}

TEST(ClipLines, KeepsTheLengthInside) {
  // Of many points on a random line, those inside are on a part, and no part leaves the box.
  test_support::Random random(51);
  for (int n = 0; n < 200; ++n) {
    Vertices line;
    for (int k = 0; k < 12; ++k) {
      const double x = random.uniform(5, 25);
      line.emplace_back(x, random.uniform(-10, 10));
    }
    double inside = 0;
    constexpr int kSamples = 4000;
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const glm::dvec2 step = line[k + 1] - line[k];
      for (int s = 0; s < kSamples; ++s) {
        const glm::dvec2 at = line[k] + step * ((s + 0.5) / kSamples);
        if (at.x > 10 && at.x < 20 && at.y > -5 && at.y < 5) inside += std::hypot(step.x, step.y) / kSamples;
      }
    }
    double kept = 0;
    for (const Vertices& part : clip_line(line, kBox)) {
      for (std::size_t k = 0; k < part.size(); ++k) {
        EXPECT_TRUE(part[k].x >= 10 - 1e-9 && part[k].x <= 20 + 1e-9 && std::abs(part[k].y) <= 5 + 1e-9);
        if (k > 0) kept += std::hypot(part[k].x - part[k - 1].x, part[k].y - part[k - 1].y);
      }
    }
    EXPECT_NEAR(kept, inside, 0.1);
  }
}

}  // namespace
}  // namespace vpe::map
