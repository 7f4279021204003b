// Tests the second eye of round panoramas by carrying.
#include "vpe/warp/carry_round.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <stdexcept>

#include "mars/geodesy/sphere.h"
#include "tests/warp/scenes.h"

namespace vpe::warp {
namespace {

using test_support::hills;
using test_support::Scene;
using test_support::texture_at;

constexpr int kTurn_px = 720;
constexpr int kRows = 80;
const glm::dvec3 kViewpoint_m(3, 0, 22);

double elevation_rad(int y) { return (5 - 40 * (y + 0.5) / kRows) * mars::kRadiansPerDegree; }

struct Ray {
  glm::dvec3 from_m{};
  glm::dvec3 direction{};
};

// Returns the ray of an eye, `aside_m` right of the viewpoint across the azimuth of its column.
Ray ray_of(double x, int y, double aside_m) {
  const double azimuth = 2 * mars::kPi * x / kTurn_px;
  const glm::dvec3 ahead(std::sin(azimuth), std::cos(azimuth), 0);
  const glm::dvec3 right(std::cos(azimuth), -std::sin(azimuth), 0);
  const double e = elevation_rad(y);
  return {kViewpoint_m + aside_m * right, std::cos(e) * ahead + std::sin(e) * glm::dvec3(0, 0, 1)};
}

core::Frame panorama_of(const Scene& scene, double aside_m, int first, int width) {
  core::Frame frame{width, kRows, {}, {}};
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < width; ++x) {
      const Ray ray = ray_of(first + x + 0.5, y, aside_m);
      const double range_m = scene.cast_m(ray.from_m, ray.direction);
      frame.range_m.push_back(static_cast<float>(range_m));
      frame.colour.push_back(std::isinf(range_m) ? base::Rgb{200, 180, 160}
                                                 : texture_at(ray.from_m + range_m * ray.direction));
    }
  }
  return frame;
}

std::vector<RoundRow> rows_of(double radius_m) {
  std::vector<RoundRow> rows;
  for (int y = 0; y < kRows; ++y) rows.push_back({radius_m, std::cos(elevation_rad(y))});
  return rows;
}

double moved_px(double radius_m, double range_m, int y) {
  return std::isinf(range_m)
             ? 0
             : kTurn_px / mars::kPi * std::atan(radius_m / (range_m * std::cos(elevation_rad(y))));
}

// The right eye's ray passes through what rays of the left eye in its row meet: the geometry that this rests on.
TEST(CarryRound, APointIsInTheSameRowOfBothEyesAndAsFarAlongTheirRays) {
  constexpr double kRadius_m = 0.7;
  for (const double x : {10.5, 200.25, 719.0}) {
    for (const int y : {2, 40, 79}) {
      for (const double range_m : {8.0, 60.0, 5000.0}) {
        const Ray right = ray_of(x, y, kRadius_m);
        const Ray left = ray_of(x + moved_px(kRadius_m, range_m, y), y, -kRadius_m);
        const glm::dvec3 apart =
            right.from_m + range_m * right.direction - left.from_m - range_m * left.direction;
        EXPECT_LT(glm::length(apart), 1e-12 * range_m + 1e-12);
      }
    }
  }
}

TEST(CarryRound, CarriedPixelsAreWithinTheirBoundsAndNothingHiddenIsShown) {
  base::ThreadPool pool(2);
  Scene plain;
  plain.floors.push_back({{0, 0, 1}, 0});
  for (const Scene& scene : {plain, hills()}) {
    for (const double radius_m : {0.1, 0.5, 1.5}) {
      const int beside = columns_beside(kTurn_px, rows_of(radius_m), 15);
      const core::Frame left = panorama_of(scene, -radius_m, 0, kTurn_px + beside);
      const core::Frame truth = panorama_of(scene, radius_m, 0, kTurn_px);
      CarriedImage right;
      carry_round(left, {kTurn_px, kTurn_px}, rows_of(radius_m), {.nearest_m = 15}, pool, right);
      ASSERT_EQ(right.width, kTurn_px);
      ASSERT_EQ(right.height, kRows);
      std::int64_t shown = 0;
      double worst_px = 0;
      for (int y = 0; y < kRows; ++y) {
        for (int x = 0; x < kTurn_px; ++x) {
          const auto n = static_cast<std::size_t>(y * kTurn_px + x);
          if (right.origin[n] == Origin::kOpen) continue;
          ++shown;
          // The nearest of what is right within a pixel: silhouettes are those of the left image's pixels.
          double off_px = 1e9;
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, kTurn_px - 1); ++u)
            off_px = std::min(off_px,
                              std::abs(moved_px(radius_m, static_cast<double>(right.range_m[n]), y) -
                                       moved_px(radius_m,
                                                static_cast<double>(
                                                    truth.range_m[static_cast<std::size_t>(y * kTurn_px + u)]),
                                                y)));
          worst_px = std::max(worst_px, off_px);
        }
      }
      std::printf("radius %.1f m: shown %.3f, off by %.3f px, stated %.3f px\n", radius_m,
                  static_cast<double>(shown) / (kTurn_px * kRows), worst_px, right.added_px);
      EXPECT_GT(shown, 0.9 * kTurn_px * kRows);
      EXPECT_LE(worst_px, right.added_px + 1e-3) << radius_m;
    }
  }
}

