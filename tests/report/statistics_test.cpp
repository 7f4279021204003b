// Growth, Pareto fronts and interleaved timing against known results.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/support.h"
#include "vpe/report/growth.h"
#include "vpe/report/interleaved_timing.h"
#include "vpe/report/pareto_front.h"

namespace vpe::report {
namespace {

TEST(Growth, FindsAPowerExactly) {
  std::vector<double> x{257, 513, 1025, 2049, 4097};
  std::vector<double> y;
  for (const double value : x) y.push_back(3.5 * std::pow(value, 1.25));
  const Growth growth = fit_growth(x, y);
  EXPECT_NEAR(growth.exponent, 1.25, 1e-12);
  EXPECT_NEAR(growth.factor, 3.5, 1e-10);
  EXPECT_NEAR(growth.half_width, 0, 1e-12);
  EXPECT_EQ(growth.points, 5);
}

// Worked by hand: ln x = 0, 1, 2, ln y = 0, 1, 1.
TEST(Growth, IntervalIsStudents) {
  const std::vector<double> x{1, std::exp(1.0), std::exp(2.0)};
  const std::vector<double> y{1, std::exp(1.0), std::exp(1.0)};
  const Growth growth = fit_growth(x, y);
  EXPECT_NEAR(growth.exponent, 0.5, 1e-12);
  EXPECT_NEAR(growth.residual, std::sqrt(1.0 / 6), 1e-12);
  EXPECT_NEAR(growth.half_width, 12.706 * std::sqrt(1.0 / 6) / std::sqrt(2.0), 1e-9);
}

// The interval contains the truth about 95 times in 100.
TEST(Growth, IntervalHoldsTheTruth) {
  test_support::Random random(20261122);
  int held = 0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> x;
    std::vector<double> y;
    for (int k = 0; k < 7; ++k) {
      x.push_back(std::exp2(k));
      double noise = 0;  // twelve uniform ones: nearly normal
      for (int n = 0; n < 12; ++n) noise += random.uniform(-0.5, 0.5);
      y.push_back(2 * std::pow(x.back(), 0.7) * std::exp(0.1 * noise));
    }
    const Growth growth = fit_growth(x, y);
    held += std::abs(growth.exponent - 0.7) <= growth.half_width ? 1 : 0;
  }
  EXPECT_GT(held, kTrials * 0.93);
  EXPECT_LT(held, kTrials * 0.97);
}

TEST(Growth, RefusesValuesWithoutGrowth) {
  const std::vector<double> one{1};
  const std::vector<double> two{1, 2};
  const std::vector<double> same{2, 2};
  const std::vector<double> negative{1, -1};
  EXPECT_THROW(fit_growth(one, one), std::invalid_argument);
  EXPECT_THROW(fit_growth(same, two), std::invalid_argument);
  EXPECT_THROW(fit_growth(two, negative), std::invalid_argument);
  EXPECT_THROW(fit_growth(two, one), std::invalid_argument);
  EXPECT_TRUE(std::isinf(fit_growth(two, two).half_width));
}

RC_GTEST_PROP(Front, NoPointBeatsItAndItBeatsAllOthers, ()) {
  const auto costs = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 20));
  std::vector<CostAndError> points;
  for (std::size_t k = 0; k < costs.size(); ++k) {
    points.push_back({static_cast<double>(costs[k]), static_cast<double>(*rc::gen::inRange(0, 20))});
  }
  const auto beats = [](const CostAndError& a, const CostAndError& b) {
    return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
  };
  const std::vector<std::size_t> front = pareto_front(points);
  RC_ASSERT(front.empty() == points.empty());
  for (std::size_t k = 0; k < points.size(); ++k) {
    bool beaten = false;
    bool twin_before = false;
    for (std::size_t n = 0; n < points.size(); ++n) {
      beaten = beaten || beats(points[n], points[k]);
      twin_before =
          twin_before || (n < k && points[n].cost == points[k].cost && points[n].error == points[k].error);
    }
    const bool on = std::find(front.begin(), front.end(), k) != front.end();
    RC_ASSERT(on == (!beaten && !twin_before));
  }
  for (std::size_t k = 1; k < front.size(); ++k) RC_ASSERT(points[front[k - 1]].cost < points[front[k]].cost);
}

TEST(Front, LeavesOutPointsThatAreNotFinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<CostAndError> points{{1, infinity}, {NAN, 0}, {3, 2}, {infinity, 0}};
  EXPECT_EQ(pareto_front(points), std::vector<std::size_t>{2});
  EXPECT_EQ(cost_at_error(points, 2), 3);
  EXPECT_EQ(cost_at_error(points, 1), infinity);
}

TEST(InterleavedTiming, RoundsAreInterleavedAndTheFirstIsUntimed) {
  double now_s = 0;
  std::string order;
  const std::vector<std::function<void()>> cases{[&] {
                                                   order += 'a';
                                                   now_s += order.size() < 3 ? 100 : 2;
                                                 },
                                                 [&] {
                                                   order += 'b';
                                                   now_s += static_cast<double>(order.size());
                                                 }};
  const std::vector<Timing> timings = time_interleaved(cases, 3, [&] { return now_s; });
  EXPECT_EQ(order, "abababab");
  EXPECT_EQ(timings[0].round_s, (std::vector<double>{2, 2, 2}));
  EXPECT_EQ(timings[1].round_s, (std::vector<double>{4, 6, 8}));
  EXPECT_EQ(timings[1].median_s(), 6);
  EXPECT_EQ(ratio(timings[1], timings[0]), 3);
  EXPECT_THROW(time_interleaved(cases, 0), std::invalid_argument);
  EXPECT_THROW(ratio(timings[0], Timing{}), std::invalid_argument);
}

TEST(InterleavedTiming, PreparationIsUntimedAndLimitedCasesRunLess) {
  double now_s = 0;
  std::string order;
  std::vector<BenchmarkCase> cases(2);
  cases[0].prepare = [&](double) {
    order += 'p';
    now_s += 50;
  };
  cases[0].run = [&] {
    order += 'a';
    now_s += 2;
  };
  cases[1].run = [&] {
    order += 'b';
    now_s += 8;
  };
  cases[1].most_rounds = 1;
  const std::vector<Timing> timings = time_interleaved(cases, 3, [&] { return now_s; });
  EXPECT_EQ(order, "papabpapa");
  EXPECT_EQ(timings[0].round_s, (std::vector<double>{2, 2, 2}));
  EXPECT_EQ(timings[1].round_s, std::vector<double>{8});
  EXPECT_EQ(ratio(timings[1], timings[0]), 4);
}

TEST(InterleavedTiming, MedianIsTheMiddle) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_TRUE(std::isnan(median({})));
}

}  // namespace
}  // namespace vpe::report
