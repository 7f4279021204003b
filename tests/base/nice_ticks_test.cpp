#include "vpe/base/nice_ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

// After GoogleTest, which it does not include.
#include <rapidcheck/gtest.h>

namespace vpe::base {
namespace {

using Values = std::vector<double>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const double kNaN = std::nan("");

// 1, 2 or 5 times a power of ten, but for rounding.
bool is_nice(double step) {
  const double leading = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
  for (const double nice : {1.0, 2.0, 5.0, 10.0}) {
    if (std::abs(leading - nice) < 1e-6) return true;
  }
  return false;
}

TEST(NiceTicks, PowersOfTenAreTheNearestDoubles) {
  for (int exponent = -22; exponent <= 22; ++exponent)
    EXPECT_EQ(power_of_ten(exponent), std::stod("1e" + std::to_string(exponent))) << exponent;
  for (const int exponent : {-300, -100, -23, 100, 300})
    EXPECT_NEAR(power_of_ten(exponent) / std::stod("1e" + std::to_string(exponent)), 1, 1e-15) << exponent;
}

TEST(NiceTicks, StepsLieOnTheirSideOfTheLimit) {
  EXPECT_EQ(nice_step_below(999), 500);
  EXPECT_EQ(nice_step_below(1000), 1000);
  EXPECT_EQ(nice_step_below(1), 1);
  EXPECT_EQ(nice_step_below(0.0499), 0.02);
  EXPECT_EQ(nice_step_above(1001), 2000);
  EXPECT_EQ(nice_step_above(0.021), 0.05);
  EXPECT_EQ(nice_step_above(5.1), 10);
  EXPECT_EQ(nice_step_above(0.1), 0.1);
}

TEST(NiceTicks, StepsForgiveRoundingButNotWithSlackZero) {
  const double nearly_500 = 500 * (1 - 1e-12);
  const double just_over_500 = 500 * (1 + 1e-12);
  EXPECT_EQ(nice_step_below(nearly_500), 500);
  EXPECT_EQ(nice_step_above(just_over_500), 500);
  EXPECT_EQ(nice_step_above(just_over_500, 0), 1000);
  EXPECT_EQ(nice_step_below(1000 * (1 - 1e-12)), 1000);
  EXPECT_EQ(nice_step_above(1000 * (1 + 1e-12)), 1000);
}

TEST(NiceTicks, StepsOfWhatHasNoneAreThatItself) {
  for (const double x : {0.0, -1.0, kInfinity}) {
    EXPECT_EQ(nice_step_below(x), x);
    EXPECT_EQ(nice_step_above(x), x);
  }
  EXPECT_TRUE(std::isnan(nice_step_below(kNaN)));
  EXPECT_TRUE(std::isnan(nice_step_above(kNaN)));
}

TEST(NiceTicks, DecimalsTellMultiplesApart) {
  EXPECT_EQ(step_decimals(20), 0);
  EXPECT_EQ(step_decimals(1), 0);
  EXPECT_EQ(step_decimals(0.5), 1);
  EXPECT_EQ(step_decimals(2.5), 1);
  EXPECT_EQ(step_decimals(0.002), 3);
  EXPECT_EQ(step_decimals(1e-12), 9);
}

TEST(NiceTicks, AreMultiplesOfTheSmallestStepThatFits) {
  EXPECT_EQ(nice_ticks(0, 10, 5).values, (Values{0, 5, 10}));
  EXPECT_EQ(nice_ticks(0, 10, 6).values, (Values{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(nice_ticks(-4503, -4497, 4).values, (Values{-4502, -4500, -4498}));
  const NiceTicks fine = nice_ticks(0, 0.3, 4);
  EXPECT_EQ(fine.values.size(), 4U);
  EXPECT_EQ(fine.decimals, 1);
  EXPECT_EQ(nice_ticks(0, 4000, 5).decimals, 0);
}

TEST(NiceTicks, TwoOrMoreOfThemMakeAScale) {
  EXPECT_EQ(nice_ticks_two_or_more(0, 10, 5), (Values{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(nice_ticks_two_or_more(0, 10, 1), (Values{0, 10}));
  EXPECT_EQ(nice_ticks_two_or_more(0.9, 10.9, 1), (Values{5, 10}));
  EXPECT_EQ(nice_ticks_two_or_more(1, 1, 6), Values{});
}

// Ranges that a damaged file or an empty selection may lead to.
TEST(NiceTicks, AreNoneWhereThereIsNoRange) {
  const double largest = std::numeric_limits<double>::max();
  const double smallest = std::numeric_limits<double>::denorm_min();
  const std::vector<std::pair<double, double>> ranges{{1, 1},         {2, 1},
                                                      {0, kNaN},      {kNaN, 0},
                                                      {0, kInfinity}, {-kInfinity, kInfinity},
                                                      {0, smallest},  {-largest, largest}};
  for (const auto& [low, high] : ranges) {
    EXPECT_TRUE(nice_ticks(low, high, 5).values.empty()) << low << " " << high;
    EXPECT_TRUE(nice_ticks_two_or_more(low, high, 5).empty()) << low << " " << high;
  }
  for (const int most : {-5, 0}) {
    EXPECT_TRUE(nice_ticks(0, 1, most).values.empty());
    EXPECT_TRUE(nice_ticks_two_or_more(0, 1, most).empty());
  }
  EXPECT_TRUE(nice_ticks(0, 1, 1).values.empty());
}

TEST(NiceTicks, EndWhereMultiplesCannotBeCounted) {
  const double high = std::nextafter(1e17, kInfinity);
  EXPECT_LE(nice_ticks(1e17, high, 5).values.size(), 5U);
  EXPECT_LE(nice_ticks_two_or_more(1e17, high, 5).size(), 20'000U);
  EXPECT_LE(nice_ticks_two_or_more(1e300, std::nextafter(1e300, kInfinity), 1'000'000).size(), 1'100'000U);
}

struct Range {
  double low;
  double high;
};

rc::Gen<Range> any_range() {
  return rc::gen::map(rc::gen::pair(rc::gen::inRange(-1'000'000, 1'000'000), rc::gen::inRange(-60, 60)),
                      [](const std::pair<int, int>& n) {
                        const double low = n.first / 100.0;
                        return Range{low, low + std::pow(10.0, n.second / 10.0)};
                      });
}

RC_GTEST_PROP(NiceTicksProperty, AreWithinTheRangeAndNotTooMany, ()) {
  const Range range = *any_range();
  const double width = range.high - range.low;
  const int most = *rc::gen::inRange(2, 20);
  const NiceTicks ticks = nice_ticks(range.low, range.high, most);
  RC_ASSERT(ticks.values.size() <= static_cast<std::size_t>(most));
  RC_ASSERT(static_cast<int>(ticks.values.size()) >= most / 3);  // the next finer ones would be too many
  RC_ASSERT(!ticks.values.empty());
  for (std::size_t n = 0; n < ticks.values.size(); ++n) {
    const double value = ticks.values[n];
    RC_ASSERT(value >= range.low - 1e-6 * width && value <= range.high + 1e-6 * width);
    const double scaled = value * std::pow(10.0, ticks.decimals);
    RC_ASSERT(std::abs(scaled - std::round(scaled)) < 1e-6 * std::max(1.0, std::abs(scaled)));
    if (n > 0) RC_ASSERT(value > ticks.values[n - 1]);
  }
}

RC_GTEST_PROP(NiceTicksProperty, AreTwoOrMore, ()) {
  const Range range = *any_range();
  const double width = range.high - range.low;
  const int most = *rc::gen::inRange(1, 20);
  const Values values = nice_ticks_two_or_more(range.low, range.high, most);
  RC_ASSERT(values.size() >= 2U);
  RC_ASSERT(values.size() <= static_cast<std::size_t>(std::max(5, most + 1)));
  RC_ASSERT(values.front() >= range.low - 1e-6 * width && values.back() <= range.high + 1e-6 * width);
}

RC_GTEST_PROP(NiceTicksProperty, StepsAreNiceAndNearTheLimit, ()) {
  const double x = std::pow(10.0, *rc::gen::inRange(-15'000, 15'000) / 1000.0);
  const double below = nice_step_below(x);
  const double above = nice_step_above(x);
  RC_ASSERT(is_nice(below) && is_nice(above));
  RC_ASSERT(below <= x * (1 + 2e-9) && below >= x / 2.6);
  RC_ASSERT(above >= x * (1 - 2e-9) && above <= x * 2.6);
  RC_ASSERT(nice_step_above(x, 0) >= x);
  RC_ASSERT(std::abs(nice_step_below(below) / below - 1) < 1e-9);
  RC_ASSERT(std::abs(nice_step_above(above) / above - 1) < 1e-9);
}

}  // namespace
}  // namespace vpe::base
