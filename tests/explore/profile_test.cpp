#include "vpe/explore/measure/profile.h"

#include <rapidcheck.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "lod/tree/posts.h"
#include "tests/explore/terrain_fixture.h"
#include "vpe/base/number.h"

namespace vpe::explore {
namespace {

class Profiles : public test_support::GroundTest<test_support::BumpyGround> {};
class RidgeProfiles : public test_support::GroundTest<test_support::RidgeGround> {};

TEST_F(Profiles, AThousandPointsButNotFinerThanThePosts) {
  const paging::PlanetMeta& meta = surface().planet().meta();
  const double finest_m = lod::post_spacing_m(meta.finest_level, meta.tile.intervals(), meta.radius_m);
  const std::vector<mars::LonLat> far{{0, 0}, {90, 0}};
  EXPECT_NEAR(profile_step_m(meta, far), mars::kPi / 2 * meta.radius_m / 1000, 1e-6);
  EXPECT_EQ(make_profile(surface(), far).points.size(), 1001U);
  EXPECT_EQ(make_profile(surface(), far, {.most_points = 50}).points.size(), 51U);
  const std::vector<mars::LonLat> near{{0, 0}, {0.01, 0}};
  EXPECT_EQ(profile_step_m(meta, near), finest_m);
  EXPECT_EQ(make_profile(surface(), far, {.step_m = 2e6}).points.size(), 4U);
}

TEST_F(Profiles, TotalsAreThoseOfThePoints) {
  const std::vector<mars::LonLat> places{{-36, 19}, {-35, 20}, {-33, 24}};
  const Profile p = make_profile(surface(), places);
  EXPECT_NEAR(p.length_m,
              (mars::distance_rad(places[0], places[1]) + mars::distance_rad(places[1], places[2])) *
                  mars::kMarsRadius_m,
              1e-6);
  EXPECT_EQ(p.ground_length_m, p.points.back().ground_distance_m);
  EXPECT_FALSE(p.has_nodata);
  for (const paging::ProfilePoint& point : p.points) {
    EXPECT_LE(point.lowest_m, point.height_m);
    EXPECT_GE(point.highest_m, point.height_m);
    EXPECT_LE(p.lowest_m, point.lowest_m);
    EXPECT_GE(p.highest_m, point.highest_m);
  }
}

// Any places in any order: those given are points of the profile as they are, and distances only grow.
TEST_F(Profiles, GoThroughAnyPlaces) {
  EXPECT_TRUE(rc::check([] {
    const auto count = *rc::gen::inRange(2, 6);
    std::vector<mars::LonLat> places;
    for (int n = 0; n < count; ++n) {
      // Poles, the seam, equal and opposite places among others.
      const double lon_deg =
          *rc::gen::oneOf(rc::gen::element(-360.0, -180.0, 0.0, 90.0, 180.0, 270.0, 360.0),
                          rc::gen::map(rc::gen::inRange(-36000, 36001), [](int x) { return x / 100.0; }));
      const double lat_deg =
          *rc::gen::oneOf(rc::gen::element(-90.0, 0.0, 90.0),
                          rc::gen::map(rc::gen::inRange(-9000, 9001), [](int x) { return x / 100.0; }));
      places.push_back({lon_deg, lat_deg});
    }
    Profile p;
    try {
      p = make_profile(surface(), places, {.most_points = 60});
    } catch (const std::invalid_argument& e) {
      RC_ASSERT(std::string(e.what()) != "");
      return;
    }
    std::vector<mars::LonLat> given;
    for (std::size_t n = 0; n < p.points.size(); ++n) {
      const paging::ProfilePoint& point = p.points[n];
      RC_ASSERT(std::isfinite(point.height_m) && std::abs(point.place.lat_deg) <= 90);
      RC_ASSERT(point.place.lon_deg > -180 && point.place.lon_deg <= 180);
      if (n > 0) RC_ASSERT(point.distance_m >= p.points[n - 1].distance_m);
      if (n > 0) RC_ASSERT(point.ground_distance_m >= p.points[n - 1].ground_distance_m);
      if (point.waypoint) given.push_back(point.place);
    }
    RC_ASSERT(given.size() >= 2U && given.size() <= places.size());
    RC_ASSERT(given.front().lon_deg == mars::normalize_lon_deg(places.front().lon_deg));
    RC_ASSERT(given.front().lat_deg == places.front().lat_deg);
    RC_ASSERT(given.back().lat_deg == places.back().lat_deg);
  }));
}

// The path crosses a ridge whose length along the ground is known.
TEST_F(RidgeProfiles, GroundDistanceGoesOverTheRidge) {
  const std::vector<mars::LonLat> places{{-35.2, 20}, {-34.8, 20}};
  const Profile p = make_profile(surface(), places, {.step_m = 50});
  const double run_m = 8000;
  const double detour_m = 2 * (std::hypot(4000.0, 800.0) - 4000);
  EXPECT_NEAR(p.ground_length_m - p.length_m, detour_m, 0.05 * detour_m);
  EXPECT_GT(p.length_m, run_m);
  EXPECT_NEAR(p.highest_m, 800, 60);  // the posts may miss the edge of the roof
  // However coarse the steps are, the top and the length are there.
  const Profile coarse = make_profile(surface(), places, {.step_m = 30000});
  EXPECT_EQ(coarse.points.size(), 2U);
  EXPECT_NEAR(coarse.highest_m, p.highest_m, 1e-6);
  EXPECT_NEAR(coarse.ground_length_m, p.ground_length_m, 1e-5);
  // Uphill is positive.
  EXPECT_GT(p.points[p.points.size() / 2 - 20].slope_deg, 9);
  EXPECT_LT(p.points[p.points.size() / 2 + 20].slope_deg, -9);
}

TEST_F(Profiles, CsvHasAPointALine) {
  const std::vector<mars::LonLat> places{{10, 0}, {12, 0}};
  const Profile p = make_profile(surface(), places, {.step_m = 20000});
  std::istringstream lines(to_csv(p));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line + "\n", profile_csv_header());
  const auto commas = std::count(line.begin(), line.end(), ',');
  std::size_t n = 0;
  for (; std::getline(lines, line); ++n) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas);
    EXPECT_EQ(line.back(), n == 0 || n + 1 == p.points.size() ? '1' : '0');
    EXPECT_NEAR(std::stod(line), p.points[n].distance_m, 6e-4);
  }
  EXPECT_EQ(n, p.points.size());
  paging::ProfilePoint nodata = p.points[0];
  nodata.nodata = true;
  EXPECT_EQ(profile_csv_line(nodata), "0.000,0.000,10,0,,,,1\n");
}

TEST_F(Profiles, InvalidPathsAreRejected) {
  const std::vector<mars::LonLat> one{{10, 0}}, opposite{{10, 0}, {-170, 0}}, far{{0, 0}, {90, 0}};
  EXPECT_THROW(make_profile(surface(), one), std::invalid_argument);
  EXPECT_THROW(make_profile(surface(), opposite), std::invalid_argument);
  EXPECT_THROW(make_profile(surface(), far, {.step_m = 0.1}), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::explore
