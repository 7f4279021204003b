// Tests images that follow the camera as a grid, or by polynomials.
#include "vpe/warp/image_grid.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <glm/geometric.hpp>
#include <random>
#include <stdexcept>

#include "tests/warp/scenes.h"

namespace vpe::warp {
namespace {

using test_support::hills;
using test_support::image_of;
using test_support::random_in;
using test_support::Scene;
using test_support::view_at;

constexpr unsigned kSeed = 20261125;

// Returns where the new camera sees what a place of an image shows, by the whole chain of rays and points.
glm::dvec2 seen_at(const core::View& from, const core::View& to, const glm::dvec2& place_px, double depth_m) {
  const glm::dvec3 ray = core::pixel_ray(from, place_px.x, place_px.y);
  const double range_m = std::isinf(depth_m) ? 1e15 : depth_m / glm::dot(ray, from.camera.axes.forward);
  return core::project(to, from.camera.position_m + range_m * ray).xy;
}

TEST(ImageGrid, VerticesMoveToWhereTheNewCameraSeesThem) {
  std::mt19937 random(kSeed);
  const core::View from = view_at({3, 0, 22}, 4, -8, 3);
  const core::Frame frame = image_of(hills(), from);
  const ImageGrid grid(from, frame.range_m, {16, 12});
  EXPECT_EQ(grid.cells(), glm::ivec2(18, 14));
  ASSERT_EQ(grid.places().size(), 19U * 15U);
  std::vector<MovedVertex> moved;
  for (int n = 0; n < 200; ++n) {
    core::View to =
        view_at({3 + random_in(random, -3, 3), random_in(random, -3, 3), 22 + random_in(random, -2, 2)},
                4 + random_in(random, -9, 9), -8 + random_in(random, -9, 9), random_in(random, -20, 20));
    to.fov_deg = random_in(random, 40, 80);
    to.width = 320;
    to.height = 200;
    grid.move(to, moved);
    for (int row = 1; row <= 13; ++row) {
      for (int column = 1; column <= 17; ++column) {
        const auto v = static_cast<std::size_t>(grid.index(column, row));
        const glm::vec2 place = grid.places()[v];
        const int x = std::min(static_cast<int>(place.x), 159);
        const int y = std::min(static_cast<int>(place.y), 119);
        const glm::dvec3 pixel_ray = core::pixel_ray(from, x + 0.5, y + 0.5);
        const double depth_m = static_cast<double>(frame.range_m[static_cast<std::size_t>(160 * y + x)]) *
                               glm::dot(pixel_ray, from.camera.axes.forward);
        ASSERT_TRUE(moved[v].is_ahead);
        const glm::dvec2 wanted = seen_at(from, to, place, depth_m);
        ASSERT_NEAR(static_cast<double>(moved[v].xy_px.x), wanted.x, 2e-3) << n;
        ASSERT_NEAR(static_cast<double>(moved[v].xy_px.y), wanted.y, 2e-3) << n;
      }
    }
  }
}

TEST(ImageGrid, RangesOfCornersMakeTheSameGrid) {
  const core::View from = view_at({3, 0, 22}, 4, -8, 3);
  const core::Frame frame = image_of(hills(), from);
  for (const glm::ivec2 cells : {glm::ivec2(16, 12), glm::ivec2(7, 5), glm::ivec2(1, 1)}) {
    std::vector<float> corners;
    for (int row = 0; row <= cells.y; ++row) {
      for (int column = 0; column <= cells.x; ++column) {
        const int x = std::min(frame.width * column / cells.x, frame.width - 1);
        const int y = std::min(frame.height * row / cells.y, frame.height - 1);
        corners.push_back(frame.range_m[static_cast<std::size_t>(frame.width * y + x)]);
      }
    }
    const ImageGrid all(from, frame.range_m, cells);
    const ImageGrid few = ImageGrid::of_corners(from, corners, cells);
    EXPECT_EQ(few.cells(), all.cells());
    const core::View to = view_at({5, 1, 21}, 9, -3, -4);
    std::vector<MovedVertex> a;
    std::vector<MovedVertex> b;
    all.move(to, a);
    few.move(to, b);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < a.size(); ++n) {
      EXPECT_EQ(a[n].is_ahead, b[n].is_ahead);
      EXPECT_EQ(a[n].xy_px, b[n].xy_px);
      EXPECT_EQ(a[n].inverse_depth, b[n].inverse_depth);
    }
    corners.pop_back();
    EXPECT_THROW((void)ImageGrid::of_corners(from, corners, cells), std::invalid_argument);
  }
}

TEST(ImageGrid, TheSameViewLeavesEachVertexInItsPlace) {
  const core::View view = view_at({0, 0, 20}, 30, -20, 12);
  const ImageGrid grid(view, image_of(hills(), view).range_m, {8, 6});
  std::vector<MovedVertex> moved;
  grid.move(view, moved);
  for (std::size_t n = 0; n < moved.size(); ++n) {
    EXPECT_NEAR(moved[n].xy_px.x, grid.places()[n].x, 1e-3);
    EXPECT_NEAR(moved[n].xy_px.y, grid.places()[n].y, 1e-3);
  }
  EXPECT_EQ(grid.texture_at(0), glm::vec2(0, 0));
  EXPECT_EQ(grid.texture_at(moved.size() - 1), glm::vec2(1, 1));
  const auto middle = static_cast<std::size_t>(grid.index(5, 4));
  EXPECT_EQ(grid.texture_at(middle), glm::vec2(0.5F, 0.5F));
}

// The motion of a pure rotation is a homography: the places that the exact projection gives, whatever the ranges.
TEST(ImageGrid, APolynomialOfARotationIsWithinItsResidualOfTheHomography) {
  std::mt19937 random(kSeed);
  const core::View from = view_at({3, 0, 22}, 4, -8);
  const ImageGrid grid(from, image_of(hills(), from).range_m, {16, 12});
  std::vector<MovedVertex> moved;
  double worst_px = 0;
  for (int n = 0; n < 200; ++n) {
    core::View to = view_at({3, 0, 22}, 4 + random_in(random, -6, 6), -8 + random_in(random, -6, 6),
                            random_in(random, -10, 10));
    grid.move(to, moved);
    const auto motion = fit_motion(grid, moved);
    ASSERT_TRUE(motion);
    for (double y = 0; y <= 120; y += 4) {
      for (double x = 0; x <= 160; x += 4) {
        const glm::dvec2 wanted = seen_at(from, to, {x, y}, std::numeric_limits<double>::infinity());
        ASSERT_LE(glm::length(motion->at({x, y}) - wanted), motion->residual_px + 0.02) << n;
      }
    }
    worst_px = std::max(worst_px, motion->residual_px);
  }
  std::printf("largest residual of a rotation of up to 6 degrees: %.3f px of 160\n", worst_px);
  EXPECT_LT(worst_px, 2);
  EXPECT_GT(worst_px, 0);
}

// On a plane the true motion is a homography too, so the grid is exact at its vertices, and polynomials nearly so.
TEST(ImageGrid, TheGridFollowsReliefThatPolynomialsCannot) {
  const core::View from = view_at({3, 0, 22}, 4, -20);
  const ImageGrid grid(from, image_of(hills(), from).range_m, {16, 12});
  std::vector<MovedVertex> moved;
  core::View to = view_at({6, 4, 22}, 4, -20);
  grid.move(to, moved);
  const auto motion = fit_motion(grid, moved);
  ASSERT_TRUE(motion);
  EXPECT_GT(motion->residual_px, 0.5);
}

// Returns where a triangle of moved vertices shows what the three places show.
glm::dvec2 moved_within(const std::array<glm::dvec2, 3>& places, const std::array<glm::dvec2, 3>& moved,
                        const glm::dvec2& place) {
  const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
  const glm::dvec2 ab = places[1] - places[0];
  const glm::dvec2 ac = places[2] - places[0];
  const glm::dvec2 p = place - places[0];
  const double u = cross(p, ac) / cross(ab, ac);
  const double v = cross(ab, p) / cross(ab, ac);
  return moved[0] + u * (moved[1] - moved[0]) + v * (moved[2] - moved[0]);
}

// Returns where the grid, drawn as two triangles a cell, shows a place of its image.
glm::dvec2 shown_at(const ImageGrid& grid, const std::vector<MovedVertex>& moved, const glm::dvec2& place,
                    const glm::dvec2& cell_px) {
  const glm::ivec2 cell = glm::ivec2(glm::floor(place / cell_px)) + 1;
  const auto vertex = [&](int right, int down) {
    return static_cast<std::size_t>(grid.index(cell.x + right, cell.y + down));
  };
  const std::array<std::size_t, 4> at{vertex(0, 0), vertex(1, 0), vertex(1, 1), vertex(0, 1)};
  const glm::dvec2 within = place / cell_px - glm::floor(place / cell_px);
  const std::array<std::size_t, 3> corners =
      within.x > within.y ? std::array{at[0], at[1], at[2]} : std::array{at[0], at[2], at[3]};
  std::array<glm::dvec2, 3> places;
  std::array<glm::dvec2, 3> to;
  for (std::size_t n = 0; n < 3; ++n) {
    places[n] = grid.places()[corners[n]];
    to[n] = moved[corners[n]].xy_px;
  }
  return moved_within(places, to, place);
}

// A tenth of a second at 30 degrees and one height a second: 200 motions against the true images.
TEST(ImageGrid, TwoHundredMotionsShowNearlyAllGroundWhereTheTrueImagesDo) {
  std::mt19937 random(kSeed);
  const Scene scene = hills();
  const core::View from = view_at({3, 0, 22}, 4, -20);
  const core::Frame frame = image_of(scene, from);
  const glm::ivec2 cells(16, 12);
  const ImageGrid grid(from, frame.range_m, cells);
  const glm::dvec2 cell_px = glm::dvec2(160, 120) / glm::dvec2(cells);
  std::vector<MovedVertex> moved;
  std::int64_t grid_within = 0;
  std::int64_t polynomial_within = 0;
  std::int64_t still_within = 0;
  std::int64_t seen = 0;
  for (int n = 0; n < 200; ++n) {
    glm::dvec3 step(random_in(random, -1, 1), random_in(random, -1, 1), random_in(random, -1, 1));
    step *= 2.2 / std::max(glm::length(step), 1.0);
    const core::View to = view_at(glm::dvec3(3, 0, 22) + step, 4 + random_in(random, -3, 3),
                                  -20 + random_in(random, -3, 3), random_in(random, -3, 3));
    const core::Frame truth = image_of(scene, to);
    grid.move(to, moved);
    const auto polynomial = fit_motion(grid, moved);
    ASSERT_TRUE(polynomial);
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        const auto range_m = static_cast<double>(truth.range_m[static_cast<std::size_t>(160 * y + x)]);
        if (std::isinf(range_m)) continue;
        const glm::dvec2 pixel(x + 0.5, y + 0.5);
        const glm::dvec3 point_m = to.camera.position_m + range_m * core::pixel_ray(to, pixel.x, pixel.y);
        const glm::dvec2 place = core::project(from, point_m).xy;
        if (!(place.x >= 0 && place.x < 160 && place.y >= 0 && place.y < 120)) continue;
        // What the first image does not show is not asked of it.
        const glm::dvec3 back = point_m - from.camera.position_m;
        if (scene.cast_m(from.camera.position_m, glm::normalize(back)) < 0.999 * glm::length(back)) continue;
        ++seen;
        grid_within += glm::length(shown_at(grid, moved, place, cell_px) - pixel) <= 1 ? 1 : 0;
        polynomial_within += glm::length(polynomial->at(place) - pixel) <= 1 ? 1 : 0;
        still_within += glm::length(place - pixel) <= 1 ? 1 : 0;
      }
    }
  }
  const auto share = [&](std::int64_t within) {
    return static_cast<double>(within) / static_cast<double>(seen);
  };
  std::printf("within 1 px of 160: grid %.4f, polynomials %.4f, the image itself %.4f of %lld\n",
              share(grid_within), share(polynomial_within), share(still_within), static_cast<long long>(seen));
  EXPECT_GT(seen, 1'000'000);
  EXPECT_GT(share(grid_within), 0.97);
  EXPECT_GT(share(grid_within), share(polynomial_within));
  EXPECT_LT(share(still_within), 0.2);
}

