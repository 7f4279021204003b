// Places within a circle, over a made-up ground whose skyline turns with the place.
#include "panorama/match/place_search.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "panorama/match/fit_drawing.h"
#include "tests/panorama/match/photo_fixture.h"

namespace match_test {
namespace {

using panorama::find_sky_line;
using panorama::PlaceMatch;

constexpr PhotoShape kShape{480, 300, {}};

// Ridges at a range, with nearer ones before them: parallax moves both.
class Ground {
 public:
  explicit Ground(std::uint32_t seed) : far_(ridges(seed)), near_(ridges(seed + 1, 1.2)) {}

  SkylineProfile at(const glm::dvec2& offset_m, double step_deg) const {
    const auto samples = static_cast<std::size_t>(std::lround(360 / step_deg));
    std::vector<double> elevations;
    for (const double azimuth : SkylineProfile::azimuths_deg(samples))
      elevations.push_back(std::max(of(far_, 8000, azimuth, offset_m), of(near_, 1500, azimuth, offset_m)));
    return SkylineProfile(std::move(elevations));
  }

 private:
  // The first-order parallax of a ring of ridges.
  static double of(const SkylineProfile& ring, double range_m, double azimuth_deg, const glm::dvec2& offset_m) {
    const double a = azimuth_deg * std::numbers::pi / 180;
    const double across = offset_m.x * std::cos(a) - offset_m.y * std::sin(a);
    const double along = offset_m.x * std::sin(a) + offset_m.y * std::cos(a);
    return ring.elevation_deg(azimuth_deg + across / range_m * 180 / std::numbers::pi) * (1 + along / range_m);
  }

  SkylineProfile far_;
  SkylineProfile near_;
};

TEST(PlaceSearch, FindsThePlaceOfAPanorama) {
  const Ground ground(11);
  const PhotoShape shape{1800, 200, panorama::equirectangular_map(1800, 200, 1800, 0, 100)};
  const glm::dvec2 truth{120, -70};
  const PhotoPose pose{200, 0.5, -0.5, 0};
  const auto line = find_sky_line(photograph(ground.at(truth, 0.05), shape, pose, {}, 2));
  double done = 0;
  const PlaceMatch found = panorama::search_place(
      line, shape, 200, [&](const glm::dvec2& o, double step) { return ground.at(o, step); }, {},
      [&](double share) { done = share; });
  std::printf("off by %.2f m, spread %.2f m, %d places; %s\n", glm::length(found.offset_m - truth),
              found.spread_m, found.places, found.match.reason.c_str());
  EXPECT_GT(done, 0.9);
  EXPECT_LE(glm::length(found.offset_m - truth), std::max(3.0, found.spread_m));
  ASSERT_TRUE(found.match.found()) << found.match.reason;
  EXPECT_NEAR(found.match.pose.yaw_deg, 200, 0.1);
  EXPECT_NEAR(found.match.pose.pitch_deg, 0.5, 0.05);
  EXPECT_NEAR(found.match.pose.roll_deg, -0.5, 0.05);
}

// A skyline that is everywhere the same tells nothing of the place.
TEST(PlaceSearch, AFarSkylineLeavesThePlaceOpen) {
  const SkylineProfile profile = ridges(12, 1.5, 720);
  const PhotoPose pose{20, 1, 1, 40};
  const auto line = find_sky_line(photograph(profile, kShape, pose, {}, 2));
  panorama::MatchOptions options;
  options.fov_deg = 40;
  const PlaceMatch found = panorama::search_place(
      line, kShape, 40, [&](const glm::dvec2&, double) { return profile; }, options);
  EXPECT_GT(found.spread_m, 10);
  ASSERT_TRUE(found.match.found()) << found.match.reason;
  EXPECT_NEAR(found.match.pose.yaw_deg, 20, 0.1);
}

TEST(PlaceSearch, WithoutSkyItSaysSo) {
  const RgbImage image{100, 100, std::vector<vpe::base::Rgb>(10000)};
  const PlaceMatch found = panorama::search_place(find_sky_line(image), {100, 100, {}}, 10,
                                                  [](const glm::dvec2&, double) { return ridges(1); }, {});
  EXPECT_EQ(found.match.failure, panorama::MatchFailure::kFewColumns);
}

TEST(PlaceSearch, BadRadius) {
  const auto profile = [](const glm::dvec2&, double) { return ridges(1); };
  for (const double radius : {0.0, -5.0, 1e6, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(panorama::search_place({}, kShape, radius, profile, {}), std::invalid_argument) << radius;
}

TEST(FitDrawing, BothSkylinesAreDrawnWhereTheyAre) {
  const SkylineProfile profile = ridges(5);
  const PhotoPose pose{120, 1, 0, 40};
  const RgbImage photo = photograph(profile, kShape, pose, {0, 0, 0, false, 0}, 1);
  panorama::SkyLine line;
  line.points = {{100.5, 20.5, 1}};
  panorama::SkylineMatch match;
  match.pose = pose;
  const RgbImage drawn = panorama::draw_fit(photo, kShape, line, match, profile);
  ASSERT_EQ(drawn.pixels.size(), photo.pixels.size());
  EXPECT_EQ(drawn.pixels[20 * 480 + 100], panorama::kFoundColour);
  for (int x = 2; x < 478; x += 17) {
    // The highest pixel of the line lies where the photograph turns from sky to ground.
    int y = 0;
    while (y < 300 && drawn.pixels[static_cast<std::size_t>(y * 480 + x)] != panorama::kComputedColour) ++y;
    ASSERT_LT(y, 300) << x;
    const auto red = [&](int row) {
      return photo.pixels[static_cast<std::size_t>(std::clamp(row, 0, 299) * 480 + x)].r;
    };
    EXPECT_GT(red(y - 3), 150) << x;
    EXPECT_LT(red(y + 6), 150) << x;
  }
  match.failure = panorama::MatchFailure::kFewColumns;
  const RgbImage dots = panorama::draw_fit(photo, kShape, line, match, profile);
  EXPECT_EQ(std::count(dots.pixels.begin(), dots.pixels.end(), panorama::kComputedColour), 0);
}

}  // namespace
}  // namespace match_test
