#include "panorama/page/page_writer.h"

#include <algorithm>
#include <set>

#include "panorama/page/page_files.h"
#include "panorama/projection.h"
#include "tests/panorama/page/page_fixture.h"
#include "vpe/base/temporary.h"

namespace {

namespace fs = std::filesystem;
using page_test::lossless;
using page_test::message_of;
using page_test::Opened;
using panorama::PageReport;
using panorama::write_page;

std::set<std::string> files_below(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.insert(entry.path().lexically_relative(folder).generic_string());
  }
  return names;
}

class PageWriter : public testing::Test {
 protected:
  PageReport write(const fs::path& folder, const panorama::PageOptions& options = lossless()) {
    return write_page(folder, opened_.content(), options, pool_);
  }
  const test_support::TempDir dir_;
  const Opened opened_{page_test::write_sample(dir_ / "in")};
  vpe::base::ThreadPool pool_{3};
};

TEST_F(PageWriter, WritesAllThatThePageNeeds) {
  const PageReport report = write(dir_ / "page");
  EXPECT_EQ(report.levels, 3);
  EXPECT_EQ(report.tiles, 3 * 2 + 2 * 1 + 1);
  EXPECT_EQ(report.layer_tiles, 6 * 3);
  const auto names = files_below(dir_ / "page");
  for (const char* name : {"index.html", "data.js", "preview.jpg", "picture.png", "tiles/left/0/2_1.js",
                           "tiles/left/2/0_0.js", "layers/5_2.js", "viewer/main.js", "viewer/style.css"})
    EXPECT_TRUE(names.contains(name)) << name;
  EXPECT_EQ(names.size(), 4 + 9 + 18 + panorama::viewer_files().size());
  EXPECT_EQ(page_test::text_of(dir_ / "page/picture.png"), page_test::text_of(dir_ / "in/a.png"));
  const auto data = page_test::data_of(dir_ / "page");
  EXPECT_EQ(data.at("picture"), "picture.png");
  EXPECT_EQ(data.at("title"), "a.png");
  EXPECT_EQ(data.at("layers").at("width"), page_test::kWidth);
  // Only the page is there, no draft.
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_.path()), fs::directory_iterator()), 2);
}

TEST_F(PageWriter, TilesShowTheImage) {
  write(dir_ / "page");
  for (const auto& [column, row] : {std::pair{0, 0}, {1, 1}, {2, 0}}) {
    const auto tile =
        page_test::tile_of(dir_ / "page", "left/0/" + std::to_string(column) + "_" + std::to_string(row));
    for (int y = 1; y < tile.height - 1; y += 7) {
      for (int x = 1; x < tile.width - 1; ++x) {
        ASSERT_EQ(tile.pixels[static_cast<std::size_t>(y * tile.width + x)],
                  page_test::colour_at(column * 512 + x - 1, row * 512 + y - 1));
      }
    }
  }
  const auto last = page_test::tile_of(dir_ / "page", "left/0/2_0");
  EXPECT_EQ(last.pixels[static_cast<std::size_t>(5 * last.width + last.width - 1)], page_test::colour_at(0, 4));
}

TEST_F(PageWriter, JpegIsTheDefaultAndNearTheImage) {
  write(dir_ / "page", {});
  EXPECT_NE(page_test::text_of(dir_ / "page/tiles/left/2/0_0.js").find("\"image/jpeg\""), std::string::npos);
  EXPECT_EQ(page_test::tile_of(dir_ / "page", "left/0/0_0").width, 514);
}

TEST_F(PageWriter, TheSamePageForAnyNumberOfThreads) {
  write(dir_ / "a");
  vpe::base::ThreadPool alone(1);
  write_page(dir_ / "b", opened_.content(), lossless(), alone);
  const auto names = files_below(dir_ / "a");
  ASSERT_EQ(names, files_below(dir_ / "b"));
  for (const std::string& name : names)
    ASSERT_EQ(page_test::text_of(dir_ / ("a/" + name)), page_test::text_of(dir_ / ("b/" + name))) << name;
}

TEST_F(PageWriter, NamesMayHaveBlanksAndLettersOfAllLanguages) {
  const Opened opened(page_test::write_sample(dir_ / "Süd <1>", "Gale – 火星.png"));
  const fs::path folder = dir_ / "Seite – 頁 a'b";
  write_page(folder / "", opened.content(), lossless(), pool_);
  const std::string html = page_test::text_of(folder / "index.html");
  EXPECT_NE(html.find("<title>Gale – 火星.png</title>"), std::string::npos);
  for (const std::string& name : files_below(folder)) {
    EXPECT_TRUE(std::all_of(name.begin(), name.end(), [](char c) {
      return c > ' ' && c < 127 && c != '%' && c != '#';
    })) << name;
  }
}

TEST_F(PageWriter, BothEyesOfAPair) {
  vpe::core::RgbImage pair = page_test::pattern(1400, 300);
  vpe::core::write_image(dir_ / "pair.png", pair.pixels, 1400, 300);
  std::ofstream(dir_ / "pair.json")
      << R"({"image": "pair.png", "projection": "cylinder", "width": 700, "height": 300,
    "azimuth_deg_at_left": 0, "columns_per_turn": 700, "horizon_row": 150, "stereo": "sbs"})";
  const Opened opened(dir_ / "pair.png");
  panorama::PageContent content = opened.content();
  content.right.emplace(panorama::PageImage{*opened.image, {700, 0}, opened.description.map});
  write_page(dir_ / "page", content, lossless(), pool_);
  EXPECT_EQ(page_test::data_of(dir_ / "page").at("eyes"), nlohmann::json::array({"left", "right"}));
  const auto right = page_test::tile_of(dir_ / "page", "right/0/0_0");
  EXPECT_EQ(right.pixels[static_cast<std::size_t>(right.width + 1)], page_test::colour_at(700, 0));
  EXPECT_EQ(right.pixels[static_cast<std::size_t>(right.width)], page_test::colour_at(1399, 0));
}

