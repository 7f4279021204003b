// The tree of balls over the objects of a scene.
#include "objects/scene/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <stdexcept>

#include "objects/levels/mesh_levels.h"
#include "objects/model/shapes.h"

namespace objects {
namespace {

std::shared_ptr<const Model> box_model() {
  Model::Level level;
  level.mesh = make_box({2, 2, 2});
  level.tree = TriangleTree(level.mesh);
  std::vector<Model::Level> levels;
  levels.push_back(std::move(level));
  return std::make_shared<const Model>("box", std::move(levels));
}

std::vector<Instance> random_instances(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<Instance> out;
  for (int n = 0; n < count; ++n) {
    Instance i;
    i.position_m = glm::dvec3(3.4e6, 0, 0) + 1000.0 * glm::dvec3(any(random), any(random), any(random));
    i.rotation = glm::normalize(glm::quat(static_cast<float>(any(random)), static_cast<float>(any(random)),
                                          static_cast<float>(any(random)), static_cast<float>(any(random))));
    i.scale = static_cast<float>(2 + any(random));
    i.is_mirrored = n % 3 == 0;
    out.push_back(i);
  }
  return out;
}

TEST(Scene, BallsHoldTheirCorners) {
  const auto model = box_model();
  const Scene scene({model}, random_instances(200, 1));
  for (std::uint32_t n = 0; n < scene.size(); ++n) {
    const Instance i = scene.instance(n);
    const SceneBall ball = scene.ball(n);
    for (glm::dvec3 p : model->levels()[0].mesh.positions_m) {
      if (i.is_mirrored) p.x = -p.x;
      const glm::dvec3 at = i.position_m + static_cast<double>(i.scale) * (glm::dquat(i.rotation) * p);
      EXPECT_LE(glm::distance(at, ball.centre_m), ball.radius_m);
    }
  }
}

TEST(Scene, VisitsExactlyWhatABallMeets) {
  const Scene scene({box_model()}, random_instances(500, 2));
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1000, 1000);
  for (int n = 0; n < 50; ++n) {
    const glm::dvec3 centre = glm::dvec3(3.4e6, 0, 0) + glm::dvec3(any(random), any(random), any(random));
    const double radius_m = 200;
    std::vector<std::uint32_t> visited;
    scene.visit([&](const SceneBall& b) { return glm::distance(b.centre_m, centre) <= b.radius_m + radius_m; },
                [&](std::uint32_t i) { visited.push_back(i); });
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < scene.size(); ++i) {
      const SceneBall b = scene.ball(i);
      if (glm::distance(b.centre_m, centre) <= b.radius_m + radius_m) expected.push_back(i);
    }
    EXPECT_EQ(visited, expected);
  }
}

// Of boxes in closed form: the distance of a place from an oriented box.
TEST(Scene, TheClearDistanceIsThatOfTheNearestBox) {
  const auto model = box_model();
  const Scene scene({model}, random_instances(500, 5));
  const glm::dvec3 low_m(-1, -1, 0);  // of the model, which stands on z = 0
  const glm::dvec3 high_m(1, 1, 2);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> any(-1500, 1500);
  for (int n = 0; n < 200; ++n) {
    const glm::dvec3 place_m = glm::dvec3(3.4e6, 0, 0) + glm::dvec3(any(random), any(random), any(random));
    double nearest_m = 1e9;
    for (std::uint32_t k = 0; k < scene.size(); ++k) {
      const Instance i = scene.instance(k);
      glm::dvec3 place =
          glm::inverse(glm::dquat(i.rotation)) * (place_m - i.position_m) / static_cast<double>(i.scale);
      if (i.is_mirrored) place.x = -place.x;
      const glm::dvec3 outside = glm::max(glm::max(low_m - place, place - high_m), glm::dvec3(0));
      nearest_m = std::min(nearest_m, static_cast<double>(i.scale) * glm::length(outside));
    }
    const double clear_m = scene.clear_distance_m(place_m, 0);
    EXPECT_LE(clear_m, nearest_m);
    EXPECT_GE(clear_m, nearest_m * 0.99 - 0.01);
    // A box has one level, of error 0.
    EXPECT_EQ(scene.clear_distance_m(place_m, 0.1), clear_m);
  }
  EXPECT_EQ(Scene().clear_distance_m({0, 0, 0}, 0.5), std::numeric_limits<double>::infinity());
}

