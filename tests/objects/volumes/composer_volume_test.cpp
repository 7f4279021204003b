// Semi-transparent volumes in images, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "objects/volumes/volume_formulas.h"
#include "tests/objects/composer_fixture.h"
#include "tests/objects/volumes/volume_shapes.h"
#include "vpe/core/appearance/shading.h"

namespace objects {
namespace {

constexpr int kThick = 10;  // posts
constexpr float kPost_m = 0.5F;

// A wall across the view, its middle plane 40 m ahead.
std::shared_ptr<const Model> wall(float extinction, Rgba colour = {255, 255, 255, 255}) {
  return volume_model(slab_level(220, kThick, 220, kPost_m, extinction), colour);
}
Instance wall_before(const core::DrawRequest& r) { return instance_before(r, {0, -55, 40}); }
double wall_depth(float extinction) { return kThick * static_cast<double>(kPost_m * extinction); }

double veiled(double depth, double behind) { return 255 * (1 - std::exp(-depth)) + std::exp(-depth) * behind; }

// Compares a channel of all pixels with what Beer and Lambert's law leaves: each to its rounding, and all together within
// 1e-3.
void expect_law(const core::DrawRequest& r, const core::Frame& frame, double depth, double behind) {
  double sum = 0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const double expected = veiled(depth / ray_at(r, x, y).y, behind);
      const double found = frame.colour[at(frame, x, y)].r;
      ASSERT_NEAR(found, expected, 0.51) << x << " " << y;
      sum += found - expected;
    }
  }
  EXPECT_LT(std::abs(sum) / static_cast<double>(frame.colour.size()), 1e-3 * 255);
}

TEST(ComposerVolume, ASlabDimsByBeerAndLambertsLaw) {
  for (const float extinction : {0.01F, 0.06F, 0.4F}) {
    const core::DrawRequest r = request_at();
    const Scene scene({wall(extinction)}, {wall_before(r)});
    const double depth = wall_depth(extinction);
    // Before the sky and before ground.
    core::Frame frame = paper_frame(r);
    const ComposedObjects drawn = draw(scene, r, frame);
    EXPECT_EQ(drawn.objects, 1);
    EXPECT_EQ(drawn.geometric_error_m, 0);
    expect_law(r, frame, depth, kPaper.r);
    frame = paper_frame(r);
    std::fill(frame.range_m.begin(), frame.range_m.end(), 90.0F);
    draw(scene, r, frame);
    expect_law(r, frame, depth, kPaper.r);
    // Ground in its middle plane, and before it.
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x)
        frame.range_m[at(frame, x, y)] = static_cast<float>(40 / ray_at(r, x, y).y);
    }
    std::fill(frame.colour.begin(), frame.colour.end(), kPaper);
    draw(scene, r, frame);
    expect_law(r, frame, depth / 2, kPaper.r);
    std::fill(frame.range_m.begin(), frame.range_m.end(), 30.0F);
    std::fill(frame.colour.begin(), frame.colour.end(), kPaper);
    draw(scene, r, frame);
    for (const Rgb& c : frame.colour) EXPECT_EQ(c, kPaper);
  }
}

TEST(ComposerVolume, RangesAreWhereTheOpacityPassesAHalf) {
  const core::DrawRequest r = request_at();
  constexpr float kExtinction = 0.4F;
  core::Frame frame = paper_frame(r);
  draw(Scene({wall(kExtinction)}, {wall_before(r)}), r, frame);
  const double front_m = 40 - 0.5 * static_cast<double>(kPost_m) * (kThick - 1);
  for (int y = 5; y < 160; y += 13) {
    for (int x = 5; x < 200; x += 13) {
      const double cosine = ray_at(r, x, y).y;
      // Up to the first posts the field rises within a spacing.
      const double into_m =
          std::log(2) * cosine / static_cast<double>(kExtinction) - 0.5 * static_cast<double>(kPost_m);
      EXPECT_NEAR(frame.range_m[at(frame, x, y)], (front_m + into_m) / cosine, 0.005);
    }
  }
  // What takes less than a half has no range.
  frame = paper_frame(r);
  draw(Scene({wall(0.05F)}, {wall_before(r)}), r, frame);
  for (const float range_m : frame.range_m) EXPECT_TRUE(std::isinf(range_m));
}

