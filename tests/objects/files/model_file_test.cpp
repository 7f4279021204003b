#include "objects/files/model_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "tests/objects/files/model_makers.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"
#include "vpe/core/image/image.h"

namespace objects {
namespace {

using test_support::base64;
using test_support::bounds_of;
using test_support::box_gltf;
using test_support::box_obj;
using test_support::box_ply;
using test_support::box_stl;
using test_support::four_colours_png;
using test_support::glb_of;
using test_support::Json;
using test_support::square_gltf;
using test_support::text_of;
using test_support::vertex_at;
using test_support::volume_m3;
using test_support::write_text;

class ModelFileTest : public testing::Test {
 protected:
  void SetUp() override {
    if (model_reader_program().empty()) GTEST_SKIP() << "skipped: no vpe-model-reader";
  }
  ModelFile read(const std::string& name, std::string_view text, const ModelFileOptions& options = {}) {
    write_text(folder_ / name, text);
    return read_model_file(folder_ / name, options);
  }
  ModelFile read(const Json& document) { return read("model.gltf", document.dump()); }

  ::test_support::TempDir folder_;
};

void expect_box(const Mesh& mesh, const glm::vec3& low, const glm::vec3& high) {
  const auto bounds = bounds_of(mesh);
  EXPECT_LT(glm::distance(bounds.low, low), 1e-5) << bounds.low.x << " " << bounds.low.y << " " << bounds.low.z;
  EXPECT_LT(glm::distance(bounds.high, high), 1e-5)
      << bounds.high.x << " " << bounds.high.y << " " << bounds.high.z;
  const glm::dvec3 sides(high - low);
  EXPECT_NEAR(volume_m3(mesh), sides.x * sides.y * sides.z, 1e-4);
  EXPECT_EQ(mesh.triangles.size(), 12U);
}

bool has_note(const ModelFile& file, const std::string& note) {
  return std::find(file.notes.begin(), file.notes.end(), note) != file.notes.end();
}

TEST_F(ModelFileTest, EachFormatHasItsAxes) {
  const glm::vec3 y_up_low(-1, 0, 0);
  const glm::vec3 y_up_high(0, 3, 2);
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"a.obj", box_obj(false)}, {"a.gltf", box_gltf().dump()}, {"a.GLB", glb_of(box_gltf())}}) {
    SCOPED_TRACE(name);
    const ModelFile file = read(name, text);
    expect_box(file.mesh, y_up_low, y_up_high);
    EXPECT_EQ(file.mesh.positions_m.size(), 8U);
    EXPECT_TRUE(file.mesh.normals.empty());
    EXPECT_TRUE(file.mesh.uvs.empty());
    EXPECT_TRUE(file.notes.empty()) << file.notes.front();
  }
  for (const bool is_binary : {false, true}) {
    SCOPED_TRACE(is_binary);
    for (const auto& file : {read("a.ply", box_ply(is_binary)), read("a.stl", box_stl(is_binary))}) {
      expect_box(file.mesh, {0, 0, 0}, {1, 2, 3});
      EXPECT_EQ(file.mesh.positions_m.size(), 8U);
      EXPECT_TRUE(file.mesh.material_table.at(0).double_sided);
    }
  }
}

TEST_F(ModelFileTest, OptionsChangeUnitAndAxis) {
  expect_box(read("a.stl", box_stl(true), {.unit_m = 0.5, .up = UpAxis::kY}).mesh, {-0.5, 0, 0}, {0, 1.5, 1});
  expect_box(read("a.obj", box_obj(false), {.unit_m = 0.001 * 1000, .up = UpAxis::kZ}).mesh, {0, 0, 0},
             {1, 2, 3});
  EXPECT_THROW(read("a.obj", box_obj(false), {.unit_m = 0}), std::invalid_argument);
  EXPECT_THROW(read("a.obj", box_obj(false), {.unit_m = NAN}), std::invalid_argument);
}

TEST_F(ModelFileTest, PlyKeepsColoursOfVertices) {
  const Mesh mesh = read("a.ply", box_ply(true)).mesh;
  ASSERT_EQ(mesh.colours.size(), 8U);
  EXPECT_EQ(mesh.colours[vertex_at(mesh, {1, 2, 3})], (Rgba{70, 200, 255, 255}));
  EXPECT_EQ(mesh.material_table.at(0).colour, (Rgba{255, 255, 255, 255}));
}

