// Figures for people: few digits.
#include "vpe/app/cli/figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "tests/app/support/app_fixture.h"
#include "vpe/app/planet/level_table.h"

namespace vpe::app {
namespace {

TEST(Figures, LengthsAndSizesHaveAUnitThatSuits) {
  EXPECT_EQ(length_text(0.0915), "0.0915 m");
  EXPECT_EQ(length_text(163.04), "163 m");
  EXPECT_EQ(length_text(3489.62), "3490 m");
  EXPECT_EQ(length_text(41707.1), "41.71 km");
  EXPECT_EQ(length_text(3396190, 7), "3396.19 km");
  EXPECT_EQ(bytes_text(8.31e6), "8.31 MB");
  EXPECT_EQ(bytes_text(12.34e9), "12.3 GB");
}

TEST(Figures, LongNumbersInSentencesAreShortened) {
  EXPECT_EQ(with_short_numbers("bent by up to -20.532597351137156 m (RMS 14.341404747401558 m) over "
                               "946.7039184575242 m to meet gale_1.2345678.tif"),
            "bent by up to -20.53 m (RMS 14.34 m) over 946.7 m to meet gale_1.2345678.tif");
  EXPECT_EQ(with_short_numbers("from sphere:3396190 to areoid by 0.6, v1.2.3456789 and 12.345"),
            "from sphere:3396190 to areoid by 0.6, v1.2.3456789 and 12.345");
}

TEST(Figures, TheLevelTableExplainsLevelsOfImageryAlone) {
  paging::PlanetMeta meta;
  meta.levels.resize(2);
  meta.levels[0].tiles = 6;
  meta.levels[0].resampling = {3489.6, 131.24, 10};
  meta.levels[1].level = 1;
  meta.levels[1].image_tiles = 12;
  const auto printed = [&] {
    testing::internal::CaptureStdout();
    print_level_table(meta);
    return testing::internal::GetCapturedStdout();
  };
  const std::string text = printed();
  EXPECT_NE(text.find("     131.2        3490\n"), std::string::npos) << text;
  EXPECT_NE(text.find("Levels without tiles hold imagery"), std::string::npos) << text;
  meta.levels.pop_back();
  EXPECT_EQ(printed().find("Levels without tiles"), std::string::npos);
  EXPECT_EQ(finest_measured(meta), nullptr);
}

}  // namespace
}  // namespace vpe::app

namespace app_test {
namespace {

class PrintedFigures : public AppTest {};

// Numbers with exponents or many digits are for programs.
TEST_F(PrintedFigures, BuildAndInfoHaveFewDigitsAndNoExponents) {
  write_dem(dir_ / "base.tif");
  Dem inset;
  inset.width = inset.height = 60;
  inset.west_deg = 10;
  inset.north_deg = 12;
  inset.cell_deg = 0.1;
  inset.height_m = [](int x, int y) { return 1000.0 + 400 * std::sin(0.3 * x) * std::cos(0.2 * y); };
  write_dem(dir_ / "inset.tif", inset);
  const Result built = vpe({"build", "base.tif", "inset.tif", "--datum", "areoid", "--align", "edges",
                            "--base-spacing", "40000", "-o", "x.vpe"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  const Result info = vpe({"info", "x.vpe"});
  static const std::regex kBad(R"([0-9]e[+-][0-9]|[0-9]\.[0-9]{6,}|[0-9]{1,}\.[0-9]{5,})");
  for (const std::string& text : {built.out, built.err, info.out}) {
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, kBad)) << found.str() << " in\n" << text;
  }
  EXPECT_TRUE(says(built.out,
                   {"resampling error of the whole planet: RMS ", "resampling error at the finest level, "}));
  EXPECT_TRUE(says(info.out, {"3396.19 km", "bent by up to ", "posts, m", "images", "at the finest level, "}));
  // JSON keeps what the file holds.
  const nlohmann::json json = parse_json(vpe({"info", "x.vpe", "--json"}).out);
  EXPECT_TRUE(std::regex_search(json.at("sources").dump(), std::regex(R"(bent by up to -?[0-9]+\.[0-9]{9,})")))
      << json.at("sources");
}

}  // namespace
}  // namespace app_test
