// Rasters on a web server that fails at times.
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <random>
#include <utility>

#include "mars/remote/gdal_remote.h"
#include "mars/remote/remote_watch.h"
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
  EXPECT_EQ(mars::raster_name("s3://a/b.tif"), "/vsis3/a/b.tif");
  EXPECT_EQ(mars::raster_name("gs://a/b.tif"), "/vsigs/a/b.tif");
  EXPECT_EQ(mars::raster_name("az://a/b.tif"), "/vsiaz/a/b.tif");
  for (const char* remote : {"/vsis3/a/b.tif", "/vsigs/a/b.tif", "/vsizip//vsiaz/a/b.zip/c.tif"})
    EXPECT_TRUE(mars::is_remote(remote)) << remote;
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

// Variables of GDAL, during the lifetime.
class Environment {
 public:
  explicit Environment(std::vector<std::pair<const char*, std::string>> variables)
      : variables_(std::move(variables)) {
    for (const auto& [name, value] : variables_) ::setenv(name, value.c_str(), 1);
  }
  ~Environment() {
    for (const auto& [name, value] : variables_) ::unsetenv(name);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::vector<std::pair<const char*, std::string>> variables_;
};

TEST_F(Remote, ObjectStoresAreRetried) {
  std::filesystem::create_directory(dir_ / "store");
  std::filesystem::rename(dir_ / "x.tif", dir_ / "store" / "x.tif");
  std::mt19937 random(5);
  HttpServer server(dir_.path(), [&](int, const std::string&) {
    return std::uniform_int_distribution<int>(0, 3)(random) == 0 ? Fate::kUnavailable : Fate::kServe;
  });
  const std::string address = server.url("");
  const Environment variables({{"AWS_S3_ENDPOINT", address.substr(7, address.size() - 8)},
                               {"AWS_HTTPS", "NO"},
                               {"AWS_VIRTUAL_HOSTING", "FALSE"},
                               {"AWS_NO_SIGN_REQUEST", "YES"}});
  EXPECT_EQ(heights("s3://store/x.tif"), heights((dir_ / "store" / "x.tif").string()));
  EXPECT_GT(server.failed(), 2);
  EXPECT_EQ(mars::open_elevation("s3://store/x.tif")->infos().front().name, "/vsis3/store/x.tif");
  const std::string said = message("s3://store/absent.tif");
  EXPECT_NE(said.find("check the address and the network"), std::string::npos) << said;
}

TEST_F(Remote, AbsentCredentialsAreNamedAtOnce) {
  const Environment variables({{"AWS_EC2_METADATA_DISABLED", "YES"},
                               {"CPL_AWS_AUTODETECT_EC2", "NO"},
                               {"AWS_CONFIG_FILE", "/nowhere"},
                               {"CPL_AWS_CREDENTIALS_FILE", "/nowhere"}});
  const std::string said = message("s3://store/x.tif");
  EXPECT_NE(said.find("AWS_NO_SIGN_REQUEST"), std::string::npos) << said;
  EXPECT_NE(said.find("give credentials"), std::string::npos) << said;
}

TEST_F(Remote, WhatIsNoRasterIsSaidToBeNone) {
  std::ofstream(dir_ / "page.tif") << "<html>not a raster</html>";
  const HttpServer server(dir_.path());
  const std::string said = message(server.url("page.tif"));
  EXPECT_NE(said.find("give a raster that gdalinfo can show"), std::string::npos) << said;
  EXPECT_EQ(said.find("the network"), std::string::npos) << said;
}

TEST_F(Remote, AServerThatHangsIsGivenUpAndWatched) {
  const Environment variables({{"GDAL_HTTP_LOW_SPEED_TIME", "1"}, {"GDAL_HTTP_LOW_SPEED_LIMIT", "1"}});
  struct Seen {
    std::mutex mutex;
    std::string address;
    double longest_s = 0;
  };
  const auto seen = std::make_shared<Seen>();
  mars::set_remote_watch([seen](const mars::RemoteWait& wait) {
    const std::lock_guard lock(seen->mutex);
    seen->address = wait.address;
    seen->longest_s = std::max(seen->longest_s, wait.seconds);
  });
  // It hangs at first, and then serves.
  const HttpServer slow(dir_.path(),
                        [](int n, const std::string&) { return n < 2 ? Fate::kHang : Fate::kServe; });
  EXPECT_EQ(heights(slow.url("x.tif")), heights((dir_ / "x.tif").string()));
  EXPECT_EQ(slow.failed(), 2);
  mars::set_remote_watch({});
  const std::lock_guard lock(seen->mutex);
  EXPECT_GT(seen->longest_s, 0.5);
  EXPECT_NE(seen->address.find(slow.url("x.tif")), std::string::npos) << seen->address;
}

// A raster that fills the globe, with overviews, of noise that does not pack.
void write_pyramid(const std::filesystem::path& path) {
  source_files::Raster raster;
  raster.width = 4096;
  raster.height = 2048;
  raster.type = GDT_Int16;
  raster.geotransform = source_files::box(-180, 90, 180, -90, raster.width, raster.height);
  raster.options = {"TILED=YES"};
  raster.value = [](int, int column, int row) {
    return std::round(1000 * std::sin(0.01 * column) * std::cos(0.02 * row)) +
           (column * 7919 + row * 104729) % 13;
  };
  source_files::write(path, raster);
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(path.c_str(), GA_Update));
  const int factors[] = {2, 4, 8, 16};
  dataset->BuildOverviews("AVERAGE", 4, factors, 0, nullptr, nullptr, nullptr);
  GDALClose(dataset);
}

