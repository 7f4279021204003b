// Tests what the window shows while the camera is dragged: ground about as fine as at rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/window/explore_window_fixture.h"

namespace vpe::window {
namespace {

// Returns the finest level in the image that is shown.
int finest_level(const ExploreWindow& window) {
  const std::vector<int>& tiles = window.drawn()->result.stats.tiles_by_level;
  int finest = 0;
  for (std::size_t level = 0; level < tiles.size(); ++level)
    if (tiles[level] > 0) finest = static_cast<int>(level);
  return finest;
}

class DragTest : public ExploreWindowTest, public testing::WithParamInterface<core::Backend> {
 protected:
  DragTest() {
    const auto rough = [](const glm::dvec3& d) {
      return 0.2 * test_support::bumpy_height(d) + 400 * std::sin(900 * d.x) * std::sin(870 * d.y + 3 * d.z);
    };
    planet_ = test_support::build_fake(
        folder_ / "fine.vpe",
        test_support::FakeElevation(rough, test_support::fine_around(mars::direction({20, 30}), 0.02, 500)),
        60'000);
  }
};

TEST_P(DragTest, AMotionBeginsWithTheGroundOfTheImageAtRest) {
  ASSERT_EQ(extra_.session.settings.set("lod.frame_ms", "20"), "");
  open(960, 540, GetParam());
  ASSERT_GE(planet_->meta().finest_level, 5);
  int drags = 0;
  for (const mars::Pose& pose : {mars::Pose{20, 30, 60'000, 30, -90, 0},
                                 {20, 29.8, 20'000, 0, -30, 0},
                                 {20.1, 29.9, 9'000, 300, -20, 0},
                                 {20, 30, 400'000, 30, -60, 0}}) {
    window_->session().put(pose);
    settle();
    for (int drag = 0; drag < 5; ++drag, ++drags) {
      const int at_rest = finest_level(*window_);
      ASSERT_GT(at_rest, 0);
      move(700, 350);
      robot_->press();
      int images = 0;
      for (int n = 1; n <= 10; ++n) {
        const std::int64_t before = window_->images();
        move(700 + 5 * n, 350);
        for (int k = 0; k < 200 && window_->images() == before; ++k) iterate(1);
        images += window_->images() != before ? 1 : 0;
        EXPECT_GE(finest_level(*window_), at_rest - 1) << "drag " << drag << " image " << n;
        EXPECT_TRUE(std::isfinite(window_->drawn()->result.certificate.shift_bound_px));
      }
      EXPECT_GE(images, 8);
      robot_->release();
      settle();
      EXPECT_TRUE(window_->shows_final_image());
    }
  }
  EXPECT_EQ(drags, 20);
}

INSTANTIATE_TEST_SUITE_P(Backends, DragTest, testing::Values(core::Backend::kPolygon, core::Backend::kRay),
                         [](const auto& backend) { return std::string(core::to_string(backend.param)); });

// What draws changes with the height, and the former image stands until the new backend's is there.
TEST_F(ExploreWindowTest, AutoChangesTheBackendOnTheWay) {
  extra_.has_gpu = false;
  open(960, 540, core::Backend::kRay);
  window_->session().put({20, 30, 50'000, 0, -30, 0});
  click("Auto");
  settle();
  EXPECT_EQ(window_->drawn()->request.backend, core::Backend::kRay);
  EXPECT_TRUE(window_->drawn()->request.is_auto);
  window_->session().put({20, 30, 5'000'000, 0, -90, 0});
  settle();
  EXPECT_EQ(window_->drawn()->request.backend, core::Backend::kPolygon);
  EXPECT_TRUE(window_->drawn()->result.missing.empty());
  window_->session().put({20, 30, 50'000, 0, -30, 0});
  for (int n = 0; n < 2000 && window_->drawn()->request.backend == core::Backend::kPolygon; ++n) iterate(1);
  EXPECT_TRUE(window_->drawn()->result.missing.empty()) << "the first image is complete";
  settle();
  EXPECT_TRUE(window_->shows_final_image());
}

}  // namespace
}  // namespace vpe::window
