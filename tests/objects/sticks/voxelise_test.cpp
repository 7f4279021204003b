// Voxels from meshes: nothing missed, insides, colours, silhouettes against triangles.
#include "objects/sticks/voxelise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <stdexcept>

#include "objects/model/shapes.h"
#include "objects/sticks/triangle_voxels.h"
#include "tests/objects/sticks/stick_shapes.h"

namespace objects {
namespace {

using stick_shapes::any_direction;
using stick_shapes::kFar;

const Rgba kOchre{180, 120, 60, 255};
const Rgba kGrey{90, 95, 100, 255};
constexpr double kPi = 3.14159265358979;

// A box on six wheels with a mast, a camera and a dish.
Mesh rover_like() {
  Mesh mesh;
  append(mesh, make_box({1.2F, 1.8F, 0.5F}), glm::translate(glm::mat4(1), {0, 0, 0.5F}), kOchre);
  for (int n = 0; n < 6; ++n) {
    const glm::mat4 at = glm::translate(
        glm::mat4(1), {n % 2 == 0 ? -0.75F : 0.55F, -0.7F + 0.7F * static_cast<float>(n / 2), 0.3F});
    append(mesh, make_cylinder(0.3F, 0.2F, 32), glm::rotate(at, glm::radians(90.0F), {0, 1, 0}), kGrey);
  }
  append(mesh, make_cylinder(0.08F, 0.9F, 16), glm::translate(glm::mat4(1), {0.3F, 0.6F, 1.0F}), kGrey);
  append(mesh, make_box({0.4F, 0.25F, 0.25F}), glm::translate(glm::mat4(1), {0.3F, 0.6F, 1.85F}), kOchre);
  append(mesh, make_cone(0.4F, 0.25F, 32), glm::translate(glm::mat4(1), {-0.2F, -0.5F, 1.0F}), kGrey);
  append(mesh, make_torus(0.3F, 0.08F, 32, 16), glm::translate(glm::mat4(1), {-0.2F, 0.5F, 1.15F}), kOchre);
  return mesh;
}

glm::ivec3 voxel_at(const StickGrid& g, const glm::dvec3& p) {
  return glm::ivec3(glm::floor((p - glm::dvec3(g.corner_m)) / static_cast<double>(g.voxel_m)));
}

void expect_conservative(const Mesh& mesh, int voxels_longest, unsigned seed) {
  const VoxelGrid voxels = voxelise(mesh, {}, {.voxels_longest = voxels_longest});
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const glm::uvec3 t = mesh.triangles[n];
    const glm::dvec3 a(mesh.positions_m[t.x]);
    const glm::dvec3 b(mesh.positions_m[t.y]);
    const glm::dvec3 c(mesh.positions_m[t.z]);
    for (int k = 0; k < 60; ++k) {
      double u = k < 3 ? (k == 1 ? 1.0 : 0.0) : any(random);
      double v = k < 3 ? (k == 2 ? 1.0 : 0.0) : any(random);
      if (k % 5 == 3) v = 0;
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const glm::ivec3 at = voxel_at(voxels.grid(), a + u * (b - a) + v * (c - a));
      ASSERT_TRUE(voxels.is_set(at.x, at.y, at.z))
          << "triangle " << n << " at " << at.x << " " << at.y << " " << at.z;
    }
  }
}

TEST(Voxelise, NoTriangleIsMissed) {
  expect_conservative(rover_like(), 90, 1);
  expect_conservative(make_rock(3, 4), 64, 2);
  expect_conservative(make_torus(2, 0.7F, 40, 20), 200, 3);
  expect_conservative(make_ellipsoid({1, 0.2F, 3}, 60), 7, 4);
  expect_conservative(make_box({1, 1, 1}), 1, 5);
  Mesh far_away;
  append(far_away, make_rock(8, 3), glm::translate(glm::mat4(1), {3000, -7000, 150}), kGrey);
  expect_conservative(far_away, 128, 6);
}

TEST(Voxelise, NarrowTrianglesAreNotMissed) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> any(-1, 1);
  Mesh mesh;
  mesh.material_table.resize(1);
  for (unsigned n = 0; n < 40; ++n) {
    const glm::vec3 a(any(random), any(random), any(random));
    const glm::vec3 b(any(random), any(random), any(random));
    const float width = std::pow(10.0F, -1.0F - static_cast<float>(n % 5));
    mesh.positions_m.insert(mesh.positions_m.end(),
                            {a, b, b + width * glm::vec3(any(random), any(random), any(random))});
    mesh.triangles.push_back({3 * n, 3 * n + 1, 3 * n + 2});
    mesh.materials.push_back(0);
  }
  expect_conservative(mesh, 300, 10);
}

