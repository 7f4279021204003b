// Tests of files of screens.
#include "vpe/explore/screens/screens_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace vpe::explore {
namespace {

const std::string kTable = R"(version = 1
scale = 10000
head = [0, 0.5, 0.6]
eye_base = 0.065
level = true
[[screen]]
name = "table"
monitor = 2
pixels = [1920, 1080]
upper_left = [-0.3, 0, -0.2]
upper_right = [0.3, 0, -0.2]
lower_left = [-0.3, 0, 0.1375]
)";

const std::string kVisor = R"(version = 1
[[screen]]
name = "left eye"
eye = "left"
window = [-10, 20]
pixels = [960, 1080]
[screen.lens]
field = 100
distortion = [0.22, 0.24]
axes = 0.0635
width = 0.0749
[[screen]]
name = "right eye"
eye = "right"
monitor = "DP-1"
pixels = [960, 1080]
lens = { field = 100 }
)";

std::string error_of(const std::string& text) {
  try {
    (void)parse_screens_toml(text, "a.screens.toml");
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return {};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(ScreensFile, HasScreensAndTheirRoom) {
  const ScreenSet set = parse_screens_toml(kTable, "a.screens.toml");
  EXPECT_EQ(set.scale, 10000);
  EXPECT_EQ(set.rest_m, glm::dvec3(0, 0.5, 0.6));
  EXPECT_EQ(set.eye_base_m, 0.065);
  EXPECT_TRUE(set.is_level);
  ASSERT_EQ(set.screens.size(), 1U);
  const PlacedScreen& table = set.screens[0].screen;
  EXPECT_EQ(check(table), "");
  EXPECT_EQ(table.eye, ScreenEye::kMiddle);
  EXPECT_EQ(std::get<MonitorNumber>(table.window).number, 2);
  EXPECT_EQ(set.screens[0].window_px, glm::ivec2(1920, 1080));
}

TEST(ScreensFile, HasLensesAndWindows) {
  const ScreenSet set = parse_screens_toml(kVisor, "a.screens.toml");
  ASSERT_EQ(set.screens.size(), 2U);
  const auto& lens = std::get<ScreenLens>(set.screens[0].screen.place);
  EXPECT_EQ(set.screens[0].screen.eye, ScreenEye::kLeft);
  EXPECT_EQ(std::get<glm::ivec2>(set.screens[0].screen.window), glm::ivec2(-10, 20));
  EXPECT_EQ(lens.field_deg, 100);
  EXPECT_EQ(lens.distortion, (std::array<double, 4>{0.22, 0.24, 0, 0}));
  EXPECT_EQ(lens.axes_m, 0.0635);
  EXPECT_EQ(lens.width_m, 0.0749);
  EXPECT_EQ(std::get<MonitorName>(set.screens[1].screen.window).name, "DP-1");
  EXPECT_EQ(std::get<ScreenLens>(set.screens[1].screen.place).width_m, 0);
  EXPECT_EQ(set.scale, 1);
  EXPECT_FALSE(set.is_level);
}

TEST(ScreensFile, ErrorsNameFileAndLine) {
  const struct {
    std::string text;
    const char* error;
  } all[] = {
      {replaced(kTable, "version = 1\n", ""), "version is missing"},
      {replaced(kTable, "version = 1", "version = 2"), "a.screens.toml:1: version"},
      {replaced(kTable, "scale = 10000", "scale = 0"), "a.screens.toml:2: scale"},
      {replaced(kTable, "scale = 10000", "size = 3"), "a.screens.toml:2: unknown key"},
      {replaced(kTable, "[0, 0.5, 0.6]", "[0, 0.5]"), "a.screens.toml:3: head"},
      {replaced(kTable, "[0, 0.5, 0.6]", "[0, 0.5, inf]"), "a.screens.toml:3: head"},
      {replaced(kTable, "0.065", "-1"), "a.screens.toml:4: eye_base"},
      {replaced(kTable, "level = true", "level = 1"), "a.screens.toml:5: level"},
      {replaced(kTable, "name = \"table\"", "name = \"\""), "a.screens.toml:7: name"},
      {replaced(kTable, "monitor = 2\n", ""), "expected either monitor"},
      {replaced(kTable, "monitor = 2\n", "monitor = 2\nwindow = [0, 0]\n"), "expected either monitor"},
      {replaced(kTable, "monitor = 2", "monitor = 0"), "a.screens.toml:8: monitor"},
      {replaced(kTable, "[1920, 1080]", "[1920, 1080.5]"), "a.screens.toml:9: pixels"},
      {replaced(kTable, "[1920, 1080]", "[1, 1080]"), "a.screens.toml:9: pixels"},
      {replaced(kTable, "upper_left = [-0.3, 0, -0.2]\n", ""), "upper_left is missing"},
      {replaced(kTable, "lower_left = [-0.3, 0,", "lower_left = [-0.1, 0,"), "right angle"},
      {replaced(kTable, "lower_left", "middle"), "unknown key"},
      {replaced(kVisor, "field = 100\n", ""), "field is missing"},
      {replaced(kVisor, "axes = 0.0635\n", ""), "expected axes"},
      {replaced(kVisor, "[0.22, 0.24]", "[1, 2, 3, 4, 5]"), "distortion"},
      {replaced(kVisor, "[0.22, 0.24]", "[-0.9]"), "turns back"},
      {replaced(kVisor, "right eye", "left eye"), "another screen is called"},
      {replaced(kVisor, "eye = \"left\"", "eye = \"third\""), "eye: expected middle, left, right or both"},
      {replaced(kVisor, "lens = { field = 100 }", "lens = 3"), "a table [screen.lens]"},
      {replaced(kVisor, "lens = {", "upper_left = [0, 0, 0]\nlens = {"), "corners or a lens"},
      {"version = 1\n", "screen is missing"},
      {"version = 1\nscreen = []\n", "tables [[screen]]"},
      {"version = 1\n[[screen]\n", "not TOML"},
  };
  for (const auto& one : all) {
    const std::string error = error_of(one.text);
    EXPECT_NE(error.find(one.error), std::string::npos) << one.error << " is not in: " << error;
    EXPECT_EQ(error.rfind("a.screens.toml:", 0), 0U) << error;
  }
  std::string many = "version = 1\n";
  for (int n = 0; n < 17; ++n) {
    std::string one = kTable.substr(kTable.find("[[screen]]"));
    many += replaced(one, "table", "t" + std::to_string(n));
  }
  EXPECT_NE(error_of(many).find("at most 16 screens, found 17"), std::string::npos);
}

TEST(ScreensFile, IsReadFromDisk) {
  const test_support::TempDir folder;
  base::write_file(folder / "a.screens.toml", kVisor);
  EXPECT_EQ(read_screens_file(folder / "a.screens.toml").screens.size(), 2U);
  EXPECT_THROW((void)read_screens_file(folder / "b.screens.toml"), base::FileError);
  base::write_file(folder / "a.toml", kVisor);
  EXPECT_THROW((void)read_screens_file(folder / "a.toml"), base::FileError);
  EXPECT_TRUE(is_screens_path("x/table.screens.toml"));
  EXPECT_FALSE(is_screens_path("table.toml"));
}

TEST(ScreensFile, TheExamplesAreRead) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(VPE_SOURCE_DIR) / "scripts/screens")) {
    EXPECT_FALSE(read_screens_file(entry.path()).screens.empty()) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 2);
}

}  // namespace
}  // namespace vpe::explore
