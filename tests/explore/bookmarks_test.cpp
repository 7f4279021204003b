#include "vpe/explore/files/bookmarks.h"

#include <rapidcheck.h>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace vpe::explore {
namespace {

constexpr const char* kText =
    "# my places\r\n"
    "\n"
    "1 -74.2 -13.5 12000 90 -15 0 60 Valles Marineris, west # of it\n"
    "  # between\n"
    "  -\t137.4  -4.6 -3500 0 -5 0 60 Below Mount Sharp  \n"
    "9 0 90 1e6 0 -90 0 45";

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

// Returns the only error of a text.
std::string fault_of(const std::string& text, int line) {
  const ParsedBookmarks parsed = parse_bookmarks(text, "B");
  EXPECT_FALSE(parsed.bookmarks.has_value()) << text;
  EXPECT_EQ(parsed.errors.size(), 1U) << text;
  if (parsed.errors.empty()) return "";
  EXPECT_EQ(parsed.errors[0].line, line) << text;
  return to_string(parsed.errors[0]);
}

TEST(Bookmarks, AreReadFromATextWrittenByPeople) {
  const auto b = parse_bookmarks(kText, "B").bookmarks;
  ASSERT_TRUE(b.has_value());
  const auto all = b->all();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].key, 1);
  EXPECT_EQ(all[0].name, "Valles Marineris, west # of it");
  EXPECT_TRUE(same(all[0].view, {{-74.2, -13.5, 12000, 90, -15, 0}, 60}));
  EXPECT_EQ(all[1].key, 0);
  EXPECT_EQ(all[1].name, "Below Mount Sharp");
  EXPECT_TRUE(same(all[2].view, {{0, 90, 1e6, 0, -90, 0}, 45}));
  EXPECT_EQ(b->at_key(9)->view.fov_deg, 45);
  EXPECT_FALSE(b->at_key(2).has_value());
  EXPECT_FALSE(b->at_key(0).has_value());
  EXPECT_EQ(b->named("Below Mount Sharp")->view.pose.alt_m, -3500);
  EXPECT_FALSE(b->named("nowhere").has_value());
  EXPECT_TRUE(parse_bookmarks("", "B").bookmarks->all().empty());
}

TEST(Bookmarks, CommentsAndUnchangedLinesStay) {
  Bookmarks b = *parse_bookmarks(kText, "B").bookmarks;
  EXPECT_EQ(b.put({1, {{1, 2, 3, 4, 5, 6}, 7}, " New one "}), "");
  EXPECT_EQ(b.put({2, {}, ""}), "");
  EXPECT_EQ(b.put({0, {}, "Below Mount Sharp"}), "");
  EXPECT_EQ(b.to_text(),
            "# my places\n"
            "\n"
            "1 1 2 3 4 5 6 7 New one\n"
            "  # between\n"
            "- 0 0 0 0 0 0 60 Below Mount Sharp\n"
            "9 0 90 1e6 0 -90 0 45\n"
            "2 0 0 0 0 0 0 60\n");
  EXPECT_TRUE(b.remove(1));
  EXPECT_FALSE(b.named("Below Mount Sharp").has_value());
  EXPECT_NE(b.to_text().find("  # between\n9 0"), std::string::npos);
  EXPECT_FALSE(b.remove(3));
}

TEST(Bookmarks, AnEmptyFileGetsAnExplainingLine) {
  Bookmarks b;
  EXPECT_EQ(b.put({3, {{-74.2, -13.5, 12000, 90, -15, 0}, 60}, "West"}), "");
  EXPECT_EQ(b.to_text(),
            "# vpe bookmarks: N lon lat alt yaw pitch roll fov name\n3 -74.2 -13.5 12000 90 -15 0 60 West\n");
}

TEST(Bookmarks, BadBookmarksAreRejectedWithAReason) {
  Bookmarks b;
  EXPECT_NE(b.put({10, {}, "x"}).find("1 to 9"), std::string::npos);
  EXPECT_NE(b.put({1, {}, "two\nlines"}).find("one line"), std::string::npos);
  EXPECT_NE(b.put({0, {}, "  "}).find("key or a name"), std::string::npos);
  EXPECT_NE(b.put({1, {{0, 91, 0, 0, 0, 0}, 60}, ""}).find("lat must be from -90 to 90, not 91"),
            std::string::npos);
  EXPECT_NE(b.put({1, {{0, std::nan(""), 0, 0, 0, 0}, 60}, ""}).find("lat"), std::string::npos);
  EXPECT_NE(b.put({1, {{}, 180}, ""}).find("fov"), std::string::npos);
  EXPECT_EQ(b.to_text(), "");
}

