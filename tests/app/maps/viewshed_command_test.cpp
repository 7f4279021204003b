// vpe viewshed as a user runs it: against vpe sight, closed forms, and its own parts.
#include <gdal_priv.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

constexpr double kSphere_m = 3396190;
constexpr double kRad = std::numbers::pi / 180;

// Holds the first band of a file, and where its pixels are.
struct Pixels {
  int columns = 0;
  int rows = 0;
  std::array<double, 6> to_map{};
  std::vector<float> values;

  float at(int column, int row) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  }
};

class ViewshedCommand : public AppTest {
 protected:
  // Returns a planet with hills around 10 E on the equator, made once per process.
  std::string hills() const {
    static const test_support::TempDir folder;
    const std::string file = (folder / "hills.vpe").string();
    if (!std::filesystem::exists(file)) {
      build(file, [](int i, int j) {
        return 120 * std::sin(0.11 * i) * std::cos(0.09 * j) + 45 * std::sin(0.31 * i + 0.17 * j) +
               18 * std::cos(0.8 * j);
      });
    }
    return file;
  }

  // Builds a planet of 300 x 300 posts 118 m apart around 10 E on the equator.
  void build(const std::string& file, std::function<double(int, int)> height_m,
             std::optional<double> no_data = std::nullopt) const {
    Dem dem;
    dem.width = dem.height = 300;
    dem.west_deg = 9.7;
    dem.north_deg = 0.3;
    dem.cell_deg = 0.002;
    dem.no_data = no_data;
    dem.height_m = std::move(height_m);
    write_dem(dir_ / "ground.tif", dem);
    const Result built = vpe({"build", "ground.tif", "-o", file, "--base-spacing", "60000", "-q"});
    EXPECT_EQ(built.exit_code, 0) << built.err;
  }

  json view(const std::string& planet_file, const Words& more) const {
    Words words{"viewshed", planet_file, "--json", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? parse_json(result.out) : json();
  }

  Pixels pixels(const std::string& name) const {
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path(name).c_str()));
    EXPECT_NE(file, nullptr);
    Pixels p;
    p.columns = file->GetRasterXSize();
    p.rows = file->GetRasterYSize();
    file->GetGeoTransform(p.to_map.data());
    p.values.resize(static_cast<std::size_t>(p.columns) * static_cast<std::size_t>(p.rows));
    EXPECT_EQ(file->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, p.columns, p.rows, p.values.data(), p.columns,
                                               p.rows, GDT_Float32, 0, 0, nullptr),
              CE_None);
    return p;
  }

  std::string metadata(const std::string& name, const char* key) const {
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path(name).c_str()));
    const char* value = file->GetMetadataItem(key);
    return value == nullptr ? "" : value;
  }
};

// Returns LON,LAT of a pixel of the map around a place on the equator.
std::string place_of(const Pixels& p, double lon_deg, int column, int row) {
  const double x = p.to_map[0] + (column + 0.5) * p.to_map[1];
  const double y = p.to_map[3] + (row + 0.5) * p.to_map[5];
  const double angle = std::hypot(x, y) / kSphere_m;
  const double azimuth = std::atan2(x, y);
  const double lat = std::asin(std::sin(angle) * std::cos(azimuth));
  const double lon = std::atan2(std::sin(azimuth) * std::sin(angle), std::cos(angle));
  char text[80];
  std::snprintf(text, sizeof text, "%.12f,%.12f", lon_deg + lon / kRad, lat / kRad);
  return text;
}

