// Promises of core::Renderer that both backends keep.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "mars/geodesy/sun.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/worst.h"
#include "vpe/core/appearance/sky.h"
#include "vpe/core/backend.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using core::Backend;
using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::request_for;

class RendererContract : public test_support::GlTest, public ::testing::WithParamInterface<Backend> {
 protected:
  std::unique_ptr<core::Renderer> make(std::shared_ptr<const paging::PlanetFile> planet) {
    if (GetParam() == Backend::kPolygon) return renderer(std::move(planet));
    return vpe::voxel::make_ray_renderer(std::move(planet), {std::size_t{256} << 20, 2});
  }
  bool is_rays() const { return GetParam() == Backend::kRay; }

  // Returns the largest forward shift of an image over the bound that it states.
  double shift_over_bound(core::Renderer& draw, const paging::Surface& surface,
                          const core::DrawRequest& request) {
    return shift_over_bound(draw.draw(request), surface, request);
  }
  double shift_over_bound(const core::DrawResult& result, const paging::Surface& surface,
                          const core::DrawRequest& request) {
    const double x = request.settings.exaggeration;
    const core::SurfaceRadius radius = [&](std::span<const glm::dvec3> directions, std::span<double> radius_m) {
      surface.radius(directions, radius_m, x);
    };
    const auto shifts = core::forward_shift_px(request.view, result.frame.range_m, radius);
    const core::ShiftSummary shift = core::summarize(shifts, core::drawn_size(request.view).x);
    EXPECT_GT(shift.pixels, 0);
    EXPECT_LE(result.certificate.image_bound_px.value(), result.certificate.shift_bound_px);
    return shift.max_px / *result.certificate.image_bound_px;
  }
};

// Walls of 4 km between posts some 60 m apart: slopes of 89 degrees.
double walls(const glm::dvec3& d) {
  const mars::LonLat p = mars::lon_lat(d);
  const auto i = static_cast<int>(std::floor(p.lon_deg * 32));
  const auto j = static_cast<int>(std::floor(p.lat_deg * 32));
  return (i + j) % 2 == 0 ? 0.0 : 4000.0;
}

// Returns a planet of walls, made once for all tests.
std::shared_ptr<const paging::PlanetFile> walled_planet() {
  static const test_support::TempDir folder;
  static const auto planet = build_fake(
      folder / "walls.vpe",
      FakeElevation(walls, test_support::fine_around(mars::direction({0.5, 0.5}), 0.008, 60)), 100000);
  return planet;
}

TEST_P(RendererContract, CertificatesHoldOnWalls) {
  const auto planet = walled_planet();
  const paging::Surface surface(planet, std::size_t{1} << 27);
  const auto draw = make(planet);
  double worst = 0;
  for (const mars::Pose& pose : {mars::Pose{0.5, 0.5, 9000, 30, -30, 0},
                                 {0.51, 0.49, 6000, 200, -45, 10},
                                 {0.47, 0.5, 4500, 90, -20, 0},
                                 {0.5, 0.53, 15000, 120, -80, 0}})
    worst = std::max(worst, shift_over_bound(*draw, surface, request_for(pose, planet->radius_m(), 160, 120)));
  test_support::record_worst(is_rays() ? "rays: forward shift, walls" : "polygons: forward shift, walls", worst,
                             1, "of the certificate");
  EXPECT_LE(worst, 1);
}

