#include "vpe/explore/measure/line_of_sight.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/explore/terrain_fixture.h"

namespace vpe::explore {
namespace {

using test_support::kPatch;
using test_support::Random;

class SphereSight : public test_support::GroundTest<test_support::SmoothGround> {};
class RidgeSight : public test_support::GroundTest<test_support::RidgeGround> {};
class BumpySight : public test_support::GroundTest<test_support::BumpyGround> {};

glm::dvec3 point_of(const paging::Surface& surface, const SightPoint& p) {
  const glm::dvec3 d = mars::direction(p.place);
  return (surface.at(d).radius_m + p.height_m) * d;
}

// Returns the distance of a line from the sphere's centre, if the foot of the perpendicular lies between the
// ends.
double over_sphere_m(const glm::dvec3& a, const glm::dvec3& b, double radius_m) {
  const glm::dvec3 way = glm::normalize(b - a);
  const double foot = -glm::dot(a, way);
  const glm::dvec3 nearest = a + std::clamp(foot, 0.0, glm::length(b - a)) * way;
  return glm::length(nearest) - radius_m;
}

// On a faceted sphere the reference surface lies between the sphere and the facets' sagitta below it.
TEST_F(SphereSight, ClearanceIsTheSpheresAndSightEndsAtTheHorizon) {
  Random random(5);
  int seen = 0;
  int hidden = 0;
  for (int n = 0; n < 300; ++n) {
    const bool near = n % 2 == 0;
    const double sagitta_m = near ? 0.3 : 900;
    const SightPoint a{
        near ? mars::lon_lat(kPatch + 0.004 * random.direction()) : mars::lon_lat(random.direction()),
        random.log_uniform(near ? 5 : 2000, near ? 100 : 400000)};
    const double bearing_deg = random.uniform(0, 360);
    const SightPoint b{mars::destination(a.place, bearing_deg, random.uniform(0.001, near ? 0.012 : 1.2)),
                       random.log_uniform(near ? 5 : 2000, near ? 100 : 400000)};
    const LineOfSight sight = line_of_sight(surface(), a, b);
    const double sphere_m = over_sphere_m(point_of(surface(), a), point_of(surface(), b), mars::kMarsRadius_m);
    EXPECT_GE(sight.clearance_m, sphere_m - sight.clearance_error_m);
    EXPECT_LE(sight.clearance_m, sphere_m + sagitta_m);
    EXPECT_LT(sight.clearance_error_m, 1e-5);
    if (std::abs(sight.clearance_m) > 1e-5) {
      EXPECT_EQ(sight.visible, sight.clearance_m > 0);
    }
    (sight.visible ? seen : hidden) += 1;
    EXPECT_EQ(sight.visible, !sight.obstruction.has_value());
    EXPECT_NEAR(sight.distance_m, glm::length(point_of(surface(), a) - point_of(surface(), b)), 1e-6);
    EXPECT_NEAR(sight.arc_m, mars::distance_rad(a.place, b.place) * mars::kMarsRadius_m, 1e-6);
  }
  EXPECT_GT(seen, 50);
  EXPECT_GT(hidden, 50);
}

// Behind the horizon a mast must reach the tangent: R / cos(beyond) - R.
TEST_F(SphereSight, TheHeightNeededIsThatOfTheTangent) {
  const SightPoint a{mars::lon_lat(kPatch), 20};
  const double dip_rad = mars::horizon_dip_rad(20, mars::kMarsRadius_m);
  for (const double arc : {0.005, 0.008, 0.012}) {
    const SightPoint b{mars::destination(a.place, 70, arc), 1};
    const LineOfSight sight = line_of_sight(surface(), a, b);
    const double tangent_m = mars::kMarsRadius_m * (1 / std::cos(arc - dip_rad) - 1);
    EXPECT_FALSE(sight.visible);
    EXPECT_NEAR(sight.needed_height_m, tangent_m, 1.0) << arc;
  }
  // No mast is tall enough on the other side of the planet.
  const SightPoint far{mars::destination(a.place, 70, 1.7), 1};
  EXPECT_EQ(line_of_sight(surface(), a, far).needed_height_m, std::numeric_limits<double>::infinity());
}

TEST_F(RidgeSight, HidesPlacesBehindUnlessTheyAreTall) {
  const SightPoint west{{-35.3, 20}, 60};  // enough to look over the bulge of the planet
  const LineOfSight sight = line_of_sight(surface(), west, {{-34.7, 20}, 60});
  EXPECT_FALSE(sight.visible);
  ASSERT_TRUE(sight.obstruction.has_value());
  // It is the western slope that is in the way, low down.
  const double foot_m =
      RidgeSight::surface().planet_radius_m() * mars::distance_rad({-35.3, 20}, {-35, 20}) - 4000;
  EXPECT_NEAR(sight.obstruction->distance_m, foot_m, 700);
  EXPECT_LT(sight.obstruction->place.lon_deg, -35);
  EXPECT_NEAR(sight.obstruction->elevation_m, 0, 100);
  EXPECT_NEAR(sight.clearance_m, -800, 100);
  EXPECT_NEAR(sight.clearance_place.lon_deg, -35, 0.01);
  // Eyes level over the crest see one another.
  EXPECT_TRUE(line_of_sight(surface(), {{-35.1, 20}, 900}, {{-34.9, 20}, 900}).visible);
  EXPECT_FALSE(line_of_sight(surface(), {{-35.1, 20}, 700}, {{-34.9, 20}, 700}).visible);
  // From the crest both sides are seen, down to the ground.
  EXPECT_TRUE(line_of_sight(surface(), {{-35, 20}, 2000}, {{-34.8, 20}, 0}).visible);
}

void expect_as_sampled(const paging::Surface& surface, const SightPoint& a, const SightPoint& b) {
  const LineOfSight sight = line_of_sight(surface, a, b);
  const glm::dvec3 camera = point_of(surface, a);
  const glm::dvec3 target = point_of(surface, b);
  double least_m = 1e300;
  constexpr int kSamples = 3000;
  for (int i = 0; i <= kSamples; ++i) {
    const glm::dvec3 p = glm::mix(camera, target, static_cast<double>(i) / kSamples);
    least_m = std::min(least_m, glm::length(p) - surface.at(p).radius_m);
  }
  EXPECT_LE(sight.clearance_m, least_m + sight.clearance_error_m + 1e-6);
  // What samples miss: between two of them the ground rises by no more than a steep slope lets it.
  EXPECT_GE(sight.clearance_m, least_m - 0.5 * sight.distance_m / kSamples);
  const glm::dvec3 at = glm::mix(camera, target, sight.clearance_distance_m / sight.distance_m);
  EXPECT_NEAR(glm::length(at) - surface.at(at).radius_m, sight.clearance_m, 1e-3);
  EXPECT_LT(mars::distance_rad(mars::lon_lat(at), sight.clearance_place), 1e-9);
  if (sight.obstruction) {
    const glm::dvec3 hit = glm::mix(camera, target, sight.obstruction->distance_m / sight.distance_m);
    EXPECT_NEAR(glm::length(hit), surface.at(hit).radius_m, 1e-4);
    EXPECT_LT(mars::distance_rad(mars::lon_lat(hit), sight.obstruction->place), 1e-9);
  }
  if (std::abs(sight.clearance_m) > 1e-3) {
    EXPECT_EQ(sight.visible, sight.clearance_m > 0);
  }
  if (!std::isfinite(sight.needed_height_m)) return;
  const auto with = [&](double height_m) { return line_of_sight(surface, a, {b.place, height_m}).visible; };
  EXPECT_TRUE(with(sight.needed_height_m + 0.05));
  if (sight.needed_height_m > 0.1) {
    EXPECT_FALSE(with(sight.needed_height_m - 0.05));
  }
}

TEST_F(BumpySight, AgreesWithManySamplesAndWithItself) {
  Random random(7);
  for (int n = 0; n < 60; ++n) {
    const bool near = n % 2 == 0;
    const SightPoint a{mars::lon_lat(near ? kPatch + 0.01 * random.direction() : random.direction()),
                       random.log_uniform(1, near ? 1000 : 1e6)};
    const double bearing_deg = random.uniform(0, 360);
    const SightPoint b{mars::destination(a.place, bearing_deg, random.log_uniform(1e-4, near ? 0.02 : 0.8)),
                       random.log_uniform(1, near ? 1000 : 1e6)};
    expect_as_sampled(surface(), a, b);
  }
}

TEST_F(BumpySight, SightIsMutual) {
  Random random(8);
  for (int n = 0; n < 60; ++n) {
    const SightPoint a{mars::lon_lat(kPatch + 0.01 * random.direction()), random.log_uniform(1, 1000)};
    const SightPoint b{mars::lon_lat(kPatch + 0.01 * random.direction()), random.log_uniform(1, 1000)};
    const LineOfSight there = line_of_sight(surface(), a, b);
    const LineOfSight back = line_of_sight(surface(), b, a);
    EXPECT_NEAR(there.clearance_m, back.clearance_m, there.clearance_error_m + back.clearance_error_m);
    if (std::abs(there.clearance_m) > 1e-5) {
      EXPECT_EQ(there.visible, back.visible);
    }
  }
}

TEST_F(BumpySight, StraightUpNothingObstructs) {
  const mars::LonLat place = mars::lon_lat(kPatch);
  const LineOfSight up = line_of_sight(surface(), {place, 2}, {place, 500});
  EXPECT_TRUE(up.visible);
  EXPECT_EQ(up.distance_m, 498);
  EXPECT_EQ(up.clearance_m, 2);
  EXPECT_EQ(up.clearance_distance_m, 0);
  EXPECT_EQ(line_of_sight(surface(), {place, 500}, {place, 2}).clearance_distance_m, 498);
  // Almost straight up: from the ground to a spacecraft.
  const mars::LonLat beside = mars::destination(place, 10, 1e-7);
  const LineOfSight craft = line_of_sight(surface(), {place, 0}, {beside, 400000});
  EXPECT_TRUE(craft.visible);
  EXPECT_NEAR(craft.clearance_m, 0, craft.clearance_error_m);
  EXPECT_EQ(craft.needed_height_m, 0);
}

TEST_F(BumpySight, InvalidPointsAreRejected) {
  const SightPoint fine{{0, 0}, 2};
  EXPECT_THROW(line_of_sight(surface(), fine, {{0, 91}, 2}), std::invalid_argument);
  EXPECT_THROW(line_of_sight(surface(), {{0, 0}, -1}, fine), std::invalid_argument);
  EXPECT_THROW(line_of_sight(surface(), fine, {{5, 0}, std::nan("")}), std::invalid_argument);
  EXPECT_THROW(line_of_sight(surface(), fine, {{180, 0}, 2}), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::explore
