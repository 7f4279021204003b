#include "vpe/warp/carry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <random>
#include <stdexcept>

#include "tests/warp/scenes.h"
#include "vpe/core/stereo.h"
#include "vpe/warp/carry_cells.h"
#include "vpe/warp/moved_pixels.h"

namespace vpe::warp {
namespace {

using test_support::Box;
using test_support::hills;
using test_support::image_of;
using test_support::random_in;
using test_support::Scene;
using test_support::view_at;

constexpr unsigned kSeed = 20261125;

// Carries by cells also what would be carried by rows.
CarriedImage by_cells(const core::View& from, const core::Frame& frame, const core::View& to,
                      const CarryOptions& options, base::ThreadPool& pool) {
  CarriedImage image;
  image.width = core::drawn_size(to).x;
  image.height = core::drawn_size(to).y;
  const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.colour.resize(count);
  image.range_m.resize(count);
  image.origin.resize(count);
  MovedPixels pixels;
  carry_cells(from, frame, to, options, pool, pixels, image);
  for (const Origin origin : image.origin) ++image.pixels[static_cast<std::size_t>(origin)];
  return image;
}

// Returns where the first camera saw the point at a range along a pixel's ray of the new camera.
glm::dvec2 seen_before(const core::View& from, const core::View& to, int x, int y, double range_m) {
  const core::SubRectangle part = core::drawn_part(to);
  const glm::dvec3 ray = core::pixel_ray(to, part.x + x + 0.5, part.y + y + 0.5);
  const double far_m = std::isfinite(range_m) ? range_m : 1e12;
  return core::project(from, to.camera.position_m + far_m * ray).xy;
}

// Errors are distances, in the first image, between what is shown and what should be.
struct Errors {
  double worst_px = 0;         // of ground
  double worst_behind_px = 0;  // where what is shown lies behind all that should be within a pixel around
  std::int64_t shown = 0;
};

Errors errors_of(const CarriedImage& carried, const core::View& from, const core::View& to,
                 const core::Frame& truth, int around = 1) {
  Errors errors;
  for (int y = 0; y < carried.height; ++y) {
    for (int x = 0; x < carried.width; ++x) {
      const auto n = static_cast<std::size_t>(y * carried.width + x);
      if (carried.origin[n] == Origin::kOpen) continue;
      ++errors.shown;
      const auto is = static_cast<double>(carried.range_m[n]);
      const auto should = static_cast<double>(truth.range_m[n]);
      const auto off_px = [&](double range_m) {
        return glm::length(seen_before(from, to, x, y, is) - seen_before(from, to, x, y, range_m));
      };
      if (std::isfinite(is) == std::isfinite(should))
        errors.worst_px = std::max(errors.worst_px, off_px(should));
      // Silhouettes are those of the first image's pixels, so what lies beside the image counts too.
      if (x < around || y < around || x >= carried.width - around || y >= carried.height - around) continue;
      double farthest = 0;
      for (int v = y - around; v <= y + around; ++v)
        for (int u = x - around; u <= x + around; ++u)
          farthest = std::max(
              farthest, static_cast<double>(truth.range_m[static_cast<std::size_t>(v * carried.width + u)]));
      if (is > farthest) errors.worst_behind_px = std::max(errors.worst_behind_px, off_px(farthest));
    }
  }
  return errors;
}

Scene comb() {
  Scene scene;
  scene.floors.push_back({{0, 0, 1}, 0});
  for (int n = -10; n <= 10; ++n) scene.boxes.push_back({{12.0 * n - 3, 60, 0}, {12.0 * n + 3, 62, 30}});
  scene.boxes.push_back({{-400, 300, 0}, {400, 310, 60}});
  return scene;
}

TEST(Carry, TheSameViewIsTheSameImage) {
  base::ThreadPool pool(2);
  const core::View view = view_at({0, 0, 20}, 10, -5, 3);
  const core::Frame frame = image_of(hills(), view);
  const CarriedImage rows = carry(view, frame, view, {}, pool);
  EXPECT_EQ(rows.count(Origin::kOpen), 0);
  EXPECT_EQ(rows.added_px, 0);
  for (std::size_t n = 0; n < frame.colour.size(); ++n) {
    ASSERT_EQ(rows.colour[n], frame.colour[n]) << n;
    if (std::isfinite(frame.range_m[n])) {
      ASSERT_NEAR(rows.range_m[n] / frame.range_m[n], 1, 3e-7) << n;
    } else {
      ASSERT_EQ(rows.range_m[n], core::kSkyRange);
    }
  }
  const CarriedImage cells = by_cells(view, frame, view, {}, pool);
  for (std::size_t n = 0; n < frame.colour.size(); ++n) {
    if (cells.origin[n] == Origin::kOpen) continue;
    ASSERT_LE(std::abs(cells.colour[n].r - frame.colour[n].r), 1) << n;
  }
  EXPECT_LE(cells.count(Origin::kOpen), 2 * 160 + 2 * 120);
}

TEST(Carry, GroundThatIsFlatBetweenNeighboursIsAtItsPlace) {
  base::ThreadPool pool(2);
  Scene plane;
  plane.floors.push_back({glm::normalize(glm::dvec3(0.1, -0.2, 1)), 0});
  Scene sphere;
  sphere.spheres.push_back({{0, 3000, -2000}, 2900});
  for (const Scene& scene : {plane, sphere}) {
    for (const double aside_m : {0.7, -0.7, 4.0, -4.0}) {
      const core::View left = view_at({0, 0, 50}, 15, -25, 8);
      for (const auto& convergence : {std::optional<double>(), std::optional<double>(200)}) {
        const core::View right = core::eye_view(left, aside_m, convergence);
        const CarriedImage carried = carry(left, image_of(scene, left), right, {.nearest_m = 40}, pool);
        const Errors errors = errors_of(carried, left, right, image_of(scene, right));
        EXPECT_GT(errors.shown, 0.7 * 160 * 120) << aside_m;
        EXPECT_LE(errors.worst_px, 0.125) << aside_m;
        EXPECT_LE(errors.worst_px, carried.added_px + 1e-3) << aside_m;
      }
    }
  }
}

// The same for any new view, where most blocks move as facets.
TEST(Carry, AnyNewViewShowsFlatGroundAtItsPlace) {
  base::ThreadPool pool(2);
  Scene plane;
  plane.floors.push_back({glm::normalize(glm::dvec3(0.1, -0.2, 1)), 0});
  Scene sphere;
  sphere.spheres.push_back({{0, 3000, -2000}, 2900});
  const core::View from = view_at({0, 0, 50}, 15, -25, 8);
  std::mt19937 random(kSeed);
  for (const Scene& scene : {plane, sphere}) {
    const core::Frame frame = image_of(scene, from);
    for (int n = 0; n < 50; ++n) {
      core::View to = view_at(
          {random_in(random, -4, 4), random_in(random, -4, 4), 50 + random_in(random, -4, 4)},
          15 + random_in(random, -5, 5), -25 + random_in(random, -5, 5), 8 + random_in(random, -10, 10));
      to.fov_deg = random_in(random, 55, 65);
      const CarriedImage carried = carry(from, frame, to, {.nearest_m = 40}, pool);
      const Errors errors = errors_of(carried, from, to, image_of(scene, to));
      EXPECT_GT(errors.shown, 0.5 * 160 * 120) << n;
      EXPECT_LE(errors.worst_px, 0.125) << n;
      EXPECT_LE(errors.worst_px, carried.added_px + 1e-3) << n;
    }
  }
}

TEST(Carry, NothingHiddenIsShown) {
  base::ThreadPool pool(2);
  for (const Scene& scene : {comb(), hills()}) {
    for (const double aside_m : {0.5, -0.5, 2.0, -2.0, 6.0}) {
      const core::View left = view_at({3, 0, 22}, 4, -6);
      const core::View right = core::eye_view(left, aside_m, std::nullopt);
      const CarriedImage carried = carry(left, image_of(scene, left), right, {.nearest_m = 30}, pool);
      const Errors errors = errors_of(carried, left, right, image_of(scene, right));
      EXPECT_GT(errors.shown, 0.5 * 160 * 120);
      EXPECT_LE(errors.worst_behind_px, 1 + kCarriedPosition_px) << aside_m;
    }
  }
}

// A frame that is carried must not be blurred beside its key frame.
TEST(Carry, ContrastBetweenPixelsIsKept) {
  base::ThreadPool pool(2);
  Scene plane;
  plane.floors.push_back({{0, 0, 1}, 0});
  const core::View from = view_at({0, 0, 50}, 15, -60);
  core::Frame frame = image_of(plane, from);
  std::mt19937 random(kSeed);
  // Grey noise with a grain of two pixels, as ground has it.
  std::vector<double> noise(frame.colour.size());
  for (double& value : noise) value = random_in(random, 40, 215);
  for (std::size_t n = 161; n < noise.size(); ++n) {
    const double grey = (noise[n] + noise[n - 1] + noise[n - 160] + noise[n - 161]) / 4;
    const auto tone = static_cast<std::uint8_t>(grey);
    frame.colour[n] = {tone, tone, tone};
  }
  const auto contrast = [](const std::vector<base::Rgb>& colour) {
    double sum = 0;
    for (std::size_t y = 30; y < 90; ++y)
      for (std::size_t x = 40; x < 120; ++x) sum += std::abs(colour[160 * y + x].r - colour[160 * y + x - 1].r);
    return sum;
  };
  for (const double turn_deg : {0.1, 0.35, 0.8}) {
    const CarriedImage image =
        by_cells(from, frame, view_at({0, 0, 50}, 15 + turn_deg, -60 + turn_deg), {}, pool);
    const double kept = contrast(image.colour) / contrast(frame.colour);
    EXPECT_GT(kept, 0.83) << turn_deg;
    EXPECT_LT(kept, 1.05) << turn_deg;
  }
}

TEST(Carry, RowsAndCellsShowTheSame) {
  base::ThreadPool pool(2);
  const core::View left = view_at({3, 0, 22}, 4, -6);
  const core::View right = core::eye_view(left, 1.5, std::nullopt);
  const core::Frame frame = image_of(hills(), left);
  const CarryOptions options{.nearest_m = 30};
  const CarriedImage rows = carry(left, frame, right, options, pool);
  const CarriedImage cells = by_cells(left, frame, right, options, pool);
  std::int64_t differ = 0;
  for (std::size_t n = 0; n < rows.origin.size(); ++n) {
    if (rows.origin[n] == Origin::kOpen || cells.origin[n] == Origin::kOpen) continue;
    if (std::abs(rows.colour[n].r - cells.colour[n].r) > 3) ++differ;
  }
  EXPECT_LT(differ, static_cast<std::int64_t>(rows.origin.size() / 100));
}

// A thousand views: any pose near the first one.
TEST(Carry, AnyNewViewShowsNothingThatIsHidden) {
  base::ThreadPool pool(2);
  std::mt19937 random(kSeed);
  const std::vector<Scene> scenes{hills(), comb()};
  std::vector<std::pair<core::View, core::Frame>> first;
  for (const Scene& scene : scenes) {
    const core::View view = view_at({3, 0, 22}, 4, -8);
    first.emplace_back(view, image_of(scene, view));
  }
  double worst_px = 0;
  double worst_behind_px = 0;
  std::int64_t shown = 0;
  for (int n = 0; n < 1000; ++n) {
    const std::size_t which = static_cast<std::size_t>(n) % scenes.size();
    const core::View& from = first[which].first;
    const double x = 3 + random_in(random, -2, 2);
    const double y = random_in(random, -3, 3);
    const double z = 22 + random_in(random, -2, 2);
    core::View to = view_at({x, y, z}, 4 + random_in(random, -6, 6), -8 + random_in(random, -6, 6),
                            random_in(random, -15, 15));
    to.fov_deg = random_in(random, 50, 70);
    const CarriedImage carried = carry(from, first[which].second, to, {.nearest_m = 15}, pool);
    const Errors errors = errors_of(carried, from, to, image_of(scenes[which], to), 2);
    shown += errors.shown;
    worst_px = std::max(worst_px, errors.worst_px);
    worst_behind_px = std::max(worst_behind_px, errors.worst_behind_px);
    EXPECT_LE(errors.worst_behind_px, 1.5) << n;
  }
  std::printf("shown %.3f, worst %.3f px, behind %.3f px\n", static_cast<double>(shown) / (1000.0 * 160 * 120),
              worst_px, worst_behind_px);
  EXPECT_GT(shown, 500 * 160 * 120);
}

TEST(Carry, WhatStandsBesideTheFirstImageIsNotMissed) {
  base::ThreadPool pool(1);
  Scene scene = hills();
  // A post that the left eye does not see and that hides ground from the right one.
  scene.boxes.push_back({{6.4, 8, 0}, {6.8, 8.4, 30}});
  const core::View left = view_at({0, 0, 20}, 0, -5);
  const core::View right = core::eye_view(left, 2, std::nullopt);
  const core::Frame frame = image_of(scene, left);
  const core::Frame truth = image_of(scene, right);
  const auto behind_px = [&](double nearest_m) {
    return errors_of(carry(left, frame, right, {.nearest_m = nearest_m}, pool), left, right, truth)
        .worst_behind_px;
  };
  EXPECT_GT(behind_px(100), 5) << "the scene does not test what it should";
  EXPECT_LE(behind_px(7), 1 + kCarriedPosition_px);
  EXPECT_EQ(carry(left, frame, right, {.nearest_m = 0}, pool).count(Origin::kOpen), 160 * 120);
}

TEST(Carry, OpenPixelsBeginBeforeTheGround) {
  base::ThreadPool pool(2);
  for (const Scene& scene : {comb(), hills()}) {
    const core::View from = view_at({3, 0, 22}, 4, -6);
    const core::Frame frame = image_of(scene, from);
    std::int64_t known = 0;
    for (const core::View& to : {core::eye_view(from, 2, std::nullopt), core::eye_view(from, -2, std::nullopt),
                                 view_at({4.5, 1, 23}, 6, -7, 5)}) {
      const CarriedImage carried = carry(from, frame, to, {.nearest_m = 15}, pool);
      const core::Frame truth = image_of(scene, to);
      for (std::size_t n = 0; n < carried.origin.size(); ++n) {
        if (carried.origin[n] != Origin::kOpen || carried.range_m[n] == 0) continue;
        ++known;
        ASSERT_GE(truth.range_m[n], 0.96F * carried.range_m[n]) << n;
      }
    }
    EXPECT_GT(known, 20);
  }
}

TEST(Carry, ThreadsChangeNoBit) {
  base::ThreadPool one(1);
  base::ThreadPool many(5);
  const core::View from = view_at({3, 0, 22}, 4, -6);
  const core::Frame frame = image_of(comb(), from);
  for (const core::View& to : {core::eye_view(from, 1.5, std::nullopt), view_at({3.5, 1, 22.5}, 6, -7, 5)}) {
    const CarriedImage a = carry(from, frame, to, {.nearest_m = 20}, one);
    const CarriedImage b = carry(from, frame, to, {.nearest_m = 20}, many);
    EXPECT_EQ(a.colour, b.colour);
    EXPECT_EQ(a.range_m, b.range_m);
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.added_px, b.added_px);
  }
}

TEST(Carry, AWiderGapOpensFewerPixels) {
  base::ThreadPool pool(2);
  const core::View left = view_at({3, 0, 22}, 4, -6);
  const core::View right = core::eye_view(left, 2, std::nullopt);
  const core::Frame frame = image_of(comb(), left);
  std::int64_t before = 160 * 120 + 1;
  for (const double gap_px : {0.0, 1.2, 2.0, 4.0, 16.0}) {
    const CarriedImage carried = carry(left, frame, right, {.gap_px = gap_px, .nearest_m = 30}, pool);
    EXPECT_LE(carried.count(Origin::kOpen), before) << gap_px;
    before = carried.count(Origin::kOpen);
    EXPECT_LE(carried.added_px, std::max(gap_px - 1, 0.0) + 2 * kCarriedPosition_px + 1e-3);
    if (gap_px == 0) {
      EXPECT_EQ(before, 160 * 120) << "nothing is carried";
    }
  }
  EXPECT_LT(before, 160 * 120 / 10);
}

TEST(Carry, BadInputIsRefused) {
  base::ThreadPool pool(1);
  const core::View view = view_at({0, 0, 20});
  core::Frame frame = image_of(hills(), view);
  core::View round = view;
  round.projection = core::Projection::kCylinder;
  EXPECT_THROW((void)carry(view, frame, round, {}, pool), std::invalid_argument);
  EXPECT_THROW((void)carry(view, frame, view, {.gap_px = -1}, pool), std::invalid_argument);
  EXPECT_THROW((void)carry(view, frame, view, {.gap_px = std::nan("")}, pool), std::invalid_argument);
  EXPECT_THROW((void)carry(view, frame, view, {.nearest_m = -1}, pool), std::invalid_argument);
  frame.colour.pop_back();
  EXPECT_THROW((void)carry(view, frame, view, {}, pool), std::invalid_argument);
  frame.colour.clear();
  EXPECT_TRUE(carry(view, frame, view, {}, pool).colour.empty());
  frame.range_m.clear();
  EXPECT_THROW((void)carry(view, frame, view, {}, pool), std::invalid_argument);
}

TEST(Carry, RangesOfAnyKindDoNoHarm) {
  base::ThreadPool pool(1);
  const core::View from = view_at({0, 0, 20});
  core::Frame frame = image_of(hills(), from);
  std::mt19937 random(kSeed);
  const std::vector<float> odd{0.0F, -1.0F, std::nanf(""), 1e-30F, 1e30F, core::kSkyRange, -core::kSkyRange};
  for (int n = 0; n < 3000; ++n) frame.range_m[random() % frame.range_m.size()] = odd[random() % odd.size()];
  for (const core::View& to : {from, core::eye_view(from, 1.5, std::nullopt), view_at({0, 5, 22.5}, 6, -7, 5),
                               view_at({0, 900, -5}, 180, 0, 0)}) {
    const CarriedImage carried = carry(from, frame, to, {.nearest_m = 20}, pool);
    for (std::size_t n = 0; n < carried.origin.size(); ++n) {
      if (carried.origin[n] == Origin::kOpen) continue;
      ASSERT_GT(carried.range_m[n], 0) << n;
    }
  }
}

}  // namespace
}  // namespace vpe::warp
