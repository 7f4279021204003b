// Contours against closed forms, their own defining properties and bad input.
#include "vpe/map/contour/contour.h"

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
#include "vpe/map/contour/conflicts.h"
#include "vpe/map/contour/edges.h"
#include "vpe/map/contour/simplify.h"

namespace vpe::map {
namespace {

using HeightFunction = std::function<double(int column, int row)>;
using ContourLines = std::vector<ContourLine>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

HeightGrid grid_of(int columns, int rows, const HeightFunction& height_m, double spacing_m = 1) {
  HeightGrid grid{columns, rows, spacing_m, {}};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      grid.heights_m.push_back(static_cast<float>(height_m(column, row)));
  return grid;
}

// Sums waves of random directions and lengths: ground with summits, basins and saddles.
HeightGrid hills(int columns, int rows, std::uint64_t seed, int waves = 12) {
  test_support::Random random(seed);
  struct Wave {
    double x, y, phase, height_m;
  };
  std::vector<Wave> sum;
  for (int n = 0; n < waves; ++n) {
    const double length = random.log_uniform(4, 60);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double phase = random.uniform(0, 2 * std::numbers::pi);
    sum.push_back({std::cos(angle) / length, std::sin(angle) / length, phase, length});
  }
  return grid_of(columns, rows, [&](int column, int row) {
    double height_m = 0;
    for (const Wave& w : sum)
      height_m += w.height_m * std::sin(w.x * 6.28 * column + w.y * 6.28 * row + w.phase);
    return height_m;
  });
}

HeightGrid noise(int columns, int rows, std::uint64_t seed, int steps) {
  test_support::Random random(seed);
  return grid_of(columns, rows, [&](int, int) { return random.integer(0, steps); });
}

ContourOptions every(double interval_m, double base_m = 0, double tolerance_m = 0) {
  ContourOptions options;
  options.interval_m = interval_m;
  options.base_m = base_m;
  options.tolerance_m = tolerance_m;
  return options;
}

double bilinear_m(const HeightGrid& grid, glm::dvec2 place) {
  const int column = std::min(static_cast<int>(place.x), grid.columns - 2);
  const int row = std::min(static_cast<int>(place.y), grid.rows - 2);
  const double x = place.x - column;
  const double y = place.y - row;
  const auto mix = [](double a, double b, double t) { return t == 0 ? a : t == 1 ? b : a + (b - a) * t; };
  return mix(mix(grid.at(column, row), grid.at(column + 1, row), x),
             mix(grid.at(column, row + 1), grid.at(column + 1, row + 1), x), y);
}

// Returns whether a place on an edge lies at the border or beside a cell that has a post without a height.
bool is_at_an_end_of_ground(const HeightGrid& grid, glm::dvec2 place) {
  for (int row = static_cast<int>(std::ceil(place.y)) - 1; row <= std::floor(place.y); ++row)
    for (int column = static_cast<int>(std::ceil(place.x)) - 1; column <= std::floor(place.x); ++column) {
      if (row < 0 || column < 0 || row + 1 >= grid.rows || column + 1 >= grid.columns) return true;
      for (const int at : {0, 1, 2, 3})
        if (!std::isfinite(grid.at(column + at % 2, row + at / 2))) return true;
    }
  return false;
}

glm::dvec2 next_point(const ContourLine& line, std::size_t n) {
  return line.points[(n + 1) % line.points.size()];
}

std::size_t edges_of(const ContourLine& line) { return line.points.size() - (line.is_closed ? 0 : 1); }

// Checks what holds for lines of any grid before simplification.
void expect_valid(const HeightGrid& grid, const ContourLines& lines, const ContourOptions& options) {
  std::int64_t before = std::numeric_limits<std::int64_t>::min();
  for (const ContourLine& line : lines) {
    EXPECT_GE(line.multiple, before);
    before = line.multiple;
    EXPECT_EQ(line.level_m, options.base_m + static_cast<double>(line.multiple) * options.interval_m);
    ASSERT_GE(line.points.size(), 2U);
    for (const glm::dvec2& point : line.points) {
      EXPECT_TRUE(point.x == std::floor(point.x) || point.y == std::floor(point.y));
      EXPECT_NEAR(bilinear_m(grid, point), line.level_m, 1e-6 * std::max(1.0, std::abs(line.level_m)));
    }
    if (!line.is_closed) {
      EXPECT_TRUE(is_at_an_end_of_ground(grid, line.points.front()));
      EXPECT_TRUE(is_at_an_end_of_ground(grid, line.points.back()));
    }
    for (std::size_t n = 0; n < edges_of(line); ++n) {
      const glm::dvec2 step = next_point(line, n) - line.points[n];
      EXPECT_LE(std::max(std::abs(step.x), std::abs(step.y)), 1 + 1e-12);
      EXPECT_GT(std::hypot(step.x, step.y), 0);
    }
  }
}

// Finds a crossing by trying all pairs in a wider type than the product's, or returns "".
std::string find_crossing(const ContourLines& lines) {
  struct Edge {
    glm::dvec2 a, b;
  };
  std::vector<Edge> edges;
  for (const ContourLine& line : lines)
    for (std::size_t n = 0; n < edges_of(line); ++n) edges.push_back({line.points[n], next_point(line, n)});
  const auto side = [](glm::dvec2 a, glm::dvec2 b, glm::dvec2 p) {
    using Wide = __float128;
    const Wide value =
        (Wide(a.x) - Wide(p.x)) * (Wide(b.y) - Wide(p.y)) - (Wide(a.y) - Wide(p.y)) * (Wide(b.x) - Wide(p.x));
    return value > 0 ? 1 : value < 0 ? -1 : 0;
  };
  const auto left = [](const Edge& e) { return std::min(e.a.x, e.b.x); };
  std::sort(edges.begin(), edges.end(), [&](const Edge& e, const Edge& f) { return left(e) < left(f); });
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      const Edge& e = edges[i];
      const Edge& f = edges[j];
      if (std::max(e.a.x, e.b.x) < left(f)) break;
      if (std::max(e.a.y, e.b.y) < std::min(f.a.y, f.b.y) || std::max(f.a.y, f.b.y) < std::min(e.a.y, e.b.y))
        continue;
      if (side(e.a, e.b, f.a) * side(e.a, e.b, f.b) < 0 && side(f.a, f.b, e.a) * side(f.a, f.b, e.b) < 0)
        return "at " + std::to_string(e.a.x) + "," + std::to_string(e.a.y);
    }
  return "";
}

double distance_to(const ContourLine& line, glm::dvec2 point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < edges_of(line); ++n) {
    const glm::dvec2 a = line.points[n];
    const glm::dvec2 along = next_point(line, n) - a;
    const double length2 = along.x * along.x + along.y * along.y;
    const double share =
        std::clamp(((point.x - a.x) * along.x + (point.y - a.y) * along.y) / length2, 0.0, 1.0);
    least = std::min(least, std::hypot(point.x - a.x - share * along.x, point.y - a.y - share * along.y));
  }
  return least;
}

