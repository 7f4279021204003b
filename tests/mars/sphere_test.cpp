#include "mars/geodesy/sphere.h"

#include <geodesic.h>
#include <proj.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "mars/geodesy/angles.h"
#include "tests/mars/exact.h"
#include "tests/support/support.h"

namespace mars {
namespace {

using exact::Bound;
using exact::Real;
using exact::vec;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const std::vector<double> kHostileDegrees{0.0,
                                          -0.0,
                                          5e-324,
                                          -5e-324,
                                          1e-300,
                                          1e-17,
                                          -1e-17,
                                          1e-9,
                                          30,
                                          45,
                                          60,
                                          90,
                                          -90,
                                          89.999,
                                          135,
                                          180,
                                          -180,
                                          270,
                                          -270,
                                          359.999999999999,
                                          360,
                                          -360,
                                          361,
                                          450,
                                          540,
                                          -540,
                                          720,
                                          1e6,
                                          -1e6,
                                          1e15,
                                          1e16,
                                          1e22,
                                          1e100,
                                          -1e300,
                                          1.7e308,
                                          179.99999999999997,
                                          -179.99999999999997};

std::vector<LonLat> hostile_places() {
  std::vector<LonLat> places;
  for (const double lat : {0.0, -0.0, 5e-324, 1e-17, 1e-9, -1e-9, 45.0, 89.0, 89.9999999999, 89.99999999999999,
                           90.0, -89.99999999999999, -90.0}) {
    for (const double lon : kHostileDegrees) places.push_back({lon, lat});
  }
  return places;
}

std::vector<LonLat> test_places(test_support::Random& random, int count) {
  std::vector<LonLat> places = hostile_places();
  for (int n = 0; n < count; ++n) {
    places.push_back(lon_lat(random.direction()));
    // Close to a pole, and close to the antimeridian.
    places.push_back({random.uniform(-180, 180), 90 - random.log_uniform(1e-14, 1)});
    places.push_back({180 - random.log_uniform(1e-13, 1), random.uniform(-90, 90)});
  }
  return places;
}

// Representable steps between two doubles.
double ulps(double got, Real want) {
  const int exponent = std::max(std::ilogb(want), -1022);
  return static_cast<double>(std::abs(got - want) / std::ldexp(1.0L, exponent - 52));
}

TEST(Sphere, SinCosIsExactAtMultiplesOf90AndWithinItsBoundElsewhere) {
  for (const double turn : {0.0, 360.0, -360.0, 3.6e17, -720.0}) {
    EXPECT_EQ(sin_cos_deg(turn + 0).sin, 0.0);
    EXPECT_EQ(sin_cos_deg(turn + 0).cos, 1.0);
  }
  EXPECT_EQ(sin_cos_deg(90).sin, 1.0);
  EXPECT_EQ(sin_cos_deg(90).cos, 0.0);
  EXPECT_EQ(sin_cos_deg(-90).sin, -1.0);
  EXPECT_EQ(sin_cos_deg(-90).cos, 0.0);
  for (const double half : {180.0, -180.0, 540.0, -540.0}) {
    EXPECT_EQ(sin_cos_deg(half).sin, 0.0);
    EXPECT_EQ(sin_cos_deg(half).cos, -1.0);
  }
  EXPECT_EQ(sin_cos_deg(270).sin, -1.0);
  EXPECT_EQ(sin_cos_deg(270).cos, 0.0);

  test_support::Random random(1);
  std::vector<double> angles = kHostileDegrees;
  for (int n = 0; n < 50000; ++n) {
    angles.push_back(random.uniform(-720, 720));
    angles.push_back(random.log_uniform(1e-300, 1e300));
    const int quarters = random.integer(-8, 8);
    angles.push_back(90 * quarters + random.log_uniform(1e-15, 1));
  }
  Bound bound("sin_cos_deg: 2 ulp");
  for (const double angle : angles) {
    const SinCos got = sin_cos_deg(angle);
    const Real sine = exact::sin_deg(angle);
    const Real cosine = exact::cos_deg(angle);
    bound.add(ulps(got.sin, sine), 2);
    bound.add(ulps(got.cos, cosine), 2);
  }
}

TEST(Sphere, SinCosOfAnglesBeyondHalfATurnIsThatOfTheirRemainder) {
  test_support::Random random(360);
  for (int n = 0; n < 100000; ++n) {
    const double size = n % 2 == 0 ? 200 : 2000;
    const double angle_deg = n < 20 ? 90.0 * (n - 10) : random.uniform(-size, size);
    const SinCos whole = sin_cos_deg(angle_deg);
    const SinCos reduced = sin_cos_deg(std::remainder(angle_deg, 360.0));
    ASSERT_EQ(whole.sin, reduced.sin) << angle_deg;
    ASSERT_EQ(whole.cos, reduced.cos) << angle_deg;
  }
}

TEST(Sphere, SinCosOfTinyAnglesKeepsRelativePrecision) {
  test_support::Random random(2);
  for (int n = 0; n < 10000; ++n) {
    const double tiny_deg = random.log_uniform(1e-290, 1e-3);
    EXPECT_LE(ulps(sin_cos_deg(tiny_deg).sin, std::sin(static_cast<Real>(tiny_deg) * exact::kPi / 180)), 2.0);
  }
}

TEST(Sphere, NoNumberIsNoNumber) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    EXPECT_TRUE(std::isnan(sin_cos_deg(bad).sin));
    EXPECT_TRUE(std::isnan(sin_cos_deg(bad).cos));
    EXPECT_TRUE(std::isnan(normalize_lon_deg(bad)));
    EXPECT_TRUE(std::isnan(direction({bad, 10}).x));
    EXPECT_TRUE(std::isnan(direction({10, bad}).z));
    EXPECT_FALSE(is_valid({bad, 0}));
    EXPECT_FALSE(is_valid({0, bad}));
    EXPECT_TRUE(std::isnan(distance_rad({bad, 0}, {0, 0})));
    EXPECT_TRUE(std::isnan(initial_bearing_deg({bad, 0}, {0, 0})));
  }
  EXPECT_TRUE(std::isnan(lon_lat({kNan, 1, 0}).lon_deg));
}

