// Films that are killed at random moments and continued equal uninterrupted films, frame by frame.
#include <chrono>
#include <csignal>

#include "tests/app/support/film_fixture.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;

class FilmKill : public FilmTest {
 protected:
  // Runs once and kills the run after a random time below `longest_s`. Returns true if it was killed.
  bool kill_once(const std::string& output, test_support::Random& random, double longest_s) const {
    const auto end =
        std::chrono::steady_clock::now() + std::chrono::duration<double>(random.uniform(0, longest_s));
    Command command = fly_command(output);
    command.signal = SIGKILL;
    command.when = [end] { return std::chrono::steady_clock::now() >= end; };
    const Result result = run(command);
    EXPECT_TRUE(result.signal == SIGKILL || result.exit_code == 0) << result.err;
    return result.signal == SIGKILL;
  }
  // Returns the time that a whole run takes.
  double time_of(const std::string& output) const {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(fly(output).exit_code, 0);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  void folder(int kills, std::uint64_t seed) const {
    const double whole_s = time_of("whole");
    const auto expected = files("whole");
    test_support::Random random(seed);
    for (int n = 0; n < kills;) {
      fs::remove_all(dir_ / "out");
      // Killed repeatedly until it is done.
      while (n < kills && kill_once("out", random, whole_s)) ++n;
      const Result last = fly("out");
      ASSERT_EQ(last.exit_code, 0) << last.err;
      ASSERT_EQ(files("out"), expected) << "after " << n << " kills";
    }
  }
  void video(int kills, std::uint64_t seed) const {
    const double whole_s = time_of("whole.mp4");
    const std::string expected = decoded("whole.mp4");
    test_support::Random random(seed);
    for (int n = 0; n < kills;) {
      fs::remove(dir_ / "x.mp4");
      fs::remove(dir_ / "x.mp4.json");
      while (n < kills && kill_once("x.mp4", random, 0.7 * whole_s)) {
        ++n;
        // A file under the film's name is the whole film.
        if (exists("x.mp4")) {
          EXPECT_EQ(decoded("x.mp4"), expected);
        }
      }
      const Result last = fly("x.mp4");
      ASSERT_EQ(last.exit_code, 0) << last.err;
      ASSERT_EQ(decoded("x.mp4"), expected) << "after " << n << " kills";
      ASSERT_EQ(leftovers(), Words{});
    }
  }
};

TEST_F(FilmKill, FolderIsTheSame) { folder(3, 1); }

TEST_F(FilmKill, VideoIsTheSame) {
  if (!has_ffmpeg()) GTEST_SKIP() << "skipped: no ffmpeg";
  video(3, 2);
}

class LongFilmKill : public FilmKill {};

TEST_F(LongFilmKill, FolderIsTheSameAfterAHundred) { folder(100, 3); }

TEST_F(LongFilmKill, VideoIsTheSameAfterAHundred) {
  if (!has_ffmpeg()) GTEST_SKIP() << "skipped: no ffmpeg";
  video(100, 4);
}

}  // namespace
}  // namespace app_test
