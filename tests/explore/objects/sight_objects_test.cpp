// Lines of sight among objects: balls, of which all distances are known.
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/explore/terrain_fixture.h"
#include "vpe/explore/measure/line_of_sight.h"
#include "vpe/explore/measure/sight_scene.h"
#include "vpe/explore/measure/sight_text.h"

namespace vpe::explore {
namespace {

using test_support::Random;

struct TestBall {
  glm::dvec3 centre_m;
  double radius_m;
  std::string name = "ball";
};

// Returns the distance at which a ray enters a ball, or leaves it if it begins inside.
std::optional<double> enters(const TestBall& ball, const glm::dvec3& from_m, const glm::dvec3& direction) {
  const glm::dvec3 to = ball.centre_m - from_m;
  const double along = glm::dot(to, direction);
  const double aside = glm::length(to - along * direction);
  if (aside > ball.radius_m) return std::nullopt;
  const double half = std::sqrt((ball.radius_m - aside) * (ball.radius_m + aside));
  if (along + half < 0) return std::nullopt;
  return along - half >= 0 ? along - half : along + half;
}

FirstObject among(std::vector<TestBall> balls) {
  return [balls = std::move(balls)](const glm::dvec3& from_m, const glm::dvec3& direction, double until_m) {
    std::optional<SightObject> first;
    for (const TestBall& ball : balls) {
      const std::optional<double> at_m = enters(ball, from_m, direction);
      if (at_m && *at_m < until_m && (!first || *at_m < first->range_m)) first = SightObject{*at_m, ball.name};
    }
    return first;
  };
}

void expect_same_figures(const LineOfSight& a, const LineOfSight& b) {
  EXPECT_EQ(a.distance_m, b.distance_m);
  EXPECT_EQ(a.arc_m, b.arc_m);
  EXPECT_EQ(a.clearance_m, b.clearance_m);
  EXPECT_EQ(a.clearance_error_m, b.clearance_error_m);
  EXPECT_EQ(a.clearance_distance_m, b.clearance_distance_m);
  EXPECT_EQ(a.needed_height_m, b.needed_height_m);
}

class SightObjects : public test_support::GroundTest<test_support::RidgeGround> {
 protected:
  struct Ends {
    glm::dvec3 from_m;
    glm::dvec3 ray;
    double distance_m;
  };
  static glm::dvec3 point_of(const SightPoint& p) {
    const glm::dvec3 up = mars::direction(p.place);
    return (surface().at(up).radius_m + p.height_m) * up;
  }
  static Ends ends(const SightPoint& a, const SightPoint& b) {
    const glm::dvec3 path = point_of(b) - point_of(a);
    return {point_of(a), glm::normalize(path), glm::length(path)};
  }
  static TestBall ball_on(const Ends& line, double at_m, double radius_m) {
    return {line.from_m + at_m * line.ray, radius_m};
  }

