#include "vpe/explore/flight_editor.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "scripts/path.h"

namespace vpe::explore {
namespace {

using scripts::Flight;
using scripts::Waypoint;

constexpr const char* kFlight =
    "flight 1\n"
    "view fov=50 size=640x360 fps=25\n"
    "at 0 pose lon=0 lat=0 alt=5000 yaw=90 pitch=-15 roll=1\n"
    "at 5 look yaw=10 pitch=5\n"
    "at 10 pose lon=10 lat=0 height=3000 yaw=100 pitch=-10 roll=-20\n"
    "at 10 set mode=wireframe\n"
    "at 12 interest lon=1 lat=2 radius=3000 levels=1\n"
    "at 20 pose lon=12 lat=0 alt=9000\n"
    "at 25 end\n";

Flight flight_of(const std::string& text) { return *scripts::parse_flight(text, "").flight; }

class Editor : public ::testing::Test {
 protected:
  static Waypoint at(double lon_deg, double lat_deg = 0, double time_s = 0) {
    return {.time_s = time_s, .lon_deg = lon_deg, .lat_deg = lat_deg, .up_m = 1000};
  }
  std::vector<double> times() const {
    std::vector<double> all;
    for (const Waypoint& w : editor_.flight().waypoints) all.push_back(w.time_s);
    return all;
  }
  // Expects an edit to be rejected with this text, and nothing to change.
  void expect_rejected(const std::function<std::string()>& edit, const std::string& text) {
    const Flight before = editor_.flight();
    const std::string undo = editor_.undo_text();
    const std::string problem = edit();
    EXPECT_NE(problem.find(text), std::string::npos) << problem << "\nexpected: " << text;
    EXPECT_EQ(editor_.flight(), before);
    EXPECT_EQ(editor_.undo_text(), undo);
  }

