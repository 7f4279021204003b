#include "paging/planet/codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "paging/build/build_grid.h"
#include "tests/support/support.h"

namespace {

using paging::Bytes;
using test_support::Random;

std::vector<std::int32_t> random_heights(Random& random, int side, int roughness) {
  std::vector<std::int32_t> h(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  std::int32_t at = random.integer(-100000, 100000);
  for (auto& x : h) x = at += random.integer(-roughness, roughness);
  return h;
}

paging::PackedMesh random_mesh(Random& random, int intervals) {
  paging::PackedMesh packed;
  packed.mesh.intervals = intervals;
  for (int j = 0; j <= intervals; ++j) {
    for (int i = 0; i <= intervals; ++i) {
      if (random.integer(0, 9) < 3)
        packed.mesh.vertices.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j)});
    }
  }
  const int count = static_cast<int>(packed.mesh.vertices.size());
  for (std::size_t v = 0; v < packed.mesh.vertices.size(); ++v)
    packed.height_q.push_back(random.integer(-400000, 400000));
  for (int t = 0; t < count; ++t) {
    std::array<int, 3> corner{random.integer(0, count - 1), random.integer(0, count - 1),
                              random.integer(0, count - 1)};
    std::sort(corner.begin(), corner.end());
    if (corner[0] == corner[1] || corner[1] == corner[2]) continue;
    for (const int c : corner) packed.mesh.triangles.push_back(static_cast<std::uint16_t>(c));
  }
  return packed;
}

std::vector<std::array<std::uint16_t, 3>> sorted_triangles(const lod::TileMesh& mesh) {
  std::vector<std::array<std::uint16_t, 3>> out;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    out.push_back({mesh.triangles[t], mesh.triangles[t + 1], mesh.triangles[t + 2]});
  }
  std::sort(out.begin(), out.end());
  return out;
}

TEST(Codec, HeightsSurviveAllValues) {
  Random random(11);
  for (const int side : {9, 65, 129}) {
    for (const int roughness : {0, 1, 300, 1000000}) {
      const auto h = random_heights(random, side, roughness);
      EXPECT_EQ(paging::decode_heights(paging::encode_heights(h, side), side), h);
    }
  }
  std::vector<std::int32_t> extreme(81);
  for (std::size_t n = 0; n < extreme.size(); ++n) {
    extreme[n] =
        n % 2 == 0 ? std::numeric_limits<std::int32_t>::min() : std::numeric_limits<std::int32_t>::max();
  }
  EXPECT_EQ(paging::decode_heights(paging::encode_heights(extreme, 9), 9), extreme);
}

// Changes of less than 2^15 quanta are decoded from two planes of bytes, others from four.
TEST(Codec, HeightsSurviveOnBothSidesOfTwoBytes) {
  for (const std::int32_t change :
       {0, 1, -1, 255, 32767, -32768, 32768, -32769, 65535, -65536, 1 << 23, 1 << 24}) {
    std::vector<std::int32_t> h(65 * 65);
    for (const std::size_t post : {std::size_t{0}, std::size_t{700}, h.size() - 1}) {
      h[post] = change;
      EXPECT_EQ(paging::decode_heights(paging::encode_heights(h, 65), 65), h) << change << " at post " << post;
      h[post] = 0;
    }
  }
}

TEST(Quanta, AreRoundedAsByRound) {
  Random random(12);
  std::vector<double> heights{
      0.0, -0.0, 0.5, -0.5, 1.5, -1.5, 2.5, -2.5, 0.49999999999999994, -0.49999999999999994};
  for (int n = 0; n < 1000; ++n) heights.push_back(random.integer(-80000, 80000) * 0.25);
  for (const double quantum_m : {1.0, 0.5, 0.1}) {
    const std::vector<std::int32_t> quanta = paging::to_quanta(heights, quantum_m);
    for (std::size_t n = 0; n < heights.size(); ++n) {
      const double whole = std::round(heights[n] / quantum_m);
      EXPECT_EQ(quanta[n], static_cast<std::int32_t>(whole)) << heights[n] << " / " << quantum_m;
    }
  }
}

