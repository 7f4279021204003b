// The cache of planets that commands build from rasters.
#include <fcntl.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>
#include <utility>

#include "tests/app/support/app_fixture.h"
#include "tests/support/http_server.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;

// Writes a raster of one height on a sphere of 100 km, whose planet has six tiles and takes a moment to build.
void write_flat(const fs::path& path, double height_m) {
  Dem dem;
  dem.height_m = [height_m](int, int) { return height_m; };
  write_dem(path, dem);
  const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
  ASSERT_TRUE(file);
  OGRSpatialReference crs;
  crs.SetFromUserInput("+proj=longlat +R=100000 +no_defs");
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  ASSERT_EQ(file->SetSpatialRef(&crs), CE_None);
}

class Cache : public AppTest {
 protected:
  double height(const std::string& raster, const std::string& folder = "") const {
    Command command = command_for({"query", raster, "30,10", "--json"});
    if (!folder.empty()) command.folder = dir_ / folder;
    const Result result = run(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? parse_json(result.out)[0]["elevation_m"].get<double>() : -1;
  }
  std::size_t planets() const {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(dir_ / "cache" / "vpe"))
      count += entry.path().extension() == ".vpe" ? 1 : 0;
    return count;
  }
  static void write_vrt(const fs::path& vrt, const fs::path& raster) {
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> from(GDALDataset::Open(raster.c_str()));
    const std::unique_ptr<GDALDataset> copy(GetGDALDriverManager()->GetDriverByName("VRT")->CreateCopy(
        vrt.c_str(), from.get(), 0, nullptr, nullptr, nullptr));
    ASSERT_TRUE(copy);
  }
  // Puts another raster of the same size in place, as old as `age` ago, as tools do that keep times.
  void replace(const std::string& name, double height_m, std::chrono::nanoseconds age) const {
    const auto before = fs::file_size(dir_ / name);
    write_flat(dir_ / name, height_m);
    ASSERT_EQ(fs::file_size(dir_ / name), before);
    fs::last_write_time(dir_ / name, fs::file_time_type::clock::now() -
                                         std::chrono::duration_cast<fs::file_time_type::duration>(age));
  }
};

TEST_F(Cache, PartsOfMosaicsThatAreOlderThanTheMosaic) {
  write_flat(dir_ / "data.tif", 1000);
  write_vrt(dir_ / "m.vrt", dir_ / "data.tif");
  write_vrt(dir_ / "outer.vrt", dir_ / "m.vrt");
  EXPECT_NEAR(height("m.vrt"), 1000, 5);
  EXPECT_NEAR(height("outer.vrt"), 1000, 5);
  EXPECT_EQ(planets(), 2U);
  EXPECT_NEAR(height("m.vrt"), 1000, 5);
  EXPECT_EQ(planets(), 2U) << "what has not changed is not built again";
  replace("data.tif", 5000, std::chrono::hours(24));
  EXPECT_NEAR(height("m.vrt"), 5000, 5);
  EXPECT_NEAR(height("outer.vrt"), 5000, 5);
}

TEST_F(Cache, ChangesWithinASecond) {
  write_flat(dir_ / "data.tif", 1000);
  const auto second = fs::file_time_type::clock::now() - std::chrono::hours(1);
  fs::last_write_time(dir_ / "data.tif", second);
  EXPECT_NEAR(height("data.tif"), 1000, 5);
  write_flat(dir_ / "data.tif", 5000);
  fs::last_write_time(dir_ / "data.tif", second + std::chrono::nanoseconds(1000));
  EXPECT_NEAR(height("data.tif"), 5000, 5);
}

TEST_F(Cache, NamesThatAreNotPathsBelongToTheirFolder) {
  const auto time = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (const auto& [folder, height_m] : {std::pair{"d1", 1000.0}, std::pair{"d2", 5000.0}}) {
    fs::create_directory(dir_ / folder);
    write_flat(dir_ / folder / "dem.tif", height_m);
    fs::last_write_time(dir_ / folder / "dem.tif", time);
  }
  EXPECT_NEAR(height("GTIFF_DIR:1:dem.tif", "d1"), 1000, 5);
  EXPECT_NEAR(height("GTIFF_DIR:1:dem.tif", "d2"), 5000, 5);
}

TEST_F(Cache, ServersThatDoNotStateTimes) {
  write_flat(dir_ / "x.tif", 1000);
  const test_support::HttpServer server(dir_.path(), {}, false);
  EXPECT_NEAR(height(server.url("x.tif")), 1000, 5);
  replace("x.tif", 5000, {});
  EXPECT_NEAR(height(server.url("x.tif")), 5000, 5);
  EXPECT_EQ(planets(), 1U) << "one file for a name, however often it is built";
}

