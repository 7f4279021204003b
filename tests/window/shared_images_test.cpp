// Images of triangles that stay in the window's textures.
#include <gtest/gtest.h>

#include <epoxy/gl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "tests/window/explore_window_fixture.h"

namespace vpe::window {
namespace {

TEST(SharedImages, WhatNeedsTheCpuIsPixels) {
  const ImageRequest plain;
  EXPECT_EQ(why_pixels(plain, false), "");
  EXPECT_NE(why_pixels(plain, true), "");
  const auto expect_pixels = [&](const auto& change) {
    ImageRequest request = plain;
    change(request);
    EXPECT_NE(why_pixels(request, false), "");
  };
  expect_pixels([](ImageRequest& r) { r.backend = core::Backend::kRay; });
  expect_pixels([](ImageRequest& r) { r.stereo = core::StereoLayout::kAnaglyph; });
  expect_pixels([](ImageRequest& r) { r.with_earlier = true; });
  expect_pixels([](ImageRequest& r) { r.keeps_ranges = true; });
  expect_pixels([](ImageRequest& r) { r.draw.want_range = true; });
  expect_pixels([](ImageRequest& r) { r.draw.settings.scene = "s.toml"; });
  expect_pixels([](ImageRequest& r) { r.draw.settings.scale_bar = true; });
}

// A context that is lost.
class LostContext : public DrawContext {
 public:
  void make_current() override { throw std::runtime_error("lost"); }
  void release() override {}
};

class LostPainter : public Painter {
 public:
  explicit LostPainter(std::unique_ptr<Painter> painter) : painter_(std::move(painter)) {}
  DrawnImage paint(const ImageRequest& request) override {
    ImageRequest changed = request;
    changed.place.context = &context_;
    return painter_->paint(changed);
  }

 private:
  LostContext context_;
  std::unique_ptr<Painter> painter_;
};

// Counts, when the window has closed, how many fences of its images are left.
class FencePainter : public Painter {
 public:
  struct Counts {
    std::atomic<int> made = 0;
    std::atomic<int> left = -1;
  };
  FencePainter(std::unique_ptr<Painter> painter, std::shared_ptr<Counts> counts)
      : painter_(std::move(painter)), counts_(std::move(counts)) {}
  ~FencePainter() override {
    painter_.reset();
    int left = 0;
    if (context_ != nullptr) {
      context_->make_current();
      for (void* fence : fences_) left += glIsSync(static_cast<GLsync>(fence)) == GL_TRUE ? 1 : 0;
      context_->release();
    }
    counts_->left = left;
  }
  DrawnImage paint(const ImageRequest& request) override {
    context_ = request.place.context;
    DrawnImage drawn = painter_->paint(request);
    if (drawn.drawn != nullptr) {
      fences_.push_back(drawn.drawn);
      ++counts_->made;
    }
    return drawn;
  }

 private:
  std::unique_ptr<Painter> painter_;
  std::shared_ptr<Counts> counts_;
  DrawContext* context_ = nullptr;
  std::vector<void*> fences_;
};

class SharedImagesTest : public ExploreWindowTest {
 protected:
  void open_with(explore::DrawContextChoice choice, bool has_gpu = false,
                 core::Backend backend = core::Backend::kPolygon) {
    window_.reset();
    extra_.preferences.context = choice;
    extra_.has_gpu = has_gpu;
    extra_.session.start = mars::Pose{20, 10, 30'000, 30, -25, 0};
    ASSERT_EQ(extra_.session.settings.set("exaggeration", "4"), "");
    open(960, 540, backend);
  }
  const SharedImages& shared() const { return window_->shared_images(); }
  // Shows another place and waits for its image.
  void show_view_of(const mars::Pose& pose) {
    window_->session().put(pose);
    settle();
  }
  core::RgbImage captured() {
    core::RgbImage image;
    window_->capture(&image);
    for (int n = 0; n < 200 && image.pixels.empty(); ++n) key("Shift_L");
    window_->capture(nullptr);
    return image;
  }
  static int largest_difference(const core::RgbImage& a, const core::RgbImage& b) {
    EXPECT_FALSE(a.pixels.empty());
    EXPECT_EQ(a.width, b.width);
    if (a.pixels.size() != b.pixels.size()) return 255;
    int largest = 0;
    for (std::size_t n = 0; n < a.pixels.size(); ++n) {
      const base::Rgb& p = a.pixels[n];
      const base::Rgb& q = b.pixels[n];
      largest = std::max({largest, std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)});
    }
    return largest;
  }
  // Returns the largest difference of the middle of the view, where no panel is, to what the window shows.
  int difference_on_screen() {
    const core::RgbImage shown = captured();
    const core::RgbImage& image = window_->image();
    const int x0 = shown.width - image.width;
    int largest = 0;
    for (int y = image.height / 3; y < image.height * 2 / 3; ++y) {
      for (int x = image.width / 3; x < image.width * 2 / 3; ++x) {
        const base::Rgb p = shown.pixels[static_cast<std::size_t>(y * shown.width + x + x0)];
        const base::Rgb q = image.pixels[static_cast<std::size_t>(y * image.width + x)];
        largest = std::max({largest, std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)});
      }
    }
    return largest;
  }

