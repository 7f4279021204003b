// Outputs never replace inputs, each other, or files of another kind or program.
#include <sys/stat.h>

#include <csignal>
#include <future>

#include "paging/planet/planet_file.h"
#include "paging/planet/sqlite.h"
#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;

class Outputs : public AppTest {
 protected:
  void SetUp() override { fs::copy_file(planet(), dir_ / "p.vpe"); }

  static Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  static Words render(const Words& more, const std::string& planet = "p.vpe") {
    return with({"render", planet, "--pose", "10,5,400000,0,-90,0", "--size", "32x24"}, more);
  }
  static Words horizon(const Words& more) {
    return with({"horizon", "p.vpe", "--at", "10,5", "--height", "4000", "--step", "30"}, more);
  }
  static Words panorama(const Words& more, const std::string& planet = "p.vpe") {
    return with({"panorama", planet, "--at", "10,5", "--height", "4000", "--width", "64", "--elevation=-20,10"},
                more);
  }
  static Words fly(const Words& more) { return with({"fly", "f.flight", "p.vpe", "--size", "32x24"}, more); }

  // Expects a refusal that leaves the file as it was.
  void expect_refused(const Words& words, int exit_code, const std::string& file, const Words& parts) const {
    const std::string before = read_text(dir_ / file);
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, exit_code) << file << result.err;
    EXPECT_TRUE(says(result.err, parts));
    EXPECT_TRUE(read_text(dir_ / file) == before) << file;
  }
  void expect_made(const Words& words) const {
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
};

// A log and statistics of a stopped film replace nothing.
TEST_F(Outputs, AStoppedFilmLeavesTheFormerLog) {
  write_text(dir_ / "f.flight", small_flight());
  const Words words =
      fly({"--backend", "ray", "-q", "-o", "out", "--log", "log.flight", "--stats", "stats.csv", "--frames"});
  expect_made(with(words, {"0-3"}));
  const std::string log = read_text(dir_ / "log.flight");
  const std::string stats = read_text(dir_ / "stats.csv");
  Command command = command_for(with(words, {"0-19", "--force"}));
  command.signal = SIGTERM;
  command.when = [&] { return exists("out/frame_000004.png"); };
  const Result result = run(command);
  if (result.exit_code == 0) GTEST_SKIP() << "skipped: it ended before the signal";
  EXPECT_EQ(result.exit_code, 143);
  EXPECT_EQ(read_text(dir_ / "log.flight"), log);
  EXPECT_EQ(read_text(dir_ / "stats.csv"), stats);
  EXPECT_EQ(leftovers(), Words{});
  expect_made(with(words, {"0-19"}));
  EXPECT_NE(read_text(dir_ / "log.flight"), log);
  EXPECT_NE(read_text(dir_ / "log.flight").find(" end\n"), std::string::npos);
  EXPECT_NE(read_text(dir_ / "stats.csv"), stats);
}

}  // namespace
}  // namespace app_test
