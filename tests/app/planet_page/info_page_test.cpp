// --html of vpe info, as a user runs it.
#include <cmath>
#include <pugixml.hpp>
#include <sstream>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

class InfoPage : public AppTest {
 protected:
  // Makes a page and parses it: a page is well-formed XML.
  pugi::xml_document page(const std::string& planet, const Words& more = {}) {
    Words words{"info", planet, "--html", "page.html", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    out_ = result.out;
    html_ = read_text(dir_ / "page.html");
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_string(html_.c_str(), pugi::parse_full);
    EXPECT_TRUE(parsed) << parsed.description() << " at "
                        << html_.substr(static_cast<std::size_t>(parsed.offset), 80);
    return document;
  }

  // Returns the row of a table with this caption, as texts by the names of its columns.
  static std::map<std::string, std::string> row(const pugi::xml_document& document, const std::string& caption,
                                                const std::string& first) {
    for (const pugi::xpath_node& found : document.select_nodes("//table")) {
      const pugi::xml_node table = found.node();
      if (std::string(table.child("caption").text().get()).find(caption) == std::string::npos) continue;
      for (const pugi::xml_node line : table.child("tbody").children("tr")) {
        if (line.child("th").text().get() != first) continue;
        std::map<std::string, std::string> cells;
        pugi::xml_node cell = line.first_child();
        for (const pugi::xml_node head : table.child("thead").child("tr").children("th")) {
          cells[head.text().get()] = cell.text().get();
          cell = cell.next_sibling();
        }
        return cells;
      }
    }
    ADD_FAILURE() << "no row " << first << " in a table " << caption;
    return {};
  }

  // Makes a planet of one DEM.
  std::string build(const std::string& name, const Dem& dem, const Words& more = {}) {
    write_dem(dir_ / name, dem);
    Words words{"build", name, "-o", "own.vpe", "--force", "--quiet"};
    if (more.empty()) words.insert(words.end(), {"--base-spacing", "100000"});
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return "own.vpe";
  }

  std::string html_;
  std::string out_;
};

TEST_F(InfoPage, StatesTheFiguresOfJson) {
  const auto document = page(planet().string(), {"--json"});
  const nlohmann::json json = parse_json(out_);
  EXPECT_EQ(json.at("html"), "page.html");
  EXPECT_EQ(row(document, "states", "posts of finest tiles")["value"],
            std::to_string(json.at("posts").get<int>()));
  EXPECT_NE(row(document, "states", "built by")["value"].find(json.at("identity").get<std::string>()),
            std::string::npos);
  EXPECT_NE(row(document, "states", "file size")["value"].find(
                std::to_string(std::filesystem::file_size(planet())) + " bytes"),
            std::string::npos);
  for (const nlohmann::json& level : json.at("by_level")) {
    auto cells = row(document, "Levels", std::to_string(level.at("level").get<int>()));
    EXPECT_EQ(cells["tiles"], std::to_string(level.at("tiles").get<int>()));
    EXPECT_EQ(cells["nodata"], std::to_string(level.at("holes").get<int>()));
    EXPECT_NEAR(std::stod(cells["posts, m"]), level.at("post_spacing_m").get<double>(),
                6e-4 * level.at("post_spacing_m").get<double>());
  }
  auto source = row(document, "Sources of elevations", "1");
  EXPECT_EQ(source["name"], json.at("sources")[0].at("name"));
  EXPECT_EQ(source["area, %"], "100");
  EXPECT_EQ(source["kind"], "data");
}

TEST_F(InfoPage, HasEachLineOfTheText) {
  const auto document = page(planet().string());
  std::string text;
  for (const pugi::xpath_node& found : document.select_nodes("//main//text()"))
    text += std::string(found.node().value()) + "\n";
  std::istringstream lines(out_);
  std::string line;
  int seen = 0;
  while (std::getline(lines, line) && !line.starts_with("level ")) {
    ASSERT_GT(line.size(), 19U);
    EXPECT_NE(text.find(line.substr(19)), std::string::npos) << line;
    ++seen;
  }
  EXPECT_GT(seen, 8);
}

TEST_F(InfoPage, IsOneFileThatCanBeReadWithoutSeeing) {
  const auto document = page(planet().string());
  EXPECT_TRUE(document.select_nodes("//script | //link | //iframe | //object").empty());
  for (const pugi::xpath_node& found : document.select_nodes("//@src | //@href"))
    EXPECT_TRUE(std::string(found.attribute().value()).starts_with("data:image/png;base64,"));
  // Base64 may hold two slashes.
  std::string text = html_;
  for (std::size_t at = 0; (at = text.find("base64,", at)) != std::string::npos; ++at)
    text.erase(at, text.find('"', at) - at);
  EXPECT_EQ(text.find("@import"), std::string::npos);
  for (std::size_t at = 0; (at = text.find("://", at)) != std::string::npos; ++at)
    EXPECT_EQ(text.substr(at, 22), "://www.w3.org/2000/svg");
  for (std::size_t at = 0; (at = text.find("url(", at)) != std::string::npos; ++at)
    EXPECT_EQ(text[at + 4], '#');
  EXPECT_TRUE(document.select_nodes("//img[not(@alt) or @alt='']").empty());
  EXPECT_TRUE(document.select_nodes("//table[not(caption)]").empty());
  EXPECT_TRUE(document.select_nodes("//th[not(@scope)]").empty());
  EXPECT_TRUE(document.select_nodes("//svg[@role='img' and not(title)]").empty());
  EXPECT_TRUE(document.select_nodes("//svg[not(@role) and not(@aria-hidden)]").empty());
  EXPECT_EQ(document.select_nodes("//h1").size(), 1U);
  EXPECT_LT(html_.size(), 1'400'000U);
}

TEST_F(InfoPage, IsTheSameForTheSameFile) {
  page(planet().string());
  const std::string first = html_;
  page(planet().string(), {"--threads", "1", "--memory", "64"});  // replaces the former one
  EXPECT_EQ(html_, first);
}

TEST_F(InfoPage, EscapesNames) {
  const std::string name = "<script>alert('\u00fc') & \"x\".tif";
  const auto document = page(build(name, {}));
  EXPECT_EQ(row(document, "Sources of elevations", "1")["name"], name);
  EXPECT_EQ(html_.find("<script"), std::string::npos);
  const auto bytes = page(build("bad\xff\nname.tif", {}));
  EXPECT_EQ(row(bytes, "Sources of elevations", "1")["name"], "bad\ufffd\\nname.tif");
}

TEST_F(InfoPage, TellsOfNodata) {
  Dem dem;
  dem.no_data = -9999;
  dem.height_m = [](int, int row) {
    return row < 30 ? -9999.0 : 10.0 * row;
  };  // north of 30 degrees: a quarter
  const auto document = page(build("half.tif", dem));
  EXPECT_NE(html_.find("no data: 25"), std::string::npos);
  EXPECT_NE(html_.find("Grey stripes"), std::string::npos);
  EXPECT_NEAR(std::stod(row(document, "Sources of elevations", "1")["area, %"]), 75, 1);
}

TEST_F(InfoPage, OfFlatGroundAndOfASmallBody) {
  Dem flat;
  flat.height_m = [](int, int) { return 0.0; };
  page(build("flat.tif", flat));
  Dem small;
  small.radius_m = 11266;
  small.height_m = [](int, int row) { return 900 * std::cos(0.07 * row); };
  const auto document =
      page(build("small.tif", small, {"--radius", "11266", "--body", "Phobos", "--base-spacing", "300"}));
  EXPECT_EQ(std::string(document.select_node("//h1").node().text().get()), "Phobos, planet file own.vpe");
}

TEST_F(InfoPage, BadPlacesAreFoundBeforeTheWork) {
  write_text(dir_ / "mine.html", "<!DOCTYPE html>\n<p>mine</p>");
  expect_failure({"info", planet().string(), "--html", "mine.html"}, 1, {"mine.html", "page of 'vpe info'"});
  EXPECT_EQ(read_text(dir_ / "mine.html"), "<!DOCTYPE html>\n<p>mine</p>");
  expect_failure({"info", planet().string(), "--html", "none/page.html"}, 1, {"none"});
  expect_failure({"info", planet().string(), "--html", planet().string()}, 2, {"--html"});
  expect_failure({"info", "none.vpe", "--html", "page.html"}, 1, {"none.vpe"});
  EXPECT_FALSE(exists("page.html"));
}

TEST_F(InfoPage, OfAPartIsRefused) {
  write_dem(dir_ / "hills.tif");
  ASSERT_EQ(vpe({"build", "hills.tif", "-o", "part.vpe", "--base-spacing", "100000", "--part", "1/2", "-q"})
                .exit_code,
            0);
  EXPECT_EQ(vpe({"info", "part.1-of-2.vpe"}).exit_code, 0);
  expect_failure({"info", "part.1-of-2.vpe", "--html", "page.html"}, 1, {"part.1-of-2.vpe", "vpe merge"});
}

}  // namespace
}  // namespace app_test
