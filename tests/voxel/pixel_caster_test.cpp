// Tests single pixels of images: how they are cast, and that they are those of the whole image.
#include "vpe/voxel/pixel_caster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/gl/gl_fixture.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using test_support::Random;
using test_support::request_for;

struct Mask {
  explicit Mask(std::size_t pixels) : is_wanted(pixels), clear_m(pixels) {}
  core::WantedPixels pixels() const { return {is_wanted, clear_m}; }
  std::vector<std::uint8_t> is_wanted;
  std::vector<float> clear_m;
};

core::View view_of_plan() {
  core::View view;
  view.width = 100;
  view.height = 60;
  return view;
}

TEST(PixelPlan, ScatteredPixelsAreRaysWithTheFullestColumnsFirst) {
  Mask mask(6000);
  for (const auto& [x, count] : {std::pair{10, 3}, {20, 7}, {30, 1}}) {
    for (int y = 0; y < count; ++y) {
      const auto n = static_cast<std::size_t>(100 * (5 + 3 * y) + x);
      mask.is_wanted[n] = 1;
      mask.clear_m[n] = 50;
    }
  }
  const vpe::voxel::PixelPlan plan = vpe::voxel::plan_pixels(view_of_plan(), mask.pixels());
  EXPECT_TRUE(plan.strips.empty());
  EXPECT_EQ(plan.columns, (std::vector<int>{20, 10, 30}));
  EXPECT_EQ(plan.rays, 11);
}

TEST(PixelPlan, UnknownBordersAreStripsThatDoNotOverlap) {
  Mask mask(6000);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 100; ++x)
      if (x >= 93 || y < 4) mask.is_wanted[static_cast<std::size_t>(100 * y + x)] = 1;
  const vpe::voxel::PixelPlan plan = vpe::voxel::plan_pixels(view_of_plan(), mask.pixels());
  EXPECT_EQ(plan.strips, (std::vector<core::SubRectangle>{{0, 0, 100, 4}, {93, 4, 7, 56}}));
  EXPECT_EQ(plan.rays, 0);
}

TEST(PixelPlan, ManyPixelsAreOneStripAndNoneAreNone) {
  Mask mask(6000);
  EXPECT_TRUE(vpe::voxel::plan_pixels(view_of_plan(), mask.pixels()).strips.empty());
  for (std::size_t n = 0; n < 6000; n += 3) {
    mask.is_wanted[n] = 1;
    mask.clear_m[n] = 50;
  }
  const vpe::voxel::PixelPlan plan = vpe::voxel::plan_pixels(view_of_plan(), mask.pixels());
  EXPECT_EQ(plan.strips, (std::vector<core::SubRectangle>{{0, 0, 100, 60}}));
  EXPECT_TRUE(plan.columns.empty());
}

