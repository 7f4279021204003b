#include "tests/app/support/app_fixture.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>

namespace app_test {

namespace fs = std::filesystem;

void write_dem(const fs::path& path, const Dem& dem) {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const GDALDataType type = dem.height_m ? GDT_Float32 : GDT_Int16;
  const std::unique_ptr<GDALDataset> file(
      driver->Create(path.c_str(), dem.width, dem.height, 1, type, nullptr));
  if (file == nullptr) throw std::runtime_error("cannot make " + path.string());
  if (dem.georeference) {
    OGRSpatialReference crs;
    crs.SetFromUserInput(("+proj=longlat +R=" + std::to_string(dem.radius_m) + " +no_defs").c_str());
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    file->SetSpatialRef(&crs);
    double transform[6] = {dem.west_deg, dem.cell_deg, 0, dem.north_deg, 0, -dem.cell_deg};
    file->SetGeoTransform(transform);
  }
  GDALRasterBand* band = file->GetRasterBand(1);
  if (dem.no_data) band->SetNoDataValue(*dem.no_data);
  std::vector<double> line(static_cast<std::size_t>(dem.width));
  for (int row = 0; row < dem.height; ++row) {
    for (int column = 0; column < dem.width; ++column) {
      const double turn = 2 * std::numbers::pi * column / dem.width;
      line[static_cast<std::size_t>(column)] =
          dem.height_m
              ? dem.height_m(column, row)
              : std::round(3000 * std::sin(3 * turn) * std::sin(std::numbers::pi * (row + 0.5) / dem.height));
    }
    if (band->RasterIO(GF_Write, 0, row, dem.width, 1, line.data(), dem.width, 1, GDT_Float64, 0, 0, nullptr) !=
        CE_None) {
      throw std::runtime_error("cannot write " + path.string());
    }
  }
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void damage_payloads(const fs::path& planet, const std::string& table) {
  struct Closer {
    void operator()(sqlite3* file) const { sqlite3_close(file); }
  };
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(planet.c_str(), &opened, SQLITE_OPEN_READWRITE, nullptr);
  const std::unique_ptr<sqlite3, Closer> file(opened);
  const std::string sql = "UPDATE " + table +
                          " SET data = CAST(substr(data, 1, length(data) / 2) || x'5a5a5a5a' || "
                          "substr(data, length(data) / 2 + 5) AS BLOB)";
  if (code != SQLITE_OK || sqlite3_exec(opened, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw std::runtime_error("cannot damage " + planet.string() + ": " + sqlite3_errmsg(opened));
  }
  if (sqlite3_total_changes(opened) == 0) throw std::runtime_error(table + " is empty in " + planet.string());
}

::testing::AssertionResult says(const std::string& message, const Words& parts) {
  for (const std::string& part : parts) {
    if (message.find(part) == std::string::npos) {
      return ::testing::AssertionFailure() << "'" << part << "' is not in: " << message;
    }
  }
  return ::testing::AssertionSuccess();
}

Command AppTest::command_for(const Words& arguments) const {
  Command command;
  command.program = VPE_PROGRAM;
  command.arguments = arguments;
  command.folder = dir_.path();
  command.environment = {{"XDG_CACHE_HOME", path("cache")},
                         {"XDG_CONFIG_HOME", ""},
                         {"XDG_CONFIG_DIRS", "none"},
                         {"HOME", path("home")},
                         {"VPE_MEMORY", ""},
                         {"VPE_THREADS", ""}};
  return command;
}

Result AppTest::vpe(const Words& arguments, const std::string& input) const {
  Command command = command_for(arguments);
  command.input = input;
  return app_test::run(command);
}

void AppTest::expect_failure(const Words& arguments, int exit_code, const Words& parts) const {
  std::string line = "vpe";
  for (const std::string& word : arguments) line += " " + word;
  SCOPED_TRACE(line);
  const Result result = vpe(arguments);
  EXPECT_EQ(result.exit_code, exit_code) << "signal " << result.signal;
  EXPECT_TRUE(says(result.err, parts));
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(leftovers(), Words{});
}

const fs::path& AppTest::planet() {
  struct Planet {
    test_support::TempDir dir;
    fs::path path = dir / "small.vpe";
    Planet() {
      write_dem(dir / "hills.tif");
      Command command;
      command.program = VPE_PROGRAM;
      command.arguments = {
          "build", (dir / "hills.tif").string(), "-o", path.string(), "--base-spacing", "100000", "-q"};
      const Result result = app_test::run(command);
      if (result.exit_code != 0) throw std::runtime_error("cannot build the test planet: " + result.err);
    }
  };
  static const Planet kPlanet;
  return kPlanet.path;
}

std::vector<std::string> AppTest::leftovers() const {
  std::vector<std::string> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(dir_.path())) {
    const std::string name = entry.path().filename().string();
    for (const char* mark : {".part", ".tmp", "-wal", "-shm", "-journal"}) {
      if (name.find(mark) != std::string::npos) found.push_back(name);
    }
  }
  return found;
}

nlohmann::json parse_json(const std::string& text) {
  nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << "not JSON: " << text;
  return json;
}

std::string small_flight(const std::string& view) {
  return "flight 1\nview " + view +
         "\nat 0 set mode=coloured sun.azimuth=200 sun.elevation=40\n"
         "at 0 pose lon=-74 lat=-13 alt=500000 yaw=20 pitch=-40\n"
         "at 2 pose lon=-60 lat=-10 alt=400000 yaw=60 pitch=-30\n";
}

}  // namespace app_test
