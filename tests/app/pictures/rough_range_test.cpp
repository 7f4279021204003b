// Ranges that come with an image for little (DrawRequest::want_rough_range), by both backends.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/gl/gl_fixture.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;

class RoughRange : public test_support::GlTest {
 protected:
  std::shared_ptr<const paging::PlanetFile> planet() {
    return test_support::build_fake(dir_ / "bumpy.vpe", test_support::FakeElevation(test_support::bumpy_height),
                                    60'000);
  }
};

TEST_F(RoughRange, IsWithinAThousandthOfTheRange) {
  const auto file = planet();
  const auto rays = vpe::voxel::make_ray_renderer(file, {std::size_t{64} << 20, 2});
  const auto triangles = renderer(file);
  for (const mars::Pose& pose : {mars::Pose{10, 20, 30'000, 40, -12, 0}, {10, 20, 4e6, 40, -80, 25}}) {
    for (core::Renderer* backend : {static_cast<core::Renderer*>(rays.get()), triangles.get()}) {
      core::DrawRequest request = test_support::request_for(pose, file->radius_m(), 160, 120);
      const core::DrawResult full = backend->draw(request);
      request.want_range = false;
      const core::DrawResult plain = backend->draw(request);
      EXPECT_TRUE(plain.frame.range_m.empty());
      request.want_rough_range = true;
      const core::DrawResult rough = backend->draw(request);
      EXPECT_EQ(rough.frame.colour, plain.frame.colour);
      // No certificate uses it.
      EXPECT_EQ(rough.certificate.image_bound_px, plain.certificate.image_bound_px);
      ASSERT_EQ(rough.frame.range_m.size(), full.frame.range_m.size());
      std::size_t ground = 0;
      for (std::size_t n = 0; n < rough.frame.range_m.size(); ++n) {
        if (std::isinf(full.frame.range_m[n]) || std::isinf(rough.frame.range_m[n])) {
          ASSERT_EQ(rough.frame.range_m[n], full.frame.range_m[n]) << n;
          continue;
        }
        ++ground;
        ASSERT_NEAR(rough.frame.range_m[n] / full.frame.range_m[n], 1, 1e-3) << n;
      }
      EXPECT_GT(ground, 5000U);
    }
  }
}

TEST_F(RoughRange, IsAbsentWhereTrianglesDoNotHaveIt) {
  const auto triangles = renderer(planet());
  core::DrawRequest request =
      test_support::request_for({10, 20, 30'000, 40, -12, 0}, mars::kMarsRadius_m, 80, 60);
  request.want_range = false;
  request.want_rough_range = true;
  // Also without smoothed edges, which use the same depths.
  request.settings.smooth_edges = false;
  EXPECT_FALSE(triangles->draw(request).frame.range_m.empty());
  request.settings.samples = 4;
  EXPECT_TRUE(triangles->draw(request).frame.range_m.empty());
  request.settings.samples = 1;
  request.settings.mode = core::Mode::kWireframe;
  EXPECT_TRUE(triangles->draw(request).frame.range_m.empty());
  request.settings.mode = core::Mode::kLit;
  request.want_colour = false;
  EXPECT_TRUE(triangles->draw(request).frame.range_m.empty());
  request.want_range = true;
  EXPECT_FALSE(triangles->draw(request).frame.range_m.empty());
}

}  // namespace
