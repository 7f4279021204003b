// Tests of screens with windows of their own: what they show on a virtual screen, for a head that moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/window/explore_window_fixture.h"
#include "tests/window/screen_pixels.h"
#include "vpe/explore/screens/lens_table.h"
#include "vpe/explore/screens/screens_file.h"

// After the project's: they are the system's.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace vpe::window {
namespace {

// A wall before the head and a table below it, right of the session's window.
const char* const kWallAndTable = R"(version = 1
scale = 100000
level = true
head = [0, 0.5, 0.6]
[[screen]]
name = "wall"
window = [1000, 0]
pixels = [320, 240]
upper_left = [-0.4, 0.7, -0.4]
upper_right = [0.4, 0.7, -0.4]
lower_left = [-0.4, 0.1, -0.4]
[[screen]]
name = "table"
window = [1000, 300]
pixels = [400, 250]
upper_left = [-0.4, 0, -0.2]
upper_right = [0.4, 0, -0.2]
lower_left = [-0.4, 0, 0.3]
)";

const char* const kVisor = R"(version = 1
[[screen]]
name = "left eye"
eye = "left"
window = [1000, 0]
pixels = [200, 220]
lens = { field = 80, distortion = [0.2, 0.1], axes = 0.06, width = 0.07 }
[[screen]]
name = "pair"
eye = "both"
window = [1300, 0]
pixels = [200, 150]
upper_left = [-0.4, 0.3, -1]
upper_right = [0.4, 0.3, -1]
lower_left = [-0.4, -0.3, -1]
)";

class ScreensTest : public ExploreWindowTest {
 protected:
  void open_screens(const char* text) {
    extra_.screens = explore::parse_screens_toml(text, "test.screens.toml");
    extra_.preferences.use_head_tracker = true;
    extra_.preferences.head_from.port = 0;  // any free one
    extra_.preferences.head.smoothing_s = 0;
    open();
    window_->session().put({20, 10, 60'000, 30, -35, 0});
    settle();
    ASSERT_NE(window_->screens(), nullptr);
  }

  void send(const explore::HeadPlace& head) {
    const double numbers[6] = {100 * head.position_m.x, 100 * head.position_m.y, 100 * head.position_m.z,
                               head.look.yaw_deg,       head.look.pitch_deg,     head.look.roll_deg};
    const int socket_number = socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(*window_->devices().tracker_port()));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(
        sendto(socket_number, numbers, sizeof numbers, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to),
        static_cast<ssize_t>(sizeof numbers));
    close(socket_number);
  }

  // Holds the head at a place until all images of it are final.
  void hold(const explore::HeadPlace& head) {
    for (int n = 0; n < 3'000; ++n) {
      send(head);
      ASSERT_TRUE(window_->step(0.01));
      const std::int64_t rounds = window_->screens()->rounds();
      if (n > 60 && window_->is_at_rest() && rounds == window_->screens()->rounds()) return;
    }
    FAIL() << "the screens do not come to rest";
  }

  // Returns the image of a screen as a painter of its own draws it.
  core::RgbImage expected(std::size_t n, const explore::HeadPlace& head, int side) {
    const explore::ScreenSet& set = window_->screens()->set();
    const explore::PlacedScreen& screen = set.screens[n].screen;
    const mars::CameraPose platform =
        explore::screen_platform(window_->session().pose(), set.is_level, planet_->radius_m());
    const auto view = explore::screen_view(screen, head, platform, explore::room_of(set), side);
    if (!view) return {};
    ImageRequest request;
    request.backend = core::Backend::kRay;
    request.draw.view = *view;
    request.draw.settings = window_->session().settings().values();
    request.draw.sun = app::sun_for(request.draw.settings, window_->session().pose());
    app::Common common;
    common.memory_mb = 256;
    app::WindowPainter painter(planet_, common);
    core::RgbImage image = painter.paint(request).image;
    if (const auto* lens = std::get_if<explore::ScreenLens>(&screen.place))
      image = explore::through_lens(image, {*lens, screen.width_px, screen.height_px, side});
    return image;
  }

  core::RgbImage shown(std::size_t n) {
    const explore::ScreenSet::Entry& entry = window_->screens()->set().screens[n];
    const glm::ivec2 place = std::get<glm::ivec2>(entry.screen.window);
    return screen_pixels(place.x, place.y, entry.window_px.x, entry.window_px.y);
  }

  static double share_alike(const core::RgbImage& a, const core::RgbImage& b) {
    if (a.pixels.size() != b.pixels.size() || a.pixels.empty()) return 0;
    std::size_t alike = 0;
    for (std::size_t n = 0; n < a.pixels.size(); ++n) {
      const auto off = [](std::uint8_t one, std::uint8_t other) { return std::abs(one - other); };
      const base::Rgb& p = a.pixels[n];
      const base::Rgb& q = b.pixels[n];
      alike += std::max({off(p.r, q.r), off(p.g, q.g), off(p.b, q.b)}) <= 2 ? 1 : 0;
    }
    return static_cast<double>(alike) / static_cast<double>(a.pixels.size());
  }
};

TEST_F(ScreensTest, EachWindowShowsTheWorldThroughItsScreen) {
  open_screens(kWallAndTable);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_GE(share_alike(shown(n), expected(n, {}, 0)), 0.999) << n;
    EXPECT_GE(share_alike(window_->screens()->window(n).read_back(), shown(n)), 0.999) << n;
  }
  const core::RgbImage wall = shown(0);
  const core::RgbImage table = shown(1);
  // The head moves: the images are those of its new place, and others than before.
  const explore::HeadPlace head{{0.3, 0.15, -0.2}, {20, -10, 5}};
  hold(head);
  for (std::size_t n = 0; n < 2; ++n) EXPECT_GE(share_alike(shown(n), expected(n, head, 0)), 0.999) << n;
  EXPECT_LT(share_alike(shown(0), wall), 0.9);
  // The ground lies near the table, so its colours stay where they are.
  EXPECT_GT(share_alike(shown(1), table), 0.95);
  // Below the table's plane there is nothing to see on it.
  hold({{0, -0.6, 0}, {}});
  for (const base::Rgb& pixel : shown(1).pixels) ASSERT_EQ(pixel, (base::Rgb{0, 0, 0}));
  EXPECT_GE(share_alike(shown(0), expected(0, {{0, -0.6, 0}, {}}, 0)), 0.999);
}

