// Images are within their certificates: shifts against exact ray casts of the reference surface.
#include <gtest/gtest.h>

#include "tests/gl/certified.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::fine_around;
using test_support::Random;
using vpe::core::DrawRequest;
using vpe::core::DrawResult;

using PolygonError = test_support::GlTest;
using test_support::expect_certified;

TEST_F(PolygonError, ShiftsStayWithinTheCertificate) {
  const glm::dvec3 corner = glm::normalize(glm::dvec3(1, 1, 1));
  const auto planet =
      build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height, fine_around(corner, 0.05, 5000)), 50000);
  const paging::Surface surface(planet, std::size_t{1} << 28);
  const auto draw = renderer(planet);
  Random random(61);
  const mars::LonLat fine = mars::lon_lat(corner);
  struct Named {
    const char* name;
    mars::LonLat place;
  };
  const std::vector<Named> places{{"north pole", {0, 90}},
                                  {"south pole", {77, -90}},
                                  {"antimeridian", {180, 10}},
                                  {"cube corner", fine},
                                  {"cube edge", {45, 0}},
                                  {"face centre", {0, 0}},
                                  {"inset boundary", {fine.lon_deg + 3, fine.lat_deg}}};
  for (const Named& named : places) {
    for (const double height : {30.0, 1500.0, 60000.0, 3e6, 3.4e7}) {
      const double ground = surface.at(mars::direction(named.place)).height_m;
      const double pitch =
          height > 1e6 ? -90 : -mars::horizon_dip_rad(height, planet->radius_m()) / mars::kRadiansPerDegree - 8;
      const double fov = height > 1e7 ? 15 : 60;
      const mars::Pose pose{
          named.place.lon_deg,    named.place.lat_deg, ground + height, random.uniform(0, 360), pitch,
          random.uniform(-30, 30)};
      expect_certified(*draw, surface, test_support::request_for(pose, planet->radius_m(), 160, 96, fov),
                       std::string(named.name) + " at " + std::to_string(height) + " m");
    }
  }
}

TEST_F(PolygonError, RandomViews) {
  const glm::dvec3 hotspot = glm::normalize(glm::dvec3(0.2, -0.4, 1));
  const auto planet =
      build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height, fine_around(hotspot, 0.05, 10000)), 60000);
  const paging::Surface surface(planet, std::size_t{1} << 28);
  const auto draw = renderer(planet);
  Random random(62);
  for (int n = 0; n < 20; ++n) {
    const mars::LonLat place =
        mars::lon_lat(n % 2 == 0 ? random.direction() : glm::normalize(hotspot + 0.05 * random.direction()));
    const double ground = surface.at(mars::direction(place)).height_m;
    const mars::Pose pose{place.lon_deg,          place.lat_deg,          ground + random.log_uniform(2, 2e6),
                          random.uniform(0, 360), random.uniform(-60, 5), random.uniform(-180, 180)};
    expect_certified(*draw, surface,
                     test_support::request_for(pose, planet->radius_m(), 160, 96, random.uniform(20, 90)),
                     "random view " + std::to_string(n));
  }
}

// Skirts are planes through the planet's centre: from exactly over a border they are seen edge-on, along it
// end-on.
TEST_F(PolygonError, BordersSeenEdgeOn) {
  const glm::dvec3 hotspot = mars::direction({45, 0});
  const auto planet =
      build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height, fine_around(hotspot, 0.02, 8000)), 60000);
  const paging::Surface surface(planet, std::size_t{1} << 28);
  const auto draw = renderer(planet);
  for (const mars::LonLat place :
       {mars::LonLat{45, 0}, mars::LonLat{45, 35.264389682754654}, mars::LonLat{0, 0}}) {
    const double ground = surface.at(mars::direction(place)).height_m;
    for (const double height : {30.0, 4000.0, 60000.0}) {
      for (const double yaw : {0.0, 90.0, 180.0}) {
        for (const double pitch : {-6.0, -40.0, -90.0}) {
          const mars::Pose pose{place.lon_deg, place.lat_deg, ground + height, yaw, pitch, 0};
          expect_certified(*draw, surface, test_support::request_for(pose, planet->radius_m(), 161, 97, 60),
                           std::to_string(place.lat_deg) + " at " + std::to_string(height) + " m, yaw " +
                               std::to_string(yaw) + ", pitch " + std::to_string(pitch));
        }
      }
    }
  }
}

// Here rounding relative to a tile's centre would move the image by many pixels.
TEST_F(PolygonError, AHandAboveTheGround) {
  const glm::dvec3 hotspot = glm::normalize(glm::dvec3(0.2, -0.4, 1));
  const auto planet =
      build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height, fine_around(hotspot, 0.02, 2000)), 60000);
  const paging::Surface surface(planet, std::size_t{1} << 28);
  const auto draw = renderer(planet);
  Random random(63);
  for (const double height : {0.1, 0.5, 2.0, 10.0}) {
    for (int n = 0; n < 4; ++n) {
      const mars::LonLat place = mars::lon_lat(glm::normalize(hotspot + 0.01 * random.direction()));
      const double ground = surface.at(mars::direction(place)).height_m;
      const mars::Pose pose{place.lon_deg, place.lat_deg, ground + height, random.uniform(0, 360), -30, 5};
      const DrawRequest request =
          test_support::request_for(pose, planet->radius_m(), 160, 96, n % 2 == 0 ? 60 : 25);
      expect_certified(*draw, surface, request, std::to_string(height) + " m");
      if (height >= 10.0) {
        EXPECT_LT(draw->draw(request).certificate.shift_bound_px, 1.5);
      }
    }
  }
}

