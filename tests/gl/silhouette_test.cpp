// Silhouettes from far away: single pixels show ground far behind the horizon of the reference surface, because
// coarse meshes lie below it, and no more of it than the certificate allows.
#include <gtest/gtest.h>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/hidden_depth.h"
#include "tests/support/worst.h"

namespace {

namespace core = vpe::core;
using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::Random;

using Silhouettes = test_support::GlTest;

// Returns true if the reference surface is met near to where a pixel shows ground by no ray that is raised or
// lowered by at most `shift_px`.
bool is_shown_by_no_ray(const paging::Surface& surface, const core::View& view, const glm::dvec3& ray,
                        double seen_m, double shift_px) {
  const glm::dvec3& camera_m = view.camera.position_m;
  const glm::dvec3 side = glm::normalize(glm::cross(ray, camera_m));
  const glm::dvec3 over = glm::cross(side, ray);
  const auto range_at = [&](double raised_px) {
    return surface.cast(camera_m, glm::normalize(ray + raised_px / core::focal_px(view) * over));
  };
  constexpr int kSteps = 64;
  double below_px = -shift_px;
  double below_m = range_at(below_px);
  for (int k = 1; k <= kSteps; ++k) {
    const double step_px = shift_px * (2.0 * k / kSteps - 1);
    const double step_m = range_at(step_px);
    // Bisects for a ray that meets the place, or for the jump over it.
    double low_px = below_px, low_m = below_m, high_px = step_px, high_m = step_m;
    for (int n = 0; n < 40 && (low_m < seen_m) != (high_m < seen_m); ++n) {
      if (std::abs(low_m - seen_m) < 1e-3 * seen_m || std::abs(high_m - seen_m) < 1e-3 * seen_m) return false;
      const double middle_px = 0.5 * (low_px + high_px);
      const double middle_m = range_at(middle_px);
      if ((middle_m < seen_m) == (low_m < seen_m)) {
        low_px = middle_px;
        low_m = middle_m;
      } else {
        high_px = middle_px;
        high_m = middle_m;
      }
    }
    below_px = step_px;
    below_m = step_m;
  }
  return true;
}

TEST_F(Silhouettes, ShowNothingThatLiesDeeperBehindGroundThanIsStated) {
  const auto planet = build_fake(dir_ / "p.vpe", FakeElevation(bumpy_height), 60000);
  const paging::Surface surface(planet, std::size_t{1} << 28);
  const auto draw = renderer(planet);
  Random random(65);
  int strange = 0;
  double farthest_m = 0;
  double worst = 0;
  for (const double tolerance_px : {0.25, 1.0, 4.0, 16.0, 64.0}) {
    for (int n = 0; n < 3; ++n) {
      const mars::LonLat place = mars::lon_lat(random.direction());
      const double alt_m = random.log_uniform(3e5, 5e7);
      const mars::Pose pose{place.lon_deg, place.lat_deg, alt_m, random.uniform(0, 360), -90, 0};
      const double disc_deg =
          2 * std::asin(planet->radius_m() / (planet->radius_m() + alt_m)) / mars::kRadiansPerDegree;
      core::DrawRequest request =
          test_support::request_for(pose, planet->radius_m(), 128, 96, std::min(120.0, 1.1 * disc_deg));
      request.settings.lod_tolerance_px = tolerance_px;
      const core::DrawResult result = draw->draw(request);
      for (int k = 0; k < 128 * 96; ++k) {
        const glm::dvec2 pixel(k % 128 + 0.5, k / 128 + 0.5);
        const auto seen_m = static_cast<double>(result.frame.range_m[static_cast<std::size_t>(k)]);
        const glm::dvec3 ray = core::pixel_ray(request.view, pixel.x, pixel.y);
        const double exact_m = surface.cast(request.view.camera.position_m, ray);
        if (seen_m == exact_m || std::abs(seen_m - exact_m) < 1e-3 * exact_m) continue;
        const double deep_px = test_support::deepest_px(surface, request.view, ray, seen_m, 1);
        worst = std::max(worst, deep_px / result.certificate.shift_bound_px);
        // Ground that is seen steeply may be nearer or farther by the error itself.
        const double bound_m = result.certificate.shift_bound_px * seen_m / core::focal_px(request.view);
        if (std::isinf(seen_m) || std::abs(seen_m - exact_m) < 3 * bound_m ||
            !is_shown_by_no_ray(surface, request.view, ray, seen_m, result.certificate.shift_bound_px))
          continue;
        ++strange;
        if (std::isfinite(exact_m)) farthest_m = std::max(farthest_m, std::abs(seen_m - exact_m));
      }
    }
  }
  std::printf("%d pixels show what no ray within the stated shift meets, up to %.0f km off\n", strange,
              farthest_m / 1000);
  EXPECT_GT(strange, 0);
  test_support::record_worst("polygons: depth of rays below ground before what they show", worst, 1,
                             "of the certificate");
}

}  // namespace
