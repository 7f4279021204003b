// Models of sticks in images, beside the triangles that they were made from.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "objects/draw/single_ray.h"
#include "objects/sticks/build_sticks.h"
#include "objects/sticks/voxelise.h"
#include "tests/objects/composer_fixture.h"

namespace objects {
namespace {

core::DrawRequest looking_ahead() {
  core::DrawRequest r = request_at(2);
  r.view.width = 240;
  r.view.height = 220;
  r.view.fov_deg = 40;
  r.settings.mode = core::Mode::kTextured;
  r.sun = glm::normalize(glm::dvec3(1, -0.6, 0.5));
  return r;
}

core::Frame image_of(const std::shared_ptr<const Model>& model, const core::DrawRequest& r,
                     const Instance& instance) {
  core::Frame frame = paper_frame(r);
  vpe::base::ThreadPool pool(2);
  (void)compose(Scene({model}, {instance}), {r, kRadius_m, nullptr}, level_rule(r, false), pool, frame);
  return frame;
}

std::shared_ptr<const Model> sticks_of(const Mesh& mesh, int voxels, bool is_tight = true) {
  return std::make_shared<const Model>(
      "sticks", std::make_shared<const StickModel>(
                    build_sticks(voxelise(mesh, {}, {.voxels_longest = voxels, .is_tight = is_tight}))));
}

// The same silhouette, ranges within a voxel, and nearly the same light.
TEST(ComposerSticks, ShowWhatTheirTrianglesShow) {
  const core::DrawRequest r = looking_ahead();
  Mesh mesh = make_rock(3, 4);
  append(mesh, make_torus(0.4F, 0.12F, 60, 30), glm::mat4(1), {180, 60, 40, 255});
  Instance instance = instance_before(r, {0, -0.4, 2.2});
  instance.scale = 1.3F;
  const auto triangles = std::make_shared<const Model>("mesh", make_levels(mesh));
  const auto sticks = sticks_of(mesh, 512);
  const core::Frame a = image_of(triangles, r, instance);
  const core::Frame b = image_of(sticks, r, instance);
  const double voxel_m =
      static_cast<double>(sticks->sticks()->levels()[0].grid.voxel_m) * static_cast<double>(instance.scale);
  std::int64_t both = 0;
  std::int64_t any = 0;
  std::int64_t far = 0;
  double light = 0;
  for (std::size_t n = 0; n < a.range_m.size(); ++n) {
    const bool in_a = !std::isinf(a.range_m[n]);
    const bool in_b = !std::isinf(b.range_m[n]);
    any += in_a || in_b ? 1 : 0;
    if (!in_a || !in_b) continue;
    ++both;
    far += std::abs(a.range_m[n] - b.range_m[n]) > 2 * static_cast<float>(voxel_m) ? 1 : 0;
    light += std::abs(a.colour[n].g - b.colour[n].g);
  }
  EXPECT_GT(both, 10'000);
  EXPECT_GE(static_cast<double>(both) / static_cast<double>(any), 0.99);
  EXPECT_LT(static_cast<double>(far) / static_cast<double>(both), 0.02);  // where the surface is seen edge-on
  EXPECT_LT(light / static_cast<double>(both), 8);
}

TEST(ComposerSticks, CoarseLevelsKeepToTheTolerance) {
  core::DrawRequest r = looking_ahead();
  const auto sticks = sticks_of(make_ellipsoid({0.5F, 0.5F, 0.5F}, 60), 256);
  r.settings.lod_tolerance_px = 2;
  core::Frame frame = paper_frame(r);
  vpe::base::ThreadPool pool(1);
  const ComposedObjects drawn = compose(Scene({sticks}, {instance_before(r, {0, 0, 8})}),
                                        {r, kRadius_m, nullptr}, level_rule(r, false), pool, frame);
  EXPECT_EQ(drawn.objects, 1);
  EXPECT_GT(drawn.geometric_error_m, 0);
  EXPECT_LE(drawn.screen_space_error_px, 2);
}

// Light through n voxels of opacity a is (1 - a)^n of what is behind (Beer and Lambert).
TEST(ComposerSticks, ASlabOfGlassDimsByBeersLaw) {
  core::DrawRequest r = looking_ahead();
  r.settings.mode = core::Mode::kUnlit;
  VoxelGrid grid({.columns_x = 40, .columns_y = 7, .height = 40, .voxel_m = 0.05F, .corner_m = {-1, 0, -1}});
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 7; ++y) {
      for (int z = 0; z < 40; ++z) grid.set(x, y, z, stick_voxel({255, 255, 255, 40}, {0, 0, 1}));
    }
  }
  const auto slab =
      std::make_shared<const Model>("slab", std::make_shared<const StickModel>(build_sticks(std::move(grid))));
  core::Frame frame = paper_frame(r);
  std::fill(frame.colour.begin(), frame.colour.end(), vpe::base::Rgb{100, 100, 100});
  vpe::base::ThreadPool pool(1);
  (void)compose(Scene({slab}, {instance_before(r, {0, 0, 5})}), {r, kRadius_m, nullptr}, level_rule(r, false),
                pool, frame);
  const glm::dvec3 d = core::pixel_ray(r.view, 121.5, 108.5);
  const double length = 7 / glm::dot(d, r.view.camera.axes.forward);  // voxels
  const double through = std::pow(1 - 40.0 / 255, length);
  EXPECT_NEAR(frame.colour[108 * 240 + 121].g, 255 * (1 - through) + 100 * through, 0.51 + 1e-3 * 255);
}

TEST(ComposerSticks, CastShadowsAndAreMetBySingleRays) {
  const core::DrawRequest r = looking_ahead();
  const auto sticks = sticks_of(make_box({1, 1, 1}), 32, false);
  Instance i = instance_before(r, {0, 0, 5});
  const Scene scene({sticks}, {i});
  const auto seen =
      first_object(scene, {r.view.camera.position_m + 0.2 * r.view.camera.axes.up, {0, 1, 0}}, 100);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->range_m, 4.5, 0.05);
  const ObjectRays rays(scene, level_rule(r, true));
  const SunGrid grid(rays, r.sun);
  const glm::dvec3 middle = i.position_m + 0.5 * r.view.camera.axes.up;
  EXPECT_EQ(grid.light_at(middle - 3.0 * r.sun), 0);
  EXPECT_EQ(grid.light_at(middle + 3.0 * r.sun), 1);
}

TEST(ComposerSticks, AModelKnowsItsLook) {
  const Model ball("ball", std::make_shared<const StickModel>(build_sticks(voxelise(
                               make_ellipsoid({1, 1, 1}, 60), {}, {.voxels_longest = 100, .is_tight = true}))));
  EXPECT_NEAR(ball.mean_silhouette_m2(), 3.1416, 0.1);
  EXPECT_EQ(ball.mean_opacity(), 1);
  EXPECT_NEAR(ball.mean_colour().r, 200, 1);
  EXPECT_NEAR(ball.ball().radius_m, 1.08, 0.09);  // of coarse levels, too
  EXPECT_EQ(ball.level_within(0), 0U);
  EXPECT_GT(ball.level_within(0.5), 0U);
  EXPECT_THROW(Model("none", std::shared_ptr<const StickModel>()), std::invalid_argument);
}

}  // namespace
}  // namespace objects
