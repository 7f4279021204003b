// Reliefs at their places: composition, frames, levels, bounds over caps, many of them.
#include "relief/relief.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <rapidcheck/gtest.h>
#include <cmath>
#include <limits>

#include "relief/spec_line.h"
#include "tests/relief/random_relief.h"
#include "tests/support/fake_source.h"

namespace relief {
namespace {

using mars::kMarsRadius_m;
using test_support::Random;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double flat_ground(const glm::dvec3&) { return 100; }

Relief placed(std::initializer_list<const char*> lines, const GroundHeight& ground = flat_ground) {
  std::vector<ReliefSpec> specs;
  for (const char* line : lines) specs.push_back(parse_relief_line(line));
  return place(std::move(specs), kMarsRadius_m, ground);
}

// `place` is also the name of places below.
Relief place_all(std::vector<ReliefSpec> specs, const GroundHeight& ground = flat_ground) {
  return place(std::move(specs), kMarsRadius_m, ground);
}

// Returns the direction so far from a place.
glm::dvec3 beside(mars::LonLat place, double bearing_deg, double way_m) {
  return mars::direction(mars::destination(place, bearing_deg, way_m / kMarsRadius_m));
}

// Returns a direction in a cap.
glm::dvec3 within(Random& random, const mars::Cap& cap) {
  const glm::dvec3 side = mars::any_perpendicular(cap.centre);
  const glm::dvec3 other = glm::cross(cap.centre, side);
  const double angle = random.uniform(0, 2 * mars::kPi);
  const double radius = cap.radius_rad * (random.integer(0, 4) == 0 ? 1.0 : std::sqrt(random.uniform(0, 1)));
  return glm::normalize(cap.centre * std::cos(radius) +
                        (side * std::cos(angle) + other * std::sin(angle)) * std::sin(radius));
}

TEST(ReliefComposition, FollowsItsFormulas) {
  EXPECT_EQ(composed_m(Mode::kAdd, 10, 4, 0.5), 12);
  EXPECT_EQ(composed_m(Mode::kReplace, 10, 4, 0.5), 7);
  EXPECT_EQ(composed_m(Mode::kReplace, 10.1, 4.3, 1), 4.3);
  EXPECT_EQ(composed_m(Mode::kMax, 10, 4, 1), 10);
  EXPECT_EQ(composed_m(Mode::kMax, 10, 14, 0.25), 11);
  EXPECT_EQ(composed_m(Mode::kMin, 10, 14, 1), 10);
  EXPECT_EQ(composed_m(Mode::kMin, 10, 4, 0.5), 7);
  EXPECT_EQ(composed_m(Mode::kReplace, 10, 4, 0), 10);
}

RC_GTEST_PROP(ReliefComposition, BoundsHoldForAllNumbers, (unsigned seed)) {
  Random random(seed);
  const auto interval = [&](double low, double high) {
    const double a = random.uniform(low, high);
    return Interval{a, a + random.uniform(0, high - a)};
  };
  for (const Mode mode : {Mode::kAdd, Mode::kReplace, Mode::kMax, Mode::kMin}) {
    for (int n = 0; n < 20; ++n) {
      const Interval ground = interval(-10, 10);
      const Interval target = interval(-10, 10);
      const Interval weight = interval(0, 1);
      const Interval bounds = composed_m(mode, ground, target, weight);
      for (int k = 0; k < 20; ++k) {
        const double height_m =
            composed_m(mode, random.uniform(ground.low, ground.high), random.uniform(target.low, target.high),
                       random.uniform(weight.low, weight.high));
        RC_ASSERT(bounds.low <= height_m && height_m <= bounds.high);
      }
    }
  }
}

TEST(PlacedReliefs, HaveArcsAsDistancesAndKeepBearings) {
  for (const mars::LonLat place : {mars::LonLat{137, -4}, {180, 60}, {-179.999, 0}, {20, 90}, {0, -90}}) {
    ReliefSpec spec;
    spec.place = place;
    spec.radius_m = 1000;
    spec.azimuth_deg = 30;
    const PlacedRelief one(spec, kMarsRadius_m);
    for (const double way_m : {0.5, 700.0, 3e5}) {
      // 20 degrees to the right of the axis; y lies to its left.
      const glm::dvec2 at_m = one.local_m(beside(place, 50, way_m));
      EXPECT_NEAR(at_m.x, way_m * std::cos(20 * mars::kRadiansPerDegree), 1e-7);
      EXPECT_NEAR(at_m.y, -way_m * std::sin(20 * mars::kRadiansPerDegree), 1e-7);
    }
  }
}

TEST(Reliefs, ChangeTheGroundAtTheirPlaces) {
  const Relief relief = placed({"kind=crater lon=10 lat=20 radius=500 depth=150 rim=30"});
  EXPECT_DOUBLE_EQ(relief.height_m(mars::direction({10, 20}), 7), 7 - 120);
  EXPECT_NEAR(relief.height_m(beside({10, 20}, 77, 500), 7), 7 + 30, 1e-3);
  EXPECT_NEAR(relief.height_m(beside({10, 20}, 200, 1000), 7), 7 + 30.0 / 8, 1e-6);
  EXPECT_EQ(relief.height_m(beside({10, 20}, 200, 2501), 7.1), 7.1);
  EXPECT_EQ(relief.height_m(mars::direction({-170, -20}), 7.1), 7.1);
  EXPECT_TRUE(std::isnan(relief.height_m(mars::direction({10, 20}), kNan)));
  EXPECT_TRUE(relief.change(mars::direction({10, 20}), 7).decides);
  EXPECT_FALSE(relief.change(beside({10, 20}, 0, 2600), 7).is_changed);
}

TEST(Reliefs, AreTheSameAcrossTheAntimeridianAndThePoles) {
  for (const mars::LonLat place : {mars::LonLat{180, 10}, {-180, 10}, {77, 90}, {0, -90}}) {
    ReliefSpec spec;
    spec.place = place;
    spec.radius_m = 2000;
    spec.depth_m = 800;
    spec.rim_m = 160;
    const Relief relief = place_all({spec});
    for (double bearing_deg = 0; bearing_deg < 360; bearing_deg += 15) {
      EXPECT_NEAR(relief.height_m(beside(place, bearing_deg, 1000), 0), -640 + 800 * 0.25, 1e-6);
    }
  }
}

TEST(Reliefs, TakeTheirLevelFromTheGroundAtTheirPlace) {
  const Relief relief =
      placed({"kind=pad lon=1 lat=2 radius=50 falloff=10", "kind=pad lon=1 lat=2 radius=20 falloff=5 rise=3",
              "kind=pad lon=5 lat=2 radius=20 level=-40"});
  EXPECT_EQ(relief.placed()[0].zero_m(), 100);
  EXPECT_EQ(relief.placed()[1].zero_m(), 103);
  EXPECT_EQ(relief.height_m(beside({1, 2}, 0, 15), 80), 103);
  EXPECT_EQ(relief.height_m(beside({1, 2}, 0, 40), 80), 100);
  EXPECT_EQ(relief.height_m(mars::direction({5, 2}), 80), -40);
}

TEST(Reliefs, ArePlacedOnTheGroundThatThoseBeforeThemLeave) {
  const Relief relief =
      placed({"kind=crater lon=1 lat=2 radius=500 depth=100 rim=0", "kind=pad lon=1 lat=2 radius=50",
              "kind=crater lon=1 lat=2 radius=500 depth=100 rim=0"});
  EXPECT_EQ(relief.placed()[1].zero_m(), 0);
  EXPECT_EQ(relief.height_m(mars::direction({1, 2}), 100), -100);
}

TEST(Reliefs, AreAppliedInOrder) {
  const auto at = [](std::initializer_list<const char*> lines) {
    return placed(lines).height_m(mars::direction({1, 2}), 100);
  };
  EXPECT_EQ(
      at({"kind=crater lon=1 lat=2 radius=500 depth=50 rim=10", "kind=flood lon=1 lat=2 radius=400 level=90"}),
      90);
  EXPECT_EQ(
      at({"kind=flood lon=1 lat=2 radius=400 level=90", "kind=crater lon=1 lat=2 radius=500 depth=50 rim=10"}),
      60);
}

TEST(Reliefs, DamsHoldWater) {
  // A valley along the meridian 0 that falls to the north.
  const auto valley = [](const glm::dvec3& d) {
    const double east_m = d.y * kMarsRadius_m;
    return 0.002 * east_m * east_m - 0.01 * d.z * kMarsRadius_m;
  };
  const Relief relief =
      place({parse_relief_line("kind=dam lon=0 lat=0 azimuth=90 length=400 width=6 height=20"),
             parse_relief_line(
                 "kind=flood lon=0 lat=-0.01 level=15 polygon=-0.003,0;0.003,0;0.003,-0.02;-0.003,-0.02")},
            kMarsRadius_m, valley);
  const auto ground = [&](double east_m, double north_m) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(1, east_m / kMarsRadius_m, north_m / kMarsRadius_m));
    return relief.height_m(d, valley(d));
  };
  EXPECT_NEAR(ground(0, 0), 20, 1e-6);
  EXPECT_NEAR(ground(50, -2), 20, 1e-6);
  EXPECT_NEAR(ground(0, -400), 15, 1e-6);
  EXPECT_NEAR(ground(0, -800), 15, 1e-6);
  EXPECT_NEAR(ground(0, 400), -4, 1e-3);
}

