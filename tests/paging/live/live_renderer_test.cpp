// Both backends draw planets that are patched in memory within their certificates and without cracks, as the tiles of a
// patch meet those of the planet at every level.
#include <gtest/gtest.h>

#include "paging/planet/planet_user.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/hidden_depth.h"
#include "tests/paging/live/live_fixture.h"
#include "vpe/core/backend.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using core::Backend;
using paging::ReliefPatcher;
using relief::ReliefSpec;
using test_support::crater_at;
using test_support::live_places;
using test_support::Planet;
using test_support::Random;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

class LiveRenderer : public test_support::GlTest,
                     public ::testing::WithParamInterface<std::tuple<Backend, bool>> {
 protected:
  void SetUp() override { planet_ = test_support::build_live(dir_ / "planet.vpe"); }

  std::unique_ptr<core::Renderer> make(const Planet& planet) {
    constexpr std::size_t kMemory = std::size_t{256} << 20;
    if (is_polygon()) return renderer(planet, kMemory);
    return vpe::voxel::make_ray_renderer(planet, {kMemory, 2});
  }
  bool is_polygon() const { return std::get<0>(GetParam()) == Backend::kPolygon; }
  bool full_grids() const { return std::get<1>(GetParam()); }

  // Returns a view of a place from above its ground, at any distance.
  static core::DrawRequest view_of(Random& random, const paging::Surface& surface, const mars::LonLat& place,
                                   double reach_deg) {
    const mars::LonLat at{place.lon_deg + reach_deg * random.uniform(-1, 1),
                          std::clamp(place.lat_deg + reach_deg * random.uniform(-1, 1), -90.0, 90.0)};
    const double height_m = surface.at(mars::direction(at)).height_m + random.log_uniform(200, 2e6);
    core::DrawRequest request =
        test_support::request_for({at.lon_deg, at.lat_deg, height_m, random.uniform(-180, 180),
                                   random.uniform(-90, -5), random.uniform(-30, 30)},
                                  surface.planet_radius_m(), kWidth, kHeight, random.uniform(20, 90));
    request.settings.smooth_edges = false;
    request.settings.exaggeration = random.integer(0, 2) == 0 ? random.uniform(0.5, 3) : 1.0;
    request.settings.lod_tolerance_px = random.log_uniform(0.1, 16);
    return request;
  }

  Planet planet_;
};

TEST_P(LiveRenderer, KeepsItsCertificatesOnPatchedGround) {
  Random random(11);
  int views = 0;
  int changed_pixels = 0;
  for (const mars::LonLat& place : live_places()) {
    const std::vector<ReliefSpec> specs{crater_at(place, 30000, 2500), crater_at(place, 8000, 2500, 900)};
    const Planet patched = paging::with_reliefs(planet_, specs, {.full_grids = full_grids(), .threads = 2});
    const auto draw = make(planet_);
    draw->draw(
        test_support::request_for({place.lon_deg, place.lat_deg, 3e5, 0, -90, 0}, planet_->radius_m(), 64, 48));
    paging::change_planet(*draw, patched);
    const paging::Surface surface(patched, std::size_t{1} << 26);
    const paging::Surface before(planet_, std::size_t{1} << 26);
    for (int n = 0; n < 25; ++n) {
      const core::DrawRequest request = view_of(random, surface, place, 1.0);
      const double x = request.settings.exaggeration;
      const core::DrawResult result = draw->draw(request);
      const core::Certificate& certificate = result.certificate;
      SCOPED_TRACE(testing::Message() << "view " << n << " at " << place.lon_deg << " " << place.lat_deg);
      EXPECT_TRUE(result.missing.empty());
      ASSERT_TRUE(certificate.image_bound_px.has_value());
      const core::SurfaceRadius radius = [&](std::span<const glm::dvec3> directions,
                                             std::span<double> radius_m) {
        surface.radius(directions, radius_m, x);
      };
      const core::ShiftSummary shift =
          core::summarize(core::forward_shift_px(request.view, result.frame.range_m, radius), kWidth);
      if (std::isfinite(certificate.shift_bound_px)) {
        EXPECT_LE(shift.max_px, *certificate.image_bound_px);
        ++views;
      }
      for (int k = n % 7; k < kWidth * kHeight; k += 7) {
        const glm::dvec3 ray = core::pixel_ray(request.view, k % kWidth + 0.5, k / kWidth + 0.5);
        const auto seen_m = static_cast<double>(result.frame.range_m[static_cast<std::size_t>(k)]);
        // A ray that passes below the surface by more has gone through a crack. The ray backend samples silhouettes, which
        // its certificate does not count, so it may pass ridges that are narrower than a pixel.
        EXPECT_LE(test_support::deepest_px(surface, request.view, ray, seen_m, x, 60),
                  is_polygon() ? certificate.shift_bound_px : std::max(1.0, certificate.shift_bound_px));
        const double exact_m = surface.cast(request.view.camera.position_m, ray, x);
        changed_pixels += before.cast(request.view.camera.position_m, ray, x) != exact_m ? 1 : 0;
      }
    }
  }
  EXPECT_GT(views, 120);
  EXPECT_GT(changed_pixels, 5000) << "views shall show the patch";
}