TEST(Sphere, ValidPlaces) {
  EXPECT_TRUE(is_valid({1e300, 90}));
  EXPECT_TRUE(is_valid({0, -90}));
  EXPECT_FALSE(is_valid({0, 90.00000000000001}));
  EXPECT_FALSE(is_valid({0, 91}));
}

TEST(Sphere, LongitudesAreNormalized) {
  const std::array<std::pair<double, double>, 12> cases{{{0, 0},
                                                         {180, 180},
                                                         {-180, 180},
                                                         {181, -179},
                                                         {-181, 179},
                                                         {360, 0},
                                                         {540, 180},
                                                         {-540, 180},
                                                         {286, -74},
                                                         {359.5, -0.5},
                                                         {3.6e17, 0},
                                                         {-180.00000000000003, 179.99999999999997}}};
  for (const auto& [lon, want] : cases) EXPECT_EQ(normalize_lon_deg(lon), want) << lon;
  for (const double lon : kHostileDegrees) {
    const double got = normalize_lon_deg(lon);
    EXPECT_GT(got, -180.0) << lon;
    EXPECT_LE(got, 180.0) << lon;
    EXPECT_EQ(normalize_lon_deg(got), got);
    // Exact: the difference is a whole number of turns.
    EXPECT_EQ(std::remainder(got, 360.0),
              std::remainder(lon, 360.0) == -180 ? 180 : std::remainder(lon, 360.0));
  }
}

TEST(Sphere, DirectionIsWithinItsBound) {
  test_support::Random random(3);
  Bound bound("kDirectionError_rad");
  for (const LonLat place : test_places(random, 20000)) {
    bound.add(exact::angle(vec(direction(place)), exact::direction(place)), kDirectionError_rad);
  }
  EXPECT_EQ(direction({37, 90}), glm::dvec3(0, 0, 1));
  EXPECT_EQ(direction({-179, -90}), glm::dvec3(0, 0, -1));
  EXPECT_EQ(direction({0, 0}), glm::dvec3(1, 0, 0));
  EXPECT_EQ(direction({90, 0}), glm::dvec3(0, 1, 0));
  EXPECT_EQ(direction({180, 0}), glm::dvec3(-1, 0, 0));
}