TEST(Reliefs, StrengthScalesTheChange) {
  const double whole = placed({"kind=crater lon=1 lat=2 radius=500"}).height_m(mars::direction({1, 2}), 0);
  const double half =
      placed({"kind=crater lon=1 lat=2 radius=500 strength=0.5"}).height_m(mars::direction({1, 2}), 0);
  EXPECT_EQ(half, whole / 2);
  EXPECT_EQ(placed({"kind=pad lon=1 lat=2 radius=5 strength=0"}).height_m(mars::direction({1, 2}), 3.1), 3.1);
}

// Heights in a cap lie within its bounds, for one and for several reliefs, over caps from centimetres to the planet.
RC_GTEST_PROP(ReliefsProperty, BoundsHoldOverCaps, (unsigned seed)) {
  Random random(seed);
  std::vector<ReliefSpec> specs{random_relief(random, kEveryKind[random.integer(0, 7)])};
  const mars::LonLat place = specs[0].place;
  while (random.integer(0, 2) != 0) {
    specs.push_back(random_relief(random, kEveryKind[random.integer(0, 7)]));
    if (specs.back().polygon.empty()) specs.back().place = place;
  }
  const Relief relief = place_all(specs, test_support::bumpy_height);
  const double reach_rad = relief.placed()[0].cap().radius_rad;
  for (int n = 0; n < 12; ++n) {
    mars::Cap cap = relief.placed()[0].cap();
    cap.radius_rad *= 1.5;
    cap.centre = within(random, cap);
    cap.radius_rad = std::min(mars::kPi, reach_rad * random.log_uniform(1e-6, 10));
    const Interval ground{-20 - random.uniform(0, 10), 30};
    const Interval bounds = relief.bounds_m(cap, ground);
    const bool touches = relief.touches(cap);
    for (int k = 0; k < 40; ++k) {
      const glm::dvec3 direction = within(random, cap);
      const double ground_m = random.uniform(ground.low, ground.high);
      const double height_m = relief.height_m(direction, ground_m);
      RC_ASSERT(bounds.low <= height_m && height_m <= bounds.high);
      RC_ASSERT(touches || height_m == ground_m);
      RC_ASSERT(touches || std::isinf(relief.spacing_m(cap)));
    }
  }
}

