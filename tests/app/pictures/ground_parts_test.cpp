// Objects that are part of the ground in images: by terrain volumes, and by everything else.
#include <cmath>
#include <fstream>

#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

using vpe::core::FloatImage;

// The camera stands 30 km up and looks north at a tower of 20 km, 100 km away, and at a pit as deep.
class GroundPartsRender : public AppTest {
 protected:
  void SetUp() override {
    AppTest::SetUp();
    // y up, a kilometre wide and deep, of unit height.
    std::ofstream(dir_ / "tower.obj") << "v -0.5 0 -0.5\nv 0.5 0 -0.5\nv 0.5 1 -0.5\nv -0.5 1 -0.5\n"
                                         "v -0.5 0 0.5\nv 0.5 0 0.5\nv 0.5 1 0.5\nv -0.5 1 0.5\n"
                                         "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  }

  void write_scene(const std::string& keys) const {
    write_text(dir_ / "a.scene.toml",
               "version = 1\n[[model]]\nname = \"tower\"\nfile = \"tower.obj\"\n"
               "[[object]]\nname = \"Tower\"\nmodel = \"tower\"\nlon = 20\nlat = 11.7\nscale = 20000\n" +
                   keys);
  }

  Result draw(const std::string& output, const Words& more,
              const std::string& pose = "20,10,30000,0,-12,0") const {
    Words all{"render",        planet().string(), "--pose",       pose,           "--size",
              "160x120",       "--scene",         "a.scene.toml", "--range",      output + ".tif",
              "--certificate", output + ".json",  "-o",           output + ".png"};
    all.insert(all.end(), more.begin(), more.end());
    return vpe(all);
  }
  FloatImage range(const std::string& output) const { return vpe::core::read_tiff(dir_ / (output + ".tif")); }
  nlohmann::json certificate(const std::string& output) const {
    return parse_json(read_text(dir_ / (output + ".json")));
  }

  static inline const Words kVolume{"--backend", "ray", "--set", "rays.mode=volume"};
  static inline const Words kExact{"--backend", "ray", "--set", "rays.mode=exact"};
};

// The tower's side is 90 km away.
bool is_on_tower(float r) { return r > 85'000 && r < 95'000; }

TEST_F(GroundPartsRender, WhatIsAddedIsGroundInVolumesAndAnObjectElsewhere) {
  write_scene("ground = \"add\"\nvoxel_m = 400\n");
  const Result by_volume = draw("v", kVolume);
  ASSERT_EQ(by_volume.exit_code, 0) << by_volume.err;
  const Result by_rays = draw("r", kExact);
  ASSERT_EQ(by_rays.exit_code, 0) << by_rays.err;
  EXPECT_EQ(by_rays.err.find("cut out"), std::string::npos) << by_rays.err;
  const FloatImage a = range("v");
  const FloatImage b = range("r");
  int tower = 0;
  int different = 0;
  for (std::size_t n = 0; n < a.pixels.size(); ++n) {
    tower += is_on_tower(a.pixels[n]) ? 1 : 0;
    different += is_on_tower(a.pixels[n]) != is_on_tower(b.pixels[n]) ? 1 : 0;
  }
  EXPECT_GT(tower, 300);
  EXPECT_LE(different, static_cast<int>(a.pixels.size()) / 50);
  EXPECT_EQ(certificate("r")["objects_drawn"], 1);
  // In volumes it is no object, and its voxels are part of the error.
  const nlohmann::json volume = certificate("v");
  EXPECT_TRUE(!volume.contains("objects_drawn") || volume["objects_drawn"] == 0);
  EXPECT_GE(volume["tile_error_m"].get<double>(), 400);
}

TEST_F(GroundPartsRender, WhatIsCutOutIsMissingInVolumesAndSaidElsewhere) {
  // Seen from above, the sides of a pit go down behind its rim.
  write_scene("ground = \"cut\"\nvoxel_m = 400\nheight = -19000\n");
  const std::string down = "20,11.7,60000,0,-90,0";
  ASSERT_EQ(draw("v", kVolume, down).exit_code, 0);
  const Result by_rays = draw("r", kExact, down);
  ASSERT_EQ(by_rays.exit_code, 0);
  EXPECT_TRUE(says(by_rays.err, {"a.scene.toml", "cut out of the ground", "rays.mode=volume"})) << by_rays.err;
  const Result quiet = draw("q", {"--backend", "ray", "--set", "rays.mode=exact", "-q"}, down);
  EXPECT_EQ(quiet.err, "");
  const FloatImage a = range("v");
  const FloatImage b = range("r");
  const std::size_t middle = a.pixels.size() / 2 + 80;
  // The tower's top was 1 km above the ground, so the pit is 19 km deep.
  EXPECT_NEAR(a.pixels[middle] - b.pixels[middle], 19000, 1500);
  EXPECT_NEAR(a.pixels[0] / b.pixels[0], 1, 0.05);
}

TEST_F(GroundPartsRender, ACameraInAPitIsBelowTheGroundOfThePlanetOnly) {
  write_scene("ground = \"cut\"\nvoxel_m = 400\nheight = -19000\n");
  Words inside = kVolume;
  inside.insert(inside.end(), {"--height", "-8000"});
  const std::string pose = "20,11.7,0,0,0,0";
  const Result refused = draw("v", inside, pose);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(says(refused.err, {"below the ground", "--allow-underground"})) << refused.err;
  inside.push_back("--allow-underground");
  const Result drawn = draw("v", inside, pose);
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  // The wall is half the tower's width away, 10 km.
  const FloatImage seen = range("v");
  EXPECT_NEAR(seen.pixels[seen.pixels.size() / 2 + 80], 10000, 1000);
}

TEST_F(GroundPartsRender, FaultsAreSaid) {
  write_scene("ground = \"cut\"\nvoxel_m = 1\n");
  const Result fine = draw("v", kVolume);
  EXPECT_EQ(fine.exit_code, 1);
  EXPECT_TRUE(says(fine.err, {"\"Tower\"", "voxels along a side", "larger voxel_m"})) << fine.err;
  EXPECT_FALSE(exists("v.png"));
  write_scene("ground = \"cut\"\n");
  write_text(dir_ / "a.flight",
             "flight 1.2\nview fov=60 size=32x24 fps=2\n"
             "at 0 pose lon=20 lat=10 alt=30000 yaw=0 pitch=-12 roll=0\n"
             "at 0 object Tower lon=20 lat=11.7\nat 1 end\n");
  const Result moved =
      vpe({"fly", "a.flight", planet().string(), "--scene", "a.scene.toml", "-o", "film", "--backend", "ray"});
  EXPECT_NE(moved.exit_code, 0);
  EXPECT_TRUE(says(moved.err, {"a.scene.toml", "\"Tower\"", "part of the ground"})) << moved.err;
}

}  // namespace
}  // namespace app_test
