// Views by OpenGL, against those of the exact sampler on the CPU.
#include "vpe/overlook/overlook_renderer.h"

#include <gtest/gtest.h>

#include <random>

#include "mars/geodesy/pose.h"
#include "panorama/viewer/render_view.h"
#include "panorama/viewer/viewer.h"
#include "tests/overlook/overlook_fixture.h"
#include "vpe/overlook/texture_pixels.h"

namespace {

using namespace vpe::overlook;
using overlook_test::image_of;
using overlook_test::maps;
using overlook_test::rough;
using panorama::PanoramaMap;
using panorama::TiledImage;

constexpr unsigned kSeed = 20261127;

std::shared_ptr<vpe::gl::Context> context() { return vpe::gl::Context::create(); }

// The share of pixels that differ by more than `steps` in a channel.
double differing(const vpe::core::RgbImage& a, const vpe::core::RgbImage& b, int steps) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  std::size_t count = 0;
  for (std::size_t n = 0; n < a.pixels.size(); ++n) {
    const auto& p = a.pixels[n];
    const auto& q = b.pixels[n];
    count += std::abs(p.r - q.r) > steps || std::abs(p.g - q.g) > steps || std::abs(p.b - q.b) > steps;
  }
  return static_cast<double>(count) / static_cast<double>(a.pixels.size());
}

vpe::core::View view_at(double yaw_deg, double pitch_deg, double roll_deg, double fov_deg, int width,
                        int height) {
  vpe::core::View view = panorama::view_of(yaw_deg, pitch_deg, fov_deg, width, height);
  view.camera.axes = mars::oriented_axes(panorama::kViewerFrame, yaw_deg, pitch_deg, roll_deg);
  return view;
}

TEST(OverlookRenderer, ShowsWhatTheExactSamplerShows) {
  const auto gl = context();
  std::mt19937 random(kSeed);
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  double worst = 0;
  double sum = 0;
  int views = 0;
  for (const PanoramaMap& map : maps()) {
    const TiledImage image = image_of(map, rough(std::llround(map.turn_px)));
    OverlookRenderer renderer(gl, image, map, {});
    for (int n = 0; n < 34; ++n) {
      const double fov_deg = std::exp(number(std::log(1.0), std::log(110.0)));
      const vpe::core::View view =
          view_at(number(0, 360), number(-50, 50), n % 2 == 0 ? 0.0 : number(-180, 180), fov_deg, 400, 250);
      const OverlookRenderer::Drawn drawn = renderer.draw(view);
      EXPECT_TRUE(drawn.is_complete);
      const double share = differing(drawn.image, panorama::render_view(image, map, view, {}), 2);
      // Near a pole a pixel covers many columns, and the rasteriser takes its differences over pairs of pixels.
      EXPECT_LT(share, 0.003) << to_string(map.kind) << " " << map.facets << " view " << n << " fov " << fov_deg
                              << " seed " << kSeed;
      worst = std::max(worst, share);
      sum += share;
      ++views;
    }
  }
  EXPECT_GE(views, 200);
  EXPECT_LT(sum / views, 0.001);
  RecordProperty("worst_share", std::to_string(worst));
  std::printf("%d views: %.5f %% of pixels differ by more than 2 steps, at worst %.4f %%\n", views,
              100 * sum / views, 100 * worst);
}

TEST(OverlookRenderer, DrawsTheZenithAndTheNadir) {
  const PanoramaMap map = maps()[1];
  const TiledImage image = image_of(map, rough(2400));
  OverlookRenderer renderer(context(), image, map, {});
  for (const double pitch_deg : {90.0, -90.0, 75.0}) {
    const vpe::core::View view = view_at(30, pitch_deg, 0, 50, 320, 320);
    EXPECT_LT(differing(renderer.draw(view).image, panorama::render_view(image, map, view, {}), 2), 0.004);
  }
}

TEST(OverlookRenderer, DirectionsAreWithinAQuarterOfAPixelAcrossSeams) {
  // A sharp vertical edge every 250 columns: where a row crosses it is measured between pixels.
  const auto edges = [](std::int64_t x, std::int64_t) {
    const auto value = static_cast<std::uint8_t>(x / 250 % 2 == 0 ? 20 : 220);
    return vpe::base::Rgb{value, value, value};
  };
  const auto gl = context();
  for (const PanoramaMap& map : {panorama::cylinder_map(3000, 1100, 3000, 0.0, 500.0),
                                 panorama::equirectangular_map(3000, 1100, 3000, 0.0, 500.0),
                                 panorama::faceted_map(12, 250, 1100, 15.0, 500.0)}) {
    const TiledImage image = image_of(map, edges);
    OverlookRenderer renderer(gl, image, map, {});
    for (int column = 0; column < 3000; column += 250) {
      const panorama::Direction at = map.to_direction(column, 500);
      const vpe::core::View view = view_at(at.azimuth_deg, at.elevation_deg, 0, 6, 401, 201);
      const vpe::core::RgbImage drawn = renderer.draw(view).image;
      double before = 0;
      const std::size_t row = 100 * 401;
      const int first = drawn.pixels[row + 170].r;
      const int last = drawn.pixels[row + 230].r;
      ASSERT_GT(std::abs(last - first), 150) << to_string(map.kind) << " " << column;
      for (std::size_t x = 170; x < 230; ++x)
        before += std::abs(last - drawn.pixels[row + x].r) / static_cast<double>(std::abs(last - first));
      EXPECT_NEAR(170 + before, 200.5, 0.25) << to_string(map.kind) << " " << column;
    }
  }
}