TEST_F(PolygonError, ExaggeratedGroundKeepsItsCertificate) {
  // Ground of two depths: where they meet, the exaggerated surface is not S with heights times x.
  const mars::LonLat place{20, 30};
  const auto planet = build_fake(
      dir_ / "p.vpe", FakeElevation(bumpy_height, fine_around(mars::direction(place), 0.05, 10000)), 150000);
  const paging::Surface surface(planet, std::size_t{1} << 28);
  const auto draw = renderer(planet);
  for (const double x : {0.1, 3.0, 25.0}) {
    const mars::Pose pose{20, 30, 150000 + 6000 * x, 40, -35, 0};
    DrawRequest request = test_support::request_for(pose, planet->radius_m(), 160, 96);
    request.settings.exaggeration = x;
    const DrawResult result = draw->draw(request);
    const auto exaggerated = [&](std::span<const glm::dvec3> directions, std::span<double> radius_m) {
      surface.radius(directions, radius_m, x);
    };
    const auto shift = vpe::core::summarize(
        vpe::core::forward_shift_px(request.view, result.frame.range_m, exaggerated), request.view.width);
    EXPECT_LE(shift.max_px, result.certificate.shift_bound_px) << x;
    EXPECT_GT(shift.max_px, 0.1 * result.certificate.shift_bound_px) << x;
    EXPECT_GT(shift.pixels, 1000);
  }
}

// A planet without height differences is the analytic sphere, but for the flat facets.
TEST_F(PolygonError, FlatPlanetIsTheSphere) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation([](const glm::dvec3&) { return 0.0; }), 20000);
  const auto draw = renderer(planet);
  const double radius = planet->radius_m();
  const double spacing =
      lod::post_spacing_m(planet->meta().finest_level, planet->meta().tile.intervals(), radius);
  for (const double alt : {100.0, 10000.0, 400000.0, 5e6}) {
    const double dip = mars::horizon_dip_rad(alt, radius) / mars::kRadiansPerDegree;
    const DrawRequest request = test_support::request_for({33, -21, alt, 120, -dip, 17}, radius, 200, 150, 40);
    const DrawResult result = draw->draw(request);
    // Cells near a knot of the warp are up to 5 % wider than the mean.
    const double sagitta = result.certificate.geometric_error_m + 2.0 * 1.11 * spacing * spacing / (8 * radius);
    const float nearest = *std::min_element(result.frame.range_m.begin(), result.frame.range_m.end());
    // Storage and rasterising move a drawn point by this much across the ray, for each metre of distance.
    const double moved = result.certificate.quantisation_px / vpe::core::focal_px(request.view);
    int surface_pixels = 0;
    double worst_range = 0;
    for (int y = 0; y < 150; ++y) {
      for (int x = 0; x < 200; ++x) {
        const glm::dvec3 d = vpe::core::pixel_ray(request.view, x + 0.5, y + 0.5);
        const double half = glm::dot(request.view.camera.position_m, d);
        const double lowest =
            std::sqrt(glm::dot(request.view.camera.position_m, request.view.camera.position_m) - half * half);
        const float range = result.frame.range_m[static_cast<std::size_t>(y * 200 + x)];
        // The depth of the ray below the sphere decides; facets may be lower than the sphere by the sagitta.
        const double outer = radius + moved * std::abs(half);
        if (half > 0 || lowest > outer) {
          ASSERT_TRUE(std::isinf(range)) << alt << " " << x << " " << y;
        } else if (const double inner = radius - sagitta - moved * std::abs(half);
                   lowest < inner - 1e-6 * alt) {
          ASSERT_TRUE(std::isfinite(range)) << alt << " " << x << " " << y;
          ++surface_pixels;
          // The hit lies between the two spheres.
          const double near = -half - std::sqrt(outer * outer - lowest * lowest);
          const double far = -half - std::sqrt(inner * inner - lowest * lowest);
          const double slack = vpe::gl::kRangeError * (1 + far / nearest) * far;
          ASSERT_GE(range, near - slack) << alt << " " << x << " " << y;
          ASSERT_LE(range, far + slack) << alt << " " << x << " " << y;
          worst_range = std::max(worst_range, (near - range) / near);
        }
      }
    }
    EXPECT_GT(surface_pixels, 3000) << alt;
    RecordProperty("range_error_" + std::to_string(static_cast<int>(alt)), std::to_string(worst_range));
  }
}

TEST_F(PolygonError, ToleranceZeroDrawsTheReferenceSurface) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height), 150000);
  const paging::Surface surface(planet, std::size_t{1} << 28);
  DrawRequest request = test_support::request_for({-40, 12, 300000, 200, -40, 0}, planet->radius_m(), 160, 96);
  request.settings.lod_tolerance_px = 0;
  const DrawResult result = renderer(planet)->draw(request);
  EXPECT_EQ(result.certificate.geometric_error_m, 0);
  const auto shift = vpe::core::summarize(
      vpe::core::forward_shift_px(request.view, result.frame.range_m, test_support::radius_of(surface)), 160);
  EXPECT_LE(shift.max_px, result.certificate.shift_bound_px + 1e-3);
  EXPECT_LT(shift.max_px, 0.01);
}

}  // namespace
