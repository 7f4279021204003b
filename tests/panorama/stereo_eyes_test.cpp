// Places of eyes that turn with the azimuth.
#include "panorama/stereo_eyes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"

namespace {

using panorama::Eye;

TEST(StereoEyes, StandAcrossTheDirection) {
  for (double azimuth_deg = -400.0; azimuth_deg < 800.0; azimuth_deg += 7.0) {
    const double a = azimuth_deg * mars::kRadiansPerDegree;
    const glm::dvec2 forward(std::sin(a), std::cos(a));  // east, north
    const glm::dvec2 right_hand(std::cos(a), -std::sin(a));
    const glm::dvec2 left = panorama::eye_place_m(Eye::kLeft, azimuth_deg, 0.064);
    const glm::dvec2 right = panorama::eye_place_m(Eye::kRight, azimuth_deg, 0.064);
    EXPECT_NEAR(glm::dot(left, forward), 0.0, 1e-15);
    EXPECT_NEAR(glm::dot(right - left, right_hand), 0.064, 1e-15);
    EXPECT_NEAR(glm::length(left + right), 0.0, 1e-15);
  }
  EXPECT_NEAR(panorama::eye_place_m(Eye::kLeft, 0.0, 2.0).x, -1.0, 1e-15);  // looking north: in the west
  EXPECT_NEAR(panorama::eye_place_m(Eye::kLeft, 90.0, 2.0).y, 1.0, 1e-15);  // looking east: in the north
}

TEST(StereoEyes, BaseFadesTowardsThePoles) {
  EXPECT_EQ(panorama::faded_base_m(2.0, 0.0), 2.0);
  EXPECT_EQ(panorama::faded_base_m(2.0, -45.0), 2.0);
  EXPECT_NEAR(panorama::faded_base_m(2.0, 67.5), 1.0, 1e-12);
  EXPECT_EQ(panorama::faded_base_m(2.0, 90.0), 0.0);
  EXPECT_EQ(panorama::faded_base_m(2.0, -90.0), 0.0);
  double before = 2.0;
  for (double elevation_deg = 0.0; elevation_deg <= 90.0; elevation_deg += 0.1) {
    const double base_m = panorama::faded_base_m(2.0, elevation_deg);
    EXPECT_LE(base_m, before);
    EXPECT_LT(before - base_m, 0.01);
    before = base_m;
  }
}

}  // namespace
