#include "objects/levels/mesh_parts.h"

#include <gtest/gtest.h>

#include <glm/ext/matrix_transform.hpp>
#include <set>

#include "objects/model/shapes.h"
#include "tests/objects/surface_points.h"

namespace objects {
namespace {

using test_support::joined;
using test_support::soup;

Mesh box_at(const glm::vec3& size_m, const glm::vec3& foot_m, Rgba colour = {}) {
  Mesh mesh;
  append(mesh, make_box(size_m), glm::translate(glm::mat4(1), foot_m), colour);
  return mesh;
}

// A plate with a rod that lies on it, and one that stands on it.
Mesh plate_with_rods() {
  Mesh mesh = box_at({4, 4, 0.5F}, {0, 0, 0}, {1, 0, 0, 255});
  append(mesh, make_box({3, 0.1F, 0.1F}), glm::translate(glm::mat4(1), {0, 1, 0.5F}), {2, 0, 0, 255});
  append(mesh, make_box({0.1F, 0.1F, 2}), glm::translate(glm::mat4(1), {1, -1, 0.5F}), {3, 0, 0, 255});
  return mesh;
}

TEST(MeshParts, PartsAreWhatCommonPositionsJoin) {
  const Mesh apart = soup({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}}});
  const MeshParts two = find_parts(apart);
  EXPECT_EQ(two.count, 2U);
  EXPECT_EQ(two.of, (std::vector<std::uint32_t>{0, 1}));
  // Triangles of a file have corners of their own; one place joins.
  const MeshParts one = find_parts(joined(apart, soup({{{0, 1, 0}, {5, 1, 0}, {3, 3, 3}}})));
  EXPECT_EQ(one.count, 1U);
  EXPECT_EQ(find_parts(plate_with_rods()).count, 3U);
  EXPECT_EQ(find_parts(Mesh{}).count, 0U);
}

TEST(MeshParts, PartsWithinTheDistanceAreLeftOut) {
  const Mesh mesh = plate_with_rods();
  EXPECT_EQ(without_near_parts(mesh, 0.05).triangles.size(), 36U);
  const Mesh plain = without_near_parts(mesh, 0.11);
  EXPECT_EQ(plain.triangles.size(), 24U);
  EXPECT_EQ(check(plain), "");
  std::set<int> colours;
  for (const std::uint16_t m : plain.materials) colours.insert(plain.material_table[m].colour.r);
  EXPECT_EQ(colours, (std::set<int>{1, 3}));
  // Only vertices that triangles need are left.
  EXPECT_LT(plain.positions_m.size(), mesh.positions_m.size());
  EXPECT_EQ(without_near_parts(mesh, 2.1).triangles.size(), 12U);
  // The largest one stays at any distance.
  EXPECT_EQ(without_near_parts(mesh, 1e9).triangles.size(), 12U);
}

// What lies near a part that is left out itself, but not near one that stays, stays.
TEST(MeshParts, OnlyPartsThatStayCarryOthers) {
  Mesh mesh = box_at({2, 2, 1}, {0, 0, 0});
  append(mesh, make_box({0.4F, 0.4F, 0.4F}), glm::translate(glm::mat4(1), {0, 0, 1}), {});
  append(mesh, make_box({0.2F, 0.2F, 0.2F}), glm::translate(glm::mat4(1), {0, 0, 1.4F}), {});
  const Mesh plain = without_near_parts(mesh, 0.45);
  EXPECT_EQ(plain.triangles.size(), 24U);
  EXPECT_LT(test_support::farthest_sample_m(mesh, plain, 5000, 1), 0.45);
}

TEST(MeshParts, LooksOfCornersStay) {
  Mesh mesh = plate_with_rods();
  for (std::size_t n = 0; n < mesh.positions_m.size(); ++n) {
    mesh.uvs.emplace_back(mesh.positions_m[n].x, mesh.positions_m[n].y);
    mesh.colours.push_back({static_cast<std::uint8_t>(n), 7, 7, 255});
  }
  const Mesh plain = without_near_parts(mesh, 0.11);
  EXPECT_EQ(check(plain), "");
  EXPECT_TRUE(plain.normals.empty());
  for (std::size_t n = 0; n < plain.positions_m.size(); ++n)
    EXPECT_EQ(plain.uvs[n], glm::vec2(plain.positions_m[n]));
  EXPECT_EQ(plain.colours.size(), plain.positions_m.size());
}

TEST(MeshParts, RepeatedPartsAndTrianglesWithoutAreaVanish) {
  const Mesh rock = make_rock(3, 2);
  Mesh twice = rock;
  twice.normals.clear();
  // The same triangles elsewhere would be joined; these lie on the surface without a common position.
  const glm::uvec3& t = rock.triangles[7];
  const glm::vec3 a = rock.positions_m[t.x], b = rock.positions_m[t.y], c = rock.positions_m[t.z];
  const Mesh more =
      joined(twice, soup({{0.5F * a + 0.25F * (b + c), 0.5F * b + 0.25F * (a + c), 0.5F * c + 0.25F * (a + b)},
                          {0.8F * a + 0.2F * b, 0.8F * a + 0.2F * b, 0.8F * a + 0.2F * b}}));
  EXPECT_EQ(find_parts(more).count, 3U);
  EXPECT_EQ(without_near_parts(more, 1e-6).triangles.size(), rock.triangles.size());
  EXPECT_TRUE(without_near_parts(Mesh{}, 1).triangles.empty());
}

}  // namespace
}  // namespace objects
