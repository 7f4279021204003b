// Published tables beside our own figures.
#include "vpe/report/papers.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace vpe::report {
namespace {

double number(const Table& table, std::size_t row, const std::string& name) {
  for (std::size_t k = 0; k < table.columns.size(); ++k)
    if (table.columns[k].name == name) return std::get<double>(table.rows.at(row)[k]);
  throw std::out_of_range(name);
}

TEST(Papers, VyatkinsTableIsThePapers) {
  const PublishedTimes& times = vyatkin_2002_times();
  ASSERT_EQ(times.rows.size(), 4U);
  const double expected[][2] = {{1024, 59}, {512, 58}, {128, 58}, {64, 57}};
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_EQ(times.rows[n].size, expected[n][0]);
    EXPECT_EQ(times.rows[n].time_s, expected[n][1]);
    EXPECT_EQ(times.rows[n].picture, "t" + std::to_string(static_cast<int>(expected[n][0])) + ".tga");
  }
  EXPECT_EQ(times.base_size, 64);
}

TEST(Papers, WansTerrainTableIsThePapers) {
  const double expected[][3] = {
      {1, 0.92, 0.65}, {4, 0.28, 0.21}, {8, 0.15, 0.11}, {12, 0.11, 0.08}, {16, 0.09, 0.06}};
  ASSERT_EQ(kWan1999Terrain.size(), std::size(expected));
  for (std::size_t n = 0; n < kWan1999Terrain.size(); ++n) {
    EXPECT_EQ(kWan1999Terrain[n].processors, expected[n][0]);
    EXPECT_EQ(kWan1999Terrain[n].accurate_s, expected[n][1]);
    EXPECT_EQ(kWan1999Terrain[n].approximate_s, expected[n][2]);
  }
  EXPECT_NEAR(kWan1999Times.conventional_s / kWan1999Terrain[0].accurate_s, 7.3, 0.05);
}

// Rounds of which the second was disturbed: ratios are of one round, and then their median.
TEST(Papers, RatiosAreWithinRounds) {
  const PublishedTimes published{"P", "M", "n", "sizes", {{2, 30, ""}, {1, 20, ""}}, 1};
  const std::vector<Timing> timings{{{3, 33, 6}}, {{2, 20, 3}}};
  const Table table = compare_times(published, timings);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(number(table, 0, "n"), 2);
  EXPECT_EQ(number(table, 0, "published_s"), 30);
  EXPECT_DOUBLE_EQ(number(table, 0, "published_ratio"), 1.5);
  EXPECT_EQ(number(table, 0, "here_s"), 6);
  EXPECT_EQ(number(table, 0, "here_least_s"), 3);
  EXPECT_EQ(number(table, 0, "here_most_s"), 33);
  EXPECT_DOUBLE_EQ(number(table, 0, "here_ratio"), 1.65);
  EXPECT_DOUBLE_EQ(number(table, 0, "here_ratio_least"), 1.5);
  EXPECT_DOUBLE_EQ(number(table, 0, "here_ratio_most"), 2);
  EXPECT_DOUBLE_EQ(number(table, 0, "ratio_of_ratios"), 1.1);
  EXPECT_EQ(number(table, 1, "here_ratio"), 1);
  EXPECT_EQ(number(table, 1, "ratio_of_ratios"), 1);
}

TEST(Papers, TimesMustFitTheTable) {
  PublishedTimes published{"P", "M", "n", "sizes", {{2, 30, ""}, {1, 20, ""}}, 1};
  const Timing one{{1}};
  EXPECT_THROW(compare_times(published, std::vector<Timing>{one}), std::invalid_argument);
  EXPECT_THROW(compare_times(published, std::vector<Timing>{one, {}}), std::invalid_argument);
  EXPECT_THROW(compare_times(published, std::vector<Timing>{one, {{1, 2}}}), std::invalid_argument);
  published.base_size = 3;
  EXPECT_THROW(compare_times(published, std::vector<Timing>{one, one}), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::report
