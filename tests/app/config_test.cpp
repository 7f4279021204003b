// --config FILE.
#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

class Config : public AppTest {
 protected:
  // What a query says with this file: whether --json took effect shows which options were read.
  Result query(const std::string& toml, const Words& more = {}) const {
    write_text(dir_ / "c.toml", toml);
    Words words{"query", planet().string(), "10,20", "--config", "c.toml"};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }
  void expect_error(const std::string& toml, const Words& parts) const {
    const Result result = query(toml);
    EXPECT_EQ(result.exit_code, 2) << toml;
    EXPECT_TRUE(says(result.err, parts));
    EXPECT_EQ(result.out, "");
  }
};

TEST_F(Config, TopAndTable) {
  EXPECT_EQ(query("").out.find("lon_deg,lat_deg"), 0U);
  EXPECT_EQ(parse_json(query("json = true\n").out).size(), 1U);
  EXPECT_EQ(parse_json(query("# mine\n[query]\njson = true\nmemory = 128\n").out).size(), 1U);
  EXPECT_EQ(query("json = false\n").out.find("lon_deg,lat_deg"), 0U);
  EXPECT_EQ(query("json = true\n[query]\njson = false\n").out.find("lon_deg"), 0U);
  // Of other commands: at the top and in their tables.
  EXPECT_EQ(query("fov = 40\nset = ['mode=lit']\n[render]\njson = true\n").out.find("lon_deg,lat_deg"), 0U);
}

TEST_F(Config, CommandLineWins) {
  EXPECT_EQ(query("memory = 1\n").exit_code, 2);
  EXPECT_EQ(query("memory = 1\n", {"--memory", "128"}).exit_code, 0);
}

TEST_F(Config, RequiredOptionsMayStandThere) {
  write_dem(dir_ / "x.tif");
  write_text(
      dir_ / "c.toml",
      "[build]\noutput = 'x.vpe'\nbase-spacing = 1e5\nquiet = true\nregion = ['0,0,9,9', '-9,-9,0,0']\n");
  const Result result = vpe({"build", "x.tif", "--config", "c.toml"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(exists("x.vpe"));
}

TEST_F(Config, Errors) {
  expect_error("\nbogus = 3\n", {"c.toml:2", "--bogus", "no command"});
  expect_error("[query]\njson = true\nsize = '9x9'\n", {"c.toml:3", "'query'", "--size"});
  expect_error("[render]\nplanets = 9\n", {"c.toml:2", "'render'", "--planets"});
  expect_error("[rendr]\nfov = 9\n", {"c.toml:1", "[rendr]", "not a command"});
  expect_error("memory = 'lots'\n", {"c.toml:1", "--memory", "lots"});
  expect_error("json = 3\n", {"c.toml:1", "json", "true or false"});
  expect_error("memory = 1979-05-27\n", {"c.toml:1", "memory", "expected"});
  expect_error("memory = = 3 [[\n", {"c.toml:1", "not TOML"});
  expect_error("config = 'd.toml'\n", {"c.toml:1", "--config"});
  expect_failure({"query", "x.vpe", "1,2", "--config", "none.toml"}, 2,
                 {"--config none.toml", "No such file", "check the name"});
  expect_failure({"query", "x.vpe", "1,2", "--config", "."}, 2, {"--config .", "Is a directory"});
}

}  // namespace
}  // namespace app_test
