// Tests images of rays.mode=discrete: what their certificates state, rays that share a column, columns, and refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "tests/gl/appearance_fixture.h"
#include "tests/gl/gl_fixture.h"
#include "tests/paging/planet_fixture.h"
#include "tests/support/worst.h"
#include "vpe/core/metrics.h"
#include "vpe/voxel/cast/range_caster.h"
#include "vpe/voxel/discrete_image.h"
#include "vpe/voxel/ray_renderer.h"
#include "vpe/voxel/ray_request.h"

namespace {

namespace core = vpe::core;
using test_support::Random;
using test_support::request_for;
using vpe::voxel::RangeCaster;
using vpe::voxel::RangeOptions;

class DiscreteImage : public testing::Test {
 protected:
  static std::shared_ptr<const paging::PlanetFile> bumpy() {
    static const test_support::TempDir folder;
    static const auto planet = test_support::build_fake(
        folder / "bumpy.vpe", test_support::FakeElevation(test_support::bumpy_height), 20000);
    return planet;
  }
  static std::unique_ptr<core::PixelRenderer> rays(int threads = 2) {
    return vpe::voxel::make_ray_renderer(bumpy(), {std::size_t{256} << 20, threads});
  }
  static core::DrawRequest discrete(const mars::Pose& pose, int width, int height, double fov_deg = 60) {
    core::DrawRequest request = request_for(pose, bumpy()->radius_m(), width, height, fov_deg);
    request.settings.ray_mode = core::RayMode::kDiscrete;
    request.settings.smooth_edges = false;
    return request;
  }
  static mars::Pose random_pose(Random& random) {
    const mars::LonLat place = mars::lon_lat(random.direction());
    const double ground = paging::Surface(bumpy(), std::size_t{1} << 24).at(mars::direction(place)).height_m;
    return {place.lon_deg,          place.lat_deg,           ground + random.log_uniform(500, 3e7),
            random.uniform(0, 360), random.uniform(-90, 10), random.uniform(-180, 180)};
  }
};

TEST_F(DiscreteImage, CertificatesAreTrue) {
  const paging::Surface surface(bumpy(), std::size_t{1} << 27);
  const core::SurfaceRadius radius = [&](std::span<const glm::dvec3> directions, std::span<double> radius_m) {
    surface.radius(directions, radius_m, 1);
  };
  const auto draw = rays();
  Random random(962);
  double worst = 0;
  for (int n = 0; n < 60; ++n) {
    core::DrawRequest request = discrete(random_pose(random), 96, 64, random.log_uniform(5, 100));
    request.settings.ray_ratio = random.log_uniform(0.1, 8);
    request.settings.ray_blend = n % 2 == 1;
    request.settings.ray_vertical = n % 3 == 0 ? 4 : 1;
    const core::DrawResult drawn = draw->draw(request);
    const auto shifts = core::forward_shift_px(request.view, drawn.frame.range_m, radius);
    const core::ShiftSummary shift = core::summarize(shifts, 96);
    EXPECT_LE(shift.max_px, drawn.certificate.shift_bound_px) << n;
    worst = std::max(worst, shift.max_px / drawn.certificate.shift_bound_px);
  }
  test_support::record_worst("discrete rays: forward shift", worst, 1, "of the certificate");
}

// With voxels much narrower than pixels hardly a pixel differs from the reference surface by more than a row.
TEST_F(DiscreteImage, NarrowVoxelsShowTheReferenceSurface) {
  const auto draw = rays();
  Random random(963);
  double off = 0;
  constexpr int kViews = 8;
  for (int n = 0; n < kViews; ++n) {
    mars::Pose pose = random_pose(random);
    pose.alt_m = random.log_uniform(3e6, 3e7);
    pose.pitch_deg = random.uniform(-90, -40);
    core::DrawRequest request = discrete(pose, 96, 64);
    request.settings.ray_ratio = 1.0 / 16;
    const core::DrawResult drawn = draw->draw(request);
    request.settings.ray_mode = core::RayMode::kExact;
    const core::DrawResult exact = draw->draw(request);
    int pixels = 0;
    int far = 0;
    for (std::size_t k = 0; k < exact.frame.range_m.size(); ++k) {
      const float a = drawn.frame.range_m[k];
      const float b = exact.frame.range_m[k];
      if (std::isfinite(a) != std::isfinite(b)) ++far;
      ++pixels;
      if (!std::isfinite(a) || !std::isfinite(b)) continue;
      if (std::abs(a - b) > 0.02F * b) ++far;
    }
    off += static_cast<double>(far) / pixels / kViews;
  }
  std::printf("%.3f %% of pixels are off\n", 100 * off);
  EXPECT_LE(off, 0.01);
}

// The camera is lower than the highest ground of the tile below it.
TEST_F(DiscreteImage, CertificatesNearTheGroundAreFinite) {
  const paging::Surface surface(bumpy(), std::size_t{1} << 27);
  const core::SurfaceRadius radius = [&](std::span<const glm::dvec3> directions, std::span<double> radius_m) {
    surface.radius(directions, radius_m, 1);
  };
  const auto draw = rays();
  Random random(966);
  for (int n = 0; n < 30; ++n) {
    mars::Pose pose = random_pose(random);
    pose.alt_m =
        surface.at(mars::direction({pose.lon_deg, pose.lat_deg})).height_m + random.log_uniform(5, 300);
    const core::DrawRequest request = discrete(pose, 96, 64);
    const core::DrawResult drawn = draw->draw(request);
    EXPECT_TRUE(std::isfinite(drawn.certificate.shift_bound_px)) << n;
    const core::ShiftSummary shift =
        core::summarize(core::forward_shift_px(request.view, drawn.frame.range_m, radius), 96);
    EXPECT_LE(shift.max_px, drawn.certificate.shift_bound_px) << n;
  }
}

TEST_F(DiscreteImage, LargerRatiosTakeCoarserTiles) {
  const auto draw = rays();
  core::DrawRequest request = discrete({20, 10, 3e6, 30, -60, 0}, 160, 120);
  std::size_t levels = std::numeric_limits<std::size_t>::max();
  std::int64_t tiles = std::numeric_limits<std::int64_t>::max();
  for (const double ratio : {0.5, 2.0, 8.0}) {
    request.settings.ray_ratio = ratio;
    const core::DrawResult drawn = draw->draw(request);
    EXPECT_LE(drawn.stats.tiles_by_level.size(), levels) << ratio;
    EXPECT_LT(drawn.stats.tiles_drawn, tiles) << ratio;
    levels = drawn.stats.tiles_by_level.size();
    tiles = drawn.stats.tiles_drawn;
  }
}

TEST_F(DiscreteImage, ThreadsChangeNothing) {
  const auto one = rays(1);
  const auto three = rays(3);
  Random random(964);
  for (int n = 0; n < 6; ++n) {
    core::DrawRequest request = discrete(random_pose(random), 80, 60);
    request.settings.ray_blend = n % 2 == 0;
    request.settings.ray_vertical = n % 3 == 0 ? 2 : 1;
    const core::DrawResult a = one->draw(request);
    const core::DrawResult b = three->draw(request);
    EXPECT_EQ(a.frame.colour, b.frame.colour);
    EXPECT_EQ(a.frame.range_m, b.frame.range_m);
  }
}

// Rays of a pixel are rows of an image with as many times the rows, and share its columns.
TEST_F(DiscreteImage, RaysOfAPixelAreRowsOfATallerCylinder) {
  RangeCaster caster(bumpy(), std::size_t{1} << 27);
  vpe::base::ThreadPool pool(2);
  core::View view = discrete({20, 10, 20000, 0, 0, 0}, 200, 60).view;
  view.projection = core::Projection::kCylinder;
  RangeOptions options;
  options.method = RangeOptions::Method::kDiscrete;
  options.cell_px = 1;
  options.discrete.rays = 4;
  std::vector<float> rays_m(200 * 60 * 4);
  caster.cast(view, options, pool, rays_m);
  core::View tall = view;
  tall.height *= 4;
  options.cell_px = 4;
  options.discrete.rays = 1;
  std::vector<float> tall_m(rays_m.size());
  caster.cast(tall, options, pool, tall_m);
  EXPECT_EQ(rays_m, tall_m);
  std::vector<float> middle_m(200 * 60);
  vpe::voxel::take_middle_rays(rays_m, 200, 4, middle_m);
  for (std::size_t y = 0; y < 60; ++y)
    for (std::size_t x = 0; x < 200; ++x) ASSERT_EQ(middle_m[y * 200 + x], tall_m[(4 * y + 2) * 200 + x]);
}

// Rays of perspective pixels lie where rays of a finer image do, half a pixel of the coarser one aside.
TEST_F(DiscreteImage, RaysOfAPixelAreThoseOfAFinerImage) {
  RangeCaster caster(bumpy(), std::size_t{1} << 27);
  vpe::base::ThreadPool pool(2);
  Random random(965);
  for (int n = 0; n < 10; ++n) {
    mars::Pose pose = random_pose(random);
    pose.alt_m = random.log_uniform(1e6, 3e7);
    pose.roll_deg = random.uniform(-30, 30);
    const core::View view = discrete(pose, 90, 60).view;
    RangeOptions options;
    options.method = RangeOptions::Method::kDiscrete;
    options.cell_px = 1;
    options.discrete.rays = 4;
    std::vector<float> rays_m(90 * 60 * 4, -1.0F);
    caster.cast(view, options, pool, rays_m);
    const core::View fine = vpe::voxel::with_finer_pixels(view, 4);
    options.cell_px = 4;
    options.discrete.rays = 1;
    std::vector<float> fine_m(rays_m.size() * 4);
    caster.cast(fine, options, pool, fine_m);
    int off = 0;
    for (std::size_t row = 0; row < 240; ++row) {
      for (std::size_t x = 0; x < 90; ++x) {
        const float seen = rays_m[row * 90 + x];
        ASSERT_GT(seen, 0);
        bool is_beside = false;
        for (std::size_t k = 0; k < 4; ++k) {
          const float there = fine_m[row * 360 + 4 * x + k];
          is_beside |= seen == there || std::abs(seen - there) <= 0.03F * there;
        }
        off += is_beside ? 0 : 1;
      }
    }
    EXPECT_LE(off, 240 * 90 / 50) << n;
  }
}

TEST_F(DiscreteImage, SinglePixelsAreThoseOfTheImage) {
  const auto draw = rays();
  core::DrawRequest request = discrete({20, 10, 6e6, 30, -60, 12}, 80, 60);
  std::vector<std::uint8_t> is_wanted(80 * 60);
  const std::vector<float> clear_m(is_wanted.size());
  for (std::size_t k = 0; k < is_wanted.size(); k += 3) is_wanted[k] = 1;
  core::Frame frame;
  frame.width = 80;
  frame.height = 60;
  frame.colour.resize(is_wanted.size());
  frame.range_m.resize(is_wanted.size());
  for (const bool blends : {false, true}) {
    for (const double coarsening : {1.0, 3.0}) {
      request.settings.ray_blend = blends;
      request.coarsening = coarsening;
      const core::DrawResult whole = draw->draw(request);
      draw->draw_pixels(request, {is_wanted, clear_m}, frame);
      for (std::size_t k = 0; k < is_wanted.size(); k += 3) {
        ASSERT_EQ(frame.range_m[k], whole.frame.range_m[k]) << k;
        ASSERT_EQ(frame.colour[k], whole.frame.colour[k]) << k << " " << blends << " " << coarsening;
      }
    }
  }
  request.settings.ray_vertical = 2;
  EXPECT_THROW(draw->draw_pixels(request, {is_wanted, clear_m}, frame), std::invalid_argument);
}

// Lines of pixels cover the image at any roll, and are close to vertical planes while the camera looks ahead.
TEST_F(DiscreteImage, LinesOfPixelsCoverTheImageAtAnyRoll) {
  RangeCaster caster(bumpy(), std::size_t{1} << 27);
  vpe::base::ThreadPool pool(2);
  RangeOptions options;
  options.method = RangeOptions::Method::kDiscrete;
  options.cell_px = 1;
  for (int roll_deg = -180; roll_deg < 180; roll_deg += 15) {
    const core::View view = discrete({20, 10, 60000, 30, -12, roll_deg + 0.3}, 91, 64, 20).view;
    std::vector<float> sectors_m(91 * 64, -1.0F);
    std::vector<float> lines_m(91 * 64, -1.0F);
    options.discrete.columns = core::RayColumns::kSectors;
    caster.cast(view, options, pool, sectors_m);
    options.discrete.columns = core::RayColumns::kLines;
    caster.cast(view, options, pool, lines_m);
    int near = 0;
    for (std::size_t k = 0; k < lines_m.size(); ++k) {
      ASSERT_GT(lines_m[k], 0) << roll_deg << " " << k;
      near += lines_m[k] == sectors_m[k] || std::abs(lines_m[k] - sectors_m[k]) < 0.05F * sectors_m[k] ? 1 : 0;
    }
    EXPECT_GE(near, 91 * 64 * 9 / 10) << roll_deg;
  }
  std::vector<float> down_m(91 * 64);
  EXPECT_THROW(caster.cast(discrete({20, 10, 60000, 30, -89, 0}, 91, 64).view, options, pool, down_m),
               std::runtime_error);
}

TEST_F(DiscreteImage, WhatItCannotDrawIsRefused) {
  using vpe::voxel::why_not;
  core::DrawRequest request = discrete({20, 10, 3e5, 30, -40, 0}, 80, 60);
  EXPECT_EQ(why_not(request), "");
  request.view.projection = core::Projection::kCylinder;
  EXPECT_NE(why_not(request).find("level camera"), std::string::npos);
  request = discrete({20, 10, 3e5, 30, 0, 0}, 80, 60);
  request.view.projection = core::Projection::kEquirectangular;
  request.view.fov_deg = 100;
  EXPECT_EQ(why_not(request), "");
  request.settings.ray_columns = core::RayColumns::kLines;
  EXPECT_NE(why_not(request).find("rays.columns=sectors"), std::string::npos);
  request = discrete({20, 10, 3e5, 30, -40, 0}, 80, 60);
  request.settings.samples = 2;
  EXPECT_NE(why_not(request).find("rays.vertical"), std::string::npos);
  request.settings.samples = 1;
  request.settings.ray_columns = core::RayColumns::kLines;
  EXPECT_EQ(why_not(request), "");
  request.settings.ray_vertical = 2;
  EXPECT_NE(why_not(request).find("rays.vertical=1"), std::string::npos);
}

TEST_F(DiscreteImage, PanoramasOfALevelCameraAreDrawn) {
  const auto draw = rays();
  core::DrawRequest request = discrete({20, 10, 30000, 0, 0, 0}, 240, 60);
  request.view.projection = core::Projection::kEquirectangular;
  request.view.fov_deg = 80;
  request.settings.ray_vertical = 4;
  const core::DrawResult drawn = draw->draw(request);
  request.settings.ray_mode = core::RayMode::kExact;
  request.settings.ray_vertical = 1;
  const core::DrawResult exact = draw->draw(request);
  int same = 0;
  for (std::size_t k = 0; k < drawn.frame.range_m.size(); ++k)
    same += std::isfinite(drawn.frame.range_m[k]) == std::isfinite(exact.frame.range_m[k]) ? 1 : 0;
  EXPECT_GE(same, 240 * 59);
}

}  // namespace
