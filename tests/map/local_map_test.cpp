// Local maps against PROJ's azimuthal equidistant projection.
#include "vpe/map/local_map.h"

#include <gtest/gtest.h>
#include <proj.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "tests/support/support.h"
#include "tests/support/worst.h"
#include "vpe/base/number.h"

namespace vpe::map {
namespace {

constexpr double kRadius_m = 3396190;

class AeqdOracle {
 public:
  explicit AeqdOracle(mars::LonLat centre) : context_(proj_context_create(), proj_context_destroy) {
    const std::string text = "+proj=aeqd +R=" + base::format_number(kRadius_m) +
                             " +lon_0=" + base::format_number(centre.lon_deg) +
                             " +lat_0=" + base::format_number(centre.lat_deg);
    aeqd_.reset(proj_create(context_.get(), text.c_str()));
  }
  glm::dvec2 to_map(mars::LonLat place) const {
    const PJ_COORD at = proj_trans(
        aeqd_.get(), PJ_FWD,
        proj_coord(place.lon_deg * mars::kRadiansPerDegree, place.lat_deg * mars::kRadiansPerDegree, 0, 0));
    return {at.xy.x, at.xy.y};
  }

 private:
  std::unique_ptr<PJ_CONTEXT, PJ_CONTEXT* (*)(PJ_CONTEXT*)> context_;
  std::unique_ptr<PJ, PJ* (*)(PJ*)> aeqd_{nullptr, proj_destroy};
};

TEST(LocalMap, AgreesWithProj) {
  test_support::Random random(41);
  double worst = 0;
  for (int n = 0; n < 40; ++n) {
    const double lon_deg = random.uniform(-180, 180);
    const mars::LonLat centre{lon_deg, n == 0 ? 90.0 : n == 1 ? -90.0 : n == 2 ? 0.0 : random.uniform(-90, 90)};
    const AeqdOracle oracle(centre);
    const LocalMap map(centre, kRadius_m);
    for (int k = 0; k < 50; ++k) {
      const glm::dvec3 any = random.direction();
      const mars::LonLat place = mars::lon_lat(any);
      if (mars::distance_rad(centre, place) > 3.1) continue;
      worst = std::max(worst, glm::length(map.to_map(place) - oracle.to_map(place)));
    }
  }
  // Near the antipode an error of the place turns the bearing.
  test_support::record_worst("local map against PROJ's aeqd", worst, 1e-5, "m");
}

TEST(LocalMap, DirectionsAndDistancesFromTheCentreAreTrue) {
  test_support::Random random(42);
  double worst_rad = 0;
  for (int n = 0; n < 2000; ++n) {
    const double lon_deg = random.uniform(-180, 180);
    const mars::LonLat centre{lon_deg, random.uniform(-89, 89)};
    const LocalMap map(centre, kRadius_m);
    const double bearing_deg = random.uniform(0, 360);
    const double distance_rad = random.log_uniform(1e-7, 3.1);
    const mars::LonLat place = mars::destination(centre, bearing_deg, distance_rad);
    const glm::dvec2 at = map.to_map(place) / kRadius_m;
    const double bearing = bearing_deg * mars::kRadiansPerDegree;
    const glm::dvec2 expected(distance_rad * std::sin(bearing), distance_rad * std::cos(bearing));
    worst_rad = std::max(worst_rad, glm::length(at - expected) * std::sin(distance_rad) / distance_rad);
  }
  test_support::record_worst("local map: distance and bearing", worst_rad, LocalMap::kError_rad, "rad");
}

TEST(LocalMap, GoesThereAndBack) {
  test_support::Random random(43);
  double worst_rad = 0;
  for (const mars::LonLat centre : {mars::LonLat{0, 90}, {120, -90}, {137.4, -4.6}, {180, 0}, {-179.9, 72}}) {
    const LocalMap map(centre, kRadius_m);
    EXPECT_LT(glm::length(map.to_map(map.to_direction({0, 0}))), LocalMap::kError_rad * kRadius_m);
    EXPECT_EQ(map.centre().lon_deg, centre.lon_deg);
    EXPECT_EQ(map.radius_m(), kRadius_m);
    for (int n = 0; n < 1000; ++n) {
      const glm::dvec3 direction = random.direction();
      if (mars::angle_between_rad(direction, mars::direction(centre)) > 3.14) continue;
      worst_rad =
          std::max(worst_rad, mars::angle_between_rad(map.to_direction(map.to_map(direction)), direction));
      EXPECT_NEAR(glm::length(map.to_direction(map.to_map(direction * 3e6))), 1, 1e-14);
    }
  }
  test_support::record_worst("local map: there and back", worst_rad, LocalMap::kError_rad, "rad");
}

TEST(LocalMap, PolesAreExact) {
  const LocalMap north({30, 90}, 1);
  EXPECT_NEAR(glm::length(north.to_map(mars::LonLat{30, 80}) - glm::dvec2(0, -10 * mars::kRadiansPerDegree)), 0,
              1e-15);
  EXPECT_EQ(north.to_map(mars::LonLat{-50, 90}), glm::dvec2(0, 0));
  const LocalMap here({137, -4}, 1);
  const glm::dvec2 pole = here.to_map(mars::LonLat{0, 90});
  EXPECT_NEAR(pole.x, 0, 1e-15);
  EXPECT_NEAR(pole.y, 94 * mars::kRadiansPerDegree, 1e-15);
  EXPECT_NEAR(here.to_place(pole).lat_deg, 90, 1e-6);
}

TEST(LocalMap, ScaleIsThatOfTheProjection) {
  const LocalMap map({10, 20}, kRadius_m);
  EXPECT_EQ(map.scale_across(0), 1);
  for (const double distance_m : {10.0, 1e4, 1e6, 6e6}) {
    // Two places at the same distance, 1e-4 radians of bearing apart.
    const glm::dvec2 a(distance_m, 0);
    const glm::dvec2 b(distance_m * std::cos(1e-4), distance_m * std::sin(1e-4));
    const double there_m = kRadius_m * mars::angle_between_rad(map.to_direction(a), map.to_direction(b));
    EXPECT_NEAR(map.scale_across(distance_m), glm::length(a - b) / there_m, 1e-5);
  }
  EXPECT_TRUE(std::isinf(map.scale_across(kRadius_m * mars::kPi)));
}

TEST(LocalMap, RefusesBadInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(LocalMap({0, 91}, 1), std::invalid_argument);
  EXPECT_THROW(LocalMap({nan, 0}, 1), std::invalid_argument);
  EXPECT_THROW(LocalMap({0, 0}, 0), std::invalid_argument);
  EXPECT_THROW(LocalMap({0, 0}, nan), std::invalid_argument);
  EXPECT_THROW(LocalMap({0, 0}, std::numeric_limits<double>::infinity()), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::map
