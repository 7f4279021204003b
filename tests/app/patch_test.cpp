// vpe patch: a finished planet file and new rasters give the planet of a full build.
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

constexpr double kOff_m = 400;    // of the strip above the globe
constexpr double kFacets_m = 60;  // more than the globe's facets lie below the ground: their sagitta is 32 m

double ground_m(double lon_deg, double lat_deg) {
  return 2000 * std::sin(6 * lon_deg * M_PI / 180) * std::cos(lat_deg * M_PI / 180);
}

class PatchCommand : public AppTest {
 protected:
  void SetUp() override {
    Dem globe;
    globe.height_m = [](int column, int row) { return ground_m(2 * column - 179, 89 - 2 * row); };
    write_dem(dir_ / "globe.tif", globe);
    write_inset("strip.tif", 20, 12, kOff_m);
  }

  // Writes a square raster of a function of longitude and latitude.
  void write_square(const std::string& name, double west_deg, double north_deg, double cell_deg, int posts,
                    const std::function<double(double, double)>& height_m, double radius_m = 3396190) const {
    Dem dem;
    dem.width = dem.height = posts;
    dem.west_deg = west_deg;
    dem.north_deg = north_deg;
    dem.cell_deg = cell_deg;
    dem.radius_m = radius_m;
    dem.height_m = [=](int column, int row) {
      return height_m(west_deg + (column + 0.5) * cell_deg, north_deg - (row + 0.5) * cell_deg);
    };
    write_dem(dir_ / name, dem);
  }

  // Writes a square raster whose ground lies `off_m` above the globe's.
  void write_inset(const std::string& name, double west_deg, double north_deg, double off_m,
                   double radius_m = 3396190, double cell_deg = 0.125, int posts = 64) const {
    write_square(
        name, west_deg, north_deg, cell_deg, posts,
        [off_m](double lon_deg, double lat_deg) { return off_m + ground_m(lon_deg, lat_deg); }, radius_m);
  }

  json json_of(Words words) const {
    words.insert(words.end(), {"--json", "-q"});
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? parse_json(result.out) : json();
  }

  // Builds the planet that is patched; without options a copy of the one that an earlier test built.
  json build() const {
    static const test_support::TempDir folder;
    static json built;
    static std::filesystem::file_time_type time;  // of the raster, which planets remember
    if (built.empty()) {
      built = build_with({});
      time = std::filesystem::last_write_time(dir_ / "globe.tif");
      std::filesystem::copy_file(dir_ / "p.vpe", folder / "p.vpe");
    } else {
      std::filesystem::copy_file(folder / "p.vpe", dir_ / "p.vpe");
      std::filesystem::last_write_time(dir_ / "globe.tif", time);
    }
    return built;
  }
  json build_with(const Words& more) const {
    Words words{"build", "globe.tif", "-o", "p.vpe", "--base-spacing", "21000", "--datum", "areoid"};
    words.insert(words.end(), more.begin(), more.end());
    return json_of(words);
  }

  // Patches p.vpe and expects the content of a full build by the arguments that the patched file states.
  json expect_full(const Words& more) const {
    Words words{"patch", "p.vpe", "-o", "patched.vpe", "--force"};
    words.insert(words.end(), more.begin(), more.end());
    const json patched = json_of(words);
    Words full_words{"build", "-o", "full.vpe", "--force"};
    for (const json& word : patched["arguments"]) full_words.push_back(word);
    const json full = json_of(full_words);
    for (const char* key : {"identity", "sources", "arguments", "image_sources", "highest_m"})
      EXPECT_EQ(patched[key], full[key]) << key;
    EXPECT_GT(patched["tiles_kept"].get<int>(), 0);
    EXPECT_EQ(full["tiles_kept"], 0);
    EXPECT_EQ(vpe({"verify", "patched.vpe", "--deep", "-q"}).exit_code, 0);
    EXPECT_EQ(leftovers(), Words{});
    return patched;
  }

  double elevation_m(const std::string& planet, const std::string& place) const {
    return parse_json(vpe({"query", planet, place, "--json"}).out)[0]["elevation_m"].get<double>();
  }
};

TEST_F(PatchCommand, GivesThePlanetOfAFullBuild) {
  const json before = build();
  const json patched = expect_full({"strip.tif"});
  EXPECT_NE(patched["identity"], before["identity"]);
  EXPECT_NEAR(elevation_m("patched.vpe", "24,8"), elevation_m("p.vpe", "24,8") + kOff_m, kFacets_m);
  EXPECT_EQ(elevation_m("patched.vpe", "-120,-30"), elevation_m("p.vpe", "-120,-30"));
  // The file itself.
  const json in_place = json_of({"patch", "p.vpe", "strip.tif", "-o", "p.vpe"});
  EXPECT_EQ(in_place["identity"], patched["identity"]);
  // Another patch beside and above it.
  write_inset("second.tif", 25, 15, -25);
  expect_full({"second.tif"});
}

