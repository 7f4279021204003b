// Tests of the list of drawings and of one order of undo.
#include "vpe/explore/drawing/drawings.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <limits>

#include "vpe/explore/drawing/bookmark_list.h"
#include "vpe/explore/flight_undo.h"

namespace vpe::explore {
namespace {

Drawing polygon(std::string name = "Rim") {
  Drawing drawing;
  drawing.kind = DrawingKind::kPolygon;
  drawing.name = std::move(name);
  drawing.vertices = {{0, 0}, {10, 0}, {10, 10}};
  return drawing;
}

Drawing point(mars::LonLat place, std::string name = "") {
  Drawing drawing;
  drawing.name = std::move(name);
  drawing.vertices = {place};
  return drawing;
}

TEST(Drawings, AreEditedAndUndone) {
  Drawings drawings;
  EXPECT_FALSE(drawings.is_changed());
  ASSERT_EQ(drawings.add(polygon()), "");
  const std::uint64_t id = drawings.all()[0]->id;
  EXPECT_EQ(drawings.undo_text(), "draw 'Rim'");
  ASSERT_EQ(drawings.insert_vertex(id, 3, {190, 10}), "");
  EXPECT_EQ(drawings.find(id)->vertices.back().lon_deg, -170);
  EXPECT_EQ(drawings.undo_text(), "insert vertex 4 of 'Rim'");
  ASSERT_EQ(drawings.move_vertex(id, 2, {11, 11}), "");
  EXPECT_EQ(drawings.undo_text(), "move vertex 3 of 'Rim'");
  ASSERT_EQ(drawings.rename(id, "Crater"), "");
  EXPECT_EQ(drawings.undo_text(), "rename 'Rim'");
  ASSERT_EQ(drawings.recolour(id, {1, 2, 3}), "");
  ASSERT_EQ(drawings.show(id, false), "");
  EXPECT_EQ(drawings.undo_text(), "hide 'Crater'");
  ASSERT_EQ(drawings.remove_vertex(id, 0), "");
  ASSERT_EQ(drawings.add(point({1, 2})), "");
  EXPECT_EQ(drawings.all()[1]->name, "Point 1");
  ASSERT_EQ(drawings.add(point({1, 2})), "");
  EXPECT_EQ(drawings.all()[2]->name, "Point 2");
  ASSERT_EQ(drawings.reorder(id, 2), "");
  EXPECT_EQ(drawings.all()[2]->id, id);
  ASSERT_EQ(drawings.remove(id), "");
  EXPECT_EQ(drawings.find(id), nullptr);
  int steps = 0;
  while (drawings.undo()) ++steps;
  EXPECT_EQ(steps, 11);
  EXPECT_EQ(drawings.size(), 0U);
  EXPECT_FALSE(drawings.is_changed());
  while (drawings.redo()) --steps;
  EXPECT_EQ(steps, 0);
  EXPECT_EQ(drawings.size(), 2U);
  EXPECT_TRUE(drawings.is_changed());
}

TEST(Drawings, WrongEditsSayWhyAndChangeNothing) {
  Drawings drawings;
  ASSERT_EQ(drawings.add(polygon()), "");
  const std::uint64_t id = drawings.all()[0]->id;
  const std::uint64_t revision = drawings.revision();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto wrong = [&](const Drawings::Problem& problem, const std::string& part) {
    EXPECT_NE(problem.find(part), std::string::npos) << problem;
    EXPECT_EQ(drawings.revision(), revision);
  };
  wrong(drawings.remove_vertex(id, 0), "at least 3 vertices");
  wrong(drawings.move_vertex(id, 0, {nan, 0}), "a finite longitude");
  wrong(drawings.move_vertex(id, 0, {0, 91}), "latitude from -90 to 90");
  wrong(drawings.insert_vertex(id, 1, {0, std::numeric_limits<double>::infinity()}), "finite");
  wrong(drawings.move_vertex(id, 3, {0, 0}), "there is no vertex 4 of 'Rim'");
  wrong(drawings.insert_vertex(id, 4, {0, 0}), "there is no vertex 5");
  wrong(drawings.move_vertex(id, 0, {-170, 0}), "opposite sides of the planet");
  wrong(drawings.rename(id, "two\nlines"), "one line");
  wrong(drawings.rename(id, std::string(201, 'x')), "at most 200 bytes");
  wrong(drawings.rename(id, "\xff\xfe"), "UTF-8");
  wrong(drawings.remove(99), "gone");
  wrong(drawings.show(99, true), "gone");
  wrong(drawings.reorder(id, 1), "no position 2");
  Drawing two = point({0, 0});
  two.vertices.push_back({1, 1});
  wrong(drawings.add(two), "a point has one vertex, not 2");
  two.kind = DrawingKind::kLine;
  two.vertices.resize(1);
  wrong(drawings.add(two), "a line has at least 2 vertices, not 1");
  two.vertices.assign(DrawingLimits::kMostVertices + 1, {1, 1});
  wrong(drawings.add(two), "at most 50000 vertices");
  wrong(drawings.add_all({polygon("a"), two}, "open"), "the line: ");
  EXPECT_EQ(drawings.add(point({720, 90})), "");
  EXPECT_EQ(drawings.all()[1]->vertices[0].lon_deg, 0);
}

TEST(Drawings, OneDragIsOneStep) {
  Drawings drawings;
  ASSERT_EQ(drawings.add(polygon()), "");
  const std::uint64_t id = drawings.all()[0]->id;
  for (int n = 0; n < 20; ++n) ASSERT_EQ(drawings.move_vertex(id, 1, {10.0 + n, 1}, n > 0), "");
  EXPECT_EQ(drawings.undo_state().undo_steps, 2U);
  ASSERT_EQ(drawings.move_vertex(id, 2, {5, 5}, true), "");  // another vertex
  EXPECT_EQ(drawings.undo_state().undo_steps, 3U);
  drawings.undo();
  drawings.undo();
  EXPECT_EQ(drawings.find(id)->vertices[1].lon_deg, 10);
}

TEST(Drawings, LimitsAreKept) {
  Drawings drawings;
  std::vector<Drawing> many(DrawingLimits::kMostDrawings, point({1, 1}, "p"));
  ASSERT_EQ(drawings.add_all(many, "open"), "");
  EXPECT_EQ(drawings.undo_state().undo_steps, 1U);
  EXPECT_NE(drawings.add(point({1, 1})).find("at most 5000 drawings"), std::string::npos);
  Drawings large;
  Drawing line;
  line.kind = DrawingKind::kLine;
  line.vertices.assign(DrawingLimits::kMostVertices, {1, 1});
  ASSERT_EQ(large.add_all(std::vector<Drawing>(10, line), "open"), "");
  EXPECT_NE(large.add(point({1, 1})).find("at most 500000"), std::string::npos);
  // Old steps go, when they hold much that later ones do not.
  const std::uint64_t id = large.all()[0]->id;
  for (int n = 0; n < 200; ++n) ASSERT_EQ(large.move_vertex(id, 7, {n * 0.1, 3}), "");
  const UndoState state = large.undo_state();
  EXPECT_EQ(state.made, 201U);
  EXPECT_EQ(state.dropped + state.undo_steps, 201U);
  EXPECT_LE(state.undo_steps, (64U << 20) / (50'000 * 16));
  EXPECT_GT(state.undo_steps, 60U);
}

TEST(Drawings, LoadedOnesAreSavedOnes) {
  Drawings drawings;
  ASSERT_EQ(drawings.add(polygon()), "");
  ASSERT_EQ(drawings.load({polygon("a"), polygon("b")}), "");
  EXPECT_EQ(drawings.size(), 2U);
  EXPECT_FALSE(drawings.is_changed());
  EXPECT_FALSE(drawings.undo());
  drawings.mark_unsaved();
  EXPECT_TRUE(drawings.is_changed());
  drawings.mark_saved();
  EXPECT_FALSE(drawings.is_changed());
}

// Random edits of two stores: undo goes back through all states of both in their order, redo forward again.
TEST(UndoHistory, UndoesTheLastEditWhateverItWas) {
  EXPECT_TRUE(rc::check([] {
    std::vector<Drawings> stores(2);
    UndoHistory history;
    for (Drawings& store : stores) history.join(store);
    const auto state = [&] {
      std::vector<std::vector<Drawings::Shared>> all;
      for (const Drawings& store : stores) all.emplace_back(store.all().begin(), store.all().end());
      return all;
    };
    std::vector<decltype(state())> past{state()};
    std::size_t now = 0;
    const int actions = *rc::gen::inRange(1, 60);
    for (int n = 0; n < actions; ++n) {
      switch (*rc::gen::inRange(0, 5)) {
        case 0:
          RC_ASSERT(history.undo().empty() == (now == 0));
          now -= now > 0 ? 1 : 0;
          break;
        case 1:
          RC_ASSERT(history.redo().empty() == (now + 1 == past.size()));
          now += now + 1 < past.size() ? 1 : 0;
          break;
        default: {
          Drawings& store = stores[static_cast<std::size_t>(*rc::gen::inRange(0, 2))];
          RC_ASSERT(store.add(point({1.0 * n, 0})).empty());
          history.update();
          past.resize(++now);
          past.push_back(state());
        }
      }
      RC_ASSERT(state() == past[now]);
    }
  }));
}

// A store whose own buttons undo and redo, and which is replaced or forgets old steps, keeps the order.
TEST(UndoHistory, FollowsWhatStoresDoThemselves) {
  Drawings a;
  Drawings b;
  UndoHistory history;
  ASSERT_EQ(a.add(point({0, 0}, "before")), "");
  history.join(a);
  history.join(b);
  EXPECT_EQ(history.undo_text(), "draw 'before'");
  ASSERT_EQ(a.add(point({0, 0}, "a1")), "");
  history.update();
  ASSERT_EQ(b.add(point({0, 0}, "b1")), "");
  history.update();
  ASSERT_EQ(a.add(point({0, 0}, "a2")), "");
  a.undo();  // by its own button
  EXPECT_EQ(history.undo_text(), "draw 'b1'");
  EXPECT_EQ(history.redo_text(), "draw 'a2'");
  a.redo();
  EXPECT_EQ(history.undo_text(), "draw 'a2'");
  EXPECT_EQ(history.redo_text(), "");
  EXPECT_EQ(history.undo(), "draw 'a2'");
  EXPECT_EQ(history.undo(), "draw 'b1'");
  ASSERT_EQ(a.add(point({0, 0}, "a3")), "");
  EXPECT_EQ(history.redo(), "");  // a new edit ends what could be repeated, in all stores
  EXPECT_EQ(b.redo_text(), "");
  EXPECT_EQ(history.undo(), "draw 'a3'");
  ASSERT_EQ(b.add(point({0, 0}, "b2")), "");
  history.update();
  ASSERT_EQ(a.load({polygon()}), "");
  EXPECT_EQ(history.undo(), "draw 'b2'");
  EXPECT_EQ(history.undo(), "");
  EXPECT_EQ(a.size(), 1U);
}

TEST(UndoHistory, HoldsTheFlightToo) {
  FlightController flights(mars::kMarsRadius_m, [](mars::LonLat, double) { return 0.0; });
  FlightUndo flight(flights);
  Drawings drawings;
  UndoHistory history;
  history.join(drawings);
  history.join(flight);
  mars::Pose pose;
  pose.alt_m = 5000;
  ASSERT_EQ(flights.append(pose, 1000), "");  // makes the flight
  EXPECT_EQ(history.undo_text(), "");
  pose.lon_deg = 1;
  ASSERT_EQ(flights.append(pose, 1000), "");
  history.update();
  ASSERT_EQ(drawings.add(polygon()), "");
  history.update();
  ASSERT_EQ(flights.editor()->move(1, {2, 2}), "");
  EXPECT_EQ(history.undo(), "move pose 2");
  EXPECT_EQ(history.undo(), "draw 'Rim'");
  EXPECT_EQ(history.undo(), "append pose 2");
  EXPECT_EQ(history.undo(), "");
  EXPECT_EQ(history.redo(), "append pose 2");
  EXPECT_EQ(flights.editor()->flight().waypoints.size(), 2U);
  EXPECT_EQ(history.redo(), "draw 'Rim'");
  flights.clear();
  EXPECT_EQ(history.redo(), "");
  EXPECT_EQ(history.undo(), "draw 'Rim'");
  EXPECT_EQ(history.undo(), "");
}

TEST(UndoHistory, HoldsBookmarksToo) {
  BookmarkList bookmarks;
  bookmarks.load({{1, {{1, 2, 3, 0, 0, 0}, 60}, "one"}});
  Drawings drawings;
  UndoHistory history;
  history.join(drawings);
  history.join(bookmarks);
  EXPECT_FALSE(bookmarks.is_changed());
  ASSERT_EQ(bookmarks.put({1, {{9, 2, 3, 0, 0, 0}, 60}, "other"}), "");
  history.update();
  ASSERT_EQ(drawings.add(polygon()), "");
  history.update();
  ASSERT_EQ(bookmarks.put({0, {{9, 2, 3, 0, 0, 0}, 60}, "named"}), "");
  EXPECT_NE(bookmarks.put({10, {}, "x"}), "");
  EXPECT_NE(bookmarks.put({0, {}, ""}), "");
  EXPECT_EQ(bookmarks.all().size(), 2U);
  EXPECT_TRUE(bookmarks.is_changed());
  EXPECT_FALSE(bookmarks.remove(2));
  EXPECT_TRUE(bookmarks.remove(0));
  EXPECT_FALSE(bookmarks.at_key(1));
  EXPECT_EQ(history.undo(), "delete bookmark 1");
  EXPECT_EQ(history.undo(), "set bookmark 'named'");
  EXPECT_EQ(history.undo(), "draw 'Rim'");
  EXPECT_EQ(history.undo(), "set bookmark 1");
  EXPECT_EQ(bookmarks.at_key(1)->name, "one");
  EXPECT_FALSE(bookmarks.at_key(0));
  EXPECT_EQ(history.redo(), "set bookmark 1");
  EXPECT_EQ(bookmarks.at_key(1)->view.pose.lon_deg, 9);
}

TEST(Drawing, ColoursAndKindsAreText) {
  EXPECT_EQ(colour_text({255, 214, 90}), "#ffd65a");
  EXPECT_EQ(parse_colour("#FFd65a"), (base::Rgb{255, 214, 90}));
  for (const char* wrong : {"", "#", "ffd65a", "#ffd65", "#ffd65ag", "#gfd65a", "red"})
    EXPECT_FALSE(parse_colour(wrong));
  for (const DrawingKind kind : {DrawingKind::kPoint, DrawingKind::kLine, DrawingKind::kPolygon})
    EXPECT_EQ(drawing_kind(to_string(kind)), kind);
  EXPECT_FALSE(drawing_kind("circle"));
}

}  // namespace
}  // namespace vpe::explore
