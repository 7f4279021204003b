#include "objects/levels/mesh_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/ext/scalar_constants.hpp>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

#include "objects/levels/decimation.h"
#include "objects/levels/manifold.h"
#include "objects/model/hausdorff.h"
#include "objects/model/shapes.h"
#include "objects/model/weld.h"
#include "tests/objects/surface_points.h"

namespace objects {
namespace {

using test_support::farthest_sample_m;
using test_support::joined;
using test_support::soup;

constexpr unsigned kLevelsSeed = 20261127;

// What every list of levels keeps to. Samples check the errors.
void expect_sound(const Mesh& mesh, const std::vector<MeshLevel>& levels, std::size_t samples = 20000) {
  ASSERT_FALSE(levels.empty());
  EXPECT_EQ(levels[0].geometric_error_m, 0);
  EXPECT_EQ(levels[0].mesh.positions_m, mesh.positions_m);
  EXPECT_EQ(levels[0].mesh.triangles, mesh.triangles);
  EXPECT_EQ(levels[0].mesh.materials, mesh.materials);
  EXPECT_EQ(levels[0].mesh.textures.size(), mesh.textures.size());
  for (std::size_t n = 0; n < levels.size(); ++n) {
    Mesh level = levels[n].mesh;
    EXPECT_FALSE(levels[n].tree.is_empty());
    if (n > 0) {
      EXPECT_TRUE(level.textures.empty());
      EXPECT_LT(level.triangles.size(), levels[n - 1].mesh.triangles.size());
      EXPECT_GT(levels[n].geometric_error_m, levels[n - 1].geometric_error_m);
      EXPECT_GE(levels[n].geometric_error_m, farthest_sample_m(mesh, level, samples, kLevelsSeed));
      EXPECT_GE(levels[n].geometric_error_m, farthest_sample_m(level, mesh, samples, kLevelsSeed));
      EXPECT_LE(levels[n].geometric_error_m, bounding_ball(mesh).radius_m);
      if (n > 1) {
        EXPECT_GE(levels[n].geometric_error_m,
                  farthest_sample_m(levels[n - 1].mesh, level, samples, kLevelsSeed));
        EXPECT_GE(levels[n].geometric_error_m,
                  farthest_sample_m(level, levels[n - 1].mesh, samples, kLevelsSeed));
      }
    }
    level.textures = mesh.textures;
    EXPECT_EQ(check(level), "");
    EXPECT_EQ(level.normals.empty(), mesh.normals.empty());
    EXPECT_EQ(level.uvs.empty(), mesh.uvs.empty());
    EXPECT_EQ(level.colours.empty(), mesh.colours.empty());
  }
}

std::vector<MeshLevel> sound_levels(const Mesh& mesh, const LevelOptions& options = {}) {
  std::vector<MeshLevel> levels = make_levels(mesh, options);
  expect_sound(mesh, levels);
  return levels;
}

// A sheet of side 1 with n^2 quads, uneven by `height`, whose vertices have texture coordinates (x, y).
Mesh sheet(int n, double height) {
  Mesh mesh;
  mesh.material_table = {Material{}};
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i) / n;
      const double y = static_cast<double>(j) / n;
      mesh.positions_m.emplace_back(glm::dvec3(x, y, height * std::sin(7 * x) * std::sin(9 * y)));
      mesh.uvs.emplace_back(glm::dvec2(x, y));
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  return mesh;
}

double area_of_material(const Mesh& mesh, int material) {
  double sum = 0;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n)
    if (mesh.materials[n] == material) sum += 0.5 * glm::length(area_normal(mesh, n));
  return sum;
}