TEST_F(PatchCommand, AlignsAndMasks) {
  build_with({"--image", "globe.tif"});
  Dem mask;
  mask.width = mask.height = 20;
  mask.west_deg = 21;
  mask.north_deg = 11;
  mask.cell_deg = 0.25;
  mask.height_m = [](int column, int) { return column < 10 ? 1.0 : 0.0; };
  write_dem(dir_ / "mask.tif", mask);
  for (const char* way : {"plane", "edges"}) {
    SCOPED_TRACE(way);
    const json patched = expect_full({"strip.tif", "--mask", "mask.tif", "--align", way});
    EXPECT_TRUE(says(patched["sources"].dump(), {"posts left out where mask.tif is below 0.5"}));
    // Without offset, or with a base that comes up to it.
    const double off_m = elevation_m("patched.vpe", "22,8.5") - elevation_m("p.vpe", "22,8.5");
    if (std::string(way) == "plane") {
      EXPECT_NEAR(off_m, 0, kFacets_m);
      EXPECT_NEAR(elevation_m("patched.vpe", "27.5,8.5"), elevation_m("p.vpe", "27.5,8.5"), kFacets_m);
    } else {
      EXPECT_NEAR(off_m, kOff_m, kFacets_m);
    }
  }
}

TEST_F(PatchCommand, ImagesAreAdded) {
  build_with({"--image", "globe.tif"});
  const json patched = expect_full({"--image", "strip.tif"});
  EXPECT_EQ(patched["image_sources"].size(), 2U);
}

TEST_F(PatchCommand, ReliefsDigAndBuild) {
  build();
  write_text(
      dir_ / "works.relief.toml",
      "version = 1\n"
      "[[relief]]\nkind = \"crater\"\nlon = 24\nlat = 8\nradius_m = 60000\ndepth_m = 5000\nspacing_m = 6000\n"
      "[[relief]]\nkind = \"pad\"\nlon = -60\nlat = 30\nradius_m = 50000\nfalloff_m = 50000\n"
      "spacing_m = 6000\n");
  const json patched = expect_full({"works.relief.toml"});
  EXPECT_EQ(patched["illustration"], true);
  EXPECT_LT(elevation_m("patched.vpe", "24,8"), elevation_m("p.vpe", "24,8") - 3000);
  // The pad is level, and lies on the ground at its middle.
  const double middle_m = elevation_m("patched.vpe", "-60,30");
  EXPECT_NEAR(elevation_m("patched.vpe", "-60.5,30.4"), middle_m, kFacets_m);
  EXPECT_NEAR(middle_m, elevation_m("p.vpe", "-60,30"), kFacets_m);
  EXPECT_NEAR(elevation_m("patched.vpe", "-120,-30"), elevation_m("p.vpe", "-120,-30"), 1e-9);
  // New ground under the pad lifts all of it, also where the new raster has no data.
  std::filesystem::rename(dir_ / "patched.vpe", dir_ / "p.vpe");
  write_inset("below.tif", -64, 34, kOff_m);
  expect_full({"below.tif"});
  EXPECT_NEAR(elevation_m("patched.vpe", "-60,30"), middle_m + kOff_m, kFacets_m);
  write_text(dir_ / "bad.relief.toml",
             "version = 1\n[[relief]]\nkind = \"crater\"\nlon = 24\nlat = 8\nradius_m = -5\n");
  expect_failure({"patch", "p.vpe", "bad.relief.toml", "-o", "q.vpe"}, 1, {"bad.relief.toml", "radius"});
  expect_failure({"build", "works.relief.toml", "-o", "q.vpe"}, 2, {"works.relief.toml", "name one too"});
}

TEST_F(PatchCommand, PlanetsOfRegionsGetAnother) {
  build_with({"--region=-40,-10,-20,10", "--spacing", "10000"});
  const Result outside = vpe({"patch", "p.vpe", "strip.tif", "-o", "coarse.vpe"});
  EXPECT_EQ(outside.exit_code, 0) << outside.err;
  const json patched = expect_full({"strip.tif", "--region", "20,4,28,12"});
  EXPECT_LT(patched["finest_post_spacing_m"].get<double>(), 10001);
}

