// Tests of the window "File": what is opened, and what is made of the session.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/window/explore_window_fixture.h"
#include "vpe/app/command_job.h"
#include "vpe/core/image/image.h"

namespace vpe::window {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// What a fake job shall say, and what it was told.
struct FakeState {
  JobState state{true, -1, "begins", false};
  bool is_stopped = false;
};

class FakeJob : public Job {
 public:
  explicit FakeJob(std::shared_ptr<FakeState> fake) : fake_(std::move(fake)) {}
  JobState state() override { return fake_->state; }
  void stop() override { fake_->is_stopped = true; }

 private:
  std::shared_ptr<FakeState> fake_;
};

class FilesTest : public ExploreWindowTest {
 protected:
  void use_fake_jobs() {
    extra_.start_job = [this](const Words& words) {
      commands_.push_back(words);
      return std::make_unique<FakeJob>(fake_);
    };
  }
  void open_files() {
    control("o");
    settle();
    ASSERT_TRUE(window_->state().files);
  }
  // Iterates until the message of the window holds a text, for at most some minutes.
  void wait_for(const std::string& text) {
    for (int n = 0; n < 30'000 && window_->state().message.find(text) == std::string::npos; ++n) iterate(1);
    EXPECT_NE(window_->state().message.find(text), std::string::npos) << window_->state().message;
  }
  void control(const std::string& name) {
    robot_->key_down("Control_L");
    key(name);
    robot_->key_up("Control_L");
    iterate(3);
  }
  // Enters the name of a file.
  void enter(const std::string& file) {
    click("file/##open");
    control("a");
    glfwSetClipboardString(window_->display().handle(), file.c_str());
    control("v");
    key("Return");
    iterate(5);
  }

  std::vector<Words> commands_;
  std::shared_ptr<FakeState> fake_ = std::make_shared<FakeState>();
};

TEST_F(FilesTest, AnImageIsMadeWithProgressAndShown) {
  use_fake_jobs();
  extra_.planet_file = "/planets/p.vpe";
  open(1280, 720);
  open_files();
  click("file/Save image");
  ASSERT_EQ(commands_.size(), 1U);
  const Words& words = commands_.front();
  EXPECT_EQ(words[0], "render");
  EXPECT_EQ(words[1], "/planets/p.vpe");
  EXPECT_TRUE(words.back().ends_with(".png"));
  EXPECT_EQ(fs::path(words.back()).parent_path(), folder_.path());
  fake_->state = {true, 0.41, "drawing: 41 %", false};
  for (int n = 0; n < 60; ++n) iterate(1);
  EXPECT_EQ(window_->unfinished(), commands_);
  fake_->state = {false, 1, "", false};
  wait_for("image: " + words.back());
  EXPECT_TRUE(window_->unfinished().empty());
  click("file/x##job 0");
  EXPECT_TRUE(waits_for("file/x##job 0", false));
}

TEST_F(FilesTest, AFilmNeedsAFlightAndKeepsIt) {
  use_fake_jobs();
  open(1280, 720);
  open_files();
  click("file/Make film");
  EXPECT_TRUE(commands_.empty());
  key("Escape");
  EXPECT_FALSE(window_->state().files);
  ASSERT_EQ(window_->act({explore::ActionKind::kPlaceWaypoint}), "");
  window_->session().put({30, 10, 900'000, 0, -60, 0});
  ASSERT_EQ(window_->act({explore::ActionKind::kPlaceWaypoint}), "");
  open_files();
  click("file/Make film");
  ASSERT_EQ(commands_.size(), 1U);
  const Words& words = commands_.front();
  EXPECT_EQ(words[0], "fly");
  EXPECT_TRUE(words.back().ends_with(".mp4"));
  const scripts::ParsedFlight kept = read_flight_file(words[1]);
  ASSERT_TRUE(kept.flight.has_value());
  EXPECT_EQ(kept.flight->waypoints.size(), 2U);
  EXPECT_EQ(std::count(words.begin(), words.end(), "1280x720"), 1);
  iterate(5);
  click("file/Stop##job 0");
  EXPECT_TRUE(fake_->is_stopped);
  fake_->state = {false, 0.2, "interrupted", true};
  wait_for("film: stopped");
}

TEST_F(FilesTest, AFailureIsTold) {
  use_fake_jobs();
  open(1280, 720);
  open_files();
  click("file/Panorama from here");
  ASSERT_EQ(commands_.size(), 1U);
  EXPECT_EQ(commands_.front()[0], "panorama");
  fake_->state = {false, -1, "vpe: the disk is full", true};
  wait_for("the disk is full");
  EXPECT_TRUE(window_->state().message_is_error);
}

TEST_F(FilesTest, WithoutJobsNothingCanBeMade) {
  open(1280, 720);
  open_files();
  click("file/Save image");
  EXPECT_TRUE(window_->unfinished().empty());
  EXPECT_FALSE(window_->state().message_is_error);
}

TEST_F(FilesTest, FilesOfEveryKindAreOpened) {
  use_fake_jobs();
  std::string opened;
  extra_.open_planet = [this, &opened](const std::string& file) {
    opened = file;
    return planet_;
  };
  extra_.recent = {"/old/one.vpe", "/old/two.flight"};
  open(1280, 720);
  EXPECT_EQ(window_->recent(), (Words{"/old/one.vpe", "/old/two.flight"}));
  open_files();
  enter("/no/such.vpe");
  wait_for("there is no such file");
  EXPECT_TRUE(window_->state().message_is_error);
  const fs::path flight = folder_ / "a.flight";
  std::ofstream(flight) << "flight 1\nat 0 pose lon=10 lat=20 alt=500000 yaw=0 pitch=-60\n"
                        << "at 9 pose lon=12 lat=20 alt=500000 yaw=0 pitch=-60\n";
  enter(flight.string());
  wait_for("flight: ");
  ASSERT_NE(window_->session().flights().editor(), nullptr);
  EXPECT_EQ(window_->recent().front(), flight.string());
  const fs::path panorama = folder_ / "p.json";
  std::ofstream(panorama) << "{}\n";
  enter(panorama.string());
  for (int n = 0; n < 5'000 && commands_.empty(); ++n) iterate(1);
  ASSERT_EQ(commands_.size(), 1U);
  EXPECT_EQ(commands_.front(), (Words{"overlook", panorama.string()}));
  EXPECT_TRUE(window_->unfinished().empty());  // a window is nothing to be continued
  const fs::path other = folder_ / "other.vpe";
  std::ofstream(other) << "-";
  enter(other.string());
  for (int n = 0; n < 5'000 && window_->next_planet() == nullptr; ++n) iterate(1);
  EXPECT_EQ(window_->next_planet(), planet_);
  EXPECT_EQ(opened, other.string());
  EXPECT_EQ(window_->recent(),
            (Words{other.string(), panorama.string(), flight.string(), "/old/one.vpe", "/old/two.flight"}));
}

// A planet file is built of a raster by a command beside the window, and opened then.
TEST_F(FilesTest, ARasterIsBuiltWithProgressAndCanBeStopped) {
  use_fake_jobs();
  std::string opened;
  extra_.builds_first = [](const std::string& file) { return file.ends_with(".tif"); };
  extra_.open_planet = [this, &opened](const std::string& file) {
    opened = file;
    return planet_;
  };
  const fs::path raster = folder_ / "dem.tif";
  std::ofstream(raster) << "-";
  open(1280, 720);
  open_files();
  enter(raster.string());
  ASSERT_EQ(commands_, (std::vector<Words>{{"info", raster.string()}}));
  EXPECT_EQ(window_->unfinished(), commands_);
  iterate(5);
  click("file/Stop##job 0");
  EXPECT_TRUE(fake_->is_stopped);
  fake_->state = {false, 0.2, "interrupted", true};
  wait_for("dem.tif: stopped");
  EXPECT_EQ(opened, "");

  fake_->state = {true, 0.4, "building: 40 %", false};
  enter(raster.string());
  ASSERT_EQ(commands_.size(), 2U);
  fake_->state = {false, 0.4, "vpe: the disk is full", true};
  wait_for("the disk is full");
  EXPECT_EQ(opened, "");

  fake_->state = {true, 0.4, "building: 40 %", false};
  enter(raster.string());
  ASSERT_EQ(commands_.size(), 3U);
  fake_->state = {false, 1, "", false};
  for (int n = 0; n < 20'000 && window_->next_planet() == nullptr; ++n) iterate(1);
  EXPECT_EQ(window_->next_planet(), planet_);
  EXPECT_EQ(opened, raster.string());
  EXPECT_EQ(window_->recent().front(), raster.string());
}

TEST_F(FilesTest, PlanetsAreListed) {
  use_fake_jobs();
  extra_.builds_first = [](const std::string& file) { return file.empty(); };
  extra_.open_planet = [this](const std::string&) { return planet_; };
  std::ofstream(folder_ / "a.vpe") << "-";
  open(1280, 720);
  open_files();
  click("file/##Planets");
  iterate(3);
  click("file/##Planets=the embedded Mars");
  EXPECT_EQ(commands_, (std::vector<Words>{{"info"}}));
  click("file/##Planets");
  iterate(3);
  click("file/##Planets=a.vpe##0");
  for (int n = 0; n < 5'000 && window_->next_planet() == nullptr; ++n) iterate(1);
  EXPECT_EQ(window_->next_planet_file(), folder_ / "a.vpe");
  EXPECT_EQ(commands_.size(), 1U);
}

TEST_F(FilesTest, AProjectIsOpenedWithItsPlanet) {
  std::string opened = "-";
  extra_.open_planet = [this, &opened](const std::string& file) {
    opened = file;
    return planet_;
  };
  open(1280, 720);
  explore::Project project = window_->project();
  project.planet = "/planets/q.vpe";
  const fs::path file = folder_ / "w.vpeproj";
  explore::save_project(project, file);
  const fs::path bad = folder_ / "bad.vpeproj";
  std::ofstream(bad) << "format = 1\nunknown = 2\n";
  open_files();
  enter(bad.string());
  wait_for("unknown");
  EXPECT_TRUE(window_->state().message_is_error);
  enter(file.string());
  for (int n = 0; n < 5'000 && window_->next_planet() == nullptr; ++n) iterate(1);
  EXPECT_EQ(opened, "/planets/q.vpe");
  EXPECT_EQ(window_->next_project(), file);
}

TEST_F(FilesTest, PreferencesTakeEffectAndAreKept) {
  const fs::path file = folder_ / "config/explore.toml";
  extra_.preferences_file = file;
  open(1280, 720);
  const std::string budget = window_->session().settings().get("lod.frame_ms").value_or("");
  open_files();
  click("file/Preferences");
  iterate(3);
  click("preferences/##mouse.invert_wheel");
  iterate(3);
  EXPECT_TRUE(explore::read_preferences(file).invert_wheel);
  const double alt_m = window_->session().pose().alt_m;
  click("preferences/##draw.budget_ms");
  control("a");
  glfwSetClipboardString(window_->display().handle(), "70");
  control("v");
  key("Return");
  iterate(5);
  EXPECT_EQ(explore::read_preferences(file).draw_budget_ms, 70);
  EXPECT_EQ(window_->session().settings().get("lod.frame_ms"), budget == "40" ? "70" : budget);
  key("Escape");
  EXPECT_FALSE(window_->state().preferences);
  move(800, 300);
  robot_->wheel(1);
  settle();
  EXPECT_GT(window_->session().pose().alt_m, alt_m);  // forward is away now
  open_files();
  click("file/Preferences");
  iterate(3);
  click("preferences/As at first");
  iterate(3);
  EXPECT_EQ(explore::read_preferences(file), explore::Preferences{});
}

// The image that the program makes is the one on the screen.
TEST_F(FilesTest, ASavedImageIsThatOfTheView) {
  extra_.start_job = [](const Words& words) { return std::make_unique<app::CommandJob>(VPE_PROGRAM, words); };
  extra_.planet_file = planet_->path();
  open(1280, 720, core::Backend::kRay);
  window_->session().put({20, 30, 60'000, 30, -35, 0});
  settle();
  ASSERT_TRUE(window_->shows_final_image());
  open_files();
  click("file/Save image");
  wait_for("image: ");
  fs::path made;
  for (const auto& entry : fs::directory_iterator(folder_.path()))
    if (entry.path().extension() == ".png") made = entry.path();
  ASSERT_FALSE(made.empty());
  const core::RgbImage image = core::read_image(made.string());
  ASSERT_EQ(image.width, window_->image().width);
  ASSERT_EQ(image.height, window_->image().height);
  EXPECT_EQ(image.pixels, window_->image().pixels);
}

TEST_F(FilesTest, AStoppedCommandEndsSoon) {
  extra_.start_job = [](const Words& words) { return std::make_unique<app::CommandJob>(VPE_PROGRAM, words); };
  extra_.planet_file = planet_->path();
  open(1280, 720, core::Backend::kRay);
  ASSERT_EQ(window_->act({explore::ActionKind::kPlaceWaypoint}), "");
  window_->session().put({30, 10, 900'000, 0, -60, 0});
  ASSERT_EQ(window_->act({explore::ActionKind::kPlaceWaypoint}), "");
  ASSERT_EQ(window_->session().flights().editor()->scale_times(1000), "");
  open_files();
  click("file/Make film");
  for (int n = 0; n < 100; ++n) iterate(1);
  click("file/Stop##job 0");
  wait_for("film: stopped");
}

}  // namespace
}  // namespace vpe::window