TEST(Sphere, DirectionAgreesWithProj) {
  const std::unique_ptr<PJ_CONTEXT, PJ_CONTEXT* (*)(PJ_CONTEXT*)> context(proj_context_create(),
                                                                          proj_context_destroy);
  const std::unique_ptr<PJ, PJ* (*)(PJ*)> cart(proj_create(context.get(), "+proj=cart +R=1"), proj_destroy);
  ASSERT_NE(cart, nullptr);
  test_support::Random random(4);
  for (int n = 0; n < 10000; ++n) {
    const LonLat place{random.uniform(-180, 180), random.uniform(-90, 90)};
    const PJ_COORD at = proj_coord(place.lon_deg * kRadiansPerDegree, place.lat_deg * kRadiansPerDegree, 0, 0);
    const PJ_COORD there = proj_trans(cart.get(), PJ_FWD, at);
    const glm::dvec3 d = direction(place);
    ASSERT_LE(glm::length(d - glm::dvec3(there.xyz.x, there.xyz.y, there.xyz.z)), 1e-15);
    const PJ_COORD back = proj_trans(cart.get(), PJ_INV, proj_coord(d.x, d.y, d.z, 0));
    const LonLat ours = lon_lat(d);
    ASSERT_NEAR(ours.lat_deg, back.lp.phi / kRadiansPerDegree, 2e-13);
    if (std::abs(place.lat_deg) < 89) {
      ASSERT_NEAR(ours.lon_deg, back.lp.lam / kRadiansPerDegree, 2e-13);
    }
  }
}

TEST(Sphere, LonLatInvertsDirectionWithinItsBound) {
  test_support::Random random(5);
  std::vector<glm::dvec3> vectors;
  for (const LonLat place : test_places(random, 10000)) vectors.push_back(direction(place));
  for (int n = 0; n < 20000; ++n) {
    const glm::dvec3 along = random.direction();
    vectors.push_back(along * random.log_uniform(1e-300, 1e300));
  }
  for (const double tiny : {5e-324, 1e-310, 1e-200, 1e-17, 0.0, -0.0}) {
    for (const double sign : {1.0, -1.0}) {
      vectors.insert(vectors.end(), {{-1, tiny * sign, 0},
                                     {tiny * sign, 0, 1},
                                     {0, tiny, -1},
                                     {1, 0, tiny * sign},
                                     {tiny, tiny, 1},
                                     {-1, -tiny, tiny}});
    }
  }
  Bound bound("kLonLatError_rad");
  for (const glm::dvec3& v : vectors) {
    const LonLat p = lon_lat(v);
    ASSERT_GT(p.lon_deg, -180.0);
    ASSERT_LE(p.lon_deg, 180.0);
    ASSERT_LE(std::abs(p.lat_deg), 90.0);
    // Scaled exactly, so that the twin's squares neither overflow nor vanish.
    const double size = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    const int exponent = -std::ilogb(size);
    const exact::Vec scaled{std::ldexp(static_cast<Real>(v.x), exponent),
                            std::ldexp(static_cast<Real>(v.y), exponent),
                            std::ldexp(static_cast<Real>(v.z), exponent)};
    bound.add(exact::angle(vec(direction(p)), scaled), kLonLatError_rad);
  }
  EXPECT_EQ(lon_lat({0, 0, 5}).lat_deg, 90.0);
  EXPECT_EQ(lon_lat({0, 0, 5}).lon_deg, 0.0);
  EXPECT_EQ(lon_lat({0, 0, -5}).lat_deg, -90.0);
  EXPECT_EQ(lon_lat({-0.0, -0.0, 5}).lon_deg, 0.0);
  EXPECT_EQ(lon_lat({-1, 0, 0}).lon_deg, 180.0);
  EXPECT_EQ(lon_lat({-1, -0.0, 0}).lon_deg, 180.0);
}

TEST(Sphere, LocalFrameIsOrthonormalWithinItsBoundAndRightHanded) {
  test_support::Random random(6);
  Bound bound("local_frame: orthonormal");
  for (const LonLat place : test_places(random, 10000)) {
    const LocalFrame f = local_frame(place);
    const std::array<exact::Vec, 3> axes{vec(f.east), vec(f.north), vec(f.up)};
    for (std::size_t i = 0; i < 3; ++i) {
      bound.add(std::abs(exact::length(axes[i]) - 1), kFrameError);
      bound.add(std::abs(exact::dot(axes[i], axes[(i + 1) % 3])), kFrameError);
    }
    bound.add(exact::length(exact::cross(axes[0], axes[1]) - axes[2]), 2 * kFrameError);
    EXPECT_EQ(f.up, direction(place));
  }
  // North is the limit along the given meridian.
  const LocalFrame pole = local_frame({30, 90});
  EXPECT_LE(glm::length(pole.north + direction({30, 0})), 1e-15);
  EXPECT_LE(glm::length(pole.east - direction({120, 0})), 1e-15);
  const LocalFrame south = local_frame({30, -90});
  EXPECT_LE(glm::length(south.north - direction({30, 0})), 1e-15);
}