TEST(OverlookRenderer, ReadsOnlyWhatAViewShows) {
  const PanoramaMap& map = maps()[0];
  const TiledImage image = image_of(map, rough(3000));
  OverlookRenderer renderer(context(), image, map, {});
  const vpe::core::View view = view_at(190, 0, 0, 10, 640, 400);
  (void)renderer.draw(view);
  const std::int64_t reads = renderer.reads();
  EXPECT_LE(reads, 9);
  EXPECT_EQ(renderer.bytes(), static_cast<std::size_t>(reads) * 258 * 258 * 4);
  (void)renderer.draw(view);
  EXPECT_EQ(renderer.reads(), reads) << "the same view reads nothing";
}

TEST(OverlookRenderer, CoarserTexturesStandInForThoseNotRead) {
  const PanoramaMap& map = maps()[0];
  const TiledImage image = image_of(map, rough(3000));
  OverlookRenderer renderer(context(), image, map, {});
  const vpe::core::View view = view_at(190, 0, 0, 40, 640, 400);
  const OverlookRenderer::Drawn first = renderer.draw(view, 0);
  EXPECT_FALSE(first.is_complete);
  int views = 1;
  OverlookRenderer::Drawn drawn = first;
  for (; !drawn.is_complete && views < 100; ++views) drawn = renderer.draw(view, 2);
  EXPECT_GT(views, 2);
  EXPECT_TRUE(drawn.is_complete);
  EXPECT_EQ(drawn.image.pixels, renderer.draw(view).image.pixels);
  EXPECT_GT(differing(first.image, drawn.image, 8), 0.1) << "the first view is coarse";
  EXPECT_LT(differing(drawn.image, panorama::render_view(image, map, view, {}), 2), 0.001);
}

TEST(OverlookRenderer, KeepsToItsBudget) {
  const PanoramaMap& map = maps()[0];
  const TiledImage image = image_of(map, rough(3000));
  OverlookOptions options;
  options.budget_bytes = 1;  // raised to 8 MiB: 31 textures
  OverlookRenderer renderer(context(), image, map, options);
  const vpe::core::View first = view_at(0, 0, 0, 30, 640, 400);
  const vpe::core::RgbImage before = renderer.draw(first).image;
  for (double yaw_deg = 20; yaw_deg < 360; yaw_deg += 20) {
    (void)renderer.draw(view_at(yaw_deg, 0, 0, 30, 640, 400));
    EXPECT_LE(renderer.bytes(), OverlookOptions::kMinBudget_bytes);
  }
  EXPECT_EQ(renderer.draw(first).image.pixels, before.pixels);
}

TEST(OverlookRenderer, DrawsPartsAndMovedMiddles) {
  const PanoramaMap& map = maps()[0];
  const TiledImage image = image_of(map, rough(3000));
  OverlookRenderer renderer(context(), image, map, {});
  vpe::core::View view = view_at(200, 5, 30, 60, 640, 400);
  view.principal_offset_px = {31, -17};
  view.part = {100, 60, 300, 200};
  const vpe::core::RgbImage drawn = renderer.draw(view).image;
  EXPECT_EQ(drawn.width, 300);
  EXPECT_EQ(drawn.height, 200);
  EXPECT_LT(differing(drawn, panorama::render_view(image, map, view, {}), 2), 0.001);
}

TEST(OverlookRenderer, RefusesWhatItCannotDraw) {
  const PanoramaMap& map = maps()[0];
  const TiledImage image = image_of(map, rough(3000));
  const auto gl = context();
  OverlookRenderer renderer(gl, image, map, {});
  vpe::core::View view = view_at(0, 0, 0, 60, 64, 64);
  view.projection = vpe::core::Projection::kCylinder;
  EXPECT_THROW((void)renderer.draw(view), std::invalid_argument);
  view.projection = vpe::core::Projection::kPerspective;
  view.fov_deg = 200;
  EXPECT_THROW((void)renderer.draw(view), std::invalid_argument);
  PanoramaMap broken = map;
  broken.turn_px = 0;
  EXPECT_THROW(OverlookRenderer(gl, image, broken, {}), std::invalid_argument);
}

TEST(TexturePixels, GoOnBeyondTheEndOfACircle) {
  const PanoramaMap& map = maps()[0];
  const TiledImage image = image_of(map, [](std::int64_t x, std::int64_t y) {
    return vpe::base::Rgb{static_cast<std::uint8_t>(x % 251), static_cast<std::uint8_t>(y % 241), 7};
  });
  const std::vector<panorama::LevelGrid> grids = panorama::level_grids(image.levels(), map, {});
  const std::vector<std::uint8_t> first = texture_pixels(image, grids[0], {0, 0, 0});
  ASSERT_EQ(first.size(), 258U * 258 * 4);
  const auto at = [&](const std::vector<std::uint8_t>& pixels, std::size_t x, std::size_t y) {
    return pixels.data() + (y * 258 + x) * 4;
  };
  EXPECT_EQ(at(first, 0, 5)[0], 2999 % 251) << "left of the first column is the last";
  EXPECT_EQ(at(first, 1, 5)[0], 0);
  EXPECT_EQ(at(first, 257, 5)[0], 256 % 251);
  EXPECT_EQ(at(first, 3, 0)[1], 0) << "above the first row it is repeated";
  EXPECT_EQ(at(first, 3, 7)[1], 6);
  EXPECT_EQ(at(first, 3, 7)[3], 255);
  const std::vector<std::uint8_t> last = texture_pixels(image, grids[0], {0, 11, 0});
  EXPECT_EQ(at(last, 2999 - 11 * 256 + 1, 9)[0], 2999 % 251);
  EXPECT_EQ(at(last, 3000 - 11 * 256 + 1, 9)[0], 0) << "right of the last column is the first";
}

}  // namespace