// A renderer that goes over from state to state draws what a new one draws of the last.
TEST_P(LiveRenderer, AnAnimationEndsWithTheImageOfItsLastState) {
  const ReliefPatcher patcher(planet_);
  const mars::LonLat place = live_places()[1];
  const auto draw = make(planet_);
  const core::DrawRequest request = test_support::request_for(
      {place.lon_deg - 1, place.lat_deg, 40000, 90, -25, 0}, planet_->radius_m(), 96, 72);
  const core::DrawResult first = draw->draw(request);
  core::DrawResult last;
  Planet patched;
  for (const double depth_m : {300.0, 900.0, 1800.0}) {
    patched = patcher.with(std::vector<ReliefSpec>{crater_at(place, 25000, 2500, depth_m)},
                           {.full_grids = full_grids(), .threads = 2});
    paging::change_planet(*draw, patched);
    last = draw->draw(request);
    const core::DrawResult fresh = make(patched)->draw(request);
    EXPECT_TRUE(last.frame.colour == fresh.frame.colour);
    EXPECT_TRUE(last.frame.range_m == fresh.frame.range_m);
  }
  EXPECT_FALSE(last.frame.colour == first.frame.colour);
  paging::change_planet(*draw, patcher.with({}));
  EXPECT_TRUE(draw->draw(request).frame.colour == first.frame.colour);
}

// Normals at a tile's border depend on the ground across it, and shadows on ground far away.
TEST_P(LiveRenderer, LightOfVerticesFollowsTheGround) {
  if (!is_polygon()) return;  // rays have no triangles
  const ReliefPatcher patcher(planet_);
  const mars::LonLat place = live_places()[1];
  for (const bool shadows : {false, true}) {
    core::DrawRequest request = test_support::request_for({place.lon_deg - 1, place.lat_deg, 40000, 90, -25, 0},
                                                          planet_->radius_m(), 96, 72);
    request.settings.mode = core::Mode::kLit;
    request.settings.shading = core::Shading::kVertex;
    request.settings.shadows = shadows;
    request.sun = mars::sun_direction(place, 315, 5);
    const auto draw = make(planet_);
    const core::DrawResult first = draw->draw(request);
    for (const double depth_m : {900.0, 1800.0}) {
      const Planet patched = patcher.with(std::vector<ReliefSpec>{crater_at(place, 25000, 2500, depth_m)},
                                          {.full_grids = full_grids(), .threads = 2});
      paging::change_planet(*draw, patched);
      const core::DrawResult next = draw->draw(request);
      EXPECT_TRUE(next.frame.colour == make(patched)->draw(request).frame.colour);
      EXPECT_FALSE(next.frame.colour == first.frame.colour);
    }
    paging::change_planet(*draw, patcher.with({}));
    EXPECT_TRUE(draw->draw(request).frame.colour == first.frame.colour);
  }
}

// Pixels whose ground lies outside of the tiles that the patch made, and whose rays pass none of these, stay as they were.
TEST_P(LiveRenderer, ImagesDifferWithinTheReachAlone) {
  const mars::LonLat place = live_places()[5];
  const std::vector<ReliefSpec> specs{crater_at(place, 12000, 2500)};
  const Planet patched = paging::with_reliefs(planet_, specs, {.full_grids = full_grids(), .threads = 2});
  const core::DrawRequest request = test_support::request_for({place.lon_deg, place.lat_deg, 900000, 0, -90, 0},
                                                              planet_->radius_m(), 160, 160);
  const core::DrawResult a = make(planet_)->draw(request);
  const core::DrawResult b = make(patched)->draw(request);
  // Straight down: no ground hides other ground, and shadows are off. A tile's normals reach a post beyond it.
  const mars::Cap cap =
      relief::place(specs, planet_->radius_m(), [](const glm::dvec3&) { return 0.0; }).placed().front().cap();
  double tiles_rad = 0;
  for (const lod::TileInfo& tile : patched->tree().tiles()) {
    if (tile.has_children || patched->version(tile.key) == planet_->version()) continue;
    const mars::Cap own = lod::bounding_cap(tile.key);
    tiles_rad = std::max(tiles_rad, mars::angle_between_rad(own.centre, cap.centre) + own.radius_rad);
  }
  int differ = 0;
  for (std::size_t k = 0; k < a.frame.range_m.size(); ++k) {
    if (a.frame.colour[k] == b.frame.colour[k]) continue;
    ++differ;
    const int x = static_cast<int>(k) % 160;
    const int y = static_cast<int>(k) / 160;
    const glm::dvec3 ground =
        request.view.camera.position_m +
        static_cast<double>(b.frame.range_m[k]) * core::pixel_ray(request.view, x + 0.5, y + 0.5);
    EXPECT_LE(mars::angle_between_rad(glm::normalize(ground), cap.centre), 1.5 * tiles_rad);
  }
  EXPECT_GT(differ, 20);
  EXPECT_LT(differ, 160 * 160 / 2);
}

INSTANTIATE_TEST_SUITE_P(Backends, LiveRenderer,
                         ::testing::Combine(::testing::Values(Backend::kPolygon, Backend::kRay),
                                            ::testing::Bool()),
                         [](const auto& of) {
                           return std::string(core::to_string(std::get<0>(of.param))) +
                                  (std::get<1>(of.param) ? "_grids" : "_meshes");
                         });

}  // namespace
