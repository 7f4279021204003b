#include "objects/model/shapes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/ext/scalar_constants.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "objects/model/normals.h"
#include "objects/model/weld.h"

namespace objects {
namespace {

constexpr double kPi = glm::pi<double>();

// Each edge has two triangles, which run along it in opposite directions.
bool is_closed(const Mesh& mesh) {
  const std::vector<EdgeUse> uses = edge_uses(mesh, weld(mesh));
  bool is_so = uses.size() == 3 * mesh.triangles.size();
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    is_so = is_so && last - first == 2 && uses[first].is_forward != uses[first + 1].is_forward;
  });
  return is_so;
}

double volume_m3(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n)
    sum += glm::dot(glm::dvec3(mesh.positions_m[mesh.triangles[n].x]), area_normal(mesh, n)) / 6;
  return sum;
}

double area_m2(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) sum += 0.5 * glm::length(area_normal(mesh, n));
  return sum;
}

std::pair<glm::vec3, glm::vec3> box_of(const Mesh& mesh) {
  glm::vec3 low(std::numeric_limits<float>::max());
  glm::vec3 high(std::numeric_limits<float>::lowest());
  for (const glm::vec3& p : mesh.positions_m) low = glm::min(low, p), high = glm::max(high, p);
  return {low, high};
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float by) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], by);
}

// The inscribed shapes miss at most `missing` of volume and area.
void expect_shape(const Mesh& mesh, double volume, double area, double missing) {
  EXPECT_EQ(check(mesh), "");
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_LE(volume_m3(mesh), volume * (1 + 1e-6));
  EXPECT_GE(volume_m3(mesh), volume * (1 - missing));
  EXPECT_LE(area_m2(mesh), area * (1 + 1e-6));
  EXPECT_GE(area_m2(mesh), area * (1 - missing));
  ASSERT_EQ(mesh.normals.size(), mesh.positions_m.size());
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 normal(mesh.normals[mesh.triangles[n][k]]);
      ASSERT_NEAR(glm::length(normal), 1, 1e-6);
      ASSERT_GT(glm::dot(normal, glm::normalize(area_normal(mesh, n))), 0.55);  // least at the tip of a cone
    }
  }
}

TEST(Shapes, BoxesStandOnTheGround) {
  const Mesh box = make_box({1, 2, 3});
  expect_shape(box, 6, 22, 1e-6);
  EXPECT_EQ(box.triangles.size(), 12U);
  expect_near(box_of(box).first, {-0.5F, -1, 0}, 0);
  expect_near(box_of(box).second, {0.5F, 1, 3}, 0);
}

TEST(Shapes, EllipsoidsAreAroundTheOrigin) {
  const Mesh ball = make_ellipsoid({2, 2, 2}, 96);
  expect_shape(ball, 4.0 / 3 * kPi * 8, 4 * kPi * 4, 3e-3);
  for (std::size_t n = 0; n < ball.positions_m.size(); ++n) {
    ASSERT_NEAR(glm::length(ball.positions_m[n]), 2, 1e-6);
    ASSERT_GT(glm::dot(ball.normals[n], ball.positions_m[n] / 2.0F), 0.999);
  }
  const Mesh egg = make_ellipsoid({1, 2, 3}, 64);
  EXPECT_TRUE(is_closed(egg));
  EXPECT_NEAR(volume_m3(egg), 4.0 / 3 * kPi * 6, 0.2);
  expect_near(box_of(egg).first, {-1, -2, -3}, 1e-6F);
  expect_near(box_of(egg).second, {1, 2, 3}, 1e-6F);
  for (const int segments : {-1, 4, 5, 6, 7}) EXPECT_TRUE(is_closed(make_ellipsoid({1, 1, 1}, segments)));
}

TEST(Shapes, CylindersAndConesStandOnTheGround) {
  expect_shape(make_cylinder(2, 5, 100), kPi * 4 * 5, 2 * kPi * 4 + 2 * kPi * 2 * 5, 1e-3);
  expect_shape(make_cone(3, 4, 100), kPi * 9 * 4 / 3, kPi * 9 + kPi * 3 * 5, 1e-3);
  for (const Mesh& mesh : {make_cylinder(2, 5, 100), make_cone(2, 5, 100)}) {
    expect_near(box_of(mesh).first, {-2, -2, 0}, 1e-6F);
    expect_near(box_of(mesh).second, {2, 2, 5}, 1e-6F);
  }
  for (const int segments : {0, 3, 4}) {
    EXPECT_TRUE(is_closed(make_cylinder(1, 1, segments)));
    EXPECT_TRUE(is_closed(make_cone(1, 1, segments)));
  }
}

TEST(Shapes, ToriAreRings) {
  const Mesh torus = make_torus(3, 1, 120, 80);
  expect_shape(torus, 2 * kPi * kPi * 3, 4 * kPi * kPi * 3, 3e-3);
  expect_near(box_of(torus).second, {4, 4, 1}, 1e-6F);
  EXPECT_EQ(torus.triangles.size(), 2U * 120 * 80);
  EXPECT_TRUE(is_closed(make_torus(2, 1, 1, 1)));
}