// Returns the largest distance of points of one line, a few on each edge, from the other line.
double farthest_from(const ContourLine& line, const ContourLine& other) {
  double most = 0;
  for (std::size_t n = 0; n < edges_of(line); ++n)
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
      most =
          std::max(most, distance_to(other, line.points[n] + share * (next_point(line, n) - line.points[n])));
  return most;
}

bool same_lines(const ContourLines& a, const ContourLines& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const ContourLine& x, const ContourLine& y) {
    return x.multiple == y.multiple && x.level_m == y.level_m && x.is_closed == y.is_closed &&
           x.points == y.points;
  });
}

TEST(Contour, OfAPlaneAreStraight) {
  const HeightGrid grid = grid_of(40, 30, [](int column, int row) { return 2 * column + row + 0.5; });
  const ContourLines lines = contours(grid, every(10), 1);
  EXPECT_EQ(lines.size(), 10U);  // 10 to 100 of 0.5 to 107.5
  for (const ContourLine& line : lines) {
    EXPECT_FALSE(line.is_closed);
    for (const glm::dvec2& point : line.points) EXPECT_NEAR(2 * point.x + point.y + 0.5, line.level_m, 1e-9);
    const glm::dvec2 whole = line.points.back() - line.points.front();
    EXPECT_NEAR(length_posts(line), std::hypot(whole.x, whole.y), 1e-9);
    // Higher ground is in the east, on the right of who goes north.
    EXPECT_LT(whole.y, 0);
  }
  ContourLines simplified = contours(grid, every(10, 0, 1e-6), 1);
  ASSERT_EQ(simplified.size(), 10U);
  for (const ContourLine& line : simplified) EXPECT_EQ(line.points.size(), 2U);
}