TEST(Bookmarks, BadLinesAreReportedByNumber) {
  const std::string good = "1 0 0 0 0 0 0 60\n";
  EXPECT_EQ(fault_of(good + "2 0 0 0 0 0 0\n", 2), "B:2: expected a number for fov, found the end of the line");
  EXPECT_EQ(fault_of("\n# x\n0 0 0 0 0 0 0 60\n", 3),
            "B:3: expected a key from 1 to 9, or - for none, found \"0\"");
  EXPECT_EQ(fault_of("3 0 north 0 0 0 0 60\n", 1), "B:1: expected a number for lat, found \"north\"");
  EXPECT_EQ(fault_of("3 0 -91 0 0 0 0 60\n", 1),
            "B:1: expected numbers in their range: lat must be from -90 to 90, not -91");
  EXPECT_EQ(fault_of(good + good, 2), "B:2: expected each key once, found 1 again after line 1");
  EXPECT_NE(fault_of("3 0 0 0 0 0 0 60 a\x1b[31m\n", 1).find("\"a?[31m\""), std::string::npos);
  std::string many;
  for (int n = 0; n < 100; ++n) many += "rubbish\n";
  EXPECT_EQ(parse_bookmarks(many, "B").errors.size(), ParsedBookmarks::kMaxErrors);
}

TEST(Bookmarks, RoundTripsToTheBit) {
  rc::check([] {
    const auto within = [](double low, double high) {
      return low + (high - low) *
                       static_cast<double>(*rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 53)) * 0x1p-53;
    };
    Bookmarks b;
    std::vector<Bookmark> put;
    const int count = *rc::gen::inRange(0, 12);
    for (int n = 0; n < count; ++n) {
      Bookmark one{
          n < 9 ? n + 1 : 0,
          {{within(-360, 360), within(-90, 90), within(-1e6, 1e9), within(-360, 360), within(-90, 90),
            within(-360, 360)},
           within(0.01, 179)},
          "n" + std::to_string(n) + *rc::gen::container<std::string>(rc::gen::inRange<char>(' ', '~'))};
      RC_ASSERT(b.put(one).empty());
      put.push_back(one);
    }
    const ParsedBookmarks parsed = parse_bookmarks(b.to_text(), "B");
    RC_ASSERT(parsed.bookmarks.has_value());
    const auto all = parsed.bookmarks->all();
    RC_ASSERT(all.size() == put.size());
    for (std::size_t n = 0; n < all.size(); ++n) {
      RC_ASSERT(all[n].key == put[n].key);
      RC_ASSERT(same(all[n].view, put[n].view));
      RC_ASSERT(all[n].name == put[n].name.substr(0, put[n].name.find_last_not_of(' ') + 1));
    }
    RC_ASSERT(parsed.bookmarks->to_text() == b.to_text());
  });
}

TEST(Bookmarks, ARenamedBookmarkKeepsItsLine) {
  Bookmarks b =
      *parse_bookmarks("# mine\n1 0 0 0 0 0 0 60 one\n- 1 0 0 0 0 0 60 two\n- 2 0 0 0 0 0 60 three\n", "B")
           .bookmarks;
  EXPECT_EQ(b.rename(1, "  zwei "), "");
  EXPECT_EQ(b.rename(0, ""), "");  // it has a key
  EXPECT_EQ(b.to_text(), "# mine\n1 0 0 0 0 0 0 60\n- 1 0 0 0 0 0 60 zwei\n- 2 0 0 0 0 0 60 three\n");
  EXPECT_EQ(b.rename(2, "three"), "");
  EXPECT_NE(b.rename(2, "zwei"), "");
  EXPECT_NE(b.rename(2, " "), "");
  EXPECT_NE(b.rename(2, "a\nb"), "");
  EXPECT_NE(b.rename(3, "four"), "");
  EXPECT_EQ(b.all()[2].name, "three");
}

TEST(BookmarkFile, IsCreatedWithItsFolderAndReadBack) {
  const test_support::TempDir folder;
  const auto path = folder / "data/vpe/bookmarks";
  EXPECT_TRUE(load_bookmarks(path).bookmarks->all().empty());
  Bookmarks b;
  ASSERT_EQ(b.put({4, {}, "Schiaparelli — außen"}), "");
  save_bookmarks(path, b);
  EXPECT_EQ(load_bookmarks(path).bookmarks->at_key(4)->name, "Schiaparelli — außen");
  // Nothing else is left in the folder.
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path()))
    files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 1);
}

TEST(BookmarkFile, ALinkIsFollowedAndAFailureLeavesTheOldFile) {
  const test_support::TempDir folder;
  std::filesystem::create_directories(folder / "dotfiles");
  std::ofstream(folder / "dotfiles/marks") << "1 0 0 0 0 0 0 60\n";
  std::filesystem::create_symlink(folder / "dotfiles/marks", folder / "bookmarks");
  Bookmarks b = *load_bookmarks(folder / "bookmarks").bookmarks;
  ASSERT_EQ(b.put({2, {}, ""}), "");
  save_bookmarks(folder / "bookmarks", b);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "bookmarks"));
  EXPECT_EQ(read_text(folder / "dotfiles/marks"), "1 0 0 0 0 0 0 60\n2 0 0 0 0 0 0 60\n");
  EXPECT_THROW(save_bookmarks(folder / "dotfiles/marks/bookmarks", b), base::FileError);
  EXPECT_THROW(load_bookmarks(folder / "dotfiles"), base::FileError);
  EXPECT_EQ(read_text(folder / "dotfiles/marks"), "1 0 0 0 0 0 0 60\n2 0 0 0 0 0 0 60\n");
}

}  // namespace
}  // namespace vpe::explore
