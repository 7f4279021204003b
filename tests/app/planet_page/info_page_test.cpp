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
  EXPECT_TRUE(document.select_nodes("//link | //iframe | //object | //script[@src]").empty());
  EXPECT_EQ(document.select_nodes("//script").size(), 1U);
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
  EXPECT_EQ(html_.find("<script>alert"), std::string::npos);
  EXPECT_EQ(document.select_nodes("//script").size(), 1U);
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

TEST_F(InfoPage, OfManySources) {
  Dem base;
  base.height_m = [](int, int) { return -100.0; };
  write_dem(dir_ / "base.tif", base);
  Words words{"build", "base.tif"};
  // Insets along a parallel and one at each pole, 8 degrees wide.
  constexpr int kInsets = 7;
  for (int n = 0; n < kInsets; ++n) {
    Dem inset;
    inset.width = n < 2 ? 360 : 16;
    inset.height = 16;
    inset.cell_deg = n < 2 ? 1 : 0.5;
    inset.west_deg = n < 2 ? -180 : -160 + 50.0 * n;
    inset.north_deg = n == 0 ? 90 : n == 1 ? -74 : 4;
    inset.height_m = [n](int, int) { return 500.0 * (n + 1); };
    const std::string name = "inset" + std::to_string(n) + ".tif";
    write_dem(dir_ / name, inset);
    words.push_back(name);
  }
  words.insert(words.end(),
               {"-o", "many.vpe", "--base-spacing", "100000", "--feather", "1000", "--datum", "sphere", "-q"});
  const Result built = vpe(words);
  ASSERT_EQ(built.exit_code, 0) << built.err;
  const auto document = page("many.vpe", {"--json"});
  const nlohmann::json json = parse_json(out_);
  ASSERT_EQ(json.at("sources").size(), kInsets + 1U);
  double sum = 0;
  for (std::size_t n = 0; n <= kInsets; ++n) {
    auto source = row(document, "Sources of elevations", std::to_string(n + 1));
    EXPECT_EQ(source["name"], json.at("sources")[n].at("name"));
    const double share = std::stod(source["area, %"]);
    EXPECT_GT(share, 0) << n;
    sum += share;
    // A cap of 16 degrees has 1.94 % of the sphere, a square of 8 degrees at the equator 0.155 %.
    const std::string name = source["name"];
    if (name.find("inset0") != std::string::npos || name.find("inset1") != std::string::npos) {
      EXPECT_NEAR(share, 1.94, 0.25) << name;
    } else if (name.find("inset") != std::string::npos) {
      EXPECT_NEAR(share, 0.155, 0.04) << name;
    }
  }
  EXPECT_NEAR(sum, 100, 0.1);
  // Each inset has a number on the maps of the whole planet and of sources, a cap one on its pole's map, too.
  EXPECT_EQ(document.select_nodes("//div[@data-map='plain']//*[@class='n']").size(), 2U * kInsets);
  for (const char* pole : {"north", "south"}) {
    const std::string query = std::string("//div[@data-map='") + pole + "']//*[@class='n']";
    EXPECT_EQ(document.select_nodes(query.c_str()).size(), 1U) << pole;
  }
}

TEST_F(InfoPage, OfOneLevel) {
  const auto document = page(build("one.tif", {}, {"--base-spacing", "100000"}), {"--json"});
  ASSERT_EQ(parse_json(out_).at("by_level").size(), 1U);
  EXPECT_EQ(row(document, "Levels", "0")["tiles"], "6");
  EXPECT_EQ(document.select_nodes("//table[starts-with(caption, 'Levels')]/tbody/tr").size(), 1U);
  EXPECT_NE(html_.find("Slopes"), std::string::npos);
}

// The radii of an ellipsoid like the Earth's: heights are those of the surface above the sphere, so the poles are low.
TEST_F(InfoPage, OfAnEllipsoid) {
  constexpr double kEquatorial_m = 6378137;
  constexpr double kPolar_m = 6356752;
  Dem dem;
  dem.radius_m = kEquatorial_m;
  dem.height_m = [](int, int) { return 0.0; };
  const auto document =
      page(build("flat.tif", dem,
                 {"--radius", "6378137", "--body", "Earth", "--datum", "ellipsoid:6378137,6356752", "--shape",
                  "radius", "--base-spacing", "40000"}),
           {"--json"});
  EXPECT_EQ(std::string(document.select_node("//h1").node().text().get()), "Earth, planet file own.vpe");
  const pugi::xml_node grid = document.select_node("//div[@id='elevations']").node();
  // The lowest surface is that of flat triangles between posts 40 km apart.
  const double low = grid.attribute("data-low").as_double();
  EXPECT_NEAR(low, kPolar_m - kEquatorial_m, 150);
  EXPECT_NEAR(low + 65534 * grid.attribute("data-step").as_double(), 0, 150);
  // The normal of an ellipse leans from the radius by up to 0.192 degrees, at 45 degrees of latitude.
  double steepest = 0;
  for (const pugi::xpath_node& found :
       document.select_nodes("//table[contains(caption, 'slopes') or contains(caption, 'Slopes')]/tbody/tr")) {
    for (const pugi::xml_node cell : found.node().children("td"))
      if (std::string(cell.text().get()).find('.') != std::string::npos) steepest = cell.text().as_double();
  }
  EXPECT_GT(steepest, 0.1);
  EXPECT_LT(steepest, 0.3);
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
