// Tables, plots and pages as text.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "vpe/report/page.h"
#include "vpe/report/plots/axis.h"
#include "vpe/report/plots/ground_plot.h"
#include "vpe/report/plots/histogram.h"
#include "vpe/report/plots/svg.h"

namespace vpe::report {
namespace {

Table small_table() {
  Table table{"speeds", "Speeds of <all>", {{"method", "how"}, {"time_s", "median"}}, {}};
  table.add({"rays, \"exact\"", 0.1});
  table.add({"triangles", std::nan("")});
  table.add({std::monostate{}, 2.0});
  return table;
}

TEST(Table, IsCsv) {
  EXPECT_EQ(to_csv(small_table()), "method,time_s\n\"rays, \"\"exact\"\"\",0.1\ntriangles,\n,2\n");
}

TEST(Table, IsJson) {
  const nlohmann::json json = to_json(small_table());
  EXPECT_EQ(json["name"], "speeds");
  EXPECT_EQ(json["columns"][1]["name"], "time_s");
  EXPECT_EQ(json["rows"][0]["time_s"], 0.1);
  EXPECT_TRUE(json["rows"][1]["time_s"].is_null());
  EXPECT_TRUE(json["rows"][2]["method"].is_null());
}

TEST(Table, RefusesARowOfAnotherLength) {
  Table table = small_table();
  EXPECT_THROW(table.add({1.0}), std::invalid_argument);
}

TEST(Axis, LogarithmsEndAtDecades) {
  const Axis axis({0.02, 0, -1, 300, std::nan("")}, true);
  EXPECT_NEAR(axis.place(0.01), 0, 1e-12);
  EXPECT_NEAR(axis.place(1000), 1, 1e-12);
  EXPECT_NEAR(axis.place(1), 0.4, 1e-12);
  EXPECT_EQ(axis.place(-5), 0);
  EXPECT_TRUE(axis.below(0));
  const std::vector<Tick> ticks = axis.ticks();
  ASSERT_EQ(ticks.size(), 6U);
  EXPECT_EQ(ticks[0].text, "0.01");
  EXPECT_EQ(ticks[5].text, "1000");
}

TEST(Axis, ManyDecadesAreThinnedOut) {
  const Axis axis({1e-20, 1e20}, true);
  EXPECT_LE(axis.ticks().size(), 9U);
  EXPECT_EQ(axis.ticks()[0].text, "1e-20");
}

TEST(Axis, LinesEndAtRoundNumbers) {
  const Axis axis({0.07, 0.93}, false);
  EXPECT_NEAR(axis.place(0), 0, 1e-12);
  EXPECT_NEAR(axis.place(1), 1, 1e-12);
  EXPECT_EQ(axis.ticks()[1].text, "0.2");
  EXPECT_LT(Axis({5, 5}, false).place(5), 1);  // one value has a span too
  EXPECT_GT(Axis({5, 5}, false).place(5), 0);
  EXPECT_EQ(Axis({}, true).ticks().size(), 2U);
}

Plot small_plot() {
  Plot plot;
  plot.title = "Error & time";
  plot.x_label = "time, ms";
  plot.y_label = "shift, px";
  plot.series.push_back({"triangles", {{1, 10, "tolerance 8", 12.0, true}, {10, 1, "", {}, false}}, true});
  plot.series.push_back({"rays", {{100, 0, "", {}, false}, {5, std::nan(""), "", {}, false}}, true});
  return plot;
}

TEST(Plot, IsXmlWithAPointForEachThatIsFinite) {
  pugi::xml_document document;
  const std::string svg = to_svg(small_plot());
  ASSERT_TRUE(document.load_string(svg.c_str())) << svg;
  const pugi::xml_node root = document.child("svg");
  EXPECT_EQ(std::string(root.child("title").text().get()), "Error & time");
  int points = 0;
  for (const pugi::xpath_node& found : root.select_nodes("(circle|polygon)[title]")) {
    (void)found;
    ++points;
  }
  EXPECT_EQ(points, 3);
  EXPECT_EQ(
      root.select_nodes("(circle|polygon)[title='triangles, tolerance 8: 1, 10; at most 12 stated']").size(),
      1U);
  EXPECT_EQ(root.select_nodes("polygon[contains(title, 'no logarithm')]").size(), 1U);
  EXPECT_EQ(to_svg(small_plot()), svg);
}

TEST(Plot, AFileHasABackground) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(to_svg_file(small_plot()).c_str()));
  EXPECT_EQ(std::string(document.child("svg").child("rect").attribute("fill").value()), "#fff");
}

