// The explore window between two images: the last one follows the camera.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "tests/window/explore_window_fixture.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::window {
namespace {

// Holds images back while it is closed.
class Gate {
 public:
  void close() {
    const std::lock_guard lock(mutex_);
    is_open_ = false;
  }
  void open() {
    const std::lock_guard lock(mutex_);
    is_open_ = true;
    changed_.notify_all();
  }
  void pass() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_open_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = true;
};

// Draws as another painter does, but later.
class LatePainter : public Painter {
 public:
  LatePainter(std::unique_ptr<Painter> painter, Gate& gate, std::chrono::milliseconds wait)
      : painter_(std::move(painter)), gate_(gate), wait_(wait) {}
  DrawnImage paint(const ImageRequest& request) override {
    std::this_thread::sleep_for(wait_);
    gate_.pass();
    return painter_->paint(request);
  }

 private:
  std::unique_ptr<Painter> painter_;
  Gate& gate_;
  std::chrono::milliseconds wait_;
};

class MovedImageTest : public ExploreWindowTest {
 protected:
  void TearDown() override {
    gate_.open();
    ExploreWindowTest::TearDown();
  }
  void open_with(explore::Warp warp, core::Backend backend = core::Backend::kRay,
                 std::chrono::milliseconds wait = std::chrono::milliseconds(0), bool panels = false) {
    extra_.preferences.warp = warp;
    extra_.panels = panels;
    extra_.session.start = start_;
    ASSERT_EQ(extra_.session.settings.set("exaggeration", "20"), "");
    wrap_painter_ = [this, wait](std::unique_ptr<Painter> painter) -> std::unique_ptr<Painter> {
      return std::make_unique<LatePainter>(std::move(painter), gate_, wait);
    };
    open(static_cast<int>(view_.width), static_cast<int>(view_.height), backend);
  }
  // Moves the camera while no image is made, and returns what the window shows then.
  core::RgbImage shown_at(const mars::Pose& pose) {
    gate_.close();
    window_->session().put(pose);
    core::RgbImage image;
    window_->capture(&image);
    // A key that does nothing has the window drawn also where the image stands still.
    for (int n = 0; n < 200 && image.pixels.empty(); ++n) key("Shift_L");
    window_->capture(nullptr);
    EXPECT_FALSE(image.pixels.empty());
    gate_.open();
    return image;
  }
  // Draws what the window should show.
  core::RgbImage truth() const { return truth(window_->session().view()); }
  core::RgbImage truth(const core::View& view) const {
    core::DrawRequest request;
    request.view = view;
    request.settings = window_->session().settings().values();
    request.sun = app::sun_for(request.settings, window_->session().pose());
    core::Frame frame = voxel::make_ray_renderer(planet_, {std::size_t{64} << 20, 2})->draw(request).frame;
    return {frame.width, frame.height, std::move(frame.colour)};
  }
  // Returns the mean difference in the middle of the view, which no panel covers.
  double difference(const core::RgbImage& shown, const core::RgbImage& image) const {
    const ViewArea area = view_;
    double sum = 0;
    int count = 0;
    for (int y = image.height / 4; y < image.height * 3 / 4; ++y) {
      for (int x = image.width / 4; x < image.width * 3 / 4; ++x) {
        const base::Rgb a = shown.pixels[static_cast<std::size_t>((y + static_cast<int>(area.y)) * shown.width +
                                                                  x + static_cast<int>(area.x))];
        const base::Rgb b = image.pixels[static_cast<std::size_t>(y * image.width + x)];
        sum += std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
        ++count;
      }
    }
    return sum / (3.0 * count);
  }

