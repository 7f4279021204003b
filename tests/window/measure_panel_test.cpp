// Tests of the measuring panel without a window: Dear ImGui needs no OpenGL until a frame is shown.
#include "vpe/window/panels/measure_panel.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "tests/explore/terrain_fixture.h"
#include "vpe/explore/measure/profile_plot.h"
#include "vpe/explore/results/ground_along.h"
#include "vpe/window/panels/profile_plot_view.h"

namespace vpe::window {
namespace {

const mars::LonLat kWest{-35.15, 20};
const mars::LonLat kEast{-34.85, 20};  // the ridge is between them

class MeasurePanelTest : public test_support::GroundTest<test_support::RidgeGround> {
 protected:
  void SetUp() override {
    shared_ = std::shared_ptr<const paging::Surface>(&surface(), [](const paging::Surface*) {});
    session_ = std::make_unique<explore::Session>(shared_, explore::SessionOptions{});
    session_->resize(800, 600);
    panel_ = std::make_unique<MeasurePanel>(shared_, [this] { ++notified_; });
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {1040, 2000};
    // Logs end in the clipboard, too.
    io.ClipboardUserData = this;
    io.SetClipboardTextFn = [](void* to, const char* text) {
      auto& test = *static_cast<MeasurePanelTest*>(to);
      (std::string(text).starts_with("A: ") ? test.copied_ : test.logged_) = text;
    };
    unsigned char* pixels = nullptr;
    int width = 0;
    int height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
#if IMGUI_VERSION_NUM < 18700
    io.KeyMap[ImGuiKey_Enter] = 1;
#endif
    frame();
    frame();
  }
  void TearDown() override {
    panel_.reset();
    ImGui::DestroyContext();
  }

