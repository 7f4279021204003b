// --config FILE, the files of the user and the system, and the environment.
#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

// Returns a key of many parts: the library makes tables in tables of it, and their destructors exhaust the stack.
std::string many_parts(int count) {
  std::string text = "a";
  for (int n = 1; n < count; ++n) text += ".a";
  return text + " = 1\n";
}

class Config : public AppTest {
 protected:
  // Runs a query with this file: whether --json took effect shows which options were read.
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
  // Options of other commands, at the top and in their tables, have no effect.
  EXPECT_EQ(query("fov = 40\nset = ['mode=lit']\n[render]\njson = true\n").out.find("lon_deg,lat_deg"), 0U);
}

// A command of two words has a table within a table.
TEST_F(Config, CommandsOfTwoWords) {
  EXPECT_EQ(query("[report.error-time]\nrounds = 3\n").out.find("lon_deg,lat_deg"), 0U);
  expect_error("[report.error-time]\nround = 3\n", {"c.toml:2", "'report error-time'", "--round"});
  expect_error("[report]\nrounds = 3\n", {"c.toml:2", "'report'", "--rounds"});
  expect_error("[report.none]\nrounds = 3\n", {"c.toml:1", "[report none]", "not a command"});
  write_text(dir_ / "two.toml", "[report.error-time]\nview = 'moon'\noutput = 'there'\n");
  expect_failure({"report", "error-time", planet().string(), "--config", "two.toml"}, 2, {"--view 'moon'"});
  EXPECT_TRUE(exists("there"));
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
  expect_error(many_parts(200'000), {"c.toml:1", "fewer dots"});
  expect_error("config = 'd.toml'\n", {"c.toml:1", "--config"});
  expect_failure({"query", "x.vpe", "1,2", "--config", "none.toml"}, 2,
                 {"none.toml", "configuration", "No such file", "check the name"});
  expect_failure({"query", "x.vpe", "1,2", "--config", "."}, 2,
                 {".: cannot read the configuration", "Is a directory"});
}

// Precedence of the user's file, the system's files and the environment.
class ConfigOrder : public AppTest {
 protected:
  void write_config(const std::string& folder, const std::string& toml) const {
    std::filesystem::create_directories(dir_ / folder / "vpe");
    write_text(dir_ / folder / "vpe" / "config.toml", toml);
  }
  Result query(const std::map<std::string, std::string>& environment, const Words& more = {}) const {
    Words words{"query", planet().string(), "10,20"};
    words.insert(words.end(), more.begin(), more.end());
    Command command = command_for(words);
    for (const auto& [key, value] : environment) command.environment[key] = value;
    return run(command);
  }
  bool is_json(const std::map<std::string, std::string>& environment, const Words& more = {}) const {
    const Result result = query(environment, more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out.find("lon_deg,lat_deg") != 0U;
  }
};

TEST_F(ConfigOrder, UserBeforeSystem) {
  const std::map<std::string, std::string> both{{"XDG_CONFIG_HOME", path("user")},
                                                {"XDG_CONFIG_DIRS", path("one") + ":" + path("two")}};
  EXPECT_FALSE(is_json(both));
  write_config("two", "json = true\n");
  EXPECT_TRUE(is_json(both));
  write_config("one", "json = false\n");
  EXPECT_FALSE(is_json(both));
  write_config("user", "[query]\njson = true\n");
  EXPECT_TRUE(is_json(both));
  // The file of --config overrides the user's file, and the command line overrides it.
  write_text(dir_ / "project.toml", "json = false\n");
  EXPECT_FALSE(is_json(both, {"--config", "project.toml"}));
  EXPECT_TRUE(is_json(both, {"--config", "project.toml", "--json"}));
  // Other commands read it too; --version reads nothing.
  write_config("user", "jsno = true\n");
  Result result = query(both);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(says(result.err, {path("user") + "/vpe/config.toml:1", "--jsno"}));
  Command version = command_for({"--version"});
  version.environment["XDG_CONFIG_HOME"] = path("user");
  EXPECT_EQ(run(version).exit_code, 0);
}

TEST_F(ConfigOrder, HomeCountsWhereTheVariableIsNotSetOrNotAbsolute) {
  write_config("home/.config", "json = true\n");
  write_config("relative", "bogus = true\n");
  EXPECT_TRUE(is_json({}));
  EXPECT_TRUE(is_json({{"XDG_CONFIG_HOME", ""}}));
  EXPECT_TRUE(is_json({{"XDG_CONFIG_HOME", "relative"}}));
  EXPECT_TRUE(is_json({{"XDG_CONFIG_DIRS", "relative"}}));
  EXPECT_FALSE(is_json({{"XDG_CONFIG_HOME", path("none")}}));
  EXPECT_FALSE(is_json({{"HOME", ""}}));
}

TEST_F(ConfigOrder, Environment) {
  EXPECT_EQ(query({{"VPE_MEMORY", "128"}}).exit_code, 0);
  const Result result = query({{"VPE_MEMORY", "1"}});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(says(result.err, {"VPE_MEMORY", "64"}));
  EXPECT_EQ(query({{"VPE_THREADS", "two"}}).exit_code, 2);
  EXPECT_EQ(query({{"VPE_MEMORY", ""}}).exit_code, 0);
  // The environment overrides the files, and the command line overrides the environment.
  write_config("home/.config", "memory = 1\n");
  EXPECT_EQ(query({}).exit_code, 2);
  EXPECT_EQ(query({{"VPE_MEMORY", "128"}}).exit_code, 0);
  EXPECT_EQ(query({{"VPE_MEMORY", "1"}}, {"--memory", "128"}).exit_code, 0);
}

}  // namespace
}  // namespace app_test
