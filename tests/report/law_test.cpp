// Laws: fits to measurements, and the verdicts on them.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "vpe/report/features.h"
#include "vpe/report/law.h"

namespace vpe::report {
namespace {

Law power(double exponent, const std::vector<double>& x) {
  Law law{"grid", "rays", "posts", "frame_s", {}, {}, {}};
  for (const double value : x) law.samples.push_back({value, {3 * std::pow(value, exponent)}});
  return law;
}

TEST(Law, FitsTheMediansOfItsRounds) {
  Law law = power(0.75, {1, 2, 4, 8});
  for (LawSample& sample : law.samples) {
    const double y = sample.y.front();
    sample.y = {0.9 * y, y, 50 * y};
  }
  const auto fitted = fit(law);
  ASSERT_TRUE(fitted);
  EXPECT_NEAR(fitted->growth.exponent, 0.75, 1e-12);
  EXPECT_NEAR(fitted->growth.factor, 3, 1e-12);
  EXPECT_FALSE(fitted->of_rounds);
  EXPECT_FALSE(fitted->holds);
}

// Each round is 1.3 times the one before, on both sides: that is no scatter of the ratio.
TEST(Law, WithTwoXEveryRoundIsFittedAlone) {
  Law law{"threads", "rays", "threads", "frame_s", -1.1, -0.9, {{1, {2, 2.6, 3.38}}, {2, {1, 1.3, 1.69}}}};
  const auto fitted = fit(law);
  ASSERT_TRUE(fitted);
  EXPECT_TRUE(fitted->of_rounds);
  EXPECT_NEAR(fitted->growth.exponent, -1, 1e-12);
  EXPECT_NEAR(fitted->growth.half_width, 0, 1e-9);
  EXPECT_EQ(fitted->growth.points, 2);
  EXPECT_EQ(fitted->holds, true);
  EXPECT_EQ(fitted->surely, true);
  law.samples[1].y[0] = 1.4;
  EXPECT_GT(fit(law)->growth.half_width, 0.1);
}

TEST(Law, SaysWhatHoldsAndHowSurely) {
  Law law = power(1, {1, 2, 4, 8});
  law.samples[1].y[0] *= 1.1;
  const double half_width = fit(law)->growth.half_width;
  ASSERT_GT(half_width, 0.01);
  const double exponent = fit(law)->growth.exponent;
  const auto with_aim = [&](std::optional<double> least, std::optional<double> most) {
    law.least_exponent = least;
    law.most_exponent = most;
    return *fit(law);
  };
  EXPECT_EQ(with_aim({}, exponent + 2 * half_width).holds, true);
  EXPECT_EQ(with_aim({}, exponent + 2 * half_width).surely, true);
  EXPECT_EQ(with_aim({}, exponent + half_width / 2).holds, true);
  EXPECT_EQ(with_aim({}, exponent + half_width / 2).surely, false);
  EXPECT_EQ(with_aim({}, exponent - half_width / 2).holds, false);
  EXPECT_EQ(with_aim({}, exponent - half_width / 2).surely, false);
  EXPECT_EQ(with_aim(exponent + 2 * half_width, {}).holds, false);
  EXPECT_EQ(with_aim(exponent + 2 * half_width, {}).surely, true);
  EXPECT_EQ(with_aim(exponent - 2 * half_width, exponent + 2 * half_width).surely, true);
}

TEST(Law, WithoutAPowerThereIsNoFit) {
  EXPECT_FALSE(fit(power(1, {1})));
  EXPECT_FALSE(fit(power(1, {2, 2})));
  Law law = power(1, {1, 2});
  law.samples[0].y = {0};
  EXPECT_FALSE(fit(law));
  law.samples[0].y = {};
  EXPECT_FALSE(fit(law));
  const Table table = law_table(std::vector<Law>{law});
  EXPECT_EQ(to_text(table.rows.at(0).at(4)), "");
}

TEST(Law, TablesAndPlotsHaveEverySample) {
  std::vector<Law> laws{power(1, {1, 2, 4}), power(2, {1, 2}), power(1, {1, 2})};
  laws[1].y_name = "bytes";
  laws[2].axis = "image";
  EXPECT_EQ(law_table(laws).rows.size(), 3U);
  const Table samples = sample_table(laws);
  ASSERT_EQ(samples.rows.size(), 7U);
  EXPECT_EQ(to_text(samples.rows[1][5]), "6");
  const auto plots = law_plots(laws);
  ASSERT_EQ(plots.size(), 3U);
  EXPECT_EQ(plots[1], (std::pair<std::string, std::string>{"grid", "bytes"}));
  const Plot plot = law_plot(laws, "grid", "frame_s");
  ASSERT_EQ(plot.series.size(), 1U);
  EXPECT_EQ(plot.series[0].points.size(), 3U);
  EXPECT_EQ(plot.x_label, "posts");
}

TEST(Law, InterleavedTimesAreSamples) {
  const std::vector<double> x{1, 2};
  const std::vector<Timing> timings{{{3, 4}}, {{5, 6}}};
  const auto samples = timed_samples(x, timings);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[1].x, 2);
  EXPECT_EQ(samples[1].y, (std::vector<double>{5, 6}));
  EXPECT_THROW(timed_samples(std::vector<double>{1}, timings), std::invalid_argument);
}

TEST(Features, MediansOverTheMeasured) {
  const std::vector<SceneCost> rounds{{1, 10, {}, {}, 7}, {3, 20, {}, {}, {}}, {2, 90, {}, {}, {}}};
  const SceneCost cost = median_cost(rounds);
  EXPECT_EQ(cost.peak_mb, 2);
  EXPECT_EQ(cost.startup_s, 20);
  EXPECT_FALSE(cost.frame_s);
  EXPECT_EQ(cost.resident_mb, 7);
}

TEST(Features, TableHasOffOnAndNever) {
  FeatureCost cost{"light", "ray", "bare", {}, {}, {}, 1.5, {}, "always"};
  cost.off.frame_s = 0.002;
  cost.on.frame_s = 0.003;
  const Table table = feature_table(std::vector<FeatureCost>{cost});
  const nlohmann::json row = to_json(table)["rows"][0];
  EXPECT_EQ(row["feature"], "light");
  EXPECT_EQ(row["frame_ms_off"], 2);
  EXPECT_EQ(row["frame_ms_on"], 3);
  EXPECT_TRUE(row["frame_ms_never"].is_null());
  EXPECT_TRUE(row["peak_mb_off"].is_null());
  EXPECT_EQ(row["frame_ratio"], 1.5);
  EXPECT_TRUE(row["never_ratio"].is_null());
  EXPECT_EQ(row["note"], "always");
}

}  // namespace
}  // namespace vpe::report
