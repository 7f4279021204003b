// First roots of functions with known ones.
#include "relief/cast/first_root.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/relief/samples.h"

namespace relief {
namespace {

// (s - a) (s - b) (s - c), with slopes bounded by those of its terms.
struct Cubic {
  double a, b, c;

  double value(double s) const { return (s - a) * (s - b) * (s - c); }
  double derivative(double s) const { return (s - a) * (s - b) + (s - b) * (s - c) + (s - c) * (s - a); }
  Interval slope(double low, double high) const {
    const Interval x{low - a, high - a};
    const Interval y{low - b, high - b};
    const Interval z{low - c, high - c};
    return sum(product(x, y), sum(product(y, z), product(z, x)));
  }
};

TEST(ReliefFirstRoot, FindsTheFirstOfThree) {
  samples::Random random(50);
  for (int n = 0; n < 2000; ++n) {
    const Cubic f{random.in(-2.0, 2.0), random.in(-2.0, 2.0), random.in(-2.0, 2.0)};
    double expected = kNoRoot;
    for (const double root : {f.a, f.b, f.c})
      if (root >= -1 && root <= 1) expected = std::min(expected, root);
    const double found = first_root(f, -1, 1);
    if (expected == kNoRoot) {
      EXPECT_EQ(found, kNoRoot);
    } else {
      EXPECT_NEAR(found, expected, 1e-9);
    }
  }
}

TEST(ReliefFirstRoot, FindsRootsThatLieCloseTogether) {
  for (const double gap : {1e-2, 1e-4, 1e-6}) {
    EXPECT_NEAR(first_root(Cubic{0.3, 0.3 + gap, 5}, 0, 1), 0.3, 1e-9);
    EXPECT_NEAR(first_root(Cubic{-3, 0.3 + gap, 0.3}, 0, 1), 0.3, 1e-9);
  }
}

TEST(ReliefFirstRoot, EndsCount) {
  EXPECT_EQ(first_root(Cubic{0, 5, 6}, 0, 1), 0);
  EXPECT_NEAR(first_root(Cubic{1, 5, 6}, 0, 1), 1, 1e-15);
  EXPECT_EQ(first_root(Cubic{-1, 5, 6}, 0, 1), kNoRoot);
}

TEST(ReliefFirstRoot, ABracketedRootIsExact) {
  const Cubic f{0.123456789, 7, 9};
  EXPECT_NEAR(bracketed_root(f, 0, 1, f.value(0), f.value(1)), 0.123456789, 1e-16);
}

TEST(ReliefFirstRoot, OfAParabolaIsTheFirstInTheUnitInterval) {
  samples::Random random(51);
  for (int n = 0; n < 5000; ++n) {
    const double a = random.in(-1.0, 2.0);
    const double b = random.in(-1.0, 2.0);
    const double scale = random.in(0.1, 3.0) * (n % 2 == 0 ? 1 : -1);
    const auto f = [&](double t) { return scale * (t - a) * (t - b); };
    double expected = kNoRoot;
    for (const double root : {a, b})
      if (root >= 0 && root <= 1) expected = std::min(expected, root);
    const double found = first_parabola_root(f(0), f(0.5), f(1));
    if (expected == kNoRoot) {
      EXPECT_EQ(found, kNoRoot);
    } else {
      EXPECT_NEAR(found, expected, 1e-7);
    }
  }
}

TEST(ReliefFirstRoot, OfALineAndOfConstants) {
  EXPECT_NEAR(first_parabola_root(-1, 1, 3), 0.25, 1e-16);
  EXPECT_NEAR(first_parabola_root(3, 1, -1), 0.75, 1e-16);
  EXPECT_EQ(first_parabola_root(1, 1, 1), kNoRoot);
  EXPECT_EQ(first_parabola_root(0, 0, 0), 0);
  EXPECT_EQ(first_parabola_root(1, 0.5, 0), 1);
}

}  // namespace
}  // namespace relief