// One decade in x is a third of the axis here: 1, 10, 100 stand at the same distances.
TEST(Plot, PointsStandAtTheirLogarithms) {
  Plot plot;
  plot.series.push_back(
      {"a", {{1, 1, "", {}, false}, {10, 10, "", {}, false}, {100, 100, "", {}, false}}, true});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(to_svg(plot).c_str()));
  std::vector<double> x;
  std::vector<double> y;
  for (const pugi::xpath_node& found : document.child("svg").select_nodes("circle[title]")) {
    x.push_back(found.node().attribute("cx").as_double());
    y.push_back(found.node().attribute("cy").as_double());
  }
  ASSERT_EQ(x.size(), 3U);
  EXPECT_NEAR(x[1] - x[0], x[2] - x[1], 0.03);
  EXPECT_GT(x[1], x[0]);
  EXPECT_LT(y[1], y[0]);  // up is larger
}

TEST(Page, IsOneFileAndEscapesText) {
  Page page{"A <report>", {"1 < 2 & 3"}, {{"First", {"text"}, {small_plot()}, {small_table()}}}};
  const std::string html = to_html(page);
  EXPECT_NE(html.find("<h1>A &lt;report&gt;</h1>"), std::string::npos);
  EXPECT_NE(html.find("1 &lt; 2 &amp; 3"), std::string::npos);
  EXPECT_NE(html.find("rays, &quot;exact&quot;"), std::string::npos);
  EXPECT_NE(html.find("<svg"), std::string::npos);
  for (const char* outside : {"<script", "src=", "href=", "@import", "url("}) {
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  }
}

Histogram small_histogram() {
  return {"Slopes & more",
          "degrees",
          "%",
          "half < 2",
          {{0, 1, 30, ""}, {1, 2, 70, "many"}, {2, 3, std::nan(""), ""}},
          {{0.5, "50 %"}, {0.6, "60 %"}, {0.7, "70 %"}}};
}

TEST(Histogram, BarsStandOnTheAxis) {
  pugi::xml_document document;
  const std::string svg = to_svg(small_histogram());
  ASSERT_TRUE(document.load_string(svg.c_str())) << svg;
  const pugi::xml_node root = document.child("svg");
  EXPECT_EQ(std::string(root.child("title").text().get()), "Slopes & more");
  EXPECT_EQ(std::string(root.child("desc").text().get()), "half < 2");
  const auto bars = root.select_nodes("rect");
  ASSERT_EQ(bars.size(), 2U);
  const auto number = [&](std::size_t bar, const char* name) {
    return bars[bar].node().attribute(name).as_double();
  };
  EXPECT_NEAR(number(0, "y") + number(0, "height"), number(1, "y") + number(1, "height"), 0.02);
  EXPECT_NEAR(number(0, "height") / number(1, "height"), 3.0 / 7, 0.001);
  EXPECT_EQ(std::string(bars[1].node().child("title").text().get()), "many");
  EXPECT_EQ(root.select_nodes("line[@stroke-dasharray]").size(), 3U);
  EXPECT_EQ(root.select_nodes("text[.='50 %' or .='60 %']").size(), 2U);  // the third one has no room
  EXPECT_EQ(to_svg(small_histogram()), svg);
}

TEST(Histogram, NothingIsAnEmptyPlot) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(to_svg(Histogram{}).c_str()));
}

TEST(Page, IsWellFormedAndHasHeadings) {
  Page page{"A", {"text"}, {{"First", {}, {small_plot()}, {small_table()}}}};
  page.sections[0].figures.push_back({"<b>bold</b>", "a < b"});
  page.sections[0].histograms.push_back(small_histogram());
  page.sections[0].terms.push_back({"x & y", "1 < 2"});
  page.generator = "a \"b\"";
  page.script = "document.title;";
  pugi::xml_document document;
  const std::string html = to_html(page);
  ASSERT_TRUE(document.load_string(html.c_str(), pugi::parse_full)) << html;
  const pugi::xml_node body = document.child("html").child("body");
  EXPECT_EQ(body.select_nodes("//th[not(@scope)]").size(), 0U);
  EXPECT_EQ(body.select_nodes("//tbody/tr/th[@scope='row']").size(), 3U);
  EXPECT_EQ(std::string(body.select_node("//dl/dt").node().text().get()), "x & y");
  EXPECT_EQ(std::string(body.select_node("//figure/b").node().text().get()), "bold");
  EXPECT_EQ(std::string(body.select_node("//figcaption").node().text().get()), "a < b");
  EXPECT_EQ(std::string(document.select_node("//meta[@name='generator']/@content").attribute().value()),
            "a \"b\"");
  EXPECT_EQ(std::string(body.child("script").text().get()), "document.title;");
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
}

