// The menu of a right click over view and map.
#include "vpe/window/menu/place_menu.h"

#include <memory>
#include <utility>
#include <vector>

#include "tests/window/explore_window_fixture.h"
#include "vpe/window/menu/still_click.h"

namespace vpe::window {
namespace {

// Ends at once, as done.
class DoneJob : public Job {
 public:
  JobState state() override { return {}; }
  void stop() override {}
};

class PlaceMenuTest : public ExploreWindowTest {
 protected:
  void open_menu_window() {
    extra_.session.start = mars::Pose{10, -5, 400'000, 0, -60, 0};
    extra_.places = {{"Here", 10, -5, 0}, {"Land", 10, -5, 4e6}};
    extra_.start_job = [this](const std::vector<std::string>& words) {
      commands_.push_back(words);
      return std::make_unique<DoneJob>();
    };
    extra_.planet_file = "/data/p.vpe";
    open();
    settle();
  }
  void right_click(double x, double y) {
    move(x, y);
    robot_->press(3);
    iterate(2);
    robot_->release(3);
    iterate(4);
  }
  void choose(const std::string& label) { click("menu/" + label); }
  bool is_open() { return window_->menu().is_open(); }
  // A place of the view that no panel covers.
  static constexpr double kX = 700;
  static constexpr double kY = 300;

  std::vector<std::vector<std::string>> commands_;
};

void expect_near(mars::LonLat a, mars::LonLat b) {
  EXPECT_NEAR(a.lon_deg, b.lon_deg, 1e-6);
  EXPECT_NEAR(a.lat_deg, b.lat_deg, 1e-6);
}

TEST_F(PlaceMenuTest, AClickTellsWhatIsThereAndADragTurnsAsEver) {
  open_menu_window();
  const mars::LonLat place = under(kX, kY);
  const mars::Pose before = window_->session().pose();
  right_click(kX, kY);
  ASSERT_TRUE(is_open());
  expect_near(window_->menu().place(), place);
  EXPECT_EQ(window_->session().pose().yaw_deg, before.yaw_deg);
  EXPECT_EQ(window_->session().mouse_use(), explore::MouseUse::kNone);
  for (const char* label : {"menu/Copy", "menu/Measure from here", "menu/Profile to here",
                            "menu/Viewshed from here", "menu/Panorama from here"})
    EXPECT_TRUE(waits_for(label)) << label;
  choose("Copy");
  EXPECT_FALSE(is_open());
  const std::string copied = glfwGetClipboardString(window_->display().handle());
  for (const char* part :
       {"Name: in Land", "Place: ", "Elevation: ", "Slope: ", "Source: ", "Posts: ", "Ground: "})
    EXPECT_NE(copied.find(part), std::string::npos) << part << " in\n" << copied;
  // A drag tilts and opens nothing, even if it comes back.
  drag({kX, kY}, {80, 0}, 3);
  EXPECT_FALSE(is_open());
  EXPECT_NE(window_->session().pose().yaw_deg, before.yaw_deg);
  settle();
  move(kX, kY);
  robot_->press(3);
  iterate(2);
  move(kX + 40, kY);
  move(kX, kY);
  robot_->release(3);
  iterate(4);
  EXPECT_FALSE(is_open());
}

TEST_F(PlaceMenuTest, ItClosesByEscAndByAClickBesideIt) {
  open_menu_window();
  right_click(kX, kY);
  ASSERT_TRUE(is_open());
  key("Escape");
  iterate(3);
  EXPECT_FALSE(is_open());
  right_click(kX, kY);
  ASSERT_TRUE(is_open());
  const mars::Pose before = window_->session().pose();
  click(kX + 150, kY - 200);
  iterate(3);
  EXPECT_FALSE(is_open());
  EXPECT_EQ(window_->session().pose().lon_deg, before.lon_deg);
  // The other buttons open none.
  click(kX, kY);
  EXPECT_FALSE(is_open());
}

TEST_F(PlaceMenuTest, MeasuresFromHereAndProfilesToHereWithUndo) {
  open_menu_window();
  const mars::LonLat first = under(kX, kY);
  right_click(kX, kY);
  choose("Profile to here");
  settle();
  // From the camera's place, as there was no point.
  ASSERT_EQ(window_->measure().points().size(), 2U);
  expect_near(window_->measure().points()[0], {10, -5});
  expect_near(window_->measure().points()[1], first);
  ASSERT_NE(window_->measure().measured(), nullptr);
  right_click(kX, kY - 60);
  choose("Measure from here");
  settle();
  ASSERT_EQ(window_->measure().points().size(), 1U);
  const mars::LonLat second = window_->measure().points()[0];
  right_click(kX - 80, kY - 20);
  choose("Profile to here");
  settle();
  ASSERT_EQ(window_->measure().points().size(), 2U);
  expect_near(window_->measure().points()[0], second);
  // One order of undo with drawings: the point that is drawn last goes first.
  explore::Drawing point;
  point.vertices = {{11, -5}};
  ASSERT_EQ(window_->drawing().drawings().add(point), "");
  iterate(2);
  with_control("z");
  EXPECT_EQ(window_->drawing().drawings().size(), 0U);
  EXPECT_EQ(window_->measure().points().size(), 2U);
  with_control("z");
  EXPECT_EQ(window_->measure().points().size(), 1U);
  with_control("z");
  settle();
  ASSERT_EQ(window_->measure().points().size(), 2U);
  expect_near(window_->measure().points()[1], first);
  with_control("z", true);
  EXPECT_EQ(window_->measure().points().size(), 1U);
}

TEST_F(PlaceMenuTest, ViewshedAndPanoramaAreMadeByCommands) {
  open_menu_window();
  right_click(kX, kY);
  const mars::LonLat place = window_->menu().place();
  choose("Viewshed from here");
  ASSERT_EQ(commands_.size(), 1U);
  const std::vector<std::string>& seen = commands_[0];
  EXPECT_EQ(seen[0], "viewshed");
  EXPECT_EQ(seen[1], "/data/p.vpe");
  EXPECT_TRUE(seen[2].starts_with("--at=" + std::to_string(place.lon_deg).substr(0, 5))) << seen[2];
  EXPECT_EQ(seen[3], "--from-height");
  EXPECT_EQ(seen[4], "2");
  EXPECT_TRUE(seen.back().ends_with(".tif")) << seen.back();
  right_click(kX, kY);
  choose("Panorama from here");
  ASSERT_EQ(commands_.size(), 2U);
  EXPECT_EQ(commands_[1][0], "panorama");
  EXPECT_EQ(commands_[1][3], "--height=2");
  EXPECT_TRUE(commands_[1].back().ends_with(".jpg"));
}

TEST_F(PlaceMenuTest, OpensOverTheMapToo) {
  open_menu_window();
  ASSERT_TRUE(waits_for("map"));
  const WidgetPlace map = place_of("map");
  const mars::Pose before = window_->session().pose();
  const double x = map.x0 + 0.75 * (map.x1 - map.x0);
  const double y = map.y0 + 0.25 * (map.y1 - map.y0);
  right_click(x, y);
  ASSERT_TRUE(is_open());
  // The map shows the whole planet.
  EXPECT_NEAR(window_->menu().place().lon_deg, 90, 3);
  EXPECT_NEAR(window_->menu().place().lat_deg, 45, 3);
  EXPECT_FALSE(window_->session().is_going());
  key("Escape");
  iterate(3);
  EXPECT_FALSE(is_open());
  // A drag with the right button does nothing.
  drag({x, y}, {20, 10}, 3);
  EXPECT_FALSE(is_open());
  EXPECT_EQ(window_->session().pose().lon_deg, before.lon_deg);
}

TEST_F(PlaceMenuTest, OverTheSkyItSaysThatThereIsNoGround) {
  open_menu_window();
  window_->session().put({10, -5, 400'000, 0, 60, 0});
  settle();
  right_click(kX, kY);
  EXPECT_FALSE(is_open());
  EXPECT_EQ(window_->state().message, "there is no ground under the cursor");
}

TEST(StillClick, IsAPressThatDoesNotMove) {
  StillClick click;
  EXPECT_FALSE(click.release());
  click.press({10, 20});
  click.move({10 + StillClick::kClick_px, 20});
  EXPECT_EQ(click.release(), glm::dvec2(10, 20));
  EXPECT_FALSE(click.release());
  click.press({10, 20});
  click.move({10, 21 + StillClick::kClick_px});
  click.move({10, 20});
  EXPECT_FALSE(click.release());
  click.press({10, 20});
  click.cancel();
  EXPECT_FALSE(click.release());
  click.move({0, 0});
}

}  // namespace
}  // namespace vpe::window
