// Measures how the explore window feels: images and frames a second while the camera moves, time from an input to the first
// image that shows it, time until the image at rest, processor time while only the cursor moves.
//
// Usage: window_bench PLANET [--size WxH] [--backend auto|polygon|ray] [--seconds S] [--memory MB]
//                     [--warp off|polynomial|grid]
//
// A simulated hand on a virtual screen moves the mouse 60 times a second, on a thread of its own. An input counts as
// shown when the window has presented a frame of the first pose that it read after the input: a finished image, or the
// last one as that pose sees it.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/window/bench_window.h"
#include "tests/window/robot.h"

namespace {

using Clock = std::chrono::steady_clock;
using vpe::window::ExploreWindow;
using vpe::window::Robot;

double now_s() {
  static const Clock::time_point begun = Clock::now();
  return std::chrono::duration<double>(Clock::now() - begun).count();
}

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double resident_mb() {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024.0;
  return 0;
}

double part(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

// Moves the mouse, from construction to destruction, and tells when.
class Hand {
 public:
  Hand(Robot& robot, double x, double y, double radius)
      : thread_([this, &robot, x, y, radius](const std::stop_token& stop) {
          for (int n = 0; !stop.stop_requested(); ++n) {
            const double angle = 2 * 3.14159265358979 * n / 120.0;
            robot.move(x + radius * std::cos(angle), y + radius * std::sin(angle));
            {
              const std::lock_guard lock(mutex_);
              times_s_.push_back(now_s());
            }
            std::this_thread::sleep_for(std::chrono::microseconds(16'667));
          }
        }) {}
  // Returns the times of the inputs since the last call.
  std::vector<double> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(times_s_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<double> times_s_;
  std::jthread thread_;  // last: it uses the members above
};

struct Feel {
  double images_a_second = 0;
  double frames_a_second = 0;
  double cores = 0;
  std::vector<double> latency_ms;
};

// Runs the window for some seconds while a hand moves. Inputs after the last image do not count.
Feel feel(ExploreWindow& window, Hand& hand, double seconds) {
  struct Step {
    double begun_s;
    mars::CameraPose camera;
  };
  Feel feel;
  std::vector<Step> steps;
  std::vector<double> waiting_s;
  const std::int64_t first = window.images();
  std::int64_t frames = window.frames();
  const std::int64_t first_frame = frames;
  const double begun_s = now_s();
  const double begun_processor_s = processor_s();
  hand.take();
  while (now_s() - begun_s < seconds) {
    const double step_s = now_s();
    window.step(0.02);
    steps.push_back({step_s, window.session().view().camera});
    for (const double time_s : hand.take()) waiting_s.push_back(time_s);
    if (window.frames() == frames || window.shown_view() == nullptr) continue;
    frames = window.frames();
    const mars::CameraPose& shown = window.shown_view()->camera;
    const auto of = std::find_if(steps.rbegin(), steps.rend(), [&](const Step& s) {
      return s.camera.position_m == shown.position_m && s.camera.axes.forward == shown.axes.forward &&
             s.camera.axes.up == shown.axes.up;
    });
    if (of == steps.rend()) continue;
    const double end_s = now_s();
    std::erase_if(waiting_s, [&](double input_s) {
      if (input_s > of->begun_s) return false;
      feel.latency_ms.push_back(1e3 * (end_s - input_s));
      return true;
    });
  }
  const double took_s = now_s() - begun_s;
  feel.images_a_second = static_cast<double>(window.images() - first) / took_s;
  feel.frames_a_second = static_cast<double>(frames - first_frame) / took_s;
  feel.cores = (processor_s() - begun_processor_s) / took_s;
  return feel;
}

double settle_s(ExploreWindow& window) {
  const double begun_s = now_s();
  while (now_s() - begun_s < 60 && !(window.shows_final_image() && window.is_at_rest())) window.step(0.005);
  return now_s() - begun_s;
}

void print(const char* view, const char* what, const Feel& f, double settled_s) {
  std::printf("| %-12s | %-6s | %5.1f | %5.1f | %4.0f | %4.0f | %4.2f | %4.2f |\n", view, what,
              f.images_a_second, f.frames_a_second, part(f.latency_ms, 0.5), part(f.latency_ms, 0.95), f.cores,
              settled_s);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace vpe;
  if (argc < 2) {
    std::fprintf(stderr,
                 "usage: window_bench PLANET [--size WxH] [--backend NAME] [--seconds S] [--memory MB] "
                 "[--warp off|polynomial|grid]\n");
    return 2;
  }
  int width = 1280;
  int height = 720;
  double seconds = 5;
  core::DrawnBy drawn_by = core::DrawnBy::kAuto;
  explore::Warp warp = explore::Warp::kGrid;
  app::Common common;
  for (int n = 2; n + 1 < argc; n += 2) {
    const std::string key = argv[n];
    const std::string value = argv[n + 1];
    if (key == "--size" && std::sscanf(value.c_str(), "%dx%d", &width, &height) != 2) return 2;
    if (key == "--seconds") seconds = std::stod(value);
    if (key == "--memory") common.memory_mb = std::stoi(value);
    if (key == "--warp")
      warp = value == "off"          ? explore::Warp::kOff
             : value == "polynomial" ? explore::Warp::kPolynomial
             : value == "carry"      ? explore::Warp::kCarry
                                     : explore::Warp::kGrid;
    if (key == "--backend")
      drawn_by = value == "ray"       ? core::DrawnBy::kRay
                 : value == "polygon" ? core::DrawnBy::kPolygon
                                      : core::DrawnBy::kAuto;
  }
  const window::Screen screen(width, height);
  if (!screen.why_not().empty()) {
    std::fprintf(stderr, "%s\n", screen.why_not().c_str());
    return 1;
  }
  window::ExploreSetup setup = bench::bench_setup(argv[1], width, height, common);
  setup.drawn_by = drawn_by;
  setup.preferences.warp = warp;
  (void)setup.session.settings.set("lod.frame_ms", "40");
  ExploreWindow window(std::move(setup));
  Robot robot;

  struct Place {
    const char* name;
    mars::Pose pose;
  };
  const Place places[] = {{"globe", {-60, 0, 7e6, 0, -90, 0}},
                          {"valles 8 km", {-59.2, -13.7, 4000, 60, -20, 0}},
                          {"gale 12 km", {137.4, -5.6, 12'000, 0, -25, 0}},
                          {"gale 30 m", {137.4, -4.6, -4470, 0, -5, 0}}};
  std::printf(
      "%dx%d, %s, %d MB\n| view | motion | images/s | frames/s | input to frame: median | 95 %% (ms) | cores | settled (s) |\n",
      width, height, std::string(core::to_string(drawn_by)).c_str(), common.memory_mb);
  const double x = width * 0.62;
  const double y = height * 0.55;
  const double radius = height * 0.15;
  for (const Place& place : places) {
    window.session().put(place.pose);
    settle_s(window);
    {
      robot.move(x + radius, y);
      for (int n = 0; n < 5; ++n) window.step(0.01);
      robot.press();
      Feel drag;
      {
        Hand hand(robot, x, y, radius);
        drag = feel(window, hand, seconds);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(150));  // no throw
      robot.release();
      print(place.name, "drag", drag, settle_s(window));
    }
    {
      robot.key_down("w");
      Feel fly;
      {
        Hand hand(robot, x, y, 2);
        fly = feel(window, hand, seconds);
      }
      robot.key_up("w");
      fly.latency_ms.clear();
      print(place.name, "fly", fly, settle_s(window));
    }
    {
      Hand hand(robot, x, y, radius);
      print(place.name, "hover", feel(window, hand, seconds), 0);
    }
  }
  std::printf("resident: %.0f MB", resident_mb());
  const double rest_s = now_s();
  while (now_s() - rest_s < 2.5) window.step(0.1);
  std::printf(", after a rest %.0f MB\n", resident_mb());
  return 0;
}
