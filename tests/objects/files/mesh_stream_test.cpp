#include "objects/files/mesh_stream.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>

namespace objects {
namespace {

constexpr unsigned kSeed = 20261130;

MeshStream example() {
  MeshStream stream;
  stream.mesh.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.5}};
  stream.mesh.normals.assign(4, {0, 0, 1});
  stream.mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {-3, 7}};
  stream.mesh.colours = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}, {13, 14, 15, 16}};
  stream.mesh.triangles = {{0, 1, 2}, {1, 2, 3}};
  stream.mesh.materials = {1, 0};
  stream.mesh.material_table = {{}, {{1, 2, 3, 4}, 0, AlphaMode::kMask, 77, false}};
  stream.mesh.textures = {{2, 1, {{1, 1, 1, 1}, {2, 2, 2, 2}}}};
  stream.notes = {"2 animations are ignored", ""};
  return stream;
}

std::vector<std::uint8_t> bytes_of(const MeshStream& stream) {
  std::vector<std::uint8_t> bytes;
  write_mesh_stream(
      stream, [&](std::span<const std::uint8_t> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
  return bytes;
}

TEST(MeshStream, KeepsEveryField) {
  const MeshStream sent = example();
  const MeshStream got = read_mesh_stream(bytes_of(sent));
  EXPECT_EQ(got.error, "");
  EXPECT_EQ(got.notes, sent.notes);
  EXPECT_EQ(got.mesh.positions_m, sent.mesh.positions_m);
  EXPECT_EQ(got.mesh.normals, sent.mesh.normals);
  EXPECT_EQ(got.mesh.uvs, sent.mesh.uvs);
  EXPECT_EQ(got.mesh.colours, sent.mesh.colours);
  EXPECT_EQ(got.mesh.triangles, sent.mesh.triangles);
  EXPECT_EQ(got.mesh.materials, sent.mesh.materials);
  ASSERT_EQ(got.mesh.material_table.size(), 2U);
  EXPECT_EQ(got.mesh.material_table[0].texture, -1);
  const Material& m = got.mesh.material_table[1];
  EXPECT_EQ(m.colour, (Rgba{1, 2, 3, 4}));
  EXPECT_EQ(m.texture, 0);
  EXPECT_EQ(m.alpha, AlphaMode::kMask);
  EXPECT_EQ(m.cutoff, 77);
  EXPECT_FALSE(m.double_sided);
  ASSERT_EQ(got.mesh.textures.size(), 1U);
  EXPECT_EQ(got.mesh.textures[0].width, 2);
  EXPECT_EQ(got.mesh.textures[0].texels, sent.mesh.textures[0].texels);
}

TEST(MeshStream, AnErrorComesWithoutAMesh) {
  MeshStream sent = example();
  sent.error = "it is empty";
  sent.advice = "export it again";
  const std::vector<std::uint8_t> bytes = bytes_of(sent);
  const MeshStream got = read_mesh_stream(bytes);
  EXPECT_EQ(got.error, sent.error);
  EXPECT_EQ(got.advice, sent.advice);
  EXPECT_TRUE(got.mesh.triangles.empty());
  EXPECT_LT(bytes.size(), 150U);
}

TEST(MeshStream, LongTextsAreShortened) {
  MeshStream sent = example();
  sent.notes.assign(5000, std::string(10'000, 'x'));
  const MeshStream got = read_mesh_stream(bytes_of(sent));
  EXPECT_EQ(got.notes.size(), MeshStreamLimits::kMostNotes);
  EXPECT_EQ(got.notes.front().size(), MeshStreamLimits::kLongestText_bytes);
}

TEST(MeshStream, RefusesEveryTruncationAndAddition) {
  std::vector<std::uint8_t> bytes = bytes_of(example());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(read_mesh_stream(std::span(bytes).first(size)), std::runtime_error) << size;
  bytes.push_back(0);
  EXPECT_THROW(read_mesh_stream(bytes), std::runtime_error);
}

// Eight bytes of ones anywhere: where they are a count, nothing of that size may be allocated.
TEST(MeshStream, RefusesHugeCounts) {
  const std::vector<std::uint8_t> good = bytes_of(example());
  for (const std::uint64_t huge : {std::numeric_limits<std::uint64_t>::max(), std::uint64_t{1} << 61,
                                   std::uint64_t{49'999'999}, std::uint64_t{1} << 28}) {
    for (std::size_t at = 0; at + 8 <= good.size(); ++at) {
      std::vector<std::uint8_t> bytes = good;
      std::memcpy(bytes.data() + at, &huge, 8);
      try {
        EXPECT_EQ(check(read_mesh_stream(bytes).mesh), "") << at;
      } catch (const std::runtime_error& error) {
        EXPECT_STRNE(error.what(), "") << at;
      }
    }
  }
}

TEST(MeshStream, DamagedBytesGiveACheckedMeshOrAnError) {
  const std::vector<std::uint8_t> good = bytes_of(example());
  std::mt19937 random(kSeed);
  for (int n = 0; n < 20'000; ++n) {
    std::vector<std::uint8_t> bytes = good;
    for (unsigned k = 0; k <= random() % 3; ++k)
      bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    try {
      const MeshStream got = read_mesh_stream(bytes);
      if (got.error.empty()) {
        EXPECT_EQ(check(got.mesh), "");
      }
    } catch (const std::runtime_error& error) {
      EXPECT_STRNE(error.what(), "");
    }
  }
}

TEST(MeshStream, RefusesAMeshThatCannotBeDrawn) {
  MeshStream sent = example();
  sent.mesh.positions_m[1].x = std::numeric_limits<float>::quiet_NaN();
  try {
    read_mesh_stream(bytes_of(sent));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), check(sent.mesh));
  }
}

MeshStream points_example() {
  MeshStream stream;
  stream.mesh.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  stream.mesh.normals.assign(3, {0, 0, 1});
  stream.mesh.colours = {{1, 2, 3, 255}, {5, 6, 7, 255}, {9, 10, 11, 255}};
  stream.notes = {"1 point is ignored"};
  return stream;
}

TEST(MeshStream, PointsAreKeptWhereTheyAreAllowed) {
  const MeshStream sent = points_example();
  const MeshStream got = read_mesh_stream(bytes_of(sent), true);
  EXPECT_EQ(got.mesh.positions_m, sent.mesh.positions_m);
  EXPECT_EQ(got.mesh.normals, sent.mesh.normals);
  EXPECT_EQ(got.mesh.colours, sent.mesh.colours);
  EXPECT_EQ(got.notes, sent.notes);
  EXPECT_THROW(read_mesh_stream(bytes_of(sent)), std::runtime_error);
  // A mesh with triangles is checked as one.
  EXPECT_EQ(read_mesh_stream(bytes_of(example()), true).mesh.triangles.size(), 2U);
  MeshStream bad = example();
  bad.mesh.triangles[0].x = 99;
  EXPECT_THROW(read_mesh_stream(bytes_of(bad), true), std::runtime_error);
}

TEST(MeshStream, RefusesPointsThatAreNotSound) {
  const auto refuses = [](const auto& change) {
    MeshStream stream = points_example();
    change(stream.mesh);
    const std::string reason = check_points(stream.mesh);
    EXPECT_NE(reason, "");
    try {
      read_mesh_stream(bytes_of(stream), true);
      ADD_FAILURE() << reason;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()), reason);
    }
  };
  refuses([](Mesh& m) { m = {}; });
  refuses([](Mesh& m) { m.positions_m[1].z = std::numeric_limits<float>::quiet_NaN(); });
  refuses([](Mesh& m) { m.positions_m[1].z = 2e9F; });
  refuses([](Mesh& m) { m.normals[2].x = std::numeric_limits<float>::infinity(); });
  refuses([](Mesh& m) { m.normals.pop_back(); });
  refuses([](Mesh& m) { m.colours.pop_back(); });
  refuses([](Mesh& m) { m.uvs.resize(3); });
  refuses([](Mesh& m) { m.material_table.resize(1); });
  refuses([](Mesh& m) { m.textures = {{1, 1, {{1, 1, 1, 1}}}}; });
}

TEST(MeshStream, DamagedPointsGiveCheckedPointsOrAnError) {
  const std::vector<std::uint8_t> good = bytes_of(points_example());
  std::mt19937 random(kSeed);
  for (int n = 0; n < 20'000; ++n) {
    std::vector<std::uint8_t> bytes = good;
    for (unsigned k = 0; k <= random() % 3; ++k)
      bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    try {
      const MeshStream got = read_mesh_stream(bytes, true);
      if (got.error.empty()) {
        EXPECT_EQ(check_points(got.mesh), "");
      }
    } catch (const std::runtime_error& error) {
      EXPECT_STRNE(error.what(), "");
    }
  }
}

}  // namespace
}  // namespace objects
