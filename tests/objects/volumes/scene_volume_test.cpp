// Volumes by formula in scene files.
#include <gtest/gtest.h>

#include <vector>

#include "objects/files/model_file.h"
#include "objects/files/volume_model_file.h"
#include "tests/objects/files/scene_texts.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace objects {
namespace {

using namespace test;

const std::string kVolume =
    "version = 1\n[[volume]]\nname = \"v\"\nkind = \"plume\"\nheight_m = 80\nradius_m = 20\n";

TEST(SceneVolume, ReadsAllKeys) {
  const SceneFile scene =
      toml(kVolume +
           "optical_depth = 0.5\nlean_m = 30\ncolour = [10, 20.4, 255]\nseed = 9\nvoxels = 64\n"
           "[[model]]\nname = \"m\"\nfile = \"m.volume\"\n"
           "[[object]]\nmodel = \"v\"\nlon = 1\nlat = 2\n"
           "[[path]]\nmodel = \"v\"\npoints = [[0, 1, 2], [9, 1, 3]]\n");
  ASSERT_EQ(scene.models.size(), 2U);
  // Tables of one kind are read together: models come first.
  EXPECT_FALSE(scene.models[0].formula);
  ASSERT_TRUE(scene.models[1].formula);
  VolumeFormula expected;
  expected.kind = VolumeKind::kPlume;
  expected.height_m = 80;
  expected.radius_m = 20;
  expected.optical_depth = 0.5;
  expected.lean_m = 30;
  expected.colour = {10, 20, 255, 255};
  expected.seed = 9;
  expected.voxels = 64;
  EXPECT_EQ(*scene.models[1].formula, expected);
  EXPECT_EQ(scene.models[1].name, "v");
  EXPECT_EQ(scene.objects.at(0).model, 1U);
  EXPECT_EQ(scene.paths.at(0).model, 1U);
  EXPECT_EQ(files_of(scene), (std::vector<std::filesystem::path>{"/scenes/a.scene.toml", "/scenes/m.volume"}));
}

TEST(SceneVolume, HasDefaults) {
  const VolumeFormula f = *toml(kVolume).models.at(0).formula;
  EXPECT_EQ(f.optical_depth, 1);
  EXPECT_EQ(f.lean_m, 0);
  EXPECT_EQ(f.seed, 1U);
  EXPECT_EQ(f.voxels, 128);
  EXPECT_EQ(f.colour, VolumeFormula().colour);
}

TEST(SceneVolume, MessagesNameLineValueAndWhatIsAllowed) {
  const std::string head = "version = 1\n[[volume]]\nname = \"v\"\n";
  struct Case {
    std::string text;
    int line;
    std::string what;
  };
  const std::vector<Case> cases{
      {kVolume + "density = 1\n", 7, "density"},
      {head + "kind = \"tornado\"\nheight_m = 1\nradius_m = 1\n", 4, "dust-devil"},
      {head + "kind = \"cloud\"\nradius_m = 1\n", 2, "height_m"},
      {head + "kind = \"cloud\"\nheight_m = 0\nradius_m = 1\n", 5, "a number in [0.01, 1000000]"},
      {kVolume + "optical_depth = 0\n", 7, "a number in (0, 100]"},
      {kVolume + "optical_depth = nan\n", 7, "a number in (0, 100]"},
      {kVolume + "colour = [1, 2]\n", 7, "[red, green, blue]"},
      {kVolume + "colour = [1, 2, 256]\n", 7, "a number in [0, 255]"},
      {kVolume + "voxels = 1000\n", 7, "[16, 256]"},
      {kVolume + "seed = -1\n", 7, "seed"},
      {head + "kind = \"cloud\"\nheight_m = 10\nradius_m = 10\nlean_m = 3\n", 2, "a cloud does not lean"},
      {head + "kind = \"plume\"\nheight_m = 1000\nradius_m = 1\n", 2, "differ by more than 50 times"},
      {kVolume + "[[volume]]\nname = \"v\"\nkind = \"plume\"\nheight_m = 8\nradius_m = 2\n", 8,
       "there are two models"},
  };
  for (const Case& c : cases) {
    const std::string error = toml_error(c.text);
    EXPECT_TRUE(error.starts_with("/scenes/a.scene.toml:" + std::to_string(c.line) + ": ")) << error << "\n"
                                                                                            << c.text;
    EXPECT_NE(error.find(c.what), std::string::npos) << error;
  }
}

TEST(VolumeModelFile, KnowsItsExtensions) {
  EXPECT_TRUE(is_volume_path("a.volume"));
  EXPECT_TRUE(is_volume_path("b/a.VDB"));
  EXPECT_FALSE(is_volume_path("a.vdbx"));
  EXPECT_FALSE(is_volume_path("vdb"));
  EXPECT_FALSE(is_volume_path("a.glb"));
}

// Whatever the program was built with, the error names the file and what to do.
TEST(VolumeModelFile, BadOpenVdbFilesAreErrors) {
  if (model_reader_program().empty()) GTEST_SKIP() << "skipped: no vpe-model-reader";
  const ::test_support::TempDir folder;
  for (const std::string& text :
       {std::string("a letter"), std::string(), std::string(" BDV\0\0\0\0", 8) + std::string(200, '\xff')}) {
    vpe::base::write_file(folder / "smoke.vdb", std::string_view(text));
    try {
      (void)read_volume_model(folder / "smoke.vdb");
      ADD_FAILURE() << "no error";
    } catch (const vpe::base::FileError& error) {
      EXPECT_NE(std::string(error.what()).find("smoke.vdb"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(read_volume_model(folder / "none.vdb"), vpe::base::FileError);
  EXPECT_THROW(output_of_model_reader(folder / "none.vdb", {}), vpe::base::FileError);
}

}  // namespace
}  // namespace objects
