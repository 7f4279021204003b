// Viewsheds in closed form, their symmetries, and hostile grids.
#include "vpe/map/viewshed/viewshed.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include "tests/map/viewshed_lines.h"
#include "tests/support/support.h"

namespace vpe::map {
namespace {

constexpr double kMars_m = 3389500;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

Viewshed seen_by_two(const HeightGrid& grid, const ViewshedOptions& options) {
  base::ThreadPool pool(2);
  return viewshed(grid, options, pool);
}

HeightGrid needed_by_two(const HeightGrid& grid, const ViewshedOptions& options) {
  base::ThreadPool pool(2);
  return needed_heights(grid, options, pool);
}

Sight sight_at(const Viewshed& shed, int column, int row) {
  return shed.sights[static_cast<std::size_t>(row) * static_cast<std::size_t>(shed.columns) +
                     static_cast<std::size_t>(column)];
}

ViewshedOptions observer_at(int column, int row, double height_m = 2) {
  ViewshedOptions options;
  options.column = column;
  options.row = row;
  options.observer_height_m = height_m;
  return options;
}

std::int64_t count(const Viewshed& shed, Sight sight) { return std::ranges::count(shed.sights, sight); }

void each_post(const HeightGrid& grid, const std::function<void(int, int)>& call) {
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) call(column, row);
}

TEST(ViewshedForm, APlaneIsSeenWhole) {
  for (const double height_m : {0.0, 2.0}) {
    const Viewshed shed = seen_by_two(flat_grid(301, 200, 10, -4500), observer_at(17, 120, height_m));
    EXPECT_EQ(count(shed, Sight::seen), 301 * 200) << height_m;
  }
}

TEST(ViewshedForm, AWallHidesWhatIsUnderTheLineOverItsTop) {
  HeightGrid grid = flat_grid(401, 401, 5);
  for (int column = 0; column < 401; ++column) post(grid, column, 150) = 10;
  for (const double observer_m : {2.0, 40.0}) {
    const ViewshedOptions options = observer_at(200, 200, observer_m);
    const HeightGrid needed = needed_by_two(grid, options);
    const Viewshed shed = seen_by_two(grid, options);
    each_post(grid, [&](int column, int row) {
      // Lines of sight over the wall's top are those of a plane.
      const double line_m = observer_m + (10 - observer_m) * (200 - row) / 50;
      const double wanted_m = row >= 150 ? 0 : std::max(0.0, line_m);
      ASSERT_NEAR(double{needed.at(column, row)}, wanted_m, 1e-4) << column << " " << row;
      if (std::abs(line_m) > 1e-3) {
        ASSERT_EQ(sight_at(shed, column, row), wanted_m > 0 ? Sight::hidden : Sight::seen)
            << column << " " << row;
      }
    });
  }
}

TEST(ViewshedForm, ASphereEndsAtItsHorizon) {
  for (const double radius_m : {kMars_m, 11'100.0}) {
    for (const double observer_m : {2.0, 30.0}) {
      for (const double target_m : {0.0, 5.0}) {
        const auto horizon_m = [&](double height_m) {
          return radius_m * std::acos(radius_m / (radius_m + height_m));
        };
        const double most_m = horizon_m(observer_m) + horizon_m(target_m);
        HeightGrid grid = flat_grid(401, 401, most_m / 150);
        ViewshedOptions options = observer_at(200, 200, observer_m);
        options.radius_m = radius_m;
        options.target_height_m = target_m;
        const Viewshed shed = seen_by_two(grid, options);
        each_post(grid, [&](int column, int row) {
          const double distance_m = grid.spacing_m * std::hypot(column - 200, row - 200);
          if (std::abs(distance_m - most_m) < 1.5 * grid.spacing_m) return;
          ASSERT_EQ(sight_at(shed, column, row), distance_m < most_m ? Sight::seen : Sight::hidden)
              << radius_m << " " << observer_m << " " << target_m << " " << column << " " << row;
        });
      }
    }
  }
}

TEST(ViewshedForm, BeyondTheHorizonHeightsAreNeeded) {
  const double observer_m = 10;
  ViewshedOptions options = observer_at(200, 200, observer_m);
  options.radius_m = kMars_m;
  HeightGrid grid = flat_grid(401, 401, 250);
  const HeightGrid needed = needed_by_two(grid, options);
  const double horizon_rad = std::acos(kMars_m / (kMars_m + observer_m));
  each_post(grid, [&](int column, int row) {
    const double angle_rad = grid.spacing_m * std::hypot(column - 200, row - 200) / kMars_m;
    const double wanted_m =
        angle_rad <= horizon_rad ? 0 : kMars_m * (1 / std::cos(angle_rad - horizon_rad) - 1);
    // The horizon is that of posts, and ground between them is straight.
    ASSERT_NEAR(double{needed.at(column, row)}, wanted_m, 0.01 + 0.005 * wanted_m) << column << " " << row;
  });
}

TEST(ViewshedForm, BowlsAreSeenWholeAndDomesNot) {
  HeightGrid bowl = flat_grid(257, 257, 30);
  HeightGrid cone = bowl;
  HeightGrid dome = bowl;
  each_post(bowl, [&](int column, int row) {
    const double r = std::hypot(column - 128, row - 128);
    post(bowl, column, row) = static_cast<float>(0.3 * r * r);
    post(cone, column, row) = static_cast<float>(-20 * r);
    post(dome, column, row) = static_cast<float>(-0.3 * r * r);
  });
  const ViewshedOptions options = observer_at(128, 128, 1);
  EXPECT_EQ(count(seen_by_two(bowl, options), Sight::seen), 257 * 257);
  EXPECT_EQ(count(seen_by_two(cone, options), Sight::seen), 257 * 257);
  // Over z = -c r^2 the line from the height e touches the ground at sqrt(e / c).
  const Viewshed shed = seen_by_two(dome, observer_at(128, 128, 0.3 * 40 * 40));
  each_post(dome, [&](int column, int row) {
    const double r = std::hypot(column - 128, row - 128);
    if (std::abs(r - 40) > 1.5) {
      ASSERT_EQ(sight_at(shed, column, row), r < 40 ? Sight::seen : Sight::hidden) << column;
    }
  });
}

TEST(ViewshedForm, TargetsAreSeenFromTheirNeededHeightOn) {
  const HeightGrid grid = fractal_grid(129, 30, 60, 0.9, 2);
  ViewshedOptions options = observer_at(64, 64);
  options.radius_m = 100'000;
  const HeightGrid needed = needed_by_two(grid, options);
  const Viewshed ground = seen_by_two(grid, options);
  each_post(grid, [&](int column, int row) {
    ASSERT_EQ(needed.at(column, row) == 0, sight_at(ground, column, row) == Sight::seen)
        << column << " " << row;
  });
  std::int64_t agree = 0;
  std::int64_t posts = 0;
  for (const double target_m : {3.0, 20.0, 60.0}) {
    options.target_height_m = target_m;
    const Viewshed shed = seen_by_two(grid, options);
    each_post(grid, [&](int column, int row) {
      ++posts;
      agree +=
          (double{needed.at(column, row)} <= target_m) == (sight_at(shed, column, row) == Sight::seen) ? 1 : 0;
    });
  }
  EXPECT_GT(static_cast<double>(agree) / static_cast<double>(posts), 0.998);
}

TEST(ViewshedForm, FromSpaceAHemisphereIsSeen) {
  // A planet of 1 km, seen from 1e6 km: all within a quarter of its circumference but what is at its rim.
  ViewshedOptions options = observer_at(100, 100, 1e9);
  options.radius_m = 1000;
  const Viewshed shed = seen_by_two(flat_grid(201, 201, 20), options);
  EXPECT_EQ(sight_at(shed, 100 + 78, 100), Sight::seen);
  EXPECT_EQ(sight_at(shed, 100 + 79, 100), Sight::unknown);
  EXPECT_EQ(count(shed, Sight::hidden), 0);
}

// Small grids of few heights, so that lines meet posts exactly and ties happen.
HeightGrid any_grid() {
  HeightGrid grid = flat_grid(*rc::gen::inRange(1, 24), *rc::gen::inRange(1, 24), 7);
  for (float& height : grid.heights_m) {
    const int value = *rc::gen::inRange(-2, 9);
    height = value < -1 ? kNone : static_cast<float>(value) * 1.5F;
  }
  return grid;
}

ViewshedOptions any_options(const HeightGrid& grid) {
  ViewshedOptions options =
      observer_at(*rc::gen::inRange(0, grid.columns), *rc::gen::inRange(0, grid.rows), *rc::gen::inRange(0, 5));
  options.target_height_m = *rc::gen::inRange(0, 3);
  if (*rc::gen::arbitrary<bool>()) options.radius_m = 2000;
  return options;
}

RC_GTEST_PROP(ViewshedProperty, MirroredGroundIsSeenMirrored, ()) {
  const HeightGrid grid = any_grid();
  const ViewshedOptions options = any_options(grid);
  HeightGrid east = grid;
  HeightGrid south = grid;
  each_post(grid, [&](int column, int row) {
    post(east, grid.columns - 1 - column, row) = grid.at(column, row);
    post(south, column, grid.rows - 1 - row) = grid.at(column, row);
  });
  ViewshedOptions east_options = options;
  east_options.column = grid.columns - 1 - options.column;
  ViewshedOptions south_options = options;
  south_options.row = grid.rows - 1 - options.row;
  const Viewshed shed = seen_by_two(grid, options);
  const Viewshed east_shed = seen_by_two(east, east_options);
  const Viewshed south_shed = seen_by_two(south, south_options);
  each_post(grid, [&](int column, int row) {
    RC_ASSERT(sight_at(shed, column, row) == sight_at(east_shed, grid.columns - 1 - column, row));
    RC_ASSERT(sight_at(shed, column, row) == sight_at(south_shed, column, grid.rows - 1 - row));
  });
}

RC_GTEST_PROP(ViewshedProperty, ThreadsDoNotMatter, ()) {
  const HeightGrid grid = any_grid();
  const ViewshedOptions options = any_options(grid);
  base::ThreadPool one(1);
  base::ThreadPool five(5);
  RC_ASSERT(viewshed(grid, options, one).sights == viewshed(grid, options, five).sights);
}

RC_GTEST_PROP(ViewshedProperty, HigherTargetsAreSeenToo, ()) {
  const HeightGrid grid = any_grid();
  ViewshedOptions options = any_options(grid);
  const Viewshed low = seen_by_two(grid, options);
  options.target_height_m += *rc::gen::inRange(1, 20);
  const Viewshed high = seen_by_two(grid, options);
  for (std::size_t n = 0; n < low.sights.size(); ++n)
    RC_ASSERT(low.sights[n] != Sight::seen || high.sights[n] == Sight::seen);
}

RC_GTEST_PROP(ViewshedProperty, UnknownIsWhereGroundIs, ()) {
  const HeightGrid grid = any_grid();
  const ViewshedOptions options = any_options(grid);
  const Viewshed shed = seen_by_two(grid, options);
  const HeightGrid needed = needed_by_two(grid, options);
  const bool blind = std::isnan(grid.at(options.column, options.row));
  each_post(grid, [&](int column, int row) {
    const bool unknown = blind || std::isnan(grid.at(column, row));
    RC_ASSERT((sight_at(shed, column, row) == Sight::unknown) == unknown);
    RC_ASSERT(std::isnan(needed.at(column, row)) == unknown);
    if (!unknown) RC_ASSERT(needed.at(column, row) >= 0);
  });
}

TEST(Viewshed, ManyThreadsGiveTheSameBits) {
  const HeightGrid grid = fractal_grid(513, 30, 150, 0.9, 5);
  ViewshedOptions options = observer_at(200, 301);
  options.radius_m = kMars_m;
  base::ThreadPool one(1);
  const Viewshed shed = viewshed(grid, options, one);
  const HeightGrid needed = needed_heights(grid, options, one);
  for (const int threads : {2, 3, 8}) {
    base::ThreadPool pool(threads);
    EXPECT_EQ(viewshed(grid, options, pool).sights, shed.sights) << threads;
    EXPECT_EQ(needed_heights(grid, options, pool).heights_m, needed.heights_m) << threads;
  }
}

TEST(Viewshed, NodataHidesNothing) {
  HeightGrid grid = flat_grid(101, 101, 10);
  for (int column = 0; column < 101; ++column) post(grid, column, 30) = column < 50 ? kNone : 30.0F;
  post(grid, 50, 50) = 0;
  const Viewshed shed = seen_by_two(grid, observer_at(50, 50));
  EXPECT_EQ(sight_at(shed, 20, 30), Sight::unknown);
  EXPECT_EQ(sight_at(shed, 20, 10), Sight::seen);
  EXPECT_EQ(sight_at(shed, 80, 10), Sight::hidden);
  EXPECT_EQ(count(shed, Sight::unknown), 50);
  for (const float value : {kNone, INFINITY, -INFINITY, 3e38F, -3e38F, 2e9F}) {
    const Viewshed none = seen_by_two(flat_grid(9, 5, 10, value), observer_at(4, 2));
    EXPECT_EQ(count(none, Sight::unknown), 45) << value;
    HeightGrid one = flat_grid(9, 5, 10);
    post(one, 6, 2) = value;
    const Viewshed rest = seen_by_two(one, observer_at(4, 2));
    EXPECT_EQ(count(rest, Sight::unknown), 1) << value;
    EXPECT_EQ(count(rest, Sight::seen), 44) << value;
  }
}

TEST(Viewshed, SmallGrids) {
  EXPECT_EQ(seen_by_two(flat_grid(1, 1, 10), observer_at(0, 0)).sights, std::vector{Sight::seen});
  EXPECT_EQ(needed_by_two(flat_grid(1, 1, 10), observer_at(0, 0)).heights_m, std::vector{0.0F});
  HeightGrid line = flat_grid(6, 1, 10);
  line.heights_m = {0, 0, 5, 0, 9, 9};
  const std::vector wanted{Sight::seen, Sight::seen, Sight::seen, Sight::hidden, Sight::seen, Sight::hidden};
  EXPECT_EQ(seen_by_two(line, observer_at(0, 0)).sights, wanted);
  std::swap(line.columns, line.rows);
  EXPECT_EQ(seen_by_two(line, observer_at(0, 0)).sights, wanted);
}

TEST(Viewshed, HugeHeights) {
  HeightGrid grid = flat_grid(65, 65, 30, -1e9F);
  post(grid, 40, 32) = 1e9F;
  const Viewshed shed = seen_by_two(grid, observer_at(32, 32));
  EXPECT_EQ(sight_at(shed, 40, 32), Sight::seen);
  EXPECT_EQ(sight_at(shed, 50, 32), Sight::hidden);
  EXPECT_EQ(sight_at(shed, 32, 50), Sight::seen);
}

TEST(Viewshed, NoPostBeyondTheReachIsKnown) {
  const HeightGrid grid = flat_grid(101, 81, 10);
  ViewshedOptions options = observer_at(50, 40);
  for (const double reach_m : {0.0, 9.0, 10.0, 250.0}) {
    options.reach_m = reach_m;
    const Viewshed shed = seen_by_two(grid, options);
    const HeightGrid needed = needed_by_two(grid, options);
    each_post(grid, [&](int column, int row) {
      const bool known = 10 * std::hypot(column - 50, row - 40) <= reach_m;
      ASSERT_EQ(sight_at(shed, column, row), known ? Sight::seen : Sight::unknown) << column << " " << row;
      ASSERT_EQ(std::isnan(needed.at(column, row)), !known) << column << " " << row;
    });
  }
}

TEST(Viewshed, BadInputIsNamed) {
  const auto problem = [](const HeightGrid& grid, const std::function<void(ViewshedOptions&)>& change) {
    ViewshedOptions options = observer_at(1, 1);
    change(options);
    try {
      static_cast<void>(seen_by_two(grid, options));
      static_cast<void>(needed_by_two(grid, options));
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const HeightGrid grid = flat_grid(3, 4, 10);
  const std::string start = "cannot compute a viewshed: ";
  const auto same = [](ViewshedOptions&) {};
  EXPECT_EQ(problem(grid, same), "none");
  EXPECT_EQ(problem(grid, [](auto& o) { o.column = 3; }), start + "the observer is outside the grid");
  EXPECT_EQ(problem(grid, [](auto& o) { o.row = -1; }), start + "the observer is outside the grid");
  EXPECT_EQ(problem(grid, [](auto& o) { o.radius_m = 0; }), start + "the radius of the planet must be above 0");
  EXPECT_EQ(problem(grid, [](auto& o) { o.radius_m = NAN; }),
            start + "the radius of the planet must be above 0");
  EXPECT_EQ(problem(grid, [](auto& o) { o.reach_m = -1; }), start + "the distance must be at least 0");
  EXPECT_EQ(problem(grid, [](auto& o) { o.observer_height_m = NAN; }),
            start + "heights over the ground must be at most 1e9 m");
  EXPECT_EQ(problem(grid, [](auto& o) { o.target_height_m = 2e9; }),
            start + "heights over the ground must be at most 1e9 m");
  HeightGrid bad = grid;
  bad.spacing_m = 0;
  EXPECT_EQ(problem(bad, same), start + "the spacing of posts must be above 0");
  bad = grid;
  bad.heights_m.pop_back();
  EXPECT_EQ(problem(bad, same), start + "the grid has 11 heights; expected one for each post");
  EXPECT_EQ(problem(HeightGrid{}, same),
            start + "a grid of 0 x 0 posts; expected 1 to 1048576 in both directions");
}

}  // namespace
}  // namespace vpe::map
