// vpe build from a web server.
#include <atomic>
#include <chrono>
#include <csignal>
#include <random>

#include "tests/app/support/app_fixture.h"
#include "tests/support/http_server.h"

namespace app_test {
namespace {

using test_support::HttpServer;
using Fate = HttpServer::Fate;

class Remote : public AppTest {
 protected:
  void write_global_dem(double cell_deg) const {
    Dem dem;
    dem.cell_deg = cell_deg;
    dem.width = static_cast<int>(360 / cell_deg);
    dem.height = static_cast<int>(180 / cell_deg);
    write_dem(dir_ / "x.tif", dem);
  }
  Result build(const std::string& dem, const std::string& output) const {
    Command command = command_for({"build", dem, "-o", output, "--base-spacing", "60000", "--json"});
    command.environment["GDAL_HTTP_RETRY_DELAY"] = "0.001";
    return run(command);
  }
};

TEST_F(Remote, EqualsTheLocalBuildAlthoughTheServerFails) {
  write_dem(dir_ / "x.tif");
  std::mt19937 random(7);
  HttpServer server(dir_.path(), [&](int, const std::string&) {
    return std::uniform_int_distribution<int>(0, 2)(random) == 0 ? Fate::kUnavailable : Fate::kServe;
  });
  const Result local = build("x.tif", "local.vpe");
  const Result remote = build(server.url("x.tif"), "remote.vpe");
  ASSERT_EQ(remote.exit_code, 0) << remote.err;
  EXPECT_EQ(parse_json(remote.out)["identity"], parse_json(local.out)["identity"]);
  EXPECT_EQ(parse_json(remote.out)["sources"][0]["name"], "/vsicurl/" + server.url("x.tif"));
  EXPECT_GT(server.failed(), 0);
}

TEST_F(Remote, MissingFilesAreNamed) {
  const HttpServer server(dir_.path());
  const Result result = build(server.url("absent.tif"), "x.vpe");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, {server.url("absent.tif"), "cannot open", "404", "check the address"}));
  EXPECT_FALSE(exists("x.vpe"));
}

TEST_F(Remote, AServerThatHangsCanBeStopped) {
  write_dem(dir_ / "x.tif");
  std::atomic<bool> is_hanging{false};
  // The header is served, so that the build has begun.
  const HttpServer server(dir_.path(), [&](int n, const std::string&) {
    is_hanging = n > 12;
    return n > 12 ? Fate::kHang : Fate::kServe;
  });
  for (const char* command : {"build", "info"}) {
    is_hanging = false;
    Command stopped = std::string(command) == "build"
                          ? command_for({"build", server.url("x.tif"), "-o", "x.vpe"})
                          : command_for({"info", server.url("x.tif")});
    stopped.signal = SIGTERM;
    stopped.when = [&] { return is_hanging.load(); };
    const auto begin = std::chrono::steady_clock::now();
    const Result result = run(stopped);
    EXPECT_TRUE(result.signalled);
    EXPECT_TRUE(result.exit_code == 143 || result.signal == SIGTERM) << result.exit_code << result.err;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
  }
}

// SIGTERM while GDAL waits inside the build, where signals only set a flag. The raster is larger than the memory, so
// that the build reads it again.
TEST_F(Remote, ABuildThatWaitsCanBeStopped) {
  write_global_dem(0.0625);
  std::atomic<bool> is_hanging{false};
  std::chrono::steady_clock::time_point stopped_at;
  const HttpServer server(dir_.path(), [&](int, const std::string&) {
    if (exists("x.vpe.part")) is_hanging = true;
    return is_hanging ? Fate::kHang : Fate::kServe;
  });
  Command build =
      command_for({"build", server.url("x.tif"), "-o", "x.vpe", "--memory", "64", "--base-spacing", "20000"});
  build.signal = SIGTERM;
  build.when = [&] {
    stopped_at = std::chrono::steady_clock::now();
    return is_hanging.load();
  };
  const Result result = run(build);
  EXPECT_TRUE(result.signalled);
  EXPECT_EQ(result.exit_code, 143) << result.signal << result.err;
  EXPECT_TRUE(says(result.err, {"stopped while waiting for " + server.url("x.tif")})) << result.err;
  EXPECT_LT(std::chrono::steady_clock::now() - stopped_at, std::chrono::seconds(60));
  EXPECT_TRUE(exists("x.vpe.part"));
}

// The posts of a part are all that its check reads.
TEST_F(Remote, PartsSumUpToTheWhole) {
  write_global_dem(0.5);
  const HttpServer server(dir_.path());
  const Words words{"build", server.url("x.tif"), "-o", "x.vpe", "--base-spacing", "60000", "--json"};
  nlohmann::json whole = parse_json(vpe(words).out);
  std::filesystem::remove(dir_ / "x.vpe");
  for (const char* part : {"1/3", "2/3", "3/3"}) {
    Words more = words;
    more.insert(more.end(), {"--part", part});
    EXPECT_EQ(vpe(more).exit_code, 0);
  }
  const Result merged = vpe({"merge", "x.1-of-3.vpe", "x.2-of-3.vpe", "x.3-of-3.vpe", "-o", "x.vpe", "--json"});
  const nlohmann::json joined = parse_json(merged.out);
  for (const char* equal : {"identity", "resampling_max_m", "resampling_rms_m", "resampling_posts"})
    EXPECT_EQ(joined[equal], whole[equal]) << equal;
}

TEST_F(Remote, PlanetFilesAreToBeFetched) {
  std::filesystem::copy_file(planet(), dir_ / "x.vpe");
  const HttpServer server(dir_.path());
  const std::string url = server.url("x.vpe");
  for (const Words& words : {Words{"info", url}, Words{"verify", url}, Words{"query", url, "1,2"},
                             Words{"merge", url, "-o", "y.vpe"}, Words{"info", "s3://a/x.vpe"}})
    expect_failure(words, 1, {"planet files are read from a disk", "fetch it first"});
}

}  // namespace
}  // namespace app_test