// Ranges may be asked for between images, at another tolerance. They have no colours, and the images stay the
// same.
TEST_P(RendererContract, RangesAloneAreThoseOfTheImage) {
  const auto planet = build_fake(dir_ / "bumpy.vpe", FakeElevation(bumpy_height), 50000);
  const auto draw = make(planet);
  core::DrawRequest request = request_for({20, 10, 3e5, 30, -40, 0}, planet->radius_m(), 160, 120);
  request.settings.lod_tolerance_px = 2;
  request.want_range = true;
  const core::DrawResult image = draw->draw(request);
  ASSERT_EQ(image.frame.colour.size(), 19200U);
  EXPECT_TRUE(image.certificate.nodata_share);
  core::DrawRequest alone = request;
  alone.want_colour = false;
  for (const double tolerance_px : {2.0, 0.1}) {
    alone.settings.lod_tolerance_px = tolerance_px;
    const core::DrawResult ranges = draw->draw(alone);
    EXPECT_EQ(ranges.frame.width, 160);
    EXPECT_TRUE(ranges.frame.colour.empty());
    EXPECT_FALSE(ranges.certificate.nodata_share);
    EXPECT_TRUE(ranges.missing.empty());
    const bool is_same = ranges.frame.range_m == image.frame.range_m;
    EXPECT_EQ(is_same, is_rays() || tolerance_px == 2);
    if (is_same) {
      EXPECT_EQ(ranges.certificate.image_bound_px, image.certificate.image_bound_px);
    }
    EXPECT_LE(ranges.certificate.screen_space_error_px, tolerance_px);
    const core::DrawResult again = draw->draw(request);
    EXPECT_TRUE(again.frame.colour == image.frame.colour);
    EXPECT_TRUE(again.frame.range_m == image.frame.range_m);
  }
}

TEST_P(RendererContract, CertificatesHoldUnderExaggeration) {
  const auto rough = [](const glm::dvec3& d) {
    return 0.05 * bumpy_height(d) + 300 * std::sin(400 * d.x) * std::sin(370 * d.y) * std::cos(390 * d.z);
  };
  const auto planet = build_fake(
      dir_ / "rough.vpe",
      FakeElevation(rough, test_support::fine_around(mars::direction({20, 10}), 0.25, 10000)), 60000);
  const paging::Surface surface(planet, std::size_t{1} << 27);
  const auto draw = make(planet);
  double worst = 0;
  for (const double exaggeration : {5.0, 100.0}) {
    for (const mars::Pose& pose :
         {mars::Pose{20, 10, 60000, 30, -20, 0}, {22, 8, 90000, 300, -50, 0}, {18, 12, 70000, 120, -5, 20}}) {
      core::DrawRequest request = request_for(pose, planet->radius_m(), 160, 120);
      request.settings.exaggeration = exaggeration;
      if (surface.is_below(request.view.camera.position_m, exaggeration)) continue;
      worst = std::max(worst, shift_over_bound(*draw, surface, request));
    }
  }
  test_support::record_worst(
      is_rays() ? "rays: forward shift, exaggerated" : "polygons: forward shift, exaggerated", worst, 1,
      "of the certificate");
  EXPECT_LE(worst, 1);
}

TEST_P(RendererContract, ACameraBelowTheGroundSeesOneColourAndClaimsNothing) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height), 50000);
  const paging::Surface surface(planet, std::size_t{1} << 26);
  const auto draw = make(planet);
  const double ground_m = surface.at(mars::direction({20, 30})).height_m;
  core::DrawRequest request = request_for({20, 30, ground_m - 5, 40, -10, 0}, planet->radius_m(), 40, 30);
  EXPECT_TRUE(surface.is_below(request.view.camera.position_m));
  core::DrawResult below = draw->draw(request);
  EXPECT_TRUE(below.certificate.is_below_ground);
  EXPECT_TRUE(std::isinf(below.certificate.shift_bound_px));
  EXPECT_TRUE(std::isinf(below.certificate.image_bound_px.value()));
  ASSERT_EQ(below.frame.colour.size(), 1200U);
  const vpe::base::Rgb colour = below.frame.colour.front();
  EXPECT_EQ(colour.r, 32);  // the same with every backend
  EXPECT_EQ(std::count(below.frame.colour.begin(), below.frame.colour.end(), colour), 1200);
  EXPECT_EQ(std::count(below.frame.range_m.begin(), below.frame.range_m.end(), 0.0F), 1200);
  request.want_range = false;
  EXPECT_TRUE(draw->draw(request).frame.range_m.empty());
  // Above the ground, and below it only where it is exaggerated.
  request.view.camera = mars::to_camera({20, 30, ground_m + 5, 40, -10, 0}, planet->radius_m());
  EXPECT_FALSE(draw->draw(request).certificate.is_below_ground);
  request.settings.exaggeration = ground_m > 0 ? 2 : 0.5;
  EXPECT_EQ(draw->draw(request).certificate.is_below_ground, std::abs(ground_m) > 10);
}

