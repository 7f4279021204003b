// Tests of the devices in the panel View: live values, preferences that take effect and are kept.
#include "vpe/window/panels/devices_panel.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "tests/window/explore_window_fixture.h"

namespace vpe::window {
namespace {

using explore::PadAxis;

class DevicesPanelTest : public ExploreWindowTest {
 protected:
  void open_panel() {
    extra_.preferences_file = folder_ / "config/explore.toml";
    extra_.devices.pad = [pad = pad_] { return *pad; };
    extra_.devices.pad_name = [] { return std::string("Test Pad"); };
    open(1280, 1400);
    click("Devices");
    for (int n = 0; n < 20; ++n) iterate(1);
  }
  void set_axis(PadAxis axis, float value) { (*pad_)->axes[static_cast<std::size_t>(axis)] = value; }
  explore::Preferences kept() { return explore::read_preferences(folder_ / "config/explore.toml"); }

  std::shared_ptr<std::optional<explore::PadState>> pad_ = std::make_shared<std::optional<explore::PadState>>();
};

TEST_F(DevicesPanelTest, ShowsWhatADeviceSaysWhenItChanges) {
  open_panel();
  settle();
  EXPECT_FALSE(window_->devices().states(0).pad);
  *pad_ = explore::PadState{};
  iterate(5);
  ASSERT_TRUE(window_->devices().states(0).pad);
  EXPECT_EQ(window_->devices().states(0).pad->name, "Test Pad");
  settle();  // also with a gamepad: nothing is drawn while nothing changes
  const std::int64_t before = window_->frames();
  iterate(10);
  EXPECT_EQ(window_->frames(), before);
  set_axis(PadAxis::kLeftX, 0.05F);  // within the dead zone: nothing moves, but it is shown
  iterate(5);
  EXPECT_GT(window_->frames(), before);
  EXPECT_EQ(window_->devices().states(0).pad->controls.right, 0);
  EXPECT_EQ(window_->devices().states(0).pad->axes[0], 0.05F);
}

TEST_F(DevicesPanelTest, PreferencesTakeEffectAtOnceAndAreKept) {
  *pad_ = explore::PadState{};
  open_panel();
  window_->session().put({20, 10, 300'000, 0, -40, 0});
  set_axis(PadAxis::kRightY, -1);  // up
  iterate(6);
  EXPECT_GT(window_->session().pose().pitch_deg, -40);
  set_axis(PadAxis::kRightY, 0);
  iterate(3);
  click("devices/##gamepad.invert_pitch");
  iterate(3);
  EXPECT_TRUE(kept().gamepad.invert_pitch);
  const double pitch_deg = window_->session().pose().pitch_deg;
  set_axis(PadAxis::kRightY, -1);
  iterate(6);
  EXPECT_LT(window_->session().pose().pitch_deg, pitch_deg);
  set_axis(PadAxis::kRightY, 0);
  iterate(3);
  click("devices/##gamepad.dead_zone");
  for (const char* letter : {"0", "period", "4"}) key(letter);
  key("Return");
  iterate(3);
  EXPECT_EQ(kept().gamepad.dead_zone, 0.4);
  EXPECT_TRUE(kept().gamepad.invert_pitch);
  click("devices/##gamepad.enabled");
  iterate(3);
  EXPECT_FALSE(window_->devices().states(0).pad);
  EXPECT_FALSE(kept().use_gamepad);
}

TEST_F(DevicesPanelTest, AHeadTrackerIsSwitchedOnWhileTheWindowRuns) {
  extra_.preferences.head_from.port = 0;  // any free one
  open_panel();
  EXPECT_FALSE(window_->devices().tracker_port());
  click("devices/##head_tracker.enabled");
  iterate(3);
  EXPECT_TRUE(window_->devices().tracker_port());
  EXPECT_TRUE(kept().use_head_tracker);
  const auto states = window_->devices().states(0);
  ASSERT_TRUE(states.tracker);
  EXPECT_FALSE(states.tracker->is_live);
  click("devices/##head_tracker.enabled");
  iterate(3);
  EXPECT_FALSE(window_->devices().tracker_port());
}

}  // namespace
}  // namespace vpe::window
