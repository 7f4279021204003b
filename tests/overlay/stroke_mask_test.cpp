// Tests the coverage of thin lines against samples of pixels, and against Cairo's strokes.
#include "vpe/overlay/stroke_mask.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <random>

#include "vpe/overlay/canvas.h"

namespace {

using vpe::overlay::Canvas;
using vpe::overlay::dashes;
using vpe::overlay::kWidestThinLine_px;
using vpe::overlay::StrokeMask;
using Points = std::vector<glm::dvec2>;

constexpr int kSide_px = 96;

using Pixels = std::vector<int>;

Pixels taken(StrokeMask& mask, int width) {
  Pixels out(static_cast<std::size_t>(width) * kSide_px, 0);
  mask.take_rows([&](int y, int x, std::span<const std::uint8_t> coverage) {
    std::copy(coverage.begin(), coverage.end(), out.begin() + y * width + x);
  });
  return out;
}

Pixels coverage(const Points& points, double width_px, bool closed = false) {
  StrokeMask mask(kSide_px, kSide_px);
  mask.add(points, closed, width_px);
  return taken(mask, kSide_px);
}

// Returns whether a line with round corners and square ends covers a place.
bool covers(const Points& points, double radius_px, glm::dvec2 p) {
  for (std::size_t n = 0; n + 1 < points.size(); ++n) {
    const glm::dvec2 along = glm::normalize(points[n + 1] - points[n]);
    const double t = glm::dot(p - points[n], along);
    const double s = std::abs(along.x * (p.y - points[n].y) - along.y * (p.x - points[n].x));
    if (t >= 0 && t <= glm::length(points[n + 1] - points[n]) && s <= radius_px) return true;
    if (n > 0 && glm::length(p - points[n]) <= radius_px) {
      const glm::dvec2 before = points[n] - points[n - 1];
      if (glm::dot(p - points[n], before) >= 0 && glm::dot(p - points[n], along) <= 0) return true;
    }
  }
  return false;
}

double distance_px(const Points& points, glm::dvec2 p) {
  double least = 1e9;
  for (std::size_t n = 0; n + 1 < points.size(); ++n) {
    const glm::dvec2 along = points[n + 1] - points[n];
    const double t = std::clamp(glm::dot(p - points[n], along) / glm::dot(along, along), 0.0, 1.0);
    least = std::min(least, glm::length(p - points[n] - along * t));
  }
  return least;
}

Pixels sampled(const Points& points, double width_px) {
  constexpr int kSamples = 32;  // along a pixel's side
  Pixels out(kSide_px * kSide_px, 0);
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 0; x < kSide_px; ++x) {
      if (distance_px(points, {x + 0.5, y + 0.5}) > 0.5 * width_px + 1) continue;
      int hits = 0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const glm::dvec2 at(x + (k % kSamples + 0.5) / kSamples, y + (k / kSamples + 0.5) / kSamples);
        hits += covers(points, 0.5 * width_px, at) ? 1 : 0;
      }
      out[static_cast<std::size_t>(y * kSide_px + x)] =
          (255 * hits + kSamples * kSamples / 2) / (kSamples * kSamples);
    }
  }
  return out;
}

struct Difference {
  int most = 0;
  double mean = 0;
  double rms = 0;
};

Difference difference(const Pixels& a, const Pixels& b) {
  Difference d;
  double touched = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    if (a[n] == 0 && b[n] == 0) continue;
    const int off = a[n] - b[n];
    d.most = std::max(d.most, std::abs(off));
    d.mean += off;
    d.rms += off * off;
    ++touched;
  }
  d.mean /= touched;
  d.rms = std::sqrt(d.rms / touched);
  return d;
}

