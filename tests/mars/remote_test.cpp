// Rasters on a web server that fails at times.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <random>

#include "mars/raster/gdal_remote.h"
#include "mars/sources/source.h"
#include "tests/mars/source_files.h"
#include "tests/support/http_server.h"
#include "tests/support/support.h"

namespace {

using test_support::HttpServer;
using Fate = HttpServer::Fate;

class Remote : public testing::Test {
 protected:
  static void SetUpTestSuite() { ::setenv("GDAL_HTTP_RETRY_DELAY", "0.001", 1); }
  static void TearDownTestSuite() { ::unsetenv("GDAL_HTTP_RETRY_DELAY"); }

  void SetUp() override { write_hills(dir_ / "x.tif"); }
  static void write_hills(const std::filesystem::path& path);

  // Returns heights over the whole raster, in its own order.
  static std::vector<double> heights(const std::string& name) {
    const auto source = mars::open_elevation(name);
    std::vector<glm::dvec3> directions;
    for (double lat = -88; lat < 90; lat += 4) {
      for (double lon = 1; lon < 360; lon += 5) directions.push_back(mars::direction({lon, lat}));
    }
    std::vector<double> out(directions.size());
    source->sample(directions, 1000, out);
    return out;
  }
  static std::string message(const std::string& name) {
    try {
      heights(name);
    } catch (const mars::SourceError& e) {
      return e.what();
    }
    return "no error";
  }

  test_support::TempDir dir_;
};

void Remote::write_hills(const std::filesystem::path& path) {
  source_files::Raster raster;
  raster.width = 1440;
  raster.height = 720;
  raster.type = GDT_Int16;
  raster.geotransform = source_files::box(-180, 90, 180, -90, raster.width, raster.height);
  raster.options = {"TILED=YES"};
  raster.value = [](int, int column, int row) {
    return std::round(1000 * std::sin(0.05 * column) * std::cos(0.07 * row)) + column % 7;
  };
  source_files::write(path, raster);
}

TEST_F(Remote, UrlsBecomeGdalNames) {
  EXPECT_EQ(mars::raster_name("http://a/b.tif"), "/vsicurl/http://a/b.tif");
  EXPECT_EQ(mars::raster_name("https://a/b.tif"), "/vsicurl/https://a/b.tif");
  EXPECT_EQ(mars::raster_name("/vsicurl/http://a/b.tif"), "/vsicurl/http://a/b.tif");
  EXPECT_EQ(mars::raster_name("http.tif"), "http.tif");
  EXPECT_TRUE(mars::is_remote("/vsizip/vsicurl/http://a/b.zip/c.tif"));
  EXPECT_FALSE(mars::is_remote("a/b.tif"));
}

TEST_F(Remote, EqualsTheLocalFile) {
  const HttpServer server(dir_.path());
  EXPECT_EQ(heights(server.url("x.tif")), heights((dir_ / "x.tif").string()));
  const auto info = mars::open_elevation(server.url("x.tif"))->infos().front();
  EXPECT_EQ(info.name, "/vsicurl/" + server.url("x.tif"));
  EXPECT_EQ(info.size_bytes, static_cast<std::int64_t>(std::filesystem::file_size(dir_ / "x.tif")));
  EXPECT_GT(info.mtime_s, 0);
}

TEST_F(Remote, TransientFailuresAreRetried) {
  const auto local = heights((dir_ / "x.tif").string());
  for (const Fate fate : {Fate::kUnavailable, Fate::kHangUp, Fate::kCut}) {
    SCOPED_TRACE(static_cast<int>(fate));
    std::mt19937 random(5);
    HttpServer server(dir_.path(), [&](int, const std::string&) {
      return std::uniform_int_distribution<int>(0, 3)(random) == 0 ? fate : Fate::kServe;
    });
    EXPECT_EQ(heights(server.url("x.tif")), local);
    EXPECT_GT(server.failed(), 2);
  }
}

TEST_F(Remote, PermanentFailuresNameTheAddress) {
  for (const Fate fate : {Fate::kUnavailable, Fate::kHangUp, Fate::kForbidden}) {
    SCOPED_TRACE(static_cast<int>(fate));
    bool well = true;
    HttpServer server(dir_.path(), [&](int, const std::string&) { return well ? Fate::kServe : fate; });
    well = false;
    const std::string said = message(server.url("x.tif"));
    EXPECT_NE(said.find(server.url("x.tif") + ": cannot open"), std::string::npos) << said;
    EXPECT_NE(said.find("check the address and the network"), std::string::npos) << said;
    if (fate == Fate::kForbidden) {
      EXPECT_NE(said.find("403"), std::string::npos) << said;
      EXPECT_LT(server.requests(), 8);  // asked once, not over and over
    }
  }
  const HttpServer server(dir_.path());
  const std::string said = message(server.url("absent.tif"));
  EXPECT_NE(said.find("absent.tif: cannot open"), std::string::npos) << said;
  EXPECT_NE(said.find("404"), std::string::npos) << said;
}

TEST_F(Remote, AServerThatStaysUnavailableEndsTheReading) {
  std::atomic<bool> well{true};
  HttpServer server(dir_.path(),
                    [&](int, const std::string&) { return well ? Fate::kServe : Fate::kUnavailable; });
  const auto source = mars::open_elevation(server.url("x.tif"));
  well = false;
  std::vector<double> height(1);
  try {
    source->sample(std::vector{mars::direction({100, 10})}, 1000, height);
    FAIL();
  } catch (const mars::SourceError& e) {
    EXPECT_NE(std::string(e.what()).find(server.url("x.tif") + ": cannot read rows"), std::string::npos)
        << e.what();
  }
  well = true;
  source->sample(std::vector{mars::direction({100, 10})}, 1000, height);
  EXPECT_TRUE(std::isfinite(height.front()));
}

}  // namespace