TEST(Contour, OfAConeAreCircles) {
  constexpr double kMiddle = 50.25;
  const auto height_m = [](int column, int row) { return -std::hypot(column - kMiddle, row - kMiddle); };
  const ContourLines lines = contours(grid_of(101, 101, height_m), every(10), 1);
  ASSERT_EQ(lines.front().level_m, -70);
  int rings = 0;
  for (const ContourLine& line : lines) {
    if (line.level_m < -45) continue;
    ++rings;
    EXPECT_TRUE(line.is_closed);
    double area = 0;
    for (std::size_t n = 0; n < line.points.size(); ++n) {
      const glm::dvec2 a = line.points[n];
      const glm::dvec2 b = next_point(line, n);
      EXPECT_NEAR(std::hypot(a.x - kMiddle, a.y - kMiddle), -line.level_m, 0.03);
      area += (a.x * b.y - b.x * a.y) / 2;
    }
    // Rows grow southwards: a ring that runs clockwise on the map has a positive area.
    EXPECT_NEAR(area, std::numbers::pi * line.level_m * line.level_m, 0.01 * line.level_m * line.level_m);
    EXPECT_NEAR(length_posts(line), -2 * std::numbers::pi * line.level_m, 0.01 * -line.level_m);
  }
  EXPECT_EQ(rings, 4);  // of radii 10, 20, 30, 40
}

TEST(Contour, TheMiddleDecidesASaddle) {
  // High posts in the north-west and the south-east.
  const auto saddle = [](double low_m) {
    return grid_of(2, 2, [&](int column, int row) { return column == row ? 1 : low_m; });
  };
  const ContourLines apart = contours(saddle(-2), every(10), 1);  // mean below 0: high posts are apart
  ASSERT_EQ(apart.size(), 2U);
  EXPECT_EQ(apart[0].points.front().y, 0);
  EXPECT_EQ(apart[0].points.back().x, 0);
  const ContourLines together = contours(saddle(-0.5), every(10), 1);
  ASSERT_EQ(together.size(), 2U);
  EXPECT_EQ(together[0].points.front().y, 0);
  EXPECT_EQ(together[0].points.back().x, 1);
  // A mean at the level counts as above.
  EXPECT_TRUE(same_lines(contours(saddle(-1), every(10), 1), contours(saddle(-1), every(10), 2)));
  EXPECT_EQ(contours(saddle(-1), every(10), 1)[0].points.back().x, 1);
}

TEST(Contour, PostsAtALevelCountAsAbove) {
  EXPECT_TRUE(contours(grid_of(6, 6, [](int, int) { return 100; }), every(100), 1).empty());
  // A single post at the level has no line, a plateau has one along its last posts.
  const auto square = [](int from, int to) {
    return grid_of(8, 8, [=](int c, int r) { return c >= from && c <= to && r >= from && r <= to ? 100 : 90; });
  };
  EXPECT_TRUE(contours(square(3, 3), every(100), 1).empty());
  const ContourLines plateau = contours(square(2, 5), every(100), 1);
  ASSERT_EQ(plateau.size(), 1U);
  EXPECT_TRUE(plateau[0].is_closed);
  EXPECT_EQ(plateau[0].points.size(), 12U);
  EXPECT_EQ(length_posts(plateau[0]), 12);
  // The bottom of a basin at the level has none.
  const HeightGrid basin =
      grid_of(8, 8, [](int c, int r) { return c >= 2 && c <= 5 && r >= 2 && r <= 5 ? 100 : 110; });
  EXPECT_TRUE(contours(basin, every(100), 1).empty());
  // A ridge of one post's width has a line there and back.
  const HeightGrid ridge = grid_of(8, 8, [](int c, int r) { return r == 4 && c >= 2 && c <= 5 ? 100 : 90; });
  const ContourLines back = contours(ridge, every(100), 1);
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(length_posts(back[0]), 6);
}

