// Fixture for tests of objects in the window: a scene with an object and one that moves.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "objects/files/scene_file.h"
#include "objects/sticks/build_sticks.h"
#include "objects/sticks/stick_file.h"
#include "tests/window/explore_window_fixture.h"
#include "vpe/app/scene/model_ball.h"
#include "vpe/base/file.h"

namespace vpe::window {

// The planet's posts are far apart, so objects are tens of kilometres large.
inline constexpr const char* kObjectScene = R"(version = 1
# A comment that a scene does not have.
[[model]]
name = "box"
file = "models/box.sticks"
[[object]]
model = "box"
name = "One"
lon = 20
lat = 10
scale = 20000
[[path]]
model = "box"
name = "Driver"
scale = 20000
points = [[0, 18, 8], [100, 22, 8]]
)";

class ObjectsPanelTest : public ExploreWindowTest {
 protected:
  void SetUp() override {
    ExploreWindowTest::SetUp();
    std::filesystem::create_directories(folder_ / "models");
    objects::VoxelGrid voxels({4, 4, 4, 0.5F, {-1, -1, 0}});
    for (int x = 0; x < 4; ++x)
      for (int y = 0; y < 4; ++y)
        for (int z = 0; z < 4; ++z) voxels.set(x, y, z);
    objects::write_stick_file(folder_ / "models/box.sticks", objects::build_sticks(std::move(voxels)));
    base::write_file(file(), std::string_view(kObjectScene));
  }

  std::filesystem::path file() const { return folder_ / "a.scene.toml"; }

  // Opens the window above the objects, with the panel.
  void open_above(const std::filesystem::path& scene, double height_m = 600'000) {
    if (!scene.empty()) {
      ASSERT_EQ(extra_.session.settings.set("scene", scene.string()), "");
    }
    extra_.model_ball = app::model_ball;
    open(960, 1200);
    window_->session().put({20, 10, height_m, 0, -90, 0});
    click("Objects");
    settle();
  }

  const explore::SceneEditor& editor() { return window_->objects().editor(); }
  explore::SharedItem item(const std::string& name) {
    for (const explore::SharedItem& item : editor().items())
      if (explore::item_name(*item) == name) return item;
    return nullptr;
  }
  const objects::Placing& placing(const std::string& name) {
    const explore::SharedItem found = item(name);
    if (found == nullptr) throw std::runtime_error("there is no object " + name);
    return *explore::single_placing(*found);
  }

  double left() { return 960 - window_->session().view().width; }
  mars::LonLat under(double x, double y) {
    const auto place = window_->session().place_at({x - left(), y});
    if (!place) throw std::runtime_error("there is no ground");
    return *place;
  }
  // Returns where a place is in the window.
  glm::dvec2 seen(mars::LonLat place) {
    const glm::dvec3 up = mars::direction(place);
    const explore::TerrainQuery& ground = window_->session().ground();
    return core::project(window_->session().view(), up * (ground.radius_m + ground.height_m(up))).xy +
           glm::dvec2(left(), 0);
  }

  // Enters a text in a field; beside it are buttons and the label.
  void enter(const std::string& label, const std::string& text) {
    ASSERT_TRUE(waits_for(label)) << label;
    const WidgetPlace field = place_of(label);
    click(field.x0 + 15, (field.y0 + field.y1) / 2);
    with_control("a");
    glfwSetClipboardString(window_->display().handle(), text.c_str());
    with_control("v");
    key("Return");
    settle();
  }
  void drag(glm::dvec2 from, glm::dvec2 by, int button = 1) {
    move(from.x, from.y);
    robot_->press(button);
    iterate(2);
    for (int n = 1; n <= 5; ++n) move(from.x + by.x * n / 5, from.y + by.y * n / 5);
    robot_->release(button);
    iterate(3);
  }

  std::vector<std::filesystem::path> copies() {
    std::vector<std::filesystem::path> found;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "state", none))
      if (entry.path().string().ends_with(".scene.toml")) found.push_back(entry.path());
    return found;
  }

  // Returns the colour of the image at a place of the window.
  glm::dvec3 colour_at(glm::dvec2 xy) {
    const core::RgbImage& image = window_->image();
    const double scale = static_cast<double>(image.width) / window_->session().view().width;
    const auto x = static_cast<int>((xy.x - left()) * scale);
    const auto y = static_cast<int>(xy.y * scale);
    const base::Rgb colour = image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                          static_cast<std::size_t>(x)];
    return {colour.r, colour.g, colour.b};
  }
};

}  // namespace vpe::window
