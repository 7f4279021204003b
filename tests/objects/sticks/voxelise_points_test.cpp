// Voxels from point clouds, against their definition voxel by voxel.
#include "objects/points/voxelise_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "objects/sticks/build_sticks.h"
#include "tests/objects/sticks/point_shapes.h"

namespace objects {
namespace {

using point_shapes::Place;
using point_shapes::Places;
using point_shapes::places_of;
using point_shapes::voxel_with;

constexpr double kPi = 3.14159265358979;

std::map<Place, StickVoxel> looks_of(const VoxelGrid& voxels) {
  std::map<Place, StickVoxel> looks;
  for (const VoxelGrid::Coloured& c : voxels.coloured()) {
    const glm::ivec3 at = voxels.voxel_of(c.place);
    EXPECT_TRUE(looks.emplace(Place{at.x, at.y, at.z}, c.voxel).second);
  }
  return looks;
}

// Gives random colours, and normals of any length, a few of which are none.
void decorate(Mesh& points, std::uint64_t seed) {
  ::test_support::Random random(seed);
  for (std::size_t n = 0; n < points.positions_m.size(); ++n) {
    const auto byte = [&] { return static_cast<std::uint8_t>(random.integer(0, 255)); };
    const std::uint8_t r = byte();
    const std::uint8_t g = byte();
    points.colours.push_back({r, g, byte(), 255});
  }
  points.normals.clear();
  for (std::size_t n = 0; n < points.positions_m.size(); ++n) {
    const glm::vec3 direction(random.direction());
    points.normals.push_back(n % 9 == 0 ? glm::vec3(0) : (n % 2 == 0 ? 0.1F : 3.0F) * direction);
  }
}

void expect_as_defined(const Mesh& points, int longest, int close) {
  const VoxelGrid voxels = voxelise_points(points, {.voxels_longest = longest, .close_voxels = close});
  const StickGrid& g = voxels.grid();
  EXPECT_EQ(std::max({g.columns_x, g.columns_y, g.height}), longest);
  Places held;
  std::map<Place, std::vector<std::size_t>> members;
  for (std::size_t n = 0; n < points.positions_m.size(); ++n) {
    held.insert(voxel_with(g, points.positions_m[n]));
    members[voxel_with(g, points.positions_m[n])].push_back(n);
  }
  const Places expected = point_shapes::closed(held, g, close);
  ASSERT_EQ(places_of(voxels), expected);

  const std::map<Place, StickVoxel> looks = looks_of(voxels);
  for (const auto& [place, numbers] : members) {
    ASSERT_TRUE(looks.contains(place));
    const StickVoxel& look = looks.at(place);
    glm::dvec3 colour(0);
    glm::dvec3 normal(0);
    int normals = 0;
    for (const std::size_t n : numbers) {
      colour += points.colours.empty()
                    ? glm::dvec3(160)
                    : glm::dvec3(points.colours[n].r, points.colours[n].g, points.colours[n].b);
      if (points.normals.empty() || points.normals[n] == glm::vec3(0)) continue;
      normal += glm::normalize(glm::dvec3(points.normals[n]));
      ++normals;
    }
    colour /= static_cast<double>(numbers.size());
    EXPECT_NEAR(look.colour.r, colour.x, 0.5001);
    EXPECT_NEAR(look.colour.g, colour.y, 0.5001);
    EXPECT_NEAR(look.colour.b, colour.z, 0.5001);
    EXPECT_EQ(look.colour.a, 255);
    const glm::dvec3 stored(look.normal[0], look.normal[1], look.normal[2]);
    EXPECT_NEAR(glm::length(stored), 127, 1.5);
    if (normals == 0 || glm::length(normal) < 0.21 * normals) continue;
    EXPECT_LT(glm::distance(stored / 127.0, glm::normalize(normal)), 0.02);
  }
  // Others, where they can be seen, look like the nearest with points.
  for (const Place& place : expected) {
    if (held.contains(place)) continue;
    bool is_seen = false;
    for (std::size_t k = 0; k < 6; ++k) {
      Place beside = place;
      beside[k / 2] += k % 2 == 0 ? 1 : -1;
      is_seen = is_seen || !expected.contains(beside);
    }
    ASSERT_EQ(looks.contains(place), is_seen);
    if (!is_seen) continue;
    const int reach = point_shapes::distance(held, place);
    ASSERT_LE(reach, 2 * close + 1);
    glm::dvec3 sum(0);
    int count = 0;
    point_shapes::for_each_near(place, reach, [&](const Place& q) {
      if (!held.contains(q)) return;
      const Rgba& c = looks.at(q).colour;
      sum += glm::dvec3(c.r, c.g, c.b);
      ++count;
    });
    const Rgba& c = looks.at(place).colour;
    EXPECT_LT(glm::distance(glm::dvec3(c.r, c.g, c.b), sum / static_cast<double>(count)), 1.0);
  }
}

TEST(VoxelisePoints, AreAsDefined) {
  for (const bool is_decorated : {false, true}) {
    int n = 0;
    for (Mesh points : {point_shapes::sphere_points(500, 1), point_shapes::plane_points(300, 2),
                        point_shapes::ledge_points(120, 3), point_shapes::any_points(150, 4)}) {
      if (is_decorated) decorate(points, 5);
      for (const int close : {0, 1, 2}) {
        SCOPED_TRACE(std::to_string(n) + " " + std::to_string(close));
        expect_as_defined(points, 15 + 4 * n, close);
      }
      ++n;
    }
  }
}

TEST(VoxelisePoints, ASphereIsClosedAndFilled) {
  const int longest = 48;
  const Mesh points = point_shapes::sphere_points(40'000, 11);
  const VoxelGrid voxels = voxelise_points(points, {.voxels_longest = longest});
  const auto edge_m = static_cast<double>(voxels.grid().voxel_m);
  const double volume = static_cast<double>(places_of(voxels).size()) * edge_m * edge_m * edge_m;
  EXPECT_GT(volume, 4.0 / 3.0 * kPi * 0.98);
  EXPECT_LT(volume, 4.0 / 3.0 * kPi * std::pow(1 + 1.5 * edge_m, 3));
  EXPECT_TRUE(voxels.is_set(longest / 2, longest / 2, longest / 2));
  // Few points and no closing leave a shell with holes.
  const Mesh few = point_shapes::sphere_points(3000, 12);
  EXPECT_FALSE(voxelise_points(few, {.voxels_longest = longest, .close_voxels = 0})
                   .is_set(longest / 2, longest / 2, longest / 2));
  EXPECT_TRUE(voxelise_points(few, {.voxels_longest = longest, .close_voxels = 4})
                  .is_set(longest / 2, longest / 2, longest / 2));
}

TEST(VoxelisePoints, TheOrderOfPointsHasNoEffect) {
  ::test_support::Random random(21);
  for (const bool is_decorated : {false, true}) {
    for (Mesh points : {point_shapes::sphere_points(4000, 22), point_shapes::ledge_points(1500, 23),
                        point_shapes::any_points(700, 24)}) {
      points.normals.clear();
      if (is_decorated) decorate(points, 25);
      const VoxelGrid expected = voxelise_points(points, {.voxels_longest = 40, .close_voxels = 2});
      std::vector<std::size_t> order(points.positions_m.size());
      std::iota(order.begin(), order.end(), 0U);
      std::shuffle(order.begin(), order.end(), random.engine());
      Mesh other;
      for (const std::size_t n : order) {
        other.positions_m.push_back(points.positions_m[n]);
        if (!is_decorated) continue;
        other.colours.push_back(points.colours[n]);
        other.normals.push_back(points.normals[n]);
      }
      const VoxelGrid got = voxelise_points(other, {.voxels_longest = 40, .close_voxels = 2});
      EXPECT_EQ(got.grid(), expected.grid());
      EXPECT_EQ(places_of(got), places_of(expected));
      EXPECT_EQ(got.filling, expected.filling);
      ASSERT_EQ(got.coloured().size(), expected.coloured().size());
      for (std::size_t n = 0; n < got.coloured().size(); ++n) {
        ASSERT_EQ(got.coloured()[n].place, expected.coloured()[n].place);
        ASSERT_EQ(got.coloured()[n].voxel, expected.coloured()[n].voxel);
      }
    }
  }
}

TEST(VoxelisePoints, SticksCanBeMadeOfThem) {
  Mesh points = point_shapes::sphere_points(20'000, 31);
  points.colours.assign(points.positions_m.size(), {200, 100, 50, 255});
  const StickModel model = build_sticks(voxelise_points(points, {.voxels_longest = 48}));
  StickHits hits;
  model.cast({{0, 0, 5}, {0, 0, -1}}, 0, std::numeric_limits<float>::infinity(), hits);
  ASSERT_TRUE(hits.has_front);
  EXPECT_NEAR(hits.front.t, 4, 0.1);
  EXPECT_EQ(hits.front.voxel.colour, (Rgba{200, 100, 50, 255}));
  EXPECT_GT(hits.front.voxel.normal[2], 120);
}

TEST(VoxelisePoints, PointsInALineOrPlaneAreKept) {
  Mesh line;
  for (int n = 0; n < 50; ++n) line.positions_m.emplace_back(7, 0.1F * static_cast<float>(n), 3);
  const VoxelGrid voxels = voxelise_points(line, {.voxels_longest = 50, .close_voxels = 0});
  EXPECT_EQ(voxels.grid().columns_y, 50);
  EXPECT_EQ(places_of(voxels).size(), 50U);
  Mesh pair;
  pair.positions_m = {{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(places_of(voxelise_points(pair, {.voxels_longest = 200, .close_voxels = 16})).size(), 2U);
  EXPECT_EQ(places_of(voxelise_points(pair, {.voxels_longest = 1, .close_voxels = 16})).size(), 1U);
}

std::string message_of(const Mesh& points, const VoxelisePointsOptions& options = {}) {
  try {
    voxelise_points(points, options);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(VoxelisePoints, RefusesBadInput) {
  const Mesh good = point_shapes::any_points(20, 41);
  EXPECT_EQ(message_of(good), "");
  EXPECT_NE(message_of(good, {.voxels_longest = 0}), "");
  EXPECT_NE(message_of(good, {.voxels_longest = 1025}).find("1024"), std::string::npos);
  EXPECT_NE(message_of(good, {.close_voxels = -1}), "");
  EXPECT_NE(message_of(good, {.close_voxels = 17}).find("16"), std::string::npos);
  EXPECT_EQ(message_of({}), "it has no point");
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e9F}) {
    Mesh points = good;
    points.positions_m[7].y = bad;
    EXPECT_NE(message_of(points).find("vertex 7"), std::string::npos);
    points = good;
    points.normals.assign(20, {0, 0, 1});
    points.normals[3].z = bad;
    EXPECT_NE(message_of(points).find("normal of vertex 3"), std::string::npos);
  }
  Mesh points = good;
  points.colours.resize(3);
  EXPECT_EQ(message_of(points), "its arrays have different sizes");
  points = good;
  points.triangles = {{0, 1, 2}};
  EXPECT_EQ(message_of(points), "it has more than points");
  points = good;
  points.positions_m.assign(20, {1, 2, 3});
  EXPECT_EQ(message_of(points), "all of its points lie in one place");
}

}  // namespace
}  // namespace objects
