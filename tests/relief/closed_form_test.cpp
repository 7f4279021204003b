// Closed forms of the shapes.
#include <gtest/gtest.h>

#include <cmath>

#include "mars/geodesy/sphere.h"
#include "relief/crater.h"
#include "relief/dune.h"
#include "relief/earthworks.h"
#include "relief/interval_math.h"
#include "relief/noise.h"
#include "relief/weights.h"
#include "tests/support/support.h"

namespace relief {
namespace {

using mars::kPi;

double slope_of_deg(double angle_deg) { return std::tan(angle_deg * mars::kRadiansPerDegree); }

TEST(ReliefCrater, HasTheSizesOfFreshCraters) {
  const CraterSize simple = mars_crater(500);
  EXPECT_DOUBLE_EQ(simple.depth_m, 200);
  EXPECT_DOUBLE_EQ(simple.rim_m, 40);
  EXPECT_EQ(simple.floor_ratio, 0);
  EXPECT_EQ(simple.peak_m, 0);
  const CraterSize complex = mars_crater(50000);
  EXPECT_NEAR(complex.depth_m, 360 * std::pow(100, 0.49), 1e-9);
  EXPECT_NEAR(complex.floor_ratio, 0.187 * std::pow(100, 0.249), 1e-12);
  EXPECT_NEAR(complex.peak_m, 40 * std::pow(100, 0.51), 1e-9);
}

TEST(ReliefCrater, SizesAreContinuousInTheRadius) {
  CraterSize before = mars_crater(10);
  for (double radius_m = 10.01; radius_m < 60000; radius_m *= 1.001) {
    const CraterSize size = mars_crater(radius_m);
    EXPECT_GT(size.depth_m, before.depth_m);
    EXPECT_LT(size.depth_m, 1.002 * before.depth_m);
    EXPECT_LT(std::abs(size.floor_ratio - before.floor_ratio), 0.002);
    EXPECT_LT(std::abs(size.peak_m - before.peak_m), 0.003 * size.depth_m);
    before = size;
  }
}

TEST(ReliefCrater, HasItsProfileAtCentreRimAndFar) {
  const CraterShape crater({100, 40, 8, 0, 0, 5});
  EXPECT_DOUBLE_EQ(crater.height_m(0, 0), -32);
  EXPECT_DOUBLE_EQ(crater.height_m(100, 0), 8);
  EXPECT_DOUBLE_EQ(crater.height_m(0, -50), -32 + 40 * 0.25);
  EXPECT_DOUBLE_EQ(crater.height_m(120, 160), 1);  // r = 2 R: the rim / 8
  EXPECT_EQ(crater.height_m(500, 0), 0);
  EXPECT_EQ(crater.height_m(-800, 800), 0);
  EXPECT_GT(crater.height_m(499, 0), 0);
  EXPECT_LT(crater.height_m(499, 0), 1e-4);
}

TEST(ReliefCrater, HasAFloorWithAPeak) {
  const CraterShape crater({1000, 300, 60, 0.4, 50, 4});
  EXPECT_DOUBLE_EQ(crater.height_m(0, 0), -240 + 50);
  EXPECT_DOUBLE_EQ(crater.height_m(210, 0), -240);
  EXPECT_DOUBLE_EQ(crater.height_m(0, 390), -240);
  EXPECT_NEAR(crater.height_m(700, 0), -240 + 300 * 0.25, 1e-9);
}

TEST(ReliefCrater, HasTheVolumeOfAParaboloid) {
  const CraterShape crater({100, 40, 8, 0, 0, 5});
  double below_m3 = 0;
  constexpr double kStep_m = 0.05;
  for (double r_m = kStep_m / 2; r_m < 100; r_m += kStep_m)
    below_m3 += 2 * kPi * r_m * kStep_m * (8 - crater.height_m(r_m, 0));
  EXPECT_NEAR(below_m3, kPi * 100 * 100 * 40 / 2, 1);
}

TEST(ReliefEarthworks, RampsRiseAlongTheirLength) {
  const RampShape ramp(40, -1, 3);
  EXPECT_EQ(ramp.height_m(-20, 7), -1);
  EXPECT_EQ(ramp.height_m(-50, 0), -1);
  EXPECT_EQ(ramp.height_m(0, -3), 1);
  EXPECT_EQ(ramp.height_m(20, 0), 3);
  EXPECT_EQ(ramp.height_m(1e9, 0), 3);
  EXPECT_EQ(ramp.gradient(3, 3), glm::dvec2(0.1, 0));
}

TEST(ReliefEarthworks, TrenchesHaveWallsOfTheirSlope) {
  const TrenchShape trench(100, 10, 6, 60);
  EXPECT_EQ(trench.height_m(0, 0), -6);
  EXPECT_EQ(trench.height_m(50, 5), -6);
  EXPECT_NEAR(trench.height_m(0, 6), -6 + slope_of_deg(60), 1e-12);
  EXPECT_NEAR(trench.height_m(-51, 0), -6 + slope_of_deg(60), 1e-12);
  EXPECT_NEAR(trench.height_m(51, 6), -6 + std::sqrt(2) * slope_of_deg(60), 1e-12);
  EXPECT_EQ(trench.height_m(0, 5 + 6 / slope_of_deg(60) + 1e-9), 0);
  EXPECT_NEAR(trench.gradient(0, -6).y, -slope_of_deg(60), 1e-12);
}

TEST(ReliefEarthworks, DamsFallFromTheirCrest) {
  const DamShape dam(100, 4, 10, 30);
  EXPECT_EQ(dam.height_m(-50, 2), 10);
  EXPECT_NEAR(dam.height_m(0, 12), 10 - 10 * slope_of_deg(30), 1e-12);
  EXPECT_NEAR(dam.height_m(0, 12), dam.height_m(60, 0), 1e-12);
}

TEST(ReliefDune, HasTheAngleOfReposeDownwind) {
  const DuneShape dune({10, 100, 60, 30, 33, true});
  EXPECT_EQ(dune.height_m(0, 0), 10);
  EXPECT_NEAR(dune.height_m(5, 0), 10 - 5 * slope_of_deg(33), 1e-12);
  EXPECT_EQ(dune.height_m(16, 0), 0);
  EXPECT_NEAR(dune.height_m(-30, 0), 7.5, 1e-12);
  EXPECT_EQ(dune.height_m(-60, 0), 0);
  // Half of the way to an end the crest has moved by a quarter of the horns.
  EXPECT_NEAR(dune.height_m(7.5, 25), 10 * 0.75 * 0.75, 1e-12);
  EXPECT_EQ(dune.height_m(30, 50), 0);
}

TEST(ReliefDune, TransverseDunesAreStraight) {
  const DuneShape dune({10, 100, 60, 0, 33, false});
  for (double y_m = -30; y_m <= 30; y_m += 5) EXPECT_EQ(dune.height_m(-20, y_m), dune.height_m(-20, 0));
  EXPECT_EQ(dune.height_m(0, 50), 0);
}

TEST(ReliefWeights, FallFromOneToNone) {
  const CircleWeight circle(10, 4);
  EXPECT_EQ(circle.height_m(6, 8), 1);
  EXPECT_DOUBLE_EQ(circle.height_m(0, 12), 0.5);
  EXPECT_EQ(circle.height_m(14, 0), 0);
  const BoxWeight box({-5, -1, 5, 1}, 2);
  EXPECT_EQ(box.height_m(5, -1), 1);
  EXPECT_DOUBLE_EQ(box.height_m(6, 0), 0.5);
  EXPECT_EQ(box.height_m(0, 3), 0);
  const PolygonWeight square({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 2);
  EXPECT_EQ(square.height_m(5, 5), 1);
  EXPECT_DOUBLE_EQ(square.height_m(1, 5), 0.5);
  EXPECT_EQ(square.height_m(0, 5), 0);
  EXPECT_EQ(square.height_m(-1, 5), 0);
  EXPECT_EQ(square.bounds_m({4, 4, 5, 5}).low, 1);
}

TEST(ReliefNoise, StaysWithinItsAmplitudeAndItsSlope) {
  const NoiseShape noise({3, 10, 1, 0.5, 7});
  test_support::Random random(8);
  double highest_m = 0;
  double steepest = 0;
  for (int n = 0; n < 400000; ++n) {
    const double x_m = random.uniform(-1e4, 1e4);
    const double y_m = random.uniform(-1e4, 1e4);
    highest_m = std::max(highest_m, std::abs(noise.height_m(x_m, y_m)));
    const glm::dvec2 gradient = noise.gradient(x_m, y_m);
    steepest = std::max({steepest, std::abs(gradient.x), std::abs(gradient.y)});
  }
  EXPECT_LE(highest_m, 3);
  EXPECT_GE(highest_m, 2);
  EXPECT_LE(steepest, kNoiseSlope * 3 / 10);
  EXPECT_GE(steepest, 0.5 * kNoiseSlope * 3 / 10);
}

TEST(ReliefNoise, IsItsSeeds) {
  const NoiseShape noise({3, 10, 3, 0.5, 7});
  EXPECT_EQ(noise.height_m(12.5, -3.25), NoiseShape({3, 10, 3, 0.5, 7}).height_m(12.5, -3.25));
  EXPECT_NE(noise.height_m(12.5, -3.25), NoiseShape({3, 10, 3, 0.5, 8}).height_m(12.5, -3.25));
  EXPECT_EQ(noise.height_m(1e300, 0), 0);
}

TEST(ReliefIntervals, DistancesOfARectangleHoldThoseOfItsPoints) {
  const Interval radii = radii_of({-3, 4, 6, 8});
  EXPECT_EQ(radii.low, 4);
  EXPECT_EQ(radii.high, 10);
  const Interval inside = distances_of({-1, -1, 1, 1}, {-0.5, 0, 4, 5});
  EXPECT_EQ(inside.low, 0);
  EXPECT_EQ(inside.high, 5);
  const Interval above = absolute({-3, 2});
  EXPECT_EQ(above.low, 0);
  EXPECT_EQ(above.high, 3);
  EXPECT_EQ(absolute({-3, -2}).low, 2);
}

}  // namespace
}  // namespace relief