TEST(Voxelise, NoVoxelIsFarFromATriangle) {
  const VoxelTriangle t{glm::dvec3(1.3, 2.2, 3.1), glm::dvec3(28.4, 9.1, 14.6), glm::dvec3(6.6, 30.2, 20.9)};
  std::vector<glm::ivec3> touched;
  append_voxels(t, {32, 32, 32}, touched);
  double area = 0;
  for (const glm::ivec3& at : touched) {
    const double part = area_in_voxel(t, at);
    EXPECT_GE(part, 0);
    area += part;
    const auto [u, v] = nearest_weights(t, glm::dvec3(at) + 0.5);
    const glm::dvec3 near = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
    EXPECT_LT(glm::distance(near, glm::dvec3(at) + 0.5), 0.5 * std::sqrt(3.0) + 1e-6);
  }
  EXPECT_NEAR(area, 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0])), 1e-6 * area);
}

TEST(Voxelise, AFilledSphereHasItsVolume) {
  const Mesh ball = make_ellipsoid({1, 1, 1}, 96);
  for (const int longest : {40, 120}) {
    const VoxelGrid voxels = voxelise(ball, {}, {.voxels_longest = longest});
    double count = 0;
    for (std::size_t column = 0; column < voxels.columns(); ++column)
      for_each_stretch(voxels.bits(column), [&](int begin, int end) { count += end - begin; });
    const auto edge_m = static_cast<double>(voxels.grid().voxel_m);
    const double volume = count * edge_m * edge_m * edge_m;
    EXPECT_GT(volume, 4.0 / 3.0 * kPi * 0.99);
    EXPECT_LT(volume, 4.0 / 3.0 * kPi * std::pow(1 + edge_m, 3));
    EXPECT_TRUE(voxels.is_set(longest / 2, longest / 2, longest / 2));
  }
}

TEST(Voxelise, OpenShellsStayHollow) {
  Mesh bowl = make_box({1, 1, 1});
  Mesh open = bowl;
  open.triangles.clear();
  open.materials.clear();
  for (std::size_t n = 0; n < bowl.triangles.size(); ++n) {
    const glm::uvec3 t = bowl.triangles[n];
    const bool is_lid =
        bowl.positions_m[t.x].z > 0.9F && bowl.positions_m[t.y].z > 0.9F && bowl.positions_m[t.z].z > 0.9F;
    if (is_lid) continue;
    open.triangles.push_back(t);
    open.materials.push_back(0);
  }
  EXPECT_FALSE(voxelise(open, {}, {.voxels_longest = 32}).is_set(16, 16, 16));
  EXPECT_TRUE(voxelise(bowl, {}, {.voxels_longest = 32}).is_set(16, 16, 16));
}

TEST(Voxelise, ColoursAreThoseOfTheSurface) {
  Mesh mesh;
  append(mesh, make_box({2, 2, 1}), glm::mat4(1), kOchre);
  append(mesh, make_box({2, 2, 1}), glm::translate(glm::mat4(1), {0, 0, 1.0F}), kGrey);
  const StickModel model = build_sticks(voxelise(mesh, {}, {.voxels_longest = 50}));
  std::mt19937 random(12);
  StickHits hits;
  for (int n = 0; n < 2000; ++n) {
    const glm::vec3 d(any_direction(random));
    model.cast({glm::vec3(0, 0, 1) - d * 8.0F, d}, 0, kFar, hits);
    ASSERT_TRUE(hits.has_front);
    const glm::vec3 at = glm::vec3(0, 0, 1) + d * (hits.front.t - 8.0F);
    if (std::abs(at.z - 1) < 0.05F) continue;
    EXPECT_EQ(hits.front.voxel.colour, at.z < 1 ? kOchre : kGrey);
    // Where only one side of the box passes, the normal is that of the side.
    const glm::vec3 side = glm::abs(at - glm::vec3(0, 0, 1));
    const int steep = side.x > side.y ? (side.x > side.z ? 0 : 2) : (side.y > side.z ? 1 : 2);
    glm::vec3 rest = side;
    rest[steep] = 0;
    if (std::max({rest.x, rest.y, rest.z}) > 0.9F) continue;
    EXPECT_NEAR(hits.front.voxel.normal[steep], at[steep] - (steep == 2 ? 1.0F : 0.0F) > 0 ? 127 : -127, 1);
  }
}

