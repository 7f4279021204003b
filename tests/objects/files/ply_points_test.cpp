// PLY files of points without faces, through vpe-model-reader.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <stdexcept>

#include "objects/files/model_file.h"
#include "tests/objects/files/model_makers.h"
#include "tests/objects/files/ply_maker.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace objects {
namespace {

using test_support::box_ply;
using test_support::PlyMaker;
using test_support::write_text;

constexpr unsigned kSeed = 20261127;

using Kind = PlyMaker::Kind;

constexpr const char* kPlaces = "property float x\nproperty float y\nproperty float z\n";

// Three points with normals of several lengths and colours.
std::string full_cloud(Kind kind) {
  PlyMaker ply(kind, std::string("element vertex 3\n") + kPlaces +
                         "property float nx\nproperty float ny\nproperty float nz\n"
                         "property uchar red\nproperty uchar green\nproperty uchar blue\n");
  for (int n = 0; n < 3; ++n) {
    ply.add(1.5F + static_cast<float>(n)).add(-2.0F).add(0.25F);
    ply.add(0.0F).add(n == 1 ? 0.0F : 3.0F).add(n == 1 ? 0.0F : -4.0F);
    ply.add(static_cast<std::uint8_t>(10 * n)).add(std::uint8_t{200}).add(std::uint8_t{255}).end();
  }
  return ply.bytes();
}

class PlyPoints : public testing::Test {
 protected:
  void SetUp() override {
    if (model_reader_program().empty()) GTEST_SKIP() << "skipped: no vpe-model-reader";
  }
  ModelFile read(const std::string& bytes, ModelFileOptions options = {}) {
    write_text(folder_ / "cloud.ply", bytes);
    options.allows_points = true;
    return read_model_file(folder_ / "cloud.ply", options);
  }
  // Returns the message of the error, or "" for points.
  std::string error_of(const std::string& bytes, bool allows_points = true) {
    write_text(folder_ / "cloud.ply", bytes);
    try {
      const ModelFile file =
          read_model_file(folder_ / "cloud.ply", {.time_s = 3, .allows_points = allows_points});
      EXPECT_EQ(file.mesh.triangles.empty() ? check_points(file.mesh) : check(file.mesh), "");
      return "";
    } catch (const vpe::base::FileError& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with("cannot read the model '" + (folder_ / "cloud.ply").string() + "': "))
          << message;
      return message;
    }
  }
  void expect_error(const std::string& bytes, const std::string& part) {
    const std::string message = error_of(bytes);
    EXPECT_NE(message.find(part), std::string::npos) << "'" << message << "' has no '" << part << "'";
  }

  ::test_support::TempDir folder_;
};

TEST_F(PlyPoints, AreReadInEachFormat) {
  for (const Kind kind : {Kind::kText, Kind::kLittle, Kind::kBig}) {
    const ModelFile file = read(full_cloud(kind));
    const Mesh& mesh = file.mesh;
    EXPECT_TRUE(mesh.triangles.empty());
    ASSERT_EQ(mesh.positions_m.size(), 3U);
    EXPECT_EQ(mesh.positions_m[2], glm::vec3(3.5F, -2, 0.25F));
    ASSERT_EQ(mesh.normals.size(), 3U);
    EXPECT_LT(glm::distance(mesh.normals[0], glm::vec3(0, 0.6F, -0.8F)), 1e-6F);
    EXPECT_EQ(mesh.normals[1], glm::vec3(0));
    ASSERT_EQ(mesh.colours.size(), 3U);
    EXPECT_EQ(mesh.colours[2], (Rgba{20, 200, 255, 255}));
    EXPECT_EQ(file.notes, (std::vector<std::string>{"1 normal without a direction is ignored"}));
  }
}

