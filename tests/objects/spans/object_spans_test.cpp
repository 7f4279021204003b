// Stretches of rays in the objects of a scene: turned, mirrored, scaled, far above; sticks of meshes against
// the meshes.
#include "objects/draw/object_spans.h"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>

#include "objects/sticks/build_sticks.h"
#include "objects/sticks/voxelise.h"
#include "tests/objects/spans/line_oracle.h"
#include "tests/objects/volumes/volume_shapes.h"
#include "tests/support/support.h"
#include "tests/support/worst.h"

namespace objects {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kRadius_m = 3396190;

std::shared_ptr<const Model> mesh_model(const Mesh& mesh) {
  std::vector<MeshLevel> levels(1);
  levels[0].mesh = mesh;
  levels[0].tree = TriangleTree(mesh);
  return std::make_shared<const Model>("mesh", std::move(levels));
}

std::shared_ptr<const Model> stick_model(const Mesh& mesh, const VoxeliseOptions& options) {
  return std::make_shared<const Model>(
      "sticks", std::make_shared<const StickModel>(build_sticks(voxelise(mesh, {}, options))));
}

glm::dmat3 turned(const Instance& i) {
  glm::dmat3 m = glm::mat3_cast(glm::normalize(glm::dquat(i.rotation))) * static_cast<double>(i.scale);
  if (i.is_mirrored) m[0] = -m[0];
  return m;
}

Instance random_instance(test_support::Random& random, double radius_m) {
  Instance i;
  i.position_m = radius_m * random.direction();
  const glm::dvec3 axis = random.direction();
  i.rotation = glm::quat(glm::angleAxis(random.uniform(0, 3.14), axis));
  i.scale = static_cast<float>(random.log_uniform(0.1, 10));
  i.is_mirrored = random.integer(0, 1) == 1;
  return i;
}

TEST(ObjectSpans, ListsEachObjectOnTheWay) {
  const auto box = mesh_model(make_box({2, 2, 2}));
  std::vector<Instance> instances(3);
  instances[0].position_m = {0.1, 0, kRadius_m + 10};
  instances[1].position_m = {0.1, 0, kRadius_m + 11};  // in the first one
  instances[1].scale = 3;
  instances[2].position_m = {0, 0, kRadius_m + 1e7};
  const Scene scene({box}, instances);
  const auto spans = object_spans(scene, {{0, 0, 0}, {0, 0, 1}}, kInfinite);
  ASSERT_EQ(spans.size(), 3U);
  const double expected_m[][2] = {{10, 12}, {11, 17}, {1e7, 1e7 + 2}};
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_NEAR(spans[n].begin_m - kRadius_m, expected_m[n][0], 1e-8) << n;
    EXPECT_NEAR(spans[n].end_m - kRadius_m, expected_m[n][1], 1e-8) << n;
    EXPECT_LT(spans[n].geometric_error_m, 2e-5);
    EXPECT_GT(spans[n].geometric_error_m, 0);
  }
  EXPECT_EQ(scene.instance(spans[1].instance).scale, 3);
  // Those that reach into the segment are whole.
  const auto some = object_spans(scene, {{0, 0, kRadius_m + 11.5}, {0, 0, 1}}, 100);
  ASSERT_EQ(some.size(), 2U);
  EXPECT_NEAR(some[0].begin_m, -1.5, 1e-8);
  EXPECT_NEAR(some[1].end_m, 5.5, 1e-8);
  EXPECT_TRUE(object_spans(scene, {{0, 0, kRadius_m}, {0, 0, 1}}, 9).empty());
  EXPECT_TRUE(object_spans(scene, {{5, 0, kRadius_m}, {0, 0, 1}}, kInfinite).empty());
  EXPECT_TRUE(object_spans(scene, {{0, 0, 0}, {0, 0, -1}}, kInfinite).empty());
  EXPECT_TRUE(object_spans({}, {{0, 0, 0}, {0, 0, 1}}, kInfinite).empty());
}