// A square of two triangles at z = 0, texture coordinates from 0 to 1.
Mesh square(const Material& material) {
  Mesh mesh;
  mesh.positions_m = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials = {0, 0};
  mesh.material_table = {material};
  return mesh;
}

TEST(Voxelise, HolesOfMasksLeaveNoVoxels) {
  Texture texture{64, 64, {}};
  for (int n = 0; n < 64 * 64; ++n)
    texture.texels.push_back({100, 50, 25, static_cast<std::uint8_t>(n % 64 < 32 ? 255 : 0)});
  const std::vector<TexturePyramid> textures{TexturePyramid(texture)};
  const VoxelGrid voxels =
      voxelise(square({.colour = {255, 255, 255, 255}, .texture = 0, .alpha = AlphaMode::kMask}), textures,
               {.voxels_longest = 32});
  EXPECT_EQ(voxels.grid().height, 1);
  EXPECT_TRUE(voxels.is_set(8, 16, 0));
  EXPECT_FALSE(voxels.is_set(24, 16, 0));
  EXPECT_NEAR(static_cast<double>(voxels.coloured().size()), 32 * 16, 2 * 32);
}

TEST(Voxelise, BlendedTrianglesMakeSemiTransparentVoxels) {
  const VoxelGrid pane =
      voxelise(square({.colour = {0, 0, 255, 80}, .alpha = AlphaMode::kBlend}), {}, {.voxels_longest = 16});
  ASSERT_EQ(pane.coloured().size(), 256U);
  EXPECT_EQ(pane.coloured()[77].voxel.colour, (Rgba{0, 0, 255, 80}));
  EXPECT_EQ(std::abs(pane.coloured()[77].voxel.normal[2]), 127);
  Mesh dome = make_ellipsoid({1, 1, 1}, 32);
  dome.material_table[0] = {.colour = {0, 0, 255, 80}, .alpha = AlphaMode::kBlend};
  const VoxelGrid glass = voxelise(dome, {}, {.voxels_longest = 32});
  EXPECT_FALSE(glass.is_set(16, 16, 16));  // one can look inside
  StickHits hits;
  build_sticks(glass).cast({{0.01F, 0.02F, 5}, {0, 0, -1}}, 0, kFar, hits);
  EXPECT_FALSE(hits.has_front);
  EXPECT_EQ(hits.layers.size(), 2U);
}

TEST(Voxelise, SheetsKeepANormal) {
  Mesh sheet = square({});
  sheet.triangles.insert(sheet.triangles.end(), {{0, 2, 1}, {0, 3, 2}});  // and its back
  sheet.materials.resize(4, 0);
  const VoxelGrid voxels = voxelise(sheet, {}, {.voxels_longest = 8});
  ASSERT_EQ(voxels.coloured().size(), 64U);
  for (const VoxelGrid::Coloured& c : voxels.coloured()) EXPECT_EQ(std::abs(c.voxel.normal[2]), 127);
}

// Returns the share of pixels that both show, of those that either shows: parallel rays on a square of 200 pixels.
double silhouettes_iou(const Mesh& mesh, const StickModel& model, const glm::vec3& d, bool covers = true) {
  const TriangleTree tree(mesh);
  const Ball ball = bounding_ball(mesh);
  const glm::vec3 right =
      glm::normalize(glm::cross(d, std::abs(d.z) < 0.9F ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0)));
  const glm::vec3 up = glm::cross(right, d);
  StickHits hits;
  int both = 0;
  int either = 0;
  for (int n = 0; n < 200 * 200; ++n) {
    const float u = (static_cast<float>(n % 200) - 99.5F) / 100.0F * ball.radius_m;
    const float v = (static_cast<float>(n / 200) - 99.5F) / 100.0F * ball.radius_m;
    const ModelRay ray{ball.centre_m + right * u + up * v - d * (2 * ball.radius_m), d};
    const bool is_a = tree.nearest(ray, kFar, [](const TriangleHit&) { return true; }).has_value();
    model.cast(ray, 0, kFar, hits);
    both += is_a && hits.has_front ? 1 : 0;
    either += is_a || hits.has_front ? 1 : 0;
    if (covers) {
      EXPECT_FALSE(is_a && !hits.has_front) << n;
    }  // voxels miss nothing
  }
  return static_cast<double>(both) / either;
}