TEST_P(RendererContract, ExaggerationThroughTheCentreIsRefused) {
  const auto planet =
      build_fake(dir_ / "p.vpe", FakeElevation([](const glm::dvec3& d) { return 1e6 * d.x; }), 400000);
  const auto draw = make(planet);
  core::DrawRequest request = request_for({20, 0, 2e7, 0, -90, 0}, planet->radius_m(), 40, 30);
  request.settings.exaggeration = 3;
  EXPECT_FALSE(draw->draw(request).frame.colour.empty());
  request.settings.exaggeration = 3.5;
  try {
    draw->draw(request);
    ADD_FAILURE() << "was drawn";
  } catch (const std::exception& e) {
    EXPECT_NE(std::string(e.what()).find("must be less than 3.39"), std::string::npos) << e.what();
  }
}

// Level control other than the tolerance acts or is refused, and is never ignored.
TEST_P(RendererContract, LevelControlActsOrIsRefused) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height), 20000);
  const paging::Surface surface(planet, std::size_t{1} << 26);
  const auto draw = make(planet);
  core::DrawRequest plain = request_for({20, 30, 400000, 40, -60, 0}, planet->radius_m(), 64, 48);
  plain.settings.lod_tolerance_px = 4;
  plain.settings.ray_cell_px = 0.1;
  plain.settings.ray_mode = core::RayMode::kMultires;
  const core::DrawResult before = draw->draw(plain);
  std::vector<core::DrawRequest> controlled(5, plain);
  controlled[0].interest = {{20, 30, 300000, 3}};
  controlled[1].settings.lod_metric = core::LodMetric::kDistance;
  controlled[2].settings.lod_centre_weight = 3;
  controlled[3].interest = {{20, 30, 1e7, -3}};
  controlled[4].settings.lod_triangles = 300;
  for (std::size_t n = 0; n < controlled.size(); ++n) {
    SCOPED_TRACE(n);
    if (is_rays() && n == 4) {
      EXPECT_NE(vpe::voxel::why_not(controlled[n]), "");
      EXPECT_THROW(draw->draw(controlled[n]), std::runtime_error);
      continue;
    }
    const core::DrawResult result = draw->draw(controlled[n]);
    EXPECT_NE(result.stats.tiles_by_level, before.stats.tiles_by_level);
    EXPECT_LE(shift_over_bound(result, surface, controlled[n]), 1);
    core::DrawRequest exact = controlled[n];
    exact.settings.ray_mode = core::RayMode::kExact;
    EXPECT_EQ(vpe::voxel::why_not(exact) == "", false);
  }
  // What has no effect by its weight is not asked for.
  core::DrawRequest off = controlled[0];
  off.settings.lod_interest_weight = 0;
  EXPECT_EQ(draw->draw(off).frame.colour, before.frame.colour);
  EXPECT_EQ(draw->draw(off).frame.range_m, before.frame.range_m);
}