TEST_F(PlyPoints, MayHaveNeitherColoursNorNormals) {
  for (const Kind kind : {Kind::kText, Kind::kLittle, Kind::kBig}) {
    PlyMaker ply(kind, std::string("element vertex 1\n") + kPlaces +
                           "element face 0\nproperty list uchar int vertex_indices\n");
    ply.add(1.0F).add(2.0F).add(3.0F).end();
    const ModelFile file = read(ply.bytes());
    EXPECT_EQ(file.mesh.positions_m, (std::vector<glm::vec3>{{1, 2, 3}}));
    EXPECT_TRUE(file.mesh.normals.empty());
    EXPECT_TRUE(file.mesh.colours.empty());
    EXPECT_TRUE(file.notes.empty());
  }
}

TEST_F(PlyPoints, OptionsChangeUnitAndAxis) {
  const Mesh mesh = read(full_cloud(Kind::kLittle), {.unit_m = 0.5, .up = UpAxis::kY}).mesh;
  EXPECT_EQ(mesh.positions_m[0], glm::vec3(-0.75F, 0.125F, -1));
  EXPECT_LT(glm::distance(mesh.normals[0], glm::vec3(0, -0.8F, 0.6F)), 1e-6F);
}

// Doubles, whole numbers, lists and other elements, before and after the points; colours of other types.
TEST_F(PlyPoints, AllTypesOfNumbersAreRead) {
  for (const Kind kind : {Kind::kText, Kind::kLittle, Kind::kBig}) {
    PlyMaker ply(kind,
                 "element camera 2\nproperty list ushort double views\nproperty char n\n"
                 "element vertex 2\nproperty double x\nproperty uchar quality\nproperty short y\n"
                 "property list uchar int tracks\nproperty uint z\n"
                 "property ushort red\nproperty ushort green\nproperty ushort blue\n"
                 "element edge 1\nproperty int a\nproperty int b\n");
    for (int n = 0; n < 2; ++n) ply.add(std::uint16_t{2}).add(0.5).add(1.5).add(std::int8_t{-3}).end();
    for (int n = 0; n < 2; ++n) {
      ply.add(-1.25).add(std::uint8_t{9}).add(std::int16_t{-300}).add(static_cast<std::uint8_t>(n));
      if (n == 1) ply.add(std::int32_t{77});
      ply.add(std::uint32_t{70000})
          .add(std::uint16_t{65535})
          .add(std::uint16_t{0})
          .add(std::uint16_t{25700})
          .end();
    }
    ply.add(std::int32_t{0}).add(std::int32_t{1}).end();
    const ModelFile file = read(ply.bytes());
    ASSERT_EQ(file.mesh.positions_m.size(), 2U);
    EXPECT_EQ(file.mesh.positions_m[1], glm::vec3(-1.25F, -300, 70000));
    EXPECT_EQ(file.mesh.colours[1], (Rgba{255, 0, 100, 255}));
    EXPECT_EQ(file.notes, (std::vector<std::string>{"the element \"camera\" is ignored",
                                                    "the element \"edge\" is ignored"}));
  }
  PlyMaker ply(Kind::kText, std::string("element vertex 1\n") + kPlaces +
                                "property float r\nproperty float g\nproperty float b\n");
  ply.add(1.0F).add(2.0F).add(3.0F).add(0.0F).add(1.0F).add(0.5F).end();
  EXPECT_EQ(read(ply.bytes()).mesh.colours.at(0), (Rgba{0, 255, 128, 255}));
}