Points winding(std::mt19937& random, double step_px, double bend, int steps) {
  std::uniform_real_distribution<double> any(-1, 1);
  Points points{{48 + 20 * any(random), 48 + 20 * any(random)}};
  double angle = 4 * any(random);
  const double turn = 0.2 * bend * any(random);
  for (int n = 0; n < steps; ++n) {
    angle += turn + bend * any(random);
    points.push_back(points.back() + step_px * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

TEST(StrokeMask, CoversTheWholePixelsOfAStraightLine) {
  const Pixels pixels = coverage({{10, 20.5}, {30, 20.5}}, 1);
  for (int y = 0; y < kSide_px; ++y) {
    for (int x = 0; x < kSide_px; ++x) {
      ASSERT_EQ(pixels[static_cast<std::size_t>(y * kSide_px + x)], y == 20 && x >= 10 && x < 30 ? 255 : 0)
          << x << " " << y;
    }
  }
}

TEST(StrokeMask, IsTheAreaOfStraightLinesInAnyDirection) {
  std::mt19937 random(1);
  for (int n = 0; n < 40; ++n) {
    const Points line = winding(random, 30, 0, 1);
    for (const double width_px : {0.4, 1.0, 1.7, kWidestThinLine_px}) {
      const Difference d = difference(coverage(line, width_px), sampled(line, width_px));
      // Pixels at the four corners are least exact.
      ASSERT_LE(d.most, 24) << n << " " << width_px;
      ASSERT_LE(d.rms, 6) << n << " " << width_px;
      ASSERT_LE(std::abs(d.mean), 1) << n << " " << width_px;
    }
  }
}

TEST(StrokeMask, IsNearlyTheAreaOfBentLines) {
  std::mt19937 random(2);
  for (const double bend : {0.1, 0.5}) {
    double mean = 0, rms = 0;
    constexpr int kLines = 25;
    for (int n = 0; n < kLines; ++n) {
      const Points line = winding(random, 3, bend, 10);
      const Difference d = difference(coverage(line, 1.5), sampled(line, 1.5));
      ASSERT_LE(d.most, 128) << bend << " " << n;
      mean += d.mean / kLines;
      rms += d.rms / kLines;
    }
    EXPECT_LE(std::abs(mean), 1) << bend;
    EXPECT_LE(rms, 7) << bend;
  }
}

TEST(StrokeMask, RoundsCornersOnTheirOutsideAlone) {
  const Points corner{{20, 20}, {50, 20}, {50, 60}};
  const Difference d = difference(coverage(corner, 6), sampled(corner, 6));
  EXPECT_LE(d.most, 24);
  // A tip that turns back is as long as its half width.
  const Pixels tip = coverage({{20, 30}, {50, 30}, {20, 30.01}}, 6);
  EXPECT_EQ(tip[30 * kSide_px + 51], 255);
  EXPECT_EQ(tip[30 * kSide_px + 54], 0);
}

TEST(StrokeMask, ClosesRings) {
  const Points square{{20, 20}, {60, 20}, {60, 60}, {20, 60}};
  const Pixels open = coverage(square, 2), ring = coverage(square, 2, true);
  const auto at = [](int x, int y) { return static_cast<std::size_t>(y * kSide_px + x); };
  EXPECT_EQ(open[at(20, 40)], 0);
  EXPECT_EQ(ring[at(20, 40)], 255);
  EXPECT_EQ(ring[at(19, 40)], 255);
  EXPECT_GT(ring[at(19, 19)], 150);  // round as the others
  EXPECT_EQ(ring[at(19, 19)], ring[at(60, 60)]);
}

TEST(StrokeMask, LeavesOutWhatIsOutside) {
  std::mt19937 random(3);
  constexpr int kBeside_px = 40;
  for (int n = 0; n < 50; ++n) {
    Points line = winding(random, 17, 1, 12);
    for (glm::dvec2& p : line) p = glm::round(p * 1024.0) / 1024.0;
    StrokeMask wide(kSide_px + 2 * kBeside_px, kSide_px);
    Points moved = line;
    for (glm::dvec2& p : moved) p.x += kBeside_px;
    wide.add(moved, false, 2);
    const Pixels whole = taken(wide, kSide_px + 2 * kBeside_px), part = coverage(line, 2);
    for (int y = 0; y < kSide_px; ++y) {
      for (int x = 0; x < kSide_px; ++x) {
        ASSERT_EQ(part[static_cast<std::size_t>(y * kSide_px + x)],
                  whole[static_cast<std::size_t>(y * (kSide_px + 2 * kBeside_px) + x + kBeside_px)]);
      }
    }
  }
}

TEST(StrokeMask, EndsFarOutsideChangeNothing) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(10, 86);
  for (int n = 0; n < 50; ++n) {
    const glm::dvec2 a(place(random), place(random)), b(place(random), place(random));
    const glm::dvec2 along = glm::normalize(b - a);
    const Pixels near = coverage({a - 300.0 * along, a + 300.0 * along}, 2);
    for (const double far_px : {1e5, 3e7, 1e12}) {
      const Pixels far =
          coverage({a - far_px * along, a + far_px * along, a + far_px * glm::dvec2(along.y, along.x)}, 2);
      for (std::size_t k = 0; k < near.size(); ++k)
        ASSERT_NEAR(far[k], near[k], 3 + 1e-12 * far_px) << "line " << n << " to " << far_px << " px";
    }
  }
}

TEST(StrokeMask, PlacesThatAreNoNumbersAreLeftOut) {
  const Pixels straight = coverage({{10, 10}, {80, 80}}, 2);
  for (const double no : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                          -std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(coverage({{10, 10}, {no, 50}, {50, no}, {80, 80}}, 2), straight) << no;
    EXPECT_EQ(coverage({{no, no}, {10, 10}, {80, 80}, {no, 0}}, 2, true), straight) << no;
  }
}

TEST(StrokeMask, IsEmptyAfterItsRowsWereTaken) {
  StrokeMask mask(kSide_px, kSide_px);
  mask.add(Points{{5, 5}, {90, 80}}, false, 3);
  EXPECT_GT(std::ranges::count_if(taken(mask, kSide_px), [](int c) { return c > 0; }), 100);
  EXPECT_EQ(std::ranges::count_if(taken(mask, kSide_px), [](int c) { return c > 0; }), 0);
  mask.add(Points{{5, 5}}, true, 3);
  mask.add(Points{{5, 5}, {5, 5}}, false, 3);
  mask.add({}, true, 3);
  EXPECT_EQ(std::ranges::count_if(taken(mask, kSide_px), [](int c) { return c > 0; }), 0);
}

TEST(StrokeMask, HasTheSameBitsOnAllInstructionSets) {
  std::mt19937 random(4);
  for (int n = 0; n < 20; ++n) {
    const Points line = winding(random, 5, 0.9, 15);
    const Pixels best = coverage(line, 1.3);
    for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
      hwy::SetSupportedTargetsForTest(targets & -targets);
      const Pixels other = coverage(line, 1.3);
      hwy::SetSupportedTargetsForTest(0);
      ASSERT_EQ(best, other) << hwy::TargetName(targets & -targets);
    }
  }
}

TEST(StrokeMask, LooksLikeCairosStrokes) {
  std::mt19937 random(5);
  const auto alpha = [](const Points& line, double width_px) {
    Canvas canvas(kSide_px, kSide_px);
    canvas.line(line, false, width_px, {1, 1, 1, 1});
    Pixels out;
    for (const auto& p : canvas.layer().pixels) out.push_back(p.a);
    return out;
  };
  for (int n = 0; n < 30; ++n) {
    const Points line = winding(random, 4, 0.2, 12);
    const Pixels thin = alpha(line, kWidestThinLine_px),
                 wide = alpha(line, std::nextafter(kWidestThinLine_px, 10));
    const Difference d = difference(thin, wide);
    EXPECT_LE(d.most, 64);  // Cairo has 15 rows of samples in a pixel
    EXPECT_LE(d.rms, 5);
    EXPECT_LE(std::abs(d.mean), 0.5);
  }
}

TEST(Dashes, HaveTheirLengths) {
  const Points line{{0, 0}, {10, 0}, {10, 25}};
  const auto parts = dashes(line, std::array{4.0, 3.0});
  // 35 px are five patterns of 7.
  ASSERT_EQ(parts.size(), 5U);
  EXPECT_EQ(parts[0], (Points{{0, 0}, {4, 0}}));
  EXPECT_EQ(parts[1], (Points{{7, 0}, {10, 0}, {10, 1}}));
  EXPECT_NEAR(glm::length(parts[4][0] - glm::dvec2(10, 18)), 0, 1e-12);
  EXPECT_EQ(dashes(line, {}), (std::vector<Points>{line}));
  EXPECT_EQ(dashes(line, std::array{0.0}), (std::vector<Points>{line}));
  EXPECT_TRUE(dashes(Points{{1, 1}}, std::array{1.0}).empty());
}

TEST(Dashes, ContinueAnOddPatternWithItsGapsAndStrokesInTurn) {
  const auto parts = dashes(Points{{0, 0}, {10, 0}}, std::array{2.0});
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[1], (Points{{4, 0}, {6, 0}}));
  EXPECT_EQ(parts[2], (Points{{8, 0}, {10, 0}}));
}

}  // namespace