// What is coarse is read from overviews, so that a region costs little more than its own posts.
TEST_F(Remote, CoarsePostsAreReadFromOverviews) {
  write_pyramid(dir_ / "p.tif");
  const HttpServer server(dir_.path());
  const auto local = mars::open_elevation((dir_ / "p.tif").string());
  const auto remote = mars::open_elevation(server.url("p.tif"));
  EXPECT_TRUE(local->infos().front().treatment.empty());
  EXPECT_EQ(remote->infos().front().treatment, "coarse posts from its overviews");
  std::vector<glm::dvec3> coarse;
  for (double lat = -88; lat < 90; lat += 4) {
    for (double lon = 1; lon < 360; lon += 4) coarse.push_back(mars::direction({lon, lat}));
  }
  std::vector<double> expected(coarse.size());
  std::vector<double> got(coarse.size());
  local->sample(coarse, 1e5, expected);
  remote->sample(coarse, 1e5, got);
  // Means over 16 posts differ from the posts by the relief between them: 0.01 and 0.02 rad a post, and noise.
  for (std::size_t n = 0; n < coarse.size(); ++n) EXPECT_NEAR(got[n], expected[n], 220) << n;
  double mean = 0;
  int count = 0;
  remote->visit_means(20000, [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
    EXPECT_EQ(directions.size(), heights_m.size());
    for (const double height : heights_m) mean += height;
    count += static_cast<int>(heights_m.size());
  });
  EXPECT_GT(count, 5000);
  EXPECT_NEAR(mean / count, 6, 20);
  // The whole file has 22 MB.
  EXPECT_LT(server.bytes(), 1'000'000);
  // Fine posts are those of full resolution, to the bit.
  std::vector<glm::dvec3> fine;
  for (double lat = 10; lat < 12; lat += 0.1) {
    for (double lon = 30; lon < 32; lon += 0.1) fine.push_back(mars::direction({lon, lat}));
  }
  expected.resize(fine.size());
  got.resize(fine.size());
  local->sample(fine, 5000, expected);
  remote->sample(fine, 5000, got);
  EXPECT_EQ(got, expected);
  // So are the posts of a region, which alone are read.
  const mars::Cap cap{mars::direction({31, 11}), 0.02};
  const auto wanted = [&](const mars::Cap& at) {
    return mars::angle_between_rad(at.centre, cap.centre) <= at.radius_rad + cap.radius_rad;
  };
  std::vector<double> posts;
  const auto keep = [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
    for (std::size_t n = 0; n < directions.size(); ++n)
      if (mars::angle_between_rad(directions[n], cap.centre) <= cap.radius_rad) posts.push_back(heights_m[n]);
  };
  local->visit_posts(2'000'000, keep);
  const std::vector<double> of_local = std::exchange(posts, {});
  remote->visit_posts_in(2'000'000, wanted, keep);
  EXPECT_EQ(posts, of_local);
  EXPECT_GT(posts.size(), 50U);
  EXPECT_LT(server.bytes(), 2'500'000);
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