// Returns the number of triangles of a manifold at edges and fans that are none.
std::size_t faults(const Manifold& manifold) {
  std::size_t found = 0;
  std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
  std::map<std::uint32_t, std::size_t> corners;
  std::map<std::uint32_t, JoinedSets> fans;
  for (const glm::uvec3& t : manifold.triangles)
    for (int k = 0; k < 3; ++k) {
      if (!sides.insert({t[k], t[(k + 1) % 3]}).second) ++found;
      ++corners[t[k]];
    }
  // Around each node, triangles that share an edge are one fan.
  for (const auto& [node, count] : corners) {
    std::vector<glm::uvec3> around;
    for (const glm::uvec3& t : manifold.triangles)
      if (t.x == node || t.y == node || t.z == node) around.push_back(t);
    JoinedSets sets(around.size());
    for (std::size_t a = 0; a < around.size(); ++a)
      for (std::size_t b = a + 1; b < around.size(); ++b)
        for (int k = 0; k < 3; ++k)
          for (int m = 0; m < 3; ++m)
            if (around[a][k] != node && around[a][k] == around[b][m]) sets.join(a, b);
    for (std::size_t a = 0; a < around.size(); ++a)
      if (sets.find(a) != 0) ++found;
  }
  return found;
}

void expect_manifold(const Mesh& mesh, std::size_t triangles) {
  const Manifold manifold = make_manifold(mesh);
  EXPECT_EQ(manifold.triangles.size(), triangles);
  EXPECT_EQ(faults(manifold), 0U);
  for (std::size_t n = 0; n < manifold.triangles.size(); ++n)
    for (int k = 0; k < 3; ++k)
      ASSERT_EQ(mesh.positions_m[manifold.vertex_of[manifold.triangles[n][k]]],
                mesh.positions_m[mesh.triangles[manifold.triangle_of[n]][k]]);
  EXPECT_EQ(Decimation(mesh).triangles(), triangles);
}

TEST(MeshLevels, ASphereGetsCoarserStepByStep) {
  const Mesh ball = make_ellipsoid({1, 1, 1}, 142);
  const std::vector<MeshLevel> levels = sound_levels(ball);
  ASSERT_GE(levels.size(), 5U);
  EXPECT_GT(levels[0].mesh.triangles.size(), 19000U);
  for (std::size_t n = 1; n + 1 < levels.size(); ++n) {
    const double ratio = static_cast<double>(levels[n].mesh.triangles.size()) /
                         static_cast<double>(levels[n - 1].mesh.triangles.size());
    EXPECT_NEAR(ratio, 0.25, 0.02);
  }
  EXPECT_LT(levels[1].geometric_error_m, 0.004);
  EXPECT_LT(levels[2].geometric_error_m, 0.016);
  EXPECT_LT(levels[3].geometric_error_m, 0.07);
  EXPECT_LE(levels.back().mesh.triangles.size(), 24U);
  for (std::size_t n = 0; n < 4; ++n)
    for (std::size_t v = 0; v < levels[n].mesh.positions_m.size(); ++v)
      ASSERT_GT(glm::dot(levels[n].mesh.normals[v], levels[n].mesh.positions_m[v]), 0.9);
}

TEST(MeshLevels, RocksKeepTheirShape) {
  const std::vector<MeshLevel> levels = sound_levels(make_rock(11, 4));
  ASSERT_GE(levels.size(), 4U);
  EXPECT_LT(levels[1].geometric_error_m, 0.02);
  EXPECT_LT(levels[2].geometric_error_m, 0.05);
}

TEST(MeshLevels, FlatPartsVanishWithoutError) {
  Mesh flat = sheet(40, 0);
  const std::vector<MeshLevel> levels = sound_levels(flat, {.least_triangles = 2});
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_EQ(levels[1].mesh.triangles.size(), 2U);
  EXPECT_LT(levels[1].geometric_error_m, 2e-6);
  for (std::size_t v = 0; v < levels[1].mesh.positions_m.size(); ++v)
    EXPECT_EQ(levels[1].mesh.uvs[v], glm::vec2(levels[1].mesh.positions_m[v]));
}

