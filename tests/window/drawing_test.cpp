// Tests drawing by hand in the view and on the map, undo, files, copies and projects.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "tests/window/explore_window_fixture.h"

namespace vpe::window {
namespace {

namespace fs = std::filesystem;
using explore::Drawing;
using explore::DrawingKind;

class DrawingTest : public ExploreWindowTest {
 protected:
  std::span<const explore::Drawings::Shared> drawings() { return window_->drawing().drawings().all(); }

  void draw_triangle(double y = 200) {
    click("Polygon");
    click(600, y);
    click(700, y);
    click(700, y + 100);
    key("Return");
    settle();
  }

  // Returns the copies in the folder of state.
  std::vector<fs::path> copies() {
    std::vector<fs::path> found;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder_ / "state", none))
      if (entry.path().extension() == ".vpeproj") found.push_back(entry.path());
    return found;
  }
};

TEST_F(DrawingTest, APolygonIsDrawnNamedUndoneAndMeasured) {
  open();
  click("Draw");
  settle();
  draw_triangle();
  ASSERT_EQ(drawings().size(), 1U);
  const explore::Drawings::Shared polygon = drawings()[0];
  EXPECT_EQ(polygon->kind, DrawingKind::kPolygon);
  ASSERT_EQ(polygon->vertices.size(), 3U);
  EXPECT_LT(mars::distance_rad(polygon->vertices[0], under(600, 200)), 0.005);
  EXPECT_LT(mars::distance_rad(polygon->vertices[2], under(700, 300)), 0.005);
  EXPECT_EQ(polygon->name, "Polygon 1");
  // Its measures are those of the module.
  DrawingPanel* panel = &window_->drawing();
  ASSERT_NE(panel->measured(), nullptr);
  ASSERT_TRUE(panel->measured()->ground && panel->measured()->ground->area);
  const auto expected = explore::ground_measures(window_->session().surface(), *polygon);
  EXPECT_EQ(panel->measured()->ground->area->area_m2, expected->area->area_m2);
  EXPECT_EQ(panel->measured()->sphere.area_m2, explore::sphere_measures(*polygon, mars::kMarsRadius_m).area_m2);

  key("Escape");
  EXPECT_FALSE(window_->drawing().sketch().tool());
  click("Name");
  for (const char* letter : {"r", "i", "m"}) key(letter);
  key("Return");
  settle();
  EXPECT_EQ(drawings()[0]->name, "rim");
  move(645, 240);  // out of the field
  with_control("z");
  EXPECT_EQ(drawings()[0]->name, "Polygon 1");
  EXPECT_EQ(window_->state().message, "undone: rename 'Polygon 1'");
  with_control("z");
  EXPECT_EQ(drawings().size(), 0U);
  with_control("z", true);
  with_control("z", true);
  ASSERT_EQ(drawings().size(), 1U);
  EXPECT_EQ(drawings()[0]->name, "rim");
}

TEST_F(DrawingTest, VerticesAreTakenBackAndEndedByADoubleClick) {
  open();
  click("Draw");
  settle();
  const mars::Pose before = window_->session().pose();
  click("Line");
  click(600, 200);
  click(700, 300);
  EXPECT_EQ(window_->drawing().sketch().unfinished().size(), 2U);
  key("BackSpace");
  EXPECT_EQ(window_->drawing().sketch().unfinished().size(), 1U);
  with_control("z");
  EXPECT_EQ(window_->drawing().sketch().unfinished().size(), 0U);
  with_control("z", true);
  EXPECT_EQ(window_->drawing().sketch().unfinished().size(), 1U);
  move(660, 240);
  for (int n = 0; n < 2; ++n) {
    robot_->press();
    robot_->release();
  }
  iterate(5);
  settle();
  ASSERT_EQ(drawings().size(), 1U);
  EXPECT_EQ(drawings()[0]->vertices.size(), 2U);
  // Neither clicks nor keys have moved the camera.
  EXPECT_EQ(window_->session().pose().lon_deg, before.lon_deg);
  EXPECT_EQ(window_->session().pose().alt_m, before.alt_m);
  // With a tool, a drag still moves the ground.
  move(640, 300);
  robot_->press();
  iterate(2);
  move(670, 320);
  robot_->release();
  iterate(3);
  EXPECT_NE(window_->session().pose().lon_deg, before.lon_deg);
  EXPECT_EQ(window_->drawing().sketch().unfinished().size(), 0U);
}

