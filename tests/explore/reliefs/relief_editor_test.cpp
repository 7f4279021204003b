// Reliefs that are added, moved, changed, ordered and deleted, with undo.
#include "vpe/explore/reliefs/relief_editor.h"

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace vpe::explore {
namespace {

using relief::ReliefKind;
using relief::ReliefSpec;

constexpr double kRadius_m = 3'396'190;

ReliefSpec crater(mars::LonLat place = {10, 20}, double radius_m = 1000) {
  ReliefSpec relief;
  relief.place = place;
  relief.radius_m = radius_m;
  return relief;
}

std::string titles(const ReliefEditor& editor) {
  std::string all;
  for (const SharedRelief& item : editor.items()) all += relief_title(item->relief) + ";";
  return all;
}

TEST(ReliefEditor, NamesWhatHasNone) {
  ReliefEditor editor(kRadius_m);
  EXPECT_EQ(editor.newest(), 0U);
  EXPECT_EQ(editor.add(crater()), "");
  EXPECT_EQ(editor.add(crater()), "");
  ReliefSpec named = crater();
  named.name = "Pit";
  EXPECT_EQ(editor.add(named), "");
  EXPECT_EQ(titles(editor), "Crater;Crater 2;Pit;");
  EXPECT_EQ(editor.find(editor.newest())->relief.name, "Pit");
  EXPECT_EQ(editor.add(named), "name: another relief has it");
  EXPECT_EQ(editor.items().size(), 3U);
  EXPECT_EQ(editor.find(12345), nullptr);
}

TEST(ReliefEditor, RefusesWhatCannotBePlaced) {
  ReliefEditor editor(kRadius_m);
  EXPECT_NE(editor.add(crater({0, 0}, -5)).find("radius_m"), std::string::npos);
  EXPECT_NE(editor.add(crater({0, 0}, 5e6)), "");  // reaches too far around the planet
  ASSERT_EQ(editor.add(crater()), "");
  const std::uint64_t id = editor.newest();
  EXPECT_NE(editor.move(id, {0, 91}).find("lat"), std::string::npos);
  EXPECT_NE(editor.replace(id, crater({0, 0}, 0), "shrink"), "");
  EXPECT_EQ(*editor.find(id)->relief.radius_m, 1000);
  EXPECT_EQ(editor.move(id + 1, {0, 0}), "there is no such relief");
  EXPECT_EQ(editor.replace(id + 1, crater(), "change"), "there is no such relief");
  EXPECT_EQ(editor.remove(id + 1), "there is no such relief");
  EXPECT_EQ(editor.shift(id + 1, true), "there is no such relief");
  EXPECT_EQ(editor.undo_text(), "add 'Crater'");
  const std::uint64_t revision = editor.revision();
  ReliefSpec twice = crater();
  twice.name = "a";
  EXPECT_EQ(editor.load({twice, twice}), "relief 2 \"a\": name: another relief has it");
  EXPECT_NE(editor.load({crater({0, 0}, -1)}).find("relief 1"), std::string::npos);
  EXPECT_EQ(editor.revision(), revision);
}

TEST(ReliefEditor, ADragIsOneStep) {
  ReliefEditor editor(kRadius_m);
  ASSERT_EQ(editor.add(crater()), "");
  const std::uint64_t id = editor.newest();
  EXPECT_EQ(editor.move(id, {11, 20}), "");
  EXPECT_EQ(editor.move(id, {12, 20}, true), "");
  EXPECT_EQ(editor.move(id, {373, 20}, true), "");
  EXPECT_EQ(editor.find(id)->relief.place.lon_deg, 13);
  EXPECT_EQ(editor.undo_text(), "move 'Crater'");
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(editor.find(id)->relief.place.lon_deg, 10);
  EXPECT_EQ(editor.redo_text(), "move 'Crater'");
  EXPECT_TRUE(editor.redo());
  EXPECT_EQ(editor.find(id)->relief.place.lon_deg, 13);
  // After an undo a drag goes on as another step.
  EXPECT_EQ(editor.move(id, {14, 20}, true), "");
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(editor.find(id)->relief.place.lon_deg, 13);
  // What changes nothing is no step.
  const std::uint64_t revision = editor.revision();
  EXPECT_EQ(editor.move(id, {13, 20}), "");
  EXPECT_EQ(editor.revision(), revision);
}

TEST(ReliefEditor, APolygonMovesWithItsPlace) {
  ReliefEditor editor(kRadius_m);
  ReliefSpec flood;
  flood.kind = ReliefKind::kFlood;
  flood.place = {10, 0};
  flood.rise_m = 5;
  flood.polygon = {{9.9, -0.1}, {10.1, -0.1}, {10, 0.1}};
  ASSERT_EQ(editor.add(flood), "");
  ASSERT_EQ(editor.move(editor.newest(), {50, 0}), "");
  const ReliefSpec moved = editor.find(editor.newest())->relief;
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_NEAR(moved.polygon[n].lon_deg, flood.polygon[n].lon_deg + 40, 1e-9);
    EXPECT_NEAR(moved.polygon[n].lat_deg, flood.polygon[n].lat_deg, 1e-9);
  }
}

TEST(ReliefEditor, OrderCounts) {
  ReliefEditor editor(kRadius_m);
  for (const char* name : {"a", "b", "c"}) {
    ReliefSpec relief = crater();
    relief.name = name;
    ASSERT_EQ(editor.add(relief), "");
  }
  const std::uint64_t c = editor.newest();
  EXPECT_EQ(editor.shift(c, true), "");
  EXPECT_EQ(editor.undo_text(), "add 'c'");
  EXPECT_EQ(editor.shift(c, false), "");
  EXPECT_EQ(titles(editor), "a;c;b;");
  EXPECT_EQ(editor.reliefs()[1].name, "c");
  EXPECT_EQ(editor.undo_text(), "make earlier 'c'");
  EXPECT_EQ(editor.remove(c), "");
  EXPECT_EQ(titles(editor), "a;b;");
  EXPECT_TRUE(editor.undo());
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(titles(editor), "a;b;c;");
  editor.forget_redo();
  EXPECT_FALSE(editor.redo());
}

TEST(ReliefEditor, KnowsWhatIsSaved) {
  ReliefEditor editor(kRadius_m);
  EXPECT_FALSE(editor.is_changed());
  ASSERT_EQ(editor.load({crater(), crater()}), "");
  EXPECT_FALSE(editor.is_changed());
  EXPECT_EQ(titles(editor), "Crater;Crater;");
  EXPECT_FALSE(editor.undo());
  const std::uint64_t saves = editor.saves();
  ASSERT_EQ(editor.add(crater()), "");
  EXPECT_TRUE(editor.is_changed());
  editor.mark_saved();
  EXPECT_FALSE(editor.is_changed());
  EXPECT_NE(editor.saves(), saves);
  EXPECT_TRUE(editor.undo());
  EXPECT_TRUE(editor.is_changed());
  EXPECT_TRUE(editor.redo());
  EXPECT_FALSE(editor.is_changed());
  editor.mark_unsaved();
  EXPECT_TRUE(editor.is_changed());
  EXPECT_EQ(editor.undo_state().undo_steps, 1U);
}

}  // namespace
}  // namespace vpe::explore