TEST(ImageGrid, NearerCellsComeLast) {
  const core::View from = view_at({3, 0, 22}, 4, -20);
  const ImageGrid grid(from, image_of(hills(), from).range_m, {16, 12});
  std::vector<MovedVertex> moved;
  grid.move(view_at({6, 4, 22}, 4, -20), moved);
  const std::vector<glm::ivec2> order = far_to_near(grid, moved);
  EXPECT_EQ(order.size(), 18U * 14U);
  float before = 0;
  for (const glm::ivec2& cell : order) {
    float nearest = 0;
    for (const auto& [right, down] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}})
      nearest = std::max(
          nearest, moved[static_cast<std::size_t>(grid.index(cell.x + right, cell.y + down))].inverse_depth);
    EXPECT_GE(nearest, before);
    before = nearest;
  }
  // Behind the new camera there is nothing to draw.
  grid.move(view_at({3, 0, 22}, 184, 20), moved);
  EXPECT_TRUE(far_to_near(grid, moved).empty());
  EXPECT_FALSE(fit_motion(grid, moved));
}

TEST(ImageGrid, BadInputIsRefused) {
  core::View view = view_at({0, 0, 20});
  const core::Frame frame = image_of(hills(), view);
  EXPECT_THROW(ImageGrid(view, frame.range_m, {0, 4}), std::invalid_argument);
  EXPECT_THROW(ImageGrid(view, {}, {4, 4}), std::invalid_argument);
  const ImageGrid odd(view, frame.range_m, {3, 4});
  std::vector<MovedVertex> moved;
  odd.move(view, moved);
  EXPECT_THROW((void)fit_motion(odd, moved), std::invalid_argument);
  view.projection = core::Projection::kCylinder;
  EXPECT_THROW(ImageGrid(view, frame.range_m, {4, 4}), std::invalid_argument);
  // Ranges that are none count as sky.
  const std::vector<float> none(frame.range_m.size(), 0.0F);
  view.projection = core::Projection::kPerspective;
  const ImageGrid sky(view, none, {4, 4});
  sky.move(view_at({50, 0, 20}), moved);
  EXPECT_NEAR(moved[static_cast<std::size_t>(sky.index(3, 3))].xy_px.x, 80, 1e-3);
}

}  // namespace
}  // namespace vpe::warp
