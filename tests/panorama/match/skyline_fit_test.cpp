// Cameras, profiles, the coarse search and the fit, on points without noise.
#include "panorama/match/skyline_fit.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "panorama/match/fit_spread.h"
#include "panorama/match/yaw_search.h"
#include "tests/panorama/match/photo_fixture.h"

namespace match_test {
namespace {

using panorama::DirectionFinder;
using panorama::FitProblem;
using panorama::SkyPoint;

constexpr PhotoShape kShape{720, 480, {}};

// Points where the image shows the profile, every 2 pixels, found from the profile's side.
std::vector<SkyPoint> points_of(const SkylineProfile& profile, const PhotoShape& shape, const PhotoPose& pose) {
  std::vector<SkyPoint> out;
  for (double azimuth = pose.yaw_deg - 60; azimuth < pose.yaw_deg + 60; azimuth += 0.1) {
    const auto place = panorama::photo_place(shape, pose, {azimuth, profile.elevation_deg(azimuth)});
    if (place && place->x >= 0 && place->x < shape.width_px && place->y >= 0 && place->y < shape.height_px)
      out.push_back({place->x, place->y, 1});
  }
  return out;
}

TEST(PhotoCamera, PlacesAndDirectionsAreInverse) {
  const PhotoShape map{3600, 900, panorama::equirectangular_map(3600, 900, 3600, 0, 450)};
  for (const PhotoShape& shape : {kShape, map}) {
    const PhotoPose pose{200, 7, -3, 40};
    const DirectionFinder finder(shape, pose);
    for (const double x : {3.5, 300.25, 700.0}) {
      for (const double y : {20.0, 240.0, 470.5}) {
        const auto place = panorama::photo_place(shape, pose, finder.at(x, y));
        ASSERT_TRUE(place);
        EXPECT_NEAR(place->x, x, 1e-8);
        EXPECT_NEAR(place->y, y, 1e-8);
      }
    }
  }
}

TEST(PhotoCamera, TheSignsAreThoseOfPoses) {
  const DirectionFinder level(kShape, {90, 10, 0, 40});
  EXPECT_NEAR(level.at(360, 240).azimuth_deg, 90, 1e-12);
  EXPECT_NEAR(level.at(360, 240).elevation_deg, 10, 1e-12);
  EXPECT_GT(level.at(400, 240).azimuth_deg, 90);
  // The right wing is down: what the right of the image shows is lower.
  const DirectionFinder rolled(kShape, {0, 0, 5, 40});
  EXPECT_LT(rolled.at(700, 240).elevation_deg, -1);
  EXPECT_GT(rolled.at(20, 240).elevation_deg, 1);
  // The field of view is vertical.
  const DirectionFinder plain(kShape, {0, 0, 0, 40});
  EXPECT_NEAR(plain.at(360, 0).elevation_deg, 20, 1e-12);
  EXPECT_FALSE(panorama::photo_place(kShape, {0, 0, 0, 40}, {180, 0}));
  EXPECT_NEAR(panorama::pixels_per_radian(kShape, 40), 240 / std::tan(20 * std::numbers::pi / 180), 1e-9);
  EXPECT_NEAR(panorama::camera_ray(kShape, 40, 360, 240).z, 1, 1e-12);
}

TEST(SkylineProfile, IsLinearBetweenItsSamplesAndRound) {
  const SkylineProfile profile({0, 1, 2, 3, 4, 3, 2, 1});
  EXPECT_DOUBLE_EQ(profile.step_deg(), 45);
  EXPECT_DOUBLE_EQ(profile.elevation_deg(67.5), 1.5);
  EXPECT_DOUBLE_EQ(profile.elevation_deg(-22.5), 0.5);
  EXPECT_DOUBLE_EQ(profile.elevation_deg(720 + 180), 4);
  EXPECT_DOUBLE_EQ(profile.slope(60, 3), 1.0 / 45);
  EXPECT_EQ(SkylineProfile::azimuths_deg(4), (std::vector<double>{0, 90, 180, 270}));
  EXPECT_THROW(SkylineProfile(std::vector<double>(7, 0.0)), std::invalid_argument);
  EXPECT_THROW(SkylineProfile(std::vector<double>(9, std::nan(""))), std::invalid_argument);
}

TEST(SkylineFit, ReachesTheTruthFromNearby) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const SkylineProfile profile = ridges(seed);
    const PhotoPose truth{31.0 * seed, 2, -1.5, 42};
    const auto points = points_of(profile, kShape, truth);
    const FitProblem problem{points, kShape, &profile, true};
    const auto fit = panorama::fit_skyline(problem, {truth.yaw_deg + 0.2, 2.3, -1, 43});
    EXPECT_NEAR(std::remainder(fit.pose.yaw_deg - truth.yaw_deg, 360), 0, 0.002) << "seed " << seed;
    EXPECT_NEAR(fit.pose.pitch_deg, truth.pitch_deg, 0.002) << "seed " << seed;
    EXPECT_NEAR(fit.pose.roll_deg, truth.roll_deg, 0.002) << "seed " << seed;
    EXPECT_NEAR(fit.pose.fov_deg, truth.fov_deg, 0.01) << "seed " << seed;
    EXPECT_EQ(fit.scale_px, panorama::kLeastScale_px);
  }
}