TEST_F(PlyPoints, PointsThatAreNotFiniteAreLeftOut) {
  for (const Kind kind : {Kind::kText, Kind::kLittle}) {
    PlyMaker ply(kind, std::string("element vertex 3\n") + kPlaces);
    ply.add(std::numeric_limits<float>::quiet_NaN()).add(1.0F).add(1.0F).end();
    ply.add(1.0F).add(2.0F).add(3.0F).end();
    ply.add(1.0F).add(std::numeric_limits<float>::infinity()).add(1.0F).end();
    const ModelFile file = read(ply.bytes());
    EXPECT_EQ(file.mesh.positions_m, (std::vector<glm::vec3>{{1, 2, 3}}));
    EXPECT_EQ(file.notes, (std::vector<std::string>{"2 points without finite coordinates are ignored"}));
    PlyMaker none(kind, std::string("element vertex 1\n") + kPlaces);
    none.add(std::numeric_limits<float>::quiet_NaN()).add(1.0F).add(1.0F).end();
    expect_error(none.bytes(), "none of its points has finite coordinates");
    PlyMaker far(kind, std::string("element vertex 1\n") + kPlaces);
    far.add(1.0F).add(3e9F).add(1.0F).end();
    expect_error(far.bytes(), "the coordinates of its point 0 are over 1e9 m");
  }
}

TEST_F(PlyPoints, RoundingFarFromTheOriginIsNoted) {
  PlyMaker ply(Kind::kLittle, "element vertex 2\nproperty double x\nproperty double y\nproperty double z\n");
  ply.add(4.5e6).add(1e3).add(0.0).add(4.5e6 + 20).add(1e3 + 7).add(3.0);
  const ModelFile file = read(ply.bytes());
  ASSERT_EQ(file.notes.size(), 1U);
  EXPECT_NE(file.notes[0].find("rounded by up to 0.27 m"), std::string::npos) << file.notes[0];
}

TEST_F(PlyPoints, LineEndsOfOtherSystemsAreRead) {
  std::string text = full_cloud(Kind::kText);
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
  EXPECT_EQ(read(text).mesh.positions_m.size(), 3U);
  text.resize(text.size() - 2);  // the last line has no end
  EXPECT_EQ(read(text).mesh.colours.at(2), (Rgba{20, 200, 255, 255}));
}

// More than the pieces in which a file is read.
TEST_F(PlyPoints, LongFilesAreReadInPieces) {
  constexpr int kCount = 200'000;
  for (const Kind kind : {Kind::kText, Kind::kBig}) {
    PlyMaker ply(kind, "element vertex " + std::to_string(kCount) + "\n" + kPlaces);
    for (int n = 0; n < kCount; ++n) ply.add(static_cast<float>(n)).add(static_cast<float>(-n)).add(0.5F).end();
    const Mesh mesh = read(ply.bytes()).mesh;
    ASSERT_EQ(mesh.positions_m.size(), static_cast<std::size_t>(kCount));
    for (int n = 0; n < kCount; ++n)
      ASSERT_EQ(mesh.positions_m[static_cast<std::size_t>(n)],
                glm::vec3(static_cast<float>(n), static_cast<float>(-n), 0.5F));
  }
}

TEST_F(PlyPoints, AreAnErrorWhereTheyAreNotAskedFor) {
  for (const Kind kind : {Kind::kText, Kind::kBig}) {
    const std::string message = error_of(full_cloud(kind), false);
    EXPECT_NE(message.find("it has points and no faces"), std::string::npos) << message;
    EXPECT_NE(message.find("vpe object FILE -o NAME.sticks"), std::string::npos) << message;
  }
  // Faces are read as before, asked for or not.
  EXPECT_EQ(read(box_ply(true)).mesh.triangles.size(), 12U);
  EXPECT_EQ(error_of(box_ply(false), false), "");
}

TEST_F(PlyPoints, TruncationsAreErrors) {
  for (const Kind kind : {Kind::kText, Kind::kLittle, Kind::kBig}) {
    const std::string good = full_cloud(kind);
    // A text that lost the end of its last number is another text.
    const std::size_t last = kind == Kind::kText ? good.rfind(' ') : good.size() - 1;
    for (std::size_t size = 0; size <= last; size += size < last - 9 ? 7 : 1)
      EXPECT_NE(error_of(good.substr(0, size)), "") << size;
  }
}

