// Shadows by the grid of the sun's plane, against looking at all objects.
#include "objects/draw/sun_grid.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "objects/levels/mesh_levels.h"
#include "objects/model/shapes.h"

namespace objects {
namespace {

class SunGridTest : public ::testing::Test {
 protected:
  // Rocks of a thousandth to all of `largest_m` within some distance of a place of the ground.
  Scene rocks(int count, double largest_m, double spread_m) {
    std::uniform_real_distribution<double> any(-1, 1);
    const auto model = std::make_shared<const Model>("rock", make_levels(make_rock(4, 2)));
    std::vector<Instance> instances;
    for (int n = 0; n < count; ++n) {
      Instance i;
      i.position_m = middle_ + spread_m * glm::dvec3(0.1 * any(random_), any(random_), any(random_));
      i.scale = static_cast<float>(largest_m * std::pow(10.0, -1.5 + 1.5 * any(random_)));
      i.rotation =
          glm::normalize(glm::quat(static_cast<float>(any(random_)), static_cast<float>(any(random_)),
                                   static_cast<float>(any(random_)), static_cast<float>(any(random_))));
      instances.push_back(i);
    }
    return Scene({model}, std::move(instances));
  }

  std::mt19937 random_{20261126};
  glm::dvec3 middle_{3.4e6, 100, -200};
};

TEST_F(SunGridTest, AgreesWithLookingAtAllObjects) {
  std::uniform_real_distribution<double> any(-1, 1);
  for (const auto& [count, largest_m, spread_m] :
       {std::tuple(1, 5.0, 20.0), std::tuple(300, 2.0, 40.0), std::tuple(40, 60.0, 100.0)}) {
    const Scene scene = rocks(count, largest_m, spread_m);
    LevelRule rule;
    rule.camera_m = middle_;
    rule.focal_px = 1e6;  // nothing is too small
    const ObjectRays rays(scene, rule);
    const glm::dvec3 sun = glm::normalize(glm::dvec3(0.4, any(random_), any(random_)));
    const SunGrid grid(rays, sun);
    std::vector<PlacedObject> all;
    for (std::uint32_t n = 0; n < scene.size(); ++n) all.push_back(rays.placed(n));
    int dark = 0;
    for (int n = 0; n < 3000; ++n) {
      // Half of the places are near an object's shadow.
      glm::dvec3 place = middle_ + 1.2 * spread_m * glm::dvec3(0.1 * any(random_), any(random_), any(random_));
      if (n % 2 == 0) {
        const SceneBall ball = scene.ball(static_cast<std::uint32_t>(n) % scene.size());
        place = ball.centre_m - 3 * (1 + any(random_)) * sun +
                ball.radius_m * glm::dvec3(any(random_), any(random_), any(random_));
      }
      const double expected = light_through(all, all_of(all), {place, sun});
      EXPECT_EQ(grid.light_at(place), expected);
      if (expected < 1) {
        ++dark;
        EXPECT_TRUE(grid.may_shade(place, 0));
        EXPECT_TRUE(grid.may_shade(place + glm::dvec3(0.5, 0.3, 0.1), 1));
      }
    }
    EXPECT_GT(dark, 100);
  }
}

TEST_F(SunGridTest, FarFromAllObjectsNothingIsShaded) {
  const Scene scene = rocks(200, 1, 30);
  LevelRule rule;
  rule.camera_m = middle_;
  rule.focal_px = 1000;
  const ObjectRays rays(scene, rule);
  const glm::dvec3 sun(1, 0, 0);
  const SunGrid grid(rays, sun);
  EXPECT_FALSE(grid.is_empty());
  EXPECT_FALSE(grid.may_shade(middle_ + glm::dvec3(0, 500, 0), 0.01));
  EXPECT_FALSE(grid.may_shade(middle_ + glm::dvec3(100, 0, 0), 0.01));  // above all of them
  EXPECT_EQ(grid.light_at(middle_ + glm::dvec3(100, 0, 0)), 1);
  EXPECT_TRUE(grid.may_shade(middle_, 1000));
}

TEST_F(SunGridTest, WhatIsTooSmallToBeDrawnCastsNoShadow) {
  const Scene scene = rocks(50, 0.1, 10);
  LevelRule rule;
  rule.camera_m = middle_ + glm::dvec3(1e5, 0, 0);
  rule.focal_px = 1000;
  EXPECT_TRUE(SunGrid(ObjectRays(scene, rule), {1, 0, 0}).is_empty());
  EXPECT_TRUE(SunGrid().is_empty());
  EXPECT_EQ(SunGrid().light_at(middle_), 1);
  EXPECT_FALSE(SunGrid().may_shade(middle_, 1));
}

}  // namespace
}  // namespace objects
