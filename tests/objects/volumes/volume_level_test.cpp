// Fields of extinction in bricks, their coarser levels, and rays through them against closed forms and plain sums.
#include "objects/volumes/volume_level.h"

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <limits>
#include <stdexcept>

#include "objects/volumes/volume_march.h"
#include "tests/objects/volumes/volume_shapes.h"

namespace objects {
namespace {

constexpr double kEnd = 1e6;

TEST(VolumeLevelTest, KeepsValuesWithinHalfAUnit) {
  DenseVolume dense({{5, 4, 13}, 2, {1, 2, 3}});
  std::mt19937 random(3);
  for (float& v : dense.values()) v = static_cast<float>(random() % 1000) / 1000;
  dense.at(2, 2, 2) = 1;
  const VolumeLevel level = build_level(dense);
  EXPECT_EQ(check(level), "");
  EXPECT_EQ(level.lattice.posts, (std::array<int, 3>{7, 6, 15}));
  EXPECT_EQ(post_count(level.lattice), 630U);
  EXPECT_EQ(level.places.size(), place_count(level.lattice));
  for (int z = 0; z < 13; ++z) {
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 5; ++x) {
        const glm::dvec3 place_m = glm::dvec3(1, 2, 3) + 2.0 * glm::dvec3(x, y, z);
        EXPECT_NEAR(extinction_per_m(level, place_m), static_cast<double>(dense.at(x, y, z)), 0.5 / 255 + 1e-6);
      }
    }
  }
  // Half way between two posts lies their mean; beyond a spacing from the last post there is nothing.
  EXPECT_NEAR(extinction_per_m(level, {6, 6, 7}),
              0.5 * (extinction_per_m(level, {5, 6, 7}) + extinction_per_m(level, {7, 6, 7})), 1e-9);
  EXPECT_EQ(extinction_per_m(level, {-1.001, 4, 5}), 0);
  EXPECT_EQ(extinction_per_m(level, {5, 4, 29.001}), 0);
}

TEST(VolumeLevelTest, StoresNoEmptyBricks) {
  DenseVolume dense({{200, 200, 200}, 1, {0, 0, 0}});
  dense.at(100, 100, 100) = 1;
  dense.at(20, 20, 20) = std::numeric_limits<float>::quiet_NaN();
  dense.at(60, 20, 20) = -1;
  const VolumeLevel level = build_level(dense);
  EXPECT_LE(level.posts.size() / VolumeLevel::kBrickPosts, 8U);
  EXPECT_GE(level.posts.size() / VolumeLevel::kBrickPosts, 1U);
  EXPECT_EQ(extinction_per_m(level, {60, 20, 20}), 0);
  EXPECT_NEAR(extinction_per_m(level, {100, 100, 100}), 1, 1e-6);
  EXPECT_GT(level.bytes(), level.posts.size());
}

