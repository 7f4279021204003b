#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "objects/files/model_file.h"
#include "tests/objects/files/model_makers.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace objects {
namespace {

namespace fs = std::filesystem;

using test_support::box_gltf;
using test_support::box_obj;
using test_support::box_ply;
using test_support::box_stl;
using test_support::four_colours_png;
using test_support::glb_of;
using test_support::Json;
using test_support::png_that_claims;
using test_support::square_gltf;
using test_support::write_text;

constexpr unsigned kSeed = 20261201;

using Files = std::vector<std::pair<std::string, std::string>>;

Files boxes() {
  return {{"a.gltf", box_gltf().dump()}, {"a.glb", glb_of(box_gltf())}, {"a.obj", box_obj(true)},
          {"a.ply", box_ply(false)},     {"b.ply", box_ply(true)},      {"a.stl", box_stl(false)},
          {"b.stl", box_stl(true)}};
}

class HostileModelFile : public testing::Test {
 protected:
  void SetUp() override {
    if (model_reader_program().empty()) GTEST_SKIP() << "skipped: no vpe-model-reader";
  }

  // Returns the message of the error, or "" for a mesh.
  std::string error_of(const fs::path& path) {
    try {
      const ModelFile file = read_model_file(path, {.time_s = 3});
      EXPECT_EQ(check(file.mesh), "");
      return "";
    } catch (const vpe::base::FileError& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with("cannot read the model '" + path.string() + "': ")) << message;
      return message;
    }
  }
  std::string error_of(const std::string& name, std::string_view text) {
    write_text(folder_ / name, text);
    return error_of(folder_ / name);
  }
  std::string error_of(const Json& document) { return error_of("model.gltf", document.dump()); }

  void damage(int rounds, unsigned seed) {
    std::mt19937 random(seed);
    write_text(folder_ / "box.mtl", "newmtl body\nKd 1 0 0\n");
    for (const auto& [name, good] : boxes()) {
      SCOPED_TRACE(name);
      for (int n = 0; n < rounds; ++n) {
        std::string bytes = good;
        for (unsigned k = 0; k <= random() % 4; ++k)
          bytes[random() % bytes.size()] ^= static_cast<char>(1U << random() % 8);
        error_of(name, bytes);
      }
    }
  }
  void truncate(std::size_t pieces) {
    for (const auto& [name, good] : boxes()) {
      SCOPED_TRACE(name);
      for (std::size_t n = 0; n < pieces; ++n)
        error_of(name, std::string_view(good).substr(0, good.size() * n / pieces));
    }
  }

  ::test_support::TempDir folder_;
};

void expect_says(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << " in " << message;
}

TEST_F(HostileModelFile, TruncationsGiveAMeshOrAnError) { truncate(12); }
TEST_F(HostileModelFile, DamageGivesAMeshOrAnError) { damage(30, kSeed); }

class LongHostileModelFile : public HostileModelFile {};
TEST_F(LongHostileModelFile, TruncationsGiveAMeshOrAnError) { truncate(200); }
TEST_F(LongHostileModelFile, DamageGivesAMeshOrAnError) { damage(500, kSeed + 1); }

