// Rays through placed volumes, the order along a ray, and the light in a volume.
#include "objects/draw/volume_rays.h"

#include <gtest/gtest.h>

#include <cmath>

#include "objects/draw/pixel_square.h"
#include "objects/draw/single_ray.h"
#include "objects/draw/volume_light.h"
#include "objects/draw/volume_shader.h"
#include "tests/objects/composer_fixture.h"
#include "tests/objects/volumes/volume_shapes.h"

namespace objects {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// A cube of 10 m about 50 m above a place, of depth 4 along each axis.
struct Cube {
  explicit Cube(float scale = 1, float extinction = 0.4F)
      : scene({volume_model(slab_level(21, 21, 20, 0.5F, extinction))}, {place(scale)}, {"", "cube"}),
        rays(scene, LevelRule{{0, 0, 0}, 1000, 1, 0, 1.5}),
        object(rays.placed(0)) {
    object.by_rays = true;
  }
  static Instance place(float scale) {
    Instance i;
    i.position_m = {0, 0, 50};
    i.scale = scale;
    i.name = 1;
    return i;
  }
  Scene scene;
  ObjectRays rays;
  PlacedObject object;
};

TEST(VolumeRays, CrossTheBallAndTheVolume) {
  const Cube cube;
  ASSERT_NE(cube.object.volume, nullptr);
  EXPECT_EQ(cube.object.level, nullptr);
  const ObjectRay ray{{0.1, 0.2, 0}, {0, 0, 1}};
  const auto crossing = enter_volume(cube.object, *cube.object.volume, ray, kInfinite);
  ASSERT_TRUE(crossing);
  // Its field is 0 from half a metre before and behind its posts on.
  EXPECT_NEAR(crossing->begin_m, 49.5, 1e-6);
  EXPECT_NEAR(crossing->end_m, 60, 1e-6);
  EXPECT_NEAR(optical_depth(*cube.object.volume, crossing->ray, 0, crossing->end_m - crossing->begin_m), 4,
              1e-4);
  EXPECT_NEAR(volume_through(cube.object, ray), std::exp(-4), 1e-3);
  EXPECT_FALSE(enter_volume(cube.object, *cube.object.volume, ray, 40));
  EXPECT_FALSE(enter_volume(cube.object, *cube.object.volume, {{30, 0, 0}, {0, 0, 1}}, kInfinite));
  EXPECT_FALSE(enter_volume(cube.object, *cube.object.volume, {{0, 0, 0}, {0, 0, -1}}, kInfinite));
  EXPECT_EQ(volume_through(cube.object, {{0, 0, 0}, {0, 0, -1}}), 1);
  // The depth of a model does not change with its size.
  const Cube large(3);
  const auto through = enter_volume(large.object, *large.object.volume, ray, kInfinite);
  ASSERT_TRUE(through);
  EXPECT_NEAR(optical_depth(*large.object.volume, through->ray, 0, through->end_m - through->begin_m), 4, 1e-4);
}

TEST(VolumeRays, EnterOnlyTheNamedVolumes) {
  const Cube cube;
  const std::vector<PlacedObject> objects{cube.object};
  std::vector<VolumeCrossing> crossings;
  const ObjectRay ray{{0, 0, 0}, {0, 0, 1}};
  enter_volumes(objects, all_of(objects), ray, kInfinite, crossings);
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_EQ(crossings[0].object, 0U);
  enter_volumes(objects, {}, ray, kInfinite, crossings);
  EXPECT_TRUE(crossings.empty());
  // Rays for surfaces leave them out; light goes through them.
  RayResult seen;
  nearest_object(objects, all_of(objects), ray, kInfinite, 0, seen);
  EXPECT_FALSE(seen.has_front);
  EXPECT_TRUE(seen.layers.empty());
  EXPECT_NEAR(light_through(objects, all_of(objects), ray), std::exp(-4), 1e-3);
  EXPECT_TRUE(has_volumes(cube.scene));
  EXPECT_FALSE(has_volumes(Scene({model_of(make_box({1, 1, 1}))}, {Instance()})));
}

TEST(VolumeRays, SurfacesAndStretchesComeInOrder) {
  RayResult seen;
  for (const double m : {5.0, 12.0, 15.0}) seen.layers.emplace_back().range_m = m;
  seen.front.range_m = 18;
  seen.has_front = true;
  std::vector<VolumeCrossing> crossings(2);
  crossings[0].begin_m = 10;
  crossings[0].end_m = 14;
  crossings[1].begin_m = 13;
  crossings[1].end_m = 30;
  double at_m = 0;
  double alone_m = 0;
  double mixed_m = 0;
  std::vector<double> surfaces;
  in_order(
      seen, crossings,
      [&](const ObjectHit& hit) {
        EXPECT_GE(hit.range_m, at_m);
        at_m = hit.range_m;
        surfaces.push_back(hit.range_m);
        return true;
      },
      [&](const VolumeStretch& s) {
        EXPECT_GE(s.begin_m, at_m - 1e-12);
        at_m = s.end_m;
        (s.crossings.size() == 1 ? alone_m : mixed_m) += s.end_m - s.begin_m;
        return true;
      });
  EXPECT_EQ(surfaces, (std::vector<double>{5, 12, 15, 18}));
  EXPECT_NEAR(alone_m, 3 + 4, 1e-9);
  EXPECT_NEAR(mixed_m, 1, 1e-9);
  // Either ends it.
  int calls = 0;
  in_order(
      seen, crossings, [&](const ObjectHit&) { return ++calls < 2; },
      [&](const VolumeStretch&) { return true; });
  EXPECT_EQ(calls, 2);
  calls = 0;
  in_order(
      seen, crossings, [&](const ObjectHit&) { return true; },
      [&](const VolumeStretch&) { return ++calls < 3; });
  EXPECT_EQ(calls, 3);
}

TEST(VolumeRays, LinesOfSightEndWhereHalfIsHidden) {
  const Cube cube;
  const auto seen = first_object(cube.scene, {{0.1, 0.1, 0}, {0, 0, 1}}, kInfinite);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->instance, 0U);
  EXPECT_NEAR(seen->range_m, 50 + std::log(2) / 0.4 - 0.25, 0.01);
  EXPECT_FALSE(first_object(cube.scene, {{0.1, 0.1, 0}, {0, 0, 1}}, 51));
  EXPECT_FALSE(first_object(Cube(1, 0.05F).scene, {{0.1, 0.1, 0}, {0, 0, 1}}, kInfinite));  // depth 0.5
}

