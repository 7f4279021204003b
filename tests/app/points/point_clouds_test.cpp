// vpe object with point clouds.
#include <cmath>
#include <cstring>

#include "objects/files/model_file.h"
#include "objects/sticks/stick_file.h"
#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

class PointClouds : public AppTest {
 protected:
  void SetUp() override {
    if (objects::model_reader_program().empty()) GTEST_SKIP() << "skipped: no vpe-model-reader";
  }

  // Writes points on a sphere of 2 m, whose lower half is red and whose upper half is blue.
  void write_sphere(const std::string& name, int count, bool is_coloured) const {
    test_support::Random random(20261127);
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) +
                        "\nproperty float x\nproperty float y\nproperty float z\n";
    if (is_coloured) bytes += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    bytes += "end_header\n";
    for (int n = 0; n < count; ++n) {
      const glm::vec3 p(random.direction());
      char stored[sizeof p];
      std::memcpy(stored, &p, sizeof p);
      bytes.append(stored, sizeof p);
      if (is_coloured) bytes += p.z < 0 ? std::string("\xc8\0\0", 3) : std::string("\0\0\xc8", 3);
    }
    write_text(dir_ / name, bytes);
  }
};

TEST_F(PointClouds, AreDescribed) {
  write_sphere("cloud.ply", 5000, true);
  const Result told = vpe({"object", "cloud.ply", "--json"});
  ASSERT_EQ(told.exit_code, 0) << told.err;
  const auto json = parse_json(told.out);
  EXPECT_EQ(json["points"], 5000);
  EXPECT_EQ(json["coloured"], true);
  EXPECT_EQ(json["normals"], false);
  EXPECT_EQ(json["notes"], nlohmann::json::array());
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(json["low_m"][k].get<double>(), -1, 0.02);
    EXPECT_NEAR(json["high_m"][k].get<double>(), 1, 0.02);
  }
  const Result words = vpe({"object", "cloud.ply"});
  EXPECT_TRUE(says(words.out, {"5000 points, with colours, without normals", "wide"})) << words.out;
  const Result centimetres = vpe({"object", "cloud.ply", "--unit", "0.01", "--json"});
  EXPECT_NEAR(parse_json(centimetres.out)["high_m"][2].get<double>(), 0.01, 0.0002);
}

TEST_F(PointClouds, BecomeSticks) {
  write_sphere("cloud.ply", 60'000, true);
  const Result made = vpe({"object", "cloud.ply", "-o", "rock.sticks", "--voxels", "64", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto json = parse_json(made.out);
  EXPECT_EQ(json["height"], 64);
  EXPECT_EQ(parse_json(vpe({"object", "rock.sticks", "--json"}).out), json);
  const objects::StickModel sticks = objects::read_stick_file(dir_ / "rock.sticks");
  objects::StickHits hits;
  for (const float side : {-1.0F, 1.0F}) {
    sticks.cast({{0.1F, 0.2F, 5 * side}, {0, 0, -side}}, 0, std::numeric_limits<float>::infinity(), hits);
    ASSERT_TRUE(hits.has_front);
    EXPECT_EQ(hits.front.voxel.colour,
              side < 0 ? (objects::Rgba{200, 0, 0, 255}) : (objects::Rgba{0, 0, 200, 255}));
    EXPECT_GT(side * static_cast<float>(hits.front.voxel.normal[2]), 115);
  }
  // The default closes gaps by a voxel; the same command gives the same bytes.
  const std::string bytes = read_text(dir_ / "rock.sticks");
  ASSERT_EQ(vpe({"object", "cloud.ply", "-o", "rock.sticks", "--voxels", "64", "--close", "1", "-q"}).out, "");
  EXPECT_EQ(read_text(dir_ / "rock.sticks"), bytes);
  const auto open = parse_json(
      vpe({"object", "cloud.ply", "-o", "b.sticks", "--voxels", "64", "--close", "0", "--json"}).out);
  EXPECT_NE(open, json);
}

TEST_F(PointClouds, StandInScenesAsSticksOnly) {
  write_sphere("cloud.ply", 2000, false);
  const std::string scene =
      "version = 1\n[[model]]\nname = \"rock\"\nfile = \"FILE\"\n[[object]]\nmodel = \"rock\"\nlon = 10\nlat = 20\n";
  const auto write_scene = [&](const std::string& file) {
    std::string text = scene;
    text.replace(text.find("FILE"), 4, file);
    write_text(dir_ / "a.scene.toml", text);
  };
  write_scene("cloud.ply");
  const Words query{"query", planet().string(), "10,20", "--with-objects", "a.scene.toml", "--json"};
  expect_failure(query, 1, {"cloud.ply", "it has points and no faces", "vpe object FILE -o NAME.sticks"});
  ASSERT_EQ(vpe({"object", "cloud.ply", "-o", "rock.sticks", "--voxels", "20", "--close", "3"}).exit_code, 0);
  write_scene("rock.sticks");
  const Result found = vpe(query);
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_FALSE(parse_json(found.out)[0]["object"].is_null()) << found.out;
}

TEST_F(PointClouds, WrongUseIsExplained) {
  write_sphere("cloud.ply", 100, false);
  expect_failure({"object", "cloud.ply", "--tight", "-o", "a.sticks"}, 2, {"--tight", "cloud.ply"});
  expect_failure({"object", "cloud.ply", "--close", "17", "-o", "a.sticks"}, 2, {"--close"});
  expect_failure({"object", "cloud.ply", "--close", "-1", "-o", "a.sticks"}, 2, {"--close"});
  const std::string rover =
      (std::filesystem::path(VPE_SOURCE_DIR) / "scripts/scenes/models/rover.glb").string();
  expect_failure({"object", rover, "--close", "2", "-o", "a.sticks"}, 2, {"--close is for point clouds"});
  write_text(dir_ / "one.ply",
             "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
             "end_header\n1 2 3\n1 2 3\n");
  expect_failure({"object", "one.ply", "-o", "a.sticks"}, 1, {"one.ply", "make sticks of", "one place"});
  write_text(dir_ / "short.ply",
             "ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty float z\n"
             "end_header\n1 2 3\n");
  expect_failure({"object", "short.ply", "-o", "a.sticks"}, 1, {"short.ply", "it ends early"});
  EXPECT_FALSE(exists("a.sticks"));
}

}  // namespace
}  // namespace app_test