TEST(SkylineFit, AThirdOfThePointsMayLieElsewhere) {
  const SkylineProfile profile = ridges(5);
  const PhotoPose truth{120, 1, 2, 42};
  auto points = points_of(profile, kShape, truth);
  for (std::size_t n = 0; n < points.size() / 3; ++n) points[n].y_px += 40;
  const FitProblem problem{points, kShape, &profile, false};
  const auto fit = panorama::fit_skyline(problem, {120.1, 1.1, 1.9, 42});
  EXPECT_NEAR(fit.pose.yaw_deg, 120, 0.01);
  EXPECT_NEAR(fit.pose.pitch_deg, 1, 0.01);
  EXPECT_NEAR(fit.pose.roll_deg, 2, 0.01);
}

TEST(SkylineFit, WithoutPointsItIsTheStart) {
  const SkylineProfile profile = ridges(5);
  const auto fit = panorama::fit_skyline({{}, kShape, &profile, false}, {7, 1, 2, 42});
  EXPECT_EQ(fit.pose.yaw_deg, 7);
  EXPECT_EQ(fit.scale_px, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(panorama::residuals_px({{}, kShape, &profile, false}, {}).empty());
}

TEST(SkylineFit, LossAndScale) {
  EXPECT_EQ(panorama::tukey_loss(0, 1), 0);
  EXPECT_EQ(panorama::tukey_loss(-4.7, 1), 1);
  EXPECT_NEAR(panorama::tukey_loss(4.685 / 2, 1), 1 - 0.75 * 0.75 * 0.75, 1e-12);
  EXPECT_EQ(panorama::robust_scale_px({}), panorama::kLeastScale_px);
  EXPECT_NEAR(panorama::robust_scale_px(std::vector<double>{-2, 2, 2, 1000, -2}), 2 * 1.4826, 1e-12);
}

TEST(YawSearch, TheTruthIsAmongTheStarts) {
  for (std::uint32_t seed = 20; seed < 26; ++seed) {
    const SkylineProfile profile = ridges(seed);
    const PhotoPose truth{300.3, -6, 4, 35};
    const auto points = points_of(profile, kShape, truth);
    const auto starts = panorama::search_yaw({points, kShape, &profile, false}, 35, {});
    ASSERT_FALSE(starts.empty());
    EXPECT_LE(starts.size(), 24U);
    EXPECT_NEAR(starts.front().yaw_deg, 300.3, 1) << "seed " << seed;
    EXPECT_NEAR(starts.front().pitch_deg, -6, 1) << "seed " << seed;
    EXPECT_NEAR(starts.front().roll_deg, 4, 1) << "seed " << seed;
  }
  const SkylineProfile profile = ridges(20);
  EXPECT_TRUE(panorama::search_yaw({{}, kShape, &profile, false}, 35, {}).empty());
}

TEST(FitSpread, OfExactPointsIsSmallAndOfShiftedHalvesIsNot) {
  const SkylineProfile profile = ridges(5);
  const PhotoPose truth{120, 1, 2, 42};
  auto points = points_of(profile, kShape, truth);
  FitProblem problem{points, kShape, &profile, false};
  EXPECT_LT(panorama::spread_of(problem, panorama::fit_skyline(problem, truth)).yaw_deg, 0.002);
  for (std::size_t n = 0; n < points.size(); ++n) points[n].y_px += 6 * std::sin(0.02 * static_cast<double>(n));
  EXPECT_GT(panorama::spread_of(problem, panorama::fit_skyline(problem, truth)).roll_deg, 0.05);
}

TEST(FitSpread, LeadsAndIndependentValues) {
  const std::vector<double> best(64, 0.0);
  const std::vector<double> other(64, 100.0);
  const auto lead = panorama::lead_of(best, other, 1);
  EXPECT_EQ(lead.mean, 1);
  EXPECT_EQ(lead.sigma, 0);
  EXPECT_EQ(panorama::lead_of(best, best, 1).mean, 0);
}

TEST(FitSpread, LikenessCountsTheWavesThatAreExplained) {
  Random random(9);
  std::vector<double> heights;
  std::vector<double> noise;
  std::vector<double> other;
  for (int n = 0; n < 600; ++n) {
    double h = 0;
    double o = 0;
    for (int k = 2; k < 60; ++k) {
      h += 30.0 / k * std::cos(0.005 * k * n + k * k);
      o += 30.0 / k * std::cos(0.005 * k * n + 3 * k * k + 1);
    }
    heights.push_back(h);
    other.push_back(h - o);
    noise.push_back(0.3 * random.normal());
  }
  EXPECT_GT(panorama::shape_likeness(heights, noise, 2, 3), 50);
  EXPECT_LT(panorama::shape_likeness(heights, other, 1e9, 3), 7);
  EXPECT_EQ(panorama::shape_likeness(heights, heights, 1e9, 3), 0);
  EXPECT_EQ(panorama::shape_likeness({}, {}, 1, 3), 0);
}

}  // namespace
}  // namespace match_test