TEST(MeshLevels, TheRatioAndTheEndAreOptions) {
  const Mesh rock = make_rock(1, 3);
  const std::vector<MeshLevel> levels = sound_levels(rock, {.ratio = 0.5, .least_triangles = 200});
  ASSERT_GE(levels.size(), 3U);
  EXPECT_NEAR(static_cast<double>(levels[1].mesh.triangles.size()), 640, 4);
  EXPECT_GE(levels.back().mesh.triangles.size(), 196U);
  EXPECT_THROW(make_levels(rock, {.ratio = 0}), std::invalid_argument);
  EXPECT_THROW(make_levels(rock, {.ratio = 1}), std::invalid_argument);
  EXPECT_THROW(make_levels(rock, {.ratio = std::nan("")}), std::invalid_argument);
}

TEST(MeshLevels, BordersBetweenMaterialsStay) {
  // A disc of another material in an even sheet: only its border shows in the plane.
  Mesh mesh = sheet(60, 0);
  mesh.material_table.resize(2);
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const glm::uvec3& t = mesh.triangles[n];
    const glm::vec3 middle = (mesh.positions_m[t.x] + mesh.positions_m[t.y] + mesh.positions_m[t.z]) / 3.0F;
    mesh.materials[n] = glm::distance(middle, glm::vec3(0.5F, 0.5F, 0)) < 0.3F ? 1 : 0;
  }
  const double disc = area_of_material(mesh, 1);
  Decimation decimation(mesh);
  for (const auto& [triangles, off] : {std::pair{1000U, 0.0}, {400U, 0.02}, {150U, 0.06}, {60U, 0.15}}) {
    decimation.reduce_to(triangles);
    const Mesh coarse = decimation.mesh();
    EXPECT_EQ(check(coarse), "");
    EXPECT_LE(coarse.triangles.size(), triangles);
    EXPECT_NEAR(area_of_material(coarse, 1), disc, off * disc + 1e-6) << triangles;
    EXPECT_NEAR(area_of_material(coarse, 0) + area_of_material(coarse, 1), 1, 1e-6);
  }
}

// A tube whose texture goes around once has a seam: two texture coordinates at each place of it.
TEST(MeshLevels, SeamsOfTexturesStay) {
  constexpr int kAround = 64;
  constexpr int kAlong = 40;
  Mesh mesh;
  mesh.textures.push_back({1, 1, {Rgba{}}});
  mesh.material_table = {Material{.texture = 0}};
  for (int j = 0; j <= kAlong; ++j) {
    for (int i = 0; i <= kAround; ++i) {
      const double angle = 2 * glm::pi<double>() * (i % kAround) / kAround;
      mesh.positions_m.emplace_back(glm::dvec3(std::cos(angle), std::sin(angle), 0.1 * j));
      mesh.uvs.emplace_back(glm::dvec2(static_cast<double>(i) / kAround, 0.1 * j));
    }
  }
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(j * (kAround + 1) + i); };
  for (int j = 0; j < kAlong; ++j) {
    for (int i = 0; i < kAround; ++i) {
      mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  const std::vector<MeshLevel> levels = sound_levels(mesh);
  ASSERT_GE(levels.size(), 4U);
  for (std::size_t n = 1; n < 4; ++n) {
    const Mesh& coarse = levels[n].mesh;
    for (const glm::uvec3& t : coarse.triangles) {
      float least = 1;
      float most = 0;
      for (int k = 0; k < 3; ++k) {
        const glm::vec2& uv = coarse.uvs[t[k]];
        const glm::vec3& p = coarse.positions_m[t[k]];
        const double angle = 2 * glm::pi<double>() * static_cast<double>(uv.x);
        ASSERT_NEAR(p.x, std::cos(angle), 1e-5);
        ASSERT_NEAR(p.y, std::sin(angle), 1e-5);
        ASSERT_NEAR(p.z, uv.y, 1e-5);
        least = std::min(least, uv.x);
        most = std::max(most, uv.x);
      }
      ASSERT_LE(most - least, 0.5F) << "a triangle shows the texture backwards, level " << n;
    }
  }
}

// Each triangle has a colour of its own, so that every edge is a seam.
TEST(MeshLevels, ColoursOfTrianglesStay) {
  const Mesh rock = make_rock(2, 3);
  Mesh mesh;
  mesh.material_table = rock.material_table;
  for (const glm::uvec3& t : rock.triangles) {
    for (int k = 0; k < 3; ++k) {
      mesh.positions_m.push_back(rock.positions_m[t[k]]);
      const auto tone = static_cast<std::uint8_t>(mesh.triangles.size() % 250);
      mesh.colours.push_back({tone, tone, tone, 255});
    }
    const auto first = static_cast<std::uint32_t>(mesh.positions_m.size() - 3);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.materials.push_back(0);
  }
  const std::vector<MeshLevel> levels = sound_levels(mesh);
  ASSERT_GE(levels.size(), 3U);
  for (const glm::uvec3& t : levels[1].mesh.triangles) {
    EXPECT_EQ(levels[1].mesh.colours[t.x], levels[1].mesh.colours[t.y]);
    EXPECT_EQ(levels[1].mesh.colours[t.x], levels[1].mesh.colours[t.z]);
  }
}

TEST(MeshLevels, EdgesOfThreeTrianglesLoseNone) {
  expect_manifold(soup({{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}},
                        {{0, 0, 0}, {0, 0, 1}, {-1, 1, 0}},
                        {{0, 0, 1}, {0, 0, 0}, {-1, -1, 0}}}),
                  3);
  // Three sheets that meet at an edge.
  Mesh mesh = sheet(16, 0.02);
  mesh.uvs.clear();
  Mesh wall = mesh;
  for (glm::vec3& p : wall.positions_m) p = {p.x, p.y * 0, p.y + p.z * 0};
  for (glm::vec3& p : mesh.positions_m) p.z *= p.y;
  Mesh mirrored = mesh;
  for (glm::vec3& p : mirrored.positions_m) p.y = -p.y;
  const Mesh three = joined(joined(mesh, mirrored), wall);
  expect_manifold(three, 3U * 2 * 16 * 16);
  sound_levels(three);
}

