// Values that an error of the direction leaves alone.
#include "vpe/map/near_ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "mars/geodesy/sun.h"
#include "paging/surface/query.h"
#include "tests/support/support.h"

namespace {

using vpe::map::NearGround;

constexpr double kError_rad = 1e-11;  // 0.03 mm

// A facet as a plane through a point, so that heights about it are known.
struct Plane {
  glm::dvec3 through;
  glm::dvec3 normal;
  paging::SurfacePoint point(const glm::dvec3& d) const {
    paging::SurfacePoint point;
    point.normal = normal;
    point.radius_m = glm::dot(normal, through) / glm::dot(normal, d);
    point.height_m = point.radius_m - mars::kMarsRadius_m;
    return point;
  }
};

Plane random_plane(test_support::Random& random, const glm::dvec3& d) {
  const double steep = random.log_uniform(1e-4, 3);
  const glm::dvec3 tilt{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  return {d * (mars::kMarsRadius_m + random.uniform(-8000, 20000)), glm::normalize(d + tilt * steep * 0.5)};
}

TEST(NearGround, ValuesHoldInEveryDirectionWithinTheError) {
  test_support::Random random(20261127);
  int known[4] = {};
  const int trials = 4000;
  for (int n = 0; n < trials; ++n) {
    const mars::LonLat place{random.uniform(-180, 180), random.uniform(-89, 89)};
    const glm::dvec3 d = mars::direction(place);
    const Plane plane = random_plane(random, d);
    if (glm::dot(plane.normal, d) < 0.1) continue;
    const paging::SurfacePoint point = plane.point(d);
    const NearGround near(point, d, kError_rad);
    const std::optional<float> values[] = {near.elevation(), near.slope(), near.aspect(), near.shade(315, 45)};
    for (int k = 0; k < 4; ++k) known[k] += values[k] ? 1 : 0;
    for (int k = 0; k < 6; ++k) {
      const double off_rad = 0.7 * kError_rad;
      const mars::LonLat other = mars::destination(place, 60.0 * k, off_rad);
      const glm::dvec3 direction = mars::direction(other);
      const auto slope = paging::slope_and_aspect(plane.normal, other);
      const double shade = std::max(0.0, glm::dot(plane.normal, mars::sun_direction(other, 315, 45)));
      const double expected[] = {plane.point(direction).height_m, slope.slope_deg, slope.aspect_deg, shade};
      for (int v = 0; v < 4; ++v) {
        if (values[v]) {
          ASSERT_EQ(*values[v], static_cast<float>(expected[v]))
              << v << ' ' << place.lon_deg << ' ' << place.lat_deg;
        }
      }
    }
  }
  // Steep ground and nearly level ground leave some open.
  for (const int k : known) EXPECT_GT(k, trials / 3);
}

TEST(NearGround, NothingIsKnownOfDirectionsAtAPoleAndOnLevelGround) {
  const glm::dvec3 pole{0, 0, 1};
  paging::SurfacePoint point;
  point.normal = glm::normalize(glm::dvec3(0.1, 0.2, 1));
  point.radius_m = mars::kMarsRadius_m;
  const NearGround at_pole(point, pole, 1e-13);
  EXPECT_FALSE(at_pole.aspect());
  EXPECT_FALSE(at_pole.slope());
  EXPECT_FALSE(at_pole.shade(315, 45));
  const glm::dvec3 equator{1, 0, 0};
  point.normal = equator;
  point.height_m = 1000.25;
  const NearGround level(point, equator, 1e-13);
  EXPECT_FALSE(level.aspect()) << "0 where it is level, and anything beside it";
  EXPECT_EQ(level.elevation(), std::optional<float>(1000.25F));
}

TEST(NearGround, HeightsBetweenTwoFloatsAreOpen) {
  const glm::dvec3 d{1, 0, 0};
  paging::SurfacePoint point;
  point.normal = glm::normalize(glm::dvec3(1, 0.1, 0));
  point.radius_m = mars::kMarsRadius_m;
  const float below = 1000.0F;
  const float above = std::nextafter(below, 2000.0F);
  point.height_m = (static_cast<double>(below) + static_cast<double>(above)) / 2;
  EXPECT_FALSE(NearGround(point, d, 1e-13).elevation());
  point.height_m = below;
  EXPECT_EQ(NearGround(point, d, 1e-13).elevation(), std::optional<float>(below));
}

}  // namespace