TEST(Contour, LevelsCountFromTheBase) {
  const HeightGrid grid = grid_of(50, 2, [](int column, int) { return column - 20; });
  std::set<double> levels;
  for (const ContourLine& line : contours(grid, every(7, 3), 1)) levels.insert(line.level_m);
  EXPECT_EQ(levels, (std::set<double>{-18, -11, -4, 3, 10, 17, 24}));
  const ContourLines far_base = contours(grid, every(7, 7003), 1);
  ASSERT_EQ(far_base.size(), 7U);
  EXPECT_EQ(far_base.front().multiple, -1003);
}

TEST(Contour, HoldOnHills) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const HeightGrid grid = hills(90, 70, seed);
    const ContourOptions options = every(7.25, 1.5);
    const ContourLines lines = contours(grid, options, 2);
    EXPECT_GT(lines.size(), 20U);
    expect_valid(grid, lines, options);
    EXPECT_EQ(find_crossing(lines), "");
  }
}

TEST(Contour, HoldOnNoiseAtLevels) {
  for (const std::uint64_t seed : {4U, 5U, 6U}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    HeightGrid grid = noise(40, 40, seed, 6);
    for (const int hole : {85, 433, 434, 474, 1599})
      grid.heights_m[static_cast<std::size_t>(hole)] = std::nanf("");
    const ContourOptions options = every(1, 0);
    const ContourLines lines = contours(grid, options, 2);
    expect_valid(grid, lines, options);
    EXPECT_EQ(find_crossing(lines), "");
  }
}

TEST(Contour, EveryCrossedEdgeHasOneLine) {
  const HeightGrid grid = hills(60, 60, 7);
  const ContourLines lines = contours(grid, every(5, 0.3), 1);
  std::size_t crossings = 0;
  const auto count = [&](double a, double b) {
    for (int k = -200; k <= 200; ++k) crossings += (a >= 0.3 + 5 * k) != (b >= 0.3 + 5 * k) ? 1 : 0;
  };
  for (int row = 0; row < 60; ++row)
    for (int column = 0; column < 60; ++column) {
      if (column < 59) count(grid.at(column, row), grid.at(column + 1, row));
      if (row < 59) count(grid.at(column, row), grid.at(column, row + 1));
    }
  std::size_t points = 0;
  for (const ContourLine& line : lines) points += line.points.size();
  EXPECT_EQ(points, crossings);
}

TEST(Contour, HigherGroundIsOnTheRight) {
  const HeightGrid grid = hills(50, 50, 8);
  int looked_at = 0;
  for (const ContourLine& line : contours(grid, every(6, 0.1), 1))
    for (std::size_t n = 0; n < edges_of(line); ++n) {
      const glm::dvec2 step = next_point(line, n) - line.points[n];
      const glm::dvec2 middle = (line.points[n] + next_point(line, n)) * 0.5;
      // Close to short steps the ground may turn.
      if (std::hypot(step.x, step.y) < 0.3) continue;
      const glm::dvec2 right = glm::dvec2(-step.y, step.x) * 0.05;
      EXPECT_GT(bilinear_m(grid, middle + right), bilinear_m(grid, middle - right));
      ++looked_at;
    }
  EXPECT_GT(looked_at, 500);
}

TEST(Contour, StripsDoNotShow) {
  const HeightGrid grid = hills(64, 64, 9);
  const LevelScale scale{0.5, 4};
  const std::vector<EdgeChain> whole = join_chains(chains_of_rows(grid, scale, 0, 63));
  for (const int rows : {1, 2, 5, 20}) {
    std::vector<EdgeChain> parts;
    for (int begin = 0; begin < 63; begin += rows)
      for (EdgeChain& chain : chains_of_rows(grid, scale, begin, std::min(begin + rows, 63)))
        parts.push_back(std::move(chain));
    const std::vector<EdgeChain> joined = join_chains(std::move(parts));
    ASSERT_EQ(joined.size(), whole.size());
    for (std::size_t n = 0; n < whole.size(); ++n) {
      EXPECT_EQ(joined[n].multiple, whole[n].multiple);
      EXPECT_EQ(joined[n].is_closed, whole[n].is_closed);
      EXPECT_EQ(joined[n].edges, whole[n].edges);
    }
  }
}