// A box in the middle of the wall is veiled by the half before it, with smooth edges and without.
TEST(ComposerVolume, VeilsAMeshByWhatLiesBeforeIt) {
  core::DrawRequest r = request_at();
  constexpr float kExtinction = 0.06F;
  Mesh mesh = make_box({8, 8, 8});
  mesh.material_table = {{{40, 40, 40, 255}}};
  std::fill(mesh.materials.begin(), mesh.materials.end(), std::uint16_t{0});
  const auto box = model_of(std::move(mesh));
  Instance inside = instance_before(r, {0, -4, 44});  // its near side is at 40 m
  inside.model = 1;
  for (const bool is_smooth : {false, true}) {
    r.settings.smooth_edges = is_smooth;
    core::Frame frame = paper_frame(r);
    draw(Scene({wall(kExtinction), box}, {wall_before(r), inside}), r, frame);
    const double cosine = ray_at(r, 103, 83).y;
    EXPECT_NEAR(frame.colour[at(frame, 103, 83)].r, veiled(wall_depth(kExtinction) / 2 / cosine, 40), 0.6);
    EXPECT_NEAR(frame.range_m[at(frame, 103, 83)], 40 / cosine, 0.01);
    EXPECT_NEAR(frame.colour[at(frame, 3, 3)].r, veiled(wall_depth(kExtinction) / ray_at(r, 3, 3).y, kPaper.r),
                0.6);
    // At its edge a pixel lies between the two.
    for (int x = 100; x < 160; ++x) {
      const int c = frame.colour[at(frame, x, 83)].r;
      EXPECT_GE(c, 69);
      EXPECT_LE(c, 77);
    }
  }
}

// Volumes in one another take as much light as their depths together, in the mean of their colours.
TEST(ComposerVolume, VolumesMixWhereTheyOverlap) {
  const core::DrawRequest r = request_at();
  const Scene scene({wall(0.04F, {200, 0, 0, 255}), wall(0.08F, {0, 200, 0, 255})}, {wall_before(r), [&] {
                                                                                       Instance second =
                                                                                           wall_before(r);
                                                                                       second.model = 1;
                                                                                       return second;
                                                                                     }()});
  core::Frame frame = paper_frame(r);
  EXPECT_EQ(draw(scene, r, frame).objects, 2);
  const double depth = wall_depth(0.12F) / ray_at(r, 100, 80).y;
  const Rgb c = frame.colour[at(frame, 100, 80)];
  const double through = std::exp(-depth);
  EXPECT_NEAR(c.r, 200 * (1 - through) / 3 + through * kPaper.r, 0.8);
  EXPECT_NEAR(c.g, 200 * (1 - through) * 2 / 3 + through * kPaper.g, 0.8);
}

std::vector<Instance> some_instances(const core::DrawRequest& r) {
  std::vector<Instance> all;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  for (std::uint32_t n = 0; n < 14; ++n) {
    Instance i = instance_before(r, {12 * any(random), 9 * any(random), 38 + 14 * any(random)});
    i.model = n % 3;
    i.rotation = glm::normalize(glm::quat(1, static_cast<float>(any(random)), static_cast<float>(any(random)),
                                          static_cast<float>(any(random))));
    i.scale = 1 + 0.5F * static_cast<float>(any(random));
    i.is_mirrored = n % 2 == 1;
    all.push_back(i);
  }
  return all;
}

// All sees_sun() ask for nothing else.
class OpenGround : public core::GroundLight {
 public:
  double shadow_factor(const glm::dvec3&, double) const override { return 0.25; }
  bool sees_sun(const glm::dvec3&) const override { return true; }
};