TEST(MeshLevels, AMoebiusStripLosesNone) {
  constexpr int kAround = 60;
  Mesh mesh;
  mesh.material_table = {Material{}};
  for (int i = 0; i < kAround; ++i) {
    const double a = 2 * glm::pi<double>() * i / kAround;
    for (const double s : {-0.3, 0.0, 0.3})
      mesh.positions_m.emplace_back(glm::dvec3((1 + s * std::cos(a / 2)) * std::cos(a),
                                               (1 + s * std::cos(a / 2)) * std::sin(a), s * std::sin(a / 2)));
  }
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t s = 0; s < 2; ++s) {
      const bool is_last = i + 1 == kAround;
      const std::uint32_t a = 3 * i + s;
      const std::uint32_t c = is_last ? 2 - s : 3 * (i + 1) + s;
      const std::uint32_t d = is_last ? 1 - s : 3 * (i + 1) + s + 1;
      mesh.triangles.emplace_back(a, c, d);
      mesh.triangles.emplace_back(a, d, a + 1);
    }
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  expect_manifold(mesh, 4U * kAround);
  EXPECT_GE(sound_levels(mesh).size(), 3U);
}

TEST(MeshLevels, RepeatedAndTurnedTrianglesLoseNone) {
  const Mesh rock = make_rock(4, 2);
  const std::size_t count = rock.triangles.size();
  const Mesh twice = joined(rock, rock);
  expect_manifold(twice, 2 * count);
  EXPECT_LT(sound_levels(twice).back().mesh.triangles.size(), count / 4);
  // Both sides of a leaf.
  Mesh front = sheet(12, 0.1);
  front.uvs.clear();
  Mesh back = front;
  for (glm::uvec3& t : back.triangles) std::swap(t.y, t.z);
  const Mesh leaf = joined(front, back);
  expect_manifold(leaf, leaf.triangles.size());
  EXPECT_LT(sound_levels(leaf).back().mesh.triangles.size(), leaf.triangles.size() / 4);
  // Some triangles face the wrong way.
  Mesh turned = rock;
  for (std::size_t n = 0; n < count; n += 17) std::swap(turned.triangles[n].y, turned.triangles[n].z);
  turned.normals.clear();
  expect_manifold(turned, count);
  sound_levels(turned);
}

