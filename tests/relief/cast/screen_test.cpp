// Whole images: the screen's quarters against single rays, tolerances, threads, the work on finer maps.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "relief/cast/caster.h"
#include "tests/relief/cast/rays.h"
#include "tests/relief/samples.h"
#include "vpe/report/value_noise.h"

namespace relief {
namespace {

using vpe::core::View;

Surface flat(const std::shared_ptr<const HeightMap>& map) {
  return parallel_surface(Base::plane({0, 0, 0}, {0, 0, 1}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, map,
                          map->support());
}

Surface body() {
  std::array<std::shared_ptr<const Shape>, mars::kFaces> shapes;
  shapes.fill(samples::rough_map(41, 41, 0.05, Interpolation::kBicubic, 70, 0.25, 0.25));
  return cube_surface(Base::ellipsoid({0, 0, 0}, {6, 5, 4.5}), 5, shapes);
}

Surface tapered_ball() {
  samples::Random random(71);
  std::vector<float> posts;
  for (int n = 0; n < 30 * 30; ++n) posts.push_back(static_cast<float>(random.in(-0.2, 0.2)));
  const MapLayout layout{30, 30, -2.9, -2.9, 0.2, 0.2};
  const auto map = std::make_shared<HeightMap>(layout, tapered(posts, 30, 30, 6), Interpolation::kBilinear);
  return parallel_surface(Base::sphere({0, 0, 0}, 5), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, map);
}

void expect_single_rays(const Surface& surface, const View& view) {
  vpe::base::ThreadPool pool(1);
  const CastResult found = cast(surface, view, {}, pool);
  ASSERT_EQ(found.range_m.size(),
            static_cast<std::size_t>(found.width) * static_cast<std::size_t>(found.height));
  int hits = 0;
  for (std::size_t n = 0; n < found.range_m.size(); ++n) {
    const glm::dvec3 d = rays::pixel_direction(view, n);
    const double expected = cast_ray(surface, view.camera.position_m, d);
    hits += expected < kNoHit ? 1 : 0;
    if (expected == kNoHit || found.range_m[n] == kNoHit) {
      EXPECT_EQ(found.range_m[n], expected) << n;
    } else {
      EXPECT_NEAR(found.range_m[n], expected, 1e-7) << n;
    }
  }
  EXPECT_GT(hits, 500);
}

TEST(ReliefScreen, QuartersFindWhatSingleRaysFind) {
  const auto map = samples::rough_map(60, 60, 0.5, Interpolation::kBicubic, 72);
  expect_single_rays(flat(map), rays::look({-25, -22, 9}, {0, 0, 0}, 93, 70, 60));
  expect_single_rays(body(), rays::look({9, -8, 6}, {0, 0, 0}, 100, 67, 60));
  expect_single_rays(tapered_ball(), rays::look({8, -8, 5}, {0, 0, 0}, 100, 67, 60));
}

TEST(ReliefScreen, QuartersWorkInTheGroundAndCloseToIt) {
  const auto map = samples::rough_map(60, 60, 0.5, Interpolation::kBilinear, 73);
  const Surface ground = flat(map);
  expect_single_rays(ground, rays::look({1, 2, -7}, {5, 6, 0}, 70, 65, 90));
  expect_single_rays(ground, rays::look({0.3, 0.4, map->height_m(0.3, 0.4) + 0.01}, {9, 10, 0}, 70, 65, 90));
  expect_single_rays(body(), rays::look({0, 0, 0}, {1, 1, 0.5}, 70, 65, 120));
}

TEST(ReliefScreen, PartsOffsetsAndOtherProjectionsAreThoseOfTheView) {
  const auto map = samples::rough_map(60, 60, 0.5, Interpolation::kBicubic, 74);
  const Surface ground = flat(map);
  View view = rays::look({-25, -22, 9}, {0, 0, 0}, 300, 200, 60);
  view.principal_offset_px = {17.5, -30.25};
  view.part = {70, 60, 81, 66};
  expect_single_rays(ground, view);
  View round = rays::look({0, 0, 6}, {10, 10, 5.9}, 120, 40, 60);
  for (const vpe::core::Projection projection :
       {vpe::core::Projection::kCylinder, vpe::core::Projection::kEquirectangular}) {
    round.projection = projection;
    expect_single_rays(ground, round);
  }
}

TEST(ReliefScreen, LimitsHoldForEveryPixel) {
  const auto map = samples::rough_map(60, 60, 0.5, Interpolation::kBicubic, 75);
  const Surface ground = flat(map);
  const View view = rays::look({-25, -22, 9}, {0, 0, 0}, 80, 60, 60);
  vpe::base::ThreadPool pool(1);
  const CastResult found = cast(ground, view, {.near_m = 20, .far_m = 35}, pool);
  int hits = 0;
  for (std::size_t n = 0; n < found.range_m.size(); ++n) {
    const double expected = cast_ray(ground, view.camera.position_m, rays::pixel_direction(view, n), 20, 35);
    hits += expected < kNoHit ? 1 : 0;
    if (expected == kNoHit || found.range_m[n] == kNoHit) {
      EXPECT_EQ(found.range_m[n], expected) << n;
    } else {
      EXPECT_NEAR(found.range_m[n], expected, 1e-7);
    }
  }
  EXPECT_GT(hits, 300);
}

TEST(ReliefScreen, ResultsDoNotDependOnThreads) {
  const Surface surface = body();
  const View view = rays::look({9, -8, 6}, {0, 0, 0}, 200, 150, 60);
  vpe::base::ThreadPool one(1);
  vpe::base::ThreadPool four(4);
  const CastResult a = cast(surface, view, {.tolerance_px = 0.3}, one);
  const CastResult b = cast(surface, view, {.tolerance_px = 0.3}, four);
  EXPECT_EQ(a.range_m, b.range_m);
  EXPECT_EQ(a.counts.bundles, b.counts.bundles);
  EXPECT_EQ(a.counts.steps, b.counts.steps);
  EXPECT_EQ(a.counts.patches, b.counts.patches);
}

TEST(ReliefScreen, AToleranceMovesHitsByNoMoreThanItSays) {
  const auto map = samples::rough_map(200, 200, 0.2, Interpolation::kBicubic, 76, 0.5, 0.5);
  const Surface ground = flat(map);
  const View view = rays::look({-45, -42, 12}, {0, 0, 0}, 120, 90, 40);
  vpe::base::ThreadPool pool(1);
  const CastResult exact = cast(ground, view, {}, pool);
  int moved = 0;
  for (const double tolerance_px : {0.5, 3.0}) {
    const CastResult found = cast(ground, view, {.tolerance_px = tolerance_px}, pool);
    for (std::size_t n = 0; n < found.range_m.size(); ++n) {
      // What is hit exactly is hit with a tolerance, too.
      const bool is_hit = found.range_m[n] < kNoHit;
      EXPECT_TRUE(is_hit || exact.range_m[n] == kNoHit);
      if (!is_hit) continue;
      moved += std::abs(found.range_m[n] - exact.range_m[n]) > 1e-9 ? 1 : 0;
      // Beyond the exact hit the ray has not gone deeper than the tolerance.
      const glm::dvec3 d = rays::pixel_direction(view, n);
      const double first = std::min(found.range_m[n], exact.range_m[n]);
      for (int k = 0; k <= 20; ++k) {
        const double range_m = first + (found.range_m[n] - first) * k / 20;
        const double depth_m = range_m * glm::dot(d, view.camera.axes.forward);
        const double offset_m = ground.offset_m(view.camera.position_m + range_m * d);
        if (std::isnan(offset_m)) continue;  // on the border of the map
        EXPECT_LE(std::abs(offset_m), tolerance_px * depth_m / vpe::core::focal_px(view) + 1e-9);
      }
    }
  }
  EXPECT_GT(moved, 100);
}

TEST(ReliefScreen, WorkHardlyGrowsWithTheMap) {
  vpe::base::ThreadPool pool(1);
  const auto work = [&pool](int posts) {
    std::vector<float> heights;
    for (int j = 0; j < posts; ++j)
      for (int i = 0; i < posts; ++i) {
        const glm::dvec3 at{4.0 * i / (posts - 1), 4.0 * j / (posts - 1), 0.5};
        heights.push_back(static_cast<float>(8 * vpe::report::value_noise(at, 1) +
                                             2 * vpe::report::value_noise(4.0 * at, 2)));
      }
    const double spacing_m = 100.0 / (posts - 1);
    const auto map = std::make_shared<HeightMap>(MapLayout{posts, posts, -50, -50, spacing_m, spacing_m},
                                                 heights, Interpolation::kBilinear);
    const CastCounts counts =
        cast(flat(map), rays::look({-55, -52, 32}, {0, 0, 0}, 128, 128, 50), {.tolerance_px = 0.5}, pool)
            .counts;
    return static_cast<double>(counts.bundles + counts.steps + counts.patches);
  };
  // 256 times the posts: four levels more, which most rays end before.
  EXPECT_LE(work(512), 1.5 * work(32));
}

TEST(ReliefScreen, BadViewsAndOptionsAreRefused) {
  vpe::base::ThreadPool pool(1);
  const Surface surface = tapered_ball();
  View view = rays::look({9, -8, 6}, {0, 0, 0}, 20, 15, 60);
  EXPECT_NO_THROW(cast(surface, view, {}, pool));
  EXPECT_THROW(cast(surface, view, {.tolerance_px = -1}, pool), std::invalid_argument);
  EXPECT_THROW(cast(surface, view, {.tolerance_px = std::nan("")}, pool), std::invalid_argument);
  EXPECT_THROW(cast(surface, view, {.near_m = 3, .far_m = 2}, pool), std::invalid_argument);
  view.fov_deg = 0;
  EXPECT_THROW(cast(surface, view, {}, pool), std::invalid_argument);
}

}  // namespace
}  // namespace relief