TEST(ComposerVolume, OrderAndThreadsChangeNoBit) {
  core::DrawRequest r = request_at();
  r.settings.mode = core::Mode::kTextured;
  r.settings.smooth_edges = true;
  r.settings.lod_tolerance_px = 1;
  r.settings.haze_visibility_m = 500;
  const Scene::Models models{volume_model(ball_level(4, 0.3F, 40), {200, 150, 100, 255}),
                             model_of(make_ellipsoid({2, 2, 2}, 40)), volume_model(chance_level(5))};
  std::vector<Instance> instances = some_instances(r);
  const OpenGround ground;
  core::Frame first;
  for (int n = 0; n < 4; ++n) {
    core::Frame frame = paper_frame(r);
    for (std::size_t p = 0; p < frame.range_m.size(); ++p)
      frame.range_m[p] = p % 200 < 90 ? 60.0F : core::kSkyRange;
    const ComposedObjects drawn = draw(Scene(models, instances), r, frame, &ground, n + 1);
    EXPECT_GT(drawn.objects, 8);
    EXPECT_GT(drawn.shaded, 10);
    if (n == 0) first = frame;
    EXPECT_EQ(frame.colour, first.colour) << n;
    EXPECT_EQ(frame.range_m, first.range_m) << n;
    std::shuffle(instances.begin(), instances.end(), std::mt19937(static_cast<unsigned>(n)));
  }
}

// Neither size nor place nor direction changes what a volume looks like.
TEST(ComposerVolume, ScaledTurnedAndFarVolumesLookTheSame) {
  const auto model = volume_model(chance_level(7), {255, 200, 90, 255});
  const core::DrawRequest near = request_at();
  Instance i = instance_before(near, {-2, -7, 20});
  core::Frame expected = paper_frame(near);
  EXPECT_EQ(draw(Scene({model}, {i}), near, expected).objects, 1);
  EXPECT_NE(expected.colour, paper_frame(near).colour);
  const auto differs = [&](const core::Frame& frame) {
    int most = 0;
    for (std::size_t n = 0; n < frame.colour.size(); ++n)
      most = std::max(most, std::abs(frame.colour[n].g - expected.colour[n].g));
    return most;
  };
  // Twice as far and twice as large.
  Instance large = instance_before(near, {-4, -14, 40});
  large.scale = 2;
  core::Frame frame = paper_frame(near);
  draw(Scene({model}, {large}), near, frame);
  EXPECT_LE(differs(frame), 1);
  // 1e8 m from the planet's centre.
  const core::DrawRequest far = request_at(1e8);
  frame = paper_frame(far);
  draw(Scene({model}, {instance_before(far, {-2, -7, 20})}), far, frame);
  EXPECT_LE(differs(frame), 1);
  // Camera and volume turned together.
  core::DrawRequest turned = near;
  const glm::dquat turn = glm::normalize(glm::dquat(0.7, 0.2, -0.5, 0.3));
  turned.view.camera.axes.right = turn * near.view.camera.axes.right;
  turned.view.camera.axes.up = turn * near.view.camera.axes.up;
  turned.view.camera.axes.forward = turn * near.view.camera.axes.forward;
  frame = paper_frame(turned);
  draw(Scene({model}, {instance_before(turned, {-2, -7, 20})}), turned, frame);
  EXPECT_LE(differs(frame), 2);
}

TEST(ComposerVolume, ATurnedWallIsThickerByItsCosine) {
  const core::DrawRequest r = request_at();
  Instance i = wall_before(r);
  const double angle = 0.5;
  const glm::dquat about_up = glm::angleAxis(angle, r.view.camera.axes.up);
  i.rotation = glm::normalize(glm::quat(about_up * glm::dquat(i.rotation)));
  core::Frame frame = paper_frame(r);
  draw(Scene({wall(0.06F)}, {i}), r, frame);
  const glm::dvec3 normal = about_up * r.view.camera.axes.forward;
  for (int x = 60; x < 140; x += 8) {
    const double cosine = std::abs(glm::dot(ray_at(r, x, 80), normal));
    EXPECT_NEAR(frame.colour[at(frame, x, 80)].r, veiled(wall_depth(0.06F) / cosine, kPaper.r), 0.6) << x;
  }
}