TEST(Shapes, SharpEdgesStaySharp) {
  const Mesh box = make_box({1, 1, 1});
  EXPECT_EQ(box.positions_m.size(), 24U);
  for (const glm::vec3& n : box.normals) EXPECT_EQ(std::abs(n.x) + std::abs(n.y) + std::abs(n.z), 1);
  // The rim has two normals at each place, the caps' middles have one.
  EXPECT_EQ(make_cylinder(1, 1, 24).positions_m.size(), 2U + 4 * 24);
}

TEST(Shapes, RocksAreBlocksOfAMetre) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const Mesh rock = make_rock(seed, 4);
    EXPECT_EQ(check(rock), "");
    EXPECT_TRUE(is_closed(rock)) << seed;
    EXPECT_EQ(rock.triangles.size(), 20U * 256);
    const auto [low, high] = box_of(rock);
    const glm::vec3 size = high - low;
    EXPECT_NEAR(std::max({size.x, size.y, size.z}), 1, 1e-6);
    EXPECT_GT(std::min({size.x, size.y, size.z}), 0.35);
    EXPECT_LT(size.z, 0.9);
    EXPECT_EQ(low.z, 0);
    EXPECT_NEAR(low.x + high.x, 0, 1e-6);
    EXPECT_NEAR(low.y + high.y, 0, 1e-6);
    EXPECT_GT(volume_m3(rock), 0.1) << seed;
    EXPECT_LT(volume_m3(rock), 0.65) << seed;
  }
  EXPECT_EQ(make_rock(1, -3).triangles.size(), 20U);
  EXPECT_NE(make_rock(1, 1).positions_m, make_rock(2, 1).positions_m);
}

// The same bits on every machine.
TEST(Shapes, RocksAreTheSameEverywhere) {
  const auto hash_of = [](const Mesh& mesh) {
    std::uint64_t hash = 14695981039346656037U;
    for (const glm::vec3& p : mesh.positions_m)
      for (int k = 0; k < 3; ++k) hash = (hash ^ std::bit_cast<std::uint32_t>(p[k])) * 1099511628211U;
    return hash;
  };
  EXPECT_EQ(hash_of(make_rock(7, 3)), 5846979454178726072U);
  EXPECT_EQ(hash_of(make_rock(2026, 4)), 4287275973361683097U);
}

TEST(Shapes, PartsAreAppendedAtTheirPlaces) {
  constexpr Rgba kBrown{120, 90, 60, 255};
  constexpr Rgba kGreen{40, 110, 50, 255};
  Mesh tree;
  append(tree, make_cylinder(0.1F, 2, 24), glm::mat4(1), kBrown);
  append(tree, make_cone(1, 3, 24), glm::translate(glm::mat4(1), {0, 0, 2}), kGreen);
  append(tree, make_cone(0.5F, 1, 24), glm::translate(glm::mat4(1), {0, 0, 5}), kGreen);
  EXPECT_EQ(check(tree), "");
  ASSERT_EQ(tree.material_table.size(), 2U);
  EXPECT_EQ(tree.material_table[0].colour, kBrown);
  EXPECT_EQ(tree.material_table[1].colour, kGreen);
  EXPECT_EQ(tree.materials.front(), 0);
  EXPECT_EQ(tree.materials.back(), 1);
  EXPECT_EQ(box_of(tree).second.z, 6);
  EXPECT_EQ(tree.triangles.size(), 4U * 24 + 2 * 24 + 2 * 24);
}

TEST(Shapes, MirroredAndSqueezedPartsStayRightSideOut) {
  const Mesh cone = make_cone(1, 2, 32);
  Mesh mesh;
  append(mesh, cone, glm::scale(glm::mat4(1), {1, -3, 0.5F}), {});
  EXPECT_EQ(check(mesh), "");
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(volume_m3(mesh), 1.5 * volume_m3(cone), 1e-5);
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n)
    for (int k = 0; k < 3; ++k)
      ASSERT_GT(glm::dot(glm::dvec3(mesh.normals[mesh.triangles[n][k]]), area_normal(mesh, n)), 0);
}

TEST(Shapes, AppendedArraysFit) {
  Mesh flat = make_box({1, 1, 1});
  flat.normals.clear();
  flat.colours.assign(flat.positions_m.size(), Rgba{1, 2, 3, 255});
  flat.uvs.assign(flat.positions_m.size(), glm::vec2(0.5F));
  append(flat, make_cone(1, 1, 8), glm::mat4(1), {});
  EXPECT_EQ(check(flat), "");
  EXPECT_EQ(flat.normals.size(), flat.positions_m.size());
  Mesh smooth = make_cone(1, 1, 8);
  Mesh part = make_box({1, 1, 1});
  part.normals.clear();
  append(smooth, part, glm::mat4(1), {});
  EXPECT_EQ(check(smooth), "");
  EXPECT_EQ(smooth.normals.size(), smooth.positions_m.size());
}

}  // namespace
}  // namespace objects