TEST_F(DrawingTest, AVertexIsDraggedInTheViewAsOneStep) {
  open();
  click("Draw");
  settle();
  draw_triangle();
  key("Escape");
  const mars::Pose before = window_->session().pose();
  const mars::LonLat old = drawings()[0]->vertices[1];
  move(700, 200);
  robot_->press();
  iterate(2);
  for (int n = 1; n <= 5; ++n) move(700 + 4 * n, 200 - 6 * n);
  robot_->release();
  iterate(3);
  EXPECT_LT(mars::distance_rad(drawings()[0]->vertices[1], under(720, 170)), 0.01);
  EXPECT_GT(mars::distance_rad(drawings()[0]->vertices[1], old), 0.02);
  EXPECT_EQ(window_->session().pose().lon_deg, before.lon_deg);
  with_control("z");
  EXPECT_EQ(drawings()[0]->vertices[1].lon_deg, old.lon_deg);
  EXPECT_EQ(drawings().size(), 1U);
}

TEST_F(DrawingTest, TheMapTakesVerticesToo) {
  open();
  click("Draw");
  settle();
  const mars::Pose before = window_->session().pose();
  click("Line");
  const WidgetPlace map = place_of("map");
  const auto map_xy = [&](double x, double y) {
    return std::pair{map.x0 + x * (map.x1 - map.x0), map.y0 + y * (map.y1 - map.y0)};
  };
  const auto [x0, y0] = map_xy(0.5, 0.5);
  const auto [x1, y1] = map_xy(0.75, 0.25);
  click(x0, y0);
  click(x1, y1);
  key("Return");
  settle();
  ASSERT_EQ(drawings().size(), 1U);
  EXPECT_NEAR(drawings()[0]->vertices[0].lon_deg, 0, 2);
  EXPECT_NEAR(drawings()[0]->vertices[0].lat_deg, 0, 2);
  EXPECT_NEAR(drawings()[0]->vertices[1].lon_deg, 90, 2);
  EXPECT_NEAR(drawings()[0]->vertices[1].lat_deg, 45, 2);
  EXPECT_EQ(window_->session().pose().lon_deg, before.lon_deg);
  key("Escape");
  // A drag on the map moves the vertex and not the map.
  move(x1, y1);
  robot_->press();
  iterate(2);
  move(x1 + 10, y1 + 10);
  move(x1 + 20, y1 + 20);
  robot_->release();
  iterate(3);
  EXPECT_GT(drawings()[0]->vertices[1].lon_deg, 100);
  EXPECT_LT(drawings()[0]->vertices[1].lat_deg, 40);
  EXPECT_NEAR(drawings()[0]->vertices[0].lon_deg, 0, 2);
}

TEST_F(DrawingTest, FilesAreWrittenAndOpened) {
  open(960, 1300);
  click("Draw");
  settle();
  draw_triangle(600);
  EXPECT_TRUE(window_->drawing().drawings().is_changed());
  click("Save GeoJSON");
  settle();
  EXPECT_TRUE(fs::exists(folder_ / "drawings.geojson")) << window_->state().message;
  EXPECT_FALSE(window_->drawing().drawings().is_changed());
  click("Save CSV##drawings");
  iterate(3);
  EXPECT_TRUE(fs::exists(folder_ / "drawings.csv"));
  click("Save measures");
  iterate(3);
  EXPECT_TRUE(fs::exists(folder_ / "drawings-measures.geojson")) << window_->state().message;
  click("Copy measures");
  iterate(3);
  const std::string copied = glfwGetClipboardString(window_->display().handle());
  for (const char* part : {"Polygon 1", "area", "dip", "datum", "nodata", "synthetic"})
    EXPECT_NE(copied.find(part), std::string::npos) << part << " in\n" << copied;
  click("Open##drawings");
  settle();
  ASSERT_EQ(drawings().size(), 2U);
  EXPECT_TRUE(explore::same(*drawings()[0], *drawings()[1]));
  with_control("z");
  EXPECT_EQ(drawings().size(), 1U);
}

