// vpe report scaling, features and all at their smallest: counts are checked, and that all files agree. Times
// are not judged.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <set>
#include <sstream>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

using nlohmann::json;

class Report : public AppTest {
 protected:
  std::set<std::string> files(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(dir_ / folder))
      names.insert(entry.path().filename().string());
    return names;
  }

  // A CSV file has the table's columns and as many rows.
  void expect_csv(const std::string& file, const json& table) const {
    std::istringstream csv(read_text(dir_ / file));
    std::string line;
    ASSERT_TRUE(std::getline(csv, line));
    std::string names;
    for (const json& column : table["columns"])
      names += (names.empty() ? "" : ",") + column["name"].get<std::string>();
    EXPECT_EQ(line, names);
    std::size_t rows = 0;
    while (std::getline(csv, line)) ++rows;
    EXPECT_EQ(rows, table["rows"].size()) << file;
  }

  void expect_page(const std::string& file, std::size_t least_plots) const {
    const std::string html = read_text(dir_ / file);
    std::size_t plots = 0;
    for (std::size_t at = html.find("<svg"); at != std::string::npos; at = html.find("<svg", at + 1)) ++plots;
    EXPECT_GE(plots, least_plots);
    expect_one_file(html);
  }

  // Nothing comes from another file: pictures are in the page.
  static void expect_one_file(std::string html) {
    const std::string inside = " src=\"data:image/png;base64,";
    for (std::size_t at = html.find(inside); at != std::string::npos; at = html.find(inside, at))
      html.erase(at, inside.size());
    for (const char* outside : {"<script", "src=", "href=", "@import", "url("})
      EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  }

  static json row(const json& table, const json& wanted) {
    for (const json& one : table["rows"]) {
      const bool same = std::all_of(wanted.items().begin(), wanted.items().end(),
                                    [&](const auto& item) { return one[item.key()] == item.value(); });
      if (same) return one;
    }
    ADD_FAILURE() << "no row of " << wanted;
    return json::object();
  }
};

