// Test of a long random session. VPE_WANDER_S sets its duration (300), VPE_EMBEDDED_PLANET the planet.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "tests/window/explore_window_fixture.h"

namespace vpe::window {
namespace {

double resident_mb() {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024.0;
  return 0;
}

// The parameter is the backend; none: the window chooses.
class LongWander : public ExploreWindowTest,
                   public testing::WithParamInterface<std::optional<core::Backend>> {};

TEST_P(LongWander, FramesStayShortAndMemoryFlat) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
  const char* text = std::getenv("VPE_WANDER_S");
  const double wander_s = text == nullptr ? 300.0 : std::atof(text);
  const char* path = std::getenv("VPE_EMBEDDED_PLANET");
  if (path != nullptr) planet_ = paging::PlanetFile::open(path);
  ASSERT_TRUE(extra_.session.settings.set("lod.tolerance", "2").empty());
  ASSERT_TRUE(extra_.session.settings.set("lod.frame_ms", "40").empty());
  open(1280, 720, GetParam());

  test_support::Random random(20261122);
  std::vector<double> frames_ms;
  std::vector<double> images_ms;
  std::vector<double> memory_mb;
  std::vector<double> longest_ms;  // frame, of each tenth of the time
  const auto begun = Clock::now();
  double next_memory_s = 0;
  std::int64_t images = window_->images();
  // Performs one random activity after another, each for some seconds.
  enum class Doing { kForward, kDrag, kTilt, kZoomIn, kZoomOut, kMap, kRest };
  Doing doing = Doing::kRest;
  double until_s = 0;
  double x = 700;
  double y = 300;
  const WidgetPlace map = place_of("map");
  const auto stop = [&] {
    robot_->key_up("w");
    robot_->release(1);
    robot_->release(3);
  };
  while (seconds(Clock::now() - begun) < wander_s) {
    const double now_s = seconds(Clock::now() - begun);
    if (now_s >= until_s) {
      stop();
      doing = static_cast<Doing>(random.integer(0, 6));
      until_s = now_s + random.uniform(0.5, 4.0);
      x = random.uniform(400, 1200);
      y = random.uniform(60, 600);
      if (doing == Doing::kMap) {
        x = random.uniform(map.x0 + 4, map.x1 - 4);
        y = random.uniform(map.y0 + 20, map.y1 - 20);
      }
      robot_->move(x, y);
      if (doing == Doing::kForward) robot_->key_down("w");
      if (doing == Doing::kDrag || doing == Doing::kMap) robot_->press(1);
      if (doing == Doing::kTilt) robot_->press(3);
      if (doing == Doing::kMap) robot_->release(1);
    }
    if (doing == Doing::kDrag || doing == Doing::kTilt) {
      x = std::clamp(x + random.uniform(-25, 25), 345.0, 1270.0);
      y = std::clamp(y + random.uniform(-25, 25), 5.0, 660.0);
      robot_->move(x, y);
    }
    if (doing == Doing::kZoomIn && random.integer(0, 3) == 0) robot_->wheel(1);
    if (doing == Doing::kZoomOut && random.integer(0, 3) == 0) robot_->wheel(-1);
    const auto frame = Clock::now();
    ASSERT_TRUE(window_->step(0.02));
    frames_ms.push_back(seconds(Clock::now() - frame) * 1e3);
    if (window_->images() != images) {
      images = window_->images();
      images_ms.push_back(window_->drawn()->seconds * 1e3);
      ASSERT_TRUE(window_->drawn()->error.empty()) << window_->drawn()->error;
    }
    if (now_s >= next_memory_s) {
      memory_mb.push_back(resident_mb());
      longest_ms.push_back(0);
      next_memory_s += wander_s / 10;
    }
    longest_ms.back() = std::max(longest_ms.back(), frames_ms.back());
    ASSERT_GE(window_->session().height_m(), 0.9);
  }
  stop();
  std::ranges::sort(frames_ms);
  std::ranges::sort(images_ms);
  const auto part = [](const std::vector<double>& sorted, double p) {
    return sorted[std::min(sorted.size() - 1,
                           static_cast<std::size_t>(p * static_cast<double>(sorted.size())))];
  };
  std::printf(
      "%zu frames: median %.1f ms, 99 %% %.1f, longest %.1f; %zu images: median %.1f, 99 %% %.1f, longest "
      "%.1f\n",
      frames_ms.size(), part(frames_ms, 0.5), part(frames_ms, 0.99), frames_ms.back(), images_ms.size(),
      part(images_ms, 0.5), part(images_ms, 0.99), images_ms.back());
  std::printf("memory, MB:");
  for (const double mb : memory_mb) std::printf(" %.0f", mb);
  std::printf("\nlongest frames, ms:");
  for (const double ms : longest_ms) std::printf(" %.0f", ms);
  std::printf("\n");
  // Caches fill in the first half; after that memory must not grow.
  const double half = memory_mb[memory_mb.size() / 2];
  EXPECT_LT(memory_mb.back(), half * 1.1 + 16);
}

INSTANTIATE_TEST_SUITE_P(LongBackends, LongWander,
                         testing::Values(std::optional(core::Backend::kPolygon),
                                         std::optional<core::Backend>()),
                         [](const auto& of) -> std::string { return of.param ? "polygon" : "auto"; });

}  // namespace
}  // namespace vpe::window