TEST(Voxelise, SilhouettesAgreeWithTriangles) {
  std::mt19937 random(21);
  const Mesh ball = make_ellipsoid({1, 1, 1}, 64);
  const StickModel ball_sticks = build_sticks(voxelise(ball, {}, {.voxels_longest = 512}));
  const Mesh rover = rover_like();
  const StickModel rover_sticks = build_sticks(voxelise(rover, {}, {.voxels_longest = 512}));
  for (int n = 0; n < 4; ++n) {
    const glm::vec3 d = n == 0   ? glm::vec3(0, 1, 0)
                        : n == 1 ? glm::vec3(0, 0, -1)
                                 : glm::vec3(any_direction(random));
    EXPECT_GE(silhouettes_iou(ball, ball_sticks, d), 0.99) << n;
    EXPECT_GE(silhouettes_iou(rover, rover_sticks, d), 0.985) << n;  // a voxel larger all around
  }
}

TEST(Voxelise, TightVoxelsAreNoLargerThanTheMesh) {
  const Mesh ball = make_ellipsoid({1, 1, 1}, 96);
  const StickModel model = build_sticks(voxelise(ball, {}, {.voxels_longest = 256, .is_tight = true}));
  const auto edge_m = static_cast<double>(model.levels()[0].grid.voxel_m);
  const double volume =
      static_cast<double>(stick_shapes::count_voxels(model.levels()[0])) * edge_m * edge_m * edge_m;
  EXPECT_NEAR(volume, 4.0 / 3.0 * kPi, 0.01 * volume);
  const Mesh rover = rover_like();
  const StickModel sticks = build_sticks(voxelise(rover, {}, {.voxels_longest = 512, .is_tight = true}));
  std::mt19937 random(22);
  for (int n = 0; n < 3; ++n) {
    const glm::vec3 d(any_direction(random));
    EXPECT_GE(silhouettes_iou(ball, model, d, false), 0.99) << n;
    EXPECT_GE(silhouettes_iou(rover, sticks, d, false), 0.99) << n;
  }
  StickHits hits;
  model.cast({{0.1F, 0.2F, 9}, {0, 0, -1}}, 0, kFar, hits);
  ASSERT_TRUE(hits.has_front);
  EXPECT_EQ(hits.front.voxel.colour, ball.material_table[0].colour);
}

TEST(Voxelise, TightVoxelsKeepThinSheets) {
  std::mt19937 random(23);
  for (int n = 0; n < 12; ++n) {
    const float thickness = n % 2 == 0 ? 0.004F : 0.0001F;  // voxels are 8 mm
    Mesh plate;
    append(plate, make_box({1, 0.8F, thickness}),
           glm::rotate(glm::mat4(1), 0.35F * static_cast<float>(n), glm::vec3(any_direction(random))), kGrey);
    const StickModel model = build_sticks(voxelise(plate, {}, {.voxels_longest = 128, .is_tight = true}));
    const TriangleTree tree(plate);
    StickHits hits;
    int seen = 0;
    int missed = 0;
    for (int k = 0; k < 3000; ++k) {
      const glm::vec3 d(any_direction(random));
      const ModelRay ray{glm::vec3(any_direction(random)) * 0.2F - d * 4.0F, d};
      if (!tree.nearest(ray, kFar, [](const TriangleHit&) { return true; })) continue;
      ++seen;
      model.cast(ray, 0, kFar, hits);
      missed += hits.has_front ? 0 : 1;
    }
    EXPECT_GT(seen, 500);
    EXPECT_LT(missed, seen / 50) << n << " of " << seen;
  }
}

TEST(Voxelise, RefusesOptionsOutOfRange) {
  EXPECT_THROW(voxelise(make_box({1, 1, 1}), {}, {.voxels_longest = 0}), std::invalid_argument);
  EXPECT_THROW(voxelise(make_box({1, 1, 1}), {}, {.voxels_longest = 1025}), std::invalid_argument);
}

TEST(Voxelise, MeshesWithoutAreaAreHarmless) {
  Mesh dot;
  dot.positions_m = {{1, 2, 3}};
  dot.triangles = {{0, 0, 0}};
  dot.materials = {0};
  dot.material_table.resize(1);
  EXPECT_TRUE(voxelise(dot, {}, {.voxels_longest = 8}).coloured().empty());
}

}  // namespace
}  // namespace objects