TEST_F(PatchCommand, SourcesThatMovedAreFound) {
  std::filesystem::create_directory(dir_ / "data");
  std::filesystem::create_directory(dir_ / "planets");
  std::filesystem::rename(dir_ / "globe.tif", dir_ / "data/globe.tif");
  json_of({"build", "data/globe.tif", "-o", "planets/p.vpe", "--base-spacing", "21000", "--datum",
           "data/globe.tif=areoid"});
  std::filesystem::create_directory(dir_ / "elsewhere");
  std::filesystem::rename(dir_ / "data/globe.tif", dir_ / "elsewhere/globe.tif");
  expect_failure({"patch", "planets/p.vpe", "strip.tif", "-o", "q.vpe"}, 1, {"data/globe.tif"});
  const json found = json_of(
      {"patch", "planets/p.vpe", "strip.tif", "--datum", "areoid", "-o", "q.vpe", "--sources", "elsewhere"});
  EXPECT_EQ(found["arguments"][0], "elsewhere/globe.tif");
  std::filesystem::rename(dir_ / "elsewhere/globe.tif", dir_ / "planets/globe.tif");
  EXPECT_EQ(json_of({"patch", "planets/p.vpe", "strip.tif", "--datum", "areoid", "-o", "r.vpe"})["identity"],
            found["identity"]);
}

// A repeatable option takes one value each time: what follows is a raster.
TEST_F(PatchCommand, RastersAfterOptionsAreRasters) {
  const json built = build_with({"--image", "globe.tif", "strip.tif"});
  EXPECT_EQ(built["sources"].size(), 2U);
  EXPECT_EQ(built["image_sources"].size(), 1U);
  EXPECT_EQ(build_with({"strip.tif", "--force"})["sources"].size(), 2U);
}

// A mask, like the areoid, is no source of its own, but decides what the planet has.
TEST_F(PatchCommand, AChangedMaskIsNoticed) {
  Dem mask;
  mask.width = mask.height = 20;
  mask.west_deg = 20;
  mask.north_deg = 12;
  mask.cell_deg = 0.4;
  mask.height_m = [](int column, int) { return column < 10 ? 1.0 : 0.0; };
  write_dem(dir_ / "mask=1.tif", mask);
  build_with({"strip.tif", "--mask", "strip.tif=mask=1.tif"});
  mask.height_m = [](int column, int) { return column < 10 ? 0.0 : 1.0; };
  write_dem(dir_ / "mask=1.tif", mask);
  write_inset("far.tif", 100, 12, 0);
  expect_failure({"patch", "p.vpe", "far.tif", "-o", "q.vpe"}, 1,
                 {"p.vpe: cannot be patched", "strip.tif", "mask=1.tif", "build the planet again"});
}

// Samples of the content do not show every change: a file of another time is not what it was.
TEST_F(PatchCommand, ATouchedSourceIsNotTrusted) {
  build();
  const auto time = std::filesystem::last_write_time(dir_ / "globe.tif");
  std::filesystem::last_write_time(dir_ / "globe.tif", time + std::chrono::hours(1));
  expect_failure({"patch", "p.vpe", "strip.tif", "-o", "q.vpe"}, 1,
                 {"p.vpe", "globe.tif", "another size, time"});
  std::filesystem::create_directory(dir_ / "copies");
  std::filesystem::copy_file(dir_ / "globe.tif", dir_ / "copies/globe.tif");
  json_of({"patch", "p.vpe", "strip.tif", "-o", "q.vpe", "--sources", "copies"});
}

TEST_F(PatchCommand, TheSameSourceTwiceIsRefused) {
  build();
  json_of({"patch", "p.vpe", "strip.tif", "-o", "q.vpe"});
  // The same command again makes the same file.
  json_of({"patch", "p.vpe", "strip.tif", "-o", "q.vpe"});
  for (const std::string& name : {std::string("strip.tif"), path("strip.tif")}) {
    expect_failure({"patch", "q.vpe", name, "-o", "r.vpe"}, 1, {name, "is a source of q.vpe already"});
    expect_failure({"patch", "p.vpe", "strip.tif", name, "-o", "r.vpe"}, 1, {name, "already"});
  }
}

TEST_F(PatchCommand, OptionsAreOfTheAddedRaster) {
  std::filesystem::create_directory(dir_ / "a");
  std::filesystem::rename(dir_ / "strip.tif", dir_ / "a/strip.tif");
  build_with({"a/strip.tif"});
  write_inset("strip.tif", 60, 12, kOff_m);
  const json patched = expect_full({"strip.tif", "--align", "plane"});
  for (const json& source : patched["sources"]) {
    const bool is_levelled = source.value("treatment", "").find("levelled") != std::string::npos;
    EXPECT_EQ(is_levelled, source["name"] == "strip.tif") << source;
  }
  expect_failure({"patch", "p.vpe", "--image", "strip.tif", "--align", "plane", "-o", "q.vpe"}, 2,
                 {"none is given"});
  expect_failure({"patch", "p.vpe", "strip.tif", "--region", "0,0,10,10", "-o", "q.vpe"}, 2,
                 {"was built without it"});
}

