// A finer planet file replaces the first one while the window is open.
#include <atomic>
#include <future>
#include <stdexcept>
#include <thread>

#include "tests/window/explore_window_fixture.h"

namespace vpe::window {
namespace {

class FinerPlanet : public ExploreWindowTest {
 protected:
  // Opens the window on a planet of posts 600 km apart; finer_ is made when the test says so.
  void open_coarse() {
    planet_ = test_support::build_fake(folder_ / "coarse.vpe",
                                       test_support::FakeElevation(test_support::bumpy_height), 600'000);
    extra_.make_finer = [this](const std::stop_token& stop,
                               const TellProgress& tell) -> std::optional<ShownPlanet> {
      tell(0.25);
      begun_ = true;
      while (!may_end_) {
        if (stop.stop_requested()) {
          stopped_ = true;
          return std::nullopt;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      if (fails_) throw std::runtime_error("the disk is full");
      app::Common common;
      common.memory_mb = 256;
      return ShownPlanet{
          finer_, std::make_shared<const paging::Surface>(finer_, std::size_t{32} << 20),
          [common, file = finer_] { return std::make_unique<app::WindowPainter>(file, common); }};
    };
    open();
    settle();
    for (int n = 0; n < 20'000 && !begun_; ++n) iterate(1);
    ASSERT_TRUE(begun_);
  }

  std::shared_ptr<const paging::PlanetFile> finer_ = planet();
  std::atomic<bool> begun_{false}, may_end_{false}, stopped_{false}, fails_{false};
};

TEST_F(FinerPlanet, ReplacesTheFirstOneInPlace) {
  open_coarse();
  EXPECT_NE(window_->state().message.find("coarse ground"), std::string::npos) << window_->state().message;
  window_->session().put({20, 10, 400'000, 30, -50, 0});
  settle();
  ASSERT_TRUE(window_->shows_final_image());
  const auto coarse_image = window_->image().pixels;
  const mars::Pose pose = window_->session().pose();
  may_end_ = true;
  for (int n = 0; n < 20'000 && &window_->session().surface().planet() != finer_.get(); ++n) iterate(1);
  ASSERT_EQ(&window_->session().surface().planet(), finer_.get());
  EXPECT_EQ(window_->state().message, "the planet is complete");
  settle();
  EXPECT_TRUE(window_->shows_final_image());
  EXPECT_EQ(window_->session().pose().lon_deg, pose.lon_deg);
  EXPECT_EQ(window_->session().pose().alt_m, pose.alt_m);
  EXPECT_NE(window_->image().pixels, coarse_image);
  EXPECT_EQ(window_->next_planet(), nullptr);
}

TEST_F(FinerPlanet, TheCameraStaysAboveItsGround) {
  open_coarse();
  const mars::Pose low{20, 10, window_->session().surface().at(mars::direction({20, 10})).height_m + 2,
                       0,  0,  0};
  window_->session().put(low);
  may_end_ = true;
  for (int n = 0; n < 20'000 && &window_->session().surface().planet() != finer_.get(); ++n) iterate(1);
  EXPECT_GT(window_->session().height_m(), 0);
}

TEST_F(FinerPlanet, TheWindowFileTellsProgressAndStopsIt) {
  open_coarse();
  ASSERT_EQ(window_->act({explore::ActionKind::kFiles}), "");
  click("file/Stop##planet");
  for (int n = 0; n < 20'000 && !stopped_; ++n) iterate(1);
  EXPECT_TRUE(stopped_);
  EXPECT_TRUE(waits_for("file/Stop##planet", false));
  EXPECT_FALSE(window_->state().message_is_error);
  EXPECT_NE(&window_->session().surface().planet(), finer_.get());
}

TEST_F(FinerPlanet, ClosingTheWindowStopsIt) {
  open_coarse();
  window_.reset();
  EXPECT_TRUE(stopped_);
}

TEST_F(FinerPlanet, AFailureIsShownAndTheFirstOneStays) {
  open_coarse();
  fails_ = may_end_ = true;
  for (int n = 0; n < 20'000 && !window_->state().message_is_error; ++n) iterate(1);
  EXPECT_EQ(window_->state().message, "the disk is full");
  EXPECT_EQ(&window_->session().surface().planet(), planet_.get());
}

}  // namespace
}  // namespace vpe::window