// Pairs at all distances, also nearly equal and nearly opposite.
std::vector<std::pair<glm::dvec3, glm::dvec3>> test_pairs(test_support::Random& random, int count) {
  std::vector<std::pair<glm::dvec3, glm::dvec3>> pairs;
  for (int n = 0; n < count; ++n) {
    const glm::dvec3 a = random.direction();
    const glm::dvec3 aside = glm::normalize(glm::cross(a, random.direction()));
    const double angle = random.log_uniform(1e-17, 1);
    pairs.emplace_back(a, random.direction());
    pairs.emplace_back(a, a * std::cos(angle) + aside * std::sin(angle));
    pairs.emplace_back(a, a * -std::cos(angle) + aside * std::sin(angle));
  }
  return pairs;
}

TEST(Sphere, AngleBetweenIsWithinItsBound) {
  test_support::Random random(7);
  Bound bound("angle_between_rad");
  for (const auto& [a, b] : test_pairs(random, 20000)) {
    const double scale_a = random.log_uniform(1e-60, 1e60);
    const double scale_b = random.log_uniform(1e-60, 1e60);
    const glm::dvec3 long_a = a * scale_a;
    const glm::dvec3 long_b = b * scale_b;
    const Real want = exact::angle(vec(long_a), vec(long_b));
    bound.add(std::abs(angle_between_rad(long_a, long_b) - want), angle_error_rad(static_cast<double>(want)));
  }
  const glm::dvec3 x(1, 0, 0);
  EXPECT_EQ(angle_between_rad(x, x), 0.0);
  EXPECT_EQ(angle_between_rad(x, -x), kPi);
  EXPECT_EQ(angle_between_rad(x, {0, 3, 0}), kPi / 2);
}

TEST(Sphere, DistanceAndBearingAgreeWithGeographicLib) {
  geod_geodesic sphere;
  geod_init(&sphere, 1.0, 0.0);
  test_support::Random random(8);
  const std::vector<LonLat> places = test_places(random, 3000);
  for (int n = 0; n < 30000; ++n) {
    const LonLat a = places[static_cast<std::size_t>(random.integer(0, static_cast<int>(places.size()) - 1))];
    const LonLat b = places[static_cast<std::size_t>(random.integer(0, static_cast<int>(places.size()) - 1))];
    double want_rad = 0;
    double azimuth_deg = 0;
    double end_deg = 0;
    geod_inverse(&sphere, a.lat_deg, std::remainder(a.lon_deg, 360), b.lat_deg, std::remainder(b.lon_deg, 360),
                 &want_rad, &azimuth_deg, &end_deg);
    ASSERT_NEAR(distance_rad(a, b), want_rad, 5e-15);
    const double bearing = initial_bearing_deg(a, b);
    ASSERT_GE(bearing, 0.0);
    ASSERT_LT(bearing, 360.0);
    // Its error grows with 1 / sin(distance); at a pole its meaning depends on the longitude given.
    const double lever = std::abs(std::sin(want_rad));
    if (lever > 1e-9 && std::abs(a.lat_deg) < 90) {
      const double gap_rad = std::abs(std::remainder(bearing - azimuth_deg, 360)) * kRadiansPerDegree;
      ASSERT_LE(gap_rad, 2e-15 + 2e-15 / lever)
          << a.lon_deg << " " << a.lat_deg << " to " << b.lon_deg << " " << b.lat_deg;
    }
  }
}

TEST(Sphere, BearingIsWithinItsBound) {
  test_support::Random random(9);
  Bound bound("initial_bearing_deg");
  const std::vector<LonLat> places = test_places(random, 5000);
  for (int n = 0; n < 50000; ++n) {
    const LonLat a = places[static_cast<std::size_t>(random.integer(0, static_cast<int>(places.size()) - 1))];
    const LonLat b = places[static_cast<std::size_t>(random.integer(0, static_cast<int>(places.size()) - 1))];
    const exact::Vec east{-exact::sin_deg(a.lon_deg), exact::cos_deg(a.lon_deg), 0};
    const exact::Vec north = exact::cross(exact::direction(a), east);
    const exact::Vec to = exact::direction(b);
    const Real e = exact::dot(east, to);
    const Real n2 = exact::dot(north, to);
    const Real lever = std::hypot(e, n2);
    if (lever < 1e-12L) continue;
    const Real gap =
        std::remainder(initial_bearing_deg(a, b) * exact::kPi / 180 - std::atan2(e, n2), 2 * exact::kPi);
    bound.add(std::abs(gap), kBearingError_rad * (1 + 1 / lever));
  }
}

