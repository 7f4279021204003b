#include "lod/tree/tile_key.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace {

using lod::Edge;
using lod::TileKey;

std::vector<TileKey> all_tiles(int level) {
  std::vector<TileKey> tiles;
  for (int face = 0; face < mars::kFaces; ++face) {
    for (int j = 0; j < 1 << level; ++j) {
      for (int i = 0; i < 1 << level; ++i) tiles.push_back({static_cast<mars::Face>(face), level, i, j});
    }
  }
  return tiles;
}

TileKey random_tile(test_support::Random& random, int level) {
  const int last = (1 << level) - 1;
  return {static_cast<mars::Face>(random.integer(0, 5)), level, random.integer(0, last),
          random.integer(0, last)};
}

// Returns the cube point at grid line `t` of `n` along an edge.
glm::dvec3 edge_point(const TileKey& key, Edge edge, int t, int log_n) {
  const std::int64_t n = std::int64_t{1} << log_n;
  const bool vertical = edge == Edge::kWest || edge == Edge::kEast;
  const std::int64_t fixed = edge == Edge::kEast || edge == Edge::kNorth ? n : 0;
  const std::int64_t i = key.i * n + (vertical ? fixed : t);
  const std::int64_t j = key.j * n + (vertical ? t : fixed);
  return mars::cube_point(key.face, mars::face_line(i, key.level + log_n),
                          mars::face_line(j, key.level + log_n));
}

void expect_shared_edge(const TileKey& key, Edge edge) {
  const lod::Neighbour next = lod::neighbour(key, edge);
  ASSERT_TRUE(lod::is_valid(next.key)) << lod::to_string(key);
  ASSERT_EQ(next.key.level, key.level);
  ASSERT_NE(next.key, key);
  constexpr int kLog = 2;
  for (int t = 0; t <= 1 << kLog; ++t) {
    const int other = next.reversed ? (1 << kLog) - t : t;
    ASSERT_EQ(edge_point(key, edge, t, kLog), edge_point(next.key, next.edge, other, kLog))
        << lod::to_string(key) << " edge " << static_cast<int>(edge) << " post " << t;
  }
  const lod::Neighbour back = lod::neighbour(next.key, next.edge);
  ASSERT_EQ(back.key, key);
  ASSERT_EQ(back.edge, edge);
  ASSERT_EQ(back.reversed, next.reversed);
}

