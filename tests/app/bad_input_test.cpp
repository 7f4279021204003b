// Malformed files: one clear message, exit 1, nothing half-written.
#include <fstream>
#include <limits>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;

class BadInput : public AppTest {
 protected:
  // Expects the failure from `build`, and where a PLANET is expected.
  void expect_bad_dem(const std::string& name, const Words& parts) const {
    Words all = parts;
    all.push_back(name);
    expect_failure({"build", name, "-o", "x.vpe", "--base-spacing", "100000"}, 1, all);
    expect_failure({"query", name, "1,2"}, 1, all);
    EXPECT_FALSE(exists("x.vpe"));
    for (const auto& entry : fs::recursive_directory_iterator(dir_.path()))
      EXPECT_NE(entry.path().extension(), ".vpe");
  }
  void expect_bad_planet(const std::string& name, const Words& parts) const {
    Words all = parts;
    all.push_back(name);
    expect_failure({"query", name, "1,2"}, 1, all);
  }
};

TEST_F(BadInput, Dems) {
  expect_bad_dem("missing.tif", {"cannot open", "No such file", "check the name"});

  write_text(dir_ / "text.tif", "hello\n");
  expect_bad_dem("text.tif", {"cannot open as a raster", "not recognized", "gdalinfo"});
  write_text(dir_ / "empty.tif", "");
  expect_bad_dem("empty.tif", {"cannot open as a raster", "gdalinfo"});
  fs::create_directory(dir_ / "folder");
  expect_bad_dem("folder", {"cannot open as a raster"});

  Dem dem;
  dem.georeference = false;
  write_dem(dir_ / "nowhere.tif", dem);
  expect_bad_dem("nowhere.tif", {"no georeference", "gdal_translate -a_srs"});

  dem = {};
  dem.height_m = [](int, int) { return std::numeric_limits<double>::quiet_NaN(); };
  write_dem(dir_ / "nan.tif", dem);
  expect_bad_dem("nan.tif", {"holds no elevation", "not a number", "gdalinfo"});

  write_dem(dir_ / "cut.tif");
  fs::resize_file(dir_ / "cut.tif", 2000);
  expect_bad_dem("cut.tif", {"cannot read", "cut short or damaged"});
}

TEST_F(BadInput, OnePixelGivesAPlanetWithOneHeightThere) {
  Dem dem;
  dem.width = dem.height = 1;
  dem.west_deg = 10;
  dem.north_deg = 22;
  dem.cell_deg = 4;
  dem.height_m = [](int, int) { return 1234.0; };
  write_dem(dir_ / "one.tif", dem);
  EXPECT_EQ(vpe({"build", "one.tif", "-o", "one.vpe", "--base-spacing", "100000"}).exit_code, 0);
  const auto answers = parse_json(vpe({"query", "one.vpe", "--json", "12,20", "100,20"}).out);
  EXPECT_NEAR(answers[0]["elevation_m"].get<double>(), 1234, 135);  // the sagitta of posts 42 km apart
  EXPECT_TRUE(answers[1]["elevation_m"].is_null());
}

// Fill values that no nodata value declares, as rasters of radii have them.
TEST_F(BadInput, HeightsAtOrBelowTheCentreAreRefusedByPlace) {
  Dem dem;
  dem.height_m = [](int column, int row) { return column == 40 && row == 60 ? 0 : 3396290; };
  write_dem(dir_ / "radii.tif", dem);
  expect_bad_dem("radii.tif", {"radii.tif: the height at lon -", "centre", "-a_nodata", "--radius"});
  dem.height_m = [](int, int) { return 0; };
  write_dem(dir_ / "zeros.tif", dem);
  expect_failure({"build", "zeros.tif", "--datum", "radius", "-o", "z.vpe", "--base-spacing", "100000"}, 1,
                 {"zeros.tif: ", "centre"});
  dem.height_m = [](int column, int row) { return column == 40 && row == 60 ? -32768e3 : 1200; };
  write_dem(dir_ / "fill.tif", dem);
  expect_bad_dem("fill.tif", {"fill.tif: the height at lon -99 lat -31 is -32768000 m", "centre"});
  EXPECT_EQ(leftovers(), Words{});
}