TEST(Contour, ThreadsDoNotShow) {
  const HeightGrid grid = hills(700, 900, 10);  // several strips
  for (const double tolerance_m : {0.0, 0.7}) {
    const ContourLines one = contours(grid, every(20, 0, tolerance_m), 1);
    EXPECT_TRUE(same_lines(one, contours(grid, every(20, 0, tolerance_m), 2)));
    EXPECT_TRUE(same_lines(one, contours(grid, every(20, 0, tolerance_m), 7)));
  }
}

TEST(Contour, FirstAboveIsExact) {
  test_support::Random random(11);
  for (int n = 0; n < 20000; ++n) {
    const double base_m = random.uniform(-1e4, 1e4);
    const LevelScale scale{base_m, random.log_uniform(1e-3, 1e4)};
    const double any_m = random.uniform(-3e4, 3e4);
    const double height_m =
        n % 2 == 0 ? any_m : scale.level_m(static_cast<std::int64_t>(std::floor(any_m / scale.interval_m)));
    const std::int64_t multiple = scale.first_above(height_m);
    EXPECT_GT(scale.level_m(multiple), height_m);
    EXPECT_LE(scale.level_m(multiple - 1), height_m);
  }
}

TEST(Contour, NodataAndInfiniteHeightsEndLines) {
  for (const double hole :
       {kNan, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    const HeightGrid grid = grid_of(30, 30, [&](int column, int row) {
      return column >= 10 && column <= 14 && row >= 10 && row <= 14 ? hole : row + 0.25;
    });
    const ContourOptions options = every(4);
    const ContourLines lines = contours(grid, options, 1);
    EXPECT_EQ(lines.size(), 8U);  // 4, 8, ... 28, of which 12 is cut
    expect_valid(grid, lines, options);
    for (const ContourLine& line : lines)
      for (const glm::dvec2& p : line.points) EXPECT_FALSE(p.x > 9 && p.x < 15 && p.y > 9 && p.y < 15);
  }
  EXPECT_TRUE(contours(grid_of(5, 5, [](int, int) { return kNan; }), every(1), 1).empty());
}

TEST(Contour, ThinGridsHaveNone) {
  const auto slope = [](int column, int row) { return 10 * column + 10 * row; };
  for (const auto& [columns, rows] : {std::pair{1, 9}, {9, 1}, {1, 1}, {0, 0}, {0, 5}, {5, 0}})
    EXPECT_TRUE(contours(grid_of(columns, rows, slope), every(7), 1).empty());
  EXPECT_FALSE(contours(grid_of(2, 9, slope), every(7), 1).empty());
}

TEST(Contour, RefusesBadInput) {
  const HeightGrid grid = grid_of(5, 5, [](int column, int) { return column; });
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double interval_m : {0.0, -1.0, kNan, infinite, 1e-9, 1e-300})
    EXPECT_THROW(contours(grid, every(interval_m), 1), std::invalid_argument) << interval_m;
  EXPECT_THROW(contours(grid, every(1, kNan), 1), std::invalid_argument);
  EXPECT_THROW(contours(grid, every(1, infinite), 1), std::invalid_argument);
  EXPECT_THROW(contours(grid, every(1, 1e30), 1), std::invalid_argument);
  for (const double tolerance_m : {-1.0, kNan, infinite})
    EXPECT_THROW(contours(grid, every(1, 0, tolerance_m), 1), std::invalid_argument);
  HeightGrid wrong = grid;
  wrong.heights_m.pop_back();
  EXPECT_THROW(contours(wrong, every(1), 1), std::invalid_argument);
  wrong = grid;
  wrong.columns = -5;
  wrong.rows = -5;
  EXPECT_THROW(contours(wrong, every(1), 1), std::invalid_argument);
  for (const double spacing_m : {0.0, -1.0, kNan, infinite}) {
    wrong = grid;
    wrong.spacing_m = spacing_m;
    EXPECT_THROW(contours(wrong, every(1), 1), std::invalid_argument);
  }
  ContourOptions few = every(0.25);
  few.most_points = 10;
  EXPECT_THROW(contours(grid, few, 1), std::length_error);
  ContourLines none;
  EXPECT_THROW(simplify_contours(none, -1, 1), std::invalid_argument);
  EXPECT_THROW(simplify_contours(none, kNan, 1), std::invalid_argument);
  simplify_contours(none, 1, 1);
}