TEST(VolumeLevelTest, RefusesWhatExceedsTheLimits) {
  EXPECT_THROW(DenseVolume({{1, 4, 4}, 1, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(DenseVolume({{4, 4, 5000}, 1, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(DenseVolume({{2000, 2000, 2000}, 1, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(DenseVolume({{4, 4, 4}, 0, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(DenseVolume({{4, 4, 4}, std::numeric_limits<float>::quiet_NaN(), {0, 0, 0}}),
               std::invalid_argument);
  EXPECT_THROW(DenseVolume({{4, 4, 4}, 1, {0, 1e9F, 0}}), std::invalid_argument);
  DenseVolume bright({{4, 4, 4}, 1, {0, 0, 0}});
  bright.at(1, 1, 1) = 2e6F;
  EXPECT_THROW(build_level(bright), std::invalid_argument);
}

TEST(VolumeLevelTest, CheckFindsFaults) {
  const VolumeLevel good = chance_level(1);
  ASSERT_EQ(check(good), "");
  const auto with = [&](const auto& change) {
    VolumeLevel level = good;
    change(level);
    return check(level);
  };
  EXPECT_NE(with([](VolumeLevel& l) { l.places.pop_back(); }), "");
  EXPECT_NE(with([](VolumeLevel& l) { l.posts.pop_back(); }), "");
  EXPECT_NE(with([](VolumeLevel& l) { l.posts.resize(l.posts.size() - VolumeLevel::kBrickPosts); }), "");
  EXPECT_NE(with([](VolumeLevel& l) { l.places.back() = 1000; }), "");
  EXPECT_NE(with([](VolumeLevel& l) { l.unit_per_m = -1; }), "");
  EXPECT_NE(with([](VolumeLevel& l) { l.unit_per_m = std::numeric_limits<float>::infinity(); }), "");
  EXPECT_NE(with([](VolumeLevel& l) { l.lattice.spacing_m = 0; }), "");
  EXPECT_NE(with([](VolumeLevel& l) { l.lattice.posts[1] = 1; }), "");
}

// The sum of extinction stays at each level, and so do its middle and the depth across a slab.
TEST(VolumeLevelTest, CoarserLevelsKeepTheSum) {
  for (const VolumeLevel& finest :
       {chance_level(2), ball_level(5, 0.4F, 40), slab_level(40, 40, 30, 0.5F, 0.2F)}) {
    VolumeLevel level = finest;
    for (int n = 0; n < 3; ++n) {
      const VolumeLevel coarser = halved(level);
      EXPECT_EQ(check(coarser), "");
      EXPECT_FLOAT_EQ(coarser.lattice.spacing_m, 2 * level.lattice.spacing_m);
      EXPECT_NEAR(mass_m2(coarser), mass_m2(finest), 0.02 * mass_m2(finest)) << n;
      level = coarser;
    }
  }
  const VolumeLevel slab = halved(halved(slab_level(120, 120, 30, 0.5F, 0.2F)));
  EXPECT_NEAR(optical_depth(slab, {{0.3, 0.2, -30}, {0, 0, 1}}, 0, kEnd), 30 * 0.5 * 0.2, 0.01);
}

// A ray meets n * spacing * extinction, divided by the cosine of its angle with the normal.
TEST(VolumeMarch, ASlabDimsByBeerAndLambertsLaw) {
  for (const float extinction : {0.01F, 0.05F, 0.3F}) {
    const VolumeLevel slab = slab_level(400, 400, 20, 0.5F, extinction);
    for (const double tilt_deg : {0.0, 10.0, 45.0, 70.0}) {
      const double tilt = tilt_deg * 0.0174532925;
      for (const double length : {1.0, 0.25, 7.0}) {
        const glm::dvec3 d(std::sin(tilt) * 0.6, std::sin(tilt) * 0.8, -std::cos(tilt));
        const glm::dvec3 from = glm::dvec3(0.13, -0.21, 5) - 40.0 * d;
        const double depth = optical_depth(slab, {from, length * d}, 0, kEnd);
        const double expected = 20 * 0.5 * static_cast<double>(extinction) / std::cos(tilt);
        EXPECT_NEAR(depth, expected, 1e-5 * expected) << tilt_deg << " " << length;
        EXPECT_NEAR(std::exp(-depth), std::exp(-expected), 1e-3);
      }
    }
  }
}

// The chord of a ball, but for a spacing at its edge.
TEST(VolumeMarch, ABallHasTheDepthOfItsChords) {
  constexpr double kRadius_m = 6;
  constexpr double kExtinction = 0.25;
  const VolumeLevel ball = ball_level(6, 0.25F, 89);
  EXPECT_NEAR(mass_m2(ball), 4.0 / 3 * 3.14159265 * 216 * kExtinction, 0.002 * 226);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int n = 0; n < 300; ++n) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(any(random), any(random), any(random)));
    const glm::dvec3 through = 3.0 * glm::dvec3(any(random), any(random), any(random));
    const double beside2 = glm::dot(through, through) - std::pow(glm::dot(through, d), 2);
    if (beside2 > 25) continue;
    const double chord = 2 * std::sqrt(kRadius_m * kRadius_m - beside2);
    EXPECT_NEAR(optical_depth(ball, {through - 50.0 * d, d}, 0, kEnd), chord * kExtinction,
                kExtinction * static_cast<double>(ball.lattice.spacing_m) * 0.5);
  }
}

// Simpson's rule in each cell equals a sum over many small steps.
TEST(VolumeMarch, EqualsAPlainSum) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  int met = 0;
  for (int n = 0; n < 120; ++n) {
    const VolumeLevel level = chance_level(static_cast<std::uint32_t>(n % 6));
    glm::dvec3 d(any(random), any(random), any(random));
    if (n % 5 == 0) d[n % 3] = 0;  // along a plane of the lattice
    if (n % 15 == 0) d = {0, 0, n % 2 == 0 ? 1 : -1};
    const glm::dvec3 middle_m = glm::dvec3(2, 6, 3) + 2.0 * glm::dvec3(any(random), any(random), any(random));
    const VolumeRay ray{n % 10 == 0 ? glm::floor(middle_m) - 10.0 * d : middle_m - 10.0 * d, d};
    constexpr int kSteps = 40000;
    double sum = 0;
    for (int k = 0; k < kSteps; ++k)
      sum += extinction_per_m(level, ray.origin_m + 20.0 * (k + 0.5) / kSteps * d);
    sum *= 20.0 / kSteps * glm::length(d);
    EXPECT_NEAR(optical_depth(level, ray, 0, 20), sum, 1e-4 + 2e-4 * sum) << n;
    met += sum > 0 ? 1 : 0;
    // Parts of a ray sum up, and it is the same from the other end.
    const double whole = optical_depth(level, ray, 0, 20);
    EXPECT_NEAR(optical_depth(level, ray, 0, 9.7) + optical_depth(level, ray, 9.7, 20), whole,
                1e-5 * (1 + whole));
    EXPECT_NEAR(optical_depth(level, {ray.origin_m + 20.0 * d, -d}, 0, 20), whole, 1e-5 * (1 + whole));
  }
  EXPECT_GT(met, 60);
}

TEST(VolumeMarch, StepsAscendAndEndWhenAsked) {
  const VolumeLevel level = ball_level(4, 1, 30);
  double before = 0;
  int steps = 0;
  march(level, {{0.1, 0.2, -9}, {0.1, 0.05, 1}}, 0, kEnd, [&](const VolumeStep& step) {
    EXPECT_GE(step.begin, before);
    EXPECT_GT(step.end, step.begin);
    EXPECT_GT(step.depth, 0);
    before = step.end;
    ++steps;
    return true;
  });
  EXPECT_GT(steps, 20);
  int seen = 0;
  march(level, {{0.1, 0.2, -9}, {0.1, 0.05, 1}}, 0, kEnd, [&](const VolumeStep&) { return ++seen < 3; });
  EXPECT_EQ(seen, 3);
  // Nothing is met beside it, behind it or within nothing.
  EXPECT_EQ(optical_depth(level, {{9, 0, -9}, {0, 0, 1}}, 0, kEnd), 0);
  EXPECT_EQ(optical_depth(level, {{0, 0, -9}, {0, 0, -1}}, 0, kEnd), 0);
  EXPECT_EQ(optical_depth(level, {{0, 0, -9}, {0, 0, 1}}, 5, 5), 0);
}

TEST(VolumeModelTest, HasABallAroundAllLevels) {
  const VolumeModel model(ball_level(7, 0.5F, 64), {10, 20, 30, 0});
  ASSERT_GE(model.levels().size(), 2U);
  const Ball& ball = model.ball();
  EXPECT_LT(glm::length(ball.centre_m), 0.3F);
  EXPECT_GT(ball.radius_m, 7);
  EXPECT_LT(ball.radius_m, 9.5F);
  EXPECT_EQ(model.colour(), (Rgba{10, 20, 30, 255}));
  EXPECT_EQ(model.level_error_m(0), 0);
  for (std::size_t n = 1; n < model.levels().size(); ++n)
    EXPECT_EQ(model.level_error_m(n), static_cast<double>(model.levels()[n].lattice.spacing_m));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const VolumeLevel& level : model.levels()) {
    for (int n = 0; n < 2000; ++n) {
      const glm::dvec3 place_m = 13.0 * glm::dvec3(any(random), any(random), any(random));
      if (glm::distance(place_m, glm::dvec3(ball.centre_m)) > static_cast<double>(ball.radius_m)) {
        EXPECT_EQ(extinction_per_m(level, place_m), 0);
      }
      if (&level != &model.levels().front()) continue;
      for (int k = 0; k < 3; ++k) {
        if (place_m[k] < static_cast<double>(model.low_m()[k]) ||
            place_m[k] > static_cast<double>(model.high_m()[k])) {
          EXPECT_EQ(extinction_per_m(level, place_m), 0);
        }
      }
    }
  }
  // A ball of depth 7 is a disc that hides nearly all.
  EXPECT_NEAR(model.look().silhouette_m2, 3.14159 * 49, 40);
  EXPECT_GT(model.look().opacity, 0.7);
  EXPECT_GT(model.bytes(), model.levels()[0].bytes());
  EXPECT_THROW(VolumeModel(build_level(DenseVolume({{4, 4, 4}, 1, {0, 0, 0}})), {}), std::invalid_argument);
  EXPECT_THROW(VolumeModel(VolumeLevel(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace objects
