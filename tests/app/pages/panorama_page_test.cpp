// --html of vpe panorama and vpe overlook, as a user runs them.
#include <cmath>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;

class PanoramaPage : public AppTest {
 protected:
  // Writes a small panorama with layers.
  Result draw(const std::string& name, const Words& more = {}) const {
    Words words{"panorama",
                planet().string(),
                "--at",
                "10,5",
                "--height",
                "500",
                "-o",
                name,
                "--width",
                "900",
                "--elevation=-20,20",
                "--aux-layers",
                "range,lonlat"};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }
  nlohmann::json data(const std::string& folder) const {
    const std::string script = read_text(dir_ / folder / "data.js");
    const std::size_t begin = script.find("vpeData = ") + 10;
    return nlohmann::json::parse(script.substr(begin, script.rfind(';') - begin));
  }
};

TEST_F(PanoramaPage, IsWrittenWithThePanorama) {
  const Result result = draw("a.png", {"--html", "page", "--html-title", "Hills & craters", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out).at("page").at("levels"), 2);
  EXPECT_TRUE(exists("page/index.html"));
  EXPECT_TRUE(exists("page/tiles/left/0/1_0.js"));
  EXPECT_TRUE(exists("page/layers/0_0.js"));
  EXPECT_EQ(read_text(dir_ / "page/picture.png"), read_text(dir_ / "a.png"));
  EXPECT_EQ(data("page").at("title"), "Hills & craters");
  EXPECT_EQ(data("page").at("layers").at("bands").size(), 3U);
  EXPECT_TRUE(leftovers().empty());
}

TEST_F(PanoramaPage, OfAnExistingPanoramaIsTheSame) {
  ASSERT_EQ(draw("a.png", {"--html", "page"}).exit_code, 0);
  ASSERT_EQ(vpe({"overlook", "a.png", "--html", "other"}).exit_code, 0);
  for (const char* name : {"index.html", "data.js", "tiles/left/0/0_0.js", "layers/0_0.js"})
    EXPECT_EQ(read_text(dir_ / "page" / name), read_text(dir_ / "other" / name)) << name;
}

TEST_F(PanoramaPage, OtherFilesAreKept) {
  ASSERT_EQ(draw("a.png").exit_code, 0);
  fs::create_directory(dir_ / "mine");
  write_text(dir_ / "mine/notes.txt", "mine");
  expect_failure({"overlook", "a.png", "--html", "mine"}, 1, {"mine", "holds files", "--force"});
  ASSERT_EQ(vpe({"overlook", "a.png", "--html", "mine", "--force"}).exit_code, 0);
  EXPECT_EQ(read_text(dir_ / "mine/notes.txt"), "mine");
  // Found before any work.
  expect_failure({"overlook", "none.png", "--html", "a.png"}, 1, {"a.png", "no folder"});
  expect_failure({"overlook", "a.png", "--html-title", "x"}, 2, {"--html"});
}

TEST_F(PanoramaPage, HotspotsLeadToPagesBesideIt) {
  ASSERT_EQ(draw("a.png").exit_code, 0);
  Words words{"panorama", planet().string(), "--at",    "10.5,5", "--height", "500",
              "-o",       "rim two.png",     "--width", "600"};
  ASSERT_EQ(vpe(words).exit_code, 0);
  write_text(dir_ / "spots.txt", "spot Here 10 5 500 a.png\nspot \"The rim\" 10.5 5 500 \"rim two.png\"\n");
  const Result result = vpe({"overlook", "a.png", "--html", "a", "--html-hotspots", "spots.txt"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.err, {"The rim", "not there yet"}));
  const auto hotspots = data("a").at("hotspots");
  ASSERT_EQ(hotspots.size(), 1U);
  EXPECT_EQ(hotspots.at(0).at("text"), "The rim");
  EXPECT_EQ(hotspots.at(0).at("page"), "../rim%20two/index.html");
  EXPECT_NEAR(hotspots.at(0).at("azimuth_deg").get<double>(), 90, 0.1);
  EXPECT_NEAR(hotspots.at(0).at("range_m").get<double>(), 29530, 500);
  write_text(dir_ / "bad.txt", "spot\n");
  expect_failure({"overlook", "a.png", "--html", "b", "--html-hotspots", "bad.txt"}, 1,
                 {"bad.txt", "spot NAME"});
}

}  // namespace
}  // namespace app_test
