// vpe build from a web server.
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

}  // namespace
}  // namespace app_test
