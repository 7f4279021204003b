// Objects in images, against closed forms: ranges, silhouettes, order.
#include <gtest/gtest.h>

#include <array>
#include <glm/ext/matrix_transform.hpp>
#include <random>

#include "tests/objects/composer_fixture.h"

namespace objects {
namespace {

// A ball of many triangles lies within its sagitta of the sphere.
TEST(Composer, ABallHasTheRangesOfASphere) {
  for (const core::Projection projection :
       {core::Projection::kPerspective, core::Projection::kCylinder, core::Projection::kEquirectangular}) {
    core::DrawRequest r = request_at();
    r.view.projection = projection;
    if (projection != core::Projection::kPerspective) r.view.width = 700;
    const Instance i = instance_before(r, {3, -2, 20});
    const Scene scene({model_of(make_ellipsoid({4, 4, 4}, 200))}, {i});
    core::Frame frame = paper_frame(r);
    const ComposedObjects drawn = draw(scene, r, frame);
    EXPECT_EQ(drawn.objects, 1);
    EXPECT_EQ(drawn.screen_space_error_px, 0);
    std::int64_t inside = 0;
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        const glm::dvec3 d = ray_at(r, x, y);
        const glm::dvec3 to = i.position_m - r.view.camera.position_m;
        const double middle = glm::dot(to, d);
        const double across = glm::length(to - middle * d);
        const auto range_m = static_cast<double>(frame.range_m[at(frame, x, y)]);
        if (middle > 0 && across < 3.9) {
          ++inside;
          EXPECT_NEAR(range_m, middle - std::sqrt(16 - across * across), 0.01) << x << " " << y;
          EXPECT_NE(frame.colour[at(frame, x, y)], kPaper);
        } else if (across > 4.0001 || middle <= 0) {
          EXPECT_TRUE(std::isinf(range_m)) << x << " " << y;
          EXPECT_EQ(frame.colour[at(frame, x, y)], kPaper);
        }
      }
    }
    EXPECT_GT(inside, 500);
    EXPECT_GE(drawn.pixels, inside);
  }
}

TEST(Composer, GroundHidesObjectsAndTheyHideIt) {
  core::DrawRequest r = request_at();
  const Scene scene({model_of(make_box({4, 1, 4}))}, {instance_before(r, {0, -2, 10})});
  core::Frame frame = paper_frame(r);
  std::fill(frame.range_m.begin(), frame.range_m.end(), 9.0F);
  draw(scene, r, frame);
  for (std::size_t n = 0; n < frame.colour.size(); ++n) {
    EXPECT_EQ(frame.colour[n], kPaper);
    EXPECT_EQ(frame.range_m[n], 9.0F);
  }
  std::fill(frame.range_m.begin(), frame.range_m.end(), 12.0F);
  draw(scene, r, frame);
  EXPECT_NEAR(frame.range_m[at(frame, 100, 80)], 9.5, 0.01);
  EXPECT_EQ(frame.range_m[at(frame, 2, 2)], 12.0F);
}

TEST(Composer, OneSidedTrianglesAreHiddenFromBehindAlsoWhenMirrored) {
  core::DrawRequest r = request_at();
  r.view.camera.axes.up = {1, 0, 0};
  Mesh box = make_box({40, 40, 40});
  box.material_table = {{{255, 255, 255, 255}, -1, AlphaMode::kOpaque, 128, false}};
  const auto model = model_of(std::move(box));
  for (const bool mirrored : {false, true}) {
    Instance around = instance_before(r, {0, -20, 0});  // the camera is in it
    around.is_mirrored = mirrored;
    core::Frame frame = paper_frame(r);
    draw(Scene({model}, {around}), r, frame);
    EXPECT_EQ(frame.colour[at(frame, 100, 80)], kPaper);
    Instance before = instance_before(r, {0, -20, 40});
    before.is_mirrored = mirrored;
    frame = paper_frame(r);
    draw(Scene({model}, {before}), r, frame);
    EXPECT_NE(frame.colour[at(frame, 100, 80)], kPaper);
  }
}

TEST(Composer, MirroringSwapsLeftAndRight) {
  core::DrawRequest r = request_at();
  Mesh shape = make_box({0.5F, 0.5F, 4});
  append(shape, make_box({2, 0.5F, 0.5F}), glm::translate(glm::mat4(1), glm::vec3(1.2F, 0, 2)),
         {200, 0, 0, 255});
  const auto model = model_of(std::move(shape));
  std::array<core::Frame, 2> frames;
  for (std::size_t k = 0; k < 2; ++k) {
    Instance i = instance_before(r, {0, -2, 10});
    i.is_mirrored = k == 1;
    frames[k] = paper_frame(r);
    draw(Scene({model}, {i}), r, frames[k]);
  }
  int different = 0;
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x)
      different += frames[0].colour[at(frames[0], x, y)] == frames[1].colour[at(frames[1], 199 - x, y)] ? 0 : 1;
  }
  EXPECT_LE(different, 20);  // pixel centres on an outline
  EXPECT_NE(frames[0].colour[at(frames[0], 130, 76)], kPaper);
  EXPECT_EQ(frames[1].colour[at(frames[1], 130, 76)], kPaper);
}

