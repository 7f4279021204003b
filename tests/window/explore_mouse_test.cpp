// Tests of mouse navigation, and of files dropped on the window.
#include <fstream>

#include "tests/window/explore_window_fixture.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/explore/mouse.h"

namespace vpe::window {
namespace {

class ExploreMouseTest : public ExploreWindowTest {
 protected:
  static constexpr double kSide_px = 330;  // of the panels, at scale 1

  // The ground under a position of the window.
  glm::dvec3 ground_at(double x, double y) {
    const auto found = explore::ground_at(window_->session().pose(), window_->session().screen(),
                                          {x - kSide_px, y}, window_->session().ground());
    EXPECT_TRUE(found.has_value());
    return found.value_or(glm::dvec3(0));
  }
  // Where it is in the window now.
  glm::dvec2 place_of_ground(const glm::dvec3& at_m) {
    return glm::dvec2(core::project(window_->session().view(), at_m).xy) + glm::dvec2{kSide_px, 0};
  }
  double distance_to(const glm::dvec3& at_m) {
    return glm::length(window_->session().view().camera.position_m - at_m);
  }

  // As the window system hands over files: GLFW's own callback, which is put back.
  void drop(const std::string& file) {
    GLFWwindow* handle = window_->display().handle();
    const GLFWdropfun on_drop = glfwSetDropCallback(handle, nullptr);
    glfwSetDropCallback(handle, on_drop);
    ASSERT_NE(on_drop, nullptr);
    const char* files[] = {file.c_str()};
    on_drop(handle, 1, files);
  }
};

TEST_F(ExploreMouseTest, TheWheelZoomsToTheGroundUnderTheCursor) {
  open();
  move(700, 180);
  settle();
  const glm::dvec3 under = ground_at(700, 180);
  const double before_m = distance_to(under);
  robot_->wheel(3);
  iterate(5);
  settle();
  EXPECT_LT(distance_to(under), 0.9 * before_m);
  EXPECT_NEAR(place_of_ground(under).x, 700, 0.5);
  EXPECT_NEAR(place_of_ground(under).y, 180, 0.5);
  robot_->wheel(-3);
  iterate(5);
  settle();
  // Each notch holds the ground under the cursor at that moment; a pixel of the whole planet is kilometres
  // wide.
  EXPECT_NEAR(distance_to(under), before_m, 0.01 * before_m);
}

TEST_F(ExploreMouseTest, ARightDragTiltsAboutTheMiddle) {
  open();
  const explore::Screen screen = window_->session().screen();
  const double x = kSide_px + screen.width / 2.0;
  const double y = screen.height / 2.0;
  move(x, y);
  robot_->wheel(10);
  iterate(10);
  settle();
  const glm::dvec3 middle = ground_at(x, y);
  const double before_m = distance_to(middle);
  const mars::Pose before = window_->session().pose();
  for (const int button : {3, 2}) {  // right, then middle
    move(x, y);
    robot_->press(button);
    iterate(2);
    for (int n = 1; n <= 6; ++n) move(x + 5 * n, y - 10 * n);
    robot_->release(button);
    settle();
    EXPECT_NEAR(place_of_ground(middle).x, x, 0.5) << button;
    EXPECT_NEAR(place_of_ground(middle).y, y, 0.5) << button;
    EXPECT_NEAR(distance_to(middle), before_m, 1e-6 * before_m) << button;
  }
  EXPECT_GT(window_->session().pose().pitch_deg, before.pitch_deg + 5);
  EXPECT_GT(std::abs(window_->session().pose().yaw_deg - before.yaw_deg), 1);
}

TEST_F(ExploreMouseTest, AFlickGoesOnAndComesToRest) {
  extra_.display.clock = own_clock();  // a hand that rests for 0.1 s before it lets go throws nothing
  open();
  window_->session().put({20, 10, 400'000, 0, -90, 0});
  int left = 0;
  int top = 0;
  glfwGetWindowPos(window_->display().handle(), &left, &top);
  move(600, 250);
  settle();
  robot_->press();
  iterate(1);
  for (int k = 1; k <= 8; ++k) {
    robot_->move(600 + 25 * k + left, 250 + top);
    iterate(1);
  }
  robot_->release();
  iterate(1);
  EXPECT_EQ(window_->session().mouse_use(), explore::MouseUse::kNone);
  EXPECT_TRUE(window_->session().is_moving());
  EXPECT_FALSE(window_->is_at_rest());
  const double lon_deg = window_->session().pose().lon_deg;
  settle();
  EXPECT_LT(window_->session().pose().lon_deg, lon_deg) << "on to the west";
  EXPECT_FALSE(window_->session().is_moving());
  EXPECT_TRUE(window_->shows_final_image());
}

TEST_F(ExploreMouseTest, ACtrlDragLooksAroundInPlace) {
  open();
  window_->session().put({20, 10, 400'000, 0, -60, 0});
  move(600, 250);
  settle();
  const mars::Pose before = window_->session().pose();
  robot_->key_down("Control_L");
  robot_->press();
  iterate(2);
  EXPECT_EQ(window_->session().mouse_use(), explore::MouseUse::kLook);
  for (int n = 1; n <= 8; ++n) move(600 - 10 * n, 250);
  robot_->release();
  robot_->key_up("Control_L");
  settle();
  EXPECT_NEAR(window_->session().pose().lon_deg, before.lon_deg, 1e-9);
  EXPECT_NEAR(window_->session().pose().alt_m, before.alt_m, 1e-3);
  EXPECT_GT(window_->session().pose().yaw_deg, before.yaw_deg + 2);
}

TEST_F(ExploreMouseTest, ADoubleClickFliesThere) {
  open();
  settle();
  const glm::dvec3 wanted = ground_at(700, 180);
  const double before_m = distance_to(wanted);
  move(700, 180);
  for (int n = 0; n < 2; ++n) {
    robot_->press();
    window_->step(0.01);
    robot_->release();
    window_->step(0.01);
  }
  settle();
  const explore::Screen screen = window_->session().screen();
  EXPECT_LT(distance_to(wanted), 0.8 * before_m);
  EXPECT_NEAR(place_of_ground(wanted).x, kSide_px + screen.width / 2.0, 2);
  EXPECT_NEAR(place_of_ground(wanted).y, screen.height / 2.0, 2);
}

TEST_F(ExploreMouseTest, ADroppedPlanetIsShownNext) {
  const std::string other = folder_ / "other.vpe";
  test_support::build_fake(other, test_support::FakeElevation([](const glm::dvec3&) { return 100.0; }),
                           400'000);
  extra_.open_planet = [](const std::string& file) { return app::open_planet(file, app::Common{}); };
  open();
  drop(other);
  bool is_open = true;
  for (int n = 0; n < 20'000 && window_->next_planet() == nullptr && is_open; ++n)
    is_open = window_->step(0.01);
  ASSERT_NE(window_->next_planet(), nullptr);
  EXPECT_EQ(window_->next_planet()->path(), other);
  EXPECT_EQ(window_->next_planet_file(), other);
}

TEST_F(ExploreMouseTest, ADroppedFileThatIsNoPlanetIsReportedAndTheWindowContinues) {
  const std::string text = folder_ / "notes.txt";
  std::ofstream(text) << "no planet\n";
  extra_.open_planet = [](const std::string& file) { return app::open_planet(file, app::Common{}); };
  open();
  drop(text);
  for (int n = 0; n < 20'000 && !window_->state().message_is_error; ++n) ASSERT_TRUE(window_->step(0.01));
  EXPECT_TRUE(window_->state().message_is_error);
  EXPECT_NE(window_->state().message.find("notes.txt"), std::string::npos) << window_->state().message;
  EXPECT_EQ(window_->next_planet(), nullptr);
  settle();
  EXPECT_TRUE(window_->drawn()->error.empty());
}

}  // namespace
}  // namespace vpe::window