class DrawnPixels : public test_support::GlTest {
 protected:
  std::shared_ptr<const paging::PlanetFile> bumpy() {
    return test_support::build_fake(dir_ / "bumpy.vpe", test_support::FakeElevation(test_support::bumpy_height),
                                    20'000);
  }
};

// Pixels are those of the whole image, whatever is known about their rays, and the others are left alone.
TEST_F(DrawnPixels, AreThoseOfTheWholeImage) {
  const auto planet = bumpy();
  const auto renderer = vpe::voxel::make_ray_renderer(planet, {std::size_t{256} << 20, 2});
  Random random(20261125);
  for (const mars::Pose& pose : {mars::Pose{10, 20, 15'000, 40, -12, 0}, {10, 20, 200'000, 40, -35, 25}}) {
    for (const core::RayMode mode : {core::RayMode::kExact, core::RayMode::kMultires}) {
      core::DrawRequest request = request_for(pose, planet->radius_m(), 200, 120);
      request.settings.mode = core::Mode::kLit;
      request.settings.ray_mode = mode;
      request.settings.smooth_edges = false;
      request.settings.gamma = 1;
      request.want_range = true;
      const core::Frame whole = renderer->draw(request).frame;
      for (const double share : {0.0, 0.02, 0.5, 1.0}) {
        Mask mask(whole.range_m.size());
        core::Frame frame = whole;
        std::int64_t wanted = 0;
        for (std::size_t n = 0; n < whole.range_m.size(); ++n) {
          if (random.uniform(0, 1) >= share) continue;
          ++wanted;
          mask.is_wanted[n] = 1;
          // Unknown, clear up to just before the ground, and a little beyond it: then the ray begins anew.
          const int known = random.integer(0, 2);
          mask.clear_m[n] = known == 0 ? 0.0F : known == 1 ? 0.9F * whole.range_m[n] : 1.06F * whole.range_m[n];
          frame.range_m[n] = -7;
          frame.colour[n] = {1, 2, 3};
        }
        const core::DrawResult drawn = renderer->draw_pixels(request, mask.pixels(), frame);
        EXPECT_TRUE(drawn.missing.empty());
        std::int64_t differ = 0;
        for (std::size_t n = 0; n < whole.range_m.size(); ++n) {
          if (mask.is_wanted[n] == 0) {
            ASSERT_EQ(frame.range_m[n], whole.range_m[n]) << n;
            ASSERT_EQ(frame.colour[n], whole.colour[n]) << n;
            continue;
          }
          const bool is_sky = std::isinf(whole.range_m[n]);
          const bool agrees = is_sky ? std::isinf(frame.range_m[n])
                                     : std::abs(frame.range_m[n] / whole.range_m[n] - 1) <
                                           (mode == core::RayMode::kExact ? 1e-4 : 0.05);
          const bool has_colour = std::abs(frame.colour[n].r - whole.colour[n].r) <= 3;
          if (!agrees || !has_colour) ++differ;
        }
        // Single rays meet ridges that fit between two columns.
        EXPECT_LE(differ, wanted / 100 + 1) << share << " " << static_cast<int>(mode);
      }
    }
  }
}

TEST_F(DrawnPixels, HaveTheWholeImagesBitsWhereColumnsCastThem) {
  const auto planet = bumpy();
  const auto renderer = vpe::voxel::make_ray_renderer(planet, {std::size_t{256} << 20, 2});
  core::DrawRequest request = request_for({10, 20, 15'000, 40, -12, 0}, planet->radius_m(), 300, 120);
  request.settings.smooth_edges = false;
  request.want_range = true;
  const core::Frame whole = renderer->draw(request).frame;
  Mask mask(whole.range_m.size());
  core::Frame frame = whole;
  for (std::size_t n = 0; n < frame.range_m.size(); ++n) {
    if (n % 300 < 270) continue;
    mask.is_wanted[n] = 1;
    frame.range_m[n] = -7;
    frame.colour[n] = {};
  }
  renderer->draw_pixels(request, mask.pixels(), frame);
  EXPECT_EQ(frame.range_m, whole.range_m);
  EXPECT_EQ(frame.colour, whole.colour);
}

TEST_F(DrawnPixels, AreOfOneColourBelowTheGround) {
  const auto planet = bumpy();
  const auto renderer = vpe::voxel::make_ray_renderer(planet, {std::size_t{64} << 20, 2});
  core::DrawRequest request = request_for({10, 20, -20'000, 40, -12, 0}, planet->radius_m(), 40, 30);
  request.settings.smooth_edges = false;
  request.want_range = true;
  const core::DrawResult whole = renderer->draw(request);
  ASSERT_TRUE(whole.certificate.is_below_ground);
  Mask mask(1200);
  mask.is_wanted[77] = 1;
  core::Frame frame{40, 30, std::vector<vpe::base::Rgb>(1200, {1, 2, 3}), std::vector<float>(1200, 5)};
  EXPECT_TRUE(renderer->draw_pixels(request, mask.pixels(), frame).certificate.is_below_ground);
  EXPECT_EQ(frame.range_m[77], whole.frame.range_m[77]);
  EXPECT_EQ(frame.colour[77], whole.frame.colour[77]);
  EXPECT_EQ(frame.range_m[76], 5);
}

TEST_F(DrawnPixels, BadRequestsAreRefused) {
  const auto planet = bumpy();
  const auto renderer = vpe::voxel::make_ray_renderer(planet, {std::size_t{64} << 20, 2});
  core::DrawRequest request = request_for({10, 20, 15'000, 40, -12, 0}, planet->radius_m(), 40, 30);
  core::Frame frame{40, 30, std::vector<vpe::base::Rgb>(1200), std::vector<float>(1200)};
  const Mask mask(1200);
  const Mask small(1199);
  EXPECT_THROW(renderer->draw_pixels(request, small.pixels(), frame), std::invalid_argument);
  core::Frame short_frame = frame;
  short_frame.range_m.pop_back();
  EXPECT_THROW(renderer->draw_pixels(request, mask.pixels(), short_frame), std::invalid_argument);
  core::DrawRequest several = request;
  several.settings.samples = 4;
  EXPECT_THROW(renderer->draw_pixels(several, mask.pixels(), frame), std::invalid_argument);
}

// Round images: few pixels ray by ray, many by casting all of them.
TEST_F(DrawnPixels, OfRoundImagesAreThoseOfTheWholeImage) {
  const auto planet = bumpy();
  const auto renderer = vpe::voxel::make_ray_renderer(planet, {std::size_t{256} << 20, 2});
  Random random(20261126);
  for (const core::Projection projection : {core::Projection::kCylinder, core::Projection::kEquirectangular}) {
    core::DrawRequest request = request_for({10, 20, 15'000, 40, 0, 0}, planet->radius_m(), 360, 100);
    request.view.projection = projection;
    request.view.fov_deg = 80;
    request.settings.smooth_edges = false;
    request.want_range = true;
    const core::Frame whole = renderer->draw(request).frame;
    for (const double share : {0.02, 0.6}) {
      Mask mask(whole.range_m.size());
      core::Frame frame = whole;
      for (std::size_t n = 0; n < whole.range_m.size(); ++n) {
        if (random.uniform(0, 1) >= share) continue;
        mask.is_wanted[n] = 1;
        mask.clear_m[n] = std::isinf(whole.range_m[n]) ? 0 : 0.9F * whole.range_m[n];
        frame.range_m[n] = -7;
        frame.colour[n] = {1, 2, 3};
      }
      renderer->draw_pixels(request, mask.pixels(), frame);
      int differ = 0;
      for (std::size_t n = 0; n < whole.range_m.size(); ++n) {
        const bool agrees = std::isinf(whole.range_m[n])
                                ? std::isinf(frame.range_m[n])
                                : std::abs(frame.range_m[n] / whole.range_m[n] - 1) < 1e-4;
        if (!agrees || std::abs(frame.colour[n].r - whole.colour[n].r) > 3) ++differ;
      }
      EXPECT_LE(differ, 36) << share;
    }
  }
}

}  // namespace