// The field of the slab falls from 4 to 0 within half a metre of z = 0 and 9.5 m. From the planet's centre, images
// would take a coarser level.
TEST(ObjectSpans, VolumesHaveThoseOfAThreshold) {
  std::vector<Instance> instances(2);
  instances[0].position_m = {0, 0, kRadius_m};
  instances[1].position_m = {0, 0, kRadius_m + 100};
  instances[1].scale = 3;
  instances[1].is_mirrored = true;
  const Scene scene({volume_model(slab_level(21, 21, 20, 0.5F, 4))}, instances);
  const ObjectRay up{{0, 0, 0}, {0, 0, 1}};
  EXPECT_TRUE(object_spans(scene, up, kInfinite).empty());
  EXPECT_TRUE(object_spans(scene, up, kInfinite, std::nullopt).empty());
  EXPECT_TRUE(object_spans(scene, up, kInfinite, 4.1).empty());
  for (const double threshold_per_m : {0.0, -1.0, 2.0, 3.0, 0.4}) {
    const double share = threshold_per_m > 0 ? threshold_per_m / 4 : 0.5;
    const auto spans = object_spans(scene, up, kInfinite, threshold_per_m);
    ASSERT_EQ(spans.size(), 2U);
    for (std::size_t n = 0; n < 2; ++n) {
      const double scale = n == 0 ? 1 : 3;
      const double from_m = kRadius_m + (n == 0 ? 0 : 100);
      EXPECT_NEAR(spans[n].begin_m - from_m, -0.5 * scale * (1 - share), 1e-6);
      EXPECT_NEAR(spans[n].end_m - from_m, scale * (9.5 + 0.5 * (1 - share)), 1e-6);
      EXPECT_GE(spans[n].geometric_error_m, 0.5 * scale);
      EXPECT_LT(spans[n].geometric_error_m, 0.5 * scale + 1e-3);
    }
    EXPECT_EQ(object_spans(scene, up, kRadius_m + 50, threshold_per_m).size(), 1U);
  }
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), kInfinite, -kInfinite}) {
    EXPECT_THROW((void)object_spans(scene, up, kInfinite, bad), std::invalid_argument);
    EXPECT_THROW((void)object_spans({}, up, kInfinite, bad), std::invalid_argument);
  }
}

// Ends of volumes at any attitude lie where their field is at the threshold, and other models have the stretches that they have
// without one.
TEST(ObjectSpans, VolumesAtAnyAttitudeAreMetWhereTheyReachTheThreshold) {
  test_support::Random random(33);
  const auto volume = volume_model(ball_level(7, 0.5F, 30));
  const auto box = mesh_model(make_box({9, 9, 9}));
  const VolumeLevel& level = volume->volume()->levels()[0];
  double worst = 0;
  std::size_t met = 0;
  for (int n = 0; n < 200; ++n) {
    const Instance i = random_instance(random, kRadius_m);
    Instance of_box = i;
    of_box.model = 1;
    const Scene scene({volume, box}, {i, of_box});
    const glm::dvec3 up =
        glm::normalize(scene.ball().centre_m + 0.7 * scene.ball().radius_m * random.direction());
    const auto solid = object_spans(scene, {{0, 0, 0}, up}, kInfinite);
    std::size_t others = 0;
    for (const ObjectSpan& s : object_spans(scene, {{0, 0, 0}, up}, kInfinite, 0)) {
      if (scene.instance(s.instance).model == 1) {
        ASSERT_LT(others, solid.size());
        EXPECT_EQ(s.begin_m, solid[others].begin_m);
        EXPECT_EQ(s.end_m, solid[others++].end_m);
        continue;
      }
      ++met;
      EXPECT_LT(s.begin_m, s.end_m);
      for (const double at_m : {s.begin_m, s.end_m}) {
        const double from_m = glm::length(i.position_m);
        const glm::dvec3 place_m =
            glm::inverse(turned(i)) * ((at_m - from_m) * up + (from_m * up - i.position_m));
        worst = std::max(worst, std::abs(extinction_per_m(level, place_m) - 0.25));
      }
    }
    EXPECT_EQ(others, solid.size());
  }
  EXPECT_GT(met, 80U);
  EXPECT_LT(worst, 1e-6);
}

