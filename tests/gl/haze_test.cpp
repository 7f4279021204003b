// Haze in images agrees with its definition (vpe/core/appearance/shading.h) pixel by pixel.
#include "vpe/core/appearance/shading.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "tests/gl/gl_fixture.h"
#include "vpe/core/appearance/sky.h"

namespace {

namespace core = vpe::core;

constexpr int kWidth = 96;
constexpr int kHeight = 72;
const mars::LonLat kPlace{20, 15};

using Haze = test_support::GlTest;

TEST_F(Haze, EveryPixelIsDimmedByTheAirInFrontOfIt) {
  const test_support::FakeElevation source(test_support::bumpy_height,
                                           test_support::fine_around(mars::direction(kPlace), 0.05, 4000));
  const auto file = test_support::build_fake(dir_ / "p.vpe", source, 60000);
  const double radius_m = file->radius_m();
  const double ground_m = test_support::bumpy_height(mars::direction(kPlace));
  const auto draw = renderer(file);
  const paging::Surface surface(file, std::size_t{1} << 26);
  struct Camera {
    double alt_m, pitch_deg, fov_deg;
  };
  for (const Camera& camera : {Camera{ground_m + 1500, -3, 50}, Camera{80000, -25, 60}, Camera{8e6, -88, 40}}) {
    for (const auto& [sun_deg, tolerance_px] : {std::pair{35.0, 0.0}, {3.0, 0.0}, {35.0, 1.0}}) {
      core::DrawRequest r =
          test_support::request_for({kPlace.lon_deg, kPlace.lat_deg, camera.alt_m, 70, camera.pitch_deg, 15},
                                    radius_m, kWidth, kHeight, camera.fov_deg);
      r.settings.background = core::Background::kBlack;
      r.settings.smooth_edges = false;
      r.settings.lod_tolerance_px = tolerance_px;
      r.sun = mars::sun_direction(kPlace, 250, sun_deg);
      const core::DrawResult clear = draw->draw(r);
      // Coarse triangles far away are chords below the ground; haze is that of the air in front of the ground.
      const std::vector<float> ranges_m =
          tolerance_px > 0 ? test_support::reference_ranges(surface, r.view) : clear.frame.range_m;
      for (const double visibility_m : {20000.0, 200000.0}) {
        r.settings.haze_visibility_m = visibility_m;
        const core::DrawResult hazy = draw->draw(r);
        r.settings.haze_visibility_m = 0;
        ASSERT_EQ(hazy.frame.range_m, clear.frame.range_m);
        const double camera_m = glm::length(r.view.camera.position_m);
        int ground = 0, good = 0, sky = 0, same_sky = 0, changed = 0;
        double worst = 0;
        for (int y = 0; y < kHeight; ++y) {
          for (int x = 0; x < kWidth; ++x) {
            const auto at = static_cast<std::size_t>(y * kWidth + x);
            const auto rgb = [](const vpe::base::Rgb& c) { return glm::dvec3(c.r, c.g, c.b); };
            const glm::dvec3 before = rgb(clear.frame.colour[at]), got = rgb(hazy.frame.colour[at]);
            if (!std::isfinite(clear.frame.range_m[at])) {
              ++sky;
              same_sky += got == before ? 1 : 0;
              continue;
            }
            if (!std::isfinite(ranges_m[at])) continue;
            const double range_m = ranges_m[at];
            const glm::dvec3 ray = core::pixel_ray(r.view, x + 0.5, y + 0.5);
            const glm::dvec3 up = r.view.camera.position_m / camera_m;
            const double left = core::transmittance(
                core::air_m(radius_m, camera_m - radius_m, glm::dot(ray, up), range_m), visibility_m);
            const glm::dvec3 hit = r.view.camera.position_m + range_m * ray;
            const glm::dvec3 wanted = glm::mix(core::haze_colour(core::air_of(core::Atmosphere::kMars).haze,
                                                                 glm::dot(glm::normalize(hit), r.sun)),
                                               before, left);
            const glm::dvec3 off = glm::abs(got - wanted);
            const double most = std::max({off.x, off.y, off.z});
            worst = std::max(worst, most);
            ++ground;
            good += most <= 2 ? 1 : 0;
            changed += glm::length(got - before) > 8 ? 1 : 0;
          }
        }
        std::printf(
            "camera at %.0f m, sun at %.0f, tolerance %.0f, visibility %.0f km: %d of %d pixels of ground "
            "within 2, worst %.1f, %d changed\n",
            camera.alt_m, sun_deg, tolerance_px, visibility_m / 1000, good, ground, worst, changed);
        if (tolerance_px > 0) {
          // A pixel is up to 80 km here, and heights are coarse like the rest.
          EXPECT_LE(worst, 20);
        } else {
          EXPECT_GE(good, 0.999 * ground);
        }
        EXPECT_EQ(same_sky, sky);
        EXPECT_GT(ground, kWidth * kHeight / 4);
        if (visibility_m < 1e5) {
          EXPECT_GT(changed, ground / 2);
        }
      }
    }
  }
}

}  // namespace
