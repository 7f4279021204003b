// Stereo pairs.
#include "vpe/core/stereo.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/support/process.h"
#include "tests/support/support.h"

namespace {

using vpe::core::combine_stereo;
using vpe::core::RgbImage;
using vpe::core::StereoLayout;

RgbImage noise(int width, int height, std::uint64_t seed) {
  test_support::Random random(seed);
  RgbImage image{width, height, {}};
  for (int n = 0; n < width * height; ++n) {
    const auto value = [&] { return static_cast<std::uint8_t>(random.integer(0, 255)); };
    image.pixels.push_back({value(), value(), value()});
  }
  return image;
}

vpe::base::Rgb at(const RgbImage& image, int x, int y) {
  return image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(x)];
}

TEST(Stereo, SideBySideAndOverUnder) {
  const RgbImage left = noise(5, 3, 1);
  const RgbImage right = noise(5, 3, 2);
  const RgbImage beside = combine_stereo(left, right, StereoLayout::kSideBySide);
  ASSERT_EQ(beside.width, 10);
  ASSERT_EQ(beside.height, 3);
  const RgbImage over = combine_stereo(left, right, StereoLayout::kOverUnder);
  ASSERT_EQ(over.width, 5);
  ASSERT_EQ(over.height, 6);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) {
      EXPECT_EQ(at(beside, x, y), at(left, x, y));
      EXPECT_EQ(at(beside, x + 5, y), at(right, x, y));
      EXPECT_EQ(at(over, x, y), at(left, x, y));
      EXPECT_EQ(at(over, x, y + 3), at(right, x, y));
    }
  }
}

TEST(Stereo, EyesOfOtherSizeAreRefused) {
  EXPECT_THROW(combine_stereo(noise(5, 3, 1), noise(5, 4, 1), StereoLayout::kAnaglyph), vpe::core::ImageError);
  const RgbImage wide{32768, 1, std::vector<vpe::base::Rgb>(32768)};
  EXPECT_THROW(combine_stereo(wide, wide, StereoLayout::kSideBySide), vpe::core::ImageError);
}

TEST(Stereo, RedCyanIsThatOfFfmpeg) {
  const auto ffmpeg = app_test::find_program("ffmpeg");
  ASSERT_FALSE(ffmpeg.empty()) << "ffmpeg is not installed; .ci/packages.txt names its package";
  const test_support::TempDir folder;
  const RgbImage left = noise(64, 48, 3);
  const RgbImage right = noise(64, 48, 4);
  const RgbImage pair = combine_stereo(left, right, StereoLayout::kSideBySide);
  vpe::core::write_image(folder / "pair.png", pair.pixels, pair.width, pair.height);
  app_test::Command command;
  command.program = ffmpeg;
  command.arguments = {"-v", "error", "-i", "pair.png", "-vf", "format=rgb24,stereo3d=sbsl:arcd", "red.png"};
  command.folder = folder.path();
  const app_test::Result result = app_test::run(command);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const RgbImage theirs = vpe::core::read_image(folder / "red.png");
  const RgbImage ours = combine_stereo(left, right, StereoLayout::kAnaglyph);
  ASSERT_EQ(theirs.width, 64);
  ASSERT_EQ(theirs.height, 48);
  for (std::size_t n = 0; n < ours.pixels.size(); ++n) {
    EXPECT_NEAR(ours.pixels[n].r, theirs.pixels[n].r, 1);
    EXPECT_NEAR(ours.pixels[n].g, theirs.pixels[n].g, 1);
    EXPECT_NEAR(ours.pixels[n].b, theirs.pixels[n].b, 1);
  }
}

TEST(Stereo, RedGlassSeesTheLeftCameraOnly) {
  const RgbImage white{1, 1, {{255, 255, 255}}};
  const RgbImage black{1, 1, {{0, 0, 0}}};
  const vpe::base::Rgb left = combine_stereo(white, black, StereoLayout::kAnaglyph).pixels[0];
  EXPECT_GT(left.r, 250);
  EXPECT_LT(left.g, 10);
  EXPECT_LT(left.b, 10);
  const vpe::base::Rgb right = combine_stereo(black, white, StereoLayout::kAnaglyph).pixels[0];
  EXPECT_LT(right.r, 10);
  EXPECT_GT(right.g, 250);
  EXPECT_GT(right.b, 250);
}

TEST(Stereo, EyesAreParallelOrMeetAtADistance) {
  vpe::core::View view;
  view.camera = mars::to_camera({30, 20, 1000, 40, -10, 5}, mars::kMarsRadius_m);
  view.width = 1000;
  view.height = 800;
  const double base_m = 0.5;
  const auto x_of = [&](const vpe::core::View& eye, double distance_m) {
    const auto projected =
        vpe::core::project(eye, view.camera.position_m + distance_m * view.camera.axes.forward);
    EXPECT_NEAR(projected.xy.y, 400.0, 1e-4);
    return projected.xy.x;
  };
  const double f = vpe::core::focal_px(view);
  const auto left = vpe::core::eye_view(view, -base_m / 2, std::nullopt);
  const auto right = vpe::core::eye_view(view, base_m / 2, std::nullopt);
  for (const double distance_m : {2.0, 10.0, 1000.0})
    EXPECT_NEAR(x_of(left, distance_m) - x_of(right, distance_m), f * base_m / distance_m, 1e-5);
  const auto left10 = vpe::core::eye_view(view, -base_m / 2, 10.0);
  const auto right10 = vpe::core::eye_view(view, base_m / 2, 10.0);
  EXPECT_NEAR(x_of(left10, 10.0), 500.0, 1e-5);
  EXPECT_NEAR(x_of(right10, 10.0), 500.0, 1e-5);
  EXPECT_GT(x_of(left10, 5.0), x_of(right10, 5.0));  // nearer: in front of the screen
  EXPECT_LT(x_of(left10, 50.0), x_of(right10, 50.0));
}

TEST(Stereo, BaseOfTheNearest) {
  const float sky = INFINITY;
  EXPECT_FALSE(vpe::core::comfortable_base_m(std::vector<float>{sky, sky}));
  EXPECT_FALSE(vpe::core::comfortable_base_m({}));
  EXPECT_DOUBLE_EQ(*vpe::core::comfortable_base_m(std::vector<float>{sky, 300.0F, 90.0F}), 3.0);
}

TEST(Stereo, Names) {
  for (const auto layout : {StereoLayout::kSideBySide, StereoLayout::kOverUnder, StereoLayout::kAnaglyph})
    EXPECT_EQ(vpe::core::parse_stereo(vpe::core::to_string(layout)), layout);
  EXPECT_FALSE(vpe::core::parse_stereo("SBS"));
}

TEST(Stereo, NoDistanceOfConvergenceIsInfinity) {
  EXPECT_EQ(vpe::core::convergence_at(0), std::nullopt);
  EXPECT_EQ(vpe::core::convergence_at(-1), std::nullopt);
  EXPECT_EQ(vpe::core::convergence_at(80), 80.0);
}

}  // namespace
