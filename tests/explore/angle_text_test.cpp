#include "vpe/explore/measure/angle_text.h"

#include <gtest/gtest.h>

namespace vpe::explore {
namespace {

TEST(AngleText, ZeroHasNoSign) {
  EXPECT_EQ(angle_text(-0.0, 1), "0.0");
  EXPECT_EQ(angle_text(-0.04, 1), "0.0");
  EXPECT_EQ(angle_text(-0.0004, 3), "0.000");
  EXPECT_EQ(angle_text(-0.06, 1), "-0.1");
  EXPECT_EQ(angle_text(12.34, 1), "12.3");
}

TEST(AngleText, AHeadingIsBelow360AlsoAfterRounding) {
  EXPECT_EQ(heading_text(360, 1), "0.0");
  EXPECT_EQ(heading_text(359.96, 1), "0.0");
  EXPECT_EQ(heading_text(359.94, 1), "359.9");
  EXPECT_EQ(heading_text(-0.01, 1), "0.0");
  EXPECT_EQ(heading_text(-0.0, 0), "0");
  EXPECT_EQ(heading_text(-90, 1), "270.0");
  EXPECT_EQ(heading_text(725, 0), "5");
  EXPECT_EQ(heading_text(-1e-18, 2), "0.00");
}

}  // namespace
}  // namespace vpe::explore