TEST(Reliefs, BoundsShrinkWithTheCap) {
  Random random(3);
  for (const ReliefKind kind : kEveryKind) {
    for (int n = 0; n < 50; ++n) {
      const Relief relief = place_all({random_relief(random, kind)});
      const mars::Cap& cap = relief.placed()[0].cap();
      const glm::dvec3 direction = within(random, cap);
      const double ground_m = random.uniform(-10, 10);
      const double height_m = relief.height_m(direction, ground_m);
      const Interval bounds = relief.bounds_m({direction, 1e-14}, {ground_m, ground_m});
      EXPECT_LE(bounds.low, height_m);
      EXPECT_GE(bounds.high, height_m);
      EXPECT_LE(bounds.high - bounds.low, 1e-3) << kind_word(kind);
    }
  }
}

TEST(Reliefs, ABatchHasTheHeightsOfItsPlaces) {
  Random random(4);
  std::vector<ReliefSpec> specs;
  for (int n = 0; n < 200; ++n) {
    specs.push_back(random_relief(random, kEveryKind[n % 8]));
    if (!specs.back().polygon.empty()) continue;
    specs.back().place = {10 + random.uniform(0, 0.5), random.uniform(0, 0.5)};
  }
  const Relief relief = place_all(specs);
  for (const std::size_t count : {std::size_t{1}, std::size_t{7}, std::size_t{500}}) {
    for (const double spread : {1e-4, 1e-2, 2.0}) {
      std::vector<glm::dvec3> directions;
      std::vector<double> ground_m;
      for (std::size_t n = 0; n < count; ++n) {
        directions.push_back(within(random, {mars::direction({10.2, 0.2}), spread}));
        ground_m.push_back(random.uniform(-100, 100));
      }
      std::vector<ReliefChange> changes(count);
      relief.change(directions, ground_m, changes);
      for (std::size_t n = 0; n < count; ++n) {
        const ReliefChange one = relief.change(directions[n], ground_m[n]);
        EXPECT_EQ(changes[n].height_m, one.height_m);
        EXPECT_EQ(changes[n].is_changed, one.is_changed);
        EXPECT_EQ(changes[n].decides, one.decides);
      }
    }
  }
}