TEST(ContourSimplify, StaysWithinTheToleranceAndApart) {
  for (const std::uint64_t seed : {21U, 22U, 23U, 24U}) {
    for (const double tolerance_m : {0.1, 0.6, 2.5, 20.0}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " tolerance " + std::to_string(tolerance_m));
      HeightGrid grid = seed == 24 ? noise(36, 36, seed, 5) : hills(70, 60, seed);
      grid.spacing_m = 2;
      const double interval_m = seed == 24 ? 1 : 8;
      const ContourLines given = contours(grid, every(interval_m), 1);
      const ContourLines simplified = contours(grid, every(interval_m, 0, tolerance_m), 1);
      ASSERT_EQ(simplified.size(), given.size());
      std::size_t points = 0;
      std::size_t left = 0;
      for (std::size_t n = 0; n < given.size(); ++n) {
        EXPECT_EQ(simplified[n].level_m, given[n].level_m);
        EXPECT_EQ(simplified[n].is_closed, given[n].is_closed);
        EXPECT_EQ(simplified[n].points.front(), given[n].points.front());
        if (!given[n].is_closed) {
          EXPECT_EQ(simplified[n].points.back(), given[n].points.back());
        }
        if (given[n].is_closed && given[n].points.size() > 2) {
          EXPECT_GE(simplified[n].points.size(), 3U);
        }
        EXPECT_LE(farthest_from(given[n], simplified[n]), tolerance_m / 2 * (1 + 1e-9));
        EXPECT_LE(farthest_from(simplified[n], given[n]), tolerance_m / 2 * (1 + 1e-9));
        points += given[n].points.size();
        left += simplified[n].points.size();
      }
      EXPECT_EQ(find_crossing(simplified), "");
      if (seed != 24 && tolerance_m > 0.5) {
        EXPECT_LT(left, points / 2);
      }
    }
  }
}

TEST(ContourSimplify, LinesTooCloseAreKeptApart) {
  // Two parallel zigzags that a plain simplification would make cross the straight line between them.
  ContourLines lines(3);
  for (int n = 0; n <= 40; ++n) {
    const double swing = n % 2 == 0 ? 0.0 : 2.0;
    lines[0].points.emplace_back(n, 10 + swing);
    lines[1].points.emplace_back(n, 10.5 + swing);
    lines[2].points.emplace_back(n, 11 + swing);
  }
  lines[1].points.front().y = 10.1;
  const ContourLines given = lines;
  simplify_contours(lines, 3, 1);
  EXPECT_EQ(find_crossing(lines), "");
  for (std::size_t n = 0; n < 3; ++n) EXPECT_LE(farthest_from(given[n], lines[n]), 3 + 1e-9);
}

TEST(ContourSimplify, MayMeetIsRightForExactCases) {
  const auto meet = [](glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d) {
    const bool there = may_meet({a, b}, {c, d});
    EXPECT_EQ(there, may_meet({d, c}, {a, b}));
    return there;
  };
  EXPECT_TRUE(meet({0, 0}, {2, 2}, {0, 2}, {2, 0}));
  EXPECT_FALSE(meet({0, 0}, {1, 1}, {0, 2}, {2, 1.5}));
  EXPECT_FALSE(meet({0, 0}, {2, 2}, {2, 2}, {3, 0}));  // an end of both
  EXPECT_TRUE(meet({0, 0}, {2, 2}, {2, 2}, {1, 1}));   // back on itself
  EXPECT_TRUE(meet({0, 0}, {2, 2}, {1, 1}, {3, 0}));   // an end on the other
  EXPECT_TRUE(meet({0, 0}, {2, 2}, {2, 2}, {0, 0}));   // the same
  EXPECT_FALSE(meet({0, 0}, {2, 2}, {3, 3}, {4, 4}));  // in line, apart
  EXPECT_TRUE(meet({0, 0}, {2, 2}, {1, 1}, {4, 4}));   // in line, over each other
  EXPECT_FALSE(meet({0, 0}, {2, 2}, {2, 2}, {4, 4}));  // in line, one after the other
}

}  // namespace
}  // namespace vpe::map
