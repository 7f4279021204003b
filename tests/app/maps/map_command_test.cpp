// vpe map as a user runs it: against vpe query, gdaldem and GDAL's validator.
#include <gdal_priv.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class MapCommand : public AppTest {
 protected:
  json map(const Words& more, const std::string& planet_file = planet().string()) const {
    Words words{"map", planet_file, "--json", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? parse_json(result.out) : json();
  }

  // Returns a band, counted from 1, by rows.
  std::vector<float> band(const std::string& name, int number) const {
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path(name).c_str()));
    EXPECT_NE(file, nullptr);
    const int columns = file->GetRasterXSize();
    const int rows = file->GetRasterYSize();
    std::vector<float> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    EXPECT_EQ(file->GetRasterBand(number)->RasterIO(GF_Read, 0, 0, columns, rows, values.data(), columns, rows,
                                                    GDT_Float32, 0, 0, nullptr),
              CE_None);
    return values;
  }

  std::string metadata(const std::string& name, const char* key) const {
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path(name).c_str()));
    const char* value = file->GetMetadataItem(key);
    return value == nullptr ? "" : value;
  }
};

TEST_F(MapCommand, HasTheValuesOfQuery) {
  const json map_ = map({"--box", "-20,-10,25,40", "--spacing", "20000", "--crs", "IAU_2015:49900", "--bands",
                         "elevation,slope,aspect,post_spacing,error", "-o", path("m.tif")});
  const int columns = map_["columns"];
  const auto to_map = map_["geotransform"].get<std::vector<double>>();
  std::string places;
  std::vector<std::size_t> at;
  for (int row = 1; row < map_["rows"].get<int>(); row += 29) {
    for (int column = 2; column < columns; column += 31) {
      char line[80];
      std::snprintf(line, sizeof line, "%.12f,%.12f\n", to_map[0] + (column + 0.5) * to_map[1],
                    to_map[3] + (row + 0.5) * to_map[5]);
      places += line;
      at.push_back(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column));
    }
  }
  const Result queried = vpe({"query", planet().string(), "--json", "-q"}, places);
  ASSERT_EQ(queried.exit_code, 0) << queried.err;
  const json answers = parse_json(queried.out);
  ASSERT_EQ(answers.size(), at.size());
  ASSERT_GE(at.size(), 30U);
  const auto elevation = band("m.tif", 1);
  const auto slope = band("m.tif", 2);
  const auto aspect = band("m.tif", 3);
  const auto spacing = band("m.tif", 4);
  for (std::size_t k = 0; k < at.size(); ++k) {
    // Half a step of float, and what the twelfth digit of a place makes of it.
    EXPECT_NEAR(elevation[at[k]], answers[k]["elevation_m"].get<double>(), 5e-4);
    EXPECT_NEAR(slope[at[k]], answers[k]["slope_deg"].get<double>(), 1e-5);
    EXPECT_NEAR(aspect[at[k]], answers[k]["aspect_deg"].get<double>(), 1e-4);
    EXPECT_EQ(spacing[at[k]], static_cast<float>(answers[k]["post_spacing_m"].get<double>()));
  }
}

TEST_F(MapCommand, SlopesAgreeWithGdaldemOnItsHeights) {
  if (std::system("command -v gdaldem > /dev/null 2>&1") != 0) GTEST_SKIP() << "skipped: no gdaldem";
  map({"--box", "10,-10,30,10", "--spacing", "2000", "--crs", "IAU_2015:49910", "--bands", "elevation,slope",
       "-o", path("m.tif")});
  const std::string command = "gdaldem slope -q -b 1 '" + path("m.tif") + "' '" + path("slope.tif") + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const auto ours = band("m.tif", 2);
  const auto theirs = band("slope.tif", 1);
  ASSERT_EQ(ours.size(), theirs.size());
  // Facets are 42 km wide, so that most pixels and their neighbours lie on one. Others differ: gdaldem smooths over the
  // edges. Away from the equator its metres along parallels are too long.
  std::size_t near = 0;
  std::size_t counted = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (theirs[i] < -1) continue;
    ++counted;
    near += std::abs(ours[i] - theirs[i]) < 0.02 * ours[i] + 0.01 ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(near) / static_cast<double>(counted), 0.7);
}

TEST_F(MapCommand, SaysDatumResolutionErrorAndShares) {
  const json map_ = map({"--box", "0,0,10,10", "--spacing", "20000", "-o", path("m.tif")});
  for (const char* key : {"datum", "radius_m", "post_spacing_m", "coarsest_post_spacing_m", "resampling_max_m",
                          "sources", "nodata_share", "synthetic_share", "crs"})
    EXPECT_TRUE(map_.contains(key)) << key;
  for (const char* key :
       {"VPE_DATUM", "VPE_BODY", "VPE_POST_SPACING_M", "VPE_ERROR_MAX_M", "VPE_NODATA_PERCENT",
        "VPE_SYNTHETIC_PERCENT", "VPE_SOURCES", "VPE_CRS", "TIFFTAG_SOFTWARE"})
    EXPECT_FALSE(metadata("m.tif", key).empty()) << key;
  const Result text =
      vpe({"map", planet().string(), "--box", "0,0,10,10", "--spacing", "20000", "-o", path("m.tif")});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_TRUE(says(text.out, {"datum", "resolution", "nodata", "synthetic"}));
  EXPECT_TRUE(leftovers().empty());
}

