// Tests of a whole session by hand, and of its replay from the log.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "scripts/path.h"
#include "tests/support/sanitized.h"
#include "tests/window/explore_window_fixture.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::window {
namespace {

struct Shown {
  ImageRequest request;
  core::RgbImage image;
  mars::Pose pose;
  bool is_settled = false;  // nothing was missing
};

constexpr double kFlight_s = test_support::kIsSanitized ? 10 : 2;

class SessionTest : public ExploreWindowTest {
 protected:
  // Runs iterations of the event loop and keeps every image that is shown.
  void watch(int count) {
    for (int n = 0; n < count; ++n) {
      const std::int64_t before = window_->images();
      ASSERT_TRUE(window_->step(0.01));
      if (window_->images() != before && window_->drawn()->request.logged_s)
        shown_.push_back({window_->drawn()->request, window_->image(), window_->session().pose(),
                          window_->drawn()->result.settled});
    }
  }

  scripts::Flight read_log() {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      if (entry.path().extension() != ".flight") continue;
      std::ifstream in(entry.path());
      std::stringstream text;
      text << in.rdbuf();
      const scripts::ParsedFlight parsed = scripts::parse_flight(text.str(), entry.path().string());
      EXPECT_TRUE(parsed.errors.empty()) << scripts::to_string(parsed.errors.front());
      return parsed.flight.value_or(scripts::Flight{});
    }
    ADD_FAILURE() << "there is no log";
    return {};
  }

  std::vector<Shown> shown_;
};

