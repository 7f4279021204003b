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
