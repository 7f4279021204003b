// Lines of sight among objects of scene files.
#include "vpe/app/scene/scene_sight.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "objects/sticks/build_sticks.h"
#include "objects/sticks/stick_file.h"
#include "tests/explore/terrain_fixture.h"
#include "vpe/base/file.h"

namespace {

using vpe::explore::LineOfSight;
using vpe::explore::OpenScene;
using vpe::explore::SceneSight;
using vpe::explore::SightPoint;
using vpe::explore::SightScene;

// A tower 20 m wide and high, and another one that drives. The ridge begins 4 km east of them.
constexpr const char* kTower = R"(version = 1
[[model]]
name = "box"
file = "box.sticks"
[[object]]
model = "box"
name = "Tower"
lon = -35.15
lat = 20
scale = 10
)";
constexpr const char* kDriver = R"([[path]]
model = "box"
name = "Driver"
scale = 10
points = [[0, -35.2, 20.02], [100, -35.1, 20.02]]
)";
const mars::LonLat kTowerPlace{-35.15, 20};

class SceneSightTest : public test_support::GroundTest<test_support::RidgeGround> {
 protected:
  SceneSightTest() {
    objects::VoxelGrid voxels({4, 4, 4, 0.5F, {-1, -1, 0}});
    for (int x = 0; x < 4; ++x)
      for (int y = 0; y < 4; ++y)
        for (int z = 0; z < 4; ++z) voxels.set(x, y, z);
    objects::write_stick_file(folder_ / "box.sticks", objects::build_sticks(std::move(voxels)));
    write(kTower);
  }

  std::string file() const { return (folder_ / "a.scene.toml").string(); }
  void write(const std::string& text) const { vpe::base::write_file(folder_ / "a.scene.toml", text); }
  LineOfSight sight(const SightPoint& from, const SightPoint& to, const SightScene& scene) {
    return line_of_sight(surface(), from, to, open_(scene).first_object);
  }
  // Returns what hides the second point, "ground" or "".
  std::string hidden_by(const SightPoint& from, const SightPoint& to, const SightScene& scene) {
    const LineOfSight measured = sight(from, to, scene);
    if (!measured.obstruction) return "";
    return measured.obstruction->object.empty() ? "ground" : measured.obstruction->object;
  }

  test_support::TempDir folder_;
  OpenScene open_ = vpe::app::scene_sight({&surface(), [](const paging::Surface*) {}});
  const SightPoint west_{{-35.17, 20}, 10};
  const SightPoint east_{{-35.13, 20}, 10};
};

TEST_F(SceneSightTest, AnObjectHidesAtItsNearSide) {
  const SceneSight opened = open_({file()});
  EXPECT_FALSE(opened.moves);
  const LineOfSight measured = line_of_sight(surface(), west_, east_, opened.first_object);
  EXPECT_FALSE(measured.visible);
  ASSERT_TRUE(measured.obstruction);
  EXPECT_EQ(measured.obstruction->object, "Tower");
  const double middle_m = mars::distance_rad(west_.place, kTowerPlace) * (mars::kMarsRadius_m + 10);
  EXPECT_NEAR(measured.obstruction->distance_m, middle_m - 10, 0.05);
  EXPECT_TRUE(line_of_sight(surface(), west_, east_).visible);
  // Over its top.
  EXPECT_EQ(hidden_by({west_.place, 25}, {east_.place, 25}, {file()}), "");
  // Beside it.
  EXPECT_EQ(hidden_by({{-35.17, 20.001}, 10}, {{-35.13, 20.001}, 10}, {file()}), "");
  // Straight down through it.
  EXPECT_EQ(hidden_by({kTowerPlace, 100}, {kTowerPlace, 0}, {file()}), "Tower");
  EXPECT_NEAR(sight({kTowerPlace, 100}, {kTowerPlace, 0}, {file()}).obstruction->distance_m, 80, 1e-3);
}

