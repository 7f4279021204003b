// Four floats at a time.
#include "objects/model/floats4.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace objects::simd {
namespace {

TEST(Floats4, EachLaneIsByItself) {
  const Floats4 a{1, -2, 3, 0};
  const Floats4 b{2, -3, 3, std::numeric_limits<float>::infinity()};
  const Floats4 low = min(a, b);
  const Floats4 high = max(a, b);
  for (int n = 0; n < 4; ++n) {
    EXPECT_EQ(low[n], std::min(a[n], b[n])) << n;
    EXPECT_EQ(high[n], std::max(a[n], b[n])) << n;
    EXPECT_EQ(all(0.25F)[n], 0.25F);
  }
}

TEST(Floats4, BitsAreInTheOrderOfLanes) {
  const Floats4 a{1, 2, 3, 4};
  EXPECT_EQ(bits(a > all(2.5F)), 0b1100);
  EXPECT_EQ(bits(a == all(2)), 0b0010);
  EXPECT_EQ(bits(a < all(0)), 0);
  EXPECT_EQ(bits((a < all(9)) & ~(a == all(3))), 0b1011);
}

}  // namespace
}  // namespace objects::simd
