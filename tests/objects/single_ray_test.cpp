// Lines of sight among objects.
#include "objects/draw/single_ray.h"

#include <gtest/gtest.h>

#include "objects/levels/mesh_levels.h"
#include "objects/model/shapes.h"

namespace objects {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::shared_ptr<const Model> glass_or_stone(std::uint8_t alpha) {
  Mesh box = make_box({2, 2, 2});
  box.material_table = {{{200, 200, 200, alpha}, -1, alpha < 255 ? AlphaMode::kBlend : AlphaMode::kOpaque}};
  std::fill(box.materials.begin(), box.materials.end(), std::uint16_t{0});
  return std::make_shared<const Model>("box", make_levels(std::move(box)));
}

// Boxes along +x from the origin of the ray, their near sides at 9, 19, 29 m.
Scene row(std::uint8_t first_alpha) {
  std::vector<Instance> instances;
  for (int n = 0; n < 3; ++n) {
    Instance i;
    i.position_m = {3.4e6 + 10.0 * (n + 1), 0, -1};
    i.model = n == 0 ? 0 : 1;
    i.name = n == 1 ? 1 : 0;
    instances.push_back(i);
  }
  return Scene({glass_or_stone(first_alpha), glass_or_stone(255)}, instances, {"", "second"});
}

TEST(SingleRay, MeetsTheFirstObject) {
  const Scene scene = row(255);
  const ObjectRay ray{{3.4e6, 0.2, 0.3}, {1, 0, 0}};
  const auto seen = first_object(scene, ray, kInfinite);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->range_m, 9, 1e-5);
  EXPECT_FALSE(first_object(scene, ray, 8.9));
  EXPECT_FALSE(first_object(scene, {{3.4e6, 0.2, 0.3}, {-1, 0, 0}}, kInfinite));
  EXPECT_FALSE(first_object(scene, {{3.4e6, 5, 0.3}, {1, 0, 0}}, kInfinite));
  const auto from_behind = first_object(scene, {{3.4e6 + 15, 0.2, 0.3}, {1, 0, 0}}, kInfinite);
  ASSERT_TRUE(from_behind);
  EXPECT_NEAR(from_behind->range_m, 4, 1e-5);
  EXPECT_EQ(scene.names()[scene.instance(from_behind->instance).name], "second");
}

TEST(SingleRay, ThinGlassIsSeenThrough) {
  // Two sides of opacity a: 1 - (1 - a)^2 passes a half from a = 0.293 on.
  const ObjectRay ray{{3.4e6, 0.2, 0.3}, {1, 0, 0}};
  const auto thin = first_object(row(60), ray, kInfinite);
  ASSERT_TRUE(thin);
  EXPECT_NEAR(thin->range_m, 19, 1e-5);
  const auto thick = first_object(row(100), ray, kInfinite);
  ASSERT_TRUE(thick);
  EXPECT_NEAR(thick->range_m, 11, 1e-5);  // the far side
}

}  // namespace
}  // namespace objects