TEST(Reliefs, WantPostsOfAShareOfTheirParts) {
  const Relief relief =
      placed({"kind=pad lon=1 lat=2 radius=50 falloff=8", "kind=pad lon=3 lat=2 radius=50 spacing=0.25"});
  EXPECT_EQ(relief.spacing_m({mars::direction({1, 2}), 0}), 2);
  EXPECT_EQ(relief.spacing_m({mars::direction({3, 2}), 0}), 0.25);
  EXPECT_EQ(relief.spacing_m({mars::direction({2, 2}), 0.1}), 0.25);
  EXPECT_EQ(relief.spacing_m({mars::direction({9, 2}), 0.001}), std::numeric_limits<double>::infinity());
}

TEST(Reliefs, NarrowBordersAndFineOctavesDoNotAskForPostsWithoutEnd) {
  const auto spacing_m = [](const char* line) { return placed({line}).placed()[0].spacing_m(); };
  EXPECT_EQ(spacing_m("kind=pad lon=1 lat=2 radius=64 falloff=0.01"), 1);
  EXPECT_EQ(spacing_m("kind=ramp lon=1 lat=2 length=900 width=64 falloff=0.01"), 1);
  EXPECT_EQ(spacing_m("kind=flood lon=1 lat=2 radius=64 falloff=0.01"), 1);
  EXPECT_EQ(spacing_m("kind=noise lon=1 lat=2 radius=999 amplitude=1 wavelength=64 octaves=12"), 1);
  EXPECT_EQ(spacing_m("kind=noise lon=1 lat=2 radius=999 amplitude=1 wavelength=64 octaves=2"), 8);
  EXPECT_EQ(spacing_m("kind=crater lon=1 lat=2 radius=64"), 2);
}

TEST(Reliefs, TenThousandStackedAreTheirSum) {
  std::vector<ReliefSpec> specs(10000,
                                parse_relief_line("kind=crater lon=1 lat=2 radius=500 depth=0.5 rim=0.125"));
  for (std::size_t n = 0; n < specs.size(); ++n) specs[n].azimuth_deg = static_cast<double>(n % 360);
  const Relief relief = place_all(specs);
  EXPECT_EQ(relief.height_m(mars::direction({1, 2}), 0), -0.375 * 10000);
  EXPECT_NEAR(relief.height_m(beside({1, 2}, 40, 1000), 0), 0.125 / 8 * 10000, 1e-6);
  const Interval bounds = relief.bounds_m({mars::direction({1, 2}), 0}, {0, 0});
  EXPECT_LE(bounds.low, -3750);
  EXPECT_GE(bounds.high, -3750);
  EXPECT_LE(bounds.high - bounds.low, 1e-3);
}

TEST(Reliefs, StackedPadsHaveTheGroundOfThoseBefore) {
  std::vector<ReliefSpec> specs(2000, parse_relief_line("kind=pad lon=1 lat=2 radius=50 rise=0.5"));
  const Relief relief = place_all(specs, flat_ground);
  EXPECT_EQ(relief.height_m(mars::direction({1, 2}), 0), 100 + 0.5 * 2000);
}