  // Draws a frame and returns all text of the panel.
  const std::string& frame(std::optional<mars::LonLat> under_cursor = {}) {
    ImGui::GetIO().DeltaTime = 0.02F;
    ImGui::NewFrame();
    widgets_.begin_frame();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({330, 1990});
    ImGui::Begin("side", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::LogToClipboard();
    MeasureActions actions = panel_->draw(*session_, under_cursor, widgets_);
    ImGui::LogFinish();
    ImGui::End();
    const std::string panel_text = logged_;
    logged_.clear();
    ImGui::SetNextWindowPos({400, 0});
    ImGui::SetNextWindowSize({600, static_cast<float>(MeasurePanel::kStrip_px)});
    ImGui::Begin("profile strip", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::LogToClipboard();
    if (const MeasureActions saved = panel_->draw_profile(widgets_); !saved.message.empty()) actions = saved;
    ImGui::LogFinish();
    ImGui::End();
    logged_ = panel_text + logged_;
    if (actions.go_to || actions.undoes || !actions.message.empty()) actions_ = actions;
    ImGui::Render();
    return logged_;
  }
  // Returns the text with the mouse elsewhere: a tooltip would end the log.
  const std::string& text() {
    move(-1, -1);
    return logged_;
  }
  void settle() {
    for (int n = 0; n < 5000 && !panel_->is_at_rest(); ++n) {
      frame();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ASSERT_TRUE(panel_->is_at_rest());
    frame();
  }
  WidgetPlace place_of(const std::string& label) const {
    const auto found = widgets_.places().find(label);
    EXPECT_NE(found, widgets_.places().end()) << "no widget is called " << label;
    return found == widgets_.places().end() ? WidgetPlace{} : found->second;
  }
  void move(double x, double y) {
    ImGui::GetIO().MousePos = {static_cast<float>(x), static_cast<float>(y)};
    frame();
    frame();
  }
  void click(const std::string& label) {
    const WidgetPlace p = place_of(label);
    move(p.x0 + 0.3 * (p.x1 - p.x0), (p.y0 + p.y1) / 2);
    ImGui::GetIO().MouseDown[0] = true;
    frame();
    ImGui::GetIO().MouseDown[0] = false;
    frame();
    frame();
  }
  void type(const std::string& label, const std::string& typed) {
    click(label);
    ImGui::GetIO().AddInputCharactersUTF8(typed.c_str());
    frame();
    enter(true);
    frame();
    enter(false);
    frame();
  }
  static void enter(bool down) {
#if IMGUI_VERSION_NUM < 18700
    ImGui::GetIO().KeysDown[1] = down;
#else
    ImGui::GetIO().AddKeyEvent(ImGuiKey_Enter, down);
#endif
  }
  void add_both() {
    panel_->add(kWest);
    panel_->add(kEast);
    settle();
    ASSERT_NE(panel_->measured(), nullptr);
  }

  std::shared_ptr<const paging::Surface> shared_;
  std::unique_ptr<explore::Session> session_;
  std::atomic<int> notified_{0};
  std::unique_ptr<MeasurePanel> panel_;
  Widgets widgets_;
  MeasureActions actions_;
  std::string logged_;
  std::string copied_;
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

std::string read(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

TEST_F(MeasurePanelTest, ThePlaceUnderTheCursorIsReadOutAndStays) {
  session_->put({145, -20, 20000, 0, -90, 0});
  EXPECT_TRUE(has(text(), "Point at the ground"));
  const std::string there = frame(kEast);
  for (const explore::ReadOutLine& line : explore::read_out_lines(explore::read_out_at(surface(), kEast)))
    EXPECT_TRUE(has(there, line.text)) << line.text << " in\n" << there;
  EXPECT_FALSE(has(there, "Range")) << there;  // the camera is on the other side
  EXPECT_TRUE(has(frame(), "-34.85000"));
  session_->put({-34.85, 20, 20000, 0, -90, 0});
  EXPECT_TRUE(has(frame(kEast), "Range"));
}

TEST_F(MeasurePanelTest, ATypedPlaceIsEchoedAndFlownTo) {
  type("##place", "4.5895 S 222.5583 W");
  EXPECT_TRUE(has(text(), "137.441700\u00b0 E, 4.589500\u00b0 S")) << logged_;
  click("Go there");
  ASSERT_TRUE(actions_.go_to.has_value());
  EXPECT_NEAR(actions_.go_to->lon_deg, 137.4417, 1e-9);
  EXPECT_NEAR(actions_.go_to->lat_deg, -4.5895, 1e-9);
  click("Add as a point");
  ASSERT_EQ(panel_->points().size(), 1U);
  EXPECT_NEAR(panel_->points()[0].lon_deg, 137.4417, 1e-9);
}

TEST_F(MeasurePanelTest, AWrongPlaceIsExplainedAndNotFlownTo) {
  type("##place", "somewhere");
  EXPECT_TRUE(has(text(), "expected")) << logged_;
  click("Go there");
  EXPECT_FALSE(actions_.go_to.has_value());
}

TEST_F(MeasurePanelTest, TwoPointsAreMeasured) {
  add_both();
  const Measured& m = *panel_->measured();
  ASSERT_NE(m.profile, nullptr);
  EXPECT_EQ(explore::to_csv(*m.profile),
            explore::to_csv(explore::make_profile(surface(), std::vector<mars::LonLat>{kWest, kEast})));
  ASSERT_TRUE(m.sight.has_value());
  EXPECT_FALSE(m.sight->visible);
  EXPECT_GE(notified_, 1);
  const std::string all = text();
  EXPECT_TRUE(has(all, explore::measured_length_text(m.profile->ground_length_m)));
  EXPECT_TRUE(has(all, "A and B do not see each other"));
  EXPECT_TRUE(has(all, "B at " + explore::measured_length_text(m.sight->needed_height_m) + " above ground"));
}

TEST_F(MeasurePanelTest, FromHighEnoughTheySeeEachOther) {
  add_both();
  const std::shared_ptr<const explore::Profile> profile = panel_->measured()->profile;
  const double needed_m = panel_->measured()->sight->needed_height_m;
  type("B (m)##to", std::to_string(std::ceil(needed_m)));
  settle();
  ASSERT_NE(panel_->measured(), nullptr);
  EXPECT_EQ(panel_->measured()->request.to_height_m, std::ceil(needed_m));
  EXPECT_TRUE(panel_->measured()->sight->visible);
  EXPECT_EQ(panel_->measured()->profile, profile);  // not made again
  EXPECT_TRUE(has(text(), "A and B see each other")) << logged_;
}

// Opens scenes with a tower on each line of sight: 100 m and as many metres as the time has seconds after its beginning.
explore::OpenScene towers(std::atomic<int>& opened) {
  return [&opened](const explore::SightScene& scene) {
    ++opened;
    if (scene.file == "broken") throw std::runtime_error("broken: line 3");
    const double at_m = 100 + scene.time_s;
    const explore::FirstObject tower = [at_m](const glm::dvec3&, const glm::dvec3&, double until_m) {
      return at_m < until_m ? std::optional(explore::SightObject{at_m, "Tower"}) : std::nullopt;
    };
    return explore::SceneSight{tower, true};
  };
}

TEST_F(MeasurePanelTest, ObjectsOfTheSceneObstruct) {
  std::atomic<int> opened{0};
  panel_ = std::make_unique<MeasurePanel>(
      shared_, [this] { ++notified_; }, towers(opened));
  add_both();
  const std::shared_ptr<const explore::Profile> profile = panel_->measured()->profile;
  ASSERT_TRUE(panel_->measured()->sight->obstruction);
  EXPECT_EQ(panel_->measured()->sight->obstruction->object, "");
  EXPECT_FALSE(has(text(), "Obstructed by")) << logged_;
  EXPECT_EQ(opened, 0);
  // Until it is measured again, what was measured before stays.
  panel_->set_scene({"a"});
  ASSERT_NE(panel_->measured(), nullptr);
  settle();
  const auto expect_tower_at = [&](double distance_m) {
    const explore::LineOfSight& sight = *panel_->measured()->sight;
    ASSERT_TRUE(sight.obstruction);
    EXPECT_EQ(sight.obstruction->object, "Tower");
    EXPECT_NEAR(sight.obstruction->distance_m, distance_m, 0.01);
  };
  expect_tower_at(100);
  EXPECT_EQ(panel_->measured()->profile, profile);  // not made again
  EXPECT_TRUE(has(text(), "A and B do not see each other")) << logged_;
  EXPECT_TRUE(has(text(), "Obstructed by")) << logged_;
  EXPECT_TRUE(has(text(), "Tower")) << logged_;
  EXPECT_TRUE(has(text(), "100 m from A")) << logged_;
  EXPECT_TRUE(has(text(), "above ground, without objects")) << logged_;
  EXPECT_EQ(opened, 1);
  panel_->set_scene({"a"});
  EXPECT_TRUE(panel_->is_at_rest());
  // Scenes that follow quickly: the last one counts.
  for (int n = 1; n <= 50; ++n) {
    panel_->set_scene({"a", 0, 1.0 * n});
    frame();
  }
  settle();
  expect_tower_at(150);
  EXPECT_EQ(panel_->measured()->request.scene.time_s, 50);
  panel_->set_scene({});
  settle();
  EXPECT_EQ(panel_->measured()->sight->obstruction->object, "");
  EXPECT_FALSE(has(text(), "without objects")) << logged_;
}

TEST_F(MeasurePanelTest, ASceneThatCannotBeReadIsExplained) {
  std::atomic<int> opened{0};
  panel_ = std::make_unique<MeasurePanel>(
      shared_, [this] { ++notified_; }, towers(opened));
  panel_->set_scene({"broken"});
  add_both();
  EXPECT_FALSE(panel_->measured()->sight);
  EXPECT_NE(panel_->measured()->profile, nullptr);
  EXPECT_TRUE(has(text(), "broken: line 3")) << logged_;
  EXPECT_EQ(opened, 1);
  panel_->set_scene({"a", 1});
  settle();
  ASSERT_TRUE(panel_->measured()->sight);
  EXPECT_EQ(panel_->measured()->sight->obstruction->object, "Tower");
  // Another surface, and objects no more.
  panel_->set_surface(shared_);
  settle();
  ASSERT_NE(panel_->measured(), nullptr);
  EXPECT_EQ(panel_->measured()->sight->obstruction->object, "");
}

TEST_F(MeasurePanelTest, ValuesShownAreThoseOfThePresentPoints) {
  panel_->add(kWest);
  panel_->add(kEast);
  frame();
  panel_->add({-34.9, 20.1});  // while the first two may be being measured
  settle();
  ASSERT_EQ(panel_->measured()->request.places.size(), 3U);
  click("x##B");
  EXPECT_EQ(panel_->points().size(), 2U);
  settle();
  ASSERT_NE(panel_->measured(), nullptr);
  EXPECT_EQ(panel_->measured()->request.places.back().lat_deg, 20.1);
  click("Clear");
  EXPECT_TRUE(panel_->points().empty());
  EXPECT_EQ(panel_->measured(), nullptr);
  panel_->add({std::nan(""), 0});
  panel_->add({0, 91});
  EXPECT_TRUE(panel_->points().empty());
  EXPECT_TRUE(panel_->is_at_rest());
}

// Results of a request that is replaced while it is being measured are never shown.
TEST_F(MeasurePanelTest, ResultsOfFormerPointsAreDropped) {
  for (int n = 0; n < 20; ++n) {
    panel_->add({-100.0 - n, 0});
    panel_->add({50, 10});
    std::this_thread::sleep_for(std::chrono::microseconds(500));  // it is usually being measured by now
    panel_->add({60, 20});
    while (!panel_->is_at_rest()) {
      frame();
      const Measured* shown = panel_->measured();
      ASSERT_EQ(shown == nullptr ? 3U : shown->request.places.size(), 3U);
    }
    frame();
    ASSERT_NE(panel_->measured(), nullptr);
    panel_->clear();
  }
}

TEST_F(MeasurePanelTest, FailedMeasurementsAreExplained) {
  panel_->add({10, 0});
  panel_->add({-170, 0});
  settle();
  ASSERT_NE(panel_->measured(), nullptr);
  EXPECT_EQ(panel_->measured()->profile, nullptr);
  EXPECT_TRUE(has(text(), "opposite sides")) << logged_;
  // The panel keeps working.
  panel_->clear();
  add_both();
  EXPECT_NE(panel_->measured()->profile, nullptr);
}

TEST_F(MeasurePanelTest, OnePlaceTwiceIsAPathWithoutLength) {
  panel_->add(kWest);
  panel_->add(kWest);
  settle();
  ASSERT_NE(panel_->measured(), nullptr);
  ASSERT_NE(panel_->measured()->profile, nullptr);
  EXPECT_EQ(panel_->measured()->profile->length_m, 0);
  const WidgetPlace plot = place_of("profile plot");
  move((plot.x0 + plot.x1) / 2, (plot.y0 + plot.y1) / 2);
  EXPECT_FALSE(panel_->marked().has_value());
}

TEST_F(MeasurePanelTest, TheCursorOnThePlotMarksThePlace) {
  add_both();
  EXPECT_FALSE(panel_->marked().has_value());
  const WidgetPlace plot = place_of("profile plot");
  move(plot.x1 - 1, (plot.y0 + plot.y1) / 2);
  ASSERT_TRUE(panel_->marked().has_value());
  EXPECT_LT(mars::distance_rad(*panel_->marked(), kEast) * mars::kMarsRadius_m, 400);
  // Its figures are those of a point of the profile.
  const paging::ProfilePoint& last = panel_->measured()->profile->points.back();
  EXPECT_TRUE(has(frame(), explore::measured_length_text(last.distance_m) + ": ")) << logged_;
  move(plot.x1 - 1, plot.y1 + 900);
  EXPECT_FALSE(panel_->marked().has_value());
  // Gone too when the panel is not drawn any longer.
  move(plot.x1 - 1, (plot.y0 + plot.y1) / 2);
  ASSERT_TRUE(panel_->marked().has_value());
  for (int n = 0; n < 2; ++n) {
    ImGui::NewFrame();
    ImGui::Render();
  }
  EXPECT_FALSE(panel_->marked().has_value());
}

TEST_F(MeasurePanelTest, TheProfileIsSavedWholeOrNotAtAll) {
  add_both();
  const test_support::TempDir folder;
  type("##file", (folder / "p.csv").string());
  click("Save##profile");
  ASSERT_FALSE(actions_.message.empty());
  EXPECT_FALSE(actions_.message_is_error) << actions_.message;
  std::ifstream file(folder / "p.csv");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), explore::to_csv(*panel_->measured()->profile));
  click("Save##profile");
  EXPECT_TRUE(has(actions_.message, "replaced")) << actions_.message;
  std::filesystem::remove_all(folder.path());
  click("Save##profile");
  EXPECT_TRUE(actions_.message_is_error);
  EXPECT_TRUE(has(actions_.message, (folder / "p.csv").string())) << actions_.message;
}

TEST_F(MeasurePanelTest, TheGroundOfThePathIsNamed) {
  add_both();
  const std::string all = text();
  for (const explore::ReadOutLine& line :
       explore::ground_lines(panel_->measured()->ground, surface().planet().meta()))
    EXPECT_TRUE(has(all, line.text)) << line.label << " " << line.text << " in\n" << all;
  for (const char* label : {"Datum", "Posts", "Error", "Nodata", "Synthetic"})
    EXPECT_TRUE(has(all, label)) << label;
}

TEST_F(MeasurePanelTest, ResultsAreSavedAsFeaturesAndCopied) {
  add_both();
  const test_support::TempDir folder;
  for (const char* name : {"p.geojson", "p.gpkg"}) {
    type("##file", (folder / name).string());
    click("Save##profile");
    EXPECT_FALSE(actions_.message_is_error) << actions_.message;
  }
  const std::size_t points = panel_->measured()->profile->points.size();
  EXPECT_EQ(count_of(read(folder / "p.geojson"), "\"part\": \"point\""), points);
  EXPECT_EQ(count_of(read(folder / "p.geojson"), "\"part\": \"path\""), 1U);
  EXPECT_TRUE(read(folder / "p.gpkg").starts_with("SQLite format 3"));
  type("##file", (folder / "p.shp").string());
  click("Save##profile");
  EXPECT_TRUE(actions_.message_is_error);
  EXPECT_TRUE(has(actions_.message, ".gpkg")) << actions_.message;
  click("Copy##profile");
  for (const char* part : {"A: -35.15000, 20.00000", "Great circle: ", "Line of sight: A and B do not",
                           "Datum: ", "Synthetic: 0 %"})
    EXPECT_TRUE(has(copied_, part)) << part << " in\n" << copied_;
}

TEST_F(MeasurePanelTest, WhatIsUndoneIsMeasuredAgain) {
  explore::UndoHistory history;
  history.join(panel_->path());
  add_both();
  panel_->add({-34.9, 20.1});
  settle();
  EXPECT_EQ(panel_->measured()->request.places.size(), 3U);
  EXPECT_EQ(history.undo(), "measure point C");
  EXPECT_FALSE(panel_->is_at_rest());
  settle();
  ASSERT_NE(panel_->measured(), nullptr);
  EXPECT_EQ(panel_->measured()->request.places.size(), 2U);
  EXPECT_EQ(history.redo(), "measure point C");
  settle();
  EXPECT_EQ(panel_->measured()->request.places.size(), 3U);
  panel_->begin_at(kEast);
  EXPECT_EQ(panel_->points().size(), 1U);
  panel_->go_on_to(kWest, {0, 0});
  EXPECT_EQ(panel_->points().size(), 2U);
  settle();
  click("Undo##measure");
  EXPECT_TRUE(actions_.undoes);
}

TEST_F(MeasurePanelTest, ThePanelMayBeDestroyedWhileItMeasures) {
  for (int n = 0; n < 5; ++n) {
    panel_->add({-100.0 + n, 0});
    panel_->add({70, 10.0 * n});
    panel_ = std::make_unique<MeasurePanel>(shared_, [] {});
  }
  EXPECT_TRUE(panel_->is_at_rest());
}

constexpr ImU32 kMark = IM_COL32(255, 214, 90, 255);

// Counts vertices of the marks' full colour within some pixels of a place.
int vertices_at(const ImDrawList& list, const explore::Session& session, mars::LonLat place, double x0,
                double y0, double within_px) {
  const glm::dvec3 d = mars::direction(place);
  const core::Projected p =
      core::project(session.view(), d * (session.ground().radius_m + session.ground().height_m(d)));
  int count = 0;
  for (const ImDrawVert& v : list.VtxBuffer) {
    const glm::dvec2 at{static_cast<double>(v.pos.x) - x0, static_cast<double>(v.pos.y) - y0};
    count += v.col == kMark && glm::length(at - p.xy) < within_px ? 1 : 0;
  }
  return count;
}

TEST_F(MeasurePanelTest, MarksStandAtTheirPlacesAndHiddenOnesAreFaint) {
  const auto draw = [&](const mars::Pose& pose) {
    session_->put(pose);
    ImGui::NewFrame();
    auto list = std::make_unique<ImDrawList>(ImGui::GetDrawListSharedData());
    list->_ResetForNewFrame();
    list->PushClipRectFullScreen();
    list->PushTextureID(ImGui::GetIO().Fonts->TexID);
    panel_->draw_marks(*list, *session_, {session_->view(), 100, 50});
    ImGui::Render();
    return list;
  };
  add_both();
  // From above: both points and the line between them.
  const auto above = draw({-35, 20, 40000, 0, -90, 0});
  for (const double lon_deg : {-35.15, -35.1, -35.0, -34.9, -34.85})
    EXPECT_GT(vertices_at(*above, *session_, {lon_deg, 20}, 100, 50, 6), 0) << lon_deg;
  EXPECT_EQ(vertices_at(*above, *session_, {-35.1, 20.02}, 100, 50, 6), 0);
  // From the south-west, low: the ridge hides what is behind it, and the line ends at its top.
  const auto low = draw({-35.2, 19.9, 300, 50, 0, 0});
  EXPECT_GT(vertices_at(*low, *session_, {-35.15, 20}, 100, 50, 6), 0);
  EXPECT_GT(vertices_at(*low, *session_, {-35.02, 20}, 100, 50, 10), 0);
  for (const double lon_deg : {-34.95, -34.9, -34.85})
    EXPECT_EQ(vertices_at(*low, *session_, {lon_deg, 20}, 100, 50, 6), 0) << lon_deg;
  // From the other side of the planet: nothing in full colour.
  const auto far = draw({145, -20, 5e6, 0, -90, 0});
  for (const ImDrawVert& v : far->VtxBuffer) EXPECT_NE(v.col, kMark);
}

}  // namespace
}  // namespace vpe::window
