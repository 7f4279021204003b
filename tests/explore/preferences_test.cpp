#include "vpe/explore/files/preferences.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace vpe::explore {
namespace {

namespace fs = std::filesystem;
using test_support::TempDir;

base::Environment environment(const std::map<std::string, std::string>& variables) {
  return [variables](const char* name) {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  };
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

std::string text_of(const fs::path& file) { return read_user_file(file).value_or("(none)"); }

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(UserFiles, AreWhereTheSpecificationSays) {
  const auto files = [](const std::map<std::string, std::string>& variables) {
    const ExploreFiles found = explore_files(environment(variables));
    return std::pair(found.preferences.string(), found.session.string());
  };
  EXPECT_EQ(explore_files(environment({{"HOME", "/h"}})).bookmarks, "/h/.local/share/vpe/bookmarks");
  using P = std::pair<std::string, std::string>;
  EXPECT_EQ(files({{"HOME", "/h"}}), P("/h/.config/vpe/explore.toml", "/h/.local/state/vpe/explore.toml"));
  EXPECT_EQ(files({{"HOME", "/h"}, {"XDG_CONFIG_HOME", "/c"}, {"XDG_STATE_HOME", "/s"}}),
            P("/c/vpe/explore.toml", "/s/vpe/explore.toml"));
  EXPECT_EQ(files({{"HOME", "/h"}, {"XDG_CONFIG_HOME", ""}, {"XDG_STATE_HOME", "relative"}}),
            P("/h/.config/vpe/explore.toml", "/h/.local/state/vpe/explore.toml"));
  EXPECT_EQ(files({{"XDG_STATE_HOME", "/s"}}), P("", "/s/vpe/explore.toml"));
  EXPECT_EQ(files({{"HOME", "relative"}}), P("", ""));
  EXPECT_EQ(files({}), P("", ""));
}

TEST(UserFiles, AreWrittenAtOnceInFoldersOfTheUser) {
  const TempDir folder;
  const fs::path file = folder / "a/b/f.toml";
  write_user_file(file, "one");
  write_user_file(file, "two");
  EXPECT_EQ(text_of(file), "two");
  EXPECT_EQ(files_in(folder / "a/b"), 1U);  // nothing temporary is left
  struct stat info {};
  ASSERT_EQ(::stat((folder / "a").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777U, 0700U);
}

TEST(UserFiles, ALinkStaysALink) {
  const TempDir folder;
  write(folder / "real.toml", "one");
  fs::create_symlink(folder / "real.toml", folder / "link.toml");
  write_user_file(folder / "link.toml", "two");
  EXPECT_TRUE(fs::is_symlink(folder / "link.toml"));
  EXPECT_EQ(text_of(folder / "real.toml"), "two");
}

TEST(UserFiles, WhatIsNoFileIsSaid) {
  const TempDir folder;
  EXPECT_EQ(read_user_file(folder / "none"), std::nullopt);
  write(folder / "file", "x");
  EXPECT_EQ(read_user_file(folder / "file/below"), std::nullopt);
  EXPECT_THROW((void)read_user_file(folder.path()), base::FileError);
  EXPECT_THROW(write_user_file(folder.path(), ""), base::FileError);
  EXPECT_THROW(write_user_file(folder / "file/below/f.toml", ""), base::FileError);
  write(folder / "large", std::string((1U << 20U) + 1, '#'));
  EXPECT_THROW((void)read_user_file(folder / "large"), base::FileError);
}

TEST(Preferences, WithoutAFileTheyAreTheDefaults) {
  const TempDir folder;
  EXPECT_EQ(read_preferences(folder / "none/explore.toml"), Preferences{});
  EXPECT_EQ(read_preferences(""), Preferences{});
  EXPECT_FALSE(read_session("").pose.has_value());
}

TEST(Preferences, AreReadBackAsTheyWereSaved) {
  const TempDir folder;
  Preferences p;
  p.fly_speed = 2.5;
  p.invert_wheel = true;
  p.longitude = LongitudeRange::kPositive;
  p.gamepad.invert_pitch = true;
  p.gamepad.dead_zone = 0.1 + 0.2;
  p.space_mouse.roll = false;
  p.use_head_tracker = true;
  p.head_from = {.address = "0.0.0.0", .port = 5555};
  p.head.invert_yaw = true;
  ASSERT_EQ(save(p, folder / "new/explore.toml"), "");
  EXPECT_EQ(read_preferences(folder / "new/explore.toml"), p);
  const std::string text = text_of(folder / "new/explore.toml");
  EXPECT_NE(text.find("\nport = 5555  #"), std::string::npos) << text;
  EXPECT_NE(text.find("\n# speed = 1  #"), std::string::npos) << text;

  // The text of --print-settings is such a file too, with all keys.
  write(folder / "printed.toml", to_text(p));
  EXPECT_EQ(read_preferences(folder / "printed.toml"), p);
  EXPECT_EQ(to_text(p).find("\n# "), std::string::npos);
}

// Each key by itself: changed, saved, read.
TEST(Preferences, EveryKeyIsKept) {
  const TempDir folder;
  const core::KeyRegistry<Preferences>& keys = preference_keys();
  std::set<std::string_view> names;
  for (std::size_t n = 0; n < keys.infos().size(); ++n) {
    Preferences changed;
    const core::KeyInfo& key = keys.infos()[n];
    EXPECT_TRUE(names.insert(key.name).second) << key.name;
    core::KeyValue value = keys.get(n, changed);
    EXPECT_TRUE(core::is_allowed(key, value)) << key.name;
    if (const auto* number = std::get_if<core::NumberKey>(&key.type)) {
      value = (number->min + number->max) / 2.7;
    } else if (const auto* whole = std::get_if<core::IntegerKey>(&key.type)) {
      value = whole->max;
    } else if (std::holds_alternative<core::SwitchKey>(key.type)) {
      value = !std::get<bool>(value);
    } else if (const auto* choice = std::get_if<core::ChoiceKey>(&key.type)) {
      value = choice->words.back().value;
    } else if (std::holds_alternative<core::TextKey>(key.type)) {
      value = std::string("::1");
    }
    keys.set(n, changed, value);
    EXPECT_FALSE(changed == Preferences{}) << key.name;
    ASSERT_EQ(save(changed, folder / "f.toml"), "");
    EXPECT_TRUE(read_preferences(folder / "f.toml") == changed) << key.name << "\n"
                                                                << text_of(folder / "f.toml");
  }
}

TEST(Preferences, BadFilesAreRefusedByLine) {
  const TempDir folder;
  const auto why = [&folder](const std::string& text) {
    write(folder / "f.toml", text);
    try {
      (void)read_preferences(folder / "f.toml");
      return std::string();
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
  };
  const std::string file = (folder / "f.toml").string();
  EXPECT_EQ(why("[gamepad]\ndead_zone = 0.95\n"),
            file + ":2: gamepad.dead_zone: expected a number from 0 to 0.9, found 0.95");
  EXPECT_EQ(why("[head_tracker]\nport = 0"),
            file + ":2: head_tracker.port: expected a whole number from 1 to 65535, found 0");
  EXPECT_EQ(why("[head_tracker]\naddress = \"localhost\""),
            file + ":2: head_tracker.address: expected a numeric address such as 127.0.0.1, found 'localhost'");
  EXPECT_NE(
      why("[head]\nport = 1").find("tables are mouse, move, draw, ui, gamepad, space_mouse, head_tracker"),
      std::string::npos);
  EXPECT_NE(why("\xff\xfe\x00"), "");
}

TEST(Preferences, WhatCannotBeSavedIsSaidAndNothingElseHappens) {
  const TempDir folder;
  write(folder / "file", "x");
  const std::string problem = save(Preferences{}, folder / "file/vpe/explore.toml");
  EXPECT_NE(problem.find("file/vpe"), std::string::npos) << problem;
  EXPECT_NE(problem.find("Not a directory"), std::string::npos) << problem;
  EXPECT_EQ(text_of(folder / "file"), "x");
  EXPECT_NE(save(Preferences{}, "").find("set HOME"), std::string::npos);
  EXPECT_NE(save(LastSession{}, folder.path()), "");
}

TEST(Preferences, NumbersBeyondTheirRangeAreSavedWithinIt) {
  const TempDir folder;
  Preferences p;
  p.fly_speed = 1e9;
  p.ui_scale = std::nan("");
  p.head_from.address = "nowhere";
  ASSERT_EQ(save(p, folder / "f.toml"), "");
  const Preferences back = read_preferences(folder / "f.toml");
  EXPECT_EQ(back.fly_speed, 100);
  EXPECT_EQ(back.ui_scale, 0);
  EXPECT_EQ(back.head_from.address, "127.0.0.1");
}

TEST(LastSession, IsReadBackAsItWasSaved) {
  const TempDir folder;
  LastSession s;
  s.window_width_px = 2560;
  s.planet = "/data/Gale \"crater\".vpe";
  s.pose = mars::Pose{137.4, -4.6, 12345.678901234567, -179.25, -10, 1e-7};
  s.drawn_by = core::DrawnBy::kRay;
  s.panels = false;
  ASSERT_EQ(save(s, folder / "explore.toml"), "");
  const LastSession back = read_session(folder / "explore.toml");
  EXPECT_EQ(back.window_width_px, 2560);
  EXPECT_EQ(back.window_height_px, 720);
  EXPECT_EQ(back.planet, s.planet);
  ASSERT_TRUE(back.pose.has_value());
  EXPECT_EQ(back.pose->alt_m, s.pose->alt_m);
  EXPECT_EQ(back.pose->roll_deg, s.pose->roll_deg);
  EXPECT_EQ(back.drawn_by, core::DrawnBy::kRay);
  EXPECT_FALSE(back.panels);
}

TEST(LastSession, FormerNamesOfBackendsAreRead) {
  const TempDir folder;
  write(folder / "explore.toml", "[last]\nbackend = \"voxel\"\n");
  EXPECT_EQ(read_session(folder / "explore.toml").drawn_by, core::DrawnBy::kRay);
  ASSERT_EQ(save(read_session(folder / "explore.toml"), folder / "explore.toml"), "");
  EXPECT_NE(text_of(folder / "explore.toml").find("backend = \"ray\"  #"), std::string::npos);
}

TEST(LastSession, WhatNobodyCouldReadBackIsNotSaved) {
  const TempDir folder;
  LastSession s;
  s.planet = "\xff\xfe.vpe";
  s.pose = mars::Pose{0, std::nan(""), 0, 0, 0, 0};
  s.window_width_px = -5;
  ASSERT_EQ(save(s, folder / "explore.toml"), "");
  const LastSession back = read_session(folder / "explore.toml");
  EXPECT_EQ(back.planet, "");
  EXPECT_FALSE(back.pose.has_value());
  EXPECT_EQ(back.window_width_px, 1);
}

}  // namespace
}  // namespace vpe::explore