TEST(ComposerVolume, TheShadowOfASlabFollowsTheLaw) {
  core::DrawRequest r = request_at(10);
  r.settings.mode = core::Mode::kTextured;
  // A layer over all of the ground that the camera sees, above the camera.
  const auto layer = volume_model(slab_level(400, 400, 8, 2, 0.02F));
  const double depth = 8 * 2 * 0.02;
  const OpenGround ground;
  for (const double tilt : {0.0, 0.5, 1.0}) {
    r.sun = glm::normalize(glm::dvec3(std::cos(tilt), 0.3 * std::sin(tilt), -0.95 * std::sin(tilt)));
    core::Frame frame = paper_frame(r);
    std::fill(frame.colour.begin(), frame.colour.end(), Rgb{100, 100, 100});
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        const glm::dvec3 d = ray_at(r, x, y);
        if (d.x < -0.05) frame.range_m[at(frame, x, y)] = static_cast<float>(-10 / d.x);
      }
    }
    const core::Frame before = frame;
    EXPECT_GT(draw(Scene({layer}, {instance_before(r, {0, 20, 60})}), r, frame, &ground).shaded, 1000);
    const double light = std::exp(-depth / r.sun.x);
    const double expected = 100 * (1 - (1 - light) * 0.75);
    for (std::size_t n = 0; n < frame.colour.size(); ++n) {
      if (std::isinf(before.range_m[n])) continue;
      ASSERT_NEAR(frame.colour[n].g, expected, 0.51 + 0.1) << tilt;
    }
  }
}

// A wall that faces the sun hides it from itself: light fades with depth, and the night is dark.
TEST(ComposerVolume, LightComesThroughTheVolume) {
  core::DrawRequest r = request_at();
  r.settings.mode = core::Mode::kTextured;
  r.settings.sun_ambient = 0.1;
  r.settings.sun_diffuse = 0.8;
  const auto green_at = [&](float extinction, const glm::dvec3& sun) {
    r.sun = glm::normalize(sun);
    core::Frame frame = paper_frame(r);
    std::fill(frame.colour.begin(), frame.colour.end(), Rgb{0, 0, 0});
    draw(Scene({wall(extinction, {200, 200, 200, 255})}, {wall_before(r)}), r, frame);
    return static_cast<double>(frame.colour[at(frame, 100, 80)].g);
  };
  // Thin: full light. The mean of light through a depth of 0.1 lies between that of the two sides.
  const double share = 1 - std::exp(-wall_depth(0.02F));
  const double thin = green_at(0.02F, {0.02, -1, 0});
  EXPECT_LE(thin, 200 * share * core::light(0.1, 0.8, 1) + 0.6);
  EXPECT_GE(thin, 200 * share * core::light(0.1, 0.8, std::exp(-wall_depth(0.02F) * 1.1)) - 0.6);
  // Thick: what is seen has the sun behind it or before it.
  const double lit = green_at(2, {0.02, -1, 0});
  const double unlit = green_at(2, {0.02, 1, 0});
  EXPECT_NEAR(unlit, 200 * core::light(0.1, 0.8, 0), 6);
  EXPECT_GT(lit, 1.7 * unlit);
  EXPECT_NEAR(green_at(2, {-1, -0.2, 0}), 200 * core::light(0.1, 0, 0), 1);  // night
}

TEST(ComposerVolume, ObjectsShadeVolumesAndVolumesShadeObjects) {
  core::DrawRequest r = request_at();
  r.settings.mode = core::Mode::kTextured;
  r.sun = glm::normalize(glm::dvec3(0.2, -1, 0));
  const auto roof = model_of(make_box({200, 1, 200}));
  const auto screen = model_of(make_box({4, 1, 4}));
  Instance behind = instance_before(r, {0, -100, -25});  // between the sun and the wall, behind the camera
  behind.model = 1;
  core::Frame open = paper_frame(r);
  draw(Scene({wall(1), roof}, {wall_before(r)}), r, open);
  core::Frame shaded = paper_frame(r);
  draw(Scene({wall(1), roof}, {wall_before(r), behind}), r, shaded);
  EXPECT_GT(open.colour[at(open, 100, 80)].g, 1.7 * shaded.colour[at(shaded, 100, 80)].g);
  // A wall behind the camera dims a box before it.
  Instance box = instance_before(r, {0, -2, 10});
  box.model = 1;
  Instance veil = instance_before(r, {0, -55, -25});
  open = paper_frame(r);
  draw(Scene({wall(0.3F), screen}, {box}), r, open);
  shaded = paper_frame(r);
  draw(Scene({wall(0.3F), screen}, {box, veil}), r, shaded);
  const double light = std::exp(-wall_depth(0.3F) / -r.sun.y);
  const double incidence = -r.sun.y;
  const double expected = core::light(r.settings.sun_ambient, r.settings.sun_diffuse, incidence * light) /
                          core::light(r.settings.sun_ambient, r.settings.sun_diffuse, incidence);
  EXPECT_NEAR(shaded.colour[at(shaded, 100, 80)].g / static_cast<double>(open.colour[at(open, 100, 80)].g),
              expected, 0.01);
}

