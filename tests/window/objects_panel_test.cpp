// Tests objects of scene files that are placed, moved and deleted in the window, and their files.
#include <gtest/gtest.h>

#include <chrono>
#include <glm/geometric.hpp>

#include "objects/files/scene_writer.h"
#include "tests/window/objects_fixture.h"
#include "vpe/explore/objects/scene_saving.h"

namespace vpe::window {
namespace {

namespace fs = std::filesystem;

TEST_F(ObjectsPanelTest, AnObjectIsPlacedDraggedDeletedAndSaved) {
  open_above(file());
  ASSERT_EQ(editor().items().size(), 2U);
  const mars::Pose camera = window_->session().pose();
  const glm::dvec3 ground = colour_at({800, 300});
  click("Place");
  click(800, 300);
  ASSERT_EQ(editor().items().size(), 3U);
  const mars::LonLat placed = placing("Box").place;
  EXPECT_LT(mars::distance_rad(placed, under(800, 300)), 1e-9);
  EXPECT_EQ(placing("Box").scale, 20000);  // as the other of its model
  EXPECT_EQ(window_->objects().selected(), item("Box")->id);
  key("Escape");
  EXPECT_FALSE(window_->objects().is_placing());
  settle();
  // The image shows it at once, by a copy; the setting keeps the file.
  EXPECT_EQ(window_->session().settings().values().scene, file().string());
  ASSERT_EQ(copies().size(), 1U);
  EXPECT_EQ(window_->drawn()->request.draw.settings.scene, copies()[0].string());
  EXPECT_EQ(objects::read_scene_file(copies()[0]).objects.size(), 2U);
  EXPECT_EQ(objects::read_scene_file(copies()[0]).models[0].file, folder_ / "models/box.sticks");
  EXPECT_GT(glm::length(colour_at({800, 300}) - ground), 20);
  EXPECT_EQ(objects::read_scene_file(file()).objects.size(), 1U);

  drag({803, 298}, {-90, 40});
  EXPECT_NEAR(seen(placing("Box").place).x, 710, 1.5);
  EXPECT_NEAR(seen(placing("Box").place).y, 340, 1.5);
  EXPECT_EQ(window_->session().pose().lon_deg, camera.lon_deg);
  EXPECT_EQ(window_->session().pose().lat_deg, camera.lat_deg);
  with_control("z");
  EXPECT_EQ(placing("Box").place.lon_deg, placed.lon_deg);
  EXPECT_EQ(window_->state().message, "undone: move 'Box'");
  with_control("z", true);
  EXPECT_NEAR(seen(placing("Box").place).x, 710, 1.5);
  const mars::LonLat moved = placing("Box").place;

  // A click selects another one, which is deleted.
  const glm::dvec2 one = seen(placing("One").place);
  click(one.x, one.y);
  EXPECT_EQ(window_->objects().selected(), item("One")->id);
  key("Delete");
  EXPECT_EQ(item("One"), nullptr);
  settle();
  EXPECT_EQ(objects::read_scene_file(copies()[0]).objects.size(), 1U);

  with_control("s");
  settle();
  EXPECT_NE(window_->state().message.find("scene: " + file().string()), std::string::npos)
      << window_->state().message;
  EXPECT_TRUE(copies().empty());
  EXPECT_FALSE(editor().is_changed());
  const auto kept = base::read_file(explore::kept_name(file()), 10'000);
  EXPECT_EQ(std::string(kept.begin(), kept.end()), kObjectScene);
  const objects::SceneFile saved = objects::read_scene_file(file());
  ASSERT_EQ(saved.objects.size(), 1U);
  EXPECT_EQ(saved.objects[0].name, "Box");
  EXPECT_EQ(saved.objects[0].places[0].place.lon_deg, moved.lon_deg);
  EXPECT_EQ(saved.paths.size(), 1U);
  EXPECT_EQ(window_->drawn()->request.draw.settings.scene, file().string());
  EXPECT_EQ(window_->objects_message(), "");

  window_.reset();
  open_above(file());
  ASSERT_EQ(editor().items().size(), 2U);
  EXPECT_EQ(placing("Box").place.lat_deg, moved.lat_deg);
  EXPECT_FALSE(editor().is_changed());
}

TEST_F(ObjectsPanelTest, ANewSceneIsMadeOfTheFileOfAModel) {
  open_above({});
  EXPECT_TRUE(editor().items().empty());
  enter("Add##model file", (folder_ / "no.glb").string());
  EXPECT_NE(window_->state().message.find("there is no such file"), std::string::npos)
      << window_->state().message;
  enter("Add##model file", (folder_ / "models/box.sticks").string());
  click("Place");
  move(700, 400);
  key("v");  // in the middle of the view
  ASSERT_EQ(editor().items().size(), 1U);
  key("Escape");
  const double width = window_->session().view().width;
  EXPECT_LT(mars::distance_rad(placing("Box").place,
                               under(left() + width / 2, window_->session().view().height / 2.0)),
            1e-9);
  EXPECT_TRUE(placing("Box").follows_slope);
  enter("object/Scale", "30000");
  enter("object/Heading", "77");
  EXPECT_EQ(placing("Box").heading_deg, 77);
  EXPECT_EQ(placing("Box").scale, 30000);
  click("object/Keeps its altitude");
  EXPECT_EQ(placing("Box").height_kind, objects::HeightKind::kAltitude);
  EXPECT_NEAR(placing("Box").height_m,
              window_->session().ground().height_m(mars::direction(placing("Box").place)), 1e-6);
  click("object/Put on the ground");
  EXPECT_EQ(placing("Box").height_kind, objects::HeightKind::kAboveGround);
  EXPECT_EQ(placing("Box").height_m, 0);
  enter("Name##object", "Tower");
  ASSERT_NE(item("Tower"), nullptr);
  enter("##scene file", "made.scene.toml");
  click("Save##objects");
  settle();
  const objects::SceneFile saved = objects::read_scene_file(folder_ / "made.scene.toml");
  ASSERT_EQ(saved.objects.size(), 1U);
  EXPECT_EQ(saved.objects[0].name, "Tower");
  EXPECT_EQ(saved.models[0].file, folder_ / "models/box.sticks");
  EXPECT_EQ(window_->session().settings().values().scene, (folder_ / "made.scene.toml").string());
  // Another scene in its place.
  enter("##scene file", file().string());
  click("Open##objects");
  settle();
  EXPECT_NE(item("Driver"), nullptr);
  click("Close##objects");
  settle();
  EXPECT_TRUE(editor().items().empty());
  EXPECT_EQ(window_->session().settings().values().scene, "");
}

TEST_F(ObjectsPanelTest, UnsavedScenesAreKeptAndRestored) {
  open_above(file());
  click("Place");
  click(800, 300);
  settle();
  const std::string message = window_->objects_message();
  EXPECT_NE(message.find("the scene was not saved; a copy is in "), std::string::npos) << message;
  fs::path left_file;
  for (const auto& entry : fs::directory_iterator(folder_.path()))
    if (entry.path().filename().string().starts_with("vpe-unsaved-")) left_file = entry.path();
  ASSERT_FALSE(left_file.empty());
  EXPECT_EQ(objects::read_scene_file(left_file).objects.size(), 2U);
  window_.reset();
  // A copy that a program has left behind.
  const fs::path copy = folder_ / "state/unsaved.no-such-machine-1.scene.toml";
  fs::create_directories(copy.parent_path());
  objects::write_scene_file(objects::read_scene_file(left_file), copy);
  fs::last_write_time(copy, fs::file_time_type::clock::now() - std::chrono::hours(48));
  ASSERT_EQ(extra_.session.settings.set("scene", ""), "");
  open_above({});
  EXPECT_NE(opening_message_.find("unsaved scene"), std::string::npos) << opening_message_;
  click("Restore##objects");
  settle();
  EXPECT_EQ(editor().items().size(), 3U) << window_->state().message;
  EXPECT_TRUE(editor().is_changed());
  EXPECT_FALSE(fs::exists(copy));
  ASSERT_EQ(copies().size(), 1U);
  EXPECT_EQ(window_->drawn()->request.draw.settings.scene, copies()[0].string());
}

TEST_F(ObjectsPanelTest, AFileThatIsEditedByOthersIsReadAgain) {
  open_above(file());
  std::string text = kObjectScene;
  text.replace(text.find("\"One\""), 5, "\"Two\"");
  base::write_file(file(), std::string_view(text));
  for (int n = 0; n < 600 && item("Two") == nullptr; ++n) {
    move(600 + n % 2, 400);
    iterate(1);
  }
  EXPECT_NE(item("Two"), nullptr);
  // Not while there are changes.
  click("Place");
  click(800, 300);
  ASSERT_EQ(editor().items().size(), 3U);
  click("Open##objects");
  EXPECT_NE(window_->state().message.find("unsaved changes"), std::string::npos) << window_->state().message;
  EXPECT_EQ(editor().items().size(), 3U);
}

}  // namespace
}  // namespace vpe::window