TEST(Sphere, BearingAtSpecialPlaces) {
  EXPECT_EQ(initial_bearing_deg({0, 0}, {0, 0}), 0.0);
  EXPECT_EQ(initial_bearing_deg({0, 0}, {180, 0}), 0.0);
  EXPECT_EQ(initial_bearing_deg({10, 0}, {100, 0}), 90.0);
  EXPECT_EQ(initial_bearing_deg({0, 0}, {-90, 0}), 270.0);
  EXPECT_EQ(initial_bearing_deg({0, 0}, {0, -10}), 180.0);
  EXPECT_EQ(initial_bearing_deg({0, 0}, {55, 90}), 0.0);
  // On the pole the pose's own meridian tells where north is.
  EXPECT_NEAR(initial_bearing_deg({0, 90}, {90, 0}), 90, 1e-13);
  EXPECT_NEAR(initial_bearing_deg({0, 90}, {0, 0}), 180, 1e-13);
  EXPECT_LT(initial_bearing_deg({0, 0}, {-1e-300, 10}), 360.0);
  EXPECT_LT(initial_bearing_deg({0, 0}, {-5e-324, 10}), 360.0);
}

TEST(Sphere, DestinationIsWithinItsBoundAndAgreesWithGeographicLib) {
  geod_geodesic sphere;
  geod_init(&sphere, 1.0, 0.0);
  test_support::Random random(10);
  Bound bound("destination");
  for (const LonLat a : test_places(random, 8000)) {
    const double bearing_deg = random.uniform(-360, 720);
    const double distance = random.integer(0, 1) == 0 ? random.uniform(-7, 7) : random.log_uniform(1e-12, 1);
    const exact::Vec up = exact::direction(a);
    const exact::Vec east{-exact::sin_deg(a.lon_deg), exact::cos_deg(a.lon_deg), 0};
    const exact::Vec north = exact::cross(up, east);
    const exact::Vec ahead = north * exact::cos_deg(bearing_deg) + east * exact::sin_deg(bearing_deg);
    const Real d = distance;
    const exact::Vec want = up * std::cos(d) + ahead * std::sin(d);
    const LonLat got = destination(a, bearing_deg, distance);
    bound.add(exact::angle(exact::direction(got), want), kDestinationError_rad);
    if (std::abs(a.lat_deg) < 90) {
      double lat_deg = 0;
      double lon_deg = 0;
      double end_deg = 0;
      geod_direct(&sphere, a.lat_deg, std::remainder(a.lon_deg, 360), bearing_deg, distance, &lat_deg, &lon_deg,
                  &end_deg);
      EXPECT_LE(exact::angle(exact::direction(got), exact::direction({lon_deg, lat_deg})), 1e-14L);
    }
  }
}

TEST(Sphere, SlerpIsWithinItsBound) {
  test_support::Random random(11);
  Bound unit("slerp: unit length");
  Bound place("slerp: place");
  for (const auto& [a, b] : test_pairs(random, 10000)) {
    const glm::dvec3 unit_a = glm::normalize(a);
    const glm::dvec3 unit_b = glm::normalize(b);
    const double t = random.uniform(0, 1);
    const glm::dvec3 p = slerp(unit_a, unit_b, t);
    unit.add(std::abs(exact::length(vec(p)) - 1), 4e-16L);
    const Real angle = exact::angle(vec(unit_a), vec(unit_b));
    if (exact::kPi - angle < 1e-6L || angle < 1e-15L) continue;
    const Real s = std::sin(angle);
    const exact::Vec want =
        vec(unit_a) * (std::sin((1 - t) * angle) / s) + vec(unit_b) * (std::sin(t * angle) / s);
    // The plane of the circle is known as well as the cross product of its ends.
    place.add(exact::angle(vec(p), want), kSlerpError_rad * std::max(Real{1}, std::sin(t * angle) / s));
  }
  const glm::dvec3 x(1, 0, 0);
  EXPECT_EQ(slerp(x, x, 0.3), x);
  // Antipodes: one great circle for every t.
  const glm::dvec3 normal = glm::cross(x, slerp(x, -x, 0.5));
  for (const double t : {0.0, 0.1, 0.7, 1.0, 1.5}) {
    EXPECT_NEAR(glm::dot(normal, slerp(x, -x, t)), 0, 1e-15);
    EXPECT_NEAR(glm::dot(x, slerp(x, -x, t)), std::cos(t * kPi), 1e-15);
  }
  const glm::dvec3 y(0, 1, 0);
  EXPECT_NEAR(glm::length(slerp(x, y, 2.0) + x), 0, 1e-15);  // beyond the end
}

