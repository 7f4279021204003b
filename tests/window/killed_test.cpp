// Tests that work outlives a window that ends at any moment: killed, interrupted, without its display, or without room
// for its files. The program runs as a process of its own on a screen of its own.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <thread>

#include "scripts/flight.h"
#include "tests/paging/planet_fixture.h"
#include "tests/support/support.h"
#include "tests/window/robot.h"

namespace vpe::window {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

enum class End { kKill, kInterrupt, kTerminate, kNoDisplay, kFullDisk };

void pause_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

// Runs `vpe explore` with a home folder of its own.
class Program {
 public:
  Program(const fs::path& planet, const fs::path& home) {
    process_ = fork();
    if (process_ != 0) return;
    setenv("HOME", home.c_str(), 1);
    for (const char* name : {"XDG_STATE_HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME"}) unsetenv(name);
    (void)chdir(home.c_str());
    freopen("err.txt", "w", stderr);
    execl(VPE_PROGRAM, "vpe", "explore", planet.c_str(), "--size", "500x350", "--backend", "ray", "--quiet",
          static_cast<char*>(nullptr));
    _exit(127);
  }
  ~Program() {
    if (process_ > 0) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  pid_t id() const { return process_; }
  int status() const { return status_; }  // after the end, as waitpid() has it
  // Waits for the end for at most 20 s.
  bool ends() {
    for (int n = 0; n < 2000; ++n) {
      if (waitpid(process_, &status_, WNOHANG) == process_) {
        process_ = -1;
        return true;
      }
      pause_ms(10);
    }
    return false;
  }

 private:
  pid_t process_ = -1;
  int status_ = 0;
};

// Returns the number of poses of the unsaved flight in a home folder, or nullopt if there is none: a copy in the folder
// of state, or, of a window that was closed in an orderly way, a file in the working folder. One that cannot be read is
// a failure.
std::optional<std::size_t> kept_poses(const fs::path& home) {
  std::optional<std::size_t> most;
  std::error_code none;
  for (const fs::path& folder : {home / ".local/state/vpe", home}) {
    for (const auto& entry : fs::directory_iterator(folder, none)) {
      if (entry.path().extension() != ".flight") continue;
      std::stringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      const scripts::ParsedFlight parsed = scripts::parse_flight(text.str(), entry.path().string());
      EXPECT_TRUE(parsed.flight.has_value()) << entry.path() << "\n" << text.str();
      if (parsed.flight) most = std::max(most.value_or(0), parsed.flight->waypoints.size());
    }
  }
  return most;
}

const std::shared_ptr<const paging::PlanetFile>& planet_of_killed() {
  static const test_support::TempDir folder;
  static const auto file = test_support::build_fake(
      folder / "p.vpe", test_support::FakeElevation(test_support::bumpy_height), 60'000);
  return file;
}

// Places waypoints, ends the program at a random moment, and looks at what it left.
void end_once(End end, std::mt19937& random) {
  const test_support::TempDir home;
  auto screen = std::make_unique<Screen>(640, 480);
  if (!screen->why_not().empty()) GTEST_SKIP() << "skipped: " << screen->why_not();
  auto robot = std::make_unique<Robot>();
  robot->move(450, 200);
  Program program(planet_of_killed()->path(), home.path());
  // Each waypoint is placed once the copy of the one before is there; the first keys come before the window.
  const auto begun = Clock::now();
  while (!kept_poses(home.path()) && Clock::now() - begun < std::chrono::seconds(60)) {
    robot->key("p");
    pause_ms(100);
  }
  ASSERT_TRUE(kept_poses(home.path()).has_value()) << "no copy of the flight within a minute";
  const int steps = static_cast<int>(random() % 6);
  for (int n = 0; n < steps; ++n) {
    robot->key("w");
    robot->key("p");
    pause_ms(static_cast<int>(random() % 60));
  }
  const std::size_t before = kept_poses(home.path()).value_or(0);
  pause_ms(static_cast<int>(random() % 200));
  switch (end) {
    case End::kKill: kill(program.id(), SIGKILL); break;
    case End::kInterrupt: kill(program.id(), SIGINT); break;
    case End::kTerminate: kill(program.id(), SIGTERM); break;
    case End::kNoDisplay:
      robot.reset();
      screen.reset();
      break;
    case End::kFullDisk: {
      const rlimit none{0, 0};
      ASSERT_EQ(prlimit(program.id(), RLIMIT_FSIZE, &none, nullptr), 0);
      robot->key("p");
      pause_ms(static_cast<int>(random() % 400));
      kill(program.id(), SIGKILL);
      break;
    }
  }
  ASSERT_TRUE(program.ends());
  if (end == End::kNoDisplay) {
    std::stringstream said;
    said << std::ifstream(home.path() / "err.txt").rdbuf();
    EXPECT_TRUE(WIFEXITED(program.status()) && WEXITSTATUS(program.status()) == 1) << program.status();
    EXPECT_NE(said.str().find("the connection to the display was lost"), std::string::npos) << said.str();
  }
  const std::optional<std::size_t> after = kept_poses(home.path());
  ASSERT_TRUE(after.has_value()) << "the unsaved flight is lost";
  EXPECT_GE(*after, before);
}

class KilledWindow : public testing::TestWithParam<End> {};
class LongKilledWindow : public KilledWindow {};

TEST_P(KilledWindow, LeavesTheFlight) {
  std::mt19937 random(20261124U + static_cast<unsigned>(GetParam()));
  end_once(GetParam(), random);
}

TEST_P(LongKilledWindow, LeavesTheFlightAtFiftyMoments) {
  std::mt19937 random(7U + static_cast<unsigned>(GetParam()));
  for (int n = 0; n < 50 && !HasFatalFailure() && !IsSkipped(); ++n) end_once(GetParam(), random);
}

std::string end_name(const testing::TestParamInfo<End>& end) {
  switch (end.param) {
    case End::kKill: return "Kill";
    case End::kInterrupt: return "Interrupt";
    case End::kTerminate: return "Terminate";
    case End::kNoDisplay: return "NoDisplay";
    case End::kFullDisk: return "FullDisk";
  }
  return "";
}

constexpr std::array kEnds{End::kKill, End::kInterrupt, End::kTerminate, End::kNoDisplay, End::kFullDisk};
INSTANTIATE_TEST_SUITE_P(Ends, KilledWindow, testing::ValuesIn(kEnds), end_name);
INSTANTIATE_TEST_SUITE_P(LongEnds, LongKilledWindow, testing::ValuesIn(kEnds), end_name);

}  // namespace
}  // namespace vpe::window
