// Tests of lengths, areas and crossings of outlines on the sphere, against GeographicLib and closed forms.
#include "vpe/explore/drawing/sphere_polygon.h"

#include <geodesic.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/support.h"
#include "tests/support/worst.h"

namespace vpe::explore {
namespace {

constexpr double kRadius_m = mars::kMarsRadius_m;

double area(std::span<const mars::LonLat> places) {
  return std::abs(signed_sphere_area(directions_of(places)));
}

// GeographicLib on a sphere: area of the smaller side, square metres, and the outline's length.
struct Oracle {
  double area_m2 = 0;
  double length_m = 0;
};
Oracle oracle(std::span<const mars::LonLat> places) {
  geod_geodesic sphere;
  geod_init(&sphere, kRadius_m, 0);
  std::vector<double> lats;
  std::vector<double> lons;
  for (const mars::LonLat p : places) {
    lats.push_back(p.lat_deg);
    lons.push_back(p.lon_deg);
  }
  Oracle out;
  geod_polygonarea(&sphere, lats.data(), lons.data(), static_cast<int>(places.size()), &out.area_m2,
                   &out.length_m);
  out.area_m2 = std::abs(out.area_m2);
  const double all_m2 = 4 * mars::kPi * kRadius_m * kRadius_m;
  out.area_m2 = std::min(out.area_m2, all_m2 - out.area_m2);
  return out;
}

// Returns a star around a place, with corners at distances of 0.2 to 1 of the reach.
std::vector<mars::LonLat> star(test_support::Random& random, mars::LonLat centre, double reach_rad,
                               int corners) {
  std::vector<mars::LonLat> places;
  for (int n = 0; n < corners; ++n) {
    const double reach = reach_rad * random.uniform(0.2, 1);
    places.push_back(mars::destination(centre, 360.0 * n / corners, reach));
  }
  return places;
}

TEST(SpherePolygon, KnownAreas) {
  const std::vector<mars::LonLat> octant{{0, 0}, {90, 0}, {0, 90}};
  EXPECT_NEAR(area(octant), mars::kPi / 2, 1e-14);
  const std::vector<mars::LonLat> half{{0, 0}, {90, 0}, {180, 0}, {-90, 0}};
  EXPECT_NEAR(area(half), 2 * mars::kPi, 1e-12);
  const std::vector<mars::LonLat> cap{{0, 80}, {120, 80}, {-120, 80}};
  std::vector<mars::LonLat> fine;
  for (int n = 0; n < 3600; ++n) fine.push_back({n * 0.1, 80});
  EXPECT_NEAR(area(fine), 2 * mars::kPi * (1 - std::sin(80 * mars::kRadiansPerDegree)), 1e-6);
  EXPECT_LT(area(cap), area(fine));
  const std::vector<mars::LonLat> line{{10, 0}, {20, 0}};
  EXPECT_EQ(area(line), 0);
  EXPECT_NEAR(outline_length_rad(directions_of(octant)), 1.5 * mars::kPi, 1e-14);
  EXPECT_EQ(outline_length_rad(directions_of(std::vector<mars::LonLat>{{1, 2}})), 0);
}

TEST(SpherePolygon, OrientationChangesTheSignAlone) {
  std::vector<mars::LonLat> places{{170, -10}, {-170, -10}, {-175, 20}};
  const double there = signed_sphere_area(directions_of(places));
  EXPECT_GT(there, 0);
  std::reverse(places.begin(), places.end());
  EXPECT_NEAR(signed_sphere_area(directions_of(places)), -there, 1e-15);
}

// Polygons of every size, also over poles and the date line. GeographicLib states 1e-1 m^2 for the Earth's
// size.
TEST(SpherePolygon, AgreesWithGeographicLib) {
  test_support::Random random(31);
  double worst = 0;
  double worst_large = 0;
  for (int n = 0; n < 3000; ++n) {
    const mars::LonLat centre = n % 5 == 0   ? mars::LonLat{random.uniform(-180, 180), 90}
                                : n % 5 == 1 ? mars::LonLat{180, random.uniform(-80, 80)}
                                             : mars::lon_lat(random.direction());
    const double reach_rad = random.log_uniform(1e-5, 2.5);
    const std::vector<mars::LonLat> places = star(random, centre, reach_rad, random.integer(5, 60));
    const std::vector<glm::dvec3> polygon = directions_of(places);
    const Oracle expected = oracle(places);
    const double here_m2 = std::abs(signed_sphere_area(polygon)) * kRadius_m * kRadius_m;
    const double length = outline_length_rad(polygon);
    const bool is_near = std::all_of(polygon.begin(), polygon.end(),
                                     [&](const glm::dvec3& d) { return glm::dot(d, polygon[0]) > 0.18; });
    const double bound_m2 =
        (is_near ? kSphereAreaError * length : kLargeSphereAreaError) * kRadius_m * kRadius_m + 0.1;
    EXPECT_NEAR(here_m2, expected.area_m2, bound_m2) << n << " reach " << reach_rad;
    EXPECT_NEAR(length * kRadius_m, expected.length_m, 1e-6);
    double& w = is_near ? worst : worst_large;
    w = std::max(w, std::abs(here_m2 - expected.area_m2) / bound_m2);
  }
  test_support::record_worst("area on the sphere against GeographicLib / bound", worst, 1, "1");
  test_support::record_worst("large area on the sphere against GeographicLib / bound", worst_large, 1, "1");
}

// GeographicLib is no oracle for a hundred metres; a flat polygon with its first curved term is.
TEST(SpherePolygon, SmallAreasKeepTheirDigits) {
  test_support::Random random(32);
  for (int n = 0; n < 300; ++n) {
    const mars::LonLat centre{random.uniform(-180, 180), random.uniform(-89, 89)};
    const double side_rad = random.log_uniform(3e-9, 3e-6);  // from 1 cm
    std::vector<mars::LonLat> square;
    for (int corner = 0; corner < 4; ++corner)
      square.push_back(mars::destination(centre, 45 + 90.0 * corner, side_rad / std::sqrt(2.0)));
    const double error = kSphereAreaError * 4 * side_rad + side_rad * side_rad * 1e-11;
    EXPECT_NEAR(area(square), side_rad * side_rad, error) << side_rad;
  }
}

TEST(SpherePolygon, CrossingsAreFound) {
  const auto crossing = [](std::vector<mars::LonLat> places) { return crossing_edges(directions_of(places)); };
  EXPECT_FALSE(crossing({{0, 0}, {10, 0}, {10, 10}, {0, 10}}));
  EXPECT_EQ(crossing({{0, 0}, {10, 10}, {10, 0}, {0, 10}}), (std::pair<std::size_t, std::size_t>{0, 2}));
  EXPECT_TRUE(crossing({{179, 0}, {-179, 1}, {-179, 0}, {179, 1}}));
  EXPECT_TRUE(crossing({{0, 89}, {180, 89}, {90, 89}, {-90, 89}}));  // over the pole
  EXPECT_FALSE(crossing({{0, 89}, {90, 89}, {180, 89}, {-90, 89}}));
  EXPECT_TRUE(crossing({{0, 0}, {10, 0}, {10, 10}, {5, 0}, {0, 10}}));    // touches
  EXPECT_TRUE(crossing({{0, 0}, {10, 0}, {5, 0}, {5, 5}}));               // turns back on itself
  EXPECT_FALSE(crossing({{0, 0}, {0, 0}, {10, 0}, {10, 10}, {10, 10}}));  // no length
  EXPECT_FALSE(crossing({{0, 0}, {10, 0}}));
  // Edges that meet on the other side of the planet only.
  EXPECT_FALSE(crossing({{-10, 0}, {10, 0}, {100, 10}, {170, 30}, {175, -30}, {100, -60}, {0, -50}}));
}

// Against all pairs of edges by another test of crossing: a point of one edge that is on the other.
TEST(SpherePolygon, CrossingsAreThoseOfAllPairs) {
  test_support::Random random(33);
  int crossed = 0;
  for (int n = 0; n < 400; ++n) {
    std::vector<mars::LonLat> places =
        star(random, mars::lon_lat(random.direction()), random.log_uniform(1e-4, 1.2), random.integer(5, 12));
    if (n % 2 == 0) std::swap(places[1], places[static_cast<std::size_t>(random.integer(2, 4))]);
    const std::vector<glm::dvec3> p = directions_of(places);
    const std::size_t count = p.size();
    bool expected = false;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = i + 2; k < count && !(i == 0 && k + 1 == count); ++k) {
        const glm::dvec3 x = glm::normalize(
            glm::cross(glm::cross(p[i], p[(i + 1) % count]), glm::cross(p[k], p[(k + 1) % count])));
        for (const glm::dvec3& m : {x, -x}) {
          const auto on = [&m](const glm::dvec3& a, const glm::dvec3& b) {
            return std::abs(mars::angle_between_rad(a, m) + mars::angle_between_rad(m, b) -
                            mars::angle_between_rad(a, b)) < 1e-12;
          };
          expected = expected || (on(p[i], p[(i + 1) % count]) && on(p[k], p[(k + 1) % count]));
        }
      }
    }
    crossed += expected ? 1 : 0;
    EXPECT_EQ(crossing_edges(p).has_value(), expected) << n;
  }
  EXPECT_GT(crossed, 50);
  EXPECT_LT(crossed, 350);
}

TEST(SpherePolygon, ManyVerticesTakeNoLongTime) {
  std::vector<mars::LonLat> circle;
  for (int n = 0; n < 50'000; ++n) circle.push_back(mars::destination({20, 30}, 360.0 * n / 50'000, 0.1));
  EXPECT_FALSE(crossing_edges(directions_of(circle)));
  EXPECT_NEAR(area(circle), 2 * mars::kPi * (1 - std::cos(0.1)), 1e-9);
}

}  // namespace
}  // namespace vpe::explore
