// Tests of entering and leaving the panorama of a hotspot.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/window/explore_window_fixture.h"
#include "vpe/app/panorama/panorama_painter.h"
#include "vpe/core/image/image.h"
#include "vpe/explore/files/session_log.h"

namespace vpe::window {
namespace {

class HotspotsTest : public ExploreWindowTest {
 protected:
  // Makes a full circle of 720 columns whose red is the azimuth.
  std::filesystem::path make_panorama() {
    core::RgbImage image{720, 180, {}};
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        image.pixels.push_back({static_cast<std::uint8_t>(x * 255 / 720), static_cast<std::uint8_t>(y), 90});
    const std::filesystem::path file = folder_ / "turn.png";
    core::write_image(file.string(), image.pixels, image.width, image.height);
    std::ofstream(folder_ / "turn.json")
        << R"({"image": "turn.png", "projection": "equirectangular", "width": 720, "height": 180,
 "azimuth_deg_at_left": -180, "degrees_per_pixel": 0.5, "horizon_row": 90})";
    return folder_ / "turn.json";
  }
};

TEST_F(HotspotsTest, EnterOpensAndEscapeLeaves) {
  explore::Hotspot hotspot;
  hotspot.name = "Ridge";
  hotspot.place = {30, 10};
  hotspot.height_m = 20;
  hotspot.panorama = make_panorama();
  extra_.hotspots = {hotspot};
  extra_.open_overlook = [](const std::filesystem::path& file) {
    return app::overlook_setup({file.string(), {}, {}}, std::size_t{64} << 20, 2);
  };
  extra_.log = folder_ / "log.flight";
  open();
  key("Return");  // nothing is near
  EXPECT_EQ(window_->overlook(), nullptr);
  EXPECT_TRUE(window_->state().message_is_error);

  const double ground_m = window_->session().ground().height_m(mars::direction(hotspot.place));
  window_->session().put({30.0, 10.0005, ground_m + 60, 180, -20, 0});
  settle();
  EXPECT_NE(window_->state().message.find("Ridge"), std::string::npos);
  const mars::Pose before = window_->session().pose();
  key("Return");
  settle();
  ASSERT_NE(window_->overlook(), nullptr);
  EXPECT_NEAR(std::remainder(window_->overlook()->viewer().yaw_deg() - before.yaw_deg, 360.0), 0, 1e-3);
  const double yaw_deg = window_->overlook()->viewer().yaw_deg();
  robot_->key_down("Right");
  iterate(10);
  robot_->key_up("Right");
  settle();
  EXPECT_GT(window_->overlook()->viewer().yaw_deg(), yaw_deg);
  const double rotated_deg = window_->overlook()->viewer().yaw_deg();
  // Actions that would move the camera, which is not shown, are rejected.
  key("Home");
  EXPECT_TRUE(window_->state().message_is_error);
  click("map");
  settle();
  key("Escape");
  settle();
  EXPECT_EQ(window_->overlook(), nullptr);
  EXPECT_EQ(window_->session().pose().lon_deg, before.lon_deg);
  EXPECT_EQ(window_->session().pose().yaw_deg, before.yaw_deg);
  window_.reset();

  std::ifstream in(folder_ / "log.flight");
  std::stringstream text;
  text << in.rdbuf();
  EXPECT_TRUE(scripts::parse_flight(text.str(), "log").flight.has_value());
  const std::vector<explore::OverlookStep> steps = explore::overlook_steps(text.str());
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].hotspot, "Ridge");
  EXPECT_FALSE(steps[1].in);
  // In playback the camera stands at the hotspot and the head has the direction of the overlook's view.
  const scripts::Path path(*scripts::parse_flight(text.str(), "log").flight, planet_->radius_m(),
                           [](mars::LonLat, double) { return 0.0; });
  const scripts::FlightState before_out = path.at(steps[1].time_s - 1e-3);
  EXPECT_NEAR(before_out.pose.lon_deg, hotspot.place.lon_deg, 1e-9);
  EXPECT_NEAR(before_out.pose.lat_deg, hotspot.place.lat_deg, 1e-9);
  EXPECT_NEAR(before_out.pose.alt_m, ground_m + hotspot.height_m, 1e-3);
  EXPECT_NEAR(std::remainder(before_out.pose.yaw_deg + before_out.head.yaw_deg - rotated_deg, 360.0), 0, 1e-6);
}

}  // namespace
}  // namespace vpe::window
