#include "vpe/explore/objects/scene_editor.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <random>

#include "objects/files/scene_writer.h"

namespace vpe::explore {
namespace {

using objects::HeightKind;
using objects::Placing;

constexpr const char* kScene = R"(version = 1
[[model]]
name = "rover"
file = "rover.glb"
[[model]]
name = "rock"
file = "rock.glb"
[[scatter]]
name = "Field"
models = ["rock"]
polygon = [[0, 0], [1, 0], [1, 1]]
rock_abundance = 0.1
diameter_m = [0.1, 2]
[[path]]
name = "Drive"
model = "rover"
points = [[-5, 0, 0], [60, 0.1, 0]]
[[object]]
name = "One"
model = "rover"
lon = 10
lat = 20
height = 3
interest_levels = 2
[[object]]
model = "rock"
at = [[1, 2], [3, 4]]
)";

SceneEditor opened() {
  SceneEditor editor;
  editor.load(objects::parse_scene_toml(kScene, "/scenes/a.scene.toml"));
  return editor;
}

std::string text_of(const SceneEditor& editor) {
  return objects::to_toml(editor.scene(), "/scenes/a.scene.toml");
}

const Placing& placing(const SceneEditor& editor, std::uint64_t id) {
  return *single_placing(*editor.find(id));
}

TEST(SceneEditor, ListsObjectsThenPathsThenScatters) {
  const SceneEditor editor = opened();
  ASSERT_EQ(editor.items().size(), 4U);
  std::vector<std::string> titles;
  std::vector<std::string> kinds;
  for (const SharedItem& item : editor.items()) {
    titles.push_back(item_title(*item, editor.models()));
    kinds.push_back(item_kind(*item, editor.models()));
  }
  EXPECT_EQ(titles, (std::vector<std::string>{"One", "(2 of rock)", "Drive", "Field"}));
  EXPECT_EQ(kinds, (std::vector<std::string>{"rover", "2 of rock", "path of rover", "rocks"}));
  EXPECT_EQ(called(*editor.items()[0]), "'One'");
  EXPECT_EQ(called(*editor.items()[1]), "the object");
  EXPECT_NE(single_placing(*editor.items()[0]), nullptr);
  for (std::size_t n = 1; n < 4; ++n) EXPECT_EQ(single_placing(*editor.items()[n]), nullptr);
  EXPECT_FALSE(editor.is_changed());
  EXPECT_EQ(time_range(editor.items()).begin_s, -5);
  EXPECT_EQ(time_range(editor.items()).end_s, 60);
  EXPECT_EQ(text_of(editor), objects::to_toml(objects::parse_scene_toml(kScene, "/scenes/a.scene.toml"),
                                              "/scenes/a.scene.toml"));
}

TEST(SceneEditor, PlacesObjectsUnderFreeNames) {
  SceneEditor editor = opened();
  Placing placed;
  placed.place = {190, 5};
  placed.heading_deg = 40;
  EXPECT_EQ(editor.add(editor.models()[0], placed), "");
  const std::uint64_t first = editor.newest();
  EXPECT_EQ(item_name(*editor.find(first)), "Rover");
  EXPECT_EQ(placing(editor, first).place.lon_deg, -170);
  EXPECT_EQ(editor.models().size(), 2U);
  EXPECT_EQ(editor.add(editor.models()[0], placed), "");
  EXPECT_EQ(item_name(*editor.find(editor.newest())), "Rover 2");
  // Another file with the name of a model.
  EXPECT_EQ(editor.add({"rover", "/other/rover.glb"}, placed), "");
  ASSERT_EQ(editor.models().size(), 3U);
  EXPECT_EQ(editor.models()[2].name, "rover 2");
  EXPECT_EQ(item_name(*editor.find(editor.newest())), "Rover 2 2");
  // Objects stand before paths.
  EXPECT_EQ(editor.items()[4]->id, editor.newest());
  EXPECT_EQ(editor.scene().objects.size(), 5U);
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(editor.models().size(), 2U);
}

TEST(SceneEditor, EditsOnePlaceAndKeepsTheRest) {
  SceneEditor editor = opened();
  const std::uint64_t id = editor.items()[0]->id;
  EXPECT_EQ(editor.move(id, {370, -5}), "");
  EXPECT_EQ(placing(editor, id).place.lon_deg, 10);
  EXPECT_EQ(placing(editor, id).place.lat_deg, -5);
  EXPECT_EQ(placing(editor, id).height_m, 3);
  EXPECT_EQ(editor.scene().objects[0].interest_levels, 2);
  Placing turned = placing(editor, id);
  turned.heading_deg = 77;
  turned.height_kind = HeightKind::kAltitude;
  EXPECT_EQ(editor.replace(id, turned, "turn"), "");
  EXPECT_EQ(editor.undo_text(), "turn 'One'");
  EXPECT_EQ(editor.rename(id, "Two"), "");
  EXPECT_EQ(editor.rename(editor.items()[3]->id, ""), "");
  EXPECT_EQ(editor.scene().scatters[0].name, "");
  const objects::SceneFile scene = editor.scene();
  EXPECT_EQ(scene.objects[0].name, "Two");
  EXPECT_EQ(scene.objects[0].places[0].heading_deg, 77);
  EXPECT_EQ(scene.objects[0].places[0].height_kind, HeightKind::kAltitude);
  EXPECT_EQ(scene.paths[0].points.size(), 2U);
}

TEST(SceneEditor, RefusesWhatCannotBe) {
  SceneEditor editor = opened();
  const std::string before = text_of(editor);
  const std::uint64_t revision = editor.revision();
  const std::uint64_t one = editor.items()[0]->id;
  EXPECT_NE(editor.move(one, {0, 91}), "");
  EXPECT_NE(editor.move(one, {std::numeric_limits<double>::quiet_NaN(), 0}), "");
  Placing flat = placing(editor, one);
  flat.scale = 0;
  EXPECT_EQ(editor.replace(one, flat, "scale"), "scale: expected a number in (0, 1000000]");
  EXPECT_NE(editor.rename(one, "a\nb"), "");
  EXPECT_NE(editor.move(editor.items()[1]->id, {0, 0}), "");
  EXPECT_NE(editor.replace(editor.items()[2]->id, {}, "move"), "");
  EXPECT_NE(editor.move(12345, {0, 0}), "");
  EXPECT_NE(editor.rename(12345, "a"), "");
  EXPECT_NE(editor.remove(12345), "");
  EXPECT_NE(editor.add({"bad\nname", "/m.glb"}, {}), "");
  EXPECT_EQ(text_of(editor), before);
  EXPECT_EQ(editor.revision(), revision);
  EXPECT_EQ(editor.undo_text(), "");
}

TEST(SceneEditor, DeletesItemsOfAllKinds) {
  SceneEditor editor = opened();
  while (!editor.items().empty()) EXPECT_EQ(editor.remove(editor.items().back()->id), "");
  EXPECT_TRUE(editor.scene().objects.empty() && editor.scene().paths.empty() &&
              editor.scene().scatters.empty());
  EXPECT_EQ(editor.models().size(), 2U);
  EXPECT_EQ(editor.undo_text(), "delete 'One'");
  for (int n = 0; n < 4; ++n) EXPECT_TRUE(editor.undo());
  EXPECT_FALSE(editor.undo());
  EXPECT_FALSE(editor.is_changed());
  EXPECT_EQ(text_of(editor), text_of(opened()));
}

TEST(SceneEditor, ADragIsOneStep) {
  SceneEditor editor = opened();
  const std::uint64_t one = editor.items()[0]->id;
  EXPECT_EQ(editor.move(one, {11, 20}), "");
  for (int n = 0; n < 5; ++n) EXPECT_EQ(editor.move(one, {12.0 + n, 20}, true), "");
  EXPECT_EQ(editor.undo_state().undo_steps, 1U);
  EXPECT_EQ(placing(editor, one).place.lon_deg, 16);
  // A second drag begins anew.
  EXPECT_EQ(editor.move(one, {30, 20}, false), "");
  EXPECT_EQ(editor.move(one, {31, 20}, true), "");
  EXPECT_EQ(editor.undo_state().undo_steps, 2U);
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(placing(editor, one).place.lon_deg, 16);
  EXPECT_TRUE(editor.redo());
  EXPECT_EQ(placing(editor, one).place.lon_deg, 31);
  // After undo nothing goes on.
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(editor.move(one, {40, 20}, true), "");
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(placing(editor, one).place.lon_deg, 16);
}

TEST(SceneEditor, KnowsWhatIsSaved) {
  SceneEditor editor = opened();
  const std::uint64_t one = editor.items()[0]->id;
  EXPECT_EQ(editor.move(one, {11, 20}), "");
  EXPECT_TRUE(editor.is_changed());
  EXPECT_TRUE(editor.undo());
  EXPECT_FALSE(editor.is_changed());
  EXPECT_TRUE(editor.redo());
  const std::uint64_t saves = editor.saves();
  editor.mark_saved();
  EXPECT_NE(editor.saves(), saves);
  EXPECT_FALSE(editor.is_changed());
  EXPECT_TRUE(editor.undo());
  EXPECT_TRUE(editor.is_changed());
  editor.mark_saved();
  editor.mark_unsaved();
  EXPECT_TRUE(editor.is_changed());
  editor.load({});
  EXPECT_FALSE(editor.is_changed());
  EXPECT_FALSE(editor.undo());
}

// Whatever is edited, undo leads back through the same states, and redo forth.
RC_GTEST_PROP(SceneEditorProperty, UndoAndRedoPassTheSameStates, (unsigned seed)) {
  std::mt19937 random(seed);
  SceneEditor editor = opened();
  std::vector<std::string> states{text_of(editor)};
  for (int n = 0; n < 12; ++n) {
    const auto& items = editor.items();
    const std::size_t steps = editor.undo_state().undo_steps;
    const std::uint64_t id = items.empty() ? 0 : items[random() % items.size()]->id;
    const double some = static_cast<double>(random() % 90);
    switch (random() % 4) {
      case 0: (void)editor.add(editor.models()[random() % 2], Placing{{some, some}}); break;
      case 1: (void)editor.move(id, {some, -some}); break;
      case 2: (void)editor.rename(id, "n" + std::to_string(random() % 5)); break;
      default: (void)editor.remove(id); break;
    }
    if (editor.undo_state().undo_steps > steps) states.push_back(text_of(editor));
  }
  for (std::size_t n = states.size() - 1; n-- > 0;) {
    RC_ASSERT(editor.undo());
    RC_ASSERT(text_of(editor) == states[n]);
  }
  RC_ASSERT(!editor.undo());
  RC_ASSERT(!editor.is_changed());
  for (std::size_t n = 1; n < states.size(); ++n) {
    RC_ASSERT(editor.redo());
    RC_ASSERT(text_of(editor) == states[n]);
  }
  RC_ASSERT(!editor.redo());
}

}  // namespace
}  // namespace vpe::explore
