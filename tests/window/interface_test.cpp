// Tests of the parts around the view: search, places, looks, overlays, layout, status line.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "mars/embedded/data_files.h"
#include "tests/window/explore_window_fixture.h"
#include "vpe/window/panels/overlay_bar.h"

namespace vpe::window {
namespace {

class InterfaceTest : public ExploreWindowTest {
 protected:
  void type(const std::string& text) {
    for (const char c : text) key(c == ' ' ? "space" : c == '.' ? "period" : std::string(1, c));
  }
  void add_places() {
    extra_.places = {{"Olympus Mons", -133.8, 18.65, 610e3},
                     {"Olympia Undae", 178.5, 81.2, 1508e3},
                     {"Gale", 137.8, -5.4, 154e3}};
    extra_.places_file = (folder_ / "places.csv").string();
    std::ofstream(extra_.places_file) << "name,lon,lat,diameter_km\nGale,137.8,-5.4,154\n";
  }
  double distance_to(const core::Place& place) {
    const mars::Pose& pose = window_->session().pose();
    return mars::distance_rad({pose.lon_deg, pose.lat_deg}, {place.lon_deg, place.lat_deg});
  }
};

TEST(ExploreLayoutTest, PartsCoverTheWindowWithoutOverlap) {
  for (const auto& [width, height] :
       {std::pair{640, 400}, {799, 500}, {800, 500}, {1280, 720}, {3840, 2160}, {20, 20}}) {
    for (const double scale : {1.0, 2.0}) {
      for (const bool panels : {false, true}) {
        for (const double side_px : {0.0, 10.0, 400.0, 5000.0}) {
          const ExploreLayout l = layout_of({width, height, scale, panels, side_px, true});
          EXPECT_GE(l.view.width, std::min(16, width));
          EXPECT_GE(l.view.height, std::min(16, height));
          EXPECT_LE(l.view.x + l.view.width, std::max(width, 16));
          if (!panels) {
            EXPECT_EQ(l.view.width, width);
          }
          if (!l.is_narrow) {
            EXPECT_EQ(l.side.width, l.view.x);
          }
          if (l.is_narrow) {
            EXPECT_EQ(l.view.x, 0);
          }
          EXPECT_EQ(l.is_narrow, width < 800 * scale);
          EXPECT_EQ(l.side.width > 0, panels) << width;
          EXPECT_EQ(layout_of({width, height, scale, panels, side_px, false}).side.width > 0,
                    panels && !l.is_narrow);
        }
      }
    }
  }
}

TEST(StatusLineTest, TextsHaveNoNegativeZeroAndNoFullCircle) {
  EXPECT_EQ(attitude_text({0, 0, 0, -0.04, -0.0, -0.01}), "heading 0.0°  pitch 0.0°  roll 0.0°");
  EXPECT_EQ(attitude_text({0, 0, 0, 359.97, -90, 180}), "heading 0.0°  pitch -90.0°  roll 180.0°");
  EXPECT_EQ(attitude_text({0, 0, 0, -90, 12.34, -3.21}), "heading 270.0°  pitch 12.3°  roll -3.2°");
  using R = explore::LongitudeRange;
  EXPECT_EQ(hemisphere_text({-59.2, -13.7}, R::kSigned), "13.70000° S  59.20000° W");
  EXPECT_EQ(hemisphere_text({-59.2, -13.7}, R::kPositive), "13.70000° S  300.80000° E");
  EXPECT_EQ(hemisphere_text({0, -0.000001}, R::kSigned), "0.00000° N  0.00000° E");
}

TEST(StatusLineTest, WhatDoesNotFitIsLeftOutPartByPart) {
  const auto width = [](const std::string& text) { return static_cast<double>(text.size()); };
  const std::string text = "cursor  1 N  2 E   -3127.7 m   slope 6 deg";
  EXPECT_EQ(fitting_parts(text, 100, width), text);
  EXPECT_EQ(fitting_parts(text, static_cast<double>(text.size()), width), text);
  EXPECT_EQ(fitting_parts(text, static_cast<double>(text.size()) - 1, width), "cursor  1 N  2 E   -3127.7 m");
  EXPECT_EQ(fitting_parts(text, 27, width), "cursor  1 N  2 E");
  EXPECT_EQ(fitting_parts(text, -5, width), "cursor  1 N  2 E");
  EXPECT_EQ(fitting_parts("", 0, width), "");
}

TEST_F(InterfaceTest, ASearchedPlaceIsFlownTo) {
  add_places();
  open();
  key("slash");
  EXPECT_TRUE(ImGui::GetIO().WantTextInput);
  type("olym");
  ASSERT_TRUE(window_->widgets().places().contains("found 1"));
  EXPECT_FALSE(window_->widgets().places().contains("found 2"));
  key("Return");
  settle();
  EXPECT_LT(distance_to({"", -133.8, 18.65, 0}), 0.35);
  EXPECT_GT(window_->session().pose().pitch_deg, -80);
  key("slash");
  type("olym");
  key("Down");
  key("Return");
  settle();
  EXPECT_LT(distance_to({"", 178.5, 81.2, 0}), 0.5);
  // By the mouse, while the field has the keyboard.
  key("slash");
  type("gale");
  click("found 0");
  settle();
  EXPECT_LT(distance_to({"", 137.8, -5.4, 0}), 0.2);
  EXPECT_FALSE(ImGui::GetIO().WantTextInput);
  EXPECT_FALSE(window_->widgets().places().contains("found 0"));
  key("slash");
  type("20.5 10.25");
  key("Return");
  settle();
  EXPECT_LT(distance_to({"", 20.5, 10.25, 0}), 0.02);
}

TEST_F(InterfaceTest, TabCompletesTheMarkedName) {
  add_places();
  open();
  key("slash");
  type("ga");
  ASSERT_TRUE(window_->widgets().places().contains("found 0"));
  key("Tab");
  // The text is now the name, so that what follows belongs to it.
  EXPECT_TRUE(ImGui::GetIO().WantTextInput);
  type(" x");
  EXPECT_FALSE(window_->widgets().places().contains("found 0"));
  key("BackSpace");
  key("BackSpace");
  ASSERT_TRUE(window_->widgets().places().contains("found 0"));
  key("Return");
  settle();
  EXPECT_LT(distance_to({"", 137.8, -5.4, 0}), 0.2);
  // The mark chooses what is completed.
  key("slash");
  type("olym");
  key("Down");
  key("Tab");
  ASSERT_TRUE(window_->widgets().places().contains("found 0"));
  EXPECT_FALSE(window_->widgets().places().contains("found 1"));
  key("Return");
  settle();
  EXPECT_LT(distance_to({"", 178.5, 81.2, 0}), 0.5);
  // A whole name has nothing to complete: Tab leaves the field.
  key("slash");
  type("gale");
  key("Tab");
  key("Tab");
  EXPECT_FALSE(window_->widgets().places().contains("found 0"));
}

TEST_F(InterfaceTest, TheFirstInputEndsTheWelcome) {
  add_places();
  extra_.greets = true;
  open();
  EXPECT_TRUE(window_->welcome().is_shown());
  click("Gale");
  settle();
  EXPECT_FALSE(window_->welcome().is_shown());
  EXPECT_LT(distance_to({"", 137.8, -5.4, 0}), 0.2);
  window_.reset();
  extra_.greets = true;
  open();
  move(700, 150);
  EXPECT_TRUE(window_->welcome().is_shown());
  robot_->wheel(1);
  iterate(3);
  EXPECT_FALSE(window_->welcome().is_shown());
  EXPECT_TRUE(window_->overlook() == nullptr);
}

TEST_F(InterfaceTest, OverlaysAreSwitchedOverTheView) {
  add_places();
  open();
  settle();
  const core::RgbImage plain = window_->image();
  click("\u2194##overlay.scale");
  settle();
  if (window_->state().message_is_error) GTEST_SKIP() << "skipped: " << window_->state().message;
  EXPECT_EQ(window_->session().settings().get("overlay.scale"), "on");
  EXPECT_NE(window_->image().pixels, plain.pixels);
  click("Aa##overlay.names");
  settle();
  EXPECT_EQ(
      overlays_on(window_->session().settings()),
      (std::vector<std::string>{"overlay.names=" + (folder_ / "places.csv").string(), "overlay.scale=on"}));
  click("\u2194##overlay.scale");
  click("Aa##overlay.names");
  settle();
  EXPECT_EQ(window_->image().pixels, plain.pixels);
}

TEST_F(InterfaceTest, TheCursorsPlaceIsAlwaysTold) {
  open();
  move(640, 240);
  settle();
  EXPECT_NE(window_->cursor_line().find("slope"), std::string::npos) << window_->cursor_line();
  EXPECT_NE(window_->cursor_line().find("\u00b0 N"), std::string::npos) << window_->cursor_line();
  move(345, 480);  // sky
  settle();
  EXPECT_EQ(window_->cursor_line(), "");
}

TEST_F(InterfaceTest, ViewsAreKeptRenamedAndForgotten) {
  open();
  window_->session().put({10, 20, 300e3, 30, -40, 0});
  settle();
  click("Places");
  click("Keep this view");
  window_->session().put({50, 20, 300e3, 30, -40, 0});
  iterate(3);
  click("Keep this view");
  click("##view 0");
  type("home");
  key("Return");
  iterate(3);
  const explore::ParsedBookmarks kept = explore::load_bookmarks(folder_ / "bookmarks");
  ASSERT_TRUE(kept.bookmarks);
  ASSERT_EQ(kept.bookmarks->all().size(), 2U);
  EXPECT_EQ(kept.bookmarks->all()[0].name, "home");
  click("Go##view 0");
  settle();
  EXPECT_NEAR(window_->session().pose().lon_deg, 10, 1e-9);
  click("x##view 0");
  iterate(3);
  EXPECT_EQ(explore::load_bookmarks(folder_ / "bookmarks").bookmarks->all().size(), 1U);
}

TEST_F(InterfaceTest, TheLargeMapLeavesThePanelAndTheSmallMapAlone) {
  open();
  settle();
  const WidgetPlace before = place_of("Planet");
  const WidgetPlace map = place_of("map");
  key("Tab");
  settle();
  EXPECT_EQ(place_of("Planet").y0, before.y0);
  EXPECT_EQ(place_of("map").x1, map.x1);
  const WidgetPlace large = place_of("large/map");
  EXPECT_GT(large.x1 - large.x0, 500);
  // Zoomed, the small map still shows the whole planet: a click at its edge goes there.
  move((large.x0 + large.x1) / 2, (large.y0 + large.y1) / 2);
  robot_->wheel(5);
  iterate(5);
  key("Tab");
  settle();
  click(map.x0 + 0.95 * (map.x1 - map.x0), (map.y0 + map.y1) / 2);
  settle();
  EXPECT_NEAR(window_->session().pose().lon_deg, 162, 4);
}

TEST_F(InterfaceTest, TheCameraIsAimedAndInterestLoweredOnTheMap) {
  open(1280, 720);
  window_->session().put({0, 0, 200e3, 10, -30, 0});
  settle();
  const WidgetPlace map = place_of("map");
  const double x = (map.x0 + map.x1) / 2;
  const double y = (map.y0 + map.y1) / 2;
  robot_->key_down("Alt_L");
  move(x + 10, y);
  robot_->press();
  iterate(2);
  move(x + 60, y);  // east of the camera
  EXPECT_NEAR(window_->session().pose().yaw_deg, 90, 0.5);
  move(x, y - 40);
  robot_->release();
  iterate(2);
  robot_->key_up("Alt_L");
  settle();
  EXPECT_NEAR(window_->session().pose().yaw_deg, 0, 0.5);
  EXPECT_EQ(window_->session().pose().lon_deg, 0);
  robot_->key_down("Shift_L");
  robot_->key_down("Control_L");
  move(x + 40, y);
  robot_->press();
  iterate(2);
  move(x + 60, y);
  robot_->release();
  iterate(2);
  robot_->key_up("Control_L");
  robot_->key_up("Shift_L");
  settle();
  ASSERT_EQ(window_->session().interest().size(), 1U);
  EXPECT_EQ(window_->session().interest()[0].levels, -1);
  click("Detail");
  settle();
  const WidgetPlace levels = place_of("levels##region 0");
  click(levels.x0 + 5, (levels.y0 + levels.y1) / 2);
  key("2");
  key("Return");
  iterate(3);
  EXPECT_EQ(window_->session().interest()[0].levels, 2);
  click("x##region 0");
  iterate(3);
  EXPECT_TRUE(window_->session().interest().empty());
}

TEST_F(InterfaceTest, ANarrowWindowOpensThePanelOnRequest) {
  open(640, 400);
  EXPECT_EQ(window_->session().screen().width, 640);
  EXPECT_FALSE(window_->widgets().places().contains("search"));
  click("\u2261##side");
  settle();
  EXPECT_TRUE(window_->widgets().places().contains("search"));
  EXPECT_EQ(window_->session().screen().width, 640);
  click("\u2261##side");
  settle();
  EXPECT_FALSE(window_->widgets().places().contains("search"));
  key("slash");  // opens the panel itself
  settle();
  EXPECT_TRUE(ImGui::GetIO().WantTextInput);
}

TEST_F(InterfaceTest, ThePanelsWidthIsDragged) {
  open(1280, 720);
  move(330, 600);
  robot_->press();
  for (int x = 330; x <= 430; x += 20) move(x, 600);
  robot_->release();
  settle();
  EXPECT_NEAR(window_->state().side_px, 430, 2);
  EXPECT_EQ(window_->session().screen().width, 1280 - static_cast<int>(window_->state().side_px));
}

TEST_F(InterfaceTest, TooltipsWaitAndStandBesideThePanel) {
  open();
  settle();
  const WidgetPlace p = place_of("Level");
  move((p.x0 + p.x1) / 2, (p.y0 + p.y1) / 2);
  EXPECT_TRUE(window_->widgets().tip_due_s().has_value());
  const std::int64_t frames = window_->frames();
  const double begun = glfwGetTime();
  while (glfwGetTime() < begun + 2 && window_->widgets().tip_due_s()) window_->step(0.05);
  EXPECT_FALSE(window_->widgets().tip_due_s().has_value());
  EXPECT_GE(glfwGetTime() - begun, 0.2);
  EXPECT_GT(window_->frames(), frames);
}

TEST_F(InterfaceTest, CopyPutsPlaceAndCommandOnTheClipboard) {
  extra_.command_line = [](const explore::Session& session) {
    return "vpe render --fov " + std::to_string(session.screen().width);
  };
  open();
  move(640, 240);
  robot_->key_down("Control_L");
  key("c");
  robot_->key_up("Control_L");
  iterate(3);
  const std::string text = glfwGetClipboardString(window_->display().handle());
  EXPECT_NE(text.find("\u00b0 N"), std::string::npos) << text;
  EXPECT_NE(text.find("vpe render --fov " + std::to_string(window_->session().screen().width)),
            std::string::npos)
      << text;
}

TEST_F(InterfaceTest, EnterWithoutHotspotsIsNoError) {
  open();
  settle();
  key("Return");
  iterate(3);
  EXPECT_FALSE(window_->state().message_is_error);
  EXPECT_NE(window_->state().message.find("no panorama to enter"), std::string::npos);
  EXPECT_EQ(window_->state().message.find("--"), std::string::npos);
}

TEST_F(InterfaceTest, TheModeOfMotionIsChosenOverTheView) {
  extra_.display.clock = own_clock();
  open();
  window_->session().put({20, 10, 3000, 0, -20, 0});
  settle();
  for (const explore::MotionMode mode : explore::motion_modes().subspan(1)) {
    click(std::string(explore::to_string(mode)));
    EXPECT_EQ(window_->session().mode(), mode);
    EXPECT_NE(window_->state().message.find(explore::to_string(mode)), std::string::npos)
        << window_->state().message;
    settle();
    EXPECT_EQ(window_->session().mode(), mode);
  }
  EXPECT_LT(window_->session().height_m(), 5);  // drive is on the ground
}

// What is in the panel stays where it is, whatever one does beside it.
TEST_F(InterfaceTest, NoControlMovesUnderTheHand) {
  add_places();
  open(1280, 720);
  std::mt19937 random(20261124);
  for (const char* tab : {"View", "Places", "Flight", "Measure", "Look", "Detail"}) {
    click(tab);
    key("p");
    key("p");
    settle();
    std::map<std::string, WidgetPlace> first = window_->widgets().places();
    for (int n = 0; n < 17; ++n) {
      const double x = 340 + static_cast<double>(random() % 900);
      const double y = 60 + static_cast<double>(random() % 560);
      switch (random() % 9) {
        case 0: move(x, y); break;
        case 1:
          move(x, y);
          robot_->wheel(random() % 2 == 0 ? 1 : -1);
          break;
        case 2:
          key("Tab");
          key("Tab");
          break;
        case 3:
          key("F1");
          key("F1");
          break;
        case 4: key("n"); break;
        case 5: key("l"); break;
        case 6:
          key("space");
          iterate(3);
          key("space");
          break;
        case 7:
          key("Tab");
          move(x, y);
          key("Tab");
          break;
        default: key("w"); break;
      }
      iterate(2);
      for (const auto& [label, place] : window_->widgets().places()) {
        const auto before = first.find(label);
        // Widgets over the view are not in the panel.
        if (before == first.end() || place.x1 > 330 || label.starts_with("large/")) continue;
        EXPECT_EQ(place.x0, before->second.x0) << tab << ": " << label;
        EXPECT_EQ(place.y0, before->second.y0) << tab << ": " << label;
      }
    }
    key("Escape");
    iterate(3);
  }
}

}  // namespace
}  // namespace vpe::window