// Weights of what a budget takes change which tiles become coarser, and nothing while no budget takes any.
TEST_P(RendererContract, WeightsOfABudgetMoveItsLosses) {
  const mars::LonLat place{20, 30};
  const auto planet = build_fake(
      dir_ / "p.vpe", FakeElevation(bumpy_height, test_support::fine_around(mars::direction(place), 0.2, 3000)),
      100000);
  const paging::Surface surface(planet, std::size_t{1} << 26);
  const auto draw = make(planet);
  core::DrawRequest even =
      request_for({place.lon_deg, place.lat_deg, 600000, 40, -90, 0}, planet->radius_m(), 64, 48, 90);
  even.settings.lod_tolerance_px = 1.0 / 16;
  even.settings.ray_cell_px = 1.0 / 64;
  even.settings.ray_mode = core::RayMode::kMultires;
  const auto tiles = [&](core::DrawRequest request, double coarsening) {
    request.coarsening = coarsening;
    const core::DrawResult result = draw->draw(request);
    EXPECT_LE(shift_over_bound(result, surface, request), 1);
    return result.stats.tiles_drawn;
  };
  const auto expect_between = [&](const core::DrawRequest& weighed, const core::DrawRequest& unweighed) {
    EXPECT_GT(tiles(weighed, 16), tiles(unweighed, 16));
    EXPECT_LT(tiles(weighed, 16), tiles(unweighed, 1));
    const core::DrawResult at_rest = draw->draw(weighed);
    const core::DrawResult expected = draw->draw(unweighed);
    EXPECT_EQ(at_rest.frame.colour, expected.frame.colour);
    EXPECT_EQ(at_rest.frame.range_m, expected.frame.range_m);
    core::DrawRequest exact = weighed;
    exact.interest.clear();
    exact.settings.ray_mode = core::RayMode::kExact;
    EXPECT_NE(vpe::voxel::why_not(exact).find("degrade."), std::string::npos);
  };
  core::DrawRequest rim = even;
  rim.settings.degrade_distance = 0;
  expect_between(rim, even);
  core::DrawRequest centre = even;
  centre.settings.degrade_centre = 0;
  expect_between(centre, even);
  core::DrawRequest region = even;
  region.interest = {{place.lon_deg + 4, place.lat_deg, 100000, 1}};
  core::DrawRequest kept = region;
  kept.settings.degrade_interest = 0;
  expect_between(kept, region);
}

// A wall close before a camera that is high above the foot of the wall.
TEST_P(RendererContract, WallsBesideTheCameraAreNotSeenThrough) {
  const auto planet = walled_planet();
  const paging::Surface surface(planet, std::size_t{1} << 27);
  const auto draw = make(planet);
  int views = 0;
  for (double lon = 0.485; lon < 0.515; lon += 0.0005) {
    for (const double yaw : {90.0, 270.0}) {
      const core::DrawRequest request = request_for({lon, 0.505, 3500, yaw, 0, 0}, planet->radius_m(), 40, 30);
      if (surface.is_below(request.view.camera.position_m)) continue;
      const double wall_m =
          surface.cast(request.view.camera.position_m, core::pixel_ray(request.view, 20.5, 15.5));
      if (!(wall_m < 100)) continue;
      ++views;
      const core::DrawResult result = draw->draw(request);
      const double drawn_m = static_cast<double>(result.frame.range_m[15 * 40 + 20]);
      EXPECT_NEAR(drawn_m, wall_m, 0.05 * wall_m + 1) << lon << " " << yaw;
    }
  }
  EXPECT_GT(views, 0);
}

