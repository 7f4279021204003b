#include "objects/levels/clustering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <limits>

#include "objects/model/shapes.h"
#include "tests/objects/surface_points.h"

namespace objects {
namespace {

using test_support::farthest_sample_m;
using test_support::joined;
using test_support::soup;

constexpr double kDiagonal = 1.7320508075688773;

// A sheet of n^2 quads in the plane z, from 0 to 1, which faces up or down.
Mesh flat_sheet(int n, float z_m, bool faces_up) {
  std::vector<test_support::SoupTriangle> triangles;
  const auto at = [&](int i, int j) {
    return glm::vec3(static_cast<float>(i) / static_cast<float>(n),
                     static_cast<float>(j) / static_cast<float>(n), z_m);
  };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  if (!faces_up)
    for (test_support::SoupTriangle& t : triangles) std::swap(t.b, t.c);
  return soup(triangles);
}

TEST(Clustering, SurfacesStayWithinACell) {
  for (const double cell_m : {0.03, 0.1, 0.25}) {
    const Mesh rock = make_rock(3, 4);
    const Mesh coarse = cluster(rock, cell_m);
    EXPECT_EQ(check(coarse), "");
    EXPECT_LT(coarse.triangles.size(), rock.triangles.size());
    EXPECT_LE(farthest_sample_m(coarse, rock, 20000, 1), kDiagonal * cell_m);
    EXPECT_LE(farthest_sample_m(rock, coarse, 20000, 1), kDiagonal * cell_m);
    // A cell has one place.
    for (std::size_t a = 0; a < coarse.positions_m.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) ASSERT_NE(coarse.positions_m[a], coarse.positions_m[b]);
  }
}

// Places are where planes meet, so that a box keeps its corners.
TEST(Clustering, EdgesAndCornersStay) {
  Mesh box;
  for (const bool up : {false, true}) box = joined(box, flat_sheet(20, up ? 1.0F : 0.0F, up));
  Mesh sides = box;
  for (glm::vec3& p : sides.positions_m) p = {p.y, p.z, p.x};
  Mesh others = box;
  for (glm::vec3& p : others.positions_m) p = {p.z, p.x, p.y};
  box = joined(joined(box, sides), others);
  const Mesh coarse = cluster(box, 0.3);
  EXPECT_LT(coarse.triangles.size(), box.triangles.size() / 10);
  for (int n = 0; n < 8; ++n) {
    const glm::vec3 corner(n & 1, n >> 1 & 1, n >> 2 & 1);
    float nearest = 1;
    for (const glm::vec3& p : coarse.positions_m) nearest = std::min(nearest, glm::distance(p, corner));
    EXPECT_LT(nearest, 0.01F) << n;
  }
}

TEST(Clustering, WhatIsNearIsJoined) {
  // Two balls, a tenth of a cell apart, become one part.
  Mesh mesh = make_ellipsoid({1, 1, 1}, 40);
  append(mesh, make_ellipsoid({1, 1, 1}, 40), glm::translate(glm::mat4(1), {2.05F, 0, 0}), {});
  const Mesh coarse = cluster(mesh, 0.5);
  EXPECT_LT(coarse.triangles.size(), 400U);
  EXPECT_LE(farthest_sample_m(mesh, coarse, 20000, 1), 0.5 * kDiagonal);
}

// Both sides of a thin plate fall together: one of them is enough where both are seen.
TEST(Clustering, SidesOfOneSidedMaterialsStay) {
  Mesh plate = joined(flat_sheet(10, 0, false), flat_sheet(10, 0.01F, true));
  const Mesh both = cluster(plate, 0.3);
  plate.material_table[0].double_sided = false;
  const Mesh each = cluster(plate, 0.3);
  EXPECT_GT(both.triangles.size(), 4U);
  EXPECT_EQ(each.triangles.size(), 2 * both.triangles.size());
}

TEST(Clustering, TheLargestTriangleGivesMaterialAndColours) {
  // The same three cells, a large triangle amid small ones.
  Mesh mesh = soup({{{0.1F, 0.1F, 0}, {1.1F, 0.1F, 0}, {0.1F, 1.1F, 0}},
                    {{-0.3F, -0.3F, 0.05F}, {1.15F, 0, 0.05F}, {0, 1.15F, 0.05F}},
                    {{0.15F, 0.15F, 0}, {1.0F, 0.15F, 0}, {0.15F, 1.0F, 0}}});
  mesh.material_table.resize(3);
  for (std::size_t n = 0; n < 9; ++n) {
    const auto tone = static_cast<std::uint8_t>(10 * n);
    mesh.colours.push_back({tone, tone, tone, 255});
    mesh.uvs.emplace_back(static_cast<float>(n), 0.0F);
  }
  mesh.materials = {0, 1, 2};
  const Mesh coarse = cluster(mesh, 1);
  ASSERT_EQ(coarse.triangles.size(), 1U);
  EXPECT_EQ(coarse.materials[0], 1);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(coarse.colours[coarse.triangles[0][k]].r, 10 * (3 + k));
    EXPECT_EQ(coarse.uvs[coarse.triangles[0][k]].x, static_cast<float>(3 + k));
  }
}

TEST(Clustering, AnyMeshAndAnyCellWillDo) {
  EXPECT_TRUE(cluster(Mesh{}, 1).triangles.empty());
  const Mesh rock = make_rock(1, 1);
  // All in one cell, or in two.
  EXPECT_TRUE(cluster(rock, 100).triangles.empty());
  EXPECT_TRUE(cluster(soup({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}), 0.5).triangles.empty());
  // Cells that are too many or none.
  for (const double cell_m : {1e-9, 0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(cluster(rock, cell_m).triangles, rock.triangles);
  EXPECT_TRUE(cluster(rock, std::numeric_limits<double>::infinity()).triangles.empty());
  std::mt19937 random(7);
  for (int n = 0; n < 20; ++n) {
    const Mesh mesh = test_support::random_soup(random, 50, 1.0F);
    const double cell_m = 0.02 * std::pow(1.3, n);
    const Mesh coarse = cluster(mesh, cell_m);
    if (coarse.triangles.empty()) continue;
    EXPECT_EQ(check(coarse), "");
    EXPECT_LE(farthest_sample_m(coarse, mesh, 2000, 1), 2 * kDiagonal * cell_m);
    const Mesh again = cluster(mesh, cell_m);
    EXPECT_EQ(again.positions_m, coarse.positions_m);
    EXPECT_EQ(again.triangles, coarse.triangles);
  }
  // Sizes of coordinates do not matter.
  Mesh large = rock;
  for (glm::vec3& p : large.positions_m) p *= 0x1p24F;
  EXPECT_EQ(cluster(large, 0.2 * 0x1p24).triangles, cluster(rock, 0.2).triangles);
}

}  // namespace
}  // namespace objects