TEST(ComposerVolume, ModesPaintAsForOtherSemiTransparentThings) {
  core::DrawRequest r = request_at();
  const auto colour_in = [&](core::Mode mode) {
    r.settings.mode = mode;
    core::Frame frame = paper_frame(r);
    draw(Scene({wall(3, {200, 10, 10, 255})}, {wall_before(r)}), r, frame);
    return frame.colour[at(frame, 100, 80)];
  };
  EXPECT_EQ(colour_in(core::Mode::kUnlit), (Rgb{200, 10, 10}));
  EXPECT_EQ(colour_in(core::Mode::kWireframe), (Rgb{242, 191, 140}));
  EXPECT_EQ(colour_in(core::Mode::kMarkers), (Rgb{242, 191, 140}));
  const Rgb lit = colour_in(core::Mode::kLit);
  EXPECT_NEAR(lit.r / r.settings.plain_ground.r, lit.b / r.settings.plain_ground.b, 0.03);
  const Rgb coloured = colour_in(core::Mode::kColoured);
  EXPECT_GT(coloured.r, 5 * coloured.g);
}

TEST(ComposerVolume, HazeIsThatOfItsPlace) {
  core::DrawRequest r = request_at();
  r.settings.haze_visibility_m = 100;
  r.settings.atmosphere = core::Atmosphere::kMars;
  core::Frame frame = paper_frame(r);
  draw(Scene({wall(20, {100, 100, 100, 255})}, {wall_before(r)}), r, frame);
  const glm::dvec3 d = ray_at(r, 100, 80);
  const Haze haze = haze_at({r, kRadius_m, nullptr}, d, 37.7 / d.y);
  EXPECT_NEAR(frame.colour[at(frame, 100, 80)].r, 100 * haze.transmitted + haze.added.r, 1);
}

// Coarser levels for far volumes, whose error the result states; smaller than a pixel, a volume is its mean.
TEST(ComposerVolume, FarVolumesAreCoarseAndKeepTheirSum) {
  core::DrawRequest r = request_at();
  r.settings.lod_tolerance_px = 1;
  r.settings.smooth_edges = true;
  const auto ball = volume_model(ball_level(5, 0.1F, 120));
  const auto sum_at = [&](double distance_m, ComposedObjects* drawn = nullptr) {
    core::Frame frame = paper_frame(r);
    std::fill(frame.colour.begin(), frame.colour.end(), Rgb{0, 0, 0});
    const ComposedObjects made = draw(Scene({ball}, {instance_before(r, {0.3, 0.2, distance_m})}), r, frame);
    if (drawn != nullptr) *drawn = made;
    double sum = 0;
    for (const Rgb& c : frame.colour) sum += c.g;
    return sum * distance_m * distance_m;
  };
  ComposedObjects drawn;
  const double expected = sum_at(100, &drawn);
  EXPECT_EQ(drawn.objects, 1);
  EXPECT_NEAR(sum_at(300, &drawn), expected, 0.03 * expected);
  EXPECT_GT(drawn.geometric_error_m, 0);
  EXPECT_GT(drawn.screen_space_error_px, 0);
  EXPECT_LE(drawn.screen_space_error_px, 1);
  EXPECT_NEAR(sum_at(1200, &drawn), expected, 0.1 * expected);   // 1.8 px
  EXPECT_NEAR(sum_at(1800, &drawn), expected, 0.15 * expected);  // 1.2 px, as a mean
  EXPECT_EQ(drawn.objects, 1);
}

