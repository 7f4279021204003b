#include "vpe/explore/objects/scene_saving.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "objects/files/scene_writer.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace vpe::explore {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModel = "version = 1\n\n[[model]]\nname = \"m\"\nfile = \"m.glb\"\n";

std::string text_in(const fs::path& file) {
  const auto bytes = base::read_file(file, 1 << 20);
  return {bytes.begin(), bytes.end()};
}

objects::SceneFile scene_in(const fs::path& file) {
  objects::SceneFile scene = objects::read_scene_file(file);
  scene.objects.push_back({"new", 0, {objects::Placing{}}});
  return scene;
}

TEST(SceneSaving, KeepsAFileWithComments) {
  const test_support::TempDir folder;
  const fs::path file = folder / "a.scene.toml";
  const std::string with_comment = std::string("# mine\n") + kModel;
  base::write_file(file, with_comment);
  EXPECT_EQ(save_scene(scene_in(file), file, false), kept_name(file));
  EXPECT_EQ(kept_name(file).filename(), "a.scene.toml~");
  EXPECT_EQ(text_in(kept_name(file)), with_comment);
  EXPECT_EQ(objects::read_scene_file(file).objects.size(), 1U);
  // What this function has written says nothing more than the scene.
  EXPECT_EQ(save_scene(scene_in(file), file, false), std::nullopt);
  EXPECT_EQ(text_in(kept_name(file)), with_comment);
  EXPECT_EQ(objects::read_scene_file(file).objects.size(), 2U);
}

TEST(SceneSaving, KeepsWhatIsNoSceneAndWhatIsAskedFor) {
  const test_support::TempDir folder;
  const fs::path file = folder / "a.scene.toml";
  objects::SceneFile scene;
  EXPECT_EQ(save_scene(scene, file, true), std::nullopt);
  EXPECT_EQ(save_scene(scene, file, true), std::nullopt);  // the same text
  scene.models = {{"m", folder / "m.glb"}};
  EXPECT_EQ(save_scene(scene, file, true), kept_name(file));
  EXPECT_EQ(text_in(kept_name(file)), "version = 1\n");
  base::write_file(file, std::string("no scene"));
  EXPECT_EQ(save_scene(scene, file, false), kept_name(file));
  EXPECT_EQ(text_in(kept_name(file)), "no scene");
}

TEST(SceneSaving, AFailureLeavesTheFile) {
  const test_support::TempDir folder;
  const fs::path file = folder / "a.scene.toml";
  base::write_file(file, std::string(kModel));
  objects::SceneFile scene = scene_in(file);
  scene.objects[0].name = "a\nb";
  EXPECT_THROW(save_scene(scene, file, true), std::invalid_argument);
  EXPECT_EQ(text_in(file), kModel);
  EXPECT_FALSE(fs::exists(kept_name(file)));
  EXPECT_THROW(save_scene({}, folder / "none/a.scene.toml", true), base::FileError);
}

}  // namespace
}  // namespace vpe::explore