TEST_F(SceneSightTest, WhatIsFirstOnTheLineHides) {
  const SightPoint beyond{{-34.85, 20}, 10};  // the ridge
  EXPECT_EQ(hidden_by(west_, beyond, {file()}), "Tower");
  EXPECT_EQ(hidden_by(beyond, west_, {file()}), "ground");
}

TEST_F(SceneSightTest, EndsMayStandOnObjects) {
  const SightPoint high{{-35.13, 20}, 120};
  EXPECT_EQ(hidden_by({kTowerPlace, 20}, high, {file()}), "");
  EXPECT_EQ(hidden_by(high, {kTowerPlace, 20}, {file()}), "");
  EXPECT_EQ(hidden_by({kTowerPlace, 19.9}, high, {file()}), "Tower");
  EXPECT_EQ(hidden_by(high, {kTowerPlace, 19.9}, {file()}), "Tower");
}

TEST_F(SceneSightTest, PathsHideAtTheirTimes) {
  write(std::string(kTower) + kDriver);
  EXPECT_TRUE(open_({file()}).moves);
  const SightPoint from{{-35.17, 20.02}, 10};
  const SightPoint to{{-35.13, 20.02}, 10};
  EXPECT_EQ(hidden_by(from, to, {file(), 0, 0}), "");
  EXPECT_EQ(hidden_by(from, to, {file(), 0, 50}), "Driver");
  EXPECT_EQ(hidden_by(from, to, {file(), 0, 100}), "");
  EXPECT_EQ(hidden_by(west_, east_, {file(), 0, 50}), "Tower");
}

TEST_F(SceneSightTest, FlightsMoveAndHideObjects) {
  using vpe::core::ObjectTrack;
  const auto tracks = [](const ObjectTrack& track) {
    return std::make_shared<const std::vector<ObjectTrack>>(std::vector<ObjectTrack>{track});
  };
  const SightPoint from{{-35.17, 20.02}, 10};
  const SightPoint to{{-35.13, 20.02}, 10};
  const auto away = tracks({"Tower", {{0, {-35.15, 20}}, {10, {-35.15, 20.02}}}, {}});
  EXPECT_TRUE(open_({file(), 0, 0, away}).moves);
  EXPECT_EQ(hidden_by(west_, east_, {file(), 0, 0, away}), "Tower");
  EXPECT_EQ(hidden_by(west_, east_, {file(), 0, 10, away}), "");
  EXPECT_EQ(hidden_by(from, to, {file(), 0, 10, away}), "Tower");
  const auto gone = tracks({"Tower", {}, {{5, false}}});
  EXPECT_EQ(hidden_by(west_, east_, {file(), 0, 4, gone}), "Tower");
  EXPECT_EQ(hidden_by(west_, east_, {file(), 0, 5, gone}), "");
  // It stands where the file has it without a flight.
  EXPECT_EQ(hidden_by(west_, east_, {file()}), "Tower");
}

TEST_F(SceneSightTest, ChangedFilesAreReadAgainAndNamelessObjectsHaveTheNameOfTheirModel) {
  EXPECT_EQ(hidden_by(west_, east_, {file()}), "Tower");
  std::string text = kTower;
  text.erase(text.find("name = \"Tower\"\n"), std::string("name = \"Tower\"\n").size());
  write(text);
  EXPECT_EQ(hidden_by(west_, east_, {file(), 1}), "box");
  // What was opened stays as it was.
  const SceneSight before = open_({file(), 1});
  write("version = 1\n");
  EXPECT_EQ(hidden_by(west_, east_, {file(), 2}), "");
  EXPECT_FALSE(line_of_sight(surface(), west_, east_, before.first_object).visible);
}

TEST_F(SceneSightTest, AMissingFileIsNamedAndTheNextIsRead) {
  const std::string missing = (folder_ / "no.scene.toml").string();
  try {
    (void)open_({missing});
    ADD_FAILURE() << "it was opened";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find(missing), std::string::npos) << e.what();
  }
  EXPECT_EQ(hidden_by(west_, east_, {file()}), "Tower");
}

}  // namespace