// The copy that a killed program leaves is there two seconds after each change, and goes when the project is
// saved.
TEST_F(DrawingTest, UnsavedDrawingsHaveACopyAndProjectsReturn) {
  open();
  click("Draw");
  settle();
  EXPECT_TRUE(copies().empty());
  draw_triangle();
  const auto begun = std::chrono::steady_clock::now();
  const auto is_kept = [&] {
    if (copies().size() != 1) return false;
    const explore::ParsedProject copy = explore::load_project(copies()[0]);
    return copy.project && copy.project->drawings.size() == 1 &&
           explore::same(copy.project->drawings[0], *drawings()[0]);
  };
  while (!is_kept() && std::chrono::steady_clock::now() - begun < std::chrono::seconds(2)) iterate(1);
  ASSERT_TRUE(is_kept());
  // What is not finished is in the copy too.
  click(620, 320);
  click(640, 340);
  const auto again = std::chrono::steady_clock::now();
  while (explore::load_project(copies()[0]).project->drawings.size() == 1 &&
         std::chrono::steady_clock::now() - again < std::chrono::seconds(2))
    iterate(1);
  EXPECT_EQ(explore::load_project(copies()[0]).project->drawings.size(), 2U);
  key("Escape");
  key("Escape");

  ASSERT_EQ(window_->session().set("exaggeration", "2"), "");
  const mars::Pose pose{12, 34, 500'000, 10, -60, 0};
  window_->session().put(pose);
  with_control("s");
  for (int n = 0; n < 5'000 && !copies().empty(); ++n) iterate(1);
  EXPECT_TRUE(copies().empty());
  fs::path file;
  for (const auto& entry : fs::directory_iterator(folder_.path()))
    if (entry.path().extension() == ".vpeproj") file = entry.path();
  ASSERT_FALSE(file.empty()) << window_->state().message;
  EXPECT_EQ(window_->session().pose().alt_m, pose.alt_m);  // S has not moved the camera
  const explore::ParsedProject parsed = explore::load_project(file);
  ASSERT_TRUE(parsed.project);
  EXPECT_EQ(parsed.project->pose->lon_deg, 12);
  EXPECT_EQ(parsed.project->settings,
            (std::vector<std::pair<std::string, std::string>>{{"exaggeration", "2"}}));
  const Drawing before = *drawings()[0];
  with_control("3");  // a bookmark of the project
  with_control("s");
  settle();
  EXPECT_EQ(window_->drawings_message(), "");

  window_.reset();
  extra_.project = *explore::load_project(file).project;
  extra_.project_file = file;
  open();
  ASSERT_EQ(drawings().size(), 1U);
  EXPECT_TRUE(explore::same(*drawings()[0], before));
  EXPECT_FALSE(window_->drawing().drawings().is_changed());
  ASSERT_EQ(window_->project().bookmarks.size(), 1U);
  EXPECT_EQ(window_->project().bookmarks[0].key, 3);
  window_->session().put(pose);
  iterate(3);
  click("Places");
  click("Keep this view##project");
  ASSERT_EQ(window_->project().bookmarks.size(), 2U);
  click("##project view 1");
  glfwSetClipboardString(window_->display().handle(), "the rim");
  with_control("a");
  with_control("v");
  key("Return");
  EXPECT_EQ(window_->project().bookmarks[1].name, "the rim");
  window_->session().put({50, 20, 300e3, 30, -40, 0});
  click("Go##project view 1");
  settle();
  EXPECT_NEAR(window_->session().pose().lon_deg, 12, 1e-9);
  click("x##project view 1");
  iterate(3);
  EXPECT_EQ(window_->project().bookmarks.size(), 1U);
  with_control("z");
  EXPECT_EQ(window_->project().bookmarks.size(), 2U);
  with_control("s");
  EXPECT_EQ(window_->state().message, "project: " + file.string());
}

TEST_F(DrawingTest, ACopyOfAnEarlierSessionIsRestored) {
  fs::create_directories(folder_ / "state");
  explore::Project lost;
  lost.drawings = {Drawing{0, DrawingKind::kLine, "lost", {1, 2, 3}, true, {{1, 2}, {3, 4}}}};
  const fs::path copy = folder_ / "state/unsaved.no-such-machine-1.vpeproj";
  explore::save_project(lost, copy);
  fs::last_write_time(copy, fs::file_time_type::clock::now() - std::chrono::hours(48));
  open();
  EXPECT_NE(opening_message_.find("unsaved drawings"), std::string::npos) << opening_message_;
  click("Draw");
  settle();
  click("Restore##drawings");
  settle();
  ASSERT_EQ(drawings().size(), 1U) << window_->state().message;
  EXPECT_EQ(drawings()[0]->name, "lost");
  EXPECT_FALSE(fs::exists(copy));
  const std::string message = window_->drawings_message();
  EXPECT_NE(message.find("the drawings were not saved"), std::string::npos);
  EXPECT_TRUE(copies().empty());
}

}  // namespace
}  // namespace vpe::window
