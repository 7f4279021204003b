// Ways under a slope limit, against closed forms, brute force and their own defining properties.
#include "vpe/map/route/route.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>

#include "tests/support/support.h"
#include "vpe/map/route/route_search.h"

namespace vpe::map {
namespace {

using Posts = std::vector<glm::ivec2>;

constexpr double kNoHeight = std::numeric_limits<double>::quiet_NaN();

HeightGrid ground_of(int columns, int rows, const std::function<double(int, int)>& height_m,
                     double spacing_m = 1) {
  HeightGrid grid{columns, rows, spacing_m, {}};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      grid.heights_m.push_back(static_cast<float>(height_m(column, row)));
  return grid;
}

HeightGrid random_ground(int columns, int rows, std::uint64_t seed, double height_m) {
  test_support::Random random(seed);
  return ground_of(columns, rows, [&](int, int) { return random.uniform(0, height_m); });
}

RouteOptions limit(double slope_deg, double weight = 3) {
  RouteOptions options;
  options.max_slope_deg = slope_deg;
  options.slope_weight = weight;
  return options;
}

double grade_of(double slope_deg) { return std::tan(slope_deg * std::numbers::pi / 180); }

// Computes passable posts and costs of steps in another way than the product: step by step, from the written
// rules.
class Oracle {
 public:
  Oracle(const HeightGrid& grid, const RouteOptions& options) : grid_(grid), options_(options) {}

  bool has(int column, int row) const {
    return column >= 0 && row >= 0 && column < grid_.columns && row < grid_.rows &&
           std::isfinite(grid_.at(column, row));
  }

  bool passable(int column, int row) const {
    if (!has(column, row)) return false;
    double steepest = 0;
    for (const int dx : {-1, 1})
      for (const int dy : {-1, 1}) {
        const double h = grid_.at(column, row);
        const double x = has(column + dx, row) ? grid_.at(column + dx, row) - h : 0;
        const double y = has(column, row + dy) ? grid_.at(column, row + dy) - h : 0;
        steepest = std::max(steepest, std::sqrt(x * x + y * y) / grid_.spacing_m);
      }
    return steepest <= grade_of(options_.max_slope_deg);
  }

  // Returns infinity if the step is not allowed.
  double step_cost(int column, int row, int dx, int dy) const {
    const double infinite = std::numeric_limits<double>::infinity();
    const int least_x = std::min(0, dx);
    const int least_y = std::min(0, dy);
    for (int x = least_x; x <= least_x + std::abs(dx); ++x)
      for (int y = least_y; y <= least_y + std::abs(dy); ++y)
        if (!passable(column + x, row + y)) return infinite;
    const double begin = grid_.at(column, row);
    const double end = grid_.at(column + dx, row + dy);
    if (std::abs(dx) <= 1 && std::abs(dy) <= 1) return piece(std::hypot(dx, dy), end - begin);
    const double middle =
        std::abs(dx) == 2
            ? (double{grid_.at(column + dx / 2, row)} + double{grid_.at(column + dx / 2, row + dy)}) / 2
            : (double{grid_.at(column, row + dy / 2)} + double{grid_.at(column + dx, row + dy / 2)}) / 2;
    return piece(std::sqrt(5.0) / 2, middle - begin) + piece(std::sqrt(5.0) / 2, end - middle);
  }

  // Returns the least cost from one post to all others, by relaxing all steps until nothing changes.
  std::vector<double> costs_from(glm::ivec2 from) const {
    std::vector<double> cost(grid_.heights_m.size(), std::numeric_limits<double>::infinity());
    if (passable(from.x, from.y)) cost[at(from.x, from.y)] = 0;
    for (bool changed = true; changed;) {
      changed = false;
      for (int row = 0; row < grid_.rows; ++row)
        for (int column = 0; column < grid_.columns; ++column) {
          if (!std::isfinite(cost[at(column, row)])) continue;
          for (int dx = -2; dx <= 2; ++dx)
            for (int dy = -2; dy <= 2; ++dy) {
              const int sum = std::abs(dx) + std::abs(dy);
              if (sum == 0 || sum == 4 || (sum == 2 && dx * dy == 0)) continue;
              const double there = cost[at(column, row)] + step_cost(column, row, dx, dy);
              if (!std::isfinite(there)) continue;
              double& known = cost[at(column + dx, row + dy)];
              if (there >= known) continue;
              known = there;
              changed = true;
            }
        }
    }
    return cost;
  }

