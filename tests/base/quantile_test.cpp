#include "vpe/base/quantile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

// After GoogleTest, which it does not include.
#include <rapidcheck/gtest.h>

namespace vpe::base {
namespace {

using Values = std::vector<double>;

// The functions reorder their arguments: each call gets a copy.
double upper(Values values) { return median_upper(values); }
double mean(Values values) { return median_mean(values); }
double floor_of(Values values, double share) { return quantile_floor(values, share); }
double round_of(Values values, double share) { return quantile_round(values, share); }

TEST(Quantile, AgreesWithTheTableInTheHeader) {
  const Values four{4, 1, 3, 2};
  EXPECT_EQ(upper(four), 3);
  EXPECT_EQ(mean(four), 2.5);
  EXPECT_EQ(floor_of(four, 0.5), 2);
  EXPECT_EQ(round_of(four, 0.5), 3);
  EXPECT_EQ(sorted_quantile_rank(Values{1, 2, 3, 4}, 0.5), 2);
}

TEST(Quantile, OfAnOddCountIsTheMiddleByEveryRule) {
  const Values five{50, 10, 40, 20, 30};
  EXPECT_EQ(upper(five), 30);
  EXPECT_EQ(mean(five), 30);
  EXPECT_EQ(floor_of(five, 0.5), 30);
  EXPECT_EQ(round_of(five, 0.5), 30);
  EXPECT_EQ(sorted_quantile_rank(Values{10, 20, 30, 40, 50}, 0.5), 30);
}

TEST(Quantile, OfNoValuesIsNotANumber) {
  EXPECT_TRUE(std::isnan(upper({})));
  EXPECT_TRUE(std::isnan(mean({})));
  EXPECT_TRUE(std::isnan(floor_of({}, 0.5)));
  EXPECT_TRUE(std::isnan(round_of({}, 0.5)));
  EXPECT_TRUE(std::isnan(sorted_quantile_rank({}, 0.5)));
}

TEST(Quantile, StaysWithinTheValuesForAnyShare) {
  const Values three{1, 2, 3};
  for (const double share : {-1e300, -0.1, 0.0}) {
    EXPECT_EQ(floor_of(three, share), 1);
    EXPECT_EQ(round_of(three, share), 1);
    EXPECT_EQ(sorted_quantile_rank(three, share), 1);
  }
  for (const double share : {1.0, 1.1, 1e300}) {
    EXPECT_EQ(floor_of(three, share), 3);
    EXPECT_EQ(round_of(three, share), 3);
    EXPECT_EQ(sorted_quantile_rank(three, share), 3);
  }
}

TEST(Quantile, OfTailsFollowsEachRule) {
  Values hundred;
  for (int n = 100; n > 0; --n) hundred.push_back(n);
  EXPECT_EQ(floor_of(hundred, 0.9), 90);    // rank 89.1 from 0
  EXPECT_EQ(floor_of(hundred, 0.995), 99);  // rank 98.505
  EXPECT_EQ(round_of(hundred, 0.995), 100);
  EXPECT_EQ(round_of(hundred, 0.005), 1);  // rank 0.495
  std::sort(hundred.begin(), hundred.end());
  EXPECT_EQ(sorted_quantile_rank(hundred, 0.99), 99);
  EXPECT_EQ(sorted_quantile_rank(hundred, 0.999), 100);
  EXPECT_EQ(sorted_quantile_rank(hundred, 0.001), 1);
}

TEST(Quantile, AcceptsInfinity) {
  const double infinity = HUGE_VAL;
  EXPECT_EQ(upper({infinity, -infinity, 1}), 1);
  EXPECT_EQ(mean({infinity, infinity}), infinity);
  EXPECT_EQ(upper({infinity, 0}), infinity);
}

rc::Gen<Values> any_values() {
  return rc::gen::nonEmpty(rc::gen::container<Values>(
      rc::gen::map(rc::gen::inRange(-50, 50), [](int n) { return n / 8.0; })));  // with many equal ones
}

RC_GTEST_PROP(QuantileProperty, IsTheElementOfTheSortedValues, ()) {
  const Values values = *any_values();
  const double share = *rc::gen::inRange(0, 1001) / 1000.0;
  Values sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t count = sorted.size();
  RC_ASSERT(upper(values) == sorted[count / 2]);
  RC_ASSERT(mean(values) == (sorted[(count - 1) / 2] + sorted[count / 2]) / 2);
  const double rank = share * static_cast<double>(count - 1);
  RC_ASSERT(floor_of(values, share) == sorted[static_cast<std::size_t>(std::floor(rank))]);
  RC_ASSERT(round_of(values, share) == sorted[static_cast<std::size_t>(std::round(rank))]);
}

RC_GTEST_PROP(QuantileProperty, OfNearestRankIsTheSmallestValueThatIsReachedOften, ()) {
  Values sorted = *any_values();
  std::sort(sorted.begin(), sorted.end());
  const double share = *rc::gen::inRange(0, 1001) / 1000.0;
  const double quantile = sorted_quantile_rank(sorted, share);
  const auto share_up_to = [&](auto is_before) {
    return static_cast<double>(std::count_if(sorted.begin(), sorted.end(), is_before)) /
           static_cast<double>(sorted.size());
  };
  RC_ASSERT(share_up_to([&](double v) { return v <= quantile; }) >= share);
  RC_ASSERT(share_up_to([&](double v) { return v < quantile; }) < share || quantile == sorted.front());
}

RC_GTEST_PROP(QuantileProperty, DoesNotDependOnTheOrder, ()) {
  const Values values = *any_values();
  const Values other(values.rbegin(), values.rend());
  RC_ASSERT(upper(values) == upper(other));
  RC_ASSERT(mean(values) == mean(other));
  RC_ASSERT(floor_of(values, 0.9) == floor_of(other, 0.9));
  RC_ASSERT(round_of(values, 0.9) == round_of(other, 0.9));
}

}  // namespace
}  // namespace vpe::base