// Sky and plain ground have the colours of the planet's body, or those that are asked for.
TEST_P(RendererContract, TheSkyIsThatOfTheBody) {
  const glm::dvec3 sun = mars::sun_direction({20, 30}, 100, 40);
  const auto image = [&](const char* body, core::Atmosphere atmosphere) {
    const auto planet =
        build_fake(dir_ / (std::string(body) + ".vpe"), FakeElevation(bumpy_height), 200000, 2, body);
    const paging::Surface surface(planet, std::size_t{1} << 26);
    const double ground_m = surface.at(mars::direction({20, 30})).height_m;
    core::DrawRequest request = request_for({20, 30, ground_m + 100, 40, 20, 0}, planet->radius_m(), 80, 60);
    request.view.fov_deg = 100;
    request.sun = sun;
    request.settings.mode = core::Mode::kLit;
    request.settings.atmosphere = atmosphere;
    const core::DrawResult result = make(planet)->draw(request);
    core::Appearance resolved = request.settings;
    core::for_body(resolved, body);
    int sky = 0;
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 80; ++x) {
        const auto p = static_cast<std::size_t>(y * 80 + x);
        const vpe::base::Rgb c = result.frame.colour[p];
        if (std::isfinite(result.frame.range_m[p])) continue;
        const glm::dvec3 wanted =
            core::sky_colour(core::air_of(resolved.atmosphere), request.view.camera.position_m,
                             core::pixel_ray(request.view, x + 0.5, y + 0.5), request.sun, planet->radius_m());
        ++sky;
        EXPECT_LE(std::abs(c.r - wanted.r), 2) << body << " " << x << " " << y;
        EXPECT_LE(std::abs(c.g - wanted.g), 2) << body << " " << x << " " << y;
        EXPECT_LE(std::abs(c.b - wanted.b), 2) << body << " " << x << " " << y;
      }
    }
    EXPECT_GT(sky, 1000);
    return result.frame.colour;
  };
  const auto mars_image = image("Mars", core::Atmosphere::kAuto);
  const auto moon = image("Moon", core::Atmosphere::kAuto);
  const auto dusty_moon = image("Moon", core::Atmosphere::kMars);
  const auto earth = image("Earth", core::Atmosphere::kAuto);
  const auto clear_mars = image("Mars", core::Atmosphere::kNone);
  const std::size_t up = 10 * 80 + 40;
  EXPECT_EQ(moon[up], (vpe::base::Rgb{0, 0, 0}));
  EXPECT_EQ(clear_mars[up], (vpe::base::Rgb{0, 0, 0}));
  EXPECT_EQ(dusty_moon[up], mars_image[up]);
  EXPECT_GT(mars_image[up].r, mars_image[up].b);
  EXPECT_GT(earth[up].b, earth[up].r);
  // The sky overhead is no darker than half of the sky above the horizon.
  const std::size_t low = 38 * 80 + 40;
  EXPECT_GT(2 * mars_image[up].g, mars_image[low].g);
  const std::size_t ground = 58 * 80 + 40;
  EXPECT_EQ(moon[ground].r, moon[ground].b);
  EXPECT_GT(mars_image[ground].r, mars_image[ground].b);
}

// The finest tiles of the planet cannot be read: coarser ones are drawn, which the image says.
TEST_P(RendererContract, DamagedTilesAreNeverDrawnInSilence) {
  const auto path = dir_ / "damaged.vpe";
  const auto whole = build_fake(path, FakeElevation(bumpy_height), 100000);
  const paging::Surface surface(whole, std::size_t{1} << 26);
  const double radius_m = whole->radius_m();
  core::DrawRequest request = request_for({20, 30, 40000, 30, -40, 0}, radius_m, 48, 36);
  request.settings.lod_tolerance_px = 0.25;
  const core::DrawResult good = make(whole)->draw(request);
  EXPECT_TRUE(good.missing.empty());
  EXPECT_TRUE(good.failures.empty());
  const auto damaged = paging::PlanetFile::open(path.string(), [&](const lod::TileKey& tile) {
    if (!whole->tree().find(tile)->has_children)
      throw paging::PlanetError("damaged.vpe: tile " + lod::to_string(tile) + " is damaged");
  });
  const auto draw = make(damaged);
  const core::DrawResult result = draw->draw(request);
  ASSERT_FALSE(result.missing.empty());
  ASSERT_FALSE(result.failures.empty());
  EXPECT_EQ(result.certificate.tiles_missing, static_cast<int>(result.missing.size()));
  EXPECT_GT(result.certificate.tiles_substituted, 0);
  EXPECT_TRUE(result.settled);
  int own_failures = 0;
  for (const core::MissingTile& tile : result.missing) {
    EXPECT_TRUE(tile.is_unreadable);
    EXPECT_NE(tile.why.find("damaged.vpe: tile "), std::string::npos) << tile.why;
    own_failures += tile.why.find(tile.tile) != std::string::npos ? 1 : 0;  // else a tile that it depends on
  }
  EXPECT_GT(own_failures, 0);
  EXPECT_GT(result.certificate.screen_space_error_px, good.certificate.screen_space_error_px);
  EXPECT_LE(shift_over_bound(*draw, surface, request), 1);
  // A failure is reported once, and the image stays the same.
  const core::DrawResult again = draw->draw(request);
  EXPECT_TRUE(again.failures.empty());
  EXPECT_EQ(again.missing.size(), result.missing.size());
  EXPECT_EQ(again.frame.range_m, result.frame.range_m);
  EXPECT_EQ(again.frame.colour, result.frame.colour);
}

