// Takes pictures of the explore window with each of its panels, for looking at the layout and for docs/pictures.
//
// Usage: panel_shots PLANET FOLDER [--size WxH]
//
// The window is that of `vpe explore` over Gale on a virtual screen. Panels are opened by clicks on their names.
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scripts/flight.h"
#include "tests/bench/window/bench_window.h"
#include "tests/window/robot.h"
#include "vpe/core/image/image.h"

namespace {

using vpe::window::ExploreWindow;
using vpe::window::Robot;

// Drives a window until it is at rest, and keeps what it shows.
class Photographer {
 public:
  Photographer(ExploreWindow& window, Robot& robot, std::filesystem::path folder, std::string size)
      : window_(window), robot_(robot), folder_(std::move(folder)), size_(std::move(size)) {}

  void rest() {
    for (int n = 0; n < 3000 && !(window_.shows_final_image() && window_.is_at_rest()); ++n) window_.step(0.01);
    for (int n = 0; n < 5; ++n) window_.step(0.01);
  }

  bool click(const std::string& label) {
    for (int n = 0; n < 50 && !window_.widgets().places().contains(label); ++n) window_.step(0.01);
    const auto found = window_.widgets().places().find(label);
    if (found == window_.widgets().places().end()) {
      std::printf("%s: no widget is called \"%s\"\n", size_.c_str(), label.c_str());
      return false;
    }
    click_at((found->second.x0 + found->second.x1) / 2, (found->second.y0 + found->second.y1) / 2);
    return true;
  }

  void click_at(double x, double y) {
    robot_.move(x, y);
    for (int n = 0; n < 4; ++n) window_.step(0.01);
    robot_.press();
    for (int n = 0; n < 3; ++n) window_.step(0.01);
    robot_.release();
    for (int n = 0; n < 3; ++n) window_.step(0.01);
  }

  void key(const std::string& name) {
    robot_.key(name);
    for (int n = 0; n < 4; ++n) window_.step(0.01);
  }

  void shoot(const std::string& name) {
    rest();
    vpe::core::RgbImage image;
    window_.capture(&image);
    robot_.move_by(1, 0);
    for (int n = 0; n < 20 && image.pixels.empty(); ++n) window_.step(0.01);
    if (image.pixels.empty()) return;
    vpe::core::write_image(folder_ / (name + "-" + size_ + ".png"), image.pixels, image.width, image.height);
  }

 private:
  ExploreWindow& window_;
  Robot& robot_;
  std::filesystem::path folder_;
  std::string size_;
};

constexpr const char* kFlight =
    "flight 1\n"
    "at 0 pose lon=137.2 lat=-5.2 alt=6000 yaw=60 pitch=-20\n"
    "at 20 pose lon=137.6 lat=-4.9 alt=4000 yaw=100 pitch=-15\n"
    "at 40 pose lon=138.1 lat=-4.8 alt=3000 yaw=180 pitch=-10\n";

}  // namespace

int main(int argc, char** argv) {
  using namespace vpe;
  if (argc < 3) {
    std::fprintf(stderr, "usage: panel_shots PLANET FOLDER [--size WxH]\n");
    return 2;
  }
  int width = 1280;
  int height = 720;
  if (argc > 4 && std::sscanf(argv[4], "%dx%d", &width, &height) != 2) return 2;
  const window::Screen screen(width, height);
  if (!screen.why_not().empty()) {
    std::fprintf(stderr, "%s\n", screen.why_not().c_str());
    return 1;
  }
  window::ExploreSetup setup = bench::bench_setup(argv[1], width, height);
  setup.folder = argv[2];
  setup.bookmarks = std::filesystem::path(argv[2]) / "bookmarks";
  setup.session.start = mars::Pose{137.4, -5.9, 3000, 0, -12, 0};
  setup.flight = *scripts::parse_flight(kFlight, "").flight;
  ExploreWindow window(std::move(setup));
  Robot robot;
  Photographer camera(window, robot, argv[2], std::to_string(width) + "x" + std::to_string(height));
  camera.rest();
  camera.shoot("start");
  if (!window.widgets().places().contains("View")) camera.click("\u2261##side");
  for (const char* tab : {"View", "Places", "Flight", "Measure", "Draw", "Objects", "Look", "Detail"})
    if (camera.click(tab)) camera.shoot(tab);
  const std::vector<std::pair<std::string, std::string>> by_key{{"help", "F1"}, {"map", "Tab"}};
  for (const auto& [name, key] : by_key) {
    camera.key(key);
    camera.shoot(name);
    camera.key(key);
  }
  robot.key_down("Control_L");
  camera.key("o");
  robot.key_up("Control_L");
  camera.shoot("file");
  if (camera.click("file/Preferences")) camera.shoot("preferences");
  return 0;
}
