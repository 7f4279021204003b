// Intervals and rectangles of shapes of relief.
#include "relief/shape.h"

#include <gtest/gtest.h>

namespace relief {
namespace {

TEST(ReliefShape, TheHullHoldsBothIntervals) {
  const Interval found = hull({-1, 2}, {5, 7});
  EXPECT_EQ(found.low, -1);
  EXPECT_EQ(found.high, 7);
}

TEST(ReliefShape, TheSumHoldsAllSums) {
  const Interval found = sum({-1, 2}, {5, 7});
  EXPECT_EQ(found.low, 4);
  EXPECT_EQ(found.high, 9);
}

TEST(ReliefShape, RectanglesThatTouchOverlap) {
  const Rect rect{0, 0, 2, 1};
  EXPECT_TRUE(overlap(rect, {2, 1, 3, 3}));
  EXPECT_TRUE(overlap(rect, {-5, -5, 5, 5}));
  EXPECT_FALSE(overlap(rect, {2.5, 0, 3, 1}));
  EXPECT_FALSE(overlap(rect, {0, -2, 2, -0.5}));
}

}  // namespace
}  // namespace relief
