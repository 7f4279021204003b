// vpe query, and results of other commands as JSON.
#include <clocale>
#include <sstream>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

class Query : public AppTest {
 protected:
  json ask(const Words& more, const std::string& input = "") const {
    Words words{"query", planet().string(), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words, input);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return parse_json(result.out);
  }
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST_F(Query, NegativeCoordinatesNeedNoEscape) {
  const json answers = ask({"-74,-13.5", "-.5,-13", "-1e1,+5", "-180,-90"});
  ASSERT_EQ(answers.size(), 4U);
  EXPECT_EQ(answers[0]["lon_deg"], -74);
  EXPECT_EQ(answers[0]["lat_deg"], -13.5);
  EXPECT_EQ(answers[1]["lon_deg"], -0.5);
  EXPECT_EQ(answers[2]["lon_deg"], -10);
  EXPECT_EQ(answers[3]["lat_deg"], -90);
}

TEST_F(Query, AnswersFollowTheRaster) {
  // The hills at centres of cells. The reference surface lies below them by the sagitta: posts are 42 km apart,
  // diagonals 59 km.
  constexpr double kSagitta_m = 59e3 * 59e3 / (8 * 3396190.0);
  for (const auto& a : ask({"1,1", "31,1", "91,1", "-149,-1", "31,59"})) {
    const double lon = a["lon_deg"].get<double>();
    const double lat = a["lat_deg"].get<double>();
    const double column = std::floor((lon + 180) / 2);
    const double expected = 3000 * std::sin(3 * 2 * M_PI * column / 180) * std::cos(lat * M_PI / 180);
    EXPECT_LE(a["elevation_m"].get<double>(), expected + 10) << a.dump();
    EXPECT_GE(a["elevation_m"].get<double>(), expected - kSagitta_m - 10) << a.dump();
    EXPECT_EQ(a["source"].get<std::string>().substr(a["source"].get<std::string>().size() - 9), "hills.tif");
    EXPECT_EQ(a["illustration"], false);
    EXPECT_EQ(a["level"], 0);
    EXPECT_EQ(a["tile_error_m"], 0);
  }
}

TEST_F(Query, SaysWhatIsMeasuredAndWhatIsSynthetic) {
  for (const auto& a : ask({"1,1", "31,59"})) {
    EXPECT_EQ(a["kind"], "measured");
    EXPECT_EQ(a["measured_m"], a["elevation_m"]);
  }
  ASSERT_EQ(vpe({"build", "embedded", "--region", "-63.1,-12.7,-62.9,-12.5", "--spacing", "800",
                 "--base-spacing", "60000", "-o", "mars.vpe", "--quiet"})
                .exit_code,
            0);
  EXPECT_TRUE(
      says(vpe({"info", "mars.vpe"}).out,
           {"marked as synthetic", "MOLA, 8 posts a degree (carried) (7409", "embedded-detail (synthetic, "}));
  const Result result = vpe({"query", "mars.vpe", "--json", "-63,-12.6", "30,30"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("synthetic"), std::string::npos) << result.err;
  const json answers = parse_json(result.out);
  EXPECT_EQ(answers[0]["kind"], "synthetic");
  EXPECT_EQ(answers[0]["source"], "embedded-detail");
  EXPECT_EQ(answers[0]["illustration"], true);
  // The parts are different heights of the same ground.
  const double height_m = answers[0]["elevation_m"], measured_m = answers[0]["measured_m"];
  EXPECT_NE(height_m, measured_m);
  EXPECT_NEAR(height_m, measured_m, 600);
  EXPECT_NEAR(measured_m, -5000, 900);
  EXPECT_EQ(answers[1]["kind"], "measured");
  EXPECT_EQ(answers[1]["illustration"], false);
  EXPECT_EQ(answers[1]["measured_m"], answers[1]["elevation_m"]);
  const Result csv = vpe({"query", "mars.vpe", "-63,-12.6"});
  EXPECT_NE(csv.out.find(",kind,measured_m\n"), std::string::npos);
  EXPECT_NE(csv.out.find(",synthetic,-"), std::string::npos) << csv.out;
}

TEST_F(Query, DetailMayBeLeftOutOrPutBelowOtherData) {
  const Words fine{"--region", "10,5,10.2,5.2", "--spacing", "800", "--base-spacing", "60000", "--quiet"};
  const auto build = [&](Words words, const std::string& planet) {
    words.insert(words.begin(), "build");
    words.insert(words.end(), fine.begin(), fine.end());
    words.insert(words.end(), {"-o", planet});
    const Result result = vpe(words);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  };
  build({"embedded", "--detail", "none"}, "data.vpe");
  const json data = parse_json(vpe({"query", "data.vpe", "--json", "10.1,5.1"}).out)[0];
  EXPECT_EQ(data["kind"], "measured");
  build({"embedded"}, "both.vpe");
  const json both = parse_json(vpe({"query", "both.vpe", "--json", "10.1,5.1"}).out)[0];
  EXPECT_EQ(both["kind"], "synthetic");
  EXPECT_NEAR(both["measured_m"].get<double>(), data["elevation_m"].get<double>(), 1);

  Dem dem;
  dem.height_m = [](int, int) { return 1500.0; };
  write_dem(dir_ / "flat.tif", dem);
  build({"flat.tif", "--detail", "synthetic"}, "flat.vpe");
  const json flat = parse_json(vpe({"query", "flat.vpe", "--json", "10.1,5.1"}).out)[0];
  EXPECT_EQ(flat["kind"], "synthetic");
  EXPECT_EQ(flat["source"], "embedded-detail below flat.tif");
  EXPECT_GT(std::abs(flat["elevation_m"].get<double>() - 1500), 1);
  // To within what straight facets, 650 m wide, change of the detail.
  EXPECT_NEAR(flat["measured_m"].get<double>(), 1500, 5);

  expect_failure({"build", "flat.tif", "--detail", "synthetic", "-o", "x.vpe"}, 2, {"--detail", "--spacing"});
  const Words moon{"build", "flat.tif", "--detail", "synthetic", "--spacing",
                   "100",   "--radius", "1737400",  "-o",        "x.vpe"};
  expect_failure(moon, 2, {"--detail synthetic", "Mars"});
}

TEST_F(Query, WithoutTheCarriedDataNothingIsMeasured) {
  Command command = command_for({"build", "embedded", "--image", "embedded", "--region", "0,0,0.2,0.2",
                                 "--spacing", "500", "--base-spacing", "60000", "-o", "plain.vpe"});
  command.environment["VPE_DATA"] = dir_.path().string();
  const Result built = run(command);
  ASSERT_EQ(built.exit_code, 0) << built.err;
  EXPECT_TRUE(says(built.err, {"mola8.tif is missing in " + dir_.path().string(), "VPE_DATA"})) << built.err;
  EXPECT_TRUE(says(built.err, {"mdim21.vrt is missing"})) << built.err;
  const Result result = vpe({"query", "plain.vpe", "--json", "0.1,0.1", "30,30"});
  for (const auto& answer : parse_json(result.out)) {
    EXPECT_EQ(answer["kind"], "synthetic");
    EXPECT_EQ(answer["illustration"], true);
  }
  EXPECT_TRUE(says(result.err, {"an illustration"})) << result.err;
}

TEST_F(Query, BothLongitudeConventions) {
  const json answers = ask({"286,-13.5", "-74,-13.5", "180,10", "-180,10"});
  EXPECT_EQ(answers[0], answers[1]);
  EXPECT_EQ(answers[2], answers[3]);
  EXPECT_EQ(answers[2]["lon_deg"], 180);
}

TEST_F(Query, PlacesInTheNotationsOfMaps) {
  const json expected = ask({"-74,-13.5"});
  for (const char* text :
       {"13.5S,74W", "13.5 S, 286 E", "lat -13.5 lon -74", "74\u00b0W 13\u00b030'S", "286 0, -13 30"})
    EXPECT_EQ(ask({text}), expected) << text;
  EXPECT_EQ(ask({}, "13.5 S, 74 W\n"), expected);
}

// A planetographic latitude of Mars is up to 20 km from the planetocentric one.
TEST_F(Query, LatitudesMayBePlanetographic) {
  const json graphic = ask({"10,45", "10,-90", "--latitude", "planetographic"});
  const double centric_deg = std::atan(std::pow(3376.2 / 3396.19, 2)) * 180 / M_PI;
  EXPECT_NEAR(graphic[0]["lat_deg"].get<double>(), centric_deg, 1e-9);
  EXPECT_GT((45 - centric_deg) * M_PI / 180 * 3396, 19.9);
  EXPECT_EQ(graphic[1]["lat_deg"], -90);
  EXPECT_TRUE(graphic[0]["radius_m"].is_null());  // the datum is not stated
  std::ostringstream place;
  place.precision(17);
  place << "10," << centric_deg;
  EXPECT_NEAR(ask({place.str()})[0]["elevation_m"].get<double>(), graphic[0]["elevation_m"].get<double>(),
              1e-6);
  EXPECT_NEAR(ask({"10,45", "--latitude", "planetographic:1000,500"})[0]["lat_deg"].get<double>(),
              std::atan(0.25) * 180 / M_PI, 1e-9);
  EXPECT_EQ(ask({"10,45", "--latitude", "planetocentric"})[0]["lat_deg"], 45);
  expect_failure({"query", planet().string(), "10,45", "--latitude", "geodetic"}, 2,
                 {"--latitude", "geodetic"});
  // Where the datum is an ellipsoid, either kind is likely.
  write_dem(dir_ / "x.tif");
  vpe({"build", "x.tif", "-o", "e.vpe", "--base-spacing", "100000", "--datum", "ellipsoid:3396190,3376200"});
  EXPECT_TRUE(says(vpe({"query", "e.vpe", "10,45"}).err, {"note: latitudes", "up to 20 km", "--latitude"}));
  EXPECT_EQ(vpe({"query", "e.vpe", "10,45", "--latitude", "planetocentric"}).err, "");
  const Result profile = vpe({"profile", "e.vpe", "10,45", "20,45", "--latitude", "planetographic", "--json"});
  EXPECT_NEAR(parse_json(profile.out)["points"][0]["lat_deg"].get<double>(), centric_deg, 1e-9);
}

TEST_F(Query, MalformedPlacesAreRefusedAndQuotedUnchanged) {
  for (const char* text :
       {"10 20,30", "2268.75,17", "1e300,0", "540,10", "18.4,97.5", "'137.3 -4.6'", "1;2;3"}) {
    const Result result = vpe({"query", planet().string()}, std::string(text) + "\n");
    EXPECT_EQ(result.exit_code, 2) << text;
    EXPECT_TRUE(says(result.err, {"standard input, line 1", text, "expected"})) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(vpe({"query", planet().string(), text}).exit_code, 2) << text;
  }
}

TEST_F(Query, TheHeaderSaysWhichColumnIsWhich) {
  const json expected = ask({"77.5,18.4", "-74,-13.5"});
  for (const char* table : {"lat,lon\n18.4,77.5\n-13.5,-74\n", "Latitude;Longitude\n18.4;77.5\n-13.5;-74\n",
                            "y\tx\n18.4\t77.5\n-13.5\t-74\n", "lat_deg, lon_deg\n18.4N, 77.5E\n13.5 S, 74 W\n",
                            "\"lat\",\"lon\"\n\"18.4\",77.5\n\"13 30 S\",\"286\"\n"})
    EXPECT_EQ(ask({}, table), expected) << table;
  // Columns x and y of a map projection are not the place if the table has it too.
  json answers = ask({}, "x,y,lon,lat\n500,600,77.5,18.4\n");
  EXPECT_EQ(answers[0]["lon_deg"], 77.5);
  EXPECT_EQ(answers[0]["input"]["x"], "500");
}

TEST_F(Query, FurtherColumnsAreKept) {
  const std::string table = "name,lon,lat,level\n\"Gale, west\",137,-5,7\nJezero,77.5,18.4,\n";
  const json answers = ask({}, table);
  EXPECT_EQ(answers[0]["input"], json({{"name", "Gale, west"}, {"level", "7"}}));
  EXPECT_EQ(answers[1]["input"], json({{"name", "Jezero"}, {"level", ""}}));
  const std::vector<std::string> lines = lines_of(vpe({"query", planet().string()}, table).out);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_TRUE(lines[0].ends_with(",measured_m,name,input_level")) << lines[0];
  EXPECT_TRUE(lines[1].ends_with(",\"Gale, west\",7")) << lines[1];
  EXPECT_TRUE(lines[2].ends_with(",Jezero,")) << lines[2];
}

TEST_F(Query, HeadersThatNameNoPlaceAreRefused) {
  for (const char* table :
       {"name,value\n1,2\n", "lon,height\n1,2\n", "lon,longitude,lat\n1,2,3\n", "foo\n1,2\n", "x,lat\n1,2\n"}) {
    const Result result = vpe({"query", planet().string()}, table);
    EXPECT_EQ(result.exit_code, 2) << table;
    EXPECT_TRUE(says(result.err, {"line 1", "a header must name one longitude and one latitude"}))
        << result.err;
  }
  for (const char* table : {"lon,lat\n1\n", "lon,lat\n1,2,3\n", "lon,lat\n\"1,2\n", "lon,lat\n1,95\n",
                            "lon,lat\n1 S,5\n", "lon,lat\n,5\n"}) {
    const Result result = vpe({"query", planet().string()}, table);
    EXPECT_EQ(result.exit_code, 2) << table;
    EXPECT_TRUE(says(result.err, {"standard input, line 2"})) << result.err;
  }
}

TEST_F(Query, StandardInput) {
  const json expected = ask({"-74,-13.5", "10,20"});
  EXPECT_EQ(ask({}, "-74,-13.5\n10,20\n"), expected);
  EXPECT_EQ(ask({}, "lon,lat\r\n# where\r\n-74,-13.5\r\n\r\n 10 ,\t20"), expected);
  EXPECT_EQ(ask({}, "\xEF\xBB\xBF# places\nlon_deg,lat_deg\n286,-13.5\n10,20\n"), expected);
  EXPECT_EQ(ask({}, ""), json::array());
  for (const char* text : {"1,2\nfoo\n", "1,2\nlon,lat\n", "1,2\n3/4\n", "lon,lat\n1\n", "1,2\n0,95\n"}) {
    const Result result = vpe({"query", planet().string()}, text);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(says(result.err, {"standard input, line 2"}));
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(Query, CsvAndJsonSayTheSame) {
  const json answers = ask({"-74,-13.5", "10,20"});
  const Result csv = vpe({"query", planet().string(), "-74,-13.5", "10,20"});
  const std::vector<std::string> lines = lines_of(csv.out);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0],
            "lon_deg,lat_deg,elevation_m,slope_deg,aspect_deg,level,post_spacing_m,source,tile_error_m,datum,"
            "source_spacing_m,resampling_max_m,resampling_rms_m,kind,measured_m");
  for (std::size_t n = 0; n < 2; ++n) {
    std::istringstream row(lines[n + 1]);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 15U);
    EXPECT_EQ(std::stod(cells[0]), answers[n]["lon_deg"]);
    EXPECT_EQ(std::stod(cells[1]), answers[n]["lat_deg"]);
    EXPECT_NEAR(std::stod(cells[2]), answers[n]["elevation_m"].get<double>(), 0.0006);
    EXPECT_NEAR(std::stod(cells[3]), answers[n]["slope_deg"].get<double>(), 0.0006);
    EXPECT_NEAR(std::stod(cells[4]), answers[n]["aspect_deg"].get<double>(), 0.006);
    EXPECT_EQ(cells[7], answers[n]["source"]);
    EXPECT_EQ(cells[9], answers[n]["datum"]);
    EXPECT_NEAR(std::stod(cells[10]), answers[n]["source_spacing_m"].get<double>(), 0.006);
    EXPECT_NEAR(std::stod(cells[11]), answers[n]["resampling_max_m"].get<double>(), 0.0006);
    EXPECT_NEAR(std::stod(cells[12]), answers[n]["resampling_rms_m"].get<double>(), 0.0006);
    EXPECT_EQ(cells[13], answers[n]["kind"]);
    EXPECT_NEAR(std::stod(cells[14]), answers[n]["measured_m"].get<double>(), 0.0006);
  }
}

TEST_F(Query, NoAnswerWhereNoSourceHasData) {
  Dem dem;
  dem.no_data = -9999;
  dem.height_m = [](int column, int) { return column < 90 ? -9999.0 : 700.0; };  // the west has none
  write_dem(dir_ / "half.tif", dem);
  ASSERT_EQ(vpe({"build", "half.tif", "-o", "half.vpe", "--base-spacing", "100000"}).exit_code, 0);
  const json answers = parse_json(vpe({"query", "half.vpe", "--json", "-100,10", "100,10"}).out);
  for (const char* key : {"elevation_m", "slope_deg", "aspect_deg", "source_spacing_m", "tile_error_m",
                          "resampling_max_m", "resampling_rms_m"}) {
    EXPECT_TRUE(answers[0][key].is_null()) << key;
    EXPECT_TRUE(answers[1][key].is_number()) << key;
  }
  EXPECT_TRUE(answers[0]["source"].is_null());
  EXPECT_EQ(answers[1]["source"], "half.tif");
  // The reference surface lies up to 128 m below the sphere between its few posts.
  EXPECT_NEAR(answers[1]["elevation_m"].get<double>(), 636, 64.1);
  const std::vector<std::string> lines = lines_of(vpe({"query", "half.vpe", "-100,10", "100,10"}).out);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[1].find("-100,10,,,,0,"), 0U) << lines[1];
  EXPECT_NEAR(std::stod(lines[2].substr(7)), answers[1]["elevation_m"].get<double>(), 0.0006) << lines[2];
  // Answers come first, whatever the exit status.
  EXPECT_EQ(vpe({"query", "half.vpe", "100,10", "--fail-on-nodata"}).exit_code, 0);
  const Result failed = vpe({"query", "half.vpe", "-100,10", "100,10", "--fail-on-nodata"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(lines_of(failed.out), lines);
  EXPECT_TRUE(says(failed.err, {"1 of 2 places have no data"})) << failed.err;
}

TEST_F(Query, ResultsThatCannotBeWritten) {
  for (const Words& arguments : {Words{"query", planet().string(), "1,2"}, Words{"settings", "--json"},
                                 Words{"info", planet().string()}}) {
    Command command = command_for(arguments);
    command.output_to = "/dev/full";
    const Result result = app_test::run(command);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(says(result.err, {"standard output", "No space left"}));
  }
}

TEST_F(Query, InfoAndBuildAndSettingsAsJson) {
  write_dem(dir_ / "x.tif");
  const Result built = vpe({"build", "x.tif", "-o", "x.vpe", "--base-spacing", "100000", "--json"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  json build = parse_json(built.out);
  EXPECT_EQ(build["bytes"], std::filesystem::file_size(dir_ / "x.vpe"));
  EXPECT_EQ(build["tiles"], 6);
  EXPECT_EQ(build["sources"][0]["name"], "x.tif");
  EXPECT_EQ(build["resampling_posts"], 180 * 90);

  json info = parse_json(vpe({"info", "x.vpe", "--json"}).out);
  EXPECT_EQ(info["path"], "x.vpe");
  build.erase("bytes");
  EXPECT_EQ(build["tiles_kept"], 0);
  build.erase("tiles_kept");
  EXPECT_EQ(build["findings"].size(), 1U);
  build.erase("findings");
  EXPECT_TRUE(says(build["notes"][0], {"x.tif", "--datum"}));
  build.erase("notes");
  EXPECT_TRUE(info["raster"].is_null());  // of a planet file
  info.erase("raster");
  EXPECT_EQ(info, build);
  EXPECT_EQ(info["levels"], 1);
  EXPECT_EQ(info["by_level"][0]["level"], 0);

  const json settings = parse_json(vpe({"settings", "--json"}).out);
  ASSERT_TRUE(settings.is_array());
  Words keys;
  for (const json& entry : settings) {
    keys.push_back(entry.at("key"));
    EXPECT_FALSE(entry.at("meaning").get<std::string>().empty());
    EXPECT_TRUE(entry.contains("default") && entry.contains("range") && entry.contains("unit"));
  }
  const Result plain = vpe({"settings"});
  EXPECT_TRUE(says(plain.out, keys));
  EXPECT_TRUE(says(plain.out, {"mode", "exaggeration", "sun.azimuth", "sun.elevation"}));
}

TEST_F(Query, QuietSaysNothing) {
  write_dem(dir_ / "x.tif");
  const Result result = vpe({"build", "x.tif", "-o", "x.vpe", "--base-spacing", "100000", "-q"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Query, NumbersAreLocaleProof) {
  constexpr const char* kLocale = "de_DE.UTF-8";
  const locale_t german = ::newlocale(LC_ALL_MASK, kLocale, nullptr);
  if (german == nullptr) GTEST_SKIP() << "skipped: no locale " << kLocale;
  ::freelocale(german);
  const Words words{"query", planet().string(), "-74.25,-13.5"};
  Command command = command_for(words);
  command.environment["LC_ALL"] = kLocale;
  EXPECT_EQ(app_test::run(command).out, vpe(words).out);
}

TEST_F(Query, NamesWithBlanksAndOtherLetters) {
  for (const char* name : {"Täler und Höhen", "火星", "a'b\"c $HOME"}) {
    const std::filesystem::path folder = dir_ / name;
    std::filesystem::create_directory(folder);
    write_dem(folder / "mein dem.tif");
    const std::string file = (folder / "mein planet.vpe").string();
    const Result built =
        vpe({"build", (folder / "mein dem.tif").string(), "-o", file, "--base-spacing", "100000", "--json"});
    EXPECT_EQ(built.exit_code, 0) << built.err;
    EXPECT_EQ(parse_json(built.out)["tiles"], 6);
    EXPECT_EQ(parse_json(vpe({"query", file, "10,20", "--json"}).out).size(), 1U);
    EXPECT_EQ(parse_json(vpe({"info", file, "--json"}).out)["tiles"], 6);
  }
}

TEST_F(Query, JsonStaysJsonForNamesThatAreNotUtf8) {
  const std::string file = path("caf\xE9.vpe");
  std::filesystem::copy_file(planet(), file);
  const Result result = vpe({"info", file, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(parse_json(result.out)["path"], {"/caf\xEF\xBF\xBD.vpe"}));
}

}  // namespace
}  // namespace app_test
