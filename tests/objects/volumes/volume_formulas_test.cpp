// Dust devils, clouds and plumes by formula.
#include "objects/volumes/volume_formulas.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "objects/volumes/volume_march.h"
#include "objects/volumes/volume_noise.h"
#include "tests/objects/volumes/volume_shapes.h"

namespace objects {
namespace {

std::vector<VolumeFormula> examples() {
  VolumeFormula devil;
  devil.voxels = 64;
  devil.lean_m = 20;
  VolumeFormula cloud = devil;
  cloud.kind = VolumeKind::kCloud;
  cloud.height_m = 60;
  cloud.radius_m = 80;
  cloud.lean_m = 0;
  cloud.optical_depth = 4;
  VolumeFormula plume = devil;
  plume.kind = VolumeKind::kPlume;
  plume.radius_m = 30;
  plume.lean_m = 90;
  plume.optical_depth = 0.3;
  return {devil, cloud, plume};
}

TEST(VolumeFormulas, AreTheSameForTheSameSeed) {
  for (VolumeFormula f : examples()) {
    const VolumeLevel level = level_by_formula(f);
    EXPECT_EQ(level, level_by_formula(f));
    EXPECT_EQ(check(level), "");
    ++f.seed;
    EXPECT_NE(level, level_by_formula(f));
  }
}

TEST(VolumeFormulas, HaveTheStatedOpticalDepth) {
  for (VolumeFormula f : examples()) {
    f.voxels = 96;
    const VolumeLevel level = level_by_formula(f);
    double sum = 0;
    int rays = 0;
    const auto spacing_m = static_cast<double>(level.lattice.spacing_m);
    if (f.kind == VolumeKind::kCloud) {
      for (double y = -0.3 * f.radius_m; y < 0.3 * f.radius_m; y += spacing_m) {
        for (double x = -0.3 * f.radius_m; x < 0.3 * f.radius_m; x += spacing_m) {
          if (std::hypot(x, y) > 0.3 * f.radius_m) continue;
          sum += optical_depth(level, {{x, y, -1}, {0, 0, 1}}, 0, 1e4);
          ++rays;
        }
      }
    } else {
      for (double z = 0.3 * f.height_m; z < 0.7 * f.height_m; z += spacing_m) {
        double largest = 0;
        for (double x = -f.radius_m; x < f.radius_m; x += 0.5 * spacing_m)
          largest = std::max(largest, optical_depth(level, {{x, -1e3, z}, {0, 1, 0}}, 0, 1e4));
        sum += largest;
        ++rays;
      }
    }
    EXPECT_NEAR(sum / rays, f.optical_depth, 0.05 * f.optical_depth) << static_cast<int>(f.kind);
  }
}

// All of it lies in the box of its numbers and in its ball; the sum is finite, and mostly above the ground.
TEST(VolumeFormulas, StayWithinTheirSize) {
  for (const VolumeFormula& f : examples()) {
    const VolumeModel model = volume_by_formula(f);
    EXPECT_EQ(model.colour(), f.colour);
    const auto slack_m = 2 * static_cast<double>(model.levels()[0].lattice.spacing_m);
    const double reach_m = 1.15 * f.radius_m + slack_m;
    EXPECT_GE(static_cast<double>(model.low_m().x), -reach_m);
    EXPECT_LE(static_cast<double>(model.high_m().x), reach_m);
    EXPECT_GE(static_cast<double>(model.low_m().y), -reach_m);
    EXPECT_LE(static_cast<double>(model.high_m().y), reach_m + f.lean_m);
    EXPECT_LE(static_cast<double>(model.high_m().z), f.height_m + slack_m);
    EXPECT_GT(static_cast<double>(model.high_m().z), 0.7 * f.height_m);
    EXPECT_GE(static_cast<double>(model.low_m().z), -0.1 * f.height_m - slack_m);
    const double mass = mass_m2(model.levels()[0]);
    EXPECT_GT(mass, 0);
    EXPECT_LT(mass, 100 * f.optical_depth * f.height_m * (f.radius_m + f.lean_m));
    const Ball& ball = model.ball();
    for (const double side : {-1.0, 1.0}) {
      for (int k = 0; k < 3; ++k) {
        glm::dvec3 place_m(ball.centre_m);
        place_m[k] += side * 1.0001 * static_cast<double>(ball.radius_m);
        EXPECT_EQ(extinction_per_m(model.levels()[0], place_m), 0);
      }
    }
  }
}

TEST(VolumeFormulas, RefuseNumbersOutOfRange) {
  const auto problem = [](const auto& change) {
    VolumeFormula f;
    change(f);
    if (!check(f).empty()) {
      EXPECT_THROW(level_by_formula(f), std::invalid_argument);
    }
    return check(f);
  };
  EXPECT_EQ(check(VolumeFormula()), "");
  EXPECT_NE(problem([](VolumeFormula& f) { f.height_m = 0; }), "");
  EXPECT_NE(problem([](VolumeFormula& f) { f.height_m = std::nan(""); }), "");
  EXPECT_NE(problem([](VolumeFormula& f) { f.radius_m = 2e6; }), "");
  EXPECT_NE(problem([](VolumeFormula& f) { f.radius_m = 0.5; }), "");  // 100 times as high as wide
  EXPECT_NE(problem([](VolumeFormula& f) { f.lean_m = -1; }), "");
  EXPECT_NE(problem([](VolumeFormula& f) { f.optical_depth = 0; }), "");
  EXPECT_NE(problem([](VolumeFormula& f) { f.optical_depth = 101; }), "");
  EXPECT_NE(problem([](VolumeFormula& f) { f.voxels = 15; }), "");
  EXPECT_NE(problem([](VolumeFormula& f) { f.voxels = 257; }), "");
  EXPECT_NE(problem([](VolumeFormula& f) { f.kind = VolumeKind::kCloud, f.lean_m = 5; }), "");
}

// Continuous, within its bounds, and of no preferred sign.
TEST(VolumeNoise, IsSmoothAndBounded) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-40, 40);
  double sum = 0;
  double largest = 0;
  for (int n = 0; n < 5000; ++n) {
    const glm::dvec3 at(any(random), any(random), any(random));
    const double here = volume_noise(7, at);
    EXPECT_LE(std::abs(here), 1);
    EXPECT_LE(std::abs(fractal_noise(7, at, 5)), 1);
    EXPECT_NEAR(volume_noise(7, at + glm::dvec3(1e-6, 0, 0)), here, 1e-5);
    sum += here;
    largest = std::max(largest, std::abs(here));
  }
  EXPECT_LT(std::abs(sum / 5000), 0.03);
  EXPECT_GT(largest, 0.5);
  // Across the sides of the lattice's cubes, too.
  EXPECT_NEAR(volume_noise(7, {3 - 1e-9, 0.4, 0.3}), volume_noise(7, {3 + 1e-9, 0.4, 0.3}), 1e-7);
  EXPECT_NE(volume_noise(7, {0.3, 0.4, 0.3}), volume_noise(8, {0.3, 0.4, 0.3}));
}

}  // namespace
}  // namespace objects
