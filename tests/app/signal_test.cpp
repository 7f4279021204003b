// SIGINT and SIGTERM while a planet is built.
#include <csignal>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

class Signals : public AppTest {
 protected:
  static bool holds_part(const std::filesystem::path& folder) {
    std::error_code none;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, none)) {
      if (entry.path().extension() == ".part") return true;
    }
    return false;
  }
};

TEST_F(Signals, StopABuild) {
  write_dem(dir_ / "x.tif");
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
    Command command = command_for({"build", "x.tif", "-o", "x.vpe"});  // minutes of work
    command.signal = signal;
    command.when = [&] { return holds_part(dir_.path()); };
    const Result result = run(command);
    EXPECT_TRUE(result.signalled);
    EXPECT_EQ(result.exit_code, code) << "signal " << result.signal;
    EXPECT_TRUE(says(result.err, {"stopped"}));
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(exists("x.vpe"));
    EXPECT_EQ(leftovers(), Words{});
  }
}

TEST_F(Signals, KeepTheFileThatWasThere) {
  write_dem(dir_ / "x.tif");
  std::filesystem::copy_file(planet(), dir_ / "x.vpe");
  Command command = command_for({"build", "x.tif", "-o", "x.vpe"});
  command.signal = SIGINT;
  command.when = [&] { return holds_part(dir_.path()); };
  EXPECT_EQ(run(command).exit_code, 130);
  EXPECT_EQ(read_text(dir_ / "x.vpe"), read_text(planet()));
  EXPECT_EQ(leftovers(), Words{});
}

TEST_F(Signals, StopABuildIntoTheCache) {
  write_dem(dir_ / "x.tif");
  for (const Words& arguments : {Words{"query", "x.tif", "1,2"}, Words{"query", "1,2"}}) {
    Command command = command_for(arguments);
    command.signal = SIGTERM;
    command.when = [&] { return holds_part(dir_ / "cache"); };
    const Result result = run(command);
    EXPECT_TRUE(result.signalled);
    EXPECT_EQ(result.exit_code, 143) << "signal " << result.signal;
    EXPECT_TRUE(says(result.err, {"Building", "once, into", path("cache") + "/vpe/"}));
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(leftovers(), Words{});
    for (const auto& entry : std::filesystem::recursive_directory_iterator(dir_ / "cache")) {
      EXPECT_NE(entry.path().extension(), ".vpe");
    }
  }
}

class LongCache : public AppTest {};

TEST_F(LongCache, ADemIsBuiltOnceAndReused) {
  Dem dem;
  write_dem(dir_ / "x.tif", dem);
  const Words words{"query", "x.tif", "-74,-13.5", "--json"};
  Command command = command_for(words);
  command.limit_s = 900;
  const Result first = run(command);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_TRUE(says(first.err, {"Building x.tif once, into"}));
  const Result second = vpe(words);
  EXPECT_EQ(second.err, "");
  EXPECT_EQ(second.out, first.out);
  // The same file by another name is the same planet; a changed file is another.
  EXPECT_EQ(vpe({"query", path("x.tif"), "-74,-13.5", "--json"}).err, "");
  dem.width = 90;
  dem.height = 45;
  dem.cell_deg = 4;
  write_dem(dir_ / "x.tif", dem);
  command.signal = SIGINT;
  command.when = [&] { return !leftovers().empty(); };
  const Result third = run(command);
  EXPECT_EQ(third.exit_code, 130);
  EXPECT_TRUE(says(third.err, {"Building x.tif once, into"}));
}

}  // namespace
}  // namespace app_test