  std::size_t at(int column, int row) const { return static_cast<std::size_t>(row * grid_.columns + column); }

 private:
  double piece(double run, double rise) const {
    const double run_m = run * grid_.spacing_m;
    const double share = std::abs(rise) / run_m / grade_of(options_.max_slope_deg);
    if (share > 1) return std::numeric_limits<double>::infinity();
    return std::hypot(run_m, rise) * (1 + options_.slope_weight * share * share);
  }

  const HeightGrid& grid_;
  RouteOptions options_;
};

// Checks a way at many points: heights there, slopes between them, posts of the cells around them.
void expect_within_limits(const HeightGrid& grid, const Route& route, const RouteOptions& options) {
  ASSERT_EQ(route.outcome, RouteOutcome::found);
  const Oracle oracle(grid, options);
  for (std::size_t n = 0; n + 1 < route.posts.size(); ++n) {
    const glm::dvec2 a(route.posts[n]);
    const glm::dvec2 along = glm::dvec2(route.posts[n + 1]) - a;
    const int samples = 50 * static_cast<int>(std::ceil(std::hypot(along.x, along.y)));
    for (int s = 0; s <= samples; ++s) {
      const glm::dvec2 place = a + along * (static_cast<double>(s) / samples);
      // Posts of the cell or of the edge that the place lies on.
      for (const double row : {std::floor(place.y + 1e-9), std::ceil(place.y - 1e-9)})
        for (const double column : {std::floor(place.x + 1e-9), std::ceil(place.x - 1e-9)})
          EXPECT_TRUE(oracle.passable(static_cast<int>(column), static_cast<int>(row))) << column << "," << row;
    }
  }
  EXPECT_LE(route.figures.steepest_deg, options.max_slope_deg + 1e-6);
  EXPECT_LE(route.steepest_ground_deg, options.max_slope_deg + 1e-6);
  EXPECT_GE(route.figures.cost_m, route.figures.length_m);
  EXPECT_GE(route.figures.length_m, route.figures.map_length_m);
}

Route way(const HeightGrid& grid, const Posts& places, const RouteOptions& options) {
  return find_route(grid, places, options, 1);
}

TEST(Route, OnLevelGroundIsStraight) {
  test_support::Random random(1);
  const HeightGrid level = ground_of(
      150, 120, [](int, int) { return 7; }, 5);
  for (int n = 0; n < 20; ++n) {
    const int x0 = random.integer(0, 149);
    const int y0 = random.integer(0, 119);
    const int x1 = random.integer(0, 149);
    const int y1 = random.integer(0, 119);
    const Route route = way(level, {{x0, y0}, {x1, y1}}, limit(10));
    ASSERT_EQ(route.outcome, RouteOutcome::found);
    const double straight_m = 5 * std::hypot(x1 - x0, y1 - y0);
    EXPECT_NEAR(route.figures.length_m, straight_m, 1e-9 * straight_m);
    EXPECT_NEAR(route.figures.cost_m, straight_m, 1e-9 * straight_m);
    EXPECT_EQ(route.figures.climb_m, 0);
    EXPECT_LE(route.posts.size(), 2U);
  }
}

TEST(Route, OnAPlaneHasItsFigures) {
  // Rises 0.1 m a metre eastwards: the way east by 40 posts of 2 m climbs 8 m.
  const HeightGrid plane = ground_of(
      60, 60, [](int column, int) { return 0.2 * column; }, 2);
  const Route route = way(plane, {{10, 20}, {50, 20}}, limit(10, 2));
  const double length_m = std::hypot(80, 8);
  EXPECT_NEAR(route.figures.length_m, length_m, 1e-4);
  EXPECT_NEAR(route.figures.map_length_m, 80, 1e-9);
  EXPECT_NEAR(route.figures.climb_m, 8, 1e-5);
  EXPECT_EQ(route.figures.descent_m, 0);
  EXPECT_NEAR(route.figures.steepest_deg, std::atan(0.1) * 180 / std::numbers::pi, 1e-4);
  EXPECT_NEAR(route.steepest_ground_deg, std::atan(0.1) * 180 / std::numbers::pi, 1e-4);
  const double share = 0.1 / grade_of(10);
  EXPECT_NEAR(route.figures.cost_m, length_m * (1 + 2 * share * share), 1e-3);
}

TEST(Route, ZigzagsWhereThatIsCheaper) {
  // Up a plane of grade g, a way at an angle a to the fall costs (1 + w (g cos a / limit)^2) / cos a for each
  // metre of it: least straight up while w (g / limit)^2 < 1, else where cos a = limit / (g sqrt(w)).
  const HeightGrid plane = ground_of(80, 80, [](int column, int) { return 0.15 * column; });
  EXPECT_EQ(way(plane, {{20, 40}, {60, 40}}, limit(10, 1)).posts.size(), 2U);
  const Route zigzag = way(plane, {{20, 40}, {60, 40}}, limit(10, 4));
  EXPECT_GT(zigzag.posts.size(), 2U);
  const double cosine = grade_of(10) / 0.15 / 2;
  EXPECT_GE(zigzag.figures.cost_m, 40 * 2 / cosine);
  EXPECT_LT(zigzag.figures.cost_m, 1.03 * std::hypot(40, 6) * 2 / cosine);
}

TEST(Route, GoesThroughTheGapOfAWall) {
  const HeightGrid wall =
      ground_of(80, 80, [](int column, int row) { return column == 40 && (row < 60 || row > 66) ? 30 : 0; });
  const RouteOptions options = limit(20);
  const Route route = way(wall, {{10, 10}, {70, 10}}, options);
  expect_within_limits(wall, route, options);
  // The wall's first passable post beside the gap is in row 61, since row 60 has a steep neighbour.
  const double by_gap_m = 2 * std::hypot(30, 51);
  EXPECT_GT(route.figures.length_m, by_gap_m - 1e-9);
  EXPECT_LT(route.figures.length_m, 1.01 * (by_gap_m + 4));
  const HeightGrid closed = ground_of(80, 80, [](int column, int) { return column == 40 ? 30 : 0; });
  const Route none = way(closed, {{10, 10}, {70, 10}}, options);
  EXPECT_EQ(none.outcome, RouteOutcome::not_connected);
  EXPECT_EQ(none.at, 0U);
  EXPECT_EQ(none.reached_m2, 39.0 * 80);  // columns 0 to 38
  EXPECT_TRUE(none.posts.empty());
  EXPECT_EQ(none.figures.cost_m, 0);
}

TEST(Route, GoesAroundACone) {
  // 45 degrees steep within 20 posts of the middle.
  const HeightGrid cone = ground_of(
      101, 101, [](int column, int row) { return std::max(0.0, 20 - std::hypot(column - 50, row - 50)); });
  const RouteOptions options = limit(20);
  const Route route = way(cone, {{5, 50}, {95, 50}}, options);
  expect_within_limits(cone, route, options);
  // The tangents to a circle of radius 20, and the arc between them; posts beside it add some.
  const double tangent_m = std::sqrt(45.0 * 45 - 20 * 20);
  const double arc_m = 20 * (std::numbers::pi - 2 * std::acos(20.0 / 45));
  EXPECT_GT(route.figures.length_m, 2 * tangent_m + arc_m - 0.5);
  EXPECT_LT(route.figures.length_m, 1.03 * (2 * tangent_m + arc_m));
  // With a limit above its slope the way goes over it, or around it for its cost.
  EXPECT_EQ(way(cone, {{5, 50}, {50, 50}}, options).outcome, RouteOutcome::too_steep);
  const Route over = way(cone, {{5, 50}, {95, 50}}, limit(70, 0));
  EXPECT_LT(over.figures.map_length_m, route.figures.map_length_m);
}

TEST(Route, PrefersGentleGround) {
  // A ridge across with a slow ramp far off: a high weight makes the detour pay.
  const HeightGrid ridge = ground_of(120, 60, [](int column, int row) {
    const double height = std::max(0.0, 10 - 0.25 * row);
    return height * std::exp(-0.02 * (column - 60) * (column - 60));
  });
  const Route straight = way(ridge, {{20, 5}, {100, 5}}, limit(60, 0));
  const Route gentle = way(ridge, {{20, 5}, {100, 5}}, limit(60, 100));
  EXPECT_LT(straight.figures.length_m, gentle.figures.length_m);
  EXPECT_LT(gentle.figures.climb_m, straight.figures.climb_m / 2);
}

TEST(Route, SearchIsAsGoodAsBruteForce) {
  int found = 0;
  int apart = 0;
  for (std::uint64_t seed = 100; seed < 140; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test_support::Random random(seed);
    HeightGrid grid = random_ground(14, 11, seed + 1000, 1.1);
    grid.spacing_m = 1.5;
    for (int n = 0; n < 6; ++n)
      grid.heights_m[static_cast<std::size_t>(random.integer(0, 14 * 11 - 1))] = std::nanf("");
    const RouteOptions options = limit(random.uniform(28, 45), random.uniform(0, 8));
    const Oracle oracle(grid, options);
    const RouteGround ground(grid, options, 2);
    for (int row = 0; row < 11; ++row)
      for (int column = 0; column < 14; ++column)
        ASSERT_EQ(ground.is_passable({column, row}), oracle.passable(column, row)) << column << "," << row;
    const glm::ivec2 from(random.integer(0, 6), random.integer(0, 10));
    if (!ground.is_passable(from)) continue;
    const std::vector<double> costs = oracle.costs_from(from);
    const auto reachable = static_cast<std::size_t>(
        std::count_if(costs.begin(), costs.end(), [](double cost) { return std::isfinite(cost); }));
    for (int row = 0; row < 11; ++row)
      for (int column = 0; column < 14; ++column) {
        const glm::ivec2 to(column, row);
        if (!ground.is_passable(to)) continue;
        const SearchResult result = search_route(ground, from, to, nullptr);
        const double best = costs[oracle.at(column, row)];
        ASSERT_EQ(result.posts.empty(), !std::isfinite(best));
        if (result.posts.empty()) {
          EXPECT_EQ(result.reached, reachable);
          ++apart;
          continue;
        }
        ++found;
        EXPECT_NEAR(result.cost_m, best, 1e-12 * (1 + best));
        EXPECT_LE(ground.least_cost_m(from, to), best * (1 + 1e-12));
        EXPECT_EQ(result.posts.front(), from);
        EXPECT_EQ(result.posts.back(), to);
      }
  }
  EXPECT_GT(found, 1000);
  EXPECT_GT(apart, 100);
}

TEST(Route, StraighteningNeverCostsMore) {
  for (std::uint64_t seed = 200; seed < 212; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test_support::Random random(seed);
    const double phase = random.uniform(0, 6);
    HeightGrid grid = ground_of(60, 50, [&](int c, int r) {
      return 4 * std::sin(0.21 * c + phase) * std::cos(0.17 * r) + 0.8 * std::sin(0.9 * c - 0.7 * r);
    });
    for (int n = 0; n < 30; ++n)
      grid.heights_m[static_cast<std::size_t>(random.integer(0, 60 * 50 - 1))] = std::nanf("");
    const RouteOptions options = limit(random.uniform(30, 55), random.uniform(0, 6));
    const RouteGround ground(grid, options, 1);
    const glm::ivec2 from(3, 4);
    const glm::ivec2 to(56, 45);
    if (!ground.is_passable(from) || !ground.is_passable(to)) continue;
    const SearchResult steps = search_route(ground, from, to, nullptr);
    if (steps.posts.empty()) continue;
    const Route route = way(grid, {from, to}, options);
    EXPECT_LE(route.figures.cost_m, steps.cost_m * (1 + 1e-11));
    EXPECT_LE(route.posts.size(), steps.posts.size());
    expect_within_limits(grid, route, options);
  }
}

TEST(Route, CostsTheSameBothWays) {
  for (std::uint64_t seed = 300; seed < 306; ++seed) {
    const HeightGrid grid = random_ground(30, 30, seed, 1);
    const RouteOptions options = limit(50, 5);
    const RouteGround ground(grid, options, 1);
    test_support::Random random(seed);
    for (int n = 0; n < 30; ++n) {
      const glm::ivec2 a(random.integer(0, 29), random.integer(0, 14));
      const glm::ivec2 b(random.integer(0, 29), random.integer(15, 29));
      const auto there = ground.straight(a, b);
      const auto back = ground.straight(b, a);
      ASSERT_EQ(there.has_value(), back.has_value());
      if (there) {
        EXPECT_NEAR(there->cost_m, back->cost_m, 1e-12 * there->cost_m);
        EXPECT_NEAR(there->climb_m, back->descent_m, 1e-9);
      }
      if (!ground.is_passable(a) || !ground.is_passable(b)) continue;
      EXPECT_NEAR(search_route(ground, a, b, nullptr).cost_m, search_route(ground, b, a, nullptr).cost_m, 1e-9);
    }
  }
}

TEST(Route, StraightWaysFollowTheGround) {
  // On a plane the figures of any straight way are known.
  const HeightGrid plane = ground_of(
      40, 40, [](int column, int row) { return 0.125 * column - 0.0625 * row; }, 2);
  const RouteGround ground(plane, limit(30, 2), 1);
  test_support::Random random(5);
  for (int n = 0; n < 200; ++n) {
    const glm::ivec2 a(random.integer(0, 39), random.integer(0, 39));
    const glm::ivec2 b(random.integer(0, 39), random.integer(0, 39));
    const auto figures = ground.straight(a, b);
    ASSERT_TRUE(figures);
    const glm::dvec2 step = glm::dvec2(b - a) * 2.0;
    const double rise_m = 0.0625 * step.x - 0.03125 * step.y;
    const double run_m = std::hypot(step.x, step.y);
    EXPECT_NEAR(figures->map_length_m, run_m, 1e-9);
    EXPECT_NEAR(figures->length_m, std::hypot(run_m, rise_m), 1e-9);
    EXPECT_NEAR(figures->climb_m - figures->descent_m, rise_m, 1e-9);
    if (run_m > 0) {
      EXPECT_NEAR(figures->steepest_deg, std::atan(std::abs(rise_m) / run_m) * 180 / std::numbers::pi, 1e-6);
    }
  }
}

TEST(Route, LimitsSlopesAcross) {
  // Ground that rises 0.2 a metre northwards: a way east has it across.
  const HeightGrid plane = ground_of(60, 60, [](int, int row) { return -0.2 * row; });
  RouteOptions options = limit(20, 0);
  EXPECT_EQ(way(plane, {{5, 30}, {55, 30}}, options).posts.size(), 2U);
  options.max_cross_slope_deg = 5.5;
  EXPECT_FALSE(RouteGround(plane, options, 1).straight({5, 30}, {55, 30}));
  EXPECT_FALSE(RouteGround(plane, options, 1).straight({5, 30}, {55, 40}));
  EXPECT_TRUE(RouteGround(plane, options, 1).straight({5, 30}, {5, 50}));
  // Across at an angle a to the fall it is 0.2 sin a.
  EXPECT_TRUE(RouteGround(plane, options, 1).straight({5, 20}, {15, 40}));   // 5.1 degrees
  EXPECT_FALSE(RouteGround(plane, options, 1).straight({5, 20}, {17, 40}));  // 5.9 degrees
  const Route zigzag = way(plane, {{5, 30}, {25, 30}}, options);
  EXPECT_EQ(zigzag.outcome, RouteOutcome::found);
  EXPECT_GT(zigzag.figures.map_length_m, 40);
}

TEST(Route, PassesGivenPostsInOrder) {
  const HeightGrid level = ground_of(50, 50, [](int, int) { return 0; });
  const Route route = way(level, {{5, 5}, {40, 8}, {10, 45}, {10, 45}, {45, 45}}, limit(10));
  EXPECT_EQ(route.posts, (Posts{{5, 5}, {40, 8}, {10, 45}, {45, 45}}));
  EXPECT_NEAR(route.figures.length_m, std::hypot(35, 3) + std::hypot(30, 37) + 35, 1e-9);
  EXPECT_EQ(way(level, {{5, 5}, {5, 5}}, limit(10)).posts, (Posts{{5, 5}}));
}

TEST(Route, TellsWhyThereIsNone) {
  const HeightGrid grid = ground_of(40, 40, [](int column, int row) {
    if (column == 20) return kNoHeight;
    return column == 5 && row == 5 ? 9.0 : 0.0;
  });
  const RouteOptions options = limit(10);
  const Route steep = way(grid, {{5, 5}, {10, 10}}, options);
  EXPECT_EQ(steep.outcome, RouteOutcome::too_steep);
  EXPECT_EQ(steep.at, 0U);
  EXPECT_NEAR(steep.steepest_ground_deg, std::atan(std::hypot(9, 9)) * 180 / std::numbers::pi, 1e-6);
  EXPECT_EQ(way(grid, {{10, 10}, {5, 6}}, options).outcome, RouteOutcome::too_steep);
  EXPECT_EQ(way(grid, {{10, 10}, {5, 6}}, options).at, 1U);
  EXPECT_EQ(way(grid, {{10, 10}, {12, 12}, {20, 6}}, options).outcome, RouteOutcome::no_ground);
  EXPECT_EQ(way(grid, {{10, 10}, {12, 12}, {20, 6}}, options).at, 2U);
  const Route apart = way(grid, {{10, 10}, {12, 12}, {30, 6}}, options);
  EXPECT_EQ(apart.outcome, RouteOutcome::not_connected);
  EXPECT_EQ(apart.at, 1U);
  EXPECT_EQ(apart.reached_m2, 20.0 * 40 - 5);
}

TEST(Route, ThreadsAndRepetitionDoNotShow) {
  const HeightGrid grid = random_ground(120, 120, 400, 0.8);
  const Posts places{{3, 3}, {110, 60}, {20, 115}};
  const Route one = find_route(grid, places, limit(60), 1);
  ASSERT_EQ(one.outcome, RouteOutcome::found);
  for (const int threads : {1, 2, 5}) {
    const Route other = find_route(grid, places, limit(60), threads);
    EXPECT_EQ(one.posts, other.posts);
    EXPECT_EQ(one.figures.cost_m, other.figures.cost_m);
  }
}

TEST(Route, CanBeStopped) {
  const HeightGrid level = ground_of(200, 200, [](int, int) { return 0; });
  struct Stop {};
  const auto stop = [] { throw Stop(); };
  EXPECT_THROW(find_route(level, Posts{{0, 0}, {199, 150}}, limit(10), 1, stop), Stop);
}

TEST(Route, RefusesBadInput) {
  const HeightGrid level = ground_of(9, 9, [](int, int) { return 0; });
  const Posts places{{1, 1}, {7, 7}};
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double slope_deg : {0.0, -1.0, 90.0, kNoHeight, infinite}) {
    EXPECT_THROW(way(level, places, limit(slope_deg)), std::invalid_argument);
    RouteOptions options;
    options.max_cross_slope_deg = slope_deg;
    EXPECT_THROW(way(level, places, options), std::invalid_argument);
  }
  for (const double weight : {-1.0, 1001.0, kNoHeight, infinite})
    EXPECT_THROW(way(level, places, limit(10, weight)), std::invalid_argument);
  EXPECT_THROW(way(level, {{1, 1}}, limit(10)), std::invalid_argument);
  EXPECT_THROW(way(level, {}, limit(10)), std::invalid_argument);
  for (const glm::ivec2 outside : {glm::ivec2(-1, 0), glm::ivec2(9, 0), glm::ivec2(0, 9), glm::ivec2(0, -1)})
    EXPECT_THROW(way(level, {{1, 1}, outside}, limit(10)), std::invalid_argument);
  HeightGrid wrong = level;
  wrong.heights_m.pop_back();
  EXPECT_THROW(way(wrong, places, limit(10)), std::invalid_argument);
  wrong = level;
  wrong.spacing_m = 0;
  EXPECT_THROW(way(wrong, places, limit(10)), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::map
