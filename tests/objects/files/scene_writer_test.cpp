#include "objects/files/scene_writer.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <stdexcept>

#include "objects/files/scene_limits.h"
#include "tests/objects/files/any_scene.h"
#include "tests/objects/files/same_scenes.h"
#include "tests/objects/files/scene_texts.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace objects {
namespace {

using namespace test;

namespace fs = std::filesystem;

SceneFile again(const SceneFile& scene, const fs::path& file = "/scenes/a.scene.toml") {
  return parse_scene_toml(to_toml(scene, file), file);
}

RC_GTEST_PROP(SceneWriterProperty, WhatIsWrittenIsReadBack, (unsigned seed)) {
  const SceneFile scene = AnyScene(seed).make();
  const std::string text = to_toml(scene, scene.path);
  const SceneFile read = parse_scene_toml(text, scene.path);
  RC_ASSERT(same(scene, read));
  RC_ASSERT(to_toml(read, scene.path) == text);
}

TEST(SceneWriter, WritesAWholeScene) {
  const SceneFile scene = toml(kWhole);
  EXPECT_TRUE(same(scene, again(scene)));
}

// Each member of an image and of a kiosk that a file holds comes back, and a change of it is told.
TEST(SceneWriter, WritesImagesAndKiosks) {
  SceneFile scene;
  PosterEntry dome{"around", "/scenes/p/a.png", PosterForm::kDome, mars::LonLat{137.5, -4}};
  dome.height_kind = HeightKind::kAltitude;
  dome.height_m = -4500.25;
  dome.opacity = 0.5;
  dome.radius_m = 200;
  dome.fade_m = 100;
  dome.heading_deg = 7;
  dome.is_cylinder = true;
  dome.replaces_ground = true;
  PosterEntry photograph{"", "/scenes/b.jpg", PosterForm::kPhotograph, mars::LonLat{1, 2}};
  photograph.heading_deg = 10;
  photograph.pitch_deg = -0.0;
  photograph.roll_deg = 2;
  photograph.fov_deg = 40;
  photograph.distance_m = 500;
  scene.posters = {dome, photograph};
  scene.kiosks = {{"lookout", {3, 4}, 30, 5, "/scenes/p/a.json", "", 0}, {"", {}, 0, 4, "", "/spots.txt", 6}};
  const SceneFile read = again(scene);
  EXPECT_TRUE(same(scene, read));
  const auto differs = [&](const auto& change) {
    SceneFile other = scene;
    change(other);
    return !same(other, read) && same(other, again(other));
  };
  EXPECT_TRUE(differs([](SceneFile& s) { s.posters[0].replaces_ground = false; }));
  EXPECT_TRUE(differs([](SceneFile& s) { s.posters[0].fade_m = 99; }));
  EXPECT_TRUE(differs([](SceneFile& s) { s.posters[0].place->lat_deg = -4.5; }));
  EXPECT_TRUE(differs([](SceneFile& s) { s.posters[1].pitch_deg = 0; }));
  EXPECT_TRUE(differs([](SceneFile& s) { s.posters.pop_back(); }));
  EXPECT_TRUE(differs([](SceneFile& s) { s.kiosks[0].panorama.clear(); }));
  EXPECT_TRUE(differs([](SceneFile& s) { s.kiosks[1].beside_m = 7; }));
}

TEST(SceneWriter, LeavesDefaultsOut) {
  SceneFile scene;
  scene.path = "/scenes/a.scene.toml";
  scene.models = {{"rover", "/scenes/models/rover.glb"}};
  scene.objects = {{"", 0, {Placing{{137.5, -4}}}}};
  EXPECT_EQ(to_toml(scene, scene.path),
            "version = 1\n\n[[model]]\nname = \"rover\"\nfile = \"models/rover.glb\"\n\n[[object]]\n"
            "model = \"rover\"\nlon = 137.5\nlat = -4\n");
}

TEST(SceneWriter, NamesModelsRelativeToTheNewFolder) {
  SceneFile scene;
  scene.models = {{"a", "/scenes/models/a.glb"}, {"b", "/b.glb"}};
  for (const char* file : {"/scenes/a.scene.toml", "/scenes/models/deep/a.scene.toml", "/a.scene.toml"})
    EXPECT_TRUE(same(scene, again(scene, file))) << file;
  EXPECT_NE(to_toml(scene, "/other/a.scene.toml").find("file = \"../scenes/models/a.glb\""), std::string::npos);
  scene.models = {{"a", "models/a.glb"}, {"b", "../b.glb"}};
  EXPECT_TRUE(same(scene, again(scene, "x.scene.toml")));
  EXPECT_TRUE(same(scene, again(scene, "x/y.scene.toml")));
  // No relative path leads there without the name of this folder.
  EXPECT_EQ(again(scene, "../x/y.scene.toml").models[0].file, fs::current_path() / "models/a.glb");
  EXPECT_EQ(again(scene, "/x/y.scene.toml").models[0].file, fs::current_path() / "models/a.glb");
}

TEST(SceneWriter, DividesPlacesThatDiffer) {
  SceneFile scene;
  scene.models = {{"m", "/scenes/m.glb"}};
  Placing high;
  high.height_m = 5;
  scene.objects = {{"n", 0, {Placing{{1, 2}}, Placing{{3, 4}}, high}}, {"none", 0, {}}};
  const SceneFile read = again(scene);
  ASSERT_EQ(read.objects.size(), 2U);
  EXPECT_EQ(read.objects[0].places.size(), 2U);
  EXPECT_EQ(read.objects[1].name, "n");
  EXPECT_EQ(read.objects[1].places[0].height_m, 5);
}

TEST(SceneWriter, RefusesWhatNoFileCanHold) {
  const auto written = [](const std::string& name, std::size_t model = 0) {
    SceneFile scene;
    scene.models = {{"m", "/m.glb"}};
    scene.objects = {{name, model, {Placing{}}}};
    return to_toml(scene, "/a.scene.toml");
  };
  EXPECT_NO_THROW(written("a"));
  EXPECT_THROW(written("a\nb"), std::invalid_argument);
  EXPECT_THROW(written("a\x7f"), std::invalid_argument);
  EXPECT_THROW(written("a\xff"), std::invalid_argument);
  EXPECT_THROW(written(std::string(kMostNameBytes + 1, 'a')), std::invalid_argument);
  EXPECT_THROW(written("a", 1), std::invalid_argument);
}

TEST(SceneWriter, ReplacesAFileAtOnce) {
  const test_support::TempDir folder;
  const fs::path file = folder / "a.scene.toml";
  SceneFile scene = toml(kWhole);
  write_scene_file(scene, file);
  EXPECT_TRUE(same(scene, read_scene_file(file)));
  scene.objects[0].name = "a\nb";
  EXPECT_THROW(write_scene_file(scene, file), std::invalid_argument);
  EXPECT_EQ(read_scene_file(file).objects[0].name, "Rover 1");
  EXPECT_THROW(write_scene_file(toml(kWhole), folder / "none/a.scene.toml"), vpe::base::FileError);
}

}  // namespace
}  // namespace objects
