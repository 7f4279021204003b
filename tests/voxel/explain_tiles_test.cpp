// Tests that the explanation of rays names the tiles that were cast, with the errors that the certificate bounds.
#include "vpe/voxel/explain_tiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "lod/options.h"
#include "tests/gl/gl_fixture.h"
#include "tests/voxel/drawn_terrain.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using lod::LevelReason;
using test_support::Random;
using test_support::request_for;

class ExplainTiles : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = std::make_unique<test_support::TempDir>();
    planet_ = test_support::build_fake(*dir_ / "bumpy.vpe",
                                       test_support::FakeElevation(test_support::bumpy_height), 20000);
  }
  static void TearDownTestSuite() {
    planet_.reset();
    dir_.reset();
  }
  static core::DrawRequest random_request(Random& random, const paging::Surface& surface) {
    const mars::LonLat place = mars::lon_lat(random.direction());
    const double ground_m = surface.at(mars::direction(place)).height_m;
    const double height_m = random.log_uniform(1000, 1e7);
    const double yaw_deg = random.uniform(0, 360);
    const double pitch_deg = random.uniform(-90, 0);
    core::DrawRequest request =
        request_for({place.lon_deg, place.lat_deg, ground_m + height_m, yaw_deg, pitch_deg, 10},
                    surface.planet_radius_m(), 64, 48, random.log_uniform(10, 90));
    core::SettingsValues& s = request.settings;
    s.ray_mode = core::RayMode::kMultires;
    s.ray_cell_px = random.log_uniform(0.1, 8);
    s.lod_metric = random.integer(0, 2) == 0 ? core::LodMetric::kDistance : core::LodMetric::kError;
    s.lod_centre_weight = random.integer(0, 1) == 0 ? 0 : random.uniform(0, 1);
    s.exaggeration = random.integer(0, 1) == 0 ? 1 : 3;
    s.samples = random.integer(0, 3) == 0 ? 2 : 1;
    if (random.integer(0, 2) == 0) s.ray_fovea = 0.3;
    if (random.integer(0, 1) == 0) request.interest = {{place.lon_deg, place.lat_deg, 3e5, 2}};
    return request;
  }

  static inline std::unique_ptr<test_support::TempDir> dir_;
  static inline std::shared_ptr<const paging::PlanetFile> planet_;
};

TEST_F(ExplainTiles, AgreesWithTheCertificateTileByTile) {
  const paging::Surface surface(planet_, std::size_t{1} << 26);
  std::vector<lod::TileExplanation> explained;
  const auto draw = vpe::voxel::make_ray_renderer(
      planet_, {.memory_bytes = std::size_t{256} << 20, .threads = 2, .explained = &explained});
  Random random(20261126);
  std::map<LevelReason, int> seen;
  for (int n = 0; n < 60; ++n) {
    SCOPED_TRACE(n);
    const core::DrawRequest request = random_request(random, surface);
    const core::SettingsValues& s = request.settings;
    const core::DrawResult result = draw->draw(request);
    const core::Certificate& c = result.certificate;
    ASSERT_EQ(explained.size(), static_cast<std::size_t>(c.tiles_drawn));
    double largest_m = 0;
    double largest_px = 0;
    std::vector<int> by_level(result.stats.tiles_by_level.size());
    for (const lod::TileExplanation& e : explained) {
      SCOPED_TRACE(lod::to_string(e.key));
      largest_m = std::max(largest_m, e.geometric_error_m);
      largest_px = std::max(largest_px, e.screen_space_error_px);
      ++by_level.at(static_cast<std::size_t>(e.key.level));
      ++seen[e.reason];
      const lod::TileInfo& info = *planet_->tree().find(e.key);
      ASSERT_EQ(e.reason == LevelReason::kFinestThere, !info.has_children);
      if (e.reason == LevelReason::kFinestThere) {
        ASSERT_EQ(e.geometric_error_m, 0);
      } else if (s.lod_metric == core::LodMetric::kDistance) {
        ASSERT_EQ(e.reason, LevelReason::kLevelReached);
        ASSERT_LE(e.wanted_level, e.key.level);
      } else {
        ASSERT_EQ(e.reason, LevelReason::kWithinTolerance);
        ASSERT_LE(e.screen_space_error_px * std::exp2(e.shift),
                  s.ray_cell_px * (s.ray_fovea ? 2 : 1) * (1 + 1e-9));
      }
    }
    EXPECT_EQ(largest_m, c.geometric_error_m);
    EXPECT_EQ(largest_px, c.screen_space_error_px);
    EXPECT_EQ(by_level, result.stats.tiles_by_level);
  }
  EXPECT_EQ(seen.size(), 3U);
}

// By another way to find the tile under a pixel.
TEST_F(ExplainTiles, EveryPixelShowsATileOfIt) {
  const paging::Surface surface(planet_, std::size_t{1} << 26);
  std::vector<lod::TileExplanation> explained;
  const auto draw = vpe::voxel::make_ray_renderer(
      planet_, {.memory_bytes = std::size_t{256} << 20, .threads = 2, .explained = &explained});
  Random random(20261127);
  int pixels = 0;
  for (int n = 0; n < 20; ++n) {
    core::DrawRequest request = random_request(random, surface);
    const double cell_px = request.settings.ray_cell_px;
    request.settings = {};
    request.settings.ray_mode = core::RayMode::kMultires;
    request.settings.ray_cell_px = cell_px;
    request.interest.clear();
    const core::DrawResult result = draw->draw(request);
    const test_support::DrawnGround ground(surface, request.view, cell_px);
    std::map<std::int64_t, bool> named;
    for (const lod::TileExplanation& e : explained) named[lod::pack(e.key)] = true;
    for (int k = 0; k < 64 * 48; ++k) {
      const float range_m = result.frame.range_m[static_cast<std::size_t>(k)];
      if (!std::isfinite(range_m)) continue;
      const glm::dvec3 ray = core::pixel_ray(request.view, k % 64 + 0.5, k / 64 + 0.5);
      const auto tile = ground.tile(request.view.camera.position_m + static_cast<double>(range_m) * ray);
      ASSERT_TRUE(named.contains(lod::pack(planet_->tree()[tile].key))) << n << " " << k;
      ++pixels;
    }
  }
  EXPECT_GT(pixels, 10000);
}

TEST_F(ExplainTiles, NothingIsExplainedBelowTheGround) {
  std::vector<lod::TileExplanation> explained(3);
  const auto draw = vpe::voxel::make_ray_renderer(planet_, {.threads = 1, .explained = &explained});
  draw->draw(request_for({20, 30, -100000, 0, 0, 0}, planet_->radius_m(), 16, 16));
  EXPECT_TRUE(explained.empty());
}

}  // namespace
