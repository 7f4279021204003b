// Tests what the window shows while the camera is dragged: ground about as fine as at rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "lod/options.h"
#include "lod/select.h"
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

// Returns the finest level that an image of triangles would have at rest in the view of the image that is shown.
int level_at_rest(const ExploreWindow& window, const paging::PlanetFile& planet) {
  core::DrawRequest request = window.drawn()->request.draw;
  request.coarsening = 1;
  lod::SelectScratch scratch;
  lod::Selection selection;
  lod::select(lod::select_options(request, planet.radius_m(), std::int64_t{1} << 40), planet.tree(),
              lod::select_view(request.view), scratch, selection);
  return static_cast<int>(selection.tiles_by_level.size()) - 1;
}

std::string describe(const ExploreWindow& window) {
  const core::DrawResult& r = window.drawn()->result;
  std::string text = "; tiles by level:";
  for (const int count : r.stats.tiles_by_level) text += " " + std::to_string(count);
  text += "; missing " + std::to_string(r.missing.size()) + ", substituted " +
          std::to_string(r.stats.tiles_substituted) + ", uploaded " + std::to_string(r.stats.pages_uploaded) +
          ", evicted " + std::to_string(r.stats.pages_evicted) + ", bytes " +
          std::to_string(r.stats.bytes_resident) + ", coarsening " +
          std::to_string(window.drawn()->request.draw.coarsening);
  for (std::size_t n = 0; n < std::min<std::size_t>(r.missing.size(), 8); ++n)
    text += " " + r.missing[n].tile + (r.missing[n].is_unreadable ? "!" : "");
  return text;
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
  ASSERT_EQ(extra_.session.settings.set("lod.frame_ms", "2"), "");
  open(640, 360, GetParam());
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
      move(480, 220);
      robot_->press();
      int images = 0;
      for (int n = 1; n <= 10; ++n) {
        const std::int64_t before = window_->images();
        move(480 + 5 * n, 220);
        for (int k = 0; k < 200 && window_->images() == before; ++k) iterate(1);
        images += window_->images() != before ? 1 : 0;
        // As the view moves, the ground of a level may leave it.
        const int here = GetParam() == core::Backend::kRay ? at_rest : level_at_rest(*window_, *planet_);
        EXPECT_GE(here, at_rest - 1);
        EXPECT_GE(finest_level(*window_), here - 1) << "drag " << drag << " image " << n << describe(*window_);
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

// Slow storage that stalls as soon as a motion begins: what is drawn is what was loaded when the image came to rest.
TEST_P(DragTest, AMotionOverStalledStorageKeepsTheGroundOfTheImageAtRest) {
  constexpr int kSlow_ms = 10;
  constexpr int kStalled_ms = 200;
  std::atomic<int> read_ms = kSlow_ms;
  painted_ = paging::PlanetFile::open((folder_ / "fine.vpe").string(), [&read_ms](const lod::TileKey&) {
    std::this_thread::sleep_for(std::chrono::milliseconds(read_ms));
  });
  ASSERT_EQ(extra_.session.settings.set("lod.frame_ms", "20"), "");
  open(640, 360, GetParam());
  for (const mars::Pose& pose : {mars::Pose{20, 29.8, 20'000, 0, -30, 0}, {20.1, 29.9, 9'000, 300, -20, 0}}) {
    for (int drag = 0; drag < 3; ++drag) {
      mars::Pose from = pose;
      from.lon_deg += 0.3 * drag;
      window_->session().put(from);
      settle();
      const int at_rest = finest_level(*window_);
      move(480, 220);
      robot_->press();
      read_ms = kStalled_ms;
      for (int n = 1; n <= 10; ++n) {
        const std::int64_t before = window_->images();
        move(480 + 5 * n, 220 + 5 * n);
        for (int k = 0; k < 400 && window_->images() == before; ++k) iterate(1);
        EXPECT_GT(window_->images(), before);
        EXPECT_GE(finest_level(*window_), at_rest - 1) << "drag " << drag << " image " << n;
      }
      robot_->release();
      read_ms = kSlow_ms;
    }
  }
  settle();
  window_.reset();  // its threads use `read_ms`
}

// The image of the former appearance stands until the tiles of the next one are there.
TEST_P(DragTest, AChangeOfAppearanceKeepsTheGroundThatIsSeen) {
  change_s_ = 300;  // a slow machine reads them all, too
  open(640, 360, GetParam());
  window_->session().put({20.1, 29.9, 9'000, 300, -20, 0});
  settle();
  const int at_rest = finest_level(*window_);
  ASSERT_GT(at_rest, 3);
  const std::vector<std::pair<std::string, std::string>> changes{
      {"exaggeration", "2"},  {"colour", "slope"},    {"mode", "coloured"},
      {"shading", "flat"},    {"mode", "lit"},        {"exaggeration", "1.5"},
      {"shading", "gouraud"}, {"sun.azimuth", "200"}, {"mode", "textured"}};
  for (const auto& [key, value] : changes) {
    ASSERT_EQ(window_->session().set(key, value), "") << key;
    const std::int64_t before = window_->images();
    for (int n = 0; n < 30'000 && window_->images() == before; ++n) iterate(1);
    ASSERT_GT(window_->images(), before) << key;
    EXPECT_GE(finest_level(*window_), at_rest - 1) << key << " " << value;
    EXPECT_TRUE(window_->drawn()->result.missing.empty()) << key << " " << value;
    settle();
  }
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
  for (int n = 0; n < 20'000 && window_->drawn()->request.backend == core::Backend::kPolygon; ++n) iterate(1);
  EXPECT_TRUE(window_->drawn()->result.missing.empty()) << "the first image is complete";
  settle();
  EXPECT_TRUE(window_->shows_final_image());
}

}  // namespace
}  // namespace vpe::window