TEST(VolumeLightTest, InterpolatesBetweenItsPosts) {
  VolumeLight light({-2, 0, 1}, {2, 8, 5}, 0.5);
  EXPECT_GE(light.size(), 9U * 17 * 9);
  EXPECT_LE(light.size(), static_cast<std::size_t>(VolumeLight::kMostPosts));
  EXPECT_EQ(light.at({0, 3, 2}), 1);
  const auto field = [](const glm::dvec3& p) {
    return static_cast<float>(0.1 + 0.05 * p.x + 0.03 * p.y + 0.02 * p.z);
  };
  for (std::size_t n = 0; n < light.size(); ++n) light.post(n) = field(light.place_m(n));
  for (const glm::dvec3 p :
       {glm::dvec3(0.1, 3.3, 2.2), glm::dvec3(-2, 0, 1), glm::dvec3(2, 8, 5), glm::dvec3(1.9, 0.1, 4)})
    EXPECT_NEAR(light.at(p), field(p), 1e-5);
  EXPECT_NEAR(light.at({0, 9, 3}), field({0, 8, 3}), 1e-5);
  EXPECT_LE(VolumeLight({0, 0, 0}, {1, 1, 1000}, 1e-9).size(),
            static_cast<std::size_t>(VolumeLight::kMostPosts));
}

TEST(VolumeLightTest, IsWhatTheVolumeLetsThrough) {
  core::DrawRequest r = request_at();
  r.settings.mode = core::Mode::kTextured;
  r.sun = {1, 0, 0};  // up
  const Scene scene({volume_model(slab_level(41, 41, 20, 0.5F, 0.2F))}, {instance_before(r, {0, -5, 30})});
  const ObjectRays rays(scene, level_rule(r, false));
  const SunGrid grid(rays, r.sun);
  vpe::base::ThreadPool pool(2);
  const ImageLight light{r, kRadius_m, nullptr};
  const VolumeLights lights(rays, grid, light, cone_of_view(r.view, ViewRays(r.view)), pool);
  ASSERT_NE(lights.find(0), nullptr);
  EXPECT_EQ(lights.find(1), nullptr);
  EXPECT_EQ(VolumeLights().find(0), nullptr);
  for (const double z : {1.0, 4.0, 8.0})
    EXPECT_NEAR(lights.find(0)->at({0.2, 0.1, z}), std::exp(-0.2 * (9.75 - z)), 0.02) << z;
  EXPECT_EQ(sun_above(light, grid, r.view.camera.position_m), 1);
  r.sun = {-1, 0, 0};
  EXPECT_EQ(sun_above({r, kRadius_m, nullptr}, grid, r.view.camera.position_m), 0);
  // Behind the camera nothing is computed.
  core::DrawRequest back = r;
  back.view.camera.axes.forward = -r.view.camera.axes.forward;
  back.view.camera.axes.right = -r.view.camera.axes.right;
  const ViewCone cone = cone_of_view(back.view, ViewRays(back.view));
  EXPECT_EQ(VolumeLights(rays, grid, light, cone, pool).find(0), nullptr);
}

TEST(VolumeShaderTest, SaysWhichVolumesShow) {
  const core::DrawRequest r = request_at();
  const Scene scene({volume_model(slab_level(41, 41, 20, 0.5F, 0.2F))}, {instance_before(r, {0, -5, 30})});
  const ObjectRays rays(scene, level_rule(r, false));
  const std::vector<PlacedObject> objects{rays.placed(0)};
  const SunGrid grid;
  const VolumeLights lights;
  const ImageLight light{r, kRadius_m, nullptr};
  const ObjectShader surfaces(rays, grid, objects, light);
  VolumeShader shader(surfaces, lights, objects, light);
  const ObjectRay beside{r.view.camera.position_m, {1, 0, 0}};
  EXPECT_EQ(shader.colour(beside, {}, all_of(objects), kInfinite).over.w, 0);
  EXPECT_FALSE(shader.has_shown(0));
  const ObjectRay through{r.view.camera.position_m, {0, 1, 0}};
  EXPECT_NEAR(shader.colour(through, {}, all_of(objects), kInfinite).over.w, 1 - std::exp(-41 * 0.5 * 0.2),
              1e-4);
  EXPECT_TRUE(shader.has_shown(0));
}

}  // namespace
}  // namespace objects