TEST_F(Report, ScalingCountsWhatItVaries) {
  const Result result = vpe({"report", "scaling", "--short", "-o", "out", "--json", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = parse_json(result.out);
  EXPECT_EQ(files("out"),
            (std::set<std::string>{"scaling.html", "scaling.json", "scaling-laws.csv", "scaling-samples.csv",
                                   "scaling-planets.csv", "scaling-flights.csv"}));
  EXPECT_EQ(parse_json(read_text(dir_ / "out/scaling.json")), report);
  expect_csv("out/scaling-laws.csv", report["laws"]);
  expect_csv("out/scaling-samples.csv", report["samples"]);
  expect_csv("out/scaling-planets.csv", report["planets"]);
  expect_csv("out/scaling-flights.csv", report["flights"]);
  expect_page("out/scaling.html", 8);
  EXPECT_EQ(report["run"]["command"], "vpe report scaling --short -o out --json -q");

  const json cells = row(report["laws"], {{"axis", "builder"}, {"y", "cells"}});
  EXPECT_NEAR(cells["exponent"].get<double>(), 2, 1e-9);
  const json rays = row(report["laws"], {{"axis", "image"}, {"what", "rays, exact"}, {"y", "rays"}});
  EXPECT_NEAR(rays["exponent"].get<double>(), 1, 1e-9);
  EXPECT_EQ(rays["points"], 3);
  const json triangles = row(report["laws"], {{"axis", "image"}, {"what", "polygons"}, {"y", "triangles"}});
  EXPECT_GT(triangles["exponent"].get<double>(), 0.1);
  EXPECT_LT(triangles["exponent"].get<double>(), 1.5);

  // 257 and 513 posts a side, of both series.
  ASSERT_EQ(report["planets"]["rows"].size(), 4U);
  for (const json& planet : report["planets"]["rows"]) {
    EXPECT_EQ(std::fmod(planet["finest_posts"].get<double>(), 129 * 129), 0);
    const double side = planet["side_posts"].get<double>() - 1;
    EXPECT_GT(planet["finest_posts"].get<double>(), side * side);
    EXPECT_GT(planet["tiles"].get<double>(), planet["finest_posts"].get<double>() / (129 * 129));
    EXPECT_GT(planet["bytes"].get<double>(), planet["finest_posts"].get<double>());
  }
  const json coarse = row(report["planets"], {{"side_posts", 257}, {"finest_level", 8}});
  const json fine = row(report["planets"], {{"side_posts", 257}, {"finest_level", 12}});
  EXPECT_NEAR(coarse["spacing_m"].get<double>() / fine["spacing_m"].get<double>(), 16, 1e-6);

  for (const json& sample : report["samples"]["rows"]) {
    EXPECT_GE(sample["median"], sample["least"]);
    EXPECT_LE(sample["median"], sample["most"]);
    if (sample["y_name"] == "frame_s" && sample["axis"] != "speed") {
      EXPECT_EQ(sample["rounds"], 2);
      EXPECT_GT(sample["least"], 0);
    }
  }
  for (const json& flight : report["flights"]["rows"]) {
    EXPECT_GT(flight["frames"], 0);
    EXPECT_GE(flight["incomplete_share"], 0);
    EXPECT_LE(flight["incomplete_share"], 1);
  }
}

TEST_F(Report, ScalingRefusesWhatItCannotDo) {
  expect_failure({"report", "scaling"}, 2, {"--output"});
  expect_failure({"report", "scaling", "-o", "out", "--sizes", "257,300"}, 2, {"--sizes", "257, 513"});
  expect_failure({"report", "scaling", "-o", "out", "--depths", "513,257"}, 2, {"--depths", "rising"});
  expect_failure({"report", "scaling", "-o", "out", "--full", "--short"}, 2, {"--full", "--short"});
  write_text(dir_ / "file", "x");
  expect_failure({"report", "scaling", "-o", "file", "--short"}, 1, {"file"});
  EXPECT_EQ(read_text(dir_ / "file"), "x");
  EXPECT_FALSE(exists("out"));
}

// A stopped run leaves nothing and changes no old file.
TEST_F(Report, ScalingStoppedLeavesNothing) {
  std::filesystem::create_directory(dir_ / "out");
  write_text(dir_ / "out/scaling.json", "old");
  Command command = command_for({"report", "scaling", "-o", "out", "-q"});
  command.signal = SIGINT;
  command.when = [&] { return files("out").size() > 1; };
  const Result result = run(command);
  EXPECT_TRUE(result.signalled);
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_EQ(files("out"), std::set<std::string>{"scaling.json"});
  EXPECT_EQ(read_text(dir_ / "out/scaling.json"), "old");
}

TEST_F(Report, FeaturesHoldWhatTheyUse) {
  const Result result = vpe({"report", "features", planet().string(), "--short", "-o", "out", "--json", "-q",
                             "--against", command_for({}).program.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = parse_json(result.out);
  EXPECT_EQ(files("out"), (std::set<std::string>{"features.html", "features.json", "features.csv"}));
  EXPECT_EQ(parse_json(read_text(dir_ / "out/features.json")), report);
  expect_csv("out/features.csv", report["features"]);
  expect_page("out/features.html", 0);

  const json& table = report["features"];
  for (const char* backend : {"polygon", "ray"}) {
    const auto of = [&](const char* feature) {
      return row(table, {{"feature", feature}, {"backend", backend}});
    };
    for (const char* feature : {"pseudo-colour", "light of facets", "light and normals of posts", "shadows",
                                "planes", "statistics", "stereo", "certificate", "window"}) {
      const json one = of(feature);
      EXPECT_GT(one[feature == std::string("window") ? "peak_mb_off" : "peak_mb_on"], 10) << feature;
    }
    // Counted, so the same on every machine.
    EXPECT_GT(of("light and normals of posts")["resident_mb_on"],
              of("light and normals of posts")["resident_mb_off"]);
    EXPECT_GT(of("shadows")["resident_mb_on"], of("shadows")["resident_mb_off"]);
    EXPECT_EQ(of("statistics")["resident_mb_on"], of("statistics")["resident_mb_off"]);
    // The other program is this one.
    EXPECT_EQ(of("window")["resident_mb_never"], of("window")["resident_mb_off"]);
    EXPECT_TRUE(of("shadows")["peak_mb_never"].is_null());
  }
  // This planet has none.
  for (const json& one : table["rows"])
    EXPECT_EQ(one["feature"].get<std::string>().find("imagery"), std::string::npos);
}

TEST_F(Report, FeaturesRefuseWhatTheyCannotDo) {
  const std::string small = planet().string();
  expect_failure({"report", "features", small}, 2, {"-o"});
  expect_failure({"report", "features", small, "-o", "out", "--short", "--pose", "1,2,3"}, 2,
                 {"--pose", "LON,LAT,HEIGHT"});
  expect_failure({"report", "features", small, "-o", "out", "--short", "-q", "--against", "/bin/true"}, 1,
                 {"/bin/true", "same version"});
  expect_failure({"report", "features", small, "-o", "out", "--short", "-q", "--against", "/bin/false"}, 1,
                 {"/bin/false", "bare"});
  EXPECT_EQ(leftovers(), Words{});
}

TEST_F(Report, PapersPutBothSideBySide) {
  const Result result = vpe({"report", "papers", planet().string(), "--short", "--height", "300000", "--size",
                             "200x160", "-o", "out", "--json", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = parse_json(result.out);
  EXPECT_EQ(parse_json(read_text(dir_ / "out/papers.json")), report);
  expect_page("out/papers.html", 0);
  EXPECT_GT(report["eye_base_m"].get<double>(), 0);
  for (const char* look : {"lit", "textured"}) {
    const json& table = report["stereo-" + std::string(look)];
    expect_csv("out/stereo-" + std::string(look) + ".csv", table);
    const json one = row(table, {{"processors", 1}});
    for (const char* figure :
         {"left_s", "right_s", "right_full_s", "right_to_left", "pair_share", "casting_share"})
      EXPECT_GT(one[figure].get<double>(), 0) << look << " " << figure;
    // Published rows without such a machine here have no figures of it.
    const json sixteen = row(table, {{"processors", 16}});
    EXPECT_GT(sixteen["published_left_s"].get<double>(), sixteen["published_right_s"].get<double>());
    EXPECT_TRUE(sixteen["left_s"].is_null());
    for (const char* part :
         {"a-left", "b-right", "c-cast", "d-right-full", "e-differences", "f-differences-unfiltered"}) {
      const vpe::core::RgbImage image =
          vpe::core::read_image(dir_ / "out" / ("stereo-" + std::string(look) + "-" + part + ".png"));
      EXPECT_EQ(image.width, 200) << part;
      EXPECT_EQ(image.height, 160) << part;
    }
  }
  const json& figure = report["stereo-figure-8"];
  expect_csv("out/stereo-figure-8.csv", figure);
  EXPECT_EQ(figure["rows"].size(), 6);
  const json difference = row(figure, {{"quantity", "mean colour difference from the right image in full"}});
  EXPECT_NEAR(difference["published"].get<double>(), 0.031, 1e-9);
  EXPECT_LT(difference["lit"].get<double>(), 0.031);
  EXPECT_GT(difference["lit"].get<double>(), 0);

  const json& environment = report["environment-figures"];
  expect_csv("out/environment-figures.csv", environment);
  EXPECT_EQ(environment["rows"].size(), 4U);
  for (const json& quantity : environment["rows"]) EXPECT_GT(quantity["here_to_published"].get<double>(), 0);
  EXPECT_EQ(vpe::core::read_image(dir_ / "out/environment-panorama.png").width, 1504);
  EXPECT_EQ(vpe::core::read_image(dir_ / "out/environment-overlook.png").width, 1280);
  // The planet has no imagery.
  const json& texture = report["environment-texture"];
  expect_csv("out/environment-texture.csv", texture);
  EXPECT_EQ(texture["rows"].size(), 6U);
  for (const json& terrain : texture["rows"]) EXPECT_TRUE(terrain["similarity"].is_null());
  EXPECT_NE(read_text(dir_ / "out/papers.html").find("Not measured: the planet has no imagery."),
            std::string::npos);
  const json& flythrough = report["flythrough-table-1"];
  expect_csv("out/flythrough-table-1.csv", flythrough);
  EXPECT_EQ(flythrough["rows"].size(), 3U);
  const json known = row(flythrough, {{"pitch_deg", 14.6}});
  EXPECT_EQ(known["published_32p_per_s"], 11.0);
  EXPECT_EQ(known["published_2p_per_s"], 0.36);
  EXPECT_GT(known["threads_1_per_s"].get<double>(), 0);
  EXPECT_TRUE(row(flythrough, {{"pitch_deg", 30}})["published_8p_per_s"].is_null());
  const json& growth = report["flythrough-growth"];
  expect_csv("out/flythrough-growth.csv", growth);
  EXPECT_NEAR(row(growth, {{"workers", 31}})["published_share"].get<double>(), 0.986, 1e-3);
  EXPECT_EQ(row(growth, {{"workers", 1}})["ratio_of_ratios"], 1);
  const json& ratios = report["flythrough-ratio"];
  expect_csv("out/flythrough-ratio.csv", ratios);
  EXPECT_EQ(row(ratios, {{"ratio_px", 1}})["time_to_ratio_1"], 1);
  EXPECT_EQ(report["flythrough-options"]["rows"].size(), 7U);
  for (const json& part : report["flythrough-database"]["rows"])
    EXPECT_GT(part["here_to_published"].get<double>(), 0);
  for (const char* part : {"discrete", "blended", "vertical", "exact", "difference"})
    EXPECT_EQ(vpe::core::read_image(dir_ / "out" / ("flythrough-" + std::string(part) + ".png")).width, 320)
        << part;

  const json& terrain = report["terrain-table-1"];
  expect_csv("out/terrain-table-1.csv", terrain);
  ASSERT_GE(terrain["rows"].size(), 5U);
  const json one_thread = row(terrain, {{"processors", 1}});
  EXPECT_EQ(one_thread["published_accurate_s"], 0.92);
  EXPECT_EQ(row(terrain, {{"processors", 12}})["published_approximate_s"], 0.08);
  for (const char* name : {"accurate_s", "approximate_s", "approximate_to_accurate", "ratio_of_ratios"})
    EXPECT_GT(one_thread[name].get<double>(), 0) << name;
  const json& ways = report["terrain-section-7"];
  expect_csv("out/terrain-section-7.csv", ways);
  EXPECT_EQ(ways["rows"].size(), 8U);
  EXPECT_LE(row(ways, {{"quantity", "boundary array : volume, bytes"}})["here"].get<double>(), 1.0 / 32);
  EXPECT_LT(row(ways, {{"quantity", "share of pixels with other hits than rays from the camera"}})["here"]
                .get<double>(),
            0.02);
  for (const char* name : {"terrain-figure-6", "terrain-figure-7", "terrain-difference", "terrain-roll"}) {
    const vpe::core::RgbImage image = vpe::core::read_image(dir_ / "out" / (std::string(name) + ".png"));
    EXPECT_EQ(image.width, 500);
    EXPECT_EQ(image.height, 400);
  }

  const json& triangles = report["terrain-triangles"];
  expect_csv("out/terrain-triangles.csv", triangles);
  ASSERT_EQ(triangles["rows"].size(), 4U);
  EXPECT_EQ(triangles["rows"][0]["published_s"], 0.80);
  EXPECT_EQ(triangles["rows"][1]["published_s"], 0.92);
  EXPECT_GT(triangles["rows"][0]["triangles"].get<double>(), 100000);
  for (const json& way : triangles["rows"]) EXPECT_GT(way["to_accurate"].get<double>(), 0);
  EXPECT_EQ(vpe::core::read_image(dir_ / "out/terrain-triangles.png").width, 500);
  EXPECT_EQ(vpe::core::read_image(dir_ / "out/terrain-volume.png").width, 500);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "out/triangles-terrain.vpe"));

  const std::vector<std::pair<int, int>> published{{1024, 59}, {512, 58}, {128, 58}, {64, 57}};
  for (const char* name : {"relief-bilinear", "relief-bilinear-half-pixel"}) {
    const json& table = report[name];
    expect_csv("out/" + std::string(name) + ".csv", table);
    ASSERT_EQ(table["rows"].size(), published.size()) << name;
    for (std::size_t n = 0; n < published.size(); ++n) {
      const json& one = table["rows"][n];
      EXPECT_EQ(one["map_posts"], published[n].first);
      EXPECT_EQ(one["published_s"], published[n].second);
      EXPECT_NEAR(one["published_ratio"].get<double>(), published[n].second / 57.0, 1e-12);
      for (const char* column : {"here_least_s", "here_s", "here_ratio", "ratio_of_ratios"})
        EXPECT_GT(one[column].get<double>(), 0) << name << " " << column;
      EXPECT_LE(one["here_ratio_least"].get<double>(), one["here_ratio"].get<double>());
      EXPECT_GE(one["here_ratio_most"].get<double>(), one["here_ratio"].get<double>());
    }
  }
  EXPECT_EQ(report["relief-bilinear"]["rows"][1]["published_picture"], "t512.tga");
  EXPECT_FALSE(report.contains("relief-bicubic"));
  for (const char* picture : {"figure-6", "figure-7", "figure-8", "t1024", "t512", "t128", "t64"}) {
    const vpe::core::RgbImage image =
        vpe::core::read_image(dir_ / "out" / ("relief-" + std::string(picture) + ".png"));
    EXPECT_EQ(image.width, 512) << picture;
    EXPECT_EQ(image.height, 512) << picture;
    // Ground and sky.
    const auto sky = std::ranges::count(image.pixels, vpe::base::Rgb{200, 215, 235});
    EXPECT_GT(sky, 20000) << picture;
    EXPECT_LT(sky, 150000) << picture;
  }
  expect_failure({"report", "papers", planet().string(), "-o", "out", "--size", "9"}, 2, {"9"});
  expect_failure({"report", "papers", planet().string(), "-o", "out", "--eye-base", "0"}, 2, {"--eye-base"});
}

class LongReport : public Report {};

TEST_F(LongReport, AllInOneFolder) {
  Command command = command_for({"report", "all", planet().string(), "-o", "all", "--short", "-q"});
  command.limit_s = 900;
  const Result result = run(command);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out + result.err, "");
  const std::set<std::string> there = files("all");
  const std::string page = read_text(dir_ / "all/report.html");
  for (const char* report : {"error-time", "scaling", "features", "papers"}) {
    for (const char* kind : {".html", ".json"})
      EXPECT_TRUE(there.contains(std::string(report) + kind)) << report;
  }
  for (const char* heading : {"Error against time: All views", "How costs grow: Exponents",
                              "Cost of features that a scene can do without: Costs"})
    EXPECT_NE(page.find(heading), std::string::npos) << heading;
  expect_one_file(page);
  // Peaks are those of the processes, not of the one that started them.
  const json features = parse_json(read_text(dir_ / "all/features.json"));
  for (const json& one : features["features"]["rows"]) {
    if (one["backend"] == "ray" && !one["peak_mb_on"].is_null()) {
      EXPECT_LT(one["peak_mb_on"].get<double>(), 250) << one;
    }
  }
  for (const std::string& name : there) EXPECT_EQ(name.find(".tmp"), std::string::npos) << name;
}

}  // namespace
}  // namespace app_test