TEST(MeshLevels, RandomTrianglesOnFewPointsLoseNone) {
  std::mt19937 random(kLevelsSeed);
  for (int n = 0; n < 60; ++n) {
    Mesh mesh;
    mesh.material_table = {Material{}};
    const std::uint32_t points = 4 + static_cast<std::uint32_t>(n) % 9;
    for (std::uint32_t p = 0; p < points; ++p)
      mesh.positions_m.emplace_back(p % 2, p / 2 % 2, static_cast<float>(p) * 0.3F);
    while (mesh.triangles.size() < 10U + 2 * static_cast<unsigned>(n)) {
      const glm::uvec3 t(random() % points, random() % points, random() % points);
      if (t.x != t.y && t.y != t.z && t.z != t.x) mesh.triangles.push_back(t);
    }
    mesh.materials.assign(mesh.triangles.size(), 0);
    expect_manifold(mesh, mesh.triangles.size());
    expect_sound(mesh, make_levels(mesh, {.least_triangles = 1}), 2000);
  }
}

TEST(MeshLevels, SeparateShellsStay) {
  Mesh mesh;
  for (int n = 0; n < 8; ++n)
    append(mesh, make_rock(static_cast<std::uint32_t>(n), 2),
           glm::translate(glm::mat4(1), glm::vec3(1.5F * static_cast<float>(n), 0, 0)), {});
  const std::vector<MeshLevel> levels = sound_levels(mesh);
  ASSERT_GE(levels.size(), 4U);
  // Up to half of their size, as the error says.
  for (const MeshLevel& level : levels) {
    if (level.geometric_error_m > 0.5) continue;
    std::map<int, int> triangles;
    for (const glm::uvec3& t : level.mesh.triangles)
      ++triangles[static_cast<int>(std::lround(level.mesh.positions_m[t.x].x / 1.5F))];
    EXPECT_EQ(triangles.size(), 8U);
  }
  EXPECT_LE(levels[3].mesh.triangles.size(), 50U);
  EXPECT_LT(levels[3].geometric_error_m, 0.5);
}

// A body with bolts, rails, wheels with treads, and a mast.
Mesh make_machine() {
  Mesh mesh;
  const auto add = [&](const Mesh& part, float x, float y, float z, Rgba colour) {
    append(mesh, part, glm::translate(glm::mat4(1), {x, y, z}), colour);
  };
  add(make_box({2, 3, 0.6F}), 0, 0, 0.6F, {200, 200, 200, 255});
  for (int n = 0; n < 120; ++n)
    add(make_box({0.03F, 0.03F, 0.02F}), -0.9F + 0.15F * static_cast<float>(n % 12),
        -1.35F + 0.3F * static_cast<float>(n / 12), 1.2F, {60, 60, 60, 255});
  for (const float side : {-1.0F, 1.0F}) {
    for (int n = 0; n < 3; ++n)
      add(make_ellipsoid({0.15F, 0.4F, 0.4F}, 16), 1.2F * side, -1.1F + 1.1F * static_cast<float>(n), 0.4F,
          {30, 30, 30, 255});
    add(make_box({0.02F, 2.8F, 0.02F}), 1.01F * side, 0, 1.1F, {90, 90, 90, 255});
  }
  add(make_cylinder(0.04F, 1.2F, 16), 0, 1.2F, 1.2F, {220, 220, 220, 255});
  return mesh;
}

