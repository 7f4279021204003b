// vpe object and vpe sculpt.
#include <cmath>
#include <fstream>

#include "objects/volumes/volume_file.h"
#include "objects/volumes/volume_formulas.h"
#include "tests/app/support/app_fixture.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

class SceneCommands : public AppTest {
 protected:
  static std::string rover() {
    return (std::filesystem::path(VPE_SOURCE_DIR) / "scripts/scenes/models/rover.glb").string();
  }

  // Writes the silhouette of an ellipse that fills the image but for a margin, on grey.
  void write_ellipse(const std::string& name, int width, int height, const vpe::base::Rgb& colour) const {
    constexpr int kMargin = 5;
    std::vector<vpe::base::Rgb> pixels;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const double u = (x + 0.5 - 0.5 * width) / (0.5 * width - kMargin);
        const double v = (y + 0.5 - 0.5 * height) / (0.5 * height - kMargin);
        pixels.push_back(u * u + v * v < 1 ? colour : vpe::base::Rgb{208, 200, 192});
      }
    }
    vpe::core::write_image(dir_ / name, pixels, width, height);
  }
};

TEST_F(SceneCommands, ObjectDescribesAModel) {
  const Result told = vpe({"object", rover(), "--json"});
  ASSERT_EQ(told.exit_code, 0) << told.err;
  const auto json = parse_json(told.out);
  EXPECT_GT(json["triangles"].get<int>(), 3000);
  EXPECT_GT(json["materials"].get<int>(), 4);
  EXPECT_NEAR(json["low_m"][2].get<double>(), 0, 0.01);    // it stands on its wheels
  EXPECT_NEAR(json["high_m"][2].get<double>(), 2.1, 0.1);  // the head of its mast
  EXPECT_GT(json["high_m"][1].get<double>(), 1.5);         // the arm is ahead
  ASSERT_GE(json["levels"].size(), 2U);
  EXPECT_EQ(json["levels"][0]["geometric_error_m"], 0);
  EXPECT_NE(vpe({"object", rover()}).out.find("triangles"), std::string::npos);
}