TEST_F(ModelFileTest, ObjHasMaterialsAndTextures) {
  vpe::base::write_file(folder_ / "four.png", four_colours_png());
  write_text(folder_ / "box.mtl", "newmtl body\nKd 1 0.5 0\nd 0.5\nmap_Kd four.png\nmap_Ks four.png\n");
  const ModelFile file = read("box.obj", box_obj(true));
  const Mesh& mesh = file.mesh;
  expect_box(mesh, {-1, 0, 0}, {0, 3, 2});
  const Material material = mesh.material_table.at(mesh.materials.at(0));
  EXPECT_EQ(material.colour, (Rgba{255, 128, 0, 128}));
  EXPECT_EQ(material.alpha, AlphaMode::kBlend);
  EXPECT_TRUE(material.double_sided);
  ASSERT_EQ(material.texture, 0);
  EXPECT_EQ(mesh.textures[0].texels[0], (Rgba{255, 0, 0, 255}));
  EXPECT_EQ(mesh.textures[0].texels[3], (Rgba{255, 255, 255, 128}));
  // The first corner has vt 0 0, the bottom of the picture.
  EXPECT_EQ(mesh.uvs[mesh.triangles[0].x], glm::vec2(0, 1));
  EXPECT_EQ(mesh.uvs[mesh.triangles[0].z], glm::vec2(0, 0));
  EXPECT_TRUE(has_note(file, "maps other than that of the base colour are ignored in 1 material"));
}

TEST_F(ModelFileTest, ObjWithoutKdIsNotDarkened) {
  vpe::base::write_file(folder_ / "four.png", four_colours_png());
  write_text(folder_ / "box.mtl", "newmtl body\nmap_Kd .\\four.png\n");
  const Mesh mesh = read("box.obj", box_obj(true)).mesh;
  EXPECT_EQ(mesh.material_table.at(mesh.materials.at(0)).colour, (Rgba{255, 255, 255, 255}));
  EXPECT_EQ(mesh.textures.size(), 1U);
}

TEST_F(ModelFileTest, ObjWithoutItsMaterialsIsGreyWithANote) {
  const ModelFile file = read("box.obj", box_obj(true));
  EXPECT_TRUE(has_note(file, "the file of materials \"box.mtl\" does not exist"));
  EXPECT_EQ(file.mesh.material_table.at(0).colour, Material().colour);
}

TEST_F(ModelFileTest, GltfTexturesHaveTheirTopAtZero) {
  vpe::base::write_file(folder_ / "four colours.png", four_colours_png());
  Json document = square_gltf("four%20colours.png");
  for (int n = 0; n < 3; ++n) {
    if (n == 1)
      document["images"] = {{{"uri", "data:image/png;base64," + base64(text_of(four_colours_png()))}}};
    if (n == 2) {
      const auto jpeg = vpe::core::encode_jpeg(std::vector<vpe::base::Rgb>(64, {200, 30, 30}), 8, 8, 95);
      document["images"] = {{{"uri", "data:image/jpeg;base64," + base64(text_of(jpeg))}}};
    }
    const Mesh mesh = read(document).mesh;
    ASSERT_EQ(mesh.textures.size(), 1U);
    const Rgba first = mesh.textures[0].texels[0];
    EXPECT_NEAR(first.r, n == 2 ? 200 : 255, 3);
    EXPECT_EQ(first.a, 255);
    // Above, at y = 1 of the file, v is 0 in the file.
    EXPECT_EQ(mesh.uvs[vertex_at(mesh, {0, 0, 1})], glm::vec2(0, 0));
    EXPECT_EQ(mesh.uvs[vertex_at(mesh, {-1, 0, 0})], glm::vec2(1, 1));
  }
}

TEST_F(ModelFileTest, GltfTextureTransformsAreApplied) {
  vpe::base::write_file(folder_ / "four.png", four_colours_png());
  Json document = square_gltf("four.png");
  document["extensionsRequired"] = {"KHR_texture_transform"};
  document["extensionsUsed"] = {"KHR_texture_transform"};
  document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] =
      {{"offset", {0.25, 0.5}}, {"rotation", std::acos(0.0)}, {"scale", {2, 4}}};
  const Mesh mesh = read(document).mesh;
  // uv = (1, 1) is scaled to (2, 4), and turned by the extension's matrix to (4, -2).
  const glm::vec2 uv = mesh.uvs[vertex_at(mesh, {-1, 0, 0})];
  EXPECT_NEAR(uv.x, 4.25, 1e-5);
  EXPECT_NEAR(uv.y, -1.5, 1e-5);
}

