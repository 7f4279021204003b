// Arithmetic of intervals against that of their members.
#include "relief/field/interval_algebra.h"

#include <gtest/gtest.h>

#include "tests/relief/samples.h"

namespace relief {
namespace {

TEST(ReliefIntervals, ResultsHoldThoseOfAllMembers) {
  samples::Random random(1);
  for (int n = 0; n < 2000; ++n) {
    const Interval a = between(random.in(-5.0, 5.0), random.in(-5.0, 5.0));
    const Interval b = between(random.in(-5.0, 5.0), random.in(-5.0, 5.0));
    const double x = random.in(a.low, a.high);
    const double y = random.in(b.low, b.high);
    EXPECT_TRUE(holds(widened(difference(a, b), 1e-14), x - y));
    EXPECT_TRUE(holds(widened(product(a, b), 1e-14), x * y));
    EXPECT_TRUE(holds(widened(scaled(a, y), 1e-14), x * y));
    EXPECT_TRUE(holds(common(a, {-10, x}), x));
  }
}

TEST(ReliefIntervals, TheirEndsAreReached) {
  EXPECT_EQ(product({-2, 3}, {-5, 1}).low, -15);
  EXPECT_EQ(product({-2, 3}, {-5, 1}).high, 10);
  EXPECT_EQ(difference({1, 2}, {3, 5}).low, -4);
  EXPECT_EQ(scaled({1, 2}, -3).low, -6);
  EXPECT_EQ(width({1, 4}), 3);
  EXPECT_EQ(middle({1, 4}), 2.5);
  EXPECT_GT(common({0, 1}, {2, 3}).low, common({0, 1}, {2, 3}).high);
}

}  // namespace
}  // namespace relief