  // Of smoothed edges, by their rounding (gl::kFinishError).
  static constexpr int kMostDifference = 3;
  const std::vector<mars::Pose> poses_{
      {20, 10, 30'000, 30, -25, 0}, {-40, -20, 8'000, 200, -15, 12}, {100, 60, 150'000, 0, -90, 0}};
};

TEST_F(SharedImagesTest, BothWaysShowTheSame) {
  open_with(explore::DrawContextChoice::kOwn);
  ASSERT_NE(shared().why_not(), "");
  std::vector<core::RgbImage> expected;
  for (const mars::Pose& pose : poses_) {
    show_view_of(pose);
    expected.push_back(window_->image());
    EXPECT_FALSE(window_->drawn()->is_in_texture);
  }
  EXPECT_EQ(shared().count(), 0);
  EXPECT_EQ(shared().bytes(), 0U);
  open_with(explore::DrawContextChoice::kShared);
  ASSERT_EQ(shared().why_not(), "");
  for (std::size_t n = 0; n < poses_.size(); ++n) {
    show_view_of(poses_[n]);
    ASSERT_TRUE(window_->shows_final_image());
    EXPECT_TRUE(window_->drawn()->is_in_texture);
    EXPECT_TRUE(window_->drawn()->image.pixels.empty());
    EXPECT_FALSE(window_->drawn()->grids.empty());
    EXPECT_LE(largest_difference(window_->image(), expected[n]), kMostDifference) << n;
    EXPECT_LE(difference_on_screen(), 1) << n;
  }
  EXPECT_EQ(window_->images(), shared().count());
  const core::RgbImage& image = window_->image();
  EXPECT_EQ(shared().bytes(),
            2 * 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
}

TEST_F(SharedImagesTest, OverlaysAndRaysAreDrawnAsBefore) {
  open_with(explore::DrawContextChoice::kShared);
  settle();
  ASSERT_TRUE(window_->drawn()->is_in_texture);
  const core::RgbImage plain = window_->image();
  ASSERT_EQ(window_->session().set("overlay.scale", "on"), "");
  settle();
  EXPECT_FALSE(window_->drawn()->is_in_texture);
  EXPECT_GT(largest_difference(window_->image(), plain), 50);
  EXPECT_LE(difference_on_screen(), 1);
  ASSERT_EQ(window_->session().set("overlay.scale", "off"), "");
  settle();
  EXPECT_TRUE(window_->drawn()->is_in_texture);
  EXPECT_EQ(window_->image().pixels, plain.pixels);
}

TEST_F(SharedImagesTest, ALostContextLeavesThePaintersOwn) {
  wrap_painter_ = [](std::unique_ptr<Painter> painter) -> std::unique_ptr<Painter> {
    return std::make_unique<LostPainter>(std::move(painter));
  };
  open_with(explore::DrawContextChoice::kShared);
  settle();
  EXPECT_EQ(shared().why_not(), "");
  EXPECT_EQ(window_->state().image_error, "");
  EXPECT_TRUE(window_->shows_final_image());
  EXPECT_FALSE(window_->drawn()->is_in_texture);
  EXPECT_FALSE(window_->image().pixels.empty());
  EXPECT_LE(difference_on_screen(), 1);
}

TEST_F(SharedImagesTest, AWindowThatClosesBeforeItTakesItsImageLeavesNoFence) {
  const auto counts = std::make_shared<FencePainter::Counts>();
  wrap_painter_ = [&](std::unique_ptr<Painter> painter) -> std::unique_ptr<Painter> {
    return std::make_unique<FencePainter>(std::move(painter), counts);
  };
  open_with(explore::DrawContextChoice::kShared);
  settle();
  ASSERT_TRUE(window_->drawn()->is_in_texture);
  // Images are drawn until one is finished that the window has not taken.
  int taken = shared().count();
  for (int n = 0; n < 100 && counts->made == taken; ++n) {
    window_->session().put({20.0 + n, 10, 30'000, 30, -25, 0});
    iterate(1);
    for (int wait = 0; wait < 200 && counts->made == shared().count(); ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    taken = shared().count();
  }
  ASSERT_GT(counts->made, taken);
  window_.reset();
  EXPECT_EQ(counts->left, 0);
}

TEST_F(SharedImagesTest, AutoNeedsAGpu) {
  open_with(explore::DrawContextChoice::kAuto, false);
  EXPECT_EQ(shared().why_not(), "there is no GPU");
  settle();
  EXPECT_FALSE(window_->drawn()->is_in_texture);
  // A GPU that this display does not use: the painter finds that out.
  open_with(explore::DrawContextChoice::kAuto, true);
  EXPECT_EQ(shared().why_not(), "");
  settle();
  EXPECT_TRUE(window_->shows_final_image());
  EXPECT_FALSE(window_->drawn()->is_in_texture);
}

TEST_F(SharedImagesTest, ImagesFollowTheCameraAndKeepTheirSize) {
  open_with(explore::DrawContextChoice::kShared);
  settle();
  robot_->key_down("Up");
  iterate(60);
  robot_->key_up("Up");
  settle();
  EXPECT_TRUE(window_->drawn()->is_in_texture);
  EXPECT_GT(shared().count(), 2);
  const int before = window_->image().height;
  glfwSetWindowSize(window_->display().handle(), 800, 500);
  settle();
  EXPECT_LT(window_->image().height, before);
  EXPECT_EQ(window_->image().height, window_->session().view().height);
  EXPECT_LE(difference_on_screen(), 1);
}

}  // namespace
}  // namespace vpe::window