TEST(Scene, TheClearDistanceHoldsForCoarserLevels) {
  const auto model = std::make_shared<const Model>("rock", make_levels(make_rock(3, 4)));
  ASSERT_GT(model->levels().size(), 1U);
  const Scene scene({model}, random_instances(50, 8));
  std::mt19937 random(9);
  std::uniform_real_distribution<double> any(-1200, 1200);
  constexpr double kShare = 0.02;
  for (int n = 0; n < 100; ++n) {
    const glm::dvec3 place_m = glm::dvec3(3.4e6, 0, 0) + glm::dvec3(any(random), any(random), any(random));
    double nearest_m = 1e9;
    for (std::uint32_t k = 0; k < scene.size(); ++k) {
      const Instance i = scene.instance(k);
      const auto scale = static_cast<double>(i.scale);
      const SceneBall ball = scene.ball(k);
      const double to_ball_m = std::max(glm::distance(place_m, ball.centre_m) - ball.radius_m, 0.0);
      const Mesh& mesh = model->levels()[model->level_within(kShare * to_ball_m / scale)].mesh;
      for (glm::dvec3 p : mesh.positions_m) {
        if (i.is_mirrored) p.x = -p.x;
        nearest_m =
            std::min(nearest_m, glm::distance(place_m, i.position_m + scale * (glm::dquat(i.rotation) * p)));
      }
    }
    EXPECT_LE(scene.clear_distance_m(place_m, kShare), nearest_m);
    EXPECT_GT(scene.clear_distance_m(place_m, kShare), 0.9 * nearest_m - 5);
  }
}

TEST(Scene, OrderOfInstancesDoesNotMatter) {
  std::vector<Instance> instances = random_instances(300, 3);
  instances.push_back(instances.front());  // twins, too
  const auto model = box_model();
  const Scene one({model}, instances);
  std::shuffle(instances.begin(), instances.end(), std::mt19937(9));
  const Scene other({model}, instances);
  ASSERT_EQ(one.size(), other.size());
  for (std::uint32_t n = 0; n < one.size(); ++n) EXPECT_EQ(one.instance(n), other.instance(n)) << n;
  EXPECT_EQ(one.ball().radius_m, other.ball().radius_m);
}

TEST(Scene, AReplicaTakesAtMost64Bytes) {
  const Scene scene({box_model()}, random_instances(10'000, 5));
  EXPECT_LE(scene.bytes(), 10'000 * kMostBytesOfInstance);
}

TEST(Scene, WhatCannotStandIsRefused) {
  const auto model = box_model();
  std::vector<Instance> one = random_instances(1, 6);
  auto wrong = one;
  wrong[0].model = 1;
  EXPECT_THROW(Scene({model}, wrong), std::invalid_argument);
  wrong = one;
  wrong[0].name = 1;
  EXPECT_THROW(Scene({model}, wrong), std::invalid_argument);
  wrong = one;
  wrong[0].position_m.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Scene({model}, wrong), std::invalid_argument);
  wrong = one;
  wrong[0].scale = 0;
  EXPECT_THROW(Scene({model}, wrong), std::invalid_argument);
  EXPECT_THROW(Scene({nullptr}, one), std::invalid_argument);
  EXPECT_THROW(Scene({model}, one, {"x"}), std::invalid_argument);
  EXPECT_TRUE(Scene().is_empty());
  EXPECT_NO_THROW(Scene({model}, {}));
}

}  // namespace
}  // namespace objects