// What is warped to meet a strip becomes one source, so an inset at the border of the lowest raster fades in another way.
TEST_F(PatchCommand, WarpedEdgesChangeFadesElsewhere) {
  const auto write_hills = [&](const std::string& name, double west_deg, double north_deg, double cell_deg,
                               int posts, double off_m) {
    write_inset(name, west_deg, north_deg, off_m, 3396190, cell_deg, posts);
  };
  write_hills("lowest.tif", 0, 20, 0.5, 80, 0);
  write_hills("wide.tif", 20, 15, 0.25, 60, 50);
  write_hills("fine.tif", 22, -6, 0.06, 40, 80);
  write_hills("border.tif", 1.6, 10, 0.02, 100, 300);
  write_hills("far.tif", 25, -10, 0.12, 40, 120);
  json_of({"build", "lowest.tif", "wide.tif", "fine.tif", "border.tif", "-o", "p.vpe", "--base-spacing",
           "60000", "--spacing", "6000", "--datum", "areoid"});
  expect_full({"far.tif", "--align", "edges"});
}

// A raster between a base and an inset that is matched to it makes the base finer, so that the warp is another one, although
// its treatment reads the same.
TEST_F(PatchCommand, AFinerBaseWarpsInAnotherWay) {
  const auto write_level = [&](const std::string& name, double west_deg, double north_deg, double cell_deg,
                               int posts, double height_m) {
    write_square(name, west_deg, north_deg, cell_deg, posts, [height_m](double, double) { return height_m; });
  };
  write_level("base.tif", 0, 20, 0.1, 200, 0);
  write_level("inset.tif", 5, 10, 0.02, 100, 1000);
  write_level("between.tif", 15, 15, 0.05, 40, 0);
  json_of({"build", "base.tif", "inset.tif", "-o", "p.vpe", "--base-spacing", "60000", "--datum", "areoid",
           "--align", "inset.tif=edges"});
  expect_full({"between.tif"});
}

TEST_F(PatchCommand, SaysWhatItKeepsAndRounds) {
  build();
  const Result result = vpe({"patch", "p.vpe", "strip.tif", "-o", "q.vpe"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(says(result.out, {"q.vpe: ", "kept of p.vpe: "})) << result.out;
  EXPECT_EQ(result.err.find("Continuing"), std::string::npos) << result.err;
  // Posts of 7 km would be stored in steps of 1 m at the most, as those of 118 km are.
  EXPECT_EQ(result.err.find("rounded"), std::string::npos) << result.err;
}

TEST_F(PatchCommand, BadInputIsRefused) {
  const json before = build();
  expect_failure({"patch", "p.vpe", "-o", "q.vpe"}, 2, {"nothing to patch with"});
  expect_failure({"patch", "p.vpe", "no.tif", "-o", "q.vpe"}, 1, {"no.tif"});
  expect_failure({"patch", "globe.tif", "strip.tif", "-o", "q.vpe"}, 1, {"globe.tif"});
  expect_failure({"patch", "p.vpe", "strip.tif", "-o", "strip.tif"}, 2, {"strip.tif"});
  write_inset("moon.tif", 20, 12, 0, 1737400);
  expect_failure({"patch", "p.vpe", "moon.tif", "-o", "q.vpe"}, 1, {"moon.tif", "radius"});
  expect_failure({"patch", "p.vpe", "strip.tif", "--datum", "sphere:3396000", "-o", "q.vpe"}, 1,
                 {"strip.tif", "sphere:3396000", "--to-datum"});
  Dem empty;
  empty.width = empty.height = 8;
  empty.west_deg = -100;
  empty.north_deg = 0;
  empty.cell_deg = 0.5;
  empty.height_m = [](int, int) { return 1.0; };
  write_dem(dir_ / "far.tif", empty);
  expect_failure({"patch", "p.vpe", "strip.tif", "--mask", "far.tif", "-o", "q.vpe"}, 1,
                 {"far.tif", "leaves no post of strip.tif"});
  expect_failure({"build", "globe.tif", "--mask", "other.tif=far.tif", "-o", "q.vpe"}, 2, {"other.tif"});
  expect_failure({"build", "globe.tif", "--align", "level", "-o", "q.vpe"}, 2, {"none, plane or edges"});
  EXPECT_FALSE(exists("q.vpe"));
  EXPECT_EQ(leftovers(), Words{});
  // A source that is another one now.
  Dem globe;
  globe.height_m = [](int column, int row) { return 7 + ground_m(2 * column - 179, 89 - 2 * row); };
  write_dem(dir_ / "globe.tif", globe);
  expect_failure({"patch", "p.vpe", "strip.tif", "-o", "q.vpe"}, 1,
                 {"p.vpe", "globe.tif", "build the planet again"});
  EXPECT_EQ(json_of({"info", "p.vpe"})["identity"], before["identity"]);
}

}  // namespace
}  // namespace app_test