std::vector<Instance> crowd(const core::DrawRequest& r, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<Instance> out;
  for (int n = 0; n < count; ++n) {
    Instance i = instance_before(r, {30 * any(random), 20 * any(random), 60 + 55 * any(random)});
    i.rotation = glm::normalize(glm::quat(static_cast<float>(any(random)), static_cast<float>(any(random)),
                                          static_cast<float>(any(random)), static_cast<float>(any(random))));
    i.scale = static_cast<float>(2 + any(random));
    i.model = static_cast<std::uint32_t>(n % 3);
    out.push_back(i);
  }
  return out;
}

Scene::Models three_models() {
  Mesh glass = make_box({1, 1, 1});
  glass.material_table = {{{80, 160, 240, 120}, -1, AlphaMode::kBlend}};
  std::fill(glass.materials.begin(), glass.materials.end(), std::uint16_t{0});
  return {model_of(make_rock(3, 2)), model_of(make_torus(1, 0.3F, 24, 12)), model_of(std::move(glass))};
}

TEST(Composer, OrderAndThreadsChangeNoBit) {
  core::DrawRequest r = request_at();
  r.settings.mode = core::Mode::kTextured;
  r.settings.smooth_edges = true;
  std::vector<Instance> instances = crowd(r, 300, 8);
  const Scene::Models models = three_models();
  core::Frame first = paper_frame(r);
  const ComposedObjects drawn = draw(Scene(models, instances), r, first);
  EXPECT_GT(drawn.objects, 100);
  std::shuffle(instances.begin(), instances.end(), std::mt19937(1));
  core::Frame second = paper_frame(r);
  const ComposedObjects again = draw(Scene(models, instances), r, second, nullptr, 5);
  EXPECT_EQ(first.colour, second.colour);
  EXPECT_EQ(first.range_m, second.range_m);
  EXPECT_EQ(drawn.objects, again.objects);
  EXPECT_EQ(drawn.pixels, again.pixels);
}

// 10^8 m from the centre the image is that of a scene near it: nothing shakes.
TEST(Composer, FarFromThePlanetNothingShakes) {
  core::DrawRequest near = request_at();
  core::DrawRequest far = near;
  const glm::dvec3 shift(std::ldexp(1.0, 27), std::ldexp(3.0, 24), -std::ldexp(1.0, 26));
  far.view.camera.position_m += shift;
  const std::vector<Instance> here = crowd(near, 100, 4);
  std::vector<Instance> there = here;
  for (Instance& i : there) i.position_m += shift;
  const Scene::Models models = three_models();
  core::Frame a = paper_frame(near);
  core::Frame b = paper_frame(far);
  draw(Scene(models, here), near, a);
  draw(Scene(models, there), far, b);
  int different = 0;
  double worst = 0;
  for (std::size_t n = 0; n < a.colour.size(); ++n) {
    if (std::isinf(a.range_m[n]) != std::isinf(b.range_m[n])) {
      ++different;
    } else if (!std::isinf(a.range_m[n]) && std::abs(a.range_m[n] - b.range_m[n]) < 0.5F) {
      worst = std::max(worst, static_cast<double>(std::abs(a.range_m[n] - b.range_m[n])));
    }
  }
  EXPECT_LE(different, 3);
  EXPECT_LT(worst, 2e-3);  // on surfaces that are nearly edge-on
}

TEST(Composer, WhatIsNotWantedStays) {
  core::DrawRequest r = request_at();
  const Scene scene({model_of(make_box({4, 1, 4}))}, {instance_before(r, {0, -2, 10})});
  core::Frame all = paper_frame(r);
  draw(scene, r, all);
  std::vector<std::uint8_t> only(all.colour.size(), 0);
  for (std::size_t n = 0; n < only.size(); n += 3) only[n] = 1;
  core::Frame some = paper_frame(r);
  draw(scene, r, some, nullptr, 1, only);
  for (std::size_t n = 0; n < only.size(); ++n) {
    EXPECT_EQ(some.colour[n], only[n] != 0 ? all.colour[n] : kPaper);
    EXPECT_EQ(some.range_m[n], only[n] != 0 ? all.range_m[n] : core::kSkyRange);
  }
}

TEST(Composer, AnEmptySceneChangesNothing) {
  core::DrawRequest r = request_at();
  core::Frame frame = paper_frame(r);
  const core::Frame before = frame;
  EXPECT_EQ(draw(Scene(), r, frame).objects, 0);
  EXPECT_EQ(frame.colour, before.colour);
}

}  // namespace
}  // namespace objects