  Gate gate_;
  ViewArea view_{0, 0, 640, 360};
  mars::Pose start_{20, 10, 900'000, 30, -60, 0};
};

TEST_F(MovedImageTest, FollowsTheCameraUntilTheNextImageIsThere) {
  struct Motion {
    const char* what;
    mars::Pose pose;
    double most;  // of the difference without
  };
  const std::vector<Motion> motions{{"a turn", {20, 10, 900'000, 36, -57, 2}, 0.35},
                                    {"a step ahead", {20.3, 10.6, 850'000, 30, -60, 0}, 0.6}};
  for (const core::Backend backend : {core::Backend::kRay, core::Backend::kPolygon}) {
    for (const explore::Warp warp : {explore::Warp::kGrid, explore::Warp::kPolynomial, explore::Warp::kCarry}) {
      for (const Motion& motion : motions) {
        open_with(warp, backend);
        const core::RgbImage before = window_->image();
        const core::RgbImage shown = shown_at(motion.pose);
        const core::RgbImage wanted = truth();
        const double still = difference(before, wanted);
        EXPECT_GT(still, 1.5) << motion.what;
        EXPECT_LT(difference(shown, wanted), motion.most * still)
            << motion.what << " " << core::to_string(backend) << " " << static_cast<int>(warp);
        settle();
        window_.reset();
      }
    }
  }
}

// Each eye of a pair is where it should be; red-cyan pairs stand still, as both images are one.
TEST_F(MovedImageTest, PairsFollowEyeByEye) {
  for (const auto& [name, layout] : {std::pair{"side by side", core::StereoLayout::kSideBySide},
                                     std::pair{"over and under", core::StereoLayout::kOverUnder},
                                     std::pair{"red and cyan", core::StereoLayout::kAnaglyph}}) {
    view_ = {0, 0, 960, 540};  // panels need the room
    open_with(explore::Warp::kGrid, core::Backend::kRay, {}, true);
    click("View");
    iterate(2);
    click("##eyes");
    click(std::string("##eyes=") + name);
    key("h");  // nothing lies over the view
    settle();
    ASSERT_EQ(window_->drawn()->request.stereo, layout);
    const core::RgbImage before = window_->image();
    const double base_m = window_->drawn()->request.eye_base_m;
    const core::RgbImage shown = shown_at({20, 10, 900'000, 36, -57, 2});
    const auto eye = [&](double aside_m) {
      return truth(core::eye_view(window_->session().view(), aside_m, {}));
    };
    const core::RgbImage wanted = core::combine_stereo(eye(-base_m / 2), eye(base_m / 2), layout);
    const double still = difference(before, wanted);
    EXPECT_GT(still, 1.5);
    const double share = difference(shown, wanted) / still;
    EXPECT_EQ(share < 0.4, layout != core::StereoLayout::kAnaglyph) << name << " " << share;
    settle();
    window_.reset();
  }
}

TEST_F(MovedImageTest, StandsStillWhereThatIsWanted) {
  open_with(explore::Warp::kOff);
  EXPECT_TRUE(window_->drawn()->grids.empty());
  const core::RgbImage before = window_->image();
  const core::RgbImage shown = shown_at({20, 10, 900'000, 36, -57, 2});
  EXPECT_LT(difference(shown, before), 0.5);
  settle();
}

// What lies over the image at fixed places must not swim.
TEST_F(MovedImageTest, StandsStillUnderAFixedOverlay) {
  ASSERT_EQ(extra_.session.settings.set("overlay.scale", "on"), "");
  open_with(explore::Warp::kGrid);
  const core::RgbImage before = window_->image();
  const core::RgbImage shown = shown_at({20, 10, 900'000, 36, -57, 2});
  EXPECT_LT(difference(shown, before), 0.5);
  settle();
}

// A camera that turns on has its images drawn with a margin, so that their border is not seen.
TEST_F(MovedImageTest, ImagesHaveAMarginWhileTheCameraTurns) {
  view_ = {0, 0, 320, 180};  // images that take half a second have no margin
  open_with(explore::Warp::kGrid, core::Backend::kRay, std::chrono::milliseconds(60));
  EXPECT_EQ(window_->drawn()->request.margin_px, glm::ivec2(0));
  robot_->key_down("Left");
  int widest = 0;
  for (int n = 0; n < 5000 && widest < 4; ++n) {
    ASSERT_TRUE(window_->step(0.02));
    widest = std::max(widest, window_->drawn()->request.margin_px.x);
    const core::View& view = window_->drawn()->request.draw.view;
    ASSERT_EQ(window_->image().width, view.width);
    ASSERT_EQ(window_->image().height, view.height);
  }
  robot_->key_up("Left");
  EXPECT_GE(widest, 4);
  settle();
  EXPECT_EQ(window_->drawn()->request.margin_px, glm::ivec2(0));
}

TEST_F(MovedImageTest, SlowImagesHaveSeveralFramesEachAndARestHasNone) {
  open_with(explore::Warp::kGrid, core::Backend::kRay, std::chrono::milliseconds(200));
  const std::int64_t images_before = window_->images();
  const std::int64_t frames_before = window_->frames();
  robot_->key_down("Left");
  const auto begun = std::chrono::steady_clock::now();
  for (int n = 0; n < 5000 && window_->images() < images_before + 6; ++n) ASSERT_TRUE(window_->step(0.05));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  robot_->key_up("Left");
  const auto frames = static_cast<double>(window_->frames() - frames_before);
  const auto images = static_cast<double>(window_->images() - images_before);
  std::printf("%.1f frames a second, %.1f for each image\n", frames / seconds, frames / images);
  // Some 13 on an idle machine; a busy one takes longer for a frame.
  EXPECT_GE(frames / images, 2);
  settle();
  const std::int64_t frames_at_rest = window_->frames();
  iterate(40);
  EXPECT_EQ(window_->frames(), frames_at_rest);
}

}  // namespace
}  // namespace vpe::window
