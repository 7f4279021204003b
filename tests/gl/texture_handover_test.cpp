// Images that stay in a texture are those that are read back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "tests/gl/gl_fixture.h"
#include "vpe/gl/opengl.h"
#include "vpe/gl/target.h"

namespace {

namespace base = vpe::base;
namespace core = vpe::core;
namespace gl = vpe::gl;
using test_support::FakeElevation;

constexpr int kWidth = 322;
constexpr int kHeight = 181;
constexpr double kSpacing_m = 60'000;

class TextureHandover : public test_support::GlTest {
 protected:
  void SetUp() override {
    planet_ = test_support::build_fake(dir_ / "p.vpe", FakeElevation(test_support::bumpy_height), kSpacing_m);
    gl::RendererOptions options{std::size_t{256} << 20, 2, {}};
    options.handover = handover_;
    renderer_ = gl::make_polygon_renderer(context_, planet_, options);
    texture_ = gl::Texture2D::make();
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  }
  core::DrawRequest request() const {
    // Along bumpy ground to the horizon: there are edges and sky.
    core::DrawRequest request =
        test_support::request_for({20, 10, 60'000, 30, -12, 0}, planet_->radius_m(), kWidth, kHeight);
    request.want_range = false;
    request.want_rough_range = true;
    request.settings.exaggeration = 5;
    return request;
  }
  core::DrawResult draw_pixels(const core::DrawRequest& request) {
    *handover_ = {};
    return renderer_->draw(request);
  }
  core::DrawResult draw_texture(const core::DrawRequest& request) {
    *handover_ = {.texture = texture_.name(), .cells = {16, 9}};
    core::DrawResult result = renderer_->draw(request);
    if (handover_->drawn != nullptr) {
      EXPECT_NE(glClientWaitSync(static_cast<GLsync>(handover_->drawn), 0, 1'000'000'000),
                GLenum{GL_TIMEOUT_EXPIRED});
    }
    return result;
  }
  // Returns what is stored, the top row first as in an image.
  std::vector<base::Rgb> stored() const {
    std::vector<base::Rgb> pixels(std::size_t{kWidth} * kHeight);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    return pixels;
  }
  // Returns how many pixels differ by more than `allowed`, and sets the largest difference.
  static int differing(const std::vector<base::Rgb>& a, const std::vector<base::Rgb>& b, int allowed,
                       int& largest) {
    EXPECT_EQ(a.size(), b.size());
    int count = 0;
    largest = 0;
    for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) {
      const int off =
          std::max({std::abs(a[n].r - b[n].r), std::abs(a[n].g - b[n].g), std::abs(a[n].b - b[n].b)});
      largest = std::max(largest, off);
      count += off > allowed ? 1 : 0;
    }
    return count;
  }

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::shared_ptr<gl::TextureHandover> handover_ = std::make_shared<gl::TextureHandover>();
  std::unique_ptr<core::Renderer> renderer_;
  gl::Texture2D texture_;
};

TEST_F(TextureHandover, ImageIsThatOfTheCpu) {
  for (const bool smooth : {false, true}) {
    for (const double gamma : {1.0, 1.8}) {
      for (const int samples : {1, 4}) {
        core::DrawRequest asked = request();
        asked.settings.smooth_edges = smooth;
        asked.settings.gamma = gamma;
        asked.settings.samples = samples;
        const core::DrawResult pixels = draw_pixels(asked);
        EXPECT_FALSE(handover_->is_drawn);
        const core::DrawResult result = draw_texture(asked);
        ASSERT_TRUE(handover_->is_drawn);
        EXPECT_TRUE(result.frame.colour.empty());
        EXPECT_EQ(result.frame.width, kWidth);
        EXPECT_EQ(result.certificate.shift_bound_px, pixels.certificate.shift_bound_px);
        EXPECT_EQ(result.certificate.nodata_share, pixels.certificate.nodata_share);
        int largest = 0;
        const int off = differing(stored(), pixels.frame.colour, 1, largest);
        std::printf("smooth %d gamma %.1f samples %d: largest %d, %d pixels differ by more than 1\n", smooth,
                    gamma, samples, largest, off);
        EXPECT_LE(largest, smooth && samples == 1 ? gl::kFinishError : 1);
        EXPECT_LE(off, kWidth * kHeight / 1000);
      }
    }
  }
}

TEST_F(TextureHandover, EdgesAreSmoothed) {
  core::DrawRequest asked = request();
  asked.settings.smooth_edges = false;
  (void)draw_texture(asked);
  const std::vector<base::Rgb> plain = stored();
  asked.settings.smooth_edges = true;
  (void)draw_texture(asked);
  int largest = 0;
  EXPECT_GT(differing(stored(), plain, 8, largest), 50);
}

TEST_F(TextureHandover, RangesOfCornersAreThoseOfThePixels) {
  const core::DrawRequest asked = request();
  const core::DrawResult pixels = draw_pixels(asked);
  ASSERT_EQ(pixels.frame.range_m.size(), std::size_t{kWidth} * kHeight);
  (void)draw_texture(asked);
  ASSERT_EQ(handover_->range_m.size(), 17U * 10U);
  int sky = 0;
  for (int row = 0; row <= 9; ++row) {
    for (int column = 0; column <= 16; ++column) {
      const int x = std::min(kWidth * column / 16, kWidth - 1);
      const int y = std::min(kHeight * row / 9, kHeight - 1);
      const float wanted = pixels.frame.range_m[static_cast<std::size_t>(y * kWidth + x)];
      const float got = handover_->range_m[static_cast<std::size_t>(17 * row + column)];
      EXPECT_EQ(std::isinf(got), std::isinf(wanted)) << column << " " << row;
      if (std::isinf(wanted))
        ++sky;
      else
        EXPECT_NEAR(got, wanted, 1e-6 * static_cast<double>(wanted)) << column << " " << row;
    }
  }
  EXPECT_GT(sky, 10);
  EXPECT_LT(sky, 160);
}

TEST_F(TextureHandover, FollowsTheSizeAndCountsItsMemory) {
  core::DrawRequest asked = request();
  (void)draw_texture(asked);
  const std::size_t bytes = handover_->bytes;
  EXPECT_EQ(bytes, std::size_t{kWidth} * kHeight * 8 + 17U * 10U * 4);
  asked.view.width = kWidth / 2;
  asked.view.height = kHeight / 2;
  (void)draw_texture(asked);
  EXPECT_LT(handover_->bytes, bytes / 2);
  asked = request();
  (void)draw_texture(asked);
  int largest = 0;
  const std::vector<base::Rgb> again = stored();
  EXPECT_EQ(differing(again, draw_pixels(asked).frame.colour, gl::kFinishError, largest), 0);
}

TEST_F(TextureHandover, WhatIsCountedOnTheCpuIsPixels) {
  core::DrawRequest asked = request();
  asked.settings.mode = core::Mode::kWireframe;
  EXPECT_FALSE(draw_texture(asked).frame.colour.empty());
  EXPECT_FALSE(handover_->is_drawn);
  asked = request();
  asked.want_range = true;
  EXPECT_FALSE(draw_texture(asked).frame.colour.empty());
  EXPECT_FALSE(handover_->is_drawn);
}

// Nobody has to take an image.
TEST_F(TextureHandover, FencesEndWithTheNextImageAndTheRenderer) {
  (void)draw_texture(request());
  const auto first = static_cast<GLsync>(handover_->drawn);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(glIsSync(first), GL_TRUE);
  (void)draw_texture(request());
  const auto second = static_cast<GLsync>(handover_->drawn);
  ASSERT_NE(second, first);
  EXPECT_EQ(glIsSync(first), GL_FALSE);
  EXPECT_EQ(glIsSync(second), GL_TRUE);
  renderer_.reset();
  EXPECT_EQ(glIsSync(second), GL_FALSE);
}

TEST_F(TextureHandover, TheNextPixelsAreAsBefore) {
  const core::DrawRequest asked = request();
  const core::DrawResult before = draw_pixels(asked);
  (void)draw_texture(asked);
  EXPECT_EQ(draw_pixels(asked).frame.colour, before.frame.colour);
}

}  // namespace
