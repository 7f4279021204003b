// vpe query --all-surfaces where a scene cuts something out of the ground.
#include "tests/app/surfaces/surface_fixture.h"
#include "tests/objects/spans/line_oracle.h"

namespace app_test {
namespace {

namespace oracle = objects::line_oracle;

constexpr double kBall_m = 15;

class CutGround : public SurfaceTest {
 protected:
  // Writes a scene of one ball of voxels and adds keys to its object.
  std::string write_ball(double altitude_m, const std::string& keys) const {
    std::string scene =
        write_scene({{"Ball", oracle::uv_sphere(kBall_m, 24, 48), place_, altitude_m, 0, 0, 0, 1, 200}});
    std::string text = read_text(dir_ / scene);
    write_text(dir_ / scene, text + keys);
    return scene;
  }

  json surfaces(const std::string& scene, const mars::LonLat& place) const {
    return ask({place}, {"--with-objects", scene})[0]["surfaces"];
  }

  static void expect_ground(const json& surface, const char* side, double height_m, double within_m) {
    EXPECT_EQ(surface["surface"], "ground");
    EXPECT_EQ(surface["side"], side);
    EXPECT_TRUE(surface["object"].is_null());
    EXPECT_NEAR(surface["height_m"].get<double>(), height_m, within_m);
    EXPECT_LE(surface["surface_error_m"].get<double>(), within_m);
  }

  mars::LonLat place_{20.3, 11.7};
};

TEST_F(CutGround, APitHasItsFloorAndATubeHasAFloorARoofAndGroundAbove) {
  const double ground = ground_m(place_);
  // Voxels are 0.15 m wide, and the facets of the ball sink by up to 0.1 m.
  constexpr double kWithin_m = 0.5;
  const json pit = surfaces(write_ball(ground + 5, "ground = \"cut\"\n"), place_);
  ASSERT_EQ(pit.size(), 1U) << pit;
  expect_ground(pit[0], "top", ground + 5 - kBall_m, kWithin_m);
  EXPECT_NEAR(pit[0]["above_ground_m"].get<double>(), 5 - kBall_m, kWithin_m);
  const json tube = surfaces(write_ball(ground - 40, "ground = \"cut\"\n"), place_);
  ASSERT_EQ(tube.size(), 3U) << tube;
  expect_ground(tube[0], "top", ground, 0.001);
  expect_ground(tube[1], "underside", ground - 40 + kBall_m, kWithin_m);
  expect_ground(tube[2], "top", ground - 40 - kBall_m, kWithin_m);
  // Beside it, and above the ground, nothing is cut.
  const mars::LonLat beside{place_.lon_deg, place_.lat_deg + 20 / kRadius_m / kDegree};
  EXPECT_EQ(surfaces(write_ball(ground - 40, "ground = \"cut\"\n"), beside).size(), 1U);
  const json above = surfaces(write_ball(ground + 200, "ground = \"cut\"\n"), place_);
  ASSERT_EQ(above.size(), 1U);
  expect_ground(above[0], "top", ground, 0.001);
}

TEST_F(CutGround, WhatIsAddedIsListedAsAnObject) {
  const double ground = ground_m(place_);
  const std::string scene = write_ball(ground + 40, "ground = \"add\"\n");
  const json added = surfaces(scene, place_);
  ASSERT_EQ(added.size(), 3U) << added;
  EXPECT_EQ(added[0]["object"], "Ball");
  EXPECT_EQ(added[1]["side"], "underside");
  expect_ground(added[2], "top", ground, 0.001);
  // The highest object is no matter of how it is drawn.
  const json answer = ask({place_}, {"--with-objects", scene})[0];
  EXPECT_EQ(answer["object"], "Ball");
}

}  // namespace
}  // namespace app_test