TEST_F(SessionTest, IsTheSameFromItsLog) {
  open();
  // Nearer, over a place clicked on the map.
  const WidgetPlace map = place_of("map");
  const auto on_map = [&](double u, double v) {
    return std::pair{map.x0 + u * (map.x1 - map.x0), map.y0 + v * (map.y1 - map.y0)};
  };
  click(on_map(0.6, 0.4).first, on_map(0.6, 0.4).second);
  settle();
  click("Flight");
  click("Record");
  EXPECT_TRUE(window_->is_recording());
  // Five waypoints on the map.
  robot_->key_down("Control_L");
  iterate(3);
  for (const double u : {0.55, 0.6, 0.65, 0.7, 0.75}) click(on_map(u, 0.45).first, on_map(u, 0.45).second);
  robot_->key_up("Control_L");
  iterate(3);
  ASSERT_NE(window_->session().flights().editor(), nullptr);
  ASSERT_EQ(window_->session().flights().editor()->flight().waypoints.size(), 5U);
  explore::FlightEditor& editor = *window_->session().flights().editor();
  ASSERT_EQ(editor.scale_times(kFlight_s / scripts::duration_s(editor.flight())), "");
  const scripts::Flight flown = editor.flight();

  // The flight plays while the user looks around and changes a setting.
  click("Play");
  ASSERT_TRUE(window_->session().follows_flight());
  move(600, 200);
  robot_->press();
  for (int n = 1; n <= 12; ++n) {
    move(600 + 15 * n, 200 + 5 * n);
    watch(2);
  }
  robot_->release();
  watch(10);
  EXPECT_TRUE(window_->session().set("colour", "slope").empty());
  watch(20);
  EXPECT_NE(window_->session().look().yaw_deg, 0);
  for (int n = 0; n < 20'000 && window_->session().player()->is_playing(); ++n) watch(1);
  EXPECT_TRUE(window_->session().player()->at_end());
  // A slow machine shows few images while the flight plays. The log goes on behind its end.
  for (int look = 0; look < 20 && shown_.size() < 8; ++look) {
    move(400, 200);
    robot_->press();
    move(415, 205);
    watch(2);
    robot_->release();
    for (int n = 0; n < 20'000 && !window_->is_at_rest(); ++n) watch(1);
  }
  for (int n = 0; n < 20'000 && !window_->is_at_rest(); ++n) watch(1);
  // Looking around has not moved the flight.
  EXPECT_EQ(flown, window_->session().flights().editor()->flight());
  EXPECT_EQ(window_->session().pose().lon_deg, flown.waypoints.back().lon_deg);
  EXPECT_EQ(window_->session().pose().alt_m, flown.waypoints.back().up_m);
  click("Record");
  EXPECT_FALSE(window_->is_recording());
  window_.reset();

  const scripts::Flight log = read_log();
  const double radius_m = planet()->radius_m();
  const scripts::Path path(log, radius_m, {});
  ASSERT_GE(shown_.size(), 5U);
  core::Settings first;
  const auto renderer = voxel::make_ray_renderer(planet(), {std::size_t{256} << 20, 2});
  int compared = 0;
  double off_m = 0;
  double off_rad = 0;
  for (const Shown& shown : shown_) {
    const double time_s = *shown.request.logged_s;
    const mars::CameraPose camera = path.at(time_s).camera;
    const mars::CameraPose& drawn = shown.request.draw.view.camera;
    off_m = std::max(off_m, glm::length(camera.position_m - drawn.position_m));
    off_rad = std::max(off_rad, mars::angle_between_rad(camera.axes.forward, drawn.axes.forward));
    off_rad = std::max(off_rad, mars::angle_between_rad(camera.axes.up, drawn.axes.up));
    if (!shown.request.is_full || !shown.is_settled || compared >= 3) continue;
    core::Settings settings = first;
    path.apply_settings(time_s, settings);
    core::DrawRequest request;
    request.view = shown.request.draw.view;
    request.view.camera = camera;
    request.settings = settings.values();
    request.sun = app::sun_for(settings.values(), path.at(time_s).pose);
    const core::Frame frame = renderer->draw(request).frame;
    EXPECT_EQ(frame.colour, shown.image.pixels) << "at " << time_s;
    ++compared;
  }
  EXPECT_LT(off_m, 1e-9 * radius_m);
  EXPECT_LT(off_rad, 1e-9);
  RecordProperty("off_m", std::to_string(off_m));
  EXPECT_GE(compared, 1);
}

// Records zooms, a change of the backend and pairs of eyes, and shows the log in another window.
TEST_F(SessionTest, ZoomsBackendsAndEyesReplayFromItsLog) {
  open();
  const auto rest = [&] {
    watch(6);
    for (int n = 0; n < 20'000 && !window_->is_at_rest(); ++n) watch(1);
  };
  ASSERT_EQ(window_->act({explore::ActionKind::kRecord}), "");
  window_->session().set_fov(30);
  rest();
  click("##eyes");
  click("##eyes=red and cyan");
  rest();
  window_->session().set_fov(22.75);
  rest();
  click("##eyes");
  click("##eyes=off");
  click("Triangles");
  rest();
  ASSERT_EQ(window_->act({explore::ActionKind::kRecord}), "");
  window_.reset();
  const scripts::Flight log = read_log();
  const scripts::Path path(log, planet()->radius_m(), {});
  std::set<std::pair<core::Backend, bool>> seen;
  const auto expect_view = [](const scripts::ViewState& view, const ImageRequest& request) {
    EXPECT_EQ(view.fov_deg, request.draw.view.fov_deg);
    EXPECT_EQ(view.backend, core::drawn_by(request.backend));
    EXPECT_EQ(view.eyes, scripts::Eyes{request.stereo});
    if (request.stereo) {
      EXPECT_EQ(view.eye_base_m, request.eye_base_m);
    }
  };
  for (const Shown& shown : shown_) {
    expect_view(path.at(*shown.request.logged_s).view, shown.request);
    seen.emplace(shown.request.backend, shown.request.stereo.has_value());
  }
  EXPECT_EQ(seen.size(), 3U);

  extra_.flight = log;
  open();
  window_->session().set_fov(70);
  settle();
  ASSERT_EQ(window_->session().follow(false), "");
  for (const Shown& shown : shown_) {
    if (!shown.request.is_full) continue;
    window_->session().scrub(*shown.request.logged_s);
    settle();
    const ImageRequest& again = window_->drawn()->request;
    expect_view(path.at(*shown.request.logged_s).view, again);
    if (again.backend == core::Backend::kRay) {
      EXPECT_EQ(window_->image().pixels, shown.image.pixels);
    }
  }
  EXPECT_EQ(window_->drawn()->request.backend, core::Backend::kPolygon);
  // All is given back.
  window_->session().leave_flight();
  settle();
  EXPECT_EQ(window_->drawn()->request.backend, core::Backend::kRay);
  EXPECT_EQ(window_->drawn()->request.draw.view.fov_deg, 70);
  EXPECT_FALSE(window_->drawn()->request.stereo.has_value());
}

// Rays that nobody named keep to the tolerance. The log has the mode that they had.
TEST_F(SessionTest, ImagesByRaysThatNobodyNamedAreTheSameFromItsLog) {
  open();
  window_->session().put({20, 30, 50'000, 0, -30, 0});
  click("Auto");
  settle();
  ASSERT_EQ(window_->act({explore::ActionKind::kRecord}), "");
  window_->session().set_fov(40);
  watch(6);
  for (int n = 0; n < 20'000 && !window_->is_at_rest(); ++n) watch(1);
  ASSERT_EQ(window_->act({explore::ActionKind::kRecord}), "");
  ASSERT_FALSE(shown_.empty());
  const Shown shown = shown_.back();
  ASSERT_TRUE(shown.request.is_auto && shown.request.is_full);
  ASSERT_EQ(shown.request.backend, core::Backend::kRay);
  window_.reset();
  const scripts::Path path(read_log(), planet()->radius_m(), {});
  const scripts::FlightState state = path.at(*shown.request.logged_s);
  EXPECT_EQ(state.view.backend, core::DrawnBy::kRay);
  core::Settings settings;
  path.apply_settings(*shown.request.logged_s, settings);
  EXPECT_EQ(settings.values().ray_mode, core::RayMode::kMultires);
  core::DrawRequest request;
  request.view = shown.request.draw.view;
  request.view.camera = state.camera;
  request.view.fov_deg = *state.view.fov_deg;
  request.settings = settings.values();
  request.sun = app::sun_for(settings.values(), state.pose);
  const auto renderer = voxel::make_ray_renderer(planet(), {std::size_t{256} << 20, 2});
  EXPECT_EQ(renderer->draw(request).frame.colour, shown.image.pixels);
}

TEST_F(SessionTest, BookmarksAndViewsLeadBack) {
  open();
  const mars::Pose start = window_->session().pose();
  robot_->key_down("Control_L");
  iterate(2);
  key("1");
  robot_->key_up("Control_L");
  iterate(2);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "bookmarks"));
  click(600, 240);
  robot_->wheel(8);
  settle();
  EXPECT_LT(window_->session().pose().alt_m, start.alt_m / 2);
  // A view counts once it has been looked at for half a second.
  const double begun = glfwGetTime();
  while (glfwGetTime() < begun + 0.7) iterate(1);
  key("1");
  settle();
  EXPECT_NEAR(window_->session().pose().alt_m, start.alt_m, 1e-6);
  key("BackSpace");
  settle();
  EXPECT_LT(window_->session().pose().alt_m, start.alt_m / 2);
}

TEST_F(SessionTest, ASavedImageIsTheOneShown) {
  open();
  key("F12");
  settle();
  int images = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    if (entry.path().extension() != ".png") continue;
    ++images;
    const core::RgbImage saved = core::read_image(entry.path().string());
    EXPECT_EQ(saved.pixels, window_->image().pixels);
  }
  EXPECT_EQ(images, 1);
}

TEST_F(SessionTest, AGamepadASpaceMouseAndAHeadMoveTheCamera) {
  struct Cap : explore::SpaceMouseSource {
    std::vector<explore::SpaceMouseEvent> next;
    std::vector<explore::SpaceMouseEvent> poll() override { return std::exchange(next, {}); }
  };
  auto cap = std::make_unique<Cap>();
  Cap* hand = cap.get();
  auto pad = std::make_shared<std::optional<explore::PadState>>();
  extra_.devices.pad = [pad] { return *pad; };
  extra_.devices.space_mouse = std::move(cap);
  extra_.preferences.use_head_tracker = true;
  extra_.preferences.head_from.port = 0;
  open();
  const mars::Pose start = window_->session().pose();
  *pad = explore::PadState{};
  (*pad)->axes[static_cast<std::size_t>(explore::PadAxis::kRightX)] = 1;
  iterate(12);
  EXPECT_NE(window_->session().pose().yaw_deg, start.yaw_deg);
  pad->reset();
  iterate(2);
  const double alt_m = window_->session().pose().alt_m;
  hand->next.push_back(explore::SpaceMouseMotion{{0, 0, 350}, {0, 0, 0}});
  iterate(12);
  EXPECT_LT(window_->session().pose().alt_m, alt_m);  // ahead is down
  hand->next.push_back(explore::SpaceMouseMotion{});
  iterate(2);

  // A head, 20 degrees to the right; one datagram is no datagram.
  ASSERT_TRUE(window_->devices().tracker_port().has_value());
  const int out = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(*window_->devices().tracker_port()));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const std::array<double, 6> head{0, 0, 0, 20, 5, 0};
  const auto send = [&](std::size_t bytes) {
    EXPECT_EQ(sendto(out, head.data(), bytes, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to),
              static_cast<ssize_t>(bytes));
  };
  const mars::Pose pose = window_->session().pose();
  send(sizeof head - 1);
  iterate(3);
  EXPECT_EQ(window_->session().look().yaw_deg, 0);
  for (int n = 0; n < 5'000 && window_->session().look().yaw_deg < 19; ++n) {
    send(sizeof head);
    iterate(1);
  }
  EXPECT_NEAR(window_->session().look().yaw_deg, 20, 1);
  EXPECT_NEAR(window_->session().look().pitch_deg, 5, 1);
  EXPECT_EQ(window_->session().pose().yaw_deg, pose.yaw_deg);  // the platform stays
  close(out);
}

TEST_F(SessionTest, AWaypointIsDraggedAndARegionDrawnOnTheMap) {
  open();
  click("Flight");
  const WidgetPlace map = place_of("map");
  const auto x_of = [&](double u) { return map.x0 + u * (map.x1 - map.x0); };
  const auto y_of = [&](double v) { return map.y0 + v * (map.y1 - map.y0); };
  robot_->key_down("Control_L");
  iterate(2);
  click(x_of(0.3), y_of(0.3));
  click(x_of(0.5), y_of(0.3));
  robot_->key_up("Control_L");
  iterate(2);
  const explore::FlightEditor* editor = window_->session().flights().editor();
  ASSERT_NE(editor, nullptr);
  const scripts::Flight before = editor->flight();
  move(x_of(0.3), y_of(0.3));
  robot_->press();
  iterate(2);
  for (int n = 1; n <= 4; ++n) move(x_of(0.3), y_of(0.3 + 0.05 * n));
  robot_->release();
  iterate(2);
  const double degrees_px = 180.0 / (map.y1 - map.y0);
  EXPECT_NEAR(editor->flight().waypoints[0].lat_deg, before.waypoints[0].lat_deg - 0.2 * 180, 2 * degrees_px);
  EXPECT_EQ(editor->flight().waypoints[0].up_m, before.waypoints[0].up_m);
  EXPECT_EQ(editor->flight().waypoints[1], before.waypoints[1]);
  click("Undo");  // the drag is one step
  EXPECT_EQ(editor->flight(), before);

  robot_->key_down("Shift_L");
  move(x_of(0.7), y_of(0.6));
  robot_->press();
  iterate(2);
  for (int n = 1; n <= 4; ++n) move(x_of(0.7), y_of(0.6 + 0.02 * n));
  robot_->release();
  iterate(2);
  robot_->key_up("Shift_L");
  settle();
  ASSERT_EQ(window_->session().interest().size(), 1U);
  const core::InterestRegion region = window_->session().interest().front();
  EXPECT_NEAR(region.lon_deg, 0.2 * 360, 2 * degrees_px);
  EXPECT_NEAR(region.radius_m / planet()->radius_m() / mars::kRadiansPerDegree, 0.08 * 180, 2 * degrees_px);
  EXPECT_EQ(window_->drawn()->request.draw.interest.size(), 1U);
}

TEST_F(SessionTest, TwoEyesInEveryLayout) {
  open();
  const explore::Screen view = window_->session().screen();
  for (const auto& [name, layout] : {std::pair{"side by side", core::StereoLayout::kSideBySide},
                                     std::pair{"over and under", core::StereoLayout::kOverUnder},
                                     std::pair{"red and cyan", core::StereoLayout::kAnaglyph}}) {
    click("##eyes");
    click(std::string("##eyes=") + name);
    settle();
    ASSERT_EQ(window_->drawn()->request.stereo, layout);
    const explore::Screen& screen = window_->session().screen();
    EXPECT_EQ(window_->image().width, screen.width * (layout == core::StereoLayout::kSideBySide ? 2 : 1));
    EXPECT_EQ(window_->image().height, screen.height * (layout == core::StereoLayout::kOverUnder ? 2 : 1));
    // Together they fill the view, but for a last odd line.
    EXPECT_NEAR(window_->image().width, view.width, 1);
    EXPECT_NEAR(window_->image().height, view.height, 1);
  }
}

}  // namespace
}  // namespace vpe::window