TEST(CarryRound, TheFullCircleHasNoSeam) {
  base::ThreadPool pool(2);
  const int beside = columns_beside(kTurn_px, rows_of(0.5), 15);
  const auto carried = [&](int first) {
    CarriedImage right;
    carry_round(panorama_of(hills(), -0.5, first, kTurn_px + beside), {kTurn_px, kTurn_px}, rows_of(0.5),
                {.nearest_m = 15}, pool, right);
    return right;
  };
  // The same circle, cut elsewhere.
  const CarriedImage a = carried(0);
  const CarriedImage b = carried(360);
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kTurn_px; ++x) {
      const auto at_a = static_cast<std::size_t>(y * kTurn_px + x);
      const auto at_b = static_cast<std::size_t>(y * kTurn_px + (x + 360) % kTurn_px);
      ASSERT_EQ(a.origin[at_a] == Origin::kOpen, b.origin[at_b] == Origin::kOpen) << x << " " << y;
      if (a.origin[at_a] == Origin::kOpen || std::isinf(a.range_m[at_a])) continue;
      ASSERT_NEAR(a.range_m[at_a] / b.range_m[at_b], 1, 1e-3);
    }
  }
}

TEST(CarryRound, WithoutADistanceOfEyesBothSeeTheSame) {
  base::ThreadPool pool(1);
  const core::Frame left = panorama_of(hills(), 0, 0, 100);
  CarriedImage right;
  carry_round(left, {kTurn_px, 100}, rows_of(0), {}, pool, right);
  EXPECT_EQ(right.count(Origin::kOpen), 0);
  EXPECT_EQ(right.colour, left.colour);
  EXPECT_EQ(right.added_px, 0);
}

TEST(CarryRound, ThreadsChangeNoBitAndAnArcIsOpenAtItsEnd) {
  base::ThreadPool one(1);
  base::ThreadPool many(5);
  const core::Frame left = panorama_of(hills(), -0.5, 0, 200);
  CarriedImage a;
  CarriedImage b;
  carry_round(left, {kTurn_px, 200}, rows_of(0.5), {.nearest_m = 15}, one, a);
  carry_round(left, {kTurn_px, 200}, rows_of(0.5), {.nearest_m = 15}, many, b);
  EXPECT_EQ(a.colour, b.colour);
  EXPECT_EQ(a.range_m, b.range_m);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.added_px, b.added_px);
  for (int y = 0; y < kRows; ++y) {
    const auto row = static_cast<std::size_t>(200 * y);
    EXPECT_EQ(a.origin[row + 199], Origin::kOpen);
    EXPECT_NE(a.origin[row + 100], Origin::kOpen);
  }
}

TEST(CarryRound, BadInputIsRefused) {
  base::ThreadPool pool(1);
  core::Frame left = panorama_of(hills(), -0.5, 0, 20);
  CarriedImage right;
  const std::vector<RoundRow> rows = rows_of(0.5);
  EXPECT_THROW(carry_round(left, {kTurn_px, 21}, rows, {}, pool, right), std::invalid_argument);
  EXPECT_THROW(carry_round(left, {0, 20}, rows, {}, pool, right), std::invalid_argument);
  EXPECT_THROW(carry_round(left, {kTurn_px, 20}, std::vector<RoundRow>(3), {}, pool, right),
               std::invalid_argument);
  EXPECT_THROW(carry_round(left, {kTurn_px, 20}, std::vector<RoundRow>(kRows, RoundRow{1, 0}), {}, pool, right),
               std::invalid_argument);
  EXPECT_THROW(carry_round(left, {kTurn_px, 20}, rows, {.gap_px = -1}, pool, right), std::invalid_argument);
  left.colour.pop_back();
  EXPECT_THROW(carry_round(left, {kTurn_px, 20}, rows, {}, pool, right), std::invalid_argument);
  left.colour.clear();
  carry_round(left, {kTurn_px, 20}, rows, {.gap_px = 0}, pool, right);
  EXPECT_EQ(right.count(Origin::kOpen), 20 * kRows);
  EXPECT_TRUE(right.colour.empty());
}

}  // namespace
}  // namespace vpe::warp