TEST(Reliefs, ManyAreFoundWhereTheyAre) {
  Random random(6);
  std::vector<ReliefSpec> specs;
  for (int n = 0; n < 20000; ++n) {
    specs.push_back(parse_relief_line("kind=crater lon=0 lat=0 radius=3000"));
    specs.back().place = mars::lon_lat(random.direction());
  }
  const Relief relief = place_all(specs);
  for (int n = 0; n < 300; ++n) {
    const glm::dvec3 direction = random.direction();
    double expected_m = 5;
    for (const PlacedRelief& one : relief.placed()) expected_m = one.change(direction, expected_m).height_m;
    EXPECT_EQ(relief.height_m(direction, 5), expected_m);
  }
}

std::string problem_of_placing(std::vector<ReliefSpec> specs, double radius_m = kMarsRadius_m,
                               const GroundHeight& ground = flat_ground) {
  try {
    place(std::move(specs), radius_m, ground);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

TEST(Reliefs, RefuseWhatCannotBePlaced) {
  ReliefSpec crater;
  crater.name = "big";
  EXPECT_EQ(problem_of_placing({crater}), "relief 1 \"big\": radius_m is missing in a crater");
  crater.radius_m = -5;
  EXPECT_EQ(problem_of_placing({crater}),
            "relief 1 \"big\": radius_m: expected a number from 0.01 to 10000000 m, or auto, found \"-5\"");
  crater.radius_m = kNan;
  EXPECT_NE(problem_of_placing({crater}).find("found \"nan\""), std::string::npos);
  crater.radius_m = 1e6;
  EXPECT_EQ(
      problem_of_placing({crater}),
      "relief 1 \"big\": it reaches 5000000 m from its place; expected at most 3400000 m, the radius of the planet");
  const ReliefSpec pad = parse_relief_line("kind=pad lon=1 lat=2 radius=50");
  const std::string no_ground = "relief 1: there is no ground at its place; give level_m, or another place";
  EXPECT_EQ(problem_of_placing({pad}, kMarsRadius_m, [](const glm::dvec3&) { return kNan; }), no_ground);
  EXPECT_EQ(problem_of_placing({pad}, kMarsRadius_m, {}), no_ground);
  EXPECT_NE(problem_of_placing({pad}, 0), "");
  EXPECT_NE(problem_of_placing({pad}, kNan), "");
  EXPECT_EQ(problem_of_placing(std::vector<ReliefSpec>(kMostReliefs + 1, pad)),
            "100001 reliefs; expected at most 100000");
  const ReliefSpec far_polygon = parse_relief_line("kind=flood lon=1 lat=2 polygon=100,0;101,0;100,1");
  EXPECT_NE(problem_of_placing({far_polygon}).find("too far from the place"), std::string::npos);
}

TEST(Reliefs, NoneChangeNothing) {
  const Relief none;
  EXPECT_EQ(none.height_m({1, 0, 0}, 4.25), 4.25);
  EXPECT_FALSE(none.touches({{1, 0, 0}, mars::kPi}));
  const Interval bounds = none.bounds_m({{1, 0, 0}, 1}, {1, 2});
  EXPECT_EQ(bounds.low, 1);
  EXPECT_EQ(bounds.high, 2);
  none.change(std::span<const glm::dvec3>(), std::span<const double>(), std::span<ReliefChange>());
}

// Reliefs on a body that is no sphere lie on the sphere of its radius at their place.
TEST(Reliefs, SizesAreThoseOfTheBodysRadius) {
  const auto radius_m = [](const glm::dvec3& d) { return d.z > 0.5 ? 500.0 : 2000.0; };
  const auto flat = [](const glm::dvec3&) { return 0.0; };
  const auto specs = [] {
    return std::vector<ReliefSpec>{parse_relief_line("kind=crater lon=0 lat=0 radius=40"),
                                   parse_relief_line("kind=crater lon=0 lat=90 radius=40")};
  };
  const Relief relief = place(specs(), radius_m, flat);
  ASSERT_EQ(relief.placed().size(), 2U);
  EXPECT_NEAR(relief.placed()[1].cap().radius_rad / relief.placed()[0].cap().radius_rad, 4, 1e-9);
  EXPECT_NEAR(relief.height_m({1, 0, 0}, 0), relief.height_m({0, 0, 1}, 0), 1e-9);
  EXPECT_LT(relief.height_m({1, 0, 0}, 0), -5);
  EXPECT_THROW(place(
                   specs(), [](const glm::dvec3&) { return kNan; }, flat),
               std::runtime_error);
}

}  // namespace
}  // namespace relief
