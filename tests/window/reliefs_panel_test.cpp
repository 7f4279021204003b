// Tests reliefs that are placed, dragged, changed and saved in the window, with the ground changing in the images.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <stdexcept>

#include "relief/files/relief_file.h"
#include "scripts/ground_tracks.h"
#include "tests/window/explore_window_fixture.h"
#include "vpe/explore/reliefs/relief_editor.h"

namespace vpe::window {
namespace {

namespace fs = std::filesystem;
using relief::ReliefSpec;

class ReliefsPanelTest : public ExploreWindowTest {
 protected:
  void open_above(const std::string& file = {}, double height_m = 600'000) {
    extra_.reliefs_file = file;
    extra_.scenes_on = app::scene_sight;
    open(960, 1200);
    window_->session().put({20, 10, height_m, 0, -90, 0});
    click("Ground");
    settle();
  }
  const explore::ReliefEditor& editor() { return window_->reliefs().editor(); }
  const ReliefSpec& named(const std::string& name) {
    for (const explore::SharedRelief& item : editor().items())
      if (item->relief.name == name) return item->relief;
    throw std::runtime_error("there is no relief " + name);
  }
  double ground_m(mars::LonLat place) { return window_->session().ground().height_m(mars::direction(place)); }
  // Returns where a place of the ground without reliefs is in the window.
  glm::dvec2 seen_bare(mars::LonLat place) {
    const glm::dvec3 up = mars::direction(place);
    const double radius_m = paging::Surface(planet_, 1 << 20).at(up).radius_m;
    return core::project(window_->session().view(), up * radius_m).xy + glm::dvec2(left(), 0);
  }
  void choose(const std::string& kind) {
    click("Kind");
    ASSERT_TRUE(waits_for("Kind=" + kind)) << kind;
    click("Kind=" + kind);
  }
  fs::path made(const std::string& extension) {
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      if (entry.path().string().ends_with(extension)) return entry.path();
    return {};
  }
};

TEST_F(ReliefsPanelTest, AReliefIsPlacedDraggedChangedAndUndone) {
  open_above();
  EXPECT_EQ(window_->drawn()->changed, nullptr);
  const mars::LonLat place = under(700, 300);
  const double before_m = ground_m(place);
  choose("pad");
  click("Place##relief");
  click(700, 300);
  ASSERT_EQ(editor().items().size(), 1U);
  EXPECT_LT(mars::distance_rad(named("Pad").place, place), 1e-9);
  EXPECT_EQ(window_->reliefs().selected(), editor().items()[0]->id);
  key("Escape");
  EXPECT_FALSE(window_->reliefs().is_placing());
  settle();
  // The image has the pad, and the session stands on its ground.
  ASSERT_NE(window_->drawn()->changed, nullptr);
  EXPECT_NEAR(ground_m(place), before_m + named("Pad").rise_m, 0.05 * named("Pad").rise_m);
  const mars::LonLat far_off{-160, -10};
  EXPECT_EQ(ground_m(far_off), paging::Surface(planet_, 1 << 20).at(mars::direction(far_off)).height_m);

  // A drag moves it over the ground without reliefs.
  const glm::dvec2 middle = seen(named("Pad").place);
  const glm::dvec2 foot = seen_bare(named("Pad").place);
  drag(middle + glm::dvec2(2, -2), {-120, 220});
  settle();
  EXPECT_NEAR(seen_bare(named("Pad").place).x, foot.x - 120, 1.5);
  EXPECT_NEAR(seen_bare(named("Pad").place).y, foot.y + 220, 1.5);
  const mars::LonLat moved = named("Pad").place;
  EXPECT_GT(mars::distance_rad(moved, place), 0.005);
  EXPECT_NEAR(ground_m(place), before_m, 1) << "the pad has gone";

  enter("relief/Rise (m)", "12000");
  EXPECT_EQ(named("Pad").rise_m, 12000);
  settle();
  EXPECT_NEAR(ground_m(moved) - paging::Surface(planet_, 1 << 20).at(mars::direction(moved)).height_m, 12000,
              500);
  with_control("z");
  EXPECT_EQ(window_->state().message, "undone: change the rise of 'Pad'");
  with_control("z");
  settle();
  EXPECT_LT(mars::distance_rad(named("Pad").place, place), 1e-9);
  EXPECT_GT(ground_m(place), before_m + 1);
  with_control("z");
  settle();
  EXPECT_TRUE(editor().items().empty());
  EXPECT_EQ(window_->drawn()->changed, nullptr);
  EXPECT_EQ(ground_m(place), before_m);
  with_control("z", true);
  EXPECT_EQ(editor().items().size(), 1U);
  key("Delete");
  EXPECT_TRUE(editor().items().empty());
}

TEST_F(ReliefsPanelTest, ASliderIsOneStep) {
  open_above();
  click("Place##relief");
  click(700, 300);
  key("Escape");
  const double radius_m = *named("Crater").radius_m;
  const WidgetPlace slider = place_of("relief/Radius (m)");
  drag({slider.x0 + 0.5 * (slider.x1 - slider.x0) * 0.5, (slider.y0 + slider.y1) / 2}, {12, 0});
  EXPECT_NE(*named("Crater").radius_m, radius_m);
  EXPECT_EQ(editor().undo_text(), "change the radius of 'Crater'");
  with_control("z");
  EXPECT_EQ(*named("Crater").radius_m, radius_m);
  // A size that follows from the others is typed, and given back.
  EXPECT_FALSE(named("Crater").depth_m);
  enter("relief/Depth (m)", "1500");
  EXPECT_EQ(named("Crater").depth_m, 1500);
  click("relief/x##Depth (m)");
  EXPECT_FALSE(named("Crater").depth_m);
  enter("relief/Depth (m)", "deep");
  EXPECT_NE(window_->state().message.find("depth_m: expected"), std::string::npos) << window_->state().message;
  EXPECT_FALSE(named("Crater").depth_m);
}

TEST_F(ReliefsPanelTest, ReliefsAreSavedOpenedAndKept) {
  open_above();
  click("Place##relief");
  click(700, 300);
  click(600, 500);
  key("Escape");
  settle();
  ASSERT_EQ(editor().items().size(), 2U);
  enter("##relief file", "works");
  click("Save##reliefs");
  settle();
  EXPECT_EQ(window_->state().message, "reliefs: " + (folder_ / "works.relief.toml").string());
  const std::vector<ReliefSpec> saved = relief::read_relief_file(folder_ / "works.relief.toml");
  EXPECT_TRUE(saved == editor().reliefs());
  EXPECT_EQ(window_->reliefs_message(), "");
  // A flight in which they form.
  click("Save as a flight");
  settle();
  const fs::path flight = made(".flight");
  ASSERT_FALSE(flight.empty()) << window_->state().message;
  const auto bytes = base::read_file(flight, 100'000);
  const scripts::ParsedFlight parsed = scripts::parse_flight(
      std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), "flight");
  ASSERT_TRUE(parsed.flight);
  EXPECT_EQ(scripts::GroundTracks(*parsed.flight, planet_->radius_m()).at(5).reliefs.size(), 2U);
  // Close, and open again.
  click("Close##reliefs");
  settle();
  EXPECT_TRUE(editor().items().empty());
  EXPECT_EQ(window_->drawn()->changed, nullptr);
  enter("##relief file", (folder_ / "works.relief.toml").string());
  click("Open##reliefs");
  settle();
  EXPECT_EQ(editor().items().size(), 2U);
  // Unsaved changes outlive the window.
  key("Delete");
  click("Open##reliefs");
  EXPECT_NE(window_->state().message.find("have unsaved changes"), std::string::npos)
      << window_->state().message;
  const std::string message = window_->reliefs_message();
  EXPECT_NE(message.find("the reliefs were not saved; a copy is in "), std::string::npos) << message;
  window_.reset();
  open_above((folder_ / "works.relief.toml").string());
  EXPECT_EQ(editor().items().size(), 2U);
  EXPECT_FALSE(editor().is_changed());
  EXPECT_NE(window_->drawn()->changed, nullptr);
}

TEST_F(ReliefsPanelTest, APlanetIsMadeOfThem) {
  std::vector<std::string> words;
  struct Done : Job {
    JobState state() override { return {}; }
    void stop() override {}
  };
  extra_.start_job = [&words](const std::vector<std::string>& command) {
    words = command;
    return std::make_unique<Done>();
  };
  open_above();
  click("Place##relief");
  click(700, 300);
  key("Escape");
  click("Put into a planet");
  settle();
  ASSERT_EQ(words.size(), 5U) << window_->state().message;
  EXPECT_EQ(words[0], "patch");
  EXPECT_EQ(words[1], planet_->path());
  EXPECT_TRUE(relief::read_relief_file(words[2]) == editor().reliefs());
  EXPECT_EQ(words[3], "-o");
  EXPECT_FALSE(editor().is_changed());
}

TEST_F(ReliefsPanelTest, AFlightChangesTheGroundOfTheSession) {
  const scripts::ParsedFlight parsed = scripts::parse_flight(
      "flight 1.3\nat 0 pose lon=20 lat=10 alt=400000 pitch=-90\n"
      "at 0 relief hill kind=pad lon=20 lat=10 radius=60000 falloff=30000 rise=0\n"
      "at 10 relief hill rise=20000\nat 10 end\n",
      "F");
  ASSERT_TRUE(parsed.flight) << scripts::to_string(parsed.errors.at(0));
  extra_.flight = *parsed.flight;
  open(960, 540);
  const double before_m = ground_m({20, 10});
  window_->session().scrub(10);
  settle();
  EXPECT_NEAR(ground_m({20, 10}), before_m + 20000, 200);
  EXPECT_TRUE(window_->is_at_rest());
  window_->session().scrub(5);
  settle();
  const double middle_m = ground_m({20, 10});
  EXPECT_GT(middle_m, before_m + 2000);
  EXPECT_LT(middle_m, before_m + 18000);
  window_->session().leave_flight();
  window_->session().put({20, 10, 400'000, 0, -90, 0});
  settle();
  EXPECT_EQ(ground_m({20, 10}), before_m);
}

}  // namespace
}  // namespace vpe::window