  static constexpr double kDegree_m = mars::kMarsRadius_m * mars::kRadiansPerDegree;
  FlightEditor editor_{flight_of(kFlight), mars::kMarsRadius_m};
};

TEST_F(Editor, AppendsWithTheTimeOfThePath) {
  ASSERT_EQ(editor_.append(at(13), kDegree_m / 2), "");
  EXPECT_NEAR(times().back(), 22, 1e-9);
  EXPECT_EQ(editor_.flight().end_s, 25);
  ASSERT_EQ(editor_.append(at(23), kDegree_m), "");
  EXPECT_NEAR(times().back(), 32, 1e-9);
  EXPECT_EQ(editor_.flight().end_s, times().back());  // moved along
  ASSERT_EQ(editor_.append(at(23), kDegree_m), "");   // rotates in place
  EXPECT_NEAR(times().back(), 33, 1e-9);
  EXPECT_NEAR(editor_.length_m(), 23 * kDegree_m, 1e-3);
}

TEST_F(Editor, InsertsBetweenInProportion) {
  EXPECT_EQ(editor_.nearest({1, 3}), 0U);
  EXPECT_EQ(editor_.nearest({11.5, 0}), 2U);
  EXPECT_EQ(editor_.nearest({-90, 0}), 0U);
  ASSERT_EQ(editor_.insert_after(0, at(2.5), 1), "");
  EXPECT_NEAR(times()[1], 2.5, 1e-9);
  ASSERT_EQ(editor_.insert_after(0, at(0), 1), "");  // at the same place: not at the same time
  EXPECT_NEAR(times()[1], 0.025, 1e-9);
  ASSERT_EQ(editor_.insert(at(5, 0, 4)), "");
  EXPECT_EQ(editor_.flight().waypoints[3].lon_deg, 5);
  EXPECT_EQ(editor_.undo_text(), "insert pose 4");
  ASSERT_EQ(editor_.insert(at(14, 0, 30)), "");
  EXPECT_EQ(editor_.flight().end_s, 30);
  ASSERT_EQ(editor_.insert_after(6, at(15), kDegree_m), "");
  EXPECT_NEAR(times().back(), 31, 1e-9);
  expect_rejected([&] { return editor_.insert(at(5, 0, 10)); }, "already");
  expect_rejected([&] { return editor_.insert(at(5, 0, -1)); }, "a time in seconds from 0");
  expect_rejected([&] { return editor_.insert_after(77, at(1), 1); }, "there is no pose 78");
}

TEST_F(Editor, MovesKeepingHeightTimeAndAttitude) {
  ASSERT_EQ(editor_.move(1, {11, 3}), "");
  Waypoint wanted = flight_of(kFlight).waypoints[1];
  wanted.lon_deg = 11;
  wanted.lat_deg = 3;
  EXPECT_EQ(editor_.flight().waypoints[1], wanted);
  EXPECT_TRUE(wanted.above_terrain);
}

TEST_F(Editor, ViewsMoveWithThePosesAroundThem) {
  const std::string old(kFlight);
  FlightEditor editor(flight_of("flight 1.1" + old.substr(8, old.size() - 8 - 10) +
                                "at 20 view fov=30 backend=ray\nat 22 view eyes=sbs\nat 25 end\n"),
                      mars::kMarsRadius_m);
  const Flight before = editor.flight();
  ASSERT_EQ(before.views.size(), 2U);
  ASSERT_EQ(editor.scale_times(2), "");
  EXPECT_EQ(editor.flight().views[0].time_s, 40);
  EXPECT_EQ(editor.flight().views[1].time_s, 44);
  EXPECT_EQ(editor.flight().views[0].view, before.views[0].view);
  EXPECT_TRUE(editor.undo());
  ASSERT_EQ(editor.keep_speed(kDegree_m), "");
  EXPECT_EQ(editor.flight().views[0].time_s, editor.flight().waypoints.back().time_s);
  EXPECT_NEAR(editor.flight().views[1].time_s, editor.flight().views[0].time_s + 2, 1e-9);
  ASSERT_EQ(editor.move(1, {11, 1}), "");
  EXPECT_EQ(editor.flight().views[0].view, before.views[0].view);
  EXPECT_EQ(scripts::parse_flight(editor.to_text(), "").flight, editor.flight());
  FlightEditor close(flight_of("flight 1.1\nat 0 pose lon=0 lat=0 alt=1\nat 1 view fov=30\n"
                               "at 1.0000000000000002 view fov=31\n"),
                     mars::kMarsRadius_m);
  EXPECT_NE(close.scale_times(1e-310).find("too close together"), std::string::npos);
}

TEST_F(Editor, ADragIsOneStepOfUndo) {
  ASSERT_EQ(editor_.move(1, {10, 0}), "");  // pressed, not moved yet
  EXPECT_EQ(editor_.undo_text(), "");
  for (int n = 1; n < 20; ++n) ASSERT_EQ(editor_.move(1, {10 + 0.1 * n, 0}, n > 1), "");
  EXPECT_EQ(editor_.undo_text(), "move pose 2");
  ASSERT_EQ(editor_.move(1, {20, 5}), "");  // another drag
  EXPECT_TRUE(editor_.undo());
  EXPECT_NEAR(editor_.flight().waypoints[1].lon_deg, 11.9, 1e-12);
  EXPECT_TRUE(editor_.undo());
  EXPECT_EQ(editor_.flight(), flight_of(kFlight));
  EXPECT_FALSE(editor_.undo());
  ASSERT_EQ(editor_.move(1, {12, 0}, true), "");  // begins with what goes on
  EXPECT_TRUE(editor_.undo());
  EXPECT_EQ(editor_.flight(), flight_of(kFlight));
}

TEST_F(Editor, EditsAnyField) {
  const Waypoint edited{
      .time_s = 11, .lon_deg = -20, .lat_deg = 5, .up_m = 7, .yaw_deg = 1, .pitch_deg = 2, .roll_deg = 3};
  ASSERT_EQ(editor_.replace(1, edited), "");
  EXPECT_EQ(editor_.flight().waypoints[1], edited);
  const auto rejected = [&](auto change, const std::string& text) {
    Waypoint bad = edited;
    change(bad);
    expect_rejected([&] { return editor_.replace(1, bad); }, text);
  };
  rejected([](Waypoint& w) { w.time_s = 20; }, "before 20 s, the time of the neighbouring pose, not 20");
  rejected([](Waypoint& w) { w.time_s = 0; }, "after 0 s");
  rejected([](Waypoint& w) { w.time_s = std::nan(""); }, "a time");
  rejected([](Waypoint& w) { w.lat_deg = 91; }, "a pose needs lat=NUMBER from -90 to 90");
  rejected([](Waypoint& w) { w.lon_deg = std::numeric_limits<double>::infinity(); }, "lon");
  rejected([](Waypoint& w) { w.pitch_deg = -91; }, "pitch");
  rejected([](Waypoint& w) { w.up_m = 1e11; }, "alt");
  rejected([](Waypoint& w) { w.up_m = -3.5e6; }, "centre");
  rejected([](Waypoint& w) { w.up_m = -1, w.above_terrain = true; }, "height");
  rejected([](Waypoint& w) { w.lon_deg = 180, w.lat_deg = 0; }, "opposite sides");
  expect_rejected([&] { return editor_.replace(3, edited); }, "there is no pose 4");
}

TEST_F(Editor, DeletesAllButTheLastPose) {
  ASSERT_EQ(editor_.remove(1), "");
  ASSERT_EQ(editor_.remove(0), "");
  EXPECT_EQ(times(), std::vector<double>{20});
  expect_rejected([&] { return editor_.remove(0); }, "at least one pose");
  EXPECT_EQ(editor_.flight().sets.size(), 1U);
}

TEST_F(Editor, DeletingThePoseBetweenOppositePosesIsRejected) {
  ASSERT_EQ(editor_.replace(2, at(180, 0, 20)), "");
  expect_rejected([&] { return editor_.remove(1); }, "opposite sides");
}

TEST_F(Editor, ScalesAllTimes) {
  ASSERT_EQ(editor_.scale_times(3), "");
  EXPECT_EQ(times(), (std::vector<double>{0, 30, 60}));
  EXPECT_EQ(editor_.flight().heads[0].time_s, 15);
  EXPECT_EQ(editor_.flight().sets[0].time_s, 30);
  EXPECT_EQ(editor_.flight().interests[0].time_s, 36);
  EXPECT_EQ(editor_.flight().end_s, 75);
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    expect_rejected([&] { return editor_.scale_times(bad); }, "factor");
  }
  expect_rejected([&] { return editor_.scale_times(1e6); }, "longer than 1000000 s");
}

TEST_F(Editor, ConstantSpeedMovesCommandsWithTheirPoses) {
  ASSERT_EQ(editor_.keep_speed(kDegree_m / 4), "");
  const auto t = times();
  EXPECT_NEAR(t[1], 40, 1e-9);
  EXPECT_NEAR(t[2], 48, 1e-9);
  EXPECT_NEAR(editor_.flight().heads[0].time_s, 20, 1e-9);
  EXPECT_EQ(editor_.flight().sets[0].time_s, t[1]);
  EXPECT_NEAR(editor_.flight().interests[0].time_s, 41.6, 1e-9);
  EXPECT_NEAR(*editor_.flight().end_s, 53, 1e-9);
  ASSERT_EQ(editor_.insert_after(0, at(0), 1), "");  // stands there
  const double standing_s = times()[1];
  ASSERT_EQ(editor_.keep_speed(kDegree_m), "");
  EXPECT_NEAR(times()[1], standing_s, 1e-12);
  EXPECT_NEAR(times()[2], standing_s + 10, 1e-9);
  expect_rejected([&] { return editor_.keep_speed(0); }, "above 0");
  expect_rejected([&] { return editor_.append(at(3), -1); }, "above 0");
  expect_rejected([&] { return editor_.keep_speed(1e-3); }, "longer than");
  Waypoint first = editor_.flight().waypoints[0];
  first.time_s = 0.5 * standing_s;
  ASSERT_EQ(editor_.replace(0, first), "");
  expect_rejected([&] { return editor_.keep_speed(1e30); }, "too close");
}

TEST_F(Editor, ViewAndEnd) {
  scripts::FlightView view = editor_.flight().view;
  view.fov_deg = 0;
  expect_rejected([&] { return editor_.set_view(view); }, "a view needs fov");
  view.fov_deg = 30;
  ASSERT_EQ(editor_.set_view(view), "");
  EXPECT_EQ(editor_.flight().view.fov_deg, 30);
  expect_rejected([&] { return editor_.set_end(19); }, "from 20 s, the last time");
  expect_rejected([&] { return editor_.set_end(std::nan("")); }, "the end");
  ASSERT_EQ(editor_.set_end(std::nullopt), "");
  EXPECT_FALSE(editor_.flight().end_s.has_value());
}

TEST_F(Editor, AReplacedFlightIsCheckedToo) {
  Flight next = editor_.flight();
  next.heads.push_back({7, 1, 2, 3});
  ASSERT_EQ(editor_.replace_all(next, "add a look"), "");
  EXPECT_EQ(editor_.undo_text(), "add a look");
  next.heads.push_back({6, 1, 2, 3});
  expect_rejected([&] { return editor_.replace_all(next, "x"); }, "order of their times");
  next = editor_.flight();
  next.sets.push_back({20, "exaggeration", "much"});
  expect_rejected([&] { return editor_.replace_all(next, "x"); }, "a flight needs a setting");
  expect_rejected([&] { return editor_.replace_all(Flight(), "x"); }, "at least one pose");
  EXPECT_THROW(FlightEditor(Flight(), mars::kMarsRadius_m), std::invalid_argument);
}

TEST_F(Editor, KnowsWhetherItIsSaved) {
  EXPECT_FALSE(editor_.is_changed());
  ASSERT_EQ(editor_.remove(1), "");
  EXPECT_TRUE(editor_.is_changed());
  EXPECT_TRUE(editor_.undo());
  EXPECT_FALSE(editor_.is_changed());
  EXPECT_EQ(editor_.redo_text(), "delete pose 2");
  EXPECT_TRUE(editor_.redo());
  editor_.mark_saved();
  EXPECT_FALSE(editor_.is_changed());
  EXPECT_FALSE(editor_.redo());
}

TEST(EditorMemory, UndoOfLongFlightsIsBounded) {
  Flight flight;
  for (int n = 0; n < 20000; ++n) flight.waypoints.push_back({.time_s = n * 0.1, .lon_deg = n * 1e-3});
  FlightEditor editor(flight, mars::kMarsRadius_m);
  for (int n = 0; n < 80; ++n) ASSERT_EQ(editor.move(5, {1, 0.1 * n + 0.1}), "");
  std::size_t steps = 0;
  while (editor.undo()) ++steps;
  const std::size_t bytes = flight.waypoints.size() * sizeof(Waypoint);
  EXPECT_LE(steps * bytes, FlightEditorLimits::kUndoBytes);
  EXPECT_GE((steps + 2) * bytes, FlightEditorLimits::kUndoBytes);
}

// Generates numbers that are often valid, often at a limit, sometimes invalid.
double number(double scale) {
  switch (*rc::gen::inRange(0, 80)) {
    case 0: return 0;
    case 1: return scale;
    case 2: return -scale;
    case 3: return 1e12;
    case 4: return std::nan("");
    default: return scale * *rc::gen::inRange(-1000, 1001) / 1000.0;
  }
}

Waypoint some_waypoint() {
  return {.time_s = number(40),
          .lon_deg = number(360),
          .lat_deg = number(90),
          .up_m = number(1e4),
          .above_terrain = *rc::gen::arbitrary<bool>(),
          .yaw_deg = number(360),
          .pitch_deg = number(90),
          .roll_deg = number(360)};
}

std::string some_edit(FlightEditor& editor) {
  const auto index = static_cast<std::size_t>(*rc::gen::inRange(0, 8));
  switch (*rc::gen::inRange(0, 11)) {
    case 0: return editor.insert(some_waypoint());
    case 1: return editor.insert_after(index, some_waypoint(), number(1e5));
    case 2: return editor.append(some_waypoint(), number(1e5));
    case 3: return editor.move(index, {number(360), number(90)}, *rc::gen::arbitrary<bool>());
    case 4: return editor.replace(index, some_waypoint());
    case 5: return editor.remove(index);
    case 6: return editor.scale_times(number(3));
    case 7: return editor.keep_speed(number(1e6));
    case 8: return editor.set_end(number(60));
    case 9: return editor.undo() ? "" : "nothing to undo";
    default: return editor.redo() ? "" : "nothing to redo";
  }
}

TEST(EditorProperties, AnyEditsGiveAFlightThatReadsBackAndPlays) {
  int taken = 0;
  int refused = 0;
  rc::check([&] {
    FlightEditor editor(flight_of(kFlight), mars::kMarsRadius_m);
    for (int n = *rc::gen::inRange(0, 60); n > 0; --n) {
      const Flight before = editor.flight();
      const std::string problem = some_edit(editor);
      (problem.empty() ? taken : refused) += 1;
      if (!problem.empty()) RC_ASSERT(editor.flight() == before);
      const scripts::ParsedFlight parsed = scripts::parse_flight(editor.to_text(), "");
      RC_ASSERT(parsed.flight.has_value());
      RC_ASSERT(*parsed.flight == editor.flight());
    }
    const scripts::Path path(editor.flight(), mars::kMarsRadius_m, [](mars::LonLat, double) { return 100.0; });
    RC_ASSERT(std::isfinite(path.at(0.5 * path.duration_s()).pose.alt_m));
    // Undoing and redoing everything restores the flight.
    const Flight last = editor.flight();
    while (editor.undo()) {
    }
    RC_ASSERT(editor.flight() == flight_of(kFlight));
    while (editor.redo()) {
    }
    // Edits that had been undone before are redone too.
    if (editor.flight() != last) {
      bool found = false;
      do {
        found = found || editor.flight() == last;
      } while (editor.undo());
      RC_ASSERT(found);
    }
  });
  EXPECT_GT(taken, 300);
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace vpe::explore
