#include "vpe/explore/input/gamepad.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "vpe/explore/input/controls.h"

namespace vpe::explore {
namespace {

constexpr PadOptions kStraight{.dead_zone = 0, .trigger_dead_zone = 0, .curve = 1};

PadState with(PadAxis axis, float value) {
  PadState state;
  state.axes[static_cast<std::size_t>(axis)] = value;
  return state;
}

PadState pressed(PadButton button) {
  PadState state;
  state.buttons[static_cast<std::size_t>(button)] = 1;
  return state;
}

TEST(Gamepad, AtRestAllRatesAreZero) {
  EXPECT_EQ(pad_controls(PadState{}, {}), Controls{});
  // Worn sticks do not come back to their middle.
  PadState worn;
  worn.axes = {0.1F, -0.1F, 0.05F, 0.12F, -0.9F, -0.95F};
  EXPECT_EQ(pad_controls(worn, {}), Controls{});
}

TEST(Gamepad, EachPartHasItsOwnRate) {
  const auto c = [](PadAxis axis, float value) { return pad_controls(with(axis, value), kStraight); };
  EXPECT_EQ(c(PadAxis::kLeftX, 0.5F), (Controls{.right = 0.5}));
  EXPECT_EQ(c(PadAxis::kLeftY, -1), (Controls{.forward = 1}));  // pushed away
  EXPECT_EQ(c(PadAxis::kRightX, -0.5F), (Controls{.yaw_right = -0.5}));
  EXPECT_EQ(c(PadAxis::kRightY, -0.5F), (Controls{.pitch_up = 0.5}));
  EXPECT_EQ(c(PadAxis::kRightTrigger, 0), (Controls{.up = 0.5}));
  EXPECT_EQ(c(PadAxis::kLeftTrigger, 1), (Controls{.up = -1}));
  EXPECT_EQ(pad_controls(pressed(PadButton::kRightBumper), {}), (Controls{.roll_right = 1}));
  EXPECT_EQ(pad_controls(pressed(PadButton::kLeftBumper), {}), (Controls{.roll_right = -1}));
  EXPECT_EQ(pad_controls(pressed(PadButton::kLeftStick), {}), (Controls{.speed = PadOptions::kFaster}));
  EXPECT_EQ(pad_controls(pressed(PadButton::kRightStick), {}), (Controls{.speed = PadOptions::kSlower}));
  PadOptions inverted = kStraight;
  inverted.invert_pitch = true;
  EXPECT_EQ(pad_controls(with(PadAxis::kRightY, -0.5F), inverted), (Controls{.pitch_up = -0.5}));
}

TEST(Gamepad, ADeadZoneIsRoundAndHasNoStepAtItsEdge) {
  const double zone = 0.2;
  EXPECT_EQ(stick_rates({0.14, 0.14}, zone, 2), glm::dvec2(0));  // length 0.198
  EXPECT_NE(stick_rates({0.15, 0.15}, zone, 2), glm::dvec2(0));  // each alone would be within it
  EXPECT_LT(stick_rates({0.2001, 0}, zone, 1).x, 2e-4);
  EXPECT_NEAR(stick_rates({0.6, 0}, zone, 1).x, 0.5, 1e-12);
  EXPECT_NEAR(stick_rates({0.6, 0}, zone, 2).x, 0.25, 1e-12);
  EXPECT_EQ(stick_rates({1, 0}, zone, 3).x, 1);
  // Square sticks reach (1, 1): the direction is kept, the rate is that of full deflection.
  const glm::dvec2 corner = stick_rates({1, -1}, zone, 2);
  EXPECT_NEAR(std::hypot(corner.x, corner.y), 1, 1e-12);
  EXPECT_EQ(corner.x, -corner.y);
}

RC_GTEST_PROP(GamepadProperty, AnyStateIsWithinLimits, ()) {
  PadState state;
  for (float& axis : state.axes) {
    axis = *rc::gen::oneOf(rc::gen::arbitrary<float>(),
                           rc::gen::element(std::numeric_limits<float>::quiet_NaN(),
                                            std::numeric_limits<float>::infinity(), -1.0F, 1.0F));
  }
  for (std::uint8_t& button : state.buttons) button = *rc::gen::arbitrary<std::uint8_t>();
  const Controls c = pad_controls(state, {});
  for (const double rate : {c.right, c.up, c.forward, c.yaw_right, c.pitch_up, c.roll_right}) {
    RC_ASSERT(std::abs(rate) <= 1 + 1e-12);
  }
  RC_ASSERT(c.speed >= PadOptions::kSlower && c.speed <= PadOptions::kFaster);
}

RC_GTEST_PROP(GamepadProperty, LargerDeflectionIsNeverSlower, ()) {
  const double zone = 0.01 * *rc::gen::inRange(0, 90);
  const double curve = 0.1 * *rc::gen::inRange(10, 50);
  double before = 0;
  for (int n = 0; n <= 200; ++n) {
    const double rate = axis_rate(n / 200.0, zone, curve);
    RC_ASSERT(rate >= before && rate <= 1);
    RC_ASSERT(axis_rate(-n / 200.0, zone, curve) == -rate);
    before = rate;
  }
  RC_ASSERT(before == 1.0);
}

TEST(Gamepad, AButtonActsWhenItGoesDown) {
  Gamepad pad;
  const std::vector<Action> none;
  EXPECT_EQ(pad.read(PadState{}, {}).actions, none);
  EXPECT_EQ(pad.read(pressed(PadButton::kStart), {}).actions, (std::vector<Action>{{ActionKind::kPlayPause}}));
  EXPECT_EQ(pad.read(pressed(PadButton::kStart), {}).actions, none);
  EXPECT_EQ(pad.read(PadState{}, {}).actions, none);
  EXPECT_EQ(pad.read(pressed(PadButton::kStart), {}).actions.size(), 1U);
}

TEST(Gamepad, UnpluggedIsRestAndPluggingInIsNoPress) {
  Gamepad pad;
  PadState state = pressed(PadButton::kA);
  state.axes[0] = 1;
  EXPECT_TRUE(pad.read(state, {}).actions.empty());
  EXPECT_EQ(pad.read(state, {}).controls.right, 1);
  const PadReading gone = pad.read(std::nullopt, {});
  EXPECT_EQ(gone.controls, Controls{});
  EXPECT_TRUE(gone.actions.empty());
  EXPECT_TRUE(pad.read(state, {}).actions.empty());
}

TEST(Gamepad, TriggersThatHaveReportedNothingAreAtRest) {
  Gamepad pad;
  PadState fresh;
  fresh.axes[4] = fresh.axes[5] = 0;  // "half pressed"
  EXPECT_EQ(pad.read(fresh, {}).controls, Controls{});
  PadState used = fresh;
  used.axes[5] = 0.2F;
  EXPECT_GT(pad.read(used, {}).controls.up, 0.1);
  EXPECT_GT(pad.read(fresh, {}).controls.up, 0.1);  // now 0 is what it says
  pad.read(std::nullopt, {});
  EXPECT_EQ(pad.read(fresh, {}).controls, Controls{});
}

TEST(Gamepad, NoButtonHasTwoActions) {
  std::set<PadButton> used{PadButton::kLeftBumper, PadButton::kRightBumper, PadButton::kLeftStick,
                           PadButton::kRightStick};
  for (const PadBinding& binding : pad_bindings()) {
    EXPECT_TRUE(used.insert(binding.button).second) << static_cast<int>(binding.button);
  }
}

}  // namespace
}  // namespace vpe::explore