// Rays of round images meet the same volumes.
TEST(ComposerVolume, PanoramasShowVolumes) {
  for (const core::Projection projection : {core::Projection::kCylinder, core::Projection::kEquirectangular}) {
    core::DrawRequest r = request_at();
    r.view.projection = projection;
    r.view.width = 700;
    r.settings.mode = core::Mode::kTextured;
    const Instance i = instance_before(r, {3, -2, 20});
    core::Frame frame = paper_frame(r);
    EXPECT_EQ(draw(Scene({volume_model(ball_level(4, 2, 60), {250, 0, 0, 255})}, {i}), r, frame).objects, 1);
    const glm::dvec3 to = glm::normalize(i.position_m - r.view.camera.position_m);
    int inside = 0;
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        const double across_m = 20.3 * std::sqrt(std::max(0.0, 1 - std::pow(glm::dot(ray_at(r, x, y), to), 2)));
        if (across_m < 3 && glm::dot(ray_at(r, x, y), to) > 0) {
          ++inside;
          EXPECT_GT(frame.colour[at(frame, x, y)].r, 3 * frame.colour[at(frame, x, y)].g);
        } else if (across_m > 4.4) {
          EXPECT_EQ(frame.colour[at(frame, x, y)], kPaper);
        }
      }
    }
    EXPECT_GT(inside, 300);
  }
}

// Images have rays in some pixels of smooth volumes alone, those where single pixels are wanted in all.
TEST(ComposerVolume, FewerRaysShowWhatAllRaysShow) {
  core::DrawRequest r = request_at(10);
  r.settings.mode = core::Mode::kTextured;
  r.settings.lod_tolerance_px = 1;
  VolumeFormula devil;
  devil.height_m = 16;
  devil.radius_m = 4;
  devil.voxels = 64;
  Instance ball = instance_before(r, {4, -3, 26});
  ball.model = 1;
  const Scene scene(
      {volume_model(level_by_formula(devil), devil.colour), volume_model(ball_level(6, 0.12F, 30))},
      {instance_before(r, {-3, -9, 22}), ball});
  core::Frame some = paper_frame(r);
  for (int y = 0; y < some.height; ++y) {
    for (int x = 0; x < some.width; ++x) {
      const glm::dvec3 d = ray_at(r, x, y);
      if (d.x < -0.1) some.range_m[at(some, x, y)] = static_cast<float>(-10 / d.x);
    }
  }
  const core::Frame empty = some;
  core::Frame all = some;
  const OpenGround ground;
  draw(scene, r, some, &ground);
  const std::vector<std::uint8_t> wanted(all.colour.size(), 1);
  draw(scene, r, all, &ground, 1, wanted);
  int different = 0;
  int painted = 0;
  int sum = 0;
  for (std::size_t n = 0; n < all.colour.size(); ++n) {
    const auto [a, b] = std::pair(some.colour[n], all.colour[n]);
    const int most = std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
    EXPECT_LE(most, 8) << n;  // twice the step from which on each pixel has a ray
    sum += most;
    different += a == b ? 0 : 1;
    painted += b == kPaper ? 0 : 1;
    ASSERT_EQ(std::isinf(some.range_m[n]), std::isinf(all.range_m[n])) << n;
    if (!std::isinf(all.range_m[n])) {
      EXPECT_NEAR(some.range_m[n], all.range_m[n], 0.02 * static_cast<double>(all.range_m[n])) << n;
    }
  }
  EXPECT_GT(painted, 4000);
  EXPECT_GT(different, 0);  // else this test compares nothing
  EXPECT_LT(different, painted / 3);
  EXPECT_LT(sum, painted / 10);
  // Exact images have all rays.
  r.settings.lod_tolerance_px = 0;
  some = empty;
  draw(scene, r, some, &ground);
  all = empty;
  draw(scene, r, all, &ground, 1, wanted);
  EXPECT_EQ(some.colour, all.colour);
}

// A camera in a cloud sees what lies before it.
TEST(ComposerVolume, ACameraMayBeInside) {
  const core::DrawRequest r = request_at();
  core::Frame frame = paper_frame(r);
  draw(Scene({wall(0.06F)}, {instance_before(r, {0, -55, 0})}), r, frame);
  expect_law(r, frame, wall_depth(0.06F) / 2, kPaper.r);
}

}  // namespace
}  // namespace objects
