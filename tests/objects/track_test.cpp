// Objects that a flight moves, and the heights of paths.
#include "objects/scene/track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "mars/geodesy/sphere.h"
#include "objects/scene/place.h"

namespace objects {
namespace {

using vpe::core::ObjectTrack;

constexpr double kRadius_m = 3'389'500;
constexpr double kGround_m = kRadius_m + 700;

double level_ground(const glm::dvec3& /*direction*/) { return kGround_m; }

SceneFile scene_of_names() {
  SceneFile scene;
  scene.path = "a.scene.toml";
  scene.objects = {{"lander", 0, {Placing{}}, 0}, {"rocks", 0, {Placing{}, Placing{}}, 0},
                   {"twice", 0, {Placing{}}, 0},  {"twice", 0, {Placing{}}, 0},
                   {"both", 0, {Placing{}}, 0},   {"pit", 0, {Placing{}}, 0, {GroundRole::Kind::kCut}}};
  scene.paths.resize(2);
  scene.paths[0].name = "both";
  scene.paths[1].name = "rover";
  return scene;
}

TEST(Track, NamesOneObjectOrPath) {
  const SceneFile scene = scene_of_names();
  EXPECT_FALSE(track_target(scene, {"lander", {}, {}}).is_path);
  EXPECT_EQ(track_target(scene, {"lander", {}, {}}).entry, 0U);
  EXPECT_TRUE(track_target(scene, {"rover", {}, {}}).is_path);
  EXPECT_EQ(track_target(scene, {"rover", {}, {}}).entry, 1U);
  const auto error_of = [&](const std::string& name) -> std::string {
    try {
      track_target(scene, {name, {}, {}});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(
      error_of("ghost"),
      "a.scene.toml: expected one object or path with the name \"ghost\", which the flight moves, found none");
  EXPECT_TRUE(error_of("rocks").ends_with("found one with several places"));
  EXPECT_TRUE(error_of("twice").ends_with("found several"));
  EXPECT_TRUE(error_of("pit").ends_with("found one that is part of the ground"));
  EXPECT_TRUE(error_of("both").ends_with("found several"));
}

TEST(Track, PointsAreThoseOfAPath) {
  const ObjectTrack track{"a", {{1, {10, 20, 30, {}}}, {2, {11, 21, 31, 90}}}, {}};
  const std::vector<PathPoint> points = path_points(track);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].time_s, 1);
  EXPECT_EQ(points[0].place.lon_deg, 10);
  EXPECT_EQ(points[0].place.lat_deg, 20);
  EXPECT_EQ(points[0].height_m, 30);
  EXPECT_FALSE(points[0].heading_deg.has_value());
  EXPECT_EQ(points[1].heading_deg, 90);
}

TEST(Track, HeightsOfPathsChangeEvenly) {
  PathEntry path;
  path.points = {{0, {0, 0}, {}, 10}, {10, {1, 0}, {}, 30}};
  for (const double wheels_m : {0.0, 2.0}) {
    path.wheelbase_m = path.track_m = wheels_m;
    for (const double t : {-1.0, 0.0, 2.5, 10.0, 11.0}) {
      const double wanted_m = kGround_m + 10 + 2 * std::clamp(t, 0.0, 10.0);
      EXPECT_NEAR(glm::length(path_instance(path, t, level_ground).position_m), wanted_m, 1e-6) << t;
    }
  }
}

TEST(Track, APlacingMovesToWhereThePathIs) {
  Placing placing;
  placing.pitch_deg = 5;
  placing.scale = 3;
  placing.follows_slope = true;
  placing.height_kind = HeightKind::kAltitude;
  const std::vector<PathPoint> points{{0, {0, 0}, {}, 4}, {10, {90, 0}, {}, 4}, {20, {90, 45}, 270, 8}};
  const Placing moved = placing_at(placing, points, 5);
  EXPECT_NEAR(moved.place.lon_deg, 45, 1e-9);
  EXPECT_NEAR(moved.place.lat_deg, 0, 1e-9);
  EXPECT_NEAR(moved.heading_deg, 90, 1e-9);
  EXPECT_EQ(moved.height_kind, HeightKind::kAboveGround);
  EXPECT_EQ(moved.height_m, 4);
  EXPECT_EQ(moved.pitch_deg, 5);
  EXPECT_EQ(moved.scale, 3);
  EXPECT_TRUE(moved.follows_slope);
  EXPECT_NEAR(placing_at(placing, points, 15).heading_deg, 0, 1e-9);
  EXPECT_NEAR(placing_at(placing, points, 15).height_m, 6, 1e-12);
  EXPECT_NEAR(placing_at(placing, points, 25).heading_deg, -90, 1e-9);
  // It stands as a path does.
  PathEntry path;
  path.points = points;
  const glm::dvec3 a = path_instance(path, 17, level_ground).position_m;
  const glm::dvec3 b = place_instance(placing_at({}, points, 17), 1, kRadius_m, level_ground).position_m;
  EXPECT_LT(glm::length(a - b), 1e-6);
}

}  // namespace
}  // namespace objects
