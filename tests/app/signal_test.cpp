// SIGINT, SIGTERM and SIGKILL while a planet is built.
#include <chrono>
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
  // A stopped build leaves its .part file for the next one, and nothing else.
  void expect_only_parts() const {
    for (const std::string& name : leftovers())
      EXPECT_TRUE(name.ends_with(".part") || name.ends_with(".part-journal")) << name;
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
    expect_only_parts();
    std::filesystem::remove(dir_ / "x.vpe.part");
    std::filesystem::remove(dir_ / "x.vpe.part-journal");
  }
}

TEST_F(Signals, KeepTheExistingFile) {
  write_dem(dir_ / "x.tif");
  std::filesystem::copy_file(planet(), dir_ / "x.vpe");
  Command command = command_for({"build", "x.tif", "-o", "x.vpe", "--force"});
  command.signal = SIGINT;
  command.when = [&] { return holds_part(dir_.path()); };
  EXPECT_EQ(run(command).exit_code, 130);
  EXPECT_EQ(read_text(dir_ / "x.vpe"), read_text(planet()));
  expect_only_parts();
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
    expect_only_parts();
    for (const auto& entry : std::filesystem::recursive_directory_iterator(dir_ / "cache")) {
      EXPECT_NE(entry.path().extension(), ".vpe");
    }
    std::filesystem::remove_all(dir_ / "cache");
  }
}

// A build of about a second, stopped repeatedly.
class Continue : public Signals {
 protected:
  Words build_words(const std::string& name) const {
    return {"build", "x.tif", "-o", name, "--base-spacing", "25000", "--json"};
  }

  static std::string identity_of(const Result& result) {
    return parse_json(result.out).at("identity").get<std::string>();
  }

  // Sends `signal` after a random time, until a build ends by itself; returns how often it was sent. The times grow, so that
  // a slow machine gets somewhere.
  int stop_until_done(int signal, double longest_s, test_support::Random& random, Result& last) const {
    for (int stops = 0;; ++stops) {
      Command command = command_for(build_words("x.vpe"));
      const auto end = std::chrono::steady_clock::now() +
                       std::chrono::duration<double>(random.uniform(0.05, longest_s * (1 + 0.1 * stops)));
      command.signal = signal;
      command.when = [end] { return std::chrono::steady_clock::now() > end; };
      last = run(command);
      if (last.exit_code == 0) return stops;
      EXPECT_TRUE(last.signalled) << last.err;
    }
  }
};

TEST_F(Continue, AStoppedBuildIsContinued) {
  write_dem(dir_ / "x.tif");
  const Result whole = vpe(build_words("whole.vpe"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  Command command = command_for(build_words("x.vpe"));
  command.signal = SIGTERM;
  command.when = [&] { return holds_part(dir_.path()); };
  const Result stopped = run(command);
  if (stopped.exit_code != 0 && exists("x.vpe.part")) {
    EXPECT_EQ(stopped.exit_code, 143);
    EXPECT_TRUE(says(stopped.err, {"x.vpe.part", "the same command continues it", "stopped"}));
  }
  test_support::Random random(5);
  Result last;
  stop_until_done(SIGTERM, 3.0, random, last);
  EXPECT_EQ(identity_of(last), identity_of(whole));
  EXPECT_EQ(leftovers(), Words{});
}

class LongContinue : public Continue {};

TEST_F(LongContinue, KilledOneHundredTimes) {
  write_dem(dir_ / "x.tif");
  const Result whole = vpe(build_words("whole.vpe"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  test_support::Random random(6);
  int kills = 0;
  while (kills < 100) {
    Result last;
    kills += stop_until_done(SIGKILL, 2.0, random, last);
    EXPECT_EQ(identity_of(last), identity_of(whole));
    EXPECT_EQ(vpe({"verify", "x.vpe", "-q"}).exit_code, 0);
    std::filesystem::remove(dir_ / "x.vpe");
    if (HasFailure()) return;
  }
  RecordProperty("kills", kills);
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