TEST_F(ViewshedCommand, AgreesWithSight) {
  const std::string file = hills();
  view(file, {"--at", "10,0", "--from-height", "30", "--to-height", "3", "--radius", "12000", "--spacing", "60",
              "-o", path("v.tif")});
  view(file, {"--at", "10,0,30", "--radius", "12000", "--spacing", "60", "--needed", "-o", path("n.tif")});
  const Pixels seen = pixels("v.tif");
  const Pixels needed = pixels("n.tif");
  test_support::Random random(17);
  int asked = 0;
  int agree = 0;
  int near = 0;
  while (asked < 40) {
    const int column = random.integer(0, seen.columns - 1);
    const int row = random.integer(0, seen.rows - 1);
    if (seen.at(column, row) == 255) continue;
    ++asked;
    const Result result = vpe({"sight", file, "--json", "-q", "--from", "10,0", "--from-height", "30", "--to",
                               place_of(seen, 10, column, row), "--to-height", "3"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json sight = parse_json(result.out);
    agree += sight["visible"].get<bool>() == (seen.at(column, row) == 1) ? 1 : 0;
    near += std::abs(sight["needed_height_m"].get<double>() - double{needed.at(column, row)}) < 5 ? 1 : 0;
  }
  // The line of sight runs over facets, the viewshed over posts 60 m apart.
  EXPECT_GE(agree, 38);
  EXPECT_GE(near, 38);
}

TEST_F(ViewshedCommand, ALevelSphereEndsAtItsHorizon) {
  const std::string file = path("level.vpe");
  build(file, [](int, int) { return 0.0; });
  const json answer =
      view(file, {"--at", "10,0,10", "--radius", "12000", "--spacing", "100", "-o", path("v.tif")});
  const Pixels p = pixels("v.tif");
  ASSERT_EQ(p.columns, 241);
  const double horizon_m = kSphere_m * std::acos(kSphere_m / (kSphere_m + 10));  // 8242 m
  for (int row = 0; row < p.rows; ++row) {
    for (int column = 0; column < p.columns; ++column) {
      const double distance_m = 100 * std::hypot(column - 120, row - 120);
      if (distance_m > 12000) {
        ASSERT_EQ(p.at(column, row), 255) << column << " " << row;
      } else if (std::abs(distance_m - horizon_m) > 400) {
        // Facets of the planet are up to a few centimetres below the sphere.
        ASSERT_EQ(p.at(column, row), distance_m < horizon_m ? 1 : 0) << column << " " << row;
      }
    }
  }
  EXPECT_NEAR(answer["seen_share"].get<double>(), std::pow(horizon_m / 12000, 2), 0.05);
  EXPECT_NEAR(answer["known_share"].get<double>(), std::numbers::pi / 4, 0.02);
}

TEST_F(ViewshedCommand, ObserversAreCounted) {
  const std::string file = hills();
  const Words rest{"--radius", "6000", "--spacing", "100", "--crs", "IAU_2015:49910"};
  const auto run = [&](const Words& observers, const std::string& name) {
    Words words = rest;
    for (const std::string& observer : observers) words.insert(words.end(), {"--at", observer});
    words.insert(words.end(), {"-o", path(name)});
    return view(file, words);
  };
  const json answer = run({"10,0,20", "10.05,0.03,20"}, "both.tif");
  run({"10,0,20"}, "a.tif");
  run({"10.05,0.03,20"}, "b.tif");
  EXPECT_EQ(answer["observers"].size(), 2U);
  const Pixels both = pixels("both.tif");
  const Pixels parts[] = {pixels("a.tif"), pixels("b.tif")};
  int twice = 0;
  for (int row = 0; row < both.rows; ++row) {
    for (int column = 0; column < both.columns; ++column) {
      float sum = 0;
      bool known = false;
      for (const Pixels& p : parts) {
        const int c = column + static_cast<int>(std::lround((both.to_map[0] - p.to_map[0]) / 100));
        const int r = row - static_cast<int>(std::lround((both.to_map[3] - p.to_map[3]) / 100));
        if (c < 0 || r < 0 || c >= p.columns || r >= p.rows || p.at(c, r) == 255) continue;
        known = true;
        sum += p.at(c, r);
      }
      ASSERT_EQ(both.at(column, row), known ? sum : 255) << column << " " << row;
      twice += known && sum == 2 ? 1 : 0;
    }
  }
  EXPECT_GT(twice, 20);
}

TEST_F(ViewshedCommand, NeededHeightsAreZeroWhereGroundIsSeen) {
  const std::string file = hills();
  view(file, {"--at", "10,0,20", "--radius", "5000", "--spacing", "80", "-o", path("v.tif")});
  view(file, {"--at", "10,0,20", "--radius", "5000", "--spacing", "80", "--needed", "-o", path("n.tif")});
  const Pixels seen = pixels("v.tif");
  const Pixels needed = pixels("n.tif");
  ASSERT_EQ(seen.values.size(), needed.values.size());
  int hidden = 0;
  for (std::size_t n = 0; n < seen.values.size(); ++n) {
    ASSERT_EQ(std::isnan(needed.values[n]), seen.values[n] == 255);
    if (seen.values[n] == 255) continue;
    ASSERT_EQ(needed.values[n] == 0, seen.values[n] == 1);
    hidden += seen.values[n] == 0 ? 1 : 0;
  }
  EXPECT_GT(hidden, 100);
}

TEST_F(ViewshedCommand, ThreadsMakeTheSameBytes) {
  const std::string file = hills();
  const Words words{"--at", "10,0", "--radius", "8000", "--spacing", "50"};
  for (const char* threads : {"1", "3"}) {
    Words more = words;
    more.insert(more.end(), {"--threads", threads, "-o", path(std::string("v") + threads + ".tif")});
    view(file, more);
  }
  EXPECT_EQ(read_text(dir_ / "v1.tif"), read_text(dir_ / "v3.tif"));
}

TEST_F(ViewshedCommand, SaysDatumResolutionErrorAndShares) {
  const std::string file = hills();
  const json answer = view(file, {"--at", "10,0", "--radius", "3000", "-o", path("v.tif")});
  for (const char* key :
       {"datum", "radius_m", "post_spacing_m", "coarsest_post_spacing_m", "resampling_max_m", "sources",
        "nodata_share", "synthetic_share", "seen_share", "known_share", "crs", "illustration"})
    EXPECT_TRUE(answer.contains(key)) << key;
  // Without --spacing, that of the planet at the observer.
  EXPECT_DOUBLE_EQ(answer["spacing_m"].get<double>(), answer["post_spacing_m"].get<double>());
  for (const char* key :
       {"VPE_DATUM", "VPE_BODY", "VPE_POST_SPACING_M", "VPE_ERROR_MAX_M", "VPE_NODATA_PERCENT",
        "VPE_SYNTHETIC_PERCENT", "VPE_SOURCES", "VPE_CRS", "VPE_OBSERVER_0", "VPE_TARGET_HEIGHT_M",
        "VPE_REACH_M", "VPE_VIEWSHED_SPACING_M", "TIFFTAG_SOFTWARE"})
    EXPECT_FALSE(metadata("v.tif", key).empty()) << key;
  const Result text = vpe({"viewshed", file, "--at", "10,0", "--radius", "3000", "-o", path("v.tif")});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_TRUE(says(text.out, {"observer", "seen", "datum", "resolution", "nodata", "synthetic"}));
  EXPECT_TRUE(leftovers().empty());
}

TEST_F(ViewshedCommand, NodataIsNotSeenAndNoPlaceToStand) {
  const std::string file = path("gaps.vpe");
  build(
      file, [](int i, int j) { return i > 170 && j < 150 ? -9999.0 : 0.0; }, -9999);
  const json answer = view(file, {"--at", "10,0", "--radius", "5000", "--spacing", "100", "-o", path("v.tif")});
  EXPECT_GT(answer["nodata_share"].get<double>(), 0.05);
  const Pixels p = pixels("v.tif");
  EXPECT_EQ(p.at(80, 30), 255);
  EXPECT_NE(p.at(30, 80), 255);
  expect_failure(
      {"viewshed", file, "--at", "10.1,0.1", "--radius", "5000", "--spacing", "100", "-o", "w.tif", "-q"}, 1,
      {"10.1,0.1", "no source has data", "choose a place"});
}

TEST_F(ViewshedCommand, RefusesWhatIsWrong) {
  const std::string file = planet().string();
  const auto refuse = [&](const Words& more, const Words& parts, int exit_code = 2) {
    Words words{"viewshed", file};
    words.insert(words.end(), more.begin(), more.end());
    expect_failure(words, exit_code, parts);
  };
  refuse({"--radius", "1000", "-o", "v.tif"}, {"--at"});
  refuse({"--at", "x", "--radius", "1000", "-o", "v.tif"}, {"--at", "x"});
  refuse({"--at", "10,95", "--radius", "1000", "-o", "v.tif"}, {"--at", "95"});
  refuse({"--at", "10,5,-3", "--radius", "1000", "-o", "v.tif"}, {"--at", "10,5,-3", "0 to 1e9"});
  refuse({"--at", "10,5", "-o", "v.tif"}, {"--radius"});
  refuse({"--at", "10,5", "--radius", "9000000", "-o", "v.tif"}, {"--radius", "quarter"});
  refuse({"--at", "10,5", "--radius", "500000", "--spacing", "1", "-o", "v.tif"},
         {"--spacing", "--radius", "million"});
  refuse({"--at", "10,5", "--radius", "1000", "--needed", "--to-height", "2", "-o", "v.tif"},
         {"--needed", "--to-height"});
  refuse({"--at", "10,5", "--radius", "90000", "--spacing", "20000", "--crs", "EPSG:4326", "-o", "v.tif"},
         {"6378137"}, 1);
  write_text(dir_ / "notes.tif", "my notes");
  refuse({"--at", "10,5", "--radius", "90000", "-o", "notes.tif"}, {"notes.tif"}, 1);
  EXPECT_EQ(read_text(dir_ / "notes.tif"), "my notes");
}

}  // namespace
}  // namespace app_test