TEST_F(PlyPoints, HugeClaimsAreErrorsWithoutMemory) {
  for (const Kind kind : {Kind::kText, Kind::kLittle}) {
    for (const char* count : {"4", "49999999", "50000000"}) {
      std::string bytes = full_cloud(kind);
      bytes.replace(bytes.find("vertex 3"), 8, std::string("vertex ") + count);
      expect_error(bytes, "it ends early");
    }
    for (const char* count : {"50000001", "18446744073709551615", "99999999999999999999", "-1", "many"}) {
      std::string bytes = full_cloud(kind);
      bytes.replace(bytes.find("vertex 3"), 8, std::string("vertex ") + count);
      expect_error(bytes, "at most 50000000 are read");
    }
    PlyMaker lists(kind, std::string("element vertex 1\n") + kPlaces + "property list int float more\n");
    lists.add(1.0F).add(2.0F).add(3.0F).add(std::int32_t{2'000'000'000}).end();
    EXPECT_NE(error_of(lists.bytes()), "");
    PlyMaker negative(kind, std::string("element vertex 1\n") + kPlaces + "property list int float more\n");
    negative.add(1.0F).add(2.0F).add(3.0F).add(std::int32_t{-1}).end();
    EXPECT_NE(error_of(negative.bytes()), "");
  }
  expect_error("ply\nformat ascii 1.0\ncomment " + std::string(3'000'000, 'x'), "its header has no end");
  expect_error("ply\nformat ascii 1.0\nelement vertex 1\n" + std::string(kPlaces) + "end_header\n" +
                   std::string(3'000'000, ' ') + "1 2 3\n",
               "one of its lines is too long");
}

TEST_F(PlyPoints, WrongTypesAndWordsAreErrors) {
  const auto cloud = [](const std::string& properties, const std::string& numbers) {
    return "ply\nformat ascii 1.0\nelement vertex 1\n" + properties + "end_header\n" + numbers + "\n";
  };
  expect_error(cloud("property half x\n", "1"), "unknown type \"half\"");
  expect_error(cloud("property float x\nproperty float y\n", "1 2"), "no x, y and z");
  expect_error(cloud("property list uchar float x\nproperty float y\nproperty float z\n", "1 1 2 3"),
               "no x, y and z");
  expect_error(cloud(kPlaces, "10.25 20.25"), "too few numbers");
  expect_error(cloud(kPlaces, "1 2 north"), "the word \"north\"");
  expect_error(cloud(kPlaces, "1 2 0x3"), "the word \"0x3\"");
  const std::string places(kPlaces);
  const auto colours = [&](const std::string& type) {
    return places + "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
  };
  expect_error(cloud(colours("uchar"), "1 2 3 0 256 0"), "not within 0 to 255");
  expect_error(cloud(colours("int"), "1 2 3 0 0 -1"), "not within 0 to 255");
  expect_error(cloud(colours("float"), "1 2 3 200 100 50"), "not within 0 to 1");
  expect_error(cloud(colours("float"), "1 2 3 nan 0 0"), "not within 0 to 1");
  expect_error(cloud("", ""), "no x, y and z");
  expect_error("ply\nformat ascii 1.0\nelement vertex 0\n" + places + "end_header\n",
               "neither points nor faces");
  expect_error("ply\nformat ascii 1.0\nend_header\n", "neither points nor faces");
  // What a number may look like.
  EXPECT_EQ(error_of(cloud(kPlaces, "+1 2.5e-1 -.5")), "");
  EXPECT_EQ(error_of(cloud(kPlaces, "1e-400 2 3")), "");
}

TEST_F(PlyPoints, DamageGivesPointsOrAnError) {
  std::mt19937 random(kSeed);
  for (const Kind kind : {Kind::kText, Kind::kLittle, Kind::kBig}) {
    const std::string good = full_cloud(kind);
    for (int n = 0; n < 60; ++n) {
      std::string bytes = good;
      for (unsigned k = 0; k <= random() % 4; ++k)
        bytes[random() % bytes.size()] ^= static_cast<char>(1U << random() % 8);
      error_of(bytes);
    }
  }
}

}  // namespace
}  // namespace objects