// Nothing at all can be read.
TEST_P(RendererContract, UnreadableRootsAreAnError) {
  const auto path = dir_ / "damaged.vpe";
  const double radius_m = build_fake(path, FakeElevation(bumpy_height), 400000)->radius_m();
  const auto draw = make(paging::PlanetFile::open(path.string(), [](const lod::TileKey& tile) {
    throw paging::PlanetError("damaged.vpe: tile " + lod::to_string(tile) + " is damaged");
  }));
  const core::DrawRequest request = request_for({20, 30, 4000000, 30, -90, 0}, radius_m, 48, 36);
  EXPECT_THROW(draw->draw(request), std::runtime_error);
}

// A frame that may not wait for storage says what it lacks, its certificate holds, and a later one is the same as
// if it had waited.
TEST_P(RendererContract, FramesThatMayNotWaitSayWhatTheyLack) {
  const auto path = dir_ / "p.vpe";
  const auto planet = build_fake(path, FakeElevation(bumpy_height), 100000);
  const paging::Surface surface(planet, std::size_t{1} << 26);
  core::DrawRequest request = request_for({20, 30, 40000, 30, -40, 0}, planet->radius_m(), 48, 36);
  request.settings.lod_tolerance_px = 0.25;
  const core::DrawResult whole = make(planet)->draw(request);
  ASSERT_TRUE(whole.missing.empty());
  for (const bool wait : {false, true}) {
    SCOPED_TRACE(wait ? "a time-out" : "no wait");
    const auto slow = make(paging::PlanetFile::open(path.string(), [](const lod::TileKey& tile) {
      if (tile.level > 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }));
    request.paging.wait = wait;
    request.paging.timeout_s = 0;
    core::DrawResult result = slow->draw(request);
    EXPECT_FALSE(result.missing.empty());
    EXPECT_FALSE(result.settled);
    double worst = 0;
    int frames = 1;
    for (; frames < 5000 && !result.settled; ++frames) {
      EXPECT_EQ(result.certificate.tiles_missing, static_cast<int>(result.missing.size()));
      EXPECT_EQ(result.stats.tiles_missing, result.certificate.tiles_missing);
      EXPECT_TRUE(result.failures.empty());
      worst = std::max(worst, shift_over_bound(result, surface, request));
      result = slow->draw(request);
    }
    EXPECT_LE(worst, 1);
    EXPECT_GE(frames, 2);
    EXPECT_TRUE(result.settled);
    EXPECT_TRUE(result.missing.empty());
    EXPECT_EQ(result.frame.range_m, whole.frame.range_m);
    EXPECT_EQ(result.frame.colour, whole.frame.colour);
  }
}

// Where tiles cannot be read, a frame that may not wait settles on the image that waiting gives, also after the sun
// has moved.
TEST_P(RendererContract, DamageLooksTheSameWithAndWithoutWaiting) {
  const auto path = dir_ / "p.vpe";
  const auto planet = build_fake(path, FakeElevation(bumpy_height), 50000);
  const auto open_damaged = [&] {
    return paging::PlanetFile::open(path.string(), [&](const lod::TileKey& tile) {
      if (tile.level > 0 && (static_cast<std::uint64_t>(lod::pack(tile)) * 0x9e3779b97f4a7c15ULL >> 40) % 7 < 3)
        throw paging::PlanetError("tile " + lod::to_string(tile) + " is damaged");
    });
  };
  const auto late = make(open_damaged());
  for (const double sun_azimuth_deg : {315.0, 60.0}) {
    core::DrawRequest request = request_for({20, 30, 60000, 30, -60, 0}, planet->radius_m(), 48, 36);
    request.sun = mars::sun_direction({20, 30}, sun_azimuth_deg, 30);
    request.settings.mode = core::Mode::kLit;
    request.settings.lod_tolerance_px = 0.5;
    const core::DrawResult waited = make(open_damaged())->draw(request);
    EXPECT_FALSE(waited.missing.empty());
    request.paging.wait = false;
    core::DrawResult result = late->draw(request);
    for (int n = 0; n < 5000 && !result.settled; ++n) result = late->draw(request);
    EXPECT_TRUE(result.settled);
    EXPECT_EQ(result.frame.range_m, waited.frame.range_m);
    EXPECT_EQ(result.frame.colour, waited.frame.colour);
  }
}

// Moves through ground of which some tiles cannot be read, others come late, and compares each image with S.
TEST_P(RendererContract, CertificatesHoldInPagedLateAndDamagedImages) {
  const auto path = dir_ / "p.vpe";
  const auto planet = build_fake(path, FakeElevation(bumpy_height), 50000);
  const paging::Surface surface(planet, std::size_t{1} << 26);
  test_support::Random random(20261124);
  double worst = 0;
  int images = 0, incomplete = 0;
  for (int flight = 0; flight < 25; ++flight) {
    const auto seed = static_cast<std::uint64_t>(flight);
    const std::uint64_t broken_of_8 = seed % 3 == 0 ? 0 : seed % 3 * 2;
    const auto hash = [seed](const lod::TileKey& tile) {
      return (static_cast<std::uint64_t>(lod::pack(tile)) * 31 + seed) * 0x9e3779b97f4a7c15ULL >> 40;
    };
    const auto draw = make(paging::PlanetFile::open(path.string(), [&](const lod::TileKey& tile) {
      if (tile.level == 0) return;
      if (hash(tile) % 8 < broken_of_8)
        throw paging::PlanetError("tile " + lod::to_string(tile) + " is damaged");
      if (hash(tile) % 16 == 15) std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }));
    mars::Pose pose{random.uniform(-180, 180), random.uniform(-85, 85),  random.log_uniform(15000, 3e6),
                    random.uniform(0, 360),    random.uniform(-90, -45), random.uniform(-10, 10)};
    for (int n = 0; n < 10; ++n, ++images) {
      pose.lon_deg += 2;
      pose.yaw_deg += 7;
      core::DrawRequest request = request_for(pose, planet->radius_m(), 48, 36);
      request.settings.lod_tolerance_px = request.settings.ray_cell_px = 0.5;
      request.settings.ray_mode = flight % 2 == 0 ? core::RayMode::kMultires : core::RayMode::kExact;
      request.paging.wait = n % 4 == 3;
      const core::DrawResult result = draw->draw(request);
      incomplete += result.missing.empty() ? 0 : 1;
      if (result.certificate.is_below_ground) continue;
      const double x = shift_over_bound(result, surface, request);
      if (!std::isnan(x)) worst = std::max(worst, x);
      EXPECT_LE(x, 1) << "flight " << flight << " image " << n;
    }
  }
  EXPECT_EQ(images, 250);
  EXPECT_GT(incomplete, 100);
  test_support::record_worst(
      is_rays() ? "rays: forward shift, incomplete" : "polygons: forward shift, incomplete", worst, 1,
      "of the certificate");
}

INSTANTIATE_TEST_SUITE_P(Backends, RendererContract, ::testing::Values(Backend::kPolygon, Backend::kRay),
                         [](const auto& backend) { return std::string(core::to_string(backend.param)); });

}  // namespace
