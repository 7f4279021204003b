// Statistics of ground within polygons: a sphere, a plane, a bowl and a ridge, whose values are known.
#include "vpe/explore/drawing/ground_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/explore/terrain_fixture.h"
#include "vpe/explore/drawing/ground_area.h"
#include "vpe/explore/drawing/sphere_polygon.h"

namespace vpe::explore {
namespace {

constexpr double kRadius_m = mars::kMarsRadius_m;
const mars::LonLat kMiddle{-35, 20};  // of test_support::kPatch

// A round bowl of kDepth_m in a level plain, a paraboloid.
struct BowlGround {
  static constexpr double kDepth_m = 1500;
  static constexpr double kReach_m = 20'000;  // of its rim
  static double height_m(const glm::dvec3& d) {
    const double r = mars::angle_between_rad(d, test_support::kPatch) * kRadius_m / kReach_m;
    return r < 1 ? -kDepth_m * (1 - r * r) : 0.0;
  }
  static auto make(const std::filesystem::path& path) {
    return test_support::build_fake(
        path,
        test_support::FakeElevation(height_m, test_support::fine_around(test_support::kPatch, 0.012, 400)),
        100000);
  }
};

class SphereStatistics : public test_support::GroundTest<test_support::SmoothGround> {};
class PlaneStatistics : public test_support::GroundTest<test_support::PlaneGround> {};
class BowlStatistics : public test_support::GroundTest<BowlGround> {};
class BumpyStatistics : public test_support::GroundTest<test_support::BumpyGround> {};

std::vector<glm::dvec3> ring(mars::LonLat centre, double radius_rad, int corners) {
  std::vector<mars::LonLat> places;
  for (int n = 0; n < corners; ++n)
    places.push_back(mars::destination(centre, 360.0 * n / corners, radius_rad));
  std::ranges::reverse(places);  // counterclockwise
  return directions_of(places);
}

TEST_F(SphereStatistics, AreThoseOfShells) {
  for (const mars::LonLat centre : {kMiddle, mars::LonLat{0, 90}, mars::LonLat{180, 0}}) {
    const std::vector<glm::dvec3> polygon = ring(centre, 0.006, 24);
    const auto found = ground_statistics(surface(), polygon, {.level_m = -1000});
    ASSERT_TRUE(found);
    const double angle = signed_sphere_area(polygon);
    EXPECT_NEAR(found->sphere_area_m2, angle * kRadius_m * kRadius_m, 1e-9 * found->sphere_area_m2);
    // Facets hang below the sphere by a share of spacing^2 / 8 R.
    const double hangs_m = 2.5 * found->spacing_m * found->spacing_m / (4 * kRadius_m);
    EXPECT_NEAR(found->mean_m, 0, hangs_m);
    EXPECT_LE(found->highest_m, 1e-6);
    EXPECT_GE(found->lowest_m, -hangs_m);
    EXPECT_LT(found->steepest_deg, 1.5 * found->spacing_m / kRadius_m / mars::kRadiansPerDegree);
    const double shell_m3 = angle * (std::pow(kRadius_m, 3) - std::pow(kRadius_m - 1000, 3)) / 3;
    ASSERT_TRUE(found->over_level && found->over_rim && found->over_plane && found->plane);
    EXPECT_NEAR(found->over_level->above_m3, shell_m3, shell_m3 * hangs_m / 1000);
    EXPECT_EQ(found->over_level->below_m3, 0);
    EXPECT_NEAR(found->over_level->area_above_m2, found->sphere_area_m2, 1e-6 * found->sphere_area_m2);
    // The rim is on the sphere as the ground is.
    EXPECT_LT(found->over_rim->above_m3 + found->over_rim->below_m3, found->sphere_area_m2 * hangs_m);
    // As much of a cap is above the plane that fits as below it.
    EXPECT_NEAR(found->over_plane->above_m3 / found->over_plane->below_m3, 1, 0.02);
    if (found->spacing_m < 2000) {
      EXPECT_LT(found->plane->dip_deg, 0.001);
    }
    EXPECT_EQ(found->nodata_share, 0);
    EXPECT_EQ(found->synthetic_share, 0);
    EXPECT_TRUE(found->is_exact);
  }
}

TEST_F(PlaneStatistics, DipAndStrikeAreThoseOfThePlane) {
  test_support::Random random(42);
  for (int n = 0; n < 20; ++n) {
    const mars::LonLat centre = mars::destination(kMiddle, random.uniform(0, 360), random.uniform(0, 0.006));
    std::vector<mars::LonLat> places;
    const int corners = random.integer(3, 30);
    for (int k = 0; k < corners; ++k)
      places.push_back(mars::destination(centre, 360.0 * k / corners, random.uniform(0.002, 0.008)));
    if (n % 2 == 0) std::ranges::reverse(places);
    const std::vector<glm::dvec3> polygon = directions_of(places);
    const double dip_deg =
        mars::angle_between_rad(mars::direction(kMiddle), test_support::PlaneGround::normal()) /
        mars::kRadiansPerDegree;
    const auto found =
        ground_statistics(surface(), polygon, {.level_m = 0, .slope_limits_deg = {dip_deg - 1, dip_deg + 1}});
    ASSERT_TRUE(found && found->plane && found->over_plane);
    const mars::LonLat normal = mars::lon_lat(test_support::PlaneGround::normal());
    // Stored heights have steps.
    const double step_m = surface().planet().meta().quantum_m;
    EXPECT_NEAR(found->plane->dip_deg,
                mars::angle_between_rad(mars::direction(found->middle), mars::direction(normal)) /
                    mars::kRadiansPerDegree,
                1e-3);
    EXPECT_NEAR(
        std::remainder(found->plane->dip_azimuth_deg - mars::initial_bearing_deg(found->middle, normal), 360),
        0, 1e-2);
    EXPECT_LT(found->plane->residual_m, step_m);
    EXPECT_LT(found->plane->dip_error_deg.value(), 1e-3);
    EXPECT_LT(found->over_plane->above_m3 + found->over_plane->below_m3, found->sphere_area_m2 * step_m * 1.2);
    EXPECT_NEAR(found->median_slope_deg, dip_deg, 0.5);
    EXPECT_NEAR(found->rms_slope_deg, found->mean_slope_deg, 0.05);
    EXPECT_NEAR(found->steeper_share.at(0), 1, 1e-12);
    EXPECT_NEAR(found->steeper_share.at(1), 0, 1e-12);
    EXPECT_NEAR(found->area_m2, ground_area(surface(), polygon)->area_m2, 1e-6 * found->area_m2);
    EXPECT_NEAR(found->over_level->area_above_m2 + found->over_level->area_below_m2, found->sphere_area_m2,
                1e-6 * found->sphere_area_m2);
  }
}

std::shared_ptr<const paging::Surface> level_ground(const std::filesystem::path& path,
                                                    double radius_m = kRadius_m) {
  test_support::FakeElevation plain([](const glm::dvec3&) { return 0.0; },
                                    test_support::fine_around(test_support::kPatch, 0.012, 400));
  paging::BuildOptions options;
  options.output = path.string();
  options.radius_m = radius_m;
  options.base_spacing_m = 100'000;
  options.tile_k = 5;
  options.resampling_posts = 5000;
  options.threads = 1;
  paging::build_planet(options, plain, nullptr);
  return std::make_shared<const paging::Surface>(paging::PlanetFile::open(path.string()),
                                                 std::size_t{16} << 20);
}

TEST_F(BowlStatistics, VolumesAgainstAnotherPlanetAreThoseOfWhatChanged) {
  const test_support::TempDir folder;
  const std::vector<glm::dvec3> polygon = ring(kMiddle, 1.3 * BowlGround::kReach_m / kRadius_m, 90);
  const double bowl_m3 = mars::kPi * BowlGround::kReach_m * BowlGround::kReach_m * BowlGround::kDepth_m / 2;
  const auto found = ground_statistics(surface(), polygon, {.other = level_ground(folder / "level.vpe")});
  ASSERT_TRUE(found && found->over_other);
  EXPECT_NEAR(found->over_other->below_m3, bowl_m3, 1e-3 * bowl_m3);
  EXPECT_LT(found->over_other->above_m3, 1e-4 * bowl_m3);
  const std::shared_ptr<const paging::Surface> itself(&surface(), [](const paging::Surface*) {});
  const auto none = ground_statistics(surface(), polygon, {.other = itself});
  ASSERT_TRUE(none && none->over_other);
  EXPECT_LT(none->over_other->above_m3 + none->over_other->below_m3, 1e-6 * bowl_m3);
  EXPECT_FALSE(ground_statistics(surface(), polygon)->over_other);
  EXPECT_THROW(ground_statistics(surface(), polygon, {.other = level_ground(folder / "small.vpe", 3.3e6)}),
               std::invalid_argument);
}

TEST_F(BowlStatistics, VolumesAreThoseOfTheParaboloid) {
  const double reach_rad = 1.3 * BowlGround::kReach_m / kRadius_m;
  std::vector<glm::dvec3> polygon = ring(kMiddle, reach_rad, 90);
  const double bowl_m3 = mars::kPi * BowlGround::kReach_m * BowlGround::kReach_m * BowlGround::kDepth_m / 2;
  for (const bool is_clockwise : {false, true}) {
    if (is_clockwise) std::ranges::reverse(polygon);
    const auto found = ground_statistics(surface(), polygon, {.level_m = -BowlGround::kDepth_m / 2});
    ASSERT_TRUE(found && found->over_rim && found->over_level);
    EXPECT_NEAR(found->over_rim->below_m3, bowl_m3, 1e-3 * bowl_m3);
    EXPECT_LT(found->over_rim->above_m3, 1e-4 * bowl_m3);
    EXPECT_NEAR(found->over_level->below_m3, bowl_m3 / 4, 2e-3 * bowl_m3);
    EXPECT_NEAR(found->lowest_m, -BowlGround::kDepth_m, 1);
    EXPECT_NEAR(found->highest_m, 0, 0.1);
    EXPECT_NEAR(found->mean_m, -bowl_m3 / found->sphere_area_m2, 1);
    EXPECT_NEAR(found->steepest_deg,
                std::atan(2 * BowlGround::kDepth_m / BowlGround::kReach_m) / mars::kRadiansPerDegree, 0.3);
    EXPECT_GT(found->slope_90_deg, found->median_slope_deg);
    EXPECT_GT(found->area_m2, found->sphere_area_m2);
    // As much of the ground is above the plane that fits as below it.
    EXPECT_NEAR(found->over_plane->above_m3 / found->over_plane->below_m3, 1, 0.01);
    EXPECT_LT(found->plane->dip_deg, 0.01);
    EXPECT_GT(found->plane->residual_m, 100);
  }
}

TEST_F(BumpyStatistics, CoarserPostsStandForMany) {
  const std::vector<glm::dvec3> polygon = ring(kMiddle, 0.015, 12);
  const auto fine = ground_statistics(surface(), polygon, {.level_m = 0});
  const auto coarse = ground_statistics(surface(), polygon, {.most_cells = 1000, .level_m = 0});
  ASSERT_TRUE(fine && coarse);
  EXPECT_TRUE(fine->is_exact);
  EXPECT_FALSE(coarse->is_exact);
  EXPECT_FALSE(coarse->synthetic_share);
  EXPECT_GT(coarse->spacing_m, fine->spacing_m);
  EXPECT_NEAR(coarse->sphere_area_m2, fine->sphere_area_m2, 1e-9 * fine->sphere_area_m2);
  EXPECT_LT(coarse->area_m2, fine->area_m2);
  EXPECT_NEAR(coarse->mean_m, fine->mean_m, 0.3 * (fine->highest_m - fine->lowest_m));
}

TEST_F(BumpyStatistics, ProgressRisesAndAStopEnds) {
  const std::vector<glm::dvec3> polygon = ring(kMiddle, 0.015, 12);
  std::vector<double> shares;
  GroundStatisticsOptions options;
  options.progress = [&](double share) { shares.push_back(share); };
  ASSERT_TRUE(ground_statistics(surface(), polygon, options));
  ASSERT_GT(shares.size(), 4U);
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_LE(shares.back(), 1);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(ground_statistics(surface(), polygon, {}, stop.get_token()));
}

TEST_F(BumpyStatistics, PolygonsThatCannotBeAreRefused) {
  const auto refuses = [&](const std::vector<glm::dvec3>& polygon) {
    EXPECT_NE(why_no_statistics(polygon), "");
    EXPECT_THROW((void)ground_statistics(surface(), polygon), std::invalid_argument);
  };
  EXPECT_EQ(why_no_statistics(ring(kMiddle, 0.01, 12)), "");
  refuses({});
  refuses(directions_of(std::vector<mars::LonLat>{{0, 0}, {1, 0}}));
  refuses(directions_of(std::vector<mars::LonLat>{{0, 0}, {1, 0}, {2, 0}}));
  refuses(ring(kMiddle, 0.6, 12));
  refuses(directions_of(std::vector<mars::LonLat>{{5, 5}, {5, 5}, {5, 5}}));
}

}  // namespace
}  // namespace vpe::explore