  // The ridge is between low_west_ and low_east_; the others see each other over it.
  const SightPoint low_west_{{-35.3, 20}, 60};
  const SightPoint low_east_{{-34.7, 20}, 60};
  const SightPoint high_west_{{-35.1, 20}, 900};
  const SightPoint high_east_{{-34.9, 20}, 900};
};

TEST_F(SightObjects, AnObjectBeforeTheRidgeHides) {
  const Ends line = ends(low_west_, low_east_);
  const TestBall ball = ball_on(line, 2000, 5);
  const LineOfSight bare = line_of_sight(surface(), low_west_, low_east_);
  const LineOfSight sight = line_of_sight(surface(), low_west_, low_east_, among({ball}));
  EXPECT_FALSE(sight.visible);
  ASSERT_TRUE(sight.obstruction);
  EXPECT_EQ(sight.obstruction->object, "ball");
  EXPECT_NEAR(sight.obstruction->distance_m, 1995, 1e-6);
  const glm::dvec3 met = line.from_m + 1995.0 * line.ray;
  EXPECT_LT(mars::distance_rad(sight.obstruction->place, mars::lon_lat(met)) * mars::kMarsRadius_m, 1e-6);
  EXPECT_NEAR(sight.obstruction->elevation_m, glm::length(met) - mars::kMarsRadius_m, 1e-6);
  // The figures of the ground do not know objects.
  expect_same_figures(sight, bare);
}

TEST_F(SightObjects, GroundBeforeAnObjectHides) {
  const LineOfSight bare = line_of_sight(surface(), low_west_, low_east_);
  ASSERT_TRUE(bare.obstruction);
  const Ends line = ends(low_west_, low_east_);
  for (const double beyond_m : {6.0, 2000.0}) {
    const TestBall ball = ball_on(line, bare.obstruction->distance_m + beyond_m, 5);
    const LineOfSight sight = line_of_sight(surface(), low_west_, low_east_, among({ball}));
    ASSERT_TRUE(sight.obstruction);
    EXPECT_EQ(sight.obstruction->object, "");
    EXPECT_EQ(sight.obstruction->distance_m, bare.obstruction->distance_m);
    EXPECT_EQ(sight.obstruction->elevation_m, bare.obstruction->elevation_m);
    expect_same_figures(sight, bare);
  }
}

TEST_F(SightObjects, IsAskedOnceForWhatIsVisibleOfTheLine) {
  struct Asked {
    glm::dvec3 from_m;
    glm::dvec3 direction;
    double until_m;
  };
  std::vector<Asked> asked;
  const FirstObject none = [&](const glm::dvec3& from_m, const glm::dvec3& direction, double until_m) {
    asked.push_back({from_m, direction, until_m});
    return std::optional<SightObject>();
  };
  const LineOfSight over = line_of_sight(surface(), high_west_, high_east_, none);
  EXPECT_TRUE(over.visible);
  EXPECT_FALSE(over.obstruction);
  const LineOfSight hidden = line_of_sight(surface(), low_west_, low_east_, none);
  ASSERT_TRUE(hidden.obstruction);
  ASSERT_EQ(asked.size(), 2U);
  const Ends line = ends(high_west_, high_east_);
  const double end_m = kSightEnd_m + 1e-8 * line.distance_m;
  EXPECT_NEAR(glm::length(asked[0].from_m - line.from_m), end_m, 1e-8);
  EXPECT_LT(glm::length(asked[0].direction - line.ray), 1e-12);
  EXPECT_NEAR(asked[0].until_m, line.distance_m - 2 * end_m, 1e-8);
  EXPECT_NEAR(asked[1].until_m, hidden.obstruction->distance_m - kSightEnd_m - 1e-8 * hidden.distance_m, 1e-8);
}

TEST_F(SightObjects, TheFirstOfSeveralHidesAndThoseBeyondTheTargetDoNot) {
  const Ends line = ends(high_west_, high_east_);
  TestBall far = ball_on(line, line.distance_m - 50, 20);
  far.name = "far";
  TestBall near = ball_on(line, 100, 30);
  near.name = "near";
  const LineOfSight sight = line_of_sight(surface(), high_west_, high_east_, among({far, near}));
  ASSERT_TRUE(sight.obstruction);
  EXPECT_EQ(sight.obstruction->object, "near");
  EXPECT_NEAR(sight.obstruction->distance_m, 70, 1e-6);
  const LineOfSight back = line_of_sight(surface(), high_east_, high_west_, among({far, near}));
  ASSERT_TRUE(back.obstruction);
  EXPECT_EQ(back.obstruction->object, "far");
  EXPECT_NEAR(back.obstruction->distance_m, 30, 1e-6);
  const TestBall beyond = ball_on(line, line.distance_m + 30, 20);
  const TestBall behind = ball_on(line, -30, 20);
  EXPECT_TRUE(line_of_sight(surface(), high_west_, high_east_, among({beyond, behind})).visible);
}

TEST_F(SightObjects, AtTheSameDistanceItIsTheGround) {
  const FirstObject at_the_end = [](const glm::dvec3&, const glm::dvec3&, double until_m) {
    return std::optional<SightObject>({until_m, "tie"});
  };
  const LineOfSight hidden = line_of_sight(surface(), low_west_, low_east_, at_the_end);
  ASSERT_TRUE(hidden.obstruction);
  EXPECT_EQ(hidden.obstruction->object, "");
  EXPECT_TRUE(line_of_sight(surface(), high_west_, high_east_, at_the_end).visible);
}

TEST_F(SightObjects, EndsMayTouchObjectsButNotBeInThem) {
  const Ends line = ends(high_west_, high_east_);
  constexpr double kRadius_m = 4;
  const auto with = [&](double at_m) {
    return line_of_sight(surface(), high_west_, high_east_, among({ball_on(line, at_m, kRadius_m)}));
  };
  EXPECT_TRUE(with(-kRadius_m).visible);
  EXPECT_TRUE(with(line.distance_m + kRadius_m).visible);
  const LineOfSight from_within = with(-kRadius_m + 0.01);
  ASSERT_TRUE(from_within.obstruction);
  EXPECT_NEAR(from_within.obstruction->distance_m, 0.01, 1e-6);
  const LineOfSight to_within = with(line.distance_m + kRadius_m - 0.01);
  ASSERT_TRUE(to_within.obstruction);
  EXPECT_NEAR(to_within.obstruction->distance_m, line.distance_m - 0.01, 1e-6);
}

TEST_F(SightObjects, StraightUpObjectsHide) {
  const mars::LonLat place{-35.2, 20.05};
  const glm::dvec3 up = mars::direction(place);
  const TestBall balloon{(surface().at(up).radius_m + 100) * up, 10, "balloon"};
  const LineOfSight from_below = line_of_sight(surface(), {place, 2}, {place, 500}, among({balloon}));
  ASSERT_TRUE(from_below.obstruction);
  EXPECT_FALSE(from_below.visible);
  EXPECT_EQ(from_below.obstruction->object, "balloon");
  EXPECT_NEAR(from_below.obstruction->distance_m, 88, 1e-6);
  EXPECT_NEAR(from_below.obstruction->elevation_m, surface().at(up).height_m + 90, 1e-6);
  const LineOfSight from_above = line_of_sight(surface(), {place, 500}, {place, 2}, among({balloon}));
  ASSERT_TRUE(from_above.obstruction);
  EXPECT_NEAR(from_above.obstruction->distance_m, 390, 1e-6);
  EXPECT_TRUE(line_of_sight(surface(), {place, 2}, {place, 80}, among({balloon})).visible);
  EXPECT_TRUE(line_of_sight(surface(), {place, 500}, {place, 120}, among({balloon})).visible);
  EXPECT_TRUE(line_of_sight(surface(), {place, 2}, {place, 2}, among({balloon})).visible);
}

// Many balls and lines: hidden exactly by ground, or by a ball that reaches into the line.
TEST_F(SightObjects, AgreesWithClosedFormsForManyBalls) {
  Random random(11);
  int by_ball = 0;
  int by_ground = 0;
  int seen = 0;
  for (int n = 0; n < 300; ++n) {
    const auto any = [&] {
      return SightPoint{{-35 + random.uniform(-0.3, 0.3), 20 + random.uniform(-0.1, 0.1)},
                        random.log_uniform(5, 2000)};
    };
    const SightPoint a = any();
    const SightPoint b = any();
    const Ends line = ends(a, b);
    std::vector<TestBall> balls;
    std::optional<double> nearest_m;
    for (int k = 0; k < 5; ++k) {
      const double radius_m = random.log_uniform(1, 100);
      const glm::dvec3 aside = glm::normalize(glm::cross(line.ray, random.direction()));
      const double along_m = random.uniform(-0.2, 1.2) * line.distance_m;
      const double reach_m = random.uniform(0, 4) * radius_m;
      const bool holds_an_end =
          std::abs(along_m) < radius_m + 1 || std::abs(along_m - line.distance_m) < radius_m + 1;
      if (holds_an_end || std::abs(reach_m - radius_m) < 1e-3) continue;
      balls.push_back({line.from_m + along_m * line.ray + reach_m * aside, radius_m});
      if (reach_m > radius_m || along_m < 0 || along_m > line.distance_m) continue;
      const double at_m = along_m - std::sqrt(radius_m * radius_m - reach_m * reach_m);
      nearest_m = std::min(at_m, nearest_m.value_or(at_m));
    }
    const LineOfSight bare = line_of_sight(surface(), a, b);
    const LineOfSight sight = line_of_sight(surface(), a, b, among(balls));
    const double ground_m =
        bare.obstruction ? bare.obstruction->distance_m : std::numeric_limits<double>::infinity();
    if (nearest_m && *nearest_m < ground_m) {
      ++by_ball;
      ASSERT_TRUE(sight.obstruction);
      EXPECT_EQ(sight.obstruction->object, "ball");
      EXPECT_NEAR(sight.obstruction->distance_m, *nearest_m, 1e-5);
    } else {
      ++(bare.visible ? seen : by_ground);
      EXPECT_EQ(sight.visible, bare.visible);
      if (sight.obstruction) {
        EXPECT_EQ(sight.obstruction->object, "");
      }
    }
    expect_same_figures(sight, bare);
  }
  EXPECT_GT(by_ball, 50);
  EXPECT_GT(by_ground, 30);
  EXPECT_GT(seen, 20);
}

TEST_F(SightObjects, ExceptionsOfTheFunctionPassThrough) {
  const FirstObject fails = [](const glm::dvec3&, const glm::dvec3&, double) -> std::optional<SightObject> {
    throw std::runtime_error("no scene");
  };
  EXPECT_THROW(line_of_sight(surface(), high_west_, high_east_, fails), std::runtime_error);
}

std::string text_of(const std::vector<ReadOutLine>& lines, const std::string& label) {
  for (const ReadOutLine& line : lines)
    if (line.label == label) return line.text;
  return "-";
}

TEST(SightText, SaysWhatHidesAndFromWhichHeightOn) {
  LineOfSight sight;
  sight.visible = true;
  sight.distance_m = 1234;
  sight.clearance_m = 0.5;
  sight.clearance_distance_m = 20;
  SightEnds ends{"A", "C", 2, false};
  EXPECT_EQ(sight_lines(sight, ends),
            (std::vector<ReadOutLine>{{"Straight", "1234 m"}, {"Clearance", "0.50 m, 20.0 m from A"}}));
  sight.visible = false;
  sight.needed_height_m = 7;
  sight.obstruction = Obstruction{{137.4417, -4.5895}, 12.34, -4501.2, ""};
  std::vector<ReadOutLine> lines = sight_lines(sight, ends);
  EXPECT_EQ(text_of(lines, "Obstructed by"), "-");
  EXPECT_EQ(text_of(lines, "Obstructed at"),
            coordinates_text({137.4417, -4.5895}) + "; 12.3 m from A, " + "-4501.2 m elevation");
  EXPECT_EQ(text_of(lines, "Visible for"), "C at 7.00 m above ground");
  ends.has_objects = true;
  EXPECT_EQ(text_of(sight_lines(sight, ends), "Visible for"), "C at 7.00 m above ground, without objects");
  // An object before the ground that would hide it, too.
  sight.obstruction->object = "Curiosity";
  lines = sight_lines(sight, ends);
  EXPECT_EQ(text_of(lines, "Obstructed by"), "Curiosity");
  EXPECT_EQ(text_of(lines, "Visible for"), "C at 7.00 m above ground, without objects");
  // An object alone.
  sight.needed_height_m = 0;
  EXPECT_EQ(text_of(sight_lines(sight, ends), "Visible for"), "C where it is, without objects");
  sight.needed_height_m = std::numeric_limits<double>::infinity();
  EXPECT_EQ(text_of(sight_lines(sight, ends), "Visible for"),
            "no height of C: it is too far behind the horizon");
}

TEST(SightText, CoordinatesHaveFiveDecimals) {
  EXPECT_EQ(coordinates_text({137.4417, -4.5895}), "137.44170, -4.58950");
}

TEST(SightScenes, AreTheSameWhereNothingIsElsewhere) {
  const SightScene none;
  const SightScene shown{"a.scene.toml", 3, 10};
  EXPECT_TRUE(is_same_sight(none, false, {"", 4, 20}));
  EXPECT_FALSE(is_same_sight(none, false, shown));
  EXPECT_FALSE(is_same_sight(shown, false, none));
  EXPECT_TRUE(is_same_sight(shown, false, {"a.scene.toml", 3, 11}));
  EXPECT_FALSE(is_same_sight(shown, true, {"a.scene.toml", 3, 11}));
  EXPECT_TRUE(is_same_sight(shown, true, shown));
  EXPECT_FALSE(is_same_sight(shown, false, {"a.scene.toml", 4, 10}));
  EXPECT_FALSE(is_same_sight(shown, false, {"b.scene.toml", 3, 10}));
  using Tracks = std::vector<core::ObjectTrack>;
  const auto one = std::make_shared<const Tracks>(Tracks{{"rover", {}, {{0, false}}}});
  const auto equal = std::make_shared<const Tracks>(*one);
  const auto other = std::make_shared<const Tracks>(Tracks{{"lander", {}, {{0, false}}}});
  const SightScene tracked{"a.scene.toml", 3, 10, one};
  EXPECT_FALSE(is_same_sight(shown, false, tracked));
  EXPECT_FALSE(is_same_sight(tracked, true, shown));
  EXPECT_TRUE(is_same_sight(tracked, true, {"a.scene.toml", 3, 10, equal}));
  EXPECT_FALSE(is_same_sight(tracked, true, {"a.scene.toml", 3, 10, other}));
}

}  // namespace
}  // namespace vpe::explore
