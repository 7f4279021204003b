// Files that a model consists of.
#include "objects/files/model_references.h"

#include <gtest/gtest.h>

#include <fstream>

#include "objects/files/scene_file.h"
#include "objects/files/uri.h"
#include "tests/support/support.h"

namespace objects {
namespace {

namespace fs = std::filesystem;

class ModelReferences : public ::testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  test_support::TempDir folder_;
};

TEST_F(ModelReferences, OfGltfAreItsBuffersAndImages) {
  const fs::path bin = write("a b.bin", "x");
  const fs::path png = write("deep/a.png", "x");
  const fs::path model = write(
      "m.gltf", R"({"buffers":[{"uri":"a%20b.bin"},{"uri":"data:;base64,AA"},{"byteLength":1}],)"
                R"("images":[{"uri":"deep/a.png"},{"uri":"deep/a.png"},{"uri":"gone.png"},{"uri":7},3]})");
  EXPECT_EQ(model_references(model), (std::vector<fs::path>{bin, png}));
}

TEST_F(ModelReferences, OfObjAreItsMaterialsAndTheirTextures) {
  const fs::path mtl =
      write("m.mtl", "newmtl a\n map_Kd -s 1 1 1 red.png\r\nmap_d clear glass.png\nmap_Ks gone.png\n");
  const fs::path red = write("red.png", "x");
  const fs::path glass = write("clear glass.png", "x");
  const fs::path model =
      write("m.OBJ", "# mtllib other.mtl\nmtllib m.mtl\r\nmtllib\nmtllib gone.mtl\nv 0 0 0\n");
  write("other.mtl", "map_Kd red.png");
  EXPECT_EQ(model_references(model), (std::vector<fs::path>{glass, mtl, red}));
}

TEST_F(ModelReferences, NothingLiesOutsideTheFolder) {
  const fs::path inside = folder_ / "models";
  write("secret.bin", "x");
  const fs::path model =
      write("models/m.gltf",
            R"({"buffers":[{"uri":"../secret.bin"},{"uri":"/etc/passwd"},{"uri":"x/../../secret.bin"},)"
            R"({"uri":""},{"uri":"."}]})");
  EXPECT_TRUE(model_references(model).empty());
}

TEST_F(ModelReferences, WhatIsNoModelHasNone) {
  EXPECT_TRUE(model_references(folder_ / "gone.gltf").empty());
  EXPECT_TRUE(model_references(write("bad.gltf", "{\"buffers\":")).empty());
  EXPECT_TRUE(model_references(write("list.gltf", "[1]")).empty());
  EXPECT_TRUE(model_references(write("m.stl", "mtllib m.mtl\n")).empty());
  std::string deep(100'000, '[');
  EXPECT_TRUE(model_references(write("deep.gltf", deep)).empty());
}

TEST_F(ModelReferences, AreFilesOfTheScene) {
  const fs::path bin = write("a.bin", "x");
  const fs::path model = write("m.gltf", R"({"buffers":[{"uri":"a.bin"}]})");
  const fs::path scene = write("a.scene.toml", "version = 1\n[[model]]\nname = \"m\"\nfile = \"m.gltf\"\n");
  EXPECT_EQ(files_of(read_scene_file(scene)), (std::vector<fs::path>{scene, model, bin}));
}

TEST(Uri, IsDecoded) {
  EXPECT_EQ(decoded_uri("a%20b%2fc%"), "a b/c%");
  EXPECT_EQ(decoded_uri("%zz"), "%zz");
  EXPECT_EQ(decoded_uri("data:%20"), "data:%20");
}

}  // namespace
}  // namespace objects