TEST_F(HostileModelFile, WhatIsNoModelIsNamed) {
  expect_says(error_of("a.obj", ""), {"it is empty"});
  expect_says(error_of("a.fbx", "x"), {"its extension is not"});
  expect_says(error_of(folder_ / "none.obj"), {"No such file"});
  fs::create_directory(folder_ / "folder.obj");
  expect_says(error_of(folder_ / "folder.obj"), {"it is a folder"});
  ASSERT_EQ(::mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
  expect_says(error_of(folder_ / "pipe.obj"), {"it is a device or pipe"});
  expect_says(error_of("a.glb", box_gltf().dump()), {"it is not a GLB"});
  expect_says(error_of("a.gltf", glb_of(box_gltf())), {"it is a GLB"});
  // What looks like another format is not read as that format.
  EXPECT_NE(error_of("a.obj", box_ply(true)), "");
  EXPECT_NE(error_of("a.ply", box_obj(false)), "");
}

TEST_F(HostileModelFile, TheReaderMustBeThere) {
  const char* set = std::getenv("VPE_MODEL_READER");
  const std::string former = set != nullptr ? set : "";
  ASSERT_EQ(::setenv("VPE_MODEL_READER", "/nonexistent", 1), 0);
  EXPECT_EQ(model_reader_program(), "");
  expect_says(error_of("a.obj", box_obj(false)), {"/nonexistent", "VPE_MODEL_READER"});
  // Any program that does not send a model.
  ASSERT_EQ(::setenv("VPE_MODEL_READER", "/bin/true", 1), 0);
  expect_says(error_of("a.obj", box_obj(false)), {"ended with status 0 and without a model"});
  ASSERT_EQ(::setenv("VPE_MODEL_READER", "/bin/echo", 1), 0);
  expect_says(error_of("a.obj", box_obj(false)), {"not a model's stream"});
  write_text(folder_ / "dies", "#!/bin/sh\nkill -SEGV $$\n");
  ::chmod((folder_ / "dies").c_str(), 0700);
  ASSERT_EQ(::setenv("VPE_MODEL_READER", (folder_ / "dies").c_str(), 1), 0);
  expect_says(error_of("a.obj", box_obj(false)), {"ended by signal 11 (Segmentation fault)"});
  write_text(folder_ / "slow", "#!/bin/sh\nkill -XCPU $$\n");
  ::chmod((folder_ / "slow").c_str(), 0700);
  ASSERT_EQ(::setenv("VPE_MODEL_READER", (folder_ / "slow").c_str(), 1), 0);
  expect_says(error_of("a.obj", box_obj(false)), {"more than 3 s of processor time"});
  write_text(folder_ / "talks", "#!/bin/sh\nexec cat /dev/zero\n");
  ::chmod((folder_ / "talks").c_str(), 0700);
  ASSERT_EQ(::setenv("VPE_MODEL_READER", (folder_ / "talks").c_str(), 1), 0);
  EXPECT_THROW(read_model_file(folder_ / "a.obj", {.memory_gb = 0.25}), vpe::base::FileError);
  // An empty one counts as none.
  ::setenv("VPE_MODEL_READER", former.c_str(), 1);
}

TEST_F(HostileModelFile, NodesInCirclesAndOverDeepOnesAreRefused) {
  Json document = box_gltf();
  document["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
  expect_says(error_of(document), {"two parents or is its own"});
  document["nodes"] = {{{"children", {1, 1}}}, {{"mesh", 0}}};
  expect_says(error_of(document), {"two parents"});
  document["nodes"] = Json::array();
  for (int n = 0; n < 1500; ++n) document["nodes"].push_back({{"children", {n + 1}}});
  document["nodes"].push_back({{"mesh", 0}});
  expect_says(error_of(document), {"nested over 1000 deep"});
  expect_says(error_of("a.gltf", std::string(1'000'000, '[')), {"nested too deep"});
}

TEST_F(HostileModelFile, NumbersThatCannotBeAreRefused) {
  expect_says(error_of("a.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), {"vertex 0"});
  std::string ply = box_ply(true);
  ply.replace(ply.find("end_header\n") + 11, 4, "\xff\xff\xff\x7f");
  expect_says(error_of("a.ply", ply), {"not finite"});
  ply = box_ply(true);
  ply.replace(ply.size() - 4, 4, "\x7f\x7f\x7f\x7f");
  expect_says(error_of("a.ply", ply), {"names a vertex beyond the last one"});
  for (const bool is_binary : {false, true}) {
    ply = box_ply(is_binary);
    ply.replace(ply.find("element vertex 8"), 16, "element vertex 1000000000");
    EXPECT_NE(error_of("a.ply", ply), "");
  }
  std::string stl = box_stl(true);
  stl.replace(80, 4, "\xff\xff\xff\x7f");
  EXPECT_NE(error_of("a.stl", stl), "");
  Json document = box_gltf();
  document["accessors"][0]["count"] = 1'000'000'000;
  EXPECT_NE(error_of(document), "");
  document["accessors"][0]["count"] = 9;
  expect_says(error_of(document), {"reach beyond their buffer"});
}

TEST_F(HostileModelFile, CompressedModelsAreRefusedByName) {
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    Json document = box_gltf();
    document["extensionsUsed"] = {name};
    expect_says(error_of(document), {"it is compressed with", name, "save it without compression"});
  }
  Json document = box_gltf();
  document["extensionsRequired"] = {"KHR_mesh_quantization"};
  expect_says(error_of(document), {"KHR_mesh_quantization"});
}

TEST_F(HostileModelFile, TexturesOutsideOfTheFolderAreRefusedByName) {
  fs::create_directory(folder_ / "inside");
  vpe::base::write_file(folder_ / "secret.png", four_colours_png());
  fs::create_symlink(folder_ / "secret.png", folder_ / "inside/link.png");
  ASSERT_EQ(::mkfifo((folder_ / "inside/pipe.png").c_str(), 0600), 0);
  for (const char* name :
       {"../../etc/passwd", "../secret.png", "/etc/passwd", "file:///etc/passwd", "link.png",
        "http://example.com/a.png", "C:\\a.png", "pipe.png", "missing.png", "%2e%2e/secret.png"}) {
    const std::string words = error_of("inside/model.gltf", square_gltf(name).dump());
    expect_says(words, {"the texture", std::string(name).starts_with("%") ? "../secret.png" : name});
    if (std::string(name).find('\\') != std::string::npos) continue;
    write_text(folder_ / "inside/box.mtl", "newmtl body\nmap_Kd " + std::string(name) + "\n");
    if (!std::string(name).starts_with("%"))
      expect_says(error_of("inside/box.obj", box_obj(true)), {"the texture", name});
  }
}

TEST_F(HostileModelFile, OtherFilesOutsideOfTheFolderAreRefusedByName) {
  fs::create_directory(folder_ / "inside");
  write_text(folder_ / "secret.bin", std::string(168, ' '));
  Json document = box_gltf();
  for (const char* name : {"../secret.bin", "/etc/passwd", "http://example.com/a.bin"}) {
    document["buffers"][0]["uri"] = name;
    expect_says(error_of("inside/model.gltf", document.dump()), {"the buffer", name});
  }
  expect_says(error_of("inside/a.obj", "mtllib ../secret.bin\n" + box_obj(false)), {"secret.bin", "outside"});
}

TEST_F(HostileModelFile, ImagesThatClaimTooMuchAreRefused) {
  for (const std::uint32_t side : {60'000U, 30'000U}) {
    vpe::base::write_file(folder_ / "bomb.png", png_that_claims(side, side));
    expect_says(error_of(square_gltf("bomb.png")), {"bomb.png", "pixels, which are too many"});
  }
  vpe::base::write_file(folder_ / "bomb.png", png_that_claims(3, 2));
  expect_says(error_of(square_gltf("bomb.png")), {"bomb.png", "damaged"});
  write_text(folder_ / "bomb.png", "GIF89a");
  expect_says(error_of(square_gltf("bomb.png")), {"bomb.png", "neither PNG nor JPEG"});
  write_text(folder_ / "bomb.png", "\xff\xd8\xff");
  expect_says(error_of(square_gltf("bomb.png")), {"bomb.png"});
}

}  // namespace
}  // namespace objects