TEST_F(PageWriter, AFormerPageIsReplacedAsAWhole) {
  panorama::PageOptions options = lossless();
  write(dir_ / "page", options);
  options.with_image = false;
  write(dir_ / "page", options);
  EXPECT_FALSE(fs::exists(dir_ / "page/picture.png"));
  EXPECT_EQ(page_test::data_of(dir_ / "page").at("picture"), "");
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_.path()), fs::directory_iterator()), 2);
  fs::create_directory(dir_ / "empty");
  write(dir_ / "empty");
  EXPECT_TRUE(fs::exists(dir_ / "empty/index.html"));
}

TEST_F(PageWriter, OtherFilesAreNeitherReplacedNorRemoved) {
  fs::create_directory(dir_ / "mine");
  std::ofstream(dir_ / "mine/notes.txt") << "mine";
  const std::string message = message_of([&] { write(dir_ / "mine"); });
  for (const char* word : {"mine", "holds files", "--force"})
    EXPECT_NE(message.find(word), std::string::npos) << message;
  EXPECT_EQ(files_below(dir_ / "mine"), std::set<std::string>{"notes.txt"});
  panorama::PageOptions options = lossless();
  options.force = true;
  write(dir_ / "mine", options);
  write(dir_ / "mine", options);
  EXPECT_EQ(page_test::text_of(dir_ / "mine/notes.txt"), "mine");
  EXPECT_TRUE(fs::exists(dir_ / "mine/tiles/left/0/0_0.js"));
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_.path()), fs::directory_iterator()), 2);
  // A page with a file of the user is no longer a page alone.
  write(dir_ / "page");
  std::ofstream(dir_ / "page/notes.txt") << "mine";
  EXPECT_NE(message_of([&] { write(dir_ / "page"); }), "");
  EXPECT_TRUE(fs::exists(dir_ / "page/notes.txt"));
}

TEST_F(PageWriter, WhatIsInTheWayIsNamed) {
  std::ofstream(dir_ / "file") << "x";
  EXPECT_NE(message_of([&] { write(dir_ / "file"); }).find("no folder"), std::string::npos);
  const std::string message = message_of([&] { write(dir_ / "none/page"); });
  EXPECT_NE(message.find("none/page"), std::string::npos) << message;
  EXPECT_NE(message.find("make the folder"), std::string::npos) << message;
}

TEST_F(PageWriter, StoppingLeavesNothingBehind) {
  write(dir_ / "page");
  const auto before = files_below(dir_ / "page");
  panorama::PageOptions options = lossless();
  double last = 0;
  options.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    last = fraction;
    if (fraction > 0.5) throw std::runtime_error("stopped");
  };
  for (const char* name : {"page", "other"})
    EXPECT_EQ(message_of([&] {
                last = 0;
                write(dir_ / name, options);
              }),
              "stopped");
  EXPECT_EQ(files_below(dir_ / "page"), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_.path()), fs::directory_iterator()), 2);
}

TEST_F(PageWriter, FilesThatAreGoneAreNamedAndLeaveNothingBehind) {
  fs::remove(dir_ / "in/a.range.tif");
  EXPECT_NE(message_of([&] { write(dir_ / "page"); }).find("a.range.tif"), std::string::npos);
  page_test::write_sample(dir_ / "in");
  fs::remove(dir_ / "in/a.png");
  EXPECT_NE(message_of([&] { write(dir_ / "page"); }).find("a.png"), std::string::npos);
  fs::resize_file(dir_ / "in/a.lonlat.tif", fs::file_size(dir_ / "in/a.lonlat.tif") / 2);
  EXPECT_NE(message_of([&] { write(dir_ / "page"); }).find("a.lonlat.tif"), std::string::npos);
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_.path()), fs::directory_iterator()), 1);
}

// A disk of 1 MB needs rights that tests do not have everywhere: /dev/full stands for it.
TEST(PageFolder, AFullDiskIsNamed) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "skipped: no /dev/full";
  const test_support::TempDir dir;
  panorama::PageFolder page(dir / "page", false);
  for (const auto& entry : fs::directory_iterator(dir.path()))
    fs::create_symlink("/dev/full", entry.path() / "a.js");
  const std::string message = message_of([&] { page.write("a.js", std::string(100'000, 'x')); });
  EXPECT_NE(message.find("a.js"), std::string::npos) << message;
  EXPECT_NE(message.find("No space left"), std::string::npos) << message;
}

TEST(PageFolder, DraftsOfKilledRunsAreRemoved) {
  const test_support::TempDir dir;
  const std::string mark = "page" + vpe::base::process_mark();
  // No process has this number.
  const std::string stale = mark.substr(0, mark.rfind('-')) + "-999999999.tmp";
  fs::create_directory(dir / stale);
  std::ofstream(dir / (stale + "/index.html")) << "x";
  fs::create_directory(dir / "page.tmp");
  { const panorama::PageFolder page(dir / "page", false); }
  EXPECT_FALSE(fs::exists(dir / stale));
  EXPECT_TRUE(fs::exists(dir / "page.tmp"));
}

}  // namespace