TEST(TileKey, EveryNeighbourSharesTheEdgesPostsBitForBit) {
  for (int level = 0; level <= 6; ++level) {
    for (const TileKey& key : all_tiles(level)) {
      for (const Edge edge : lod::kEdges) {
        expect_shared_edge(key, edge);
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(TileKey, NeighboursAtTheDeepestLevelsSharePosts) {
  test_support::Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const int level = random.integer(7, lod::kMaxLevel);
    TileKey key = random_tile(random, level);
    if (random.integer(0, 1) == 0) key.i = random.integer(0, 1) * ((1 << level) - 1);
    if (random.integer(0, 1) == 0) key.j = random.integer(0, 1) * ((1 << level) - 1);
    for (const Edge edge : lod::kEdges) {
      expect_shared_edge(key, edge);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(TileKey, ReversedEdgesAreThoseOfTheCubesTurns) {
  // The equatorial faces form a ring. The face of each pole meets four of them; two of its edges run against
  // theirs.
  int reversed = 0;
  for (const TileKey& key : all_tiles(0)) {
    for (const Edge edge : lod::kEdges) reversed += lod::neighbour(key, edge).reversed ? 1 : 0;
  }
  EXPECT_EQ(reversed, 8);
  EXPECT_EQ(lod::neighbour({mars::Face::kPlusX, 3, 7, 2}, Edge::kEast).key,
            (TileKey{mars::Face::kPlusY, 3, 0, 2}));
  EXPECT_EQ(lod::neighbour({mars::Face::kPlusX, 3, 5, 7}, Edge::kNorth).key,
            (TileKey{mars::Face::kPlusZ, 3, 5, 0}));
}

TEST(TileKey, PackIsExactlyInvertibleAndOrdered) {
  for (int level = 0; level <= 4; ++level) {
    std::int64_t last = -1;
    for (int face = 0; face < mars::kFaces; ++face) {
      for (int code = 0; code < 1 << (2 * level); ++code) {
        TileKey key{static_cast<mars::Face>(face), 0, 0, 0};
        for (int shift = 2 * level - 2; shift >= 0; shift -= 2) key = lod::child(key, (code >> shift) & 3);
        const std::int64_t packed = lod::pack(key);
        ASSERT_GT(packed, last) << lod::to_string(key);
        last = packed;
        ASSERT_EQ(lod::unpack(packed), key);
      }
    }
  }
  test_support::Random random(2);
  for (int trial = 0; trial < 10000; ++trial) {
    const TileKey key = random_tile(random, random.integer(0, lod::kMaxLevel));
    ASSERT_EQ(lod::unpack(lod::pack(key)), key);
    ASSERT_GE(lod::pack(key), 0);
  }
}

TEST(TileKey, UnpackRefusesWhatNoTileHas) {
  const TileKey key{mars::Face::kMinusZ, 4, 3, 9};
  EXPECT_FALSE(lod::unpack(-1));
  EXPECT_FALSE(lod::unpack(std::numeric_limits<std::int64_t>::min()));
  EXPECT_FALSE(lod::unpack(std::numeric_limits<std::int64_t>::max()));
  EXPECT_FALSE(lod::unpack(lod::pack(key) + 1));                        // bits below the level
  EXPECT_FALSE(lod::unpack((std::int64_t{6} << 59)));                   // seventh face
  EXPECT_FALSE(lod::unpack((std::int64_t{lod::kMaxLevel + 1} << 54)));  // too deep
  // Each accepted number is exactly one that pack() makes.
  test_support::Random random(3);
  int accepted = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    const auto bits =
        static_cast<std::int64_t>(random.engine()()) & ~((std::int64_t{1} << random.integer(0, 54)) - 1);
    if (const auto found = lod::unpack(bits)) {
      ++accepted;
      ASSERT_TRUE(lod::is_valid(*found));
      ASSERT_EQ(lod::pack(*found), bits);
    }
  }
  EXPECT_GT(accepted, 1000);
}

TEST(TileKey, ValidityNamesTheLimits) {
  EXPECT_TRUE(lod::is_valid({mars::Face::kMinusZ, lod::kMaxLevel, (1 << lod::kMaxLevel) - 1, 0}));
  EXPECT_FALSE(lod::is_valid({mars::Face::kPlusX, lod::kMaxLevel + 1, 0, 0}));
  EXPECT_FALSE(lod::is_valid({mars::Face::kPlusX, -1, 0, 0}));
  EXPECT_FALSE(lod::is_valid({mars::Face::kPlusX, 2, 4, 0}));
  EXPECT_FALSE(lod::is_valid({mars::Face::kPlusX, 2, 0, -1}));
  EXPECT_FALSE(lod::is_valid({static_cast<mars::Face>(6), 0, 0, 0}));
}

TEST(TileKey, FamilyRelationsAgree) {
  test_support::Random random(4);
  for (int trial = 0; trial < 10000; ++trial) {
    const TileKey key = random_tile(random, random.integer(0, lod::kMaxLevel - 1));
    const std::int64_t begin = lod::morton_position(key);
    std::int64_t next = begin;
    for (int index = 0; index < 4; ++index) {
      const TileKey below = lod::child(key, index);
      ASSERT_EQ(lod::parent(below), key);
      ASSERT_EQ(lod::morton_position(below), next);
      next += lod::morton_extent(below.level);
      ASSERT_TRUE(lod::contains(key, below));
      ASSERT_FALSE(lod::contains(below, key));
    }
    ASSERT_EQ(next, begin + lod::morton_extent(key.level));
    const int level = random.integer(0, key.level);
    ASSERT_TRUE(lod::contains(lod::ancestor(key, level), key));
    const TileKey other = random_tile(random, level);
    ASSERT_EQ(lod::contains(other, key), lod::ancestor(key, level) == other);
  }
}

TEST(TileKey, TileAtAgreesWithTheRectangles) {
  test_support::Random random(5);
  for (int trial = 0; trial < 20000; ++trial) {
    const int level = random.integer(0, lod::kMaxLevel);
    const mars::ChartPoint point = mars::chart_point(random.direction());
    const TileKey key = lod::tile_at(point, level);
    ASSERT_TRUE(lod::is_valid(key));
    const mars::ChartRect rect = lod::chart_rect(key);
    ASSERT_LE(rect.u0, point.u);
    ASSERT_LE(rect.v0, point.v);
    ASSERT_TRUE(point.u < rect.u1 || rect.u1 == 1.0);
    ASSERT_TRUE(point.v < rect.v1 || rect.v1 == 1.0);
  }
  // Lines belong to the tile that begins there, the far border of the face to the last tile.
  for (int trial = 0; trial < 20000; ++trial) {
    const int level = random.integer(0, lod::kMaxLevel);
    const TileKey key = random_tile(random, level);
    const mars::ChartRect rect = lod::chart_rect(key);
    ASSERT_EQ(lod::tile_at({key.face, rect.u0, rect.v0}, level), key);
    ASSERT_EQ(lod::tile_at({key.face, std::nextafter(rect.u1, -2.0), std::nextafter(rect.v1, -2.0)}, level),
              key);
    const int last = (1 << level) - 1;
    const TileKey next{key.face, level, std::min(key.i + 1, last), std::min(key.j + 1, last)};
    ASSERT_EQ(lod::tile_at({key.face, rect.u1, rect.v1}, level), next);
  }
  EXPECT_EQ(lod::tile_at({mars::Face::kPlusX, -7.0, 3.0}, 3), (TileKey{mars::Face::kPlusX, 3, 0, 7}));
}

TEST(TileKey, CapHoldsTheTileAndTouchesIt) {
  test_support::Random random(6);
  double widest = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const TileKey key = random_tile(random, random.integer(0, 14));
    const mars::Cap cap = lod::bounding_cap(key);
    const mars::ChartRect rect = lod::chart_rect(key);
    EXPECT_NEAR(glm::length(cap.centre), 1.0, 1e-15);
    for (int sample = 0; sample < 20; ++sample) {
      const double u = random.uniform(rect.u0, rect.u1);
      const glm::dvec3 d = mars::chart_direction(rect.face, u, random.uniform(rect.v0, rect.v1));
      ASSERT_LE(mars::angle_between_rad(d, cap.centre), cap.radius_rad) << lod::to_string(key);
    }
    double farthest = 0;
    for (const double u : {rect.u0, rect.u1}) {
      for (const double v : {rect.v0, rect.v1}) {
        farthest =
            std::max(farthest, mars::angle_between_rad(mars::chart_direction(rect.face, u, v), cap.centre));
      }
    }
    EXPECT_LE(cap.radius_rad, farthest + 2e-15);
    widest = std::max(widest, cap.radius_rad / lod::nominal_side_m(key.level, 1.0));
  }
  EXPECT_LE(widest, lod::kCapPerSide);
}

TEST(TileKey, CapsAreAtMostTheStatedPartOfASide) {
  // One face and the levels around the knots, where the cells are least square, hold the worst.
  double widest = 0;
  for (int level = 0; level <= 7; ++level) {
    for (int j = 0; j < 1 << level; ++j) {
      for (int i = 0; i < 1 << level; ++i) {
        const mars::Cap cap = lod::bounding_cap({mars::Face::kPlusX, level, i, j});
        widest = std::max(widest, cap.radius_rad / lod::nominal_side_m(level, 1.0));
      }
    }
  }
  EXPECT_LE(widest, lod::kCapPerSide);
  EXPECT_GE(widest, 0.95 * lod::kCapPerSide);
}

TEST(TileKey, NamesAreUnique) {
  EXPECT_EQ(lod::to_string({mars::Face::kPlusX, 4, 3, 12}), "+x/4/3/12");
  EXPECT_EQ(lod::to_string({mars::Face::kMinusZ, 0, 0, 0}), "-z/0/0/0");
  std::set<std::string> names;
  for (const TileKey& key : all_tiles(3)) names.insert(lod::to_string(key));
  EXPECT_EQ(names.size(), 384U);
}

}  // namespace