TEST_F(SceneCommands, ObjectMakesSticks) {
  const Result made = vpe({"object", rover(), "-o", "rover.sticks", "--voxels", "100", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto json = parse_json(made.out);
  EXPECT_GT(json["coloured_voxels"].get<int>(), 5000);
  const auto again = parse_json(vpe({"object", "rover.sticks", "--json"}).out);
  EXPECT_EQ(again, json);
  // The same command gives the same bytes.
  const std::string bytes = read_text(dir_ / "rover.sticks");
  ASSERT_EQ(vpe({"object", rover(), "-o", "rover.sticks", "--voxels", "100", "-q"}).exit_code, 0);
  EXPECT_EQ(read_text(dir_ / "rover.sticks"), bytes);
}

TEST_F(SceneCommands, ObjectRefusesWhatItCannotDo) {
  std::ofstream(dir_ / "other.sticks") << "a letter";
  EXPECT_NE(vpe({"object", rover(), "-o", "other.sticks"}).exit_code, 0);
  EXPECT_EQ(read_text(dir_ / "other.sticks"), "a letter");
  const Result damaged = vpe({"object", "other.sticks"});
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_NE(damaged.err.find("other.sticks"), std::string::npos);
  const Result missing = vpe({"object", "no.glb"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("no.glb"), std::string::npos);
  EXPECT_EQ(vpe({"object", rover(), "--voxels", "0", "-o", "a.sticks"}).exit_code, 2);
}

TEST_F(SceneCommands, ObjectDescribesAndChangesVolumes) {
  objects::VolumeFormula formula;
  formula.voxels = 32;
  objects::write_volume_file(dir_ / "devil.volume", objects::volume_by_formula(formula));
  const Result told = vpe({"object", "devil.volume", "--json"});
  ASSERT_EQ(told.exit_code, 0) << told.err;
  const auto json = parse_json(told.out);
  EXPECT_GT(json["bricks"].get<int>(), 3);
  EXPECT_NEAR(json["size_m"][2].get<double>(), 105, 12);
  EXPECT_NE(vpe({"object", "devil.volume"}).out.find("extinction"), std::string::npos);
  ASSERT_EQ(vpe({"object", "devil.volume", "--density", "2", "--colour", "102030", "-o", "b.volume"}).exit_code,
            0);
  const auto changed = parse_json(vpe({"object", "b.volume", "--json"}).out);
  EXPECT_EQ(changed["colour"], nlohmann::json({16, 32, 48}));
  EXPECT_NEAR(changed["largest_extinction_per_m"].get<double>(),
              2 * json["largest_extinction_per_m"].get<double>(), 1e-6);
  EXPECT_GT(changed["mean_opacity"].get<double>(), json["mean_opacity"].get<double>());
  // What it cannot do.
  EXPECT_EQ(vpe({"object", "devil.volume", "--colour", "red"}).exit_code, 2);
  EXPECT_EQ(vpe({"object", rover(), "--density", "2"}).exit_code, 2);
  EXPECT_NE(vpe({"object", "devil.volume", "--density", "1e9"}).exit_code, 0);
  std::ofstream(dir_ / "c.volume") << "a letter";
  EXPECT_NE(vpe({"object", "devil.volume", "-o", "c.volume"}).exit_code, 0);
  EXPECT_EQ(read_text(dir_ / "c.volume"), "a letter");
  const Result damaged = vpe({"object", "c.volume"});
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_NE(damaged.err.find("c.volume"), std::string::npos);
}

TEST_F(SceneCommands, ObjectMakesAVolumeOfARasterOfLevels) {
  std::ofstream raw(dir_ / "cube.img", std::ios::binary);
  for (int n = 0; n < 6 * 5 * 4; ++n) raw.put(n == 0 ? 100 : 50);
  raw.close();
  write_text(dir_ / "cube.hdr",
             "ENVI\nsamples = 6\nlines = 5\nbands = 4\nheader offset = 0\nfile type = ENVI Standard\n"
             "data type = 1\ninterleave = bsq\nbyte order = 0\n");
  const Result made =
      vpe({"object", "cube.img", "--levels", "2", "--density", "0.01", "-o", "cube.volume", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto json = parse_json(vpe({"object", "cube.volume", "--json"}).out);
  EXPECT_EQ(json["spacing_m"], 2);
  EXPECT_NEAR(json["largest_extinction_per_m"].get<double>(), 1, 1e-6);
  // From post to post, and half a post or one of nothing around it.
  for (const auto& [axis, size_m] : {std::pair(0, 10), std::pair(1, 8), std::pair(2, 6)}) {
    EXPECT_GE(json["size_m"][axis].get<double>(), size_m);
    EXPECT_LE(json["size_m"][axis].get<double>(), size_m + 4);
  }
  EXPECT_EQ(vpe({"object", "cube.volume", "--levels", "2"}).exit_code, 2);
  EXPECT_EQ(vpe({"object", "cube.img", "--levels", "0"}).exit_code, 2);
  const Result none = vpe({"object", "none.img", "--levels", "2"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("none.img"), std::string::npos) << none.err;
}

TEST_F(SceneCommands, SculptCarvesAHull) {
  write_ellipse("side.png", 210, 110, {200, 40, 40});
  write_ellipse("front.png", 90, 110, {40, 200, 40});
  write_ellipse("top.png", 90, 210, {40, 40, 200});
  const Words words{"sculpt",  "side.png", "front.png", "top.png", "--size",
                    "4,1.6,2", "--voxels", "80",        "-o",      "a.sticks"};
  const Result made = vpe(words);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto json = parse_json(vpe({"object", "a.sticks", "--json"}).out);
  EXPECT_NEAR(json["voxel_m"].get<double>(), 0.05, 1e-6);
  EXPECT_EQ(json["columns"][0], 32);
  EXPECT_EQ(json["columns"][1], 80);
  EXPECT_EQ(json["height"], 40);
}

TEST_F(SceneCommands, SculptSaysWhatIsWrong) {
  write_ellipse("side.png", 210, 110, {200, 40, 40});
  write_ellipse("front.png", 90, 110, {40, 200, 40});
  write_ellipse("top.png", 90, 210, {40, 40, 200});
  const auto fails = [&](const Words& words, int code, const std::string& what) {
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(dir_ / "a.sticks"));
  };
  fails({"sculpt", "side.png", "--size", "4,1.6,2", "-o", "a.sticks"}, 1, "three");
  fails({"sculpt", "side.png", "front.png", "top.png", "--size", "4,4,2", "-o", "a.sticks"}, 1, "front");
  fails({"sculpt", "side.png", "front.png", "top.png", "--size", "4,1.6", "-o", "a.sticks"}, 2, "--size");
  fails({"sculpt", "side.png", "front.png", "top.png", "--size", "4,1.6,2", "--background", "grey", "-o",
         "a.sticks"},
        2, "--background");
  fails({"sculpt", "side.png", "front.png", "no.png", "--size", "4,1.6,2", "-o", "a.sticks"}, 1, "no.png");
  fails({"sculpt", "side.png", "front.png", "top.png", "--size", "4,1.6,2", "--contour", "c.txt", "-o",
         "a.sticks"},
        2, "--contour");
}

}  // namespace
}  // namespace app_test