TEST_F(Cache, UrlsAreTheSameInEveryFolder) {
  write_flat(dir_ / "x.tif", 1000);
  const test_support::HttpServer server(dir_.path());
  for (const char* folder : {"d1", "d2"}) {
    fs::create_directory(dir_ / folder);
    EXPECT_NEAR(height(server.url("x.tif"), folder), 1000, 5);
  }
  EXPECT_EQ(planets(), 1U);
}

TEST_F(Cache, ThatMayNotBeWrittenToIsRead) {
  if (::geteuid() == 0) {
    // Root may write anywhere: a lock file that cannot be opened has the same effect.
    write_flat(dir_ / "data.tif", 1000);
    EXPECT_NEAR(height("data.tif"), 1000, 5);
    for (const auto& entry : fs::directory_iterator(dir_ / "cache" / "vpe")) {
      if (entry.path().extension() != ".lock") continue;
      const fs::path lock = entry.path();
      fs::remove(lock);
      fs::create_directory(lock);
    }
  } else {
    write_flat(dir_ / "data.tif", 1000);
    EXPECT_NEAR(height("data.tif"), 1000, 5);
    fs::permissions(dir_ / "cache" / "vpe", fs::perms::owner_read | fs::perms::owner_exec);
  }
  EXPECT_NEAR(height("data.tif"), 1000, 5);
  // What is not there must be built: refused with what to do.
  if (::geteuid() != 0) {
    write_flat(dir_ / "other.tif", 2000);
    expect_failure({"query", "other.tif", "30,10"}, 1, {".lock", "cannot open", "XDG_CACHE_HOME", "vpe build"});
  }
  fs::permissions(dir_ / "cache" / "vpe", fs::perms::owner_all);
}

TEST_F(Cache, AWaitForAnotherBuildIsTold) {
  write_flat(dir_ / "flat.tif", 700);
  EXPECT_NEAR(height("flat.tif"), 700, 5);
  fs::path lock;
  for (const auto& entry : fs::recursive_directory_iterator(dir_.path()))
    if (entry.path().extension() == ".lock") lock = entry.path();
  ASSERT_FALSE(lock.empty());
  for (const auto& entry : fs::directory_iterator(lock.parent_path()))
    if (entry.path().extension() == ".vpe") fs::remove(entry.path());
  int file = ::open(lock.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(file, 0);
  ASSERT_EQ(::flock(file, LOCK_EX), 0);
  Command query = command_for({"query", "flat.tif", "30,10", "--json"});
  query.watch = [&file](const std::string& err) {
    if (file >= 0 && err.find("another vpe is building") != std::string::npos) ::close(std::exchange(file, -1));
  };
  const Result result = run(query);
  if (file >= 0) ::close(file);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("another vpe is building"), std::string::npos) << result.err;
}

// GeoPackages are SQLite files as planets are.
TEST_F(Cache, GeoPackagesAreRasters) {
  write_flat(dir_ / "data.tif", 1000);
  {
    const std::unique_ptr<GDALDataset> from(GDALDataset::Open((dir_ / "data.tif").c_str()));
    const std::unique_ptr<GDALDataset> copy(GetGDALDriverManager()->GetDriverByName("GPKG")->CreateCopy(
        (dir_ / "data.gpkg").c_str(), from.get(), 0, nullptr, nullptr, nullptr));
    ASSERT_TRUE(copy);
  }
  EXPECT_NEAR(height("data.gpkg"), 1000, 5);
  // A planet file needs no ending.
  fs::copy_file(planet(), dir_ / "planet.db");
  EXPECT_EQ(vpe({"info", "planet.db"}).exit_code, 0);
}

TEST_F(Cache, InfoNamesTheRaster) {
  const std::string name = "two\nlines.tif";
  write_flat(dir_ / name, 1000);
  const Result result = vpe({"info", name});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.out, {"raster             two\\nlines.tif\n", "its planet file"}));
  EXPECT_EQ(parse_json(vpe({"info", name, "--json"}).out)["raster"], name);
  EXPECT_TRUE(parse_json(vpe({"info", planet().string(), "--json"}).out)["raster"].is_null());
}

TEST_F(Cache, NamesThatAreNotUtf8) {
  const std::string name = "caf\xe9.tif";
  write_flat(dir_ / name, 1000);
  EXPECT_NEAR(height(name), 1000, 5);
  const Result built = vpe({"build", name, "-o", "caf\xe9.vpe", "--base-spacing", "100000", "--json"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  EXPECT_EQ(parse_json(built.out)["sources"][0]["name"], "caf\xef\xbf\xbd.tif");
  EXPECT_EQ(vpe({"verify", "caf\xe9.vpe"}).exit_code, 0);
  const Result drawn = vpe({"panorama", "caf\xe9.vpe", "--at", "10,10", "--height", "1000", "-o", "caf\xe9.png",
                            "--width", "256", "-q"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  const Result seen = vpe({"overlook", "caf\xe9.png", "--view", "10,0", "--size", "64x48", "-o", "view.png"});
  EXPECT_EQ(seen.exit_code, 0) << seen.err;
}

}  // namespace
}  // namespace app_test
