// Photographs of known attitude: found within the tolerances, or not found, and never sure and wrong.
#include "panorama/match/skyline_match.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "tests/panorama/match/photo_fixture.h"
#include "tests/support/support.h"

namespace match_test {
namespace {

using panorama::find_sky_line;
using panorama::MatchFailure;
using panorama::MatchOptions;
using panorama::SkylineMatch;

constexpr PhotoShape kShape{640, 420, {}};
constexpr double kYaw_deg = 0.1;
constexpr double kAttitude_deg = 0.05;

struct Shot {
  SkylineProfile profile;
  PhotoPose pose;
  RgbImage image;
};

// Odd ones have no data in the gap, even ones ground.
Shot shot(std::uint32_t seed) {
  Random random(1000 + seed);
  SkylineProfile profile = ridges(100 + seed);
  const PhotoPose pose{random.within(0, 360), random.within(-8, 8), random.within(-4, 4),
                       random.within(25, 55)};
  Spoiling spoiling;
  spoiling.black = seed % 2 == 1;
  RgbImage image = photograph(profile, kShape, pose, spoiling, 5000 + seed);
  return {std::move(profile), pose, std::move(image)};
}

bool is_right(const PhotoPose& pose, const PhotoPose& truth) {
  return std::abs(std::remainder(pose.yaw_deg - truth.yaw_deg, 360)) <= kYaw_deg &&
         std::abs(pose.pitch_deg - truth.pitch_deg) <= kAttitude_deg &&
         std::abs(pose.roll_deg - truth.roll_deg) <= kAttitude_deg;
}

void print(std::uint32_t seed, const SkylineMatch& match) {
  std::printf("seed %u: %s, yaw %.3f, residual %.2f px, %s\n", seed, to_string(match.failure),
              match.pose.yaw_deg, match.residual_px, match.reason.c_str());
}

// Half of them without a given field of view.
TEST(SkylineMatch, TwentyPhotographsWithNoiseAndTenDegreesWithoutSky) {
  int right = 0;
  int wrong = 0;
  double worst_deg = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const Shot s = shot(seed);
    MatchOptions options;
    if (seed % 4 < 2) options.fov_deg = s.pose.fov_deg;
    const SkylineMatch match = match_skyline(find_sky_line(s.image), kShape, s.profile, options);
    print(seed, match);
    if (!match.found()) {
      EXPECT_FALSE(match.reason.empty());
      continue;
    }
    const bool is_good = is_right(match.pose, s.pose);
    worst_deg = std::max({worst_deg, std::abs(std::remainder(match.pose.yaw_deg - s.pose.yaw_deg, 360)),
                          std::abs(match.pose.pitch_deg - s.pose.pitch_deg),
                          std::abs(match.pose.roll_deg - s.pose.roll_deg)});
    right += is_good ? 1 : 0;
    wrong += is_good ? 0 : 1;
    EXPECT_NEAR(match.pose.fov_deg, s.pose.fov_deg, 0.2);
    EXPECT_EQ(match.residuals_px.size(), find_sky_line(s.image).points.size());
  }
  std::printf("right %d, sure and wrong %d, not found %d; largest error %.4f degrees\n", right, wrong,
              20 - right - wrong, worst_deg);
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(right, 18);
}

// The skyline of another place has no right answer.
TEST(SkylineMatch, AnotherPlaceIsNotFound) {
  for (std::uint32_t seed = 30; seed < 42; ++seed) {
    const Shot s = shot(seed);
    MatchOptions options;
    if (seed % 2 == 0) options.fov_deg = s.pose.fov_deg;
    const SkylineMatch match = match_skyline(find_sky_line(s.image), kShape, ridges(70000 + seed), options);
    print(seed, match);
    EXPECT_FALSE(match.found()) << "seed " << seed;
    EXPECT_FALSE(match.reason.empty());
  }
}

TEST(SkylineMatch, ASkylineThatRepeatsIsAmbiguous) {
  const SkylineProfile once = ridges(7, 1.5, 1800);
  std::vector<double> twice;
  for (int k = 0; k < 2; ++k)
    for (int n = 0; n < 1800; ++n) twice.push_back(once.elevation_deg(0.2 * n));
  const SkylineProfile profile(std::move(twice));
  const PhotoPose pose{100, 2, 1, 40};
  const auto line = find_sky_line(photograph(profile, kShape, pose, {}, 3));
  MatchOptions options;
  options.fov_deg = 40;
  const SkylineMatch match = match_skyline(line, kShape, profile, options);
  EXPECT_EQ(match.failure, MatchFailure::kAmbiguous) << match.reason;
  EXPECT_NEAR(std::abs(std::remainder(match.pose.yaw_deg - match.second_yaw_deg, 360)), 180, 1);
}

TEST(SkylineMatch, AFlatHorizonHasNoYaw) {
  const auto line = find_sky_line(photograph(flat(), kShape, {100, 2, 1, 40}, {}, 3));
  const SkylineMatch of_flat = match_skyline(line, kShape, flat());
  EXPECT_EQ(of_flat.failure, MatchFailure::kLittleRelief) << of_flat.reason;
  const SkylineMatch of_ridges = match_skyline(line, kShape, ridges(3));
  EXPECT_FALSE(of_ridges.found());
  // Nor is a photograph of ridges found on a plain.
  const Shot s = shot(3);
  EXPECT_FALSE(match_skyline(find_sky_line(s.image), kShape, flat()).found());
}

TEST(SkylineMatch, ImagesWithoutSkyHaveFewColumns) {
  for (const std::uint8_t level : {std::uint8_t{0}, std::uint8_t{120}}) {
    const RgbImage image{200, 100, std::vector<vpe::base::Rgb>(20000, {level, level, level})};
    const SkylineMatch match = match_skyline(find_sky_line(image), {200, 100, {}}, ridges(3));
    EXPECT_EQ(match.failure, MatchFailure::kFewColumns);
    EXPECT_NE(match.reason.find("0 of 200"), std::string::npos) << match.reason;
  }
}

TEST(SkylineMatch, APanoramaOfTheFullCircle) {
  const PhotoShape shape{3600, 400, panorama::equirectangular_map(3600, 400, 3600, 0, 200)};
  const SkylineProfile profile = ridges(8);
  const PhotoPose truth{77.3, 0.4, -0.3, 0};
  const SkylineMatch match =
      match_skyline(find_sky_line(photograph(profile, shape, truth, {}, 4)), shape, profile);
  ASSERT_TRUE(match.found()) << match.reason;
  EXPECT_TRUE(is_right(match.pose, truth)) << match.pose.yaw_deg;
}

TEST(SkylineMatch, BadOptions) {
  const panorama::SkyLine line;
  const SkylineProfile profile = ridges(3);
  const auto refuses = [&](const MatchOptions& options) {
    EXPECT_THROW(match_skyline(line, kShape, profile, options), std::invalid_argument);
  };
  MatchOptions options;
  options.fov_deg = 151;
  refuses(options);
  options = {};
  options.sigmas = std::nan("");
  refuses(options);
  options = {};
  options.search.most_fov_deg = 2;
  refuses(options);
  options = {};
  options.search.starts = 1;
  refuses(options);
  EXPECT_THROW(match_skyline(line, {}, profile), std::invalid_argument);
  EXPECT_EQ(match_skyline(line, kShape, profile).failure, MatchFailure::kFewColumns);
  EXPECT_STREQ(to_string(MatchFailure::kNone), "found");
}

// The mosaic lies at yaw, pitch and roll 0. This terrain is up to 3 degrees off in the skyline, so that only a rough
// answer is possible, and no sure one.
TEST(SkylineMatch, TheNavcamMosaicIsRightOrNotFound) {
  VPE_NEED_SHARED(folder, "pano-navcam1051");
  std::ifstream table(folder / "dem_skyline.csv");
  std::string text;
  std::getline(table, text);
  std::vector<double> elevations;
  while (std::getline(table, text)) {
    double azimuth = 0;
    double elevation = 0;
    char comma = 0;
    std::istringstream(text) >> azimuth >> comma >> elevation;
    if (azimuth < 360) elevations.push_back(elevation);
  }
  ASSERT_EQ(elevations.size(), 720U);
  const auto json = nlohmann::json::parse(std::ifstream(folder / "pano.json"));
  const double scale = json["degrees_per_pixel"].get<double>();
  const RgbImage image = vpe::core::read_image(folder / json["image"].get<std::string>());
  const PhotoShape shape{image.width, image.height,
                         panorama::equirectangular_map(image.width, image.height, 360 / scale, 0,
                                                       json["elevation_deg_at_line_0"].get<double>() / scale)};
  const SkylineMatch match = match_skyline(find_sky_line(image), shape, SkylineProfile(std::move(elevations)));
  std::printf("%s: yaw %.3f pitch %.3f roll %.3f, sigma %.3f %.3f %.3f; %s\n", to_string(match.failure),
              match.pose.yaw_deg, match.pose.pitch_deg, match.pose.roll_deg, match.sigma.yaw_deg,
              match.sigma.pitch_deg, match.sigma.roll_deg, match.reason.c_str());
  EXPECT_TRUE(is_right(match.pose, {}) || !match.found());
  EXPECT_EQ(match.found(), match.reason.empty());
}

}  // namespace
}  // namespace match_test