// The mean of all heights fills nodata, so a wild height must not get into it.
TEST_F(BadInput, AHeightTooLargeToStoreIsReportedWhereItIs) {
  Dem dem;
  dem.west_deg = 10;
  dem.north_deg = 20;
  dem.cell_deg = 0.1;
  dem.no_data = -1;
  dem.height_m = [](int column, int row) { return column == 40 && row == 60 ? 4e9 : 1200; };
  write_dem(dir_ / "wild.tif", dem);
  expect_bad_dem("wild.tif", {"wild.tif: the height at lon 14.05 lat 13.95 is 4000000000 m", "-a_nodata"});
  EXPECT_EQ(leftovers(), Words{});
}

TEST_F(BadInput, FilesBesideTheRightOneAreHintedAt) {
  fs::create_directory(dir_ / "folder");
  expect_bad_dem("folder", {"cannot open as a raster", "it is a folder", "give a raster in it"});
  // The pixels of a raster whose label has the same name.
  write_dem(dir_ / "pixels.tif");
  const std::string raw(2 * 180 * 90, '\1');
  write_text(dir_ / "dem.dat", raw);
  write_text(dir_ / "dem.vrt",
             "<VRTDataset rasterXSize=\"180\" rasterYSize=\"90\"><SRS>+proj=longlat +R=3396190 +no_defs</SRS>"
             "<GeoTransform>-180,2,0,90,0,-2</GeoTransform><VRTRasterBand dataType=\"Int16\" band=\"1\" "
             "subClass=\"VRTRawRasterBand\"><SourceFilename relativeToVRT=\"1\">dem.dat</SourceFilename>"
             "</VRTRasterBand></VRTDataset>");
  expect_bad_dem("dem.dat", {"cannot open as a raster", "give the file that describes it: 'dem.vrt'"});
  EXPECT_EQ(vpe({"build", "dem.vrt", "-o", "x.vpe", "--estimate"}).exit_code, 0);
  Dem dem;
  dem.georeference = false;
  write_dem(dir_ / "nowhere.tif", dem);
  expect_bad_dem("nowhere.tif", {"IAU_2015:CODE", "49900 for Mars, 30100 for the Moon"});
}

TEST_F(BadInput, WordsAfterADoubleDashAreNoOptions) {
  const std::string planet = this->planet().string();
  const std::string answer = vpe({"query", planet, "-10,5"}).out;
  EXPECT_EQ(vpe({"query", planet, "--", "-10,5"}).out, answer);
  EXPECT_EQ(vpe({"query", "--", planet, "-10,5"}).out, answer);
  fs::copy_file(planet, dir_ / "-p.vpe");
  EXPECT_NE(vpe({"query", "--", "-p.vpe", "-10,5"}).out, "");
}

TEST_F(BadInput, OneBadDemAmongGoodOnes) {
  write_dem(dir_ / "good.tif");
  write_text(dir_ / "bad.tif", "no");
  expect_failure({"build", "good.tif", "bad.tif", "-o", "x.vpe"}, 1, {"bad.tif", "cannot open as a raster"});
  expect_failure({"build", "good.tif", "--image", "bad.tif", "-o", "x.vpe"}, 1,
                 {"bad.tif", "cannot open as a raster"});
  expect_failure({"build", "good.tif", "--image", "none.png", "-o", "x.vpe"}, 1, {"none.png", "No such file"});
  EXPECT_FALSE(exists("x.vpe"));
}