// Decimation alone cannot leave any of the parts out.
TEST(MeshLevels, ModelsOfManySmallPartsGetCoarse) {
  const Mesh machine = make_machine();
  const std::vector<MeshLevel> levels = sound_levels(machine);
  ASSERT_GE(levels.size(), 4U);
  EXPECT_LE(levels.back().mesh.triangles.size(), 30U);
  for (std::size_t n = 1; n < 3; ++n) {
    Decimation decimation(machine);
    decimation.reduce_to(levels[n].mesh.triangles.size());
    EXPECT_LT(levels[n].geometric_error_m, 0.5 * hausdorff_bound(machine, decimation.mesh(), 1e-3)) << n;
    EXPECT_LE(static_cast<double>(levels[n].mesh.triangles.size()),
              0.32 * static_cast<double>(levels[n - 1].mesh.triangles.size()));
  }
  // The bolts are the first to go.
  EXPECT_LT(levels[1].geometric_error_m, 0.03);
  // The body keeps its colour to the last.
  double body = 0;
  double all = 0;
  const Mesh& last = levels.back().mesh;
  for (std::size_t t = 0; t < last.triangles.size(); ++t) {
    const double area = glm::length(area_normal(last, t));
    all += area;
    if (last.material_table[last.materials[t]].colour.r == 200) body += area;
  }
  EXPECT_GT(body, 0.5 * all);
}

TEST(MeshLevels, SmallMeshesHaveOneLevel) {
  const Mesh one = soup({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
  EXPECT_EQ(sound_levels(one, {.least_triangles = 0}).size(), 1U);
  EXPECT_EQ(sound_levels(make_box({1, 2, 3})).size(), 1U);
  const Mesh flat = soup({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}});
  EXPECT_EQ(make_levels(flat).size(), 1U);
  const Mesh point = soup({{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}});
  EXPECT_EQ(make_levels(point).size(), 1U);
}

TEST(MeshLevels, TrianglesWithoutAreaVanish) {
  // A far one would count as error if it were seen.
  const Mesh rock = make_rock(6, 3);
  const Mesh mesh = joined(
      rock, soup({{{0, 0, 0}, {5, 5, 5}, {5, 5, 5}}, {{0, 0, 0.5F}, {0.25F, 0, 0.5F}, {0.5F, 0, 0.5F}}}));
  const std::vector<MeshLevel> levels = make_levels(mesh);
  ASSERT_GE(levels.size(), 3U);
  EXPECT_EQ(levels[0].mesh.triangles.size(), mesh.triangles.size());
  for (std::size_t n = 1; n < levels.size(); ++n) {
    EXPECT_EQ(check(levels[n].mesh), "");
    for (std::size_t t = 0; t < levels[n].mesh.triangles.size(); ++t)
      EXPECT_GT(glm::length(area_normal(levels[n].mesh, t)), 0);
  }
  EXPECT_LT(levels[1].geometric_error_m, 0.05);
}

TEST(MeshLevels, SizeAndPlaceDoNotMatter) {
  const Mesh rock = make_rock(9, 3);
  const std::vector<MeshLevel> levels = make_levels(rock);
  for (const float scale : {0x1p-20F, 0x1p20F}) {
    Mesh mesh = rock;
    for (glm::vec3& p : mesh.positions_m) p *= scale;
    const std::vector<MeshLevel> scaled = make_levels(mesh);
    ASSERT_EQ(scaled.size(), levels.size());
    for (std::size_t n = 0; n < levels.size(); ++n)
      EXPECT_NEAR(scaled[n].geometric_error_m / static_cast<double>(scale), levels[n].geometric_error_m,
                  0.3 * levels[n].geometric_error_m);
  }
}

TEST(MeshLevels, TwiceIsTheSame) {
  Mesh mesh = sheet(30, 0.1);
  mesh.colours.assign(mesh.positions_m.size(), Rgba{1, 2, 3, 255});
  const std::vector<MeshLevel> a = make_levels(mesh);
  const std::vector<MeshLevel> b = make_levels(mesh);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_EQ(a[n].geometric_error_m, b[n].geometric_error_m);
    EXPECT_EQ(a[n].mesh.positions_m, b[n].mesh.positions_m);
    EXPECT_EQ(a[n].mesh.triangles, b[n].mesh.triangles);
    EXPECT_EQ(a[n].mesh.uvs, b[n].mesh.uvs);
    EXPECT_EQ(a[n].mesh.colours, b[n].mesh.colours);
    EXPECT_EQ(a[n].mesh.normals, b[n].mesh.normals);
  }
}

}  // namespace
}  // namespace objects
