// Small objects, edges and levels of detail in images.
#include <gtest/gtest.h>

#include <glm/ext/scalar_constants.hpp>

#include "tests/objects/composer_fixture.h"

namespace objects {
namespace {

// The sum of what a small ball covers is its area, wherever it lies between pixels.
TEST(Composer, SmallObjectsCoverTheirArea) {
  core::DrawRequest r = request_at();
  r.settings.lod_tolerance_px = 1;
  Mesh ball = make_ellipsoid({1, 1, 1}, 40);
  ball.material_table = {{{255, 255, 255, 255}}};
  const auto model = model_of(std::move(ball));
  const double f = core::focal_px(r.view);
  for (const double diameter_px : {1.0, 1.2, 1.49, 1.6, 2.5}) {
    const double distance_m = 2 * f * core::corner_stretch(r.view) / diameter_px;
    for (const double shift : {0.0, 0.3, 0.77}) {
      core::Frame frame = paper_frame(r);
      std::fill(frame.colour.begin(), frame.colour.end(), Rgb{0, 0, 0});
      r.settings.smooth_edges = true;
      draw(Scene({model},
                 {instance_before(r, {shift * distance_m / f, 0.4 * shift * distance_m / f, distance_m})}),
           r, frame);
      double sum = 0;
      for (const Rgb& c : frame.colour) sum += c.r / 255.0;
      const double area = glm::pi<double>() * f * f / (distance_m * distance_m);
      EXPECT_NEAR(sum, area,
                  diameter_px < kSmoothRayDiameter_px * core::corner_stretch(r.view) ? 0.02 : 0.3 * area)
          << diameter_px << " " << shift;
    }
  }
}

TEST(Composer, NothingVanishesAboveHalfAPixel) {
  core::DrawRequest r = request_at();
  r.settings.lod_tolerance_px = 1;
  r.settings.smooth_edges = true;
  Mesh ball = make_ellipsoid({1, 1, 1}, 12);
  ball.material_table = {{{255, 255, 255, 255}}};
  const auto model = model_of(std::move(ball));
  const double per_px = core::focal_px(r.view) * core::corner_stretch(r.view);
  double before = 0;
  for (double diameter_px = 0.4; diameter_px < 3; diameter_px *= 1.03) {
    core::Frame frame = paper_frame(r);
    std::fill(frame.colour.begin(), frame.colour.end(), Rgb{0, 0, 0});
    draw(Scene({model}, {instance_before(r, {0.1, 0.2, 2 * per_px / diameter_px})}), r, frame);
    double sum = 0;
    for (const Rgb& c : frame.colour) sum += c.r / 255.0;
    if (diameter_px < 0.49) {
      EXPECT_EQ(sum, 0);
    }
    if (diameter_px >= kLeastDiameter_px) {
      EXPECT_GT(sum, 0) << diameter_px;
    }
    EXPECT_LT(std::abs(sum - before), 0.5) << diameter_px;  // of a pixel: no jump
    before = sum;
  }
}

// Edges show the share of a pixel that is covered, to a sixth.
TEST(Composer, EdgesAreSmooth) {
  core::DrawRequest r = request_at();
  Mesh ball = make_ellipsoid({1, 1, 1}, 100);
  ball.material_table = {{{255, 255, 255, 255}}};
  const Scene scene({model_of(std::move(ball))}, {instance_before(r, {0, 0, 10})});
  core::Frame hard = paper_frame(r);
  std::fill(hard.colour.begin(), hard.colour.end(), Rgb{0, 0, 0});
  core::Frame smooth = hard;
  draw(scene, r, hard);
  r.settings.smooth_edges = true;
  draw(scene, r, smooth);
  const double f = core::focal_px(r.view);
  const double radius_px = f / std::sqrt(100 - 1);
  double worst = 0;
  int between = 0;
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      int covered = 0;
      for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 16; ++i)
          covered += std::hypot(x + (i + 0.5) / 16 - 100, y + (j + 0.5) / 16 - 80) < radius_px ? 1 : 0;
      }
      const double share = smooth.colour[at(smooth, x, y)].r / 255.0;
      worst = std::max(worst, std::abs(share - covered / 256.0));
      between += share > 0 && share < 1 ? 1 : 0;
    }
  }
  EXPECT_LT(worst, 0.17);
  EXPECT_GT(between, 60);
  EXPECT_EQ(std::count_if(hard.colour.begin(), hard.colour.end(),
                          [](const Rgb& c) { return c.r != 0 && c.r != 255; }),
            0);
}