TEST(Page, ImagesAreInIt) {
  Page page;
  Section section;
  // RFC 4648, section 10: "foobar", "fooba", "foob" and nothing.
  for (const char* text : {"foobar", "fooba", "foob", ""}) {
    const std::string bytes = text;
    section.images.push_back({"a <" + bytes + ">", {bytes.begin(), bytes.end()}});
  }
  page.sections.push_back(section);
  const std::string html = to_html(page);
  for (const char* base64 : {"Zm9vYmFy", "Zm9vYmE=", "Zm9vYg==", ""})
    EXPECT_NE(html.find("src=\"data:image/png;base64," + std::string(base64) + "\"/>"), std::string::npos)
        << base64;
  EXPECT_NE(html.find("<figcaption>a &lt;foobar&gt;</figcaption>"), std::string::npos);
}

GroundPlot small_ground() {
  GroundPlot plot;
  plot.title = "Profile & more";
  plot.x_label = "distance, m";
  plot.y_label = "elevation, m";
  plot.note = "Datum: sphere";
  plot.limits = {"steeper than 5 degrees", "steeper than 15 degrees"};
  plot.marks = {0, 300};
  plot.columns = {{0, 100, 10, 20, 9, 21, 0, false},
                  {100, 200, 20, 60, 20, 66, 2, false},
                  {200, 250, 0, 0, 0, 0, 0, true},
                  {250, 300, 40, 42, 39, 43, 1, false}};
  return plot;
}

TEST(GroundPlot, IsSvgWithTheGroundByItsSteepness) {
  const std::string svg = to_svg(small_ground());
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg.c_str()));
  EXPECT_EQ(std::string(document.select_node("//title").node().text().get()), "Profile & more");
  // Two stretches with data, each filled twice; a line for each run of one steepness.
  EXPECT_EQ(document.select_nodes("//path[@fill='none']").size(), 3U);
  EXPECT_EQ(document.select_nodes("//path[@fill-opacity]").size(), 4U);
  EXPECT_EQ(document.select_nodes("//line[@stroke-dasharray='3 3']").size(), 2U);
  EXPECT_NE(svg.find("steeper than 15 degrees"), std::string::npos);
  EXPECT_NE(svg.find("Datum: sphere"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(to_svg(small_ground()), svg);
  pugi::xml_document file;
  EXPECT_TRUE(file.load_string(svg_file(svg).c_str()));
}

TEST(GroundPlot, TheAxisSpansItsGround) {
  const GroundPlot plot = small_ground();
  const PlotRange range = range_of(plot);
  EXPECT_LE(range.low, 9);
  EXPECT_GE(range.high, 66);
  EXPECT_LT(range.high - range.low, 150);
  const PlotInside inside = inside_of(plot);
  EXPECT_GT(inside.width_px, 700);
  EXPECT_LT(inside.width_px, plot.width_px);
  EXPECT_GT(inside.height_px, 150);
}

TEST(GroundPlot, WithoutGroundItIsStillAPicture) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(to_svg(GroundPlot{}).c_str()));
  GroundPlot bad = small_ground();
  bad.columns[0].low = std::nan("");
  bad.columns[3].end = HUGE_VAL;
  const std::string svg = to_svg(bad);
  EXPECT_TRUE(document.load_string(svg.c_str()));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(Svg, ElementsAreEscapedAndShort) {
  EXPECT_EQ(svg_number(1.005), "1.00");
  EXPECT_EQ(svg_attribute("x", -2.5), " x=\"-2.50\"");
  EXPECT_EQ(svg_text(1, 2, "end", "a < b"),
            "<text x=\"1.00\" y=\"2.00\" text-anchor=\"end\">a &lt; b</text>\n");
  EXPECT_EQ(svg_line(0, 0, 1, 1, " stroke=\"red\""),
            "<line x1=\"0.00\" y1=\"0.00\" x2=\"1.00\" y2=\"1.00\" stroke=\"red\"/>\n");
  const std::string begun = svg_begin(10, 20, "A & B", "about");
  EXPECT_NE(begun.find("<title>A &amp; B</title>"), std::string::npos);
  EXPECT_NE(begun.find("<desc>about</desc>"), std::string::npos);
  EXPECT_NE(begun.find("viewBox=\"0 0 10 20\""), std::string::npos);
}

}  // namespace
}  // namespace vpe::report