// Rays from the planet's centre through meshes at any attitude.
TEST(ObjectSpans, MeshesAtAnyAttitudeAreMetWhereTheirTrianglesAre) {
  test_support::Random random(31);
  double worst_m = 0;
  std::size_t met = 0;
  for (const Mesh& mesh : {line_oracle::overhang(), line_oracle::arch(), make_torus(9, 3, 40, 20)}) {
    const auto model = mesh_model(mesh);
    for (int n = 0; n < 150; ++n) {
      const Instance i = random_instance(random, n % 3 == 0 ? 1e8 : kRadius_m);
      const Scene scene({model}, {i});
      const glm::dvec3 centre = scene.ball().centre_m;
      const double reach_m = scene.ball().radius_m;
      const glm::dvec3 up = glm::normalize(centre + 0.8 * reach_m * random.direction());
      const auto spans = object_spans(scene, {{0, 0, 0}, up}, kInfinite);
      const double from_m = glm::length(i.position_m);
      const auto expected = line_oracle::meetings(
          line_oracle::placed(mesh, turned(i), i.position_m - from_m * up), {0, 0, 0}, up, 1e-4 * reach_m);
      std::size_t kept = 0;
      for (const ObjectSpan& s : spans) {
        if (s.end_m - s.begin_m < 1e-4 * reach_m) continue;
        ASSERT_LT(2 * kept + 1, expected.size()) << n;
        worst_m = std::max({worst_m, std::abs(s.begin_m - from_m - expected[2 * kept].t),
                            std::abs(s.end_m - from_m - expected[2 * kept + 1].t)});
        ++kept;
      }
      EXPECT_EQ(2 * kept, expected.size()) << n;
      met += kept;
    }
  }
  EXPECT_GT(met, 200U);
  test_support::record_worst("Spans of turned meshes against all triangles", worst_m, 1e-4, "m");
}

// Sticks of a mesh, at any attitude: ends are within the stated error of the mesh, and where the mesh is not
// thin beside the ray there are as many.
TEST(ObjectSpans, SticksOfAMeshAgreeWithItWithinTheStatedError) {
  test_support::Random random(32);
  double worst = 0;
  int compared = 0;
  for (const Mesh& mesh : {line_oracle::overhang(), line_oracle::arch(), line_oracle::uv_sphere(12, 30, 60)}) {
    for (const bool is_tight : {false, true}) {
      const auto model = stick_model(mesh, {.voxels_longest = 120, .is_tight = is_tight});
      for (int n = 0; n < 200; ++n) {
        const Instance i = random_instance(random, kRadius_m);
        const Scene scene({model}, {i});
        const double reach_m = scene.ball().radius_m;
        const double voxel_m = static_cast<double>(model->sticks()->levels()[0].grid.voxel_m * i.scale);
        const glm::dvec3 up = glm::normalize(scene.ball().centre_m + 0.9 * reach_m * random.direction());
        const double from_m = glm::length(i.position_m);
        const auto spans = object_spans(scene, {{0, 0, 0}, up}, kInfinite);
        const auto triangles = line_oracle::placed(mesh, turned(i), i.position_m - from_m * up);
        for (const ObjectSpan& s : spans) {
          EXPECT_GT(s.geometric_error_m, voxel_m);
          EXPECT_LT(s.geometric_error_m, 2 * voxel_m);
          for (const double at_m : {s.begin_m, s.end_m})
            worst =
                std::max(worst, line_oracle::distance(triangles, (at_m - from_m) * up) / s.geometric_error_m);
        }
        const auto around = line_oracle::neighbourhood(triangles, {0, 0, 0}, up, voxel_m, 1e-6 * reach_m);
        if (!around.is_clear) continue;
        EXPECT_EQ(2 * spans.size(), around.low.size()) << n;
        compared += around.low.empty() ? 0 : 1;
      }
    }
  }
  EXPECT_GE(compared, 200);
  test_support::record_worst("Ends of spans of sticks from the mesh, of the stated error", worst, 1, "");
}

}  // namespace
}  // namespace objects