TEST_F(ScreensTest, ThePlatformMovesAllScreens) {
  open_screens(kWallAndTable);
  const core::RgbImage wall = shown(0);
  const core::RgbImage table = shown(1);
  window_->session().put({25, 12, 70'000, -60, -20, 0});
  settle();
  for (std::size_t n = 0; n < 2; ++n) EXPECT_GE(share_alike(shown(n), expected(n, {}, 0)), 0.999) << n;
  EXPECT_LT(share_alike(shown(0), wall), 0.9);
  EXPECT_LT(share_alike(shown(1), table), 0.9);
  // At rest nothing is drawn.
  const std::int64_t rounds = window_->screens()->rounds();
  iterate(20);
  EXPECT_EQ(window_->screens()->rounds(), rounds);
}

TEST_F(ScreensTest, LensesAndPairsHaveTheirEyes) {
  open_screens(kVisor);
  EXPECT_GE(share_alike(shown(0), expected(0, {}, -1)), 0.999);
  // Without pairs in turn the middle is shown, and said so.
  if (!window_->screens()->window(1).has_pairs()) {
    ASSERT_EQ(window_->screens()->notes().size(), 1U);
    EXPECT_NE(window_->screens()->notes()[0].find("frame-sequential"), std::string::npos);
    EXPECT_GE(share_alike(shown(1), expected(1, {}, 0)), 0.999);
  }
}

TEST_F(ScreensTest, AMonitorThatIsNotThereIsToldWithThoseThatAre) {
  std::string text = kWallAndTable;
  text.replace(text.find("window = [1000, 0]"), 18, "monitor = 7");
  extra_.screens = explore::parse_screens_toml(text, "test.screens.toml");
  try {
    open();
    FAIL() << "monitor 7 is there";
  } catch (const DisplayError& e) {
    EXPECT_NE(std::string(e.what()).find("there is no monitor 7; monitors are: 1"), std::string::npos)
        << e.what();
  }
}

TEST_F(ScreensTest, AMonitorCanBeFilled) {
  std::string text = kWallAndTable;
  text.replace(text.find("window = [1000, 0]"), 18, "monitor = 1");
  extra_.screens = explore::parse_screens_toml(text, "test.screens.toml");
  open();
  int width = 0;
  int height = 0;
  glfwGetWindowSize(window_->screens()->window(0).handle(), &width, &height);
  EXPECT_EQ(width, 2600);
  EXPECT_EQ(height, 1500);
}

}  // namespace
}  // namespace vpe::window