// Coarse levels are drawn within the tolerance, which the result states.
TEST(Composer, LevelsKeepToTheTolerance) {
  core::DrawRequest r = request_at();
  const auto model = std::make_shared<const Model>("ball", make_levels(make_ellipsoid({1, 1, 1}, 80)));
  ASSERT_GT(model->levels().size(), 2U);
  for (const double tolerance : {0.1, 0.5, 2.0}) {
    r.settings.lod_tolerance_px = tolerance;
    const Instance i = instance_before(r, {0.5, -0.2, 30});
    core::Frame frame = paper_frame(r);
    const ComposedObjects drawn = draw(Scene({model}, {i}), r, frame);
    EXPECT_LE(drawn.screen_space_error_px, tolerance);
    EXPECT_GT(drawn.screen_space_error_px, 0);
    core::DrawRequest fine = r;
    fine.settings.lod_tolerance_px = 0;
    core::Frame truth = paper_frame(fine);
    draw(Scene({model}, {i}), fine, truth);
    // Pixels that only one shows lie along the outline, no farther in or out than the error.
    int different = 0;
    for (std::size_t n = 0; n < frame.range_m.size(); ++n)
      different += std::isinf(frame.range_m[n]) != std::isinf(truth.range_m[n]) ? 1 : 0;
    const double outline_px = 2 * glm::pi<double>() * core::focal_px(r.view) / 30;
    EXPECT_LE(different, outline_px * (drawn.screen_space_error_px + 0.3));
  }
}

// Beside the image's border a coarse level may not show where the model would.
TEST(Composer, ObjectsThatMayShowCountInTheError) {
  core::DrawRequest r = request_at();
  r.settings.lod_tolerance_px = 2;
  const auto model = std::make_shared<const Model>("ball", make_levels(make_ellipsoid({1, 1, 1}, 80)));
  // Its limb is a third of a pixel beside the border.
  const double f = core::focal_px(r.view);
  const double limb_px = f * std::tan(std::atan((100 + 0.3) / f) + std::asin(1.0 / 30));
  Instance i = instance_before(r, {0, 0, 30});
  i.position_m = r.view.camera.position_m + 30.0 * core::pixel_ray(r.view, 100 - limb_px, 80);
  core::Frame frame = paper_frame(r);
  const ComposedObjects drawn = draw(Scene({model}, {i}), r, frame);
  EXPECT_EQ(drawn.objects, 0);
  EXPECT_GT(drawn.geometric_error_m, 0);
  EXPECT_GT(drawn.screen_space_error_px, 0);
}

TEST(Composer, ADiscTakesTheShapesPlaceOnlyWithinTheTolerance) {
  core::DrawRequest r = request_at();
  for (const bool is_smooth : {true, false}) {
    r.settings.smooth_edges = is_smooth;
    for (const double tolerance : {0.1, 0.3, 0.5, 1.0, 4.0}) {
      r.settings.lod_tolerance_px = tolerance;
      EXPECT_LE(0.5 * level_rule(r, false).least_ray_px, tolerance);
      EXPECT_LE(level_rule(r, false).least_ray_px, is_smooth ? kSmoothRayDiameter_px : kHardRayDiameter_px);
    }
  }
  EXPECT_EQ(level_rule(r, false).least_ray_px, kHardRayDiameter_px);
  EXPECT_EQ(level_rule(r, true).tolerance_px, 0);
}

}  // namespace
}  // namespace objects