TEST_F(BadInput, PlanetFiles) {
  expect_bad_planet("missing.vpe", {"no such planet file", "vpe build"});
  write_dem(dir_ / "raster.vpe");
  expect_bad_planet("raster.vpe", {"not a database", "not a planet file, or damaged: build it again"});
  write_text(dir_ / "empty.vpe", "");
  expect_bad_planet("empty.vpe", {"not a planet file"});
  fs::create_directory(dir_ / "folder.vpe");
  expect_bad_planet("folder.vpe", {"cannot open", "not a planet file"});
  const std::string whole = read_text(planet());
  for (const double part : {0.001, 0.05, 0.5, 0.9}) {
    SCOPED_TRACE(part);
    write_text(dir_ / "cut.vpe",
               whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    expect_bad_planet("cut.vpe", {"damaged", "build it again"});
  }
}

TEST_F(BadInput, APlanetFileThatMayNotBeRead) {
  fs::copy_file(planet(), dir_ / "secret.vpe");
  fs::permissions(dir_ / "secret.vpe", fs::perms::none);
  if (std::ifstream(dir_ / "secret.vpe").good()) GTEST_SKIP() << "this user may read everything";
  expect_bad_planet("secret.vpe", {"cannot open", "Permission denied", "readable"});
}

TEST_F(BadInput, FlippedBitsAreDetectedOrDoNotMatter) {
  const std::string whole = read_text(planet());
  const Words places{"10,20", "90,0", "-74,-13", "180,0", "100,80", "0,-80"};  // one on every face
  const auto query = [&](const std::string& name) {
    Words words{"query", name};
    words.insert(words.end(), places.begin(), places.end());
    return vpe(words);
  };
  const std::string truth = query(planet().string()).out;
  test_support::Random random(7);
  int seen = 0;
  for (int n = 0; n < 16; ++n) {
    std::string bytes = whole;
    for (int flip = 0; flip < 8; ++flip) {
      const int at = random.integer(0, static_cast<int>(bytes.size()) - 1);
      bytes[static_cast<std::size_t>(at)] ^= static_cast<char>(1 << random.integer(0, 7));
    }
    write_text(dir_ / "flip.vpe", bytes);
    const Result result = query("flip.vpe");
    SCOPED_TRACE(n);
    if (result.exit_code == 0) {
      EXPECT_EQ(result.out, truth);
    } else {
      ++seen;
      EXPECT_EQ(result.exit_code, 1) << "signal " << result.signal;
      EXPECT_TRUE(says(result.err, {"flip.vpe", "build", "again"}));
      EXPECT_EQ(result.out, "");
    }
  }
  EXPECT_GT(seen, 0);
}

TEST_F(BadInput, Outputs) {
  write_dem(dir_ / "x.tif");
  expect_failure({"build", "x.tif", "-o", "none/x.vpe"}, 1,
                 {"none/x.vpe", "cannot write", "no folder 'none'", "make it"});
  expect_failure({"build", "x.tif", "-o", "x.tif/y.vpe"}, 1,
                 {"x.tif/y.vpe", "cannot write", "no folder 'x.tif'"});
  fs::create_directory(dir_ / "folder");
  expect_failure({"build", "x.tif", "-o", "folder"}, 1,
                 {"folder", "cannot write", "is a folder", "name of a file"});
  write_text(dir_ / "precious.txt", "years of work");
  expect_failure({"build", "x.tif", "-o", "precious.txt"}, 1,
                 {"precious.txt", "not a planet file", "another name"});
  EXPECT_EQ(read_text(dir_ / "precious.txt"), "years of work");
}

TEST_F(BadInput, OutputsOfImagesAreCheckedBeforeTheWork) {
  write_text(dir_ / "f.flight", small_flight());
  const auto render = [&](const Words& more, const Words& parts) {
    Words words{"render", "missing.vpe", "--pose", "0,0,300000"};
    words.insert(words.end(), more.begin(), more.end());
    expect_failure(words, 1, parts);
    EXPECT_FALSE(exists("x.png"));
  };
  render({"-o", "x.bmp"}, {"x.bmp", "cannot write", "image format", ".png, .jpg or .jpeg"});
  render({"-o", "x"}, {"x: cannot write", "image format"});
  render({"-o", "none/x.png"}, {"none/x.png", "no folder 'none'"});
  render({"-o", "x.png", "--range", "r.png"}, {"r.png", "cannot write", ".tif"});
  render({"-o", "x.png", "--range", "none/r.tif"}, {"none/r.tif", "no folder 'none'"});
  render({"-o", "x.png", "--certificate", "none/c.json"}, {"none/c.json", "no folder 'none'"});
  render({"-o", "x.png", "--explain-lod", "none/e.json"}, {"none/e.json", "no folder 'none'"});
  const auto fly = [&](const Words& more, const Words& parts) {
    Words words{"fly", "f.flight", "missing.vpe"};
    words.insert(words.end(), more.begin(), more.end());
    expect_failure(words, 1, parts);
    EXPECT_FALSE(exists("frames"));
  };
  fly({"-o", "none/x.mp4"}, {"none/x.mp4", "no folder 'none'"});
  fly({"-o", "x.mov"}, {"x.mov", ".mp4", "folder"});
  fly({"-o", "f.flight"}, {"f.flight", "a file, not a folder"});
  fly({"-o", "x.mp4", "--size", "97x54"}, {"x.mp4", "even", "97x54"});
  fly({"-o", "frames", "--stats", "s.txt"}, {"s.txt", ".csv or .jsonl"});
  fly({"-o", "frames", "--stats", "none/s.csv"}, {"none/s.csv", "no folder 'none'"});
  fly({"-o", "frames", "--log", "none/l.flight"}, {"none/l.flight", "no folder 'none'"});
  expect_failure({"fly", "f.flight", planet().string(), "-o", "f.flight/frames"}, 1,
                 {"f.flight/frames", "cannot make the folder", "Not a directory"});
}

TEST_F(BadInput, NoFfmpeg) {
  write_text(dir_ / "f.flight", small_flight());
  Command command = command_for({"fly", "f.flight", "missing.vpe", "-o", "x.mp4"});
  command.environment["PATH"] = path("empty");
  const Result result = app_test::run(command);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(
      says(result.err, {"x.mp4", "cannot start ffmpeg", "No such file", "install ffmpeg", "PNG frames"}));
  EXPECT_EQ(leftovers(), Words{});
  EXPECT_FALSE(exists("x.mp4"));
}

TEST_F(BadInput, Flights) {
  const auto expect_bad_flight = [&](const std::string& text, const Words& parts) {
    write_text(dir_ / "bad.flight", text);
    expect_failure({"fly", "bad.flight", planet().string(), "-o", "frames"}, 1, parts);
    EXPECT_FALSE(exists("frames"));
  };
  expect_failure({"fly", "none.flight", planet().string(), "-o", "frames"}, 1,
                 {"none.flight", "cannot open the flight", "No such file", "check the name"});
  const std::string start = "flight 1\nat 5 pose lon=1 lat=2 alt=3000\n";
  expect_bad_flight(start + "at 4 pose lon=1 lat=2 alt=3000\n", {"bad.flight:3", "time", "4"});
  expect_bad_flight(start + "at 9 set bogus=3\n", {"bad.flight:3", "bogus"});
  expect_bad_flight(start + "at 9 pose lon=1 lat=2 alt=3 speed=4\n", {"bad.flight:3", "speed"});
  expect_bad_flight(start + "at 9 pose lon=1 lat=91 alt=3\n", {"bad.flight:3", "lat"});
  expect_bad_flight(start + "at 9 pose lon=nan lat=1 alt=3\n", {"bad.flight:3", "lon"});
  expect_bad_flight(start + "wait 9\nat x end\n", {"bad.flight:3", "wait", "bad.flight:4"});
  expect_bad_flight("", {"bad.flight", "flight 1"});
  expect_bad_flight("flight 2\n", {"bad.flight:1", "1"});
  expect_bad_flight(std::string("\0\xFF\x80", 3), {"bad.flight:1"});
}

}  // namespace
}  // namespace app_test
