// Tests casts against Embree, an independent implementation over the same triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "tests/paging/planet_fixture.h"
#include "tests/voxel/brute_force.h"
#include "vpe/app/report/embree_scene.h"

namespace {

using test_support::BruteForce;
using test_support::Random;
using test_support::Verdict;
using vpe::app::EmbreeOptions;
using vpe::app::EmbreeScene;
using vpe::app::EmbreeShape;

class Embree : public ::testing::Test {
 protected:
  static std::shared_ptr<const paging::PlanetFile> stepped(const std::filesystem::path& path) {
    const glm::dvec3 fine = mars::direction({40, 34});
    return test_support::build_fake(
        path,
        test_support::FakeElevation(test_support::bumpy_height, test_support::fine_around(fine, 0.05, 10000)),
        100000);
  }
  test_support::TempDir dir_;
};

// A direction that a float holds, so that both casts are of one ray.
glm::dvec3 float_direction(const glm::dvec3& d) {
  return {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
}

// Embree's corners are floats relative to the camera, so its triangles lie this share of (range + their longest
// side) off the surface; rays that get nearer to it than that are ties between the two.
constexpr double kQuantum = 3e-7;
// The share of the other rays for which Embree may differ. There the brute force must agree with ours.
constexpr double kShareWrong = 1e-4;
constexpr double kFar = 1e-4;

TEST_F(Embree, CastsAgreeWithEmbree) {
  const auto planet = stepped(dir_ / "stepped.vpe");
  const paging::Surface surface(planet, std::size_t{128} << 20);
  const BruteForce truth(*planet);
  Random random(61);
  const double longest_m = 1.5 * lod::post_spacing_m(1, planet->meta().tile.intervals(), planet->radius_m());
  int rays = 0, hits = 0, differ = 0, embree_wrong = 0;
  for (int e = 0; e < 12; ++e) {
    const glm::dvec3 up =
        e % 3 == 0 ? glm::normalize(mars::direction({40, 34}) + 0.03 * random.direction()) : random.direction();
    const glm::dvec3 camera = up * (surface.at(up).radius_m + random.log_uniform(2, 1e6));
    const auto tiles = vpe::app::tiles_in_sight(*planet, camera);
    const EmbreeScene triangles(*planet, tiles, camera,
                                {EmbreeShape::kTriangles, RTC_BUILD_QUALITY_MEDIUM, true, 2});
    const EmbreeScene grid(*planet, tiles, camera, {EmbreeShape::kGrid, RTC_BUILD_QUALITY_MEDIUM, true, 2});
    for (int n = 0; n < 4000; ++n) {
      // Evenly about the camera, and as many near the horizon.
      glm::dvec3 d = random.direction();
      if (n % 2 == 0) {
        const double dip = std::acos(std::min(1.0, planet->radius_m() / glm::length(camera)));
        d = glm::normalize(glm::cross(up, d));
        d = glm::normalize(d + up * std::tan(random.uniform(-0.1, 0.05) - dip));
      }
      const glm::dvec3 direction = float_direction(d);
      const double length = glm::length(direction);
      const double ours = surface.cast(camera, direction / length);
      for (const EmbreeScene* scene : {&triangles, &grid}) {
        const double theirs = scene->cast(direction) * length;
        ++rays;
        hits += std::isfinite(ours) ? 1 : 0;
        if (ours == theirs || std::abs(ours - theirs) <= kFar * std::min(ours, theirs)) continue;
        ++differ;
        const Verdict verdict = test_support::judge(truth, camera, direction / length, ours);
        EXPECT_TRUE(verdict == Verdict::kSame || verdict == Verdict::kTie)
            << "camera " << e << " ray " << n << ": S " << ours << " m, Embree " << theirs << " m";
        const Verdict other =
            test_support::judge(truth, camera, direction / length, theirs, {kQuantum, kQuantum * longest_m});
        embree_wrong += other == Verdict::kMissed || other == Verdict::kPhantom ? 1 : 0;
      }
    }
  }
  EXPECT_LE(embree_wrong, rays * kShareWrong);
  EXPECT_GE(hits, rays / 2);
  std::printf("%d rays, %d hits, %d differ by more than 1e-4, Embree wrong beyond its floats in %d\n", rays,
              hits, differ, embree_wrong);
}

// Tiles that culling leaves out of the scenes cannot be hit.
TEST_F(Embree, TilesOutOfSightAreNotHit) {
  const auto planet = stepped(dir_ / "stepped.vpe");
  const paging::Surface surface(planet, std::size_t{128} << 20);
  Random random(62);
  int outside = 0;
  for (int e = 0; e < 20; ++e) {
    const glm::dvec3 up = random.direction();
    const glm::dvec3 camera = up * (surface.at(up).radius_m + random.log_uniform(2, 1e6));
    const auto tiles = vpe::app::tiles_in_sight(*planet, camera);
    outside += static_cast<int>(planet->meta().leaf_tiles) - static_cast<int>(tiles.size());
    for (int n = 0; n < 1000; ++n) {
      const glm::dvec3 direction = random.direction();
      const double range = surface.cast(camera, direction);
      if (!std::isfinite(range)) continue;
      const lod::TileKey hit = surface.at(camera + range * direction).tile;
      // A hit on a border may belong to either side.
      const auto touches = [&](const lod::TileKey& key) {
        const mars::Cap cap = lod::bounding_cap(key);
        return mars::angle_between_rad(cap.centre, camera + range * direction) <= cap.radius_rad + 1e-12;
      };
      EXPECT_TRUE(std::any_of(tiles.begin(), tiles.end(), touches)) << lod::to_string(hit);
    }
  }
  EXPECT_GT(outside, 0);
}

}  // namespace