TEST(Codec, SmoothHeightsAreSmall) {
  std::vector<std::int32_t> plane(129 * 129);
  for (std::size_t n = 0; n < plane.size(); ++n)
    plane[n] = static_cast<std::int32_t>(7 * (n % 129) + 3 * (n / 129));
  EXPECT_LT(paging::encode_heights(plane, 129).size(), 1000U);
}

TEST(Codec, MaskSurvives) {
  Random random(12);
  std::vector<bool> mask(16641);
  for (std::size_t n = 0; n < mask.size(); ++n) mask[n] = random.integer(0, 3) == 0;
  EXPECT_EQ(paging::decode_mask(paging::encode_mask(mask), mask.size()), mask);
}

TEST(Codec, MeshSurvives) {
  Random random(13);
  for (const int intervals : {8, 64, 128}) {
    const paging::PackedMesh mesh = random_mesh(random, intervals);
    const paging::PackedMesh back = paging::decode_mesh(paging::encode_mesh(mesh), intervals);
    EXPECT_EQ(back.mesh.intervals, mesh.mesh.intervals);
    EXPECT_EQ(back.mesh.vertices, mesh.mesh.vertices);
    EXPECT_EQ(back.height_q, mesh.height_q);
    EXPECT_EQ(sorted_triangles(back.mesh), sorted_triangles(mesh.mesh));
  }
}

// Any bytes either decode or throw CodecError; the sanitizer build watches for anything else.
TEST(Codec, DamagedBytesThrowOrDecode) {
  Random random(14);
  const Bytes heights = paging::encode_heights(random_heights(random, 65, 50), 65);
  const Bytes mesh = paging::encode_mesh(random_mesh(random, 64));
  int refused = 0;
  for (int round = 0; round < 2000; ++round) {
    Bytes damaged = round % 2 == 0 ? heights : mesh;
    if (round % 3 == 0)
      damaged.resize(static_cast<std::size_t>(random.integer(0, static_cast<int>(damaged.size()))));
    for (int flips = random.integer(1, 4); flips > 0 && !damaged.empty(); --flips) {
      damaged[static_cast<std::size_t>(random.integer(0, static_cast<int>(damaged.size()) - 1))] ^=
          static_cast<std::uint8_t>(1 << random.integer(0, 7));
    }
    try {
      if (round % 2 == 0) {
        paging::decode_heights(damaged, 65);
      } else {
        paging::decode_mesh(damaged, 64);
      }
    } catch (const paging::CodecError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 500);
}

// A few kilobytes of zeros must not take tens of megabytes for every thread that reads.
TEST(Codec, MeshesUnpackToNoMoreThanMeshesNeed) {
  const auto says = [](std::size_t size) {
    try {
      paging::decode_mesh(paging::compress(Bytes(size), 1), 64);
    } catch (const paging::CodecError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(says(std::size_t{5} << 20).find("not a frame of the expected size"), std::string::npos);
  EXPECT_NE(says(1 << 20).find("sizes out of range"), std::string::npos);
}

// The same below zstd: wrong numbers inside a valid frame.
TEST(Codec, WrongNumbersInsideAFrameThrowOrDecode) {
  Random random(15);
  const Bytes raw = paging::decompress(paging::encode_mesh(random_mesh(random, 16)), 1 << 20);
  int refused = 0;
  for (int round = 0; round < 2000; ++round) {
    Bytes damaged = raw;
    damaged[static_cast<std::size_t>(random.integer(0, static_cast<int>(damaged.size()) - 1))] =
        static_cast<std::uint8_t>(random.integer(0, 255));
    try {
      const paging::PackedMesh mesh = paging::decode_mesh(paging::compress(damaged, 1), 16);
      for (const std::uint16_t index : mesh.mesh.triangles) ASSERT_LT(index, mesh.mesh.vertices.size());
    } catch (const paging::CodecError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(Codec, ChecksumDependsOnKeyAndBytes) {
  const Bytes a{1, 2, 3};
  const Bytes b{1, 2, 4};
  EXPECT_NE(paging::checksum(1, a), paging::checksum(1, b));
  EXPECT_NE(paging::checksum(1, a), paging::checksum(2, a));
  EXPECT_GE(paging::checksum(1, a), 0);
}

}  // namespace
