// Floating-point traps while a test of pure functions runs: an invalid operation, a division by zero or an
// overflow ends the program, with the test's name and where it was. Part of builds with VPE_FP_TRAPS only.
#include <execinfo.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cfenv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

namespace {

// Lists suites whose code must not raise floating-point exceptions, by folder of their source. A final `*`
// matches any text.
struct Trapped {
  std::string_view folder;
  std::string_view suite;
};
constexpr Trapped kTrapped[] = {
    {"cull", "*"},
    {"lod", "*"},
    {"scripts", "*"},
    {"stability", "*"},
    {"mars", "Sphere"},
    {"mars", "Pose"},
    {"mars", "Cube"},
    {"mars", "MarsTime"},
    {"mars", "SunText"},
    {"mars", "Datum"},
    {"core", "View"},
    {"core", "BadView"},
    {"core", "Slope"},
    {"core", "Light"},
    {"core", "Air"},
    {"core", "Haze"},
    {"core", "Gamma"},
    {"core", "Palette*"},
    {"core", "ColourScale"},
    {"core", "Metrics"},
    {"core", "OnHills"},
    {"core", "Stereo"},
    {"explore", "Steer"},
    {"explore", "Mouse"},
    {"explore", "FlyTo"},
    {"explore", "MapView"},
    {"explore", "MapLine"},
    {"explore", "FlightPlayer"},
    {"explore", "Controls"},
    {"explore", "Gamepad*"},
    {"explore", "HeadTracker*"},
    {"explore", "SpaceMouse"},
    {"panorama", "Projection*"},
    {"panorama", "Viewer*"},
    {"panorama", "StereoPieces*"},
    {"panorama", "StereoEyes*"},
    {"paging", "Surface"},
    {"paging", "Section"},
};

// Lists tests that are about NaN or infinite numbers, or make them themselves.
struct Excused {
  std::string_view test;
  std::string_view why;
};
constexpr Excused kExcused[] = {
    {"Sphere.NoNumberIsNoNumber", "NaN"},
    {"Pose.NoNumberIsNoNumber", "NaN"},
    {"GeometryViews.*", "vector kernels, whose idle lanes compute unused values"},
    {"Jitter.GroundOfRays*", "vector kernels"},
    {"Depth.*", "vector kernels"},
    {"GeometryRays.RadiiOutOfRangeAreRefusedBeforeAnythingIsBuilt", "radii that are NaN"},
    {"FlightPlayer.PlaysAtAnySpeedAlsoBackwards", "a time step that is NaN counts as 0"},
    {"FlightPlayer.ScrubbedBackwardsSettingsAreThoseOfThatTime", "a time that is NaN is the start"},
    {"HeadTracker.TimesThatRunBackwardsAreTheLastOne", "times that are NaN"},
    {"MapView.ZoomEndsAtItsLimits", "a factor that is NaN"},
    {"Datum.Text", "a radius that is NaN is refused"},
    {"Sphere.SinCosIsExactAtMultiplesOf90AndWithinItsBoundElsewhere", "the test takes the exponent of 0"},
    {"StereoPieces.PairsThatNobodyCanLookAtAreRefused", "NaN is refused"},
    {"OnHills.InvalidRangesAreCountedAndHurt", "ranges that are NaN"},
    {"Palette.IsStraightBetweenStopsAndConstantBeyond", "the colour of NaN"},
    {"Palette.RefusesStopsThatMakeNone", "stops that are NaN are refused"},
    {"BadView.*", "NaN, and cameras whose squared distance overflows, are refused"},
    {"ProgressiveRefinement.WhatIsNoNumberIsFastAndBadOptionsAreRefused", "motion that is NaN counts as fast"},
    {"Path.IsHeldBeforeTheFirstPoseAndAfterTheLast", "asks for the time NaN: the start"},
    {"MonotoneSpline.IsExactOnLinesAndHoldsOutside", "asks for the time NaN: the first value"},
};

bool matches(std::string_view pattern, std::string_view text) {
  if (pattern.ends_with('*')) return text.starts_with(pattern.substr(0, pattern.size() - 1));
  return pattern == text;
}

std::string folder_of(std::string_view file) {
  const auto tests = file.rfind("tests/");
  if (tests == std::string_view::npos) return {};
  file.remove_prefix(tests + 6);
  return std::string(file.substr(0, file.find('/')));
}

char running[256] = "no test";

void print(const char* text) {
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) _exit(1);
}

void on_trap(int, siginfo_t* info, void*) {
  print(info->si_code == FPE_FLTINV   ? "floating-point trap: invalid operation in "
        : info->si_code == FPE_FLTDIV ? "floating-point trap: division by zero in "
        : info->si_code == FPE_FLTOVF ? "floating-point trap: overflow in "
                                      : "floating-point trap in ");
  print(running);
  print("\n");
  void* frames[32];
  backtrace_symbols_fd(frames, backtrace(frames, 32), STDERR_FILENO);
  _exit(1);
}

class Traps : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo& test) override {
    const std::string name = std::string(test.test_suite_name()) + "." + test.name();
    const std::string folder = folder_of(test.file());
    bool wanted = false;
    for (const Trapped& t : kTrapped)
      wanted = wanted || (t.folder == folder && matches(t.suite, test.test_suite_name()));
    for (const Excused& e : kExcused) wanted = wanted && !matches(e.test, name);
    if (!wanted) return;
    std::strncpy(running, name.c_str(), sizeof running - 1);
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  }
  void OnTestEnd(const testing::TestInfo&) override { fedisableexcept(FE_ALL_EXCEPT); }
};

// $VPE_LIST_TRAPPED names a folder: the filter of GoogleTest for its trapped suites, without the long ones.
void list_trapped(std::string_view folder) {
  std::string suites;
  for (const Trapped& t : kTrapped) {
    if (t.folder == folder)
      suites += (suites.empty() ? "" : ":") + std::string(t.suite) + (t.suite == "*" ? "" : ".*");
  }
  std::printf("%s-Long*\n", suites.c_str());
}

const bool kInstalled = [] {
  if (const char* folder = std::getenv("VPE_LIST_TRAPPED")) {
    list_trapped(folder);
    std::exit(0);
  }
  void* first[1];
  backtrace(first, 1);  // loads what it needs now rather than in the handler
  struct sigaction action = {};
  action.sa_sigaction = on_trap;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGFPE, &action, nullptr);
  testing::UnitTest::GetInstance()->listeners().Append(new Traps);
  return true;
}();

}  // namespace
