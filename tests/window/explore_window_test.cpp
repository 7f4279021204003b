// Tests of the window of `vpe explore` with simulated mouse and keys on a virtual screen.
#include "vpe/window/explore_window.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <thread>

#include "mars/geodesy/sun.h"
#include "tests/window/explore_window_fixture.h"
#include "vpe/core/image/image.h"
#include "vpe/explore/steer.h"

namespace vpe::window {
namespace {

TEST_F(ExploreWindowTest, ShowsThePlanetAndComesToRest) {
  open();
  ASSERT_NE(window_->drawn(), nullptr);
  EXPECT_TRUE(window_->drawn()->error.empty());
  EXPECT_TRUE(window_->drawn()->request.is_full);
  EXPECT_EQ(window_->image().width, window_->session().screen().width);
  const std::int64_t frames = window_->frames();
  const std::int64_t images = window_->images();
  for (int n = 0; n < 50; ++n) window_->step(0.001);
  EXPECT_EQ(window_->frames(), frames);  // draws only when something changes
  EXPECT_EQ(window_->images(), images);
}

TEST_F(ExploreWindowTest, AClickOnTheMapGoesThere) {
  open();
  const WidgetPlace map = window_->widgets().places().at("map");
  click(map.x0 + 0.75 * (map.x1 - map.x0), map.y0 + 0.25 * (map.y1 - map.y0));
  settle();
  EXPECT_NEAR(window_->session().pose().lon_deg, 90, 2);
  EXPECT_NEAR(window_->session().pose().lat_deg, 45, 2);
}

TEST_F(ExploreWindowTest, ADragHoldsTheGround) {
  open();
  click(600, 240);
  settle();
  const explore::Screen screen = window_->session().screen();
  const auto held =
      explore::ground_at(window_->session().pose(), screen, {600 - 330, 250}, window_->session().ground());
  ASSERT_TRUE(held.has_value());
  move(600, 250);
  robot_->press();
  iterate(2);
  for (int n = 1; n <= 10; ++n) move(600 + 10 * n, 250 + 4 * n);
  std::this_thread::sleep_for(std::chrono::milliseconds(150));  // without a rest the release is a throw
  robot_->release();
  settle();
  const core::Projected now = core::project(window_->session().view(), *held);
  EXPECT_NEAR(now.xy.x, 700 - 330, 1.0);
  EXPECT_NEAR(now.xy.y, 290, 1.0);
}

TEST_F(ExploreWindowTest, TheFrameAfterAnEventShowsIt) {
  open();
  int left = 0;
  int top = 0;
  glfwGetWindowPos(window_->display().handle(), &left, &top);
  move(600, 250);
  settle();
  const mars::Pose pose = window_->session().pose();
  robot_->press();
  iterate(2);
  const std::int64_t before = window_->images();
  robot_->move(620 + left, 250 + top);
  for (int n = 0; n < 100 && window_->session().pose().lon_deg == pose.lon_deg; ++n) window_->step(0.01);
  ASSERT_NE(window_->session().pose().lon_deg, pose.lon_deg);
  // The iteration that handled the event has requested the image; it is the next one shown.
  for (int n = 0; n < 10'000 && window_->images() == before; ++n) window_->step(0.01);
  EXPECT_EQ(glm::length(window_->drawn()->request.draw.view.camera.position_m -
                        window_->session().view().camera.position_m),
            0.0);
  robot_->release();
}

TEST_F(ExploreWindowTest, EveryModeAndBothBackendsWhileRunning) {
  open();
  for (const char* backend : {"Triangles", "Rays"}) {
    click(backend);
    settle();
    EXPECT_EQ(window_->drawn()->request.backend,
              backend == std::string("Rays") ? core::Backend::kRay : core::Backend::kPolygon);
    EXPECT_TRUE(window_->drawn()->error.empty()) << window_->drawn()->error;
    for (const char* mode : {"wireframe", "markers", "unlit", "lit", "coloured", "textured"}) {
      // Rays draw surfaces only; lines and dots are rejected with a reason, and the window continues.
      ASSERT_EQ(window_->session().set("mode", mode), "");
      settle();
    }
    click("Look");
    const std::array<std::array<const char*, 3>, 5> looks{{{"Elevation", "coloured", "elevation"},
                                                           {"Slope", "coloured", "slope"},
                                                           {"Aspect", "coloured", "aspect"},
                                                           {"Relief", "lit", "aspect"},
                                                           {"Photo", "textured", "aspect"}}};
    for (const auto& [look, mode, colour] : looks) {
      click(look);
      settle();
      EXPECT_EQ(window_->session().settings().get("mode"), mode);
      EXPECT_EQ(window_->session().settings().get("colour"), colour);
      EXPECT_TRUE(window_->drawn()->error.empty()) << window_->drawn()->error;
    }
    click("View");
  }
}

TEST_F(ExploreWindowTest, FGoesThroughTheModesAndCtrlWithALetterNeverMoves) {
  open();
  window_->session().put({20, 10, 30'000, 0, -60, 0});
  settle();
  key("f");
  EXPECT_EQ(window_->session().mode(), explore::MotionMode::kFly);
  EXPECT_NE(window_->state().message.find("fly"), std::string::npos) << window_->state().message;
  const mars::Pose before = window_->session().pose();
  robot_->key_down("w");
  iterate(10);
  robot_->key_up("w");
  settle();
  EXPECT_GT(window_->session().pose().lat_deg, before.lat_deg);
  EXPECT_NEAR(window_->session().pose().alt_m, before.alt_m, 1e-6) << "whatever the pitch";
  robot_->key_down("space");
  iterate(10);
  robot_->key_up("space");
  settle();
  EXPECT_GT(window_->session().pose().alt_m, before.alt_m + 1);
  EXPECT_FALSE(window_->session().follows_flight());
  const mars::Pose high = window_->session().pose();
  robot_->key_down("Control_L");
  robot_->key_down("s");
  iterate(10);
  robot_->key_up("s");
  robot_->key_up("Control_L");
  settle();
  EXPECT_EQ(window_->session().pose().lat_deg, high.lat_deg);
  key("f");
  EXPECT_EQ(window_->session().mode(), explore::MotionMode::kWalk);
  settle();
  EXPECT_NEAR(window_->session().height_m(), 1.7, 1e-6);
  EXPECT_TRUE(window_->shows_final_image());
  key("f");
  EXPECT_EQ(window_->session().mode(), explore::MotionMode::kOrbit);
}

TEST_F(ExploreWindowTest, KeysMoveRotateAndHide) {
  open();
  click(600, 240);  // the view has the focus
  settle();
  const mars::Pose before = window_->session().pose();
  robot_->key_down("w");
  iterate(10);
  robot_->key_up("w");
  settle();
  EXPECT_LT(window_->session().pose().alt_m, before.alt_m);  // looks down, so forward is down
  robot_->key_down("Right");
  iterate(10);
  robot_->key_up("Right");
  settle();
  EXPECT_NE(window_->session().pose().yaw_deg, before.yaw_deg);
  key("n");
  settle();
  EXPECT_NEAR(window_->session().pose().yaw_deg, 0, 1e-9);
  key("h");
  settle();
  EXPECT_EQ(window_->session().screen().width, 960);
  key("h");
  settle();
  EXPECT_LT(window_->session().screen().width, 960);
}

TEST_F(ExploreWindowTest, NothingOverlaps) {
  for (const auto& [width, height] : {std::pair{1280, 720}, std::pair{2560, 1440}}) {
    open(width, height);
    for (const char* tab : {"View", "Look", "Detail"}) {
      click(tab);
      settle();
      const auto& places = window_->widgets().places();
      for (auto a = places.begin(); a != places.end(); ++a) {
        for (auto b = std::next(a); b != places.end(); ++b) {
          const double w = std::min(a->second.x1, b->second.x1) - std::max(a->second.x0, b->second.x0);
          const double h = std::min(a->second.y1, b->second.y1) - std::max(a->second.y0, b->second.y0);
          EXPECT_FALSE(w > 1 && h > 1) << a->first << " and " << b->first << " at " << width;
        }
      }
    }
    window_.reset();
  }
}

TEST_F(ExploreWindowTest, WithoutADisplayTheErrorNamesAnAlternative) {
  unsetenv("DISPLAY");
  DisplayOptions options;
  options.instead = "do something else";
  try {
    Display display(options);
    FAIL() << "a window without a display";
  } catch (const DisplayError& e) {
    EXPECT_NE(std::string(e.what()).find("do something else"), std::string::npos);
  }
}

// In pairs side by side each half is a view of its own. The ground under the cursor is that of the half's image.
TEST_F(ExploreWindowTest, TheCursorIsOnTheGroundShownThereAlsoInPairs) {
  open();
  click("##eyes");
  click("##eyes=side by side");
  settle();
  const explore::Screen screen = window_->session().screen();
  // The same place of both eyes' images: a quarter of the way from their middles to their right ends.
  const double half = screen.width;
  ASSERT_EQ(half, 315);
  for (const double left : {330.0, 330.0 + half}) {
    const auto eye_view = [&] {
      const double base_m = window_->drawn()->request.eye_base_m;
      return core::eye_view(window_->session().view(), (left == 330 ? -0.5 : 0.5) * base_m, std::nullopt);
    };
    const double x = left + half * 0.6;
    const double y = screen.height / 2.0;
    move(x, y);
    settle();
    const mars::Pose before = window_->session().pose();
    const auto place = window_->session().place_at(eye_view(), {0.6 * screen.width, 0.5 * screen.height});
    ASSERT_TRUE(place.has_value());
    const glm::dvec3 up = mars::direction(*place);
    const glm::dvec3 under =
        up * (window_->session().ground().radius_m + window_->session().ground().height_m(up));
    robot_->wheel(1);
    iterate(5);
    settle();
    const core::Projected now = core::project(eye_view(), under);
    EXPECT_NEAR(now.xy.x, 0.6 * screen.width, 0.5) << left;
    EXPECT_NEAR(now.xy.y, 0.5 * screen.height, 0.5) << left;
    EXPECT_LT(window_->session().pose().alt_m, before.alt_m);
  }
}

TEST_F(ExploreWindowTest, ItRestsWithHiddenPanels) {
  open();
  key("Tab");
  key("Tab");
  key("h");
  settle();
  const std::int64_t frames = window_->frames();
  for (int n = 0; n < 50; ++n) window_->step(0.001);
  EXPECT_EQ(window_->frames(), frames);
}

TEST_F(ExploreWindowTest, AnImageThatCannotBeDrawnIsReplacedByAMessage) {
  open();
  ASSERT_EQ(window_->session().set("mode", "wireframe"), "");
  settle();
  EXPECT_FALSE(window_->state().image_error.empty());
  EXPECT_FALSE(window_->shows_final_image());
  click("Triangles");
  settle();
  EXPECT_TRUE(window_->state().image_error.empty());
  EXPECT_TRUE(window_->shows_final_image());
}

// Numbers that were typed are kept however the field is left, except by Esc.
TEST_F(ExploreWindowTest, ATypedNumberIsKeptWhenTheFieldIsLeft) {
  open();
  const auto type = [&](const std::string& digits) {
    const WidgetPlace p = place_of("Heading");
    click(p.x0 + 0.2 * (p.x1 - p.x0), (p.y0 + p.y1) / 2);
    for (const char digit : digits) key(std::string(1, digit));
  };
  type("55");
  EXPECT_NE(window_->session().pose().yaw_deg, 5);  // not while it is typed
  key("Tab");
  settle();
  EXPECT_EQ(window_->session().pose().yaw_deg, 55);
  EXPECT_FALSE(window_->state().large_map);
  type("66");
  click(700, 200);  // into the view
  settle();
  EXPECT_EQ(window_->session().pose().yaw_deg, 66);
  type("77");
  click("Pitch");
  iterate(5);
  EXPECT_EQ(window_->session().pose().yaw_deg, 77);
  type("88");
  click("Look");  // the field is gone
  settle();
  EXPECT_EQ(window_->session().pose().yaw_deg, 88);
  click("View");
  settle();
  type("99");
  key("Escape");
  settle();
  EXPECT_EQ(window_->session().pose().yaw_deg, 88);
  const WidgetPlace p = place_of("Heading");
  const double step_px = (p.y1 - p.y0) * 0.5;
  // The last two squares of the field are the steps; the label follows.
  click(p.x0 + 11 * (p.y1 - p.y0) * 14 / 20 - step_px, (p.y0 + p.y1) / 2);
  settle();
  EXPECT_NE(window_->session().pose().yaw_deg, 88);
}

// All keys arrive between two frames.
TEST_F(ExploreWindowTest, AQuicklyTypedNumberIsTaken) {
  open();
  const WidgetPlace p = place_of("Heading");
  click(p.x0 + 0.2 * (p.x1 - p.x0), (p.y0 + p.y1) / 2);
  robot_->key("2");
  robot_->key("3");
  robot_->key("Return");
  settle();
  EXPECT_EQ(window_->session().pose().yaw_deg, 23);
  key("w");  // the keyboard belongs to the view again
  EXPECT_FALSE(ImGui::GetIO().WantTextInput);
}

TEST_F(ExploreWindowTest, TabGivesNoFieldTheKeyboard) {
  open();
  click("Flight");
  key("p");
  key("p");
  key("Tab");
  EXPECT_TRUE(window_->state().large_map);
  click("Undo");
  key("Tab");
  settle();
  EXPECT_FALSE(window_->state().large_map);
  EXPECT_FALSE(ImGui::GetIO().WantTextInput);
}

TEST_F(ExploreWindowTest, TheFlightPanelStaysAtItsPlace) {
  open();
  click("Flight");
  key("p");
  settle();
  window_->session().player();
  iterate(3);
  const WidgetPlace before = place_of("Save");
  ASSERT_EQ(window_->session().follow(true), "");
  window_->session().player()->set_look_offset({10, 5, 0});
  settle();
  EXPECT_EQ(place_of("Save").y0, before.y0);
}

TEST_F(ExploreWindowTest, KeysMoveThePlatformWhileAFlightPlays) {
  open();
  click("Flight");
  const scripts::ParsedFlight parsed = scripts::parse_flight(
      "flight 1\nat 0 pose lon=0 lat=0 alt=200000 yaw=90\nat 1000 pose lon=5 lat=0 alt=200000 yaw=90\n", "");
  ASSERT_EQ(window_->session().flights().load(*parsed.flight), "");
  ASSERT_EQ(window_->session().follow(true), "");
  iterate(3);
  const WidgetPlace before = place_of("Save");
  click(600, 240);  // the view has the focus
  robot_->key_down("a");
  iterate(10);
  robot_->key_up("a");
  iterate(3);
  EXPECT_TRUE(window_->session().follows_flight());
  EXPECT_GT(window_->session().pose().lat_deg, 0.001);
  EXPECT_EQ(place_of("Save").y0, before.y0);
  click("On course");
  iterate(3);
  EXPECT_NEAR(window_->session().pose().lat_deg, 0, 1e-9);
  EXPECT_TRUE(window_->session().follows_flight());
}

// A program that is killed leaves a copy, and the next one offers it.
TEST_F(ExploreWindowTest, AnUnsavedFlightOutlivesTheProgram) {
  open();
  key("p");
  iterate(3);
  std::filesystem::path copy;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "state")) copy = entry.path();
  ASSERT_FALSE(copy.empty());
  EXPECT_EQ(copy.extension(), ".flight");
  const scripts::Flight flight = window_->session().flights().editor()->flight();
  window_.reset();  // without exit_message(), as if it were killed
  // No process has this number.
  const std::filesystem::path of_dead =
      folder_ / "state" /
      std::regex_replace(copy.filename().string(), std::regex("-[0-9]+\\.flight$"), "-999999999.flight");
  std::filesystem::rename(copy, of_dead);
  open();
  EXPECT_NE(opening_message_.find("unsaved flight"), std::string::npos) << opening_message_;
  click("Flight");
  click("Restore");
  ASSERT_NE(window_->session().flights().editor(), nullptr);
  EXPECT_EQ(window_->session().flights().editor()->flight(), flight);
  EXPECT_TRUE(window_->session().flights().editor()->is_changed());
  iterate(3);
  EXPECT_TRUE(std::filesystem::exists(copy));
  EXPECT_FALSE(std::filesystem::exists(of_dead));
  click("Save");
  iterate(3);
  EXPECT_FALSE(std::filesystem::exists(copy));
}

TEST_F(ExploreWindowTest, TheSessionIsKeptWhileItRuns) {
  int kept = 0;
  mars::Pose last;
  extra_.keep_session = [&](const ExploreWindow& shown) {
    ++kept;
    last = shown.session().pose();
  };
  open();
  const int before = kept;
  window_->session().put({12, 3, 90000, 10, -40, 0});
  const double begun = glfwGetTime();
  while (glfwGetTime() < begun + 10 && kept == before) iterate(1);
  settle();
  EXPECT_GT(kept, before);
  EXPECT_EQ(last.lon_deg, 12);
  const int rest = kept;
  const double still = glfwGetTime();
  while (glfwGetTime() < still + 2.5) iterate(1);
  EXPECT_EQ(kept, rest);
}

// Messages and the sign of recording are seen also without panels.
TEST_F(ExploreWindowTest, HiddenPanelsHideNoMessage) {
  open();
  key("h");
  settle();
  core::RgbImage plain;
  window_->capture(&plain);
  key("F1");
  key("F1");
  settle();
  ASSERT_FALSE(plain.pixels.empty());
  key("l");  // begins to record: a message, and a sign
  settle();
  core::RgbImage with_note;
  window_->capture(&with_note);
  key("F1");
  settle();
  core::RgbImage recording;
  ASSERT_FALSE(with_note.pixels.empty());
  const auto is_red = [](const core::RgbImage& image) {
    const auto x = static_cast<std::size_t>(image.width - 18);
    const base::Rgb pixel = image.pixels[18 * static_cast<std::size_t>(image.width) + x];
    return pixel.r > 200 && pixel.g < 80;
  };
  EXPECT_FALSE(is_red(plain));
  EXPECT_TRUE(is_red(with_note));
  const auto lower_edge = [](const core::RgbImage& image) {
    const auto row = static_cast<std::ptrdiff_t>(image.width) * (image.height - 18);
    return std::vector<base::Rgb>(image.pixels.begin() + row, image.pixels.begin() + row + image.width);
  };
  EXPECT_NE(lower_edge(plain), lower_edge(with_note));
}

TEST_F(ExploreWindowTest, AFlightThatWasNotSavedIsKept) {
  open();
  EXPECT_EQ(window_->exit_message(), "");
  key("p");
  const std::string message = window_->exit_message();
  EXPECT_NE(message.find("unsaved"), std::string::npos) << message;
  int kept = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    kept += entry.path().string().find("unsaved") != std::string::npos ? 1 : 0;
  EXPECT_EQ(kept, 1);
}

}  // namespace
}  // namespace vpe::window