TEST_F(MapCommand, PartsMakeTheBytesOfOneRun) {
  // Four strips.
  const Words words{"--box", "0,0,90,80",      "--spacing", "2400",
                    "--crs", "IAU_2015:49900", "--bands",   "elevation,slope,aspect"};
  Words whole = words;
  whole.insert(whole.end(), {"-o", path("a.tif"), "--threads", "1"});
  map(whole);
  const auto part = [&](const std::string& which) {
    Words more{"map", planet().string(), "-q", "-o", path("b.tif"), "--part", which, "--memory", "300"};
    more.insert(more.end(), words.begin(), words.end());
    const Result result = vpe(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_FALSE(exists("b.tif"));
  };
  part("2/3");
  part("1/3");
  fs::remove(dir_ / "b.tif.strips" / "strip_000001.tif");
  Words last = words;
  last.insert(last.end(), {"-o", path("b.tif"), "--threads", "3"});
  map(last);
  EXPECT_EQ(read_text(dir_ / "a.tif"), read_text(dir_ / "b.tif"));
  EXPECT_FALSE(exists("b.tif.strips"));
}

TEST_F(MapCommand, StripsOfAnotherMapAreNotUsed) {
  const Words words{"-q", "--box", "0,0,10,10", "--crs", "IAU_2015:49900", "-o", path("m.tif")};
  const auto run = [&](const Words& more) {
    Words all{"map", planet().string()};
    all.insert(all.end(), words.begin(), words.end());
    all.insert(all.end(), more.begin(), more.end());
    return vpe(all);
  };
  EXPECT_EQ(run({"--spacing", "20000", "--part", "1/2"}).exit_code, 0);
  const Result other = run({"--spacing", "30000", "--part", "1/2"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_TRUE(says(other.err, {"m.tif.strips", "another map"}));
  EXPECT_EQ(run({"--spacing", "30000"}).exit_code, 0);
  EXPECT_EQ(band("m.tif", 1).size(), 400U);
}

TEST_F(MapCommand, MakesACloudOptimisedFile) {
  if (std::system(
          "/usr/bin/python3 -c 'import osgeo_utils.samples.validate_cloud_optimized_geotiff' > /dev/null 2>&1") !=
      0)
    GTEST_SKIP() << "skipped: no validator of GDAL (python3-gdal)";
  map({"--spacing", "20000", "--bands", "elevation,shade", "-o", path("m.tif")});
  const std::string command = "/usr/bin/python3 -m osgeo_utils.samples.validate_cloud_optimized_geotiff -q '" +
                              path("m.tif") + "' > /dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(MapCommand, SunAndItsHours) {
  const json map_ = map({"--box", "-180,-90,180,90", "--spacing", "300000", "--crs", "IAU_2015:49900",
                         "--bands", "sun,sun_hours", "--sun", "2026-11-27T12:00Z", "-o", path("m.tif")});
  const auto sun = band("m.tif", 1);
  const auto hours = band("m.tif", 2);
  int dark = 0;
  for (const float value : sun) dark += value == 0 ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(dark) / static_cast<double>(sun.size()), 0.5, 0.06);
  for (const float value : hours) {
    EXPECT_GE(value, 0);
    EXPECT_LE(value, 24.67);
  }
  EXPECT_FALSE(metadata("m.tif", "VPE_SUN").empty());
}

TEST_F(MapCommand, RefusesWhatIsWrong) {
  const std::string file = planet().string();
  expect_failure({"map", file, "--spacing", "1000", "--box", "1,2,3", "-o", "m.tif"}, 2,
                 {"--box", "WEST,SOUTH,EAST,NORTH"});
  expect_failure({"map", file, "--spacing", "1000", "--box", "0,10,5,0", "-o", "m.tif"}, 2,
                 {"latitudes must ascend"});
  expect_failure({"map", file, "--spacing", "1000", "--bands", "height", "-o", "m.tif"}, 2,
                 {"height", "elevation"});
  expect_failure({"map", file, "--spacing", "1", "-o", "m.tif"}, 2, {"columns", "larger spacing"});
  expect_failure({"map", file, "--spacing", "20000", "--crs", "EPSG:4326", "-o", "m.tif"}, 1,
                 {"6378137", "IAU_2015"});
  expect_failure({"map", file, "--spacing", "20000", "--bands", "sun", "-o", "m.tif"}, 2, {"--sun"});
  expect_failure({"map", file, "--spacing", "20000", "--bands", "sun_hours", "--sun", "90,20", "-o", "m.tif"},
                 2, {"date"});
  expect_failure({"map", file, "--spacing", "20000", "--bands", "sun", "--sun", "noon", "-o", "m.tif"}, 2,
                 {"noon"});
  expect_failure({"map", file, "--spacing", "20000", "--bands", "colour", "-o", "m.tif"}, 2, {"imagery"});
  expect_failure({"map", file, "--spacing", "20000", "--shade", "1", "-o", "m.tif"}, 2, {"AZIMUTH,ELEVATION"});
  expect_failure({"map", file, "--spacing", "20000", "-o", "m.png"}, 1, {"m.png", "end in .tif"});
  write_text(dir_ / "notes.tif", "my notes");
  expect_failure({"map", file, "--spacing", "20000", "-o", "notes.tif"}, 1, {"notes.tif"});
  EXPECT_EQ(read_text(dir_ / "notes.tif"), "my notes");
}

}  // namespace
}  // namespace app_test
