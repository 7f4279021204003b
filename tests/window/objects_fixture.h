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

  std::vector<std::filesystem::path> copies() {
    std::vector<std::filesystem::path> found;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "state", none))
      if (entry.path().string().ends_with(".scene.toml")) found.push_back(entry.path());
    return found;
  }
};

}  // namespace vpe::window