TEST(Sphere, AnyPerpendicularIsPerpendicular) {
  test_support::Random random(12);
  Bound bound("any_perpendicular");
  for (int n = 0; n < 20000; ++n) {
    const glm::dvec3 v = random.direction();
    const exact::Vec p = vec(any_perpendicular(v));
    bound.add(std::max(std::abs(exact::dot(p, vec(v))), std::abs(exact::length(p) - 1)), 4e-16L);
  }
  EXPECT_NEAR(any_perpendicular({0, 0, 1}).z, 0, 1e-15);
}

TEST(Sphere, HorizonIsWithinItsBound) {
  test_support::Random random(13);
  Bound bound("horizon: relative");
  for (int n = 0; n < 20000; ++n) {
    const double alt_m = random.log_uniform(1e-6, 1e9);
    const double radius_m = random.log_uniform(1e3, 1e8);
    const Real h = alt_m;
    const Real r = radius_m;
    const Real distance = std::sqrt(h * (2 * r + h));
    bound.add(std::abs(horizon_distance_m(alt_m, radius_m) - distance) / distance, kHorizonError);
    const Real dip = std::atan(distance / r);
    bound.add(std::abs(horizon_dip_rad(alt_m, radius_m) - dip) / dip, kHorizonError);
  }
  // 2 m above Mars one sees 3.7 km.
  EXPECT_NEAR(horizon_distance_m(2, kMarsRadius_m), 3685.7, 0.1);
  for (const double alt_m : {0.0, -0.0, -1.0, -1e9}) {
    EXPECT_EQ(horizon_distance_m(alt_m, kMarsRadius_m), 0.0);
    EXPECT_EQ(horizon_dip_rad(alt_m, kMarsRadius_m), 0.0);
  }
}

TEST(Sphere, LonLatOfManyIsThatOfAtan2) {
  test_support::Random random(14);
  std::vector<glm::dvec3> directions;
  for (const double x : {0.0, -0.0, 1.0, -1.0}) {
    for (const double y : {0.0, -0.0, 1.0, -1.0, 5e-324, -1e-300}) {
      for (const double z : {0.0, -0.0, 1.0, -1.0, 1e-200}) directions.emplace_back(x, y, z);
    }
  }
  for (int n = 0; n < 200000; ++n) {
    glm::dvec3 d = random.direction() * random.log_uniform(1e-3, 1e3);
    if (n % 5 == 0) d[n % 3] *= random.log_uniform(1e-30, 1);
    if (n % 7 == 0) d.y = n % 2 == 0 ? d.x : -d.x;
    directions.push_back(d);
  }
  for (const double scale : {1.0, 0.9941}) {
    std::vector<glm::dvec2> angles(directions.size());
    std::vector<glm::dvec2> plain(directions.size());
    lon_lat_deg(directions, scale, angles);
    lon_lat_deg_plain(directions, scale, plain);
    Bound bound("longitude or latitude of many: relative");
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const glm::dvec3& d = directions[n];
      for (const int k : {0, 1}) {
        const double own = angles[n][k];
        ASSERT_EQ(std::bit_cast<std::uint64_t>(own), std::bit_cast<std::uint64_t>(plain[n][k]));
        const double up = k == 0 ? d.y : d.z;
        const double along = k == 0 ? d.x : std::sqrt(d.x * d.x + d.y * d.y) * scale;
        const Real radians = std::atan2(Real{up}, Real{along});
        ASSERT_EQ(std::signbit(own), std::signbit(up));
        if (std::abs(radians) < 1e-300L) {
          ASSERT_LE(std::abs(own), 1e-297);
          continue;
        }
        const Real want = radians * 180 / std::acos(Real{-1});
        bound.add(std::abs(own - want) / std::abs(want), kLonLatDegError);
        // Axes and diagonals have the very values of std::atan2(), so that posts on them keep their halves.
        if (up == 0 || along == 0 || std::abs(up) == std::abs(along)) {
          ASSERT_EQ(own, std::atan2(up, along) / kRadiansPerDegree);
        }
      }
    }
  }
}

}  // namespace
}  // namespace mars
