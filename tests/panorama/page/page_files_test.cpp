#include "panorama/page/page_files.h"

#include "tests/panorama/page/page_fixture.h"

namespace {

using panorama::PageFacts;

PageFacts facts() {
  PageFacts made;
  made.title = "A & <b>\"</script>";
  made.description.map = panorama::cylinder_map(3000, 900, 3000, 0, 450);
  made.pyramid = panorama::pyramid_of(made.description.map);
  made.marks.names.push_back({"</script><script>alert(1)</script>", {10, 2}, 1500.0});
  made.marks.hotspots.push_back({{"Rim\xE2\x80\xA8", {20, -2}, {}}, "../rim/index.html"});
  return made;
}

TEST(PageFiles, TextsAreEscaped) {
  EXPECT_EQ(panorama::html_text("a<b>&\"'"), "a&lt;b&gt;&amp;&quot;&#39;");
  const std::string json = R"({"a":"</script>\u003c", "b":")"
                           "\xE2\x80\xA9"
                           R"(ü"})";
  const std::string escaped = panorama::script_json(json);
  EXPECT_EQ(escaped.find('<'), std::string::npos);
  EXPECT_EQ(escaped.find("\xE2\x80\xA9"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(escaped), nlohmann::json::parse(json));
}

TEST(PageFiles, TheScriptHoldsTheDescription) {
  const std::string script = panorama::data_script(facts());
  EXPECT_TRUE(script.starts_with(std::string(panorama::kPageMark) + "\n"));
  EXPECT_EQ(script.find("</"), std::string::npos);
  const auto json = page_test::json_in(script, "vpeData = ", ";");
  EXPECT_EQ(json.at("title"), facts().title);
  EXPECT_EQ(json.at("map").at("focal_px"), facts().description.map.focal_px);
  EXPECT_EQ(json.at("pyramid").at("levels"), 4);
  EXPECT_EQ(json.at("eyes"), nlohmann::json::array({"left"}));
  EXPECT_TRUE(json.at("layers").is_null());
  EXPECT_EQ(json.at("names").at(0).at("range_m"), 1500.0);
  EXPECT_EQ(json.at("hotspots").at(0).at("page"), "../rim/index.html");
}

TEST(PageFiles, BytesThatAreNoUtf8AreReplaced) {
  PageFacts bad = facts();
  bad.title = "a\xFF";
  EXPECT_NE(panorama::index_html(bad).find("<title>a\xEF\xBF\xBD</title>"), std::string::npos);
  EXPECT_NO_THROW(page_test::json_in(panorama::data_script(bad), "vpeData = ", ";"));
}

TEST(PageFiles, ThePageNamesItsScriptsInOrder) {
  PageFacts pair = facts();
  pair.has_right_eye = true;
  const std::string html = panorama::index_html(pair);
  EXPECT_NE(html.find("<title>A &amp; &lt;b&gt;&quot;&lt;/script&gt;</title>"), std::string::npos);
  EXPECT_EQ(html.find("{{"), std::string::npos);
  std::size_t last = 0;
  for (const panorama::ViewerFile& file : panorama::viewer_files().subspan(1)) {
    const std::size_t at = html.find("src=\"viewer/" + std::string(file.name) + "\"");
    ASSERT_NE(at, std::string::npos) << file.name;
    EXPECT_GT(at, last);
    last = at;
  }
  const std::size_t start = html.find("viewer/main.js");
  for (const char* name : {"\"data.js\"", "tiles/left/3/0_0.js", "tiles/right/3/0_0.js"})
    EXPECT_LT(html.find(name), start);
}

TEST(PageFiles, TheViewerIsSmallAndNeedsNoNetwork) {
  std::size_t bytes = 0;
  for (const panorama::ViewerFile& file : panorama::viewer_files()) {
    bytes += file.text.size();
    EXPECT_FALSE(file.text.empty()) << file.name;
    for (const char* word : {"http:", "https:", "fetch(", "XMLHttpRequest"})
      EXPECT_EQ(file.text.find(word), std::string_view::npos) << file.name << " " << word;
  }
  EXPECT_LE(bytes, 150'000U);
}

}  // namespace