TEST_F(ModelFileTest, GltfMaterialsKeepColourAlphaAndSides) {
  Json document = box_gltf();
  document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0.002, 0.25}}}},
                            {"alphaMode", "MASK"},
                            {"alphaCutoff", 0.2},
                            {"doubleSided", true},
                            {"normalTexture", {{"index", 5}}}},
                           {{"alphaMode", "BLEND"}}};
  document["meshes"][0]["primitives"][0]["material"] = 0;
  document["meshes"][0]["primitives"].push_back(document["meshes"][0]["primitives"][0]);
  document["meshes"][0]["primitives"][1]["material"] = 1;
  document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
  const ModelFile file = read(document);
  ASSERT_EQ(file.mesh.material_table.size(), 3U);
  const Material mask = file.mesh.material_table[file.mesh.materials.at(0)];
  EXPECT_EQ(mask.colour, (Rgba{255, 188, 7, 64}));
  EXPECT_EQ(mask.alpha, AlphaMode::kMask);
  EXPECT_EQ(mask.cutoff, 51);
  EXPECT_TRUE(mask.double_sided);
  const Material blend = file.mesh.material_table[file.mesh.materials.at(12)];
  EXPECT_EQ(blend.alpha, AlphaMode::kBlend);
  EXPECT_FALSE(blend.double_sided);
  const Material missing = file.mesh.material_table[file.mesh.materials.at(24)];
  EXPECT_EQ(missing.alpha, AlphaMode::kOpaque);
  EXPECT_EQ(missing.colour, (Rgba{255, 255, 255, 255}));
  EXPECT_TRUE(has_note(file, "normal maps of 1 material are ignored"));
}

TEST_F(ModelFileTest, NodesMoveTurnAndMirrorWhatTheyHold) {
  Json document = box_gltf();
  const double h = std::sqrt(0.5);
  // The box is mirrored in x, then turned by 90 degrees about the file's y, then moved.
  document["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}},
                       {{"children", {2}}, {"rotation", {0, h, 0, h}}},
                       {{"mesh", 0}, {"scale", {-1, 1, 2}}}};
  const Mesh mesh = read(document).mesh;
  // File: x -1..0, y 0..2, z 0..6; turned: x' = z, z' = -x; moved: x 10..16, z 0..1.
  expect_box(mesh, {-16, 0, 0}, {-10, 1, 2});
}

TEST_F(ModelFileTest, InstancesBecomeCopies) {
  Json document = box_gltf();
  document["nodes"] = {{{"mesh", 0}, {"children", {1}}},
                       {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}}};
  const Mesh mesh = read(document).mesh;
  EXPECT_EQ(mesh.triangles.size(), 24U);
  EXPECT_EQ(mesh.positions_m.size(), 16U);
  EXPECT_NEAR(volume_m3(mesh), 12, 1e-5);
}

// Normals turn with the inverse transpose; parts without get flat ones.
TEST_F(ModelFileTest, NormalsStayOutside) {
  std::string text = box_obj(false);
  text += "o second\nv 0 0 0\nv 1 0 0\nv 0 1 -1\nvn 0 1 1\nf 9//1 10//1 11//1\n";
  const Mesh mesh = read("a.obj", text).mesh;
  ASSERT_EQ(mesh.normals.size(), mesh.positions_m.size());
  EXPECT_EQ(mesh.positions_m.size(), 24U + 3U);
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 flat = glm::normalize(glm::cross(mesh.positions_m[t.y] - mesh.positions_m[t.x],
                                                     mesh.positions_m[t.z] - mesh.positions_m[t.x]));
    EXPECT_GT(glm::dot(flat, mesh.normals[t.x]), 0.999F);
  }
}

TEST_F(ModelFileTest, WhatIsNotDrawnIsNoted) {
  Json document = box_gltf();
  document["animations"] = {Json::object(), Json::object()};
  document["cameras"] = {Json::object()};
  document["skins"] = {Json::object()};
  document["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_unlit"};
  document["extensions"] = {{"KHR_lights_punctual", {{"lights", {Json::object()}}}}};
  document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
  const ModelFile file = read(document);
  for (const char* note :
       {"2 animations are ignored", "1 camera is ignored", "1 skin is ignored", "1 light is ignored",
        "the extension \"KHR_materials_unlit\" is ignored", "1 part of points or lines is ignored"})
    EXPECT_TRUE(has_note(file, note)) << note;
}

TEST_F(ModelFileTest, GltfColoursOfVerticesAreLinear) {
  Json document = box_gltf();
  document["accessors"].push_back({{"bufferView", 0}, {"componentType", 5126}, {"count", 8}, {"type", "VEC3"}});
  document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 2;
  const Mesh mesh = read(document).mesh;
  // The positions serve as colours: 1 and above is full.
  EXPECT_EQ(mesh.colours[vertex_at(mesh, {-1, 0, 2})], (Rgba{255, 255, 0, 255}));
}

}  // namespace
}  // namespace objects
