#include "vpe/explore/input/controls.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace vpe::explore {
namespace {

TEST(Controls, OfSeveralDevicesAddUpToTheirLimits) {
  const std::array<Controls, 3> devices{Controls{.right = 0.5, .forward = 1, .speed = 4},
                                        Controls{.right = -0.25, .forward = 1, .pitch_up = -0.5, .speed = 0.5},
                                        Controls{}};
  EXPECT_EQ(combine(devices), (Controls{.right = 0.25, .forward = 1, .pitch_up = -0.5, .speed = 2}));
  EXPECT_FALSE(any(combine({})));
  EXPECT_TRUE(any(combine(devices)));
}

TEST(Controls, NumbersThatAreNotFiniteCountAsRest) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::array<Controls, 1> devices{Controls{.right = nan, .up = 1, .roll_right = -nan, .speed = nan}};
  EXPECT_EQ(combine(devices), (Controls{.up = 1}));
}

}  // namespace
}  // namespace vpe::explore
