// Looks for views whose pixels are farther off than their certificates state: random and adversarial ones, of
// both backends, over planets of any size and relief.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/hidden_depth.h"
#include "tests/stability/terrains.h"
#include "tests/support/worst.h"
#include "vpe/core/backend.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using core::Backend;
using test_support::Random;

constexpr int kRandomViews = 5000;
constexpr int kAdversarialViews = 500;

struct HuntedPlanet {
  std::string name;
  std::shared_ptr<const paging::PlanetFile> planet;
  std::unique_ptr<paging::Surface> surface;
  std::unique_ptr<core::Renderer> draw;
};

class CertificateHunt : public test_support::GlTest, public ::testing::WithParamInterface<Backend> {
 protected:
  void add(const std::string& name, std::shared_ptr<const paging::PlanetFile> planet) {
    constexpr std::size_t kBudget = std::size_t{200} << 20;
    HuntedPlanet& p = planets_.emplace_back();
    p.name = name;
    p.surface = std::make_unique<paging::Surface>(planet, std::size_t{1} << 26);
    if (GetParam() == Backend::kPolygon) {
      p.draw = renderer(planet, kBudget);
    } else {
      p.draw = vpe::voxel::make_ray_renderer(planet, {kBudget, 2});
    }
    p.planet = std::move(planet);
  }

  void add_planets() {
    const glm::dvec3 fine = glm::normalize(glm::dvec3(1, 1, 1));
    add("levels",
        test_support::build_fake(dir_ / "levels.vpe",
                                 test_support::FakeElevation(test_support::bumpy_height,
                                                             test_support::fine_around(fine, 0.05, 5000)),
                                 100000));
    int n = 0;
    for (const double radius_m : {1.0, 6e3, 3.4e6, 1e9}) {
      for (const double amplitude : {0.008, 0.3}) {
        for (const test_support::StrangeGround& ground : test_support::strange_grounds(amplitude)) {
          const std::string name = ground.name;
          if (name != "hills" && name != "checkerboard" && name != "cliff") continue;
          if (amplitude > 0.1 && name == "hills") continue;
          add(name + ", radius " + std::to_string(radius_m) + " m, relief " + std::to_string(amplitude),
              test_support::build_ground(dir_ / std::to_string(n++), radius_m, ground));
        }
      }
    }
  }

  // Returns a view of the planet; an adversarial one touches the ground or the skyline, stands over poles, edges
  // and corners, or has an extreme lens.
  static core::DrawRequest view_of(Random& random, const HuntedPlanet& hunted, bool is_adversarial) {
    static const std::vector<mars::LonLat> hostile = test_support::hostile_places();
    const double radius_m = hunted.planet->radius_m();
    mars::LonLat place = mars::lon_lat(random.direction());
    if (random.integer(0, is_adversarial ? 1 : 9) == 0)
      place = hostile[static_cast<std::size_t>(random.integer(0, static_cast<int>(hostile.size()) - 1))];
    double exaggeration = random.integer(0, 1) == 0 ? 1 : random.log_uniform(0.1, 10);
    try {
      hunted.planet->tree().require_drawable(exaggeration);
    } catch (const std::exception&) {
      exaggeration = 1;
    }
    const double ground_m = hunted.surface->at(mars::direction(place), exaggeration).height_m;
    const bool is_low = is_adversarial && random.integer(0, 1) == 0;
    const double height_m = radius_m * (is_low ? random.log_uniform(3e-8, 1e-5) : random.log_uniform(1e-6, 10));
    const double dip_deg =
        mars::horizon_dip_rad(std::max(0.0, ground_m + height_m), radius_m) / mars::kRadiansPerDegree;
    const bool is_narrow = random.integer(0, 1) == 0;
    const double fov_deg = is_adversarial ? (is_narrow ? random.log_uniform(0.02, 2) : random.uniform(120, 165))
                                          : random.log_uniform(2, 120);
    const double pitch_deg =
        is_adversarial ? -dip_deg + random.uniform(-0.1, 0.1) * fov_deg : random.uniform(-90, 10);
    const double yaw_deg = random.uniform(-180, 180);
    const double roll_deg = random.uniform(-180, 180);
    core::DrawRequest request =
        test_support::request_for({place.lon_deg, place.lat_deg, ground_m + height_m, yaw_deg,
                                   std::clamp(pitch_deg, -90.0, 90.0), roll_deg},
                                  radius_m, 48, 36, fov_deg);
    request.settings.mode = core::Mode::kLit;
    request.settings.smooth_edges = false;
    request.settings.exaggeration = exaggeration;
    request.settings.lod_tolerance_px = random.log_uniform(0.05, 32);
    request.settings.ray_mode = random.integer(0, 1) == 0 ? core::RayMode::kExact : core::RayMode::kMultires;
    request.settings.ray_cell_px = random.log_uniform(0.1, 8);
    return request;
  }

  void hunt(const HuntedPlanet& hunted, const core::DrawRequest& request, int view) {
    const core::DrawResult result = hunted.draw->draw(request);
    const core::Certificate& c = result.certificate;
    if (!std::isfinite(c.shift_bound_px)) {
      ++unbounded_;
      return;
    }
    const double x = request.settings.exaggeration;
    const core::SurfaceRadius radius = [&](std::span<const glm::dvec3> directions, std::span<double> radius_m) {
      hunted.surface->radius(directions, radius_m, x);
    };
    const core::ShiftSummary shift =
        core::summarize(core::forward_shift_px(request.view, result.frame.range_m, radius), 48);
    if (shift.pixels == 0) return;
    ++certified_;
    const double ratio = shift.max_px / c.image_bound_px.value();
    if (ratio > 1 && ++over_ <= 10)
      std::printf("view %d of %s: %g of %g px at %d %d; fov %g, x %g, tolerance %g, height %g m\n", view,
                  hunted.name.c_str(), shift.max_px, *c.image_bound_px, shift.worst_x, shift.worst_y,
                  request.view.fov_deg, x, request.settings.lod_tolerance_px,
                  glm::length(request.view.camera.position_m) -
                      hunted.surface->at(request.view.camera.position_m, x).radius_m);
    shift_ = std::max(shift_, ratio);
    if (GetParam() != Backend::kPolygon) return;
    for (int k = view % 61; k < 48 * 36; k += 61) {
      const glm::dvec3 ray = core::pixel_ray(request.view, k % 48 + 0.5, k / 48 + 0.5);
      const auto seen_m = static_cast<double>(result.frame.range_m[static_cast<std::size_t>(k)]);
      const double deep_px = test_support::deepest_px(*hunted.surface, request.view, ray, seen_m, x, 60);
      if (deep_px > c.shift_bound_px && ++deep_over_ <= 10)
        std::printf("view %d of %s: %g of %g px deep at %d %d; fov %g, x %g, tolerance %g\n", view,
                    hunted.name.c_str(), deep_px, c.shift_bound_px, k % 48, k / 48, request.view.fov_deg, x,
                    request.settings.lod_tolerance_px);
      depth_ = std::max(depth_, deep_px / c.shift_bound_px);
    }
  }

  std::vector<HuntedPlanet> planets_;
  int certified_ = 0;
  int unbounded_ = 0;
  int over_ = 0;
  int deep_over_ = 0;
  double shift_ = 0;
  double depth_ = 0;
};

TEST_P(CertificateHunt, NoPixelIsFartherOffThanStated) {
  add_planets();
  Random random(97);
  for (int n = 0; n < kRandomViews + kAdversarialViews; ++n) {
    const HuntedPlanet& hunted = planets_[static_cast<std::size_t>(n) % planets_.size()];
    hunt(hunted, view_of(random, hunted, n >= kRandomViews), n);
  }
  std::printf("%d views certified, %d without a finite bound; %d beyond their bound, %d pixels too deep\n",
              certified_, unbounded_, over_, deep_over_);
  EXPECT_GT(certified_, (kRandomViews + kAdversarialViews) / 3);
  std::printf("worst shift %.3g of the certificate, worst depth %.3g\n", shift_, depth_);
  const std::string backend = GetParam() == Backend::kRay ? "rays" : "triangles";
  test_support::record_worst(backend + ": forward shift, hunted", shift_, 1, "of the certificate");
  if (GetParam() == Backend::kPolygon)
    test_support::record_worst("triangles: depth of rays, hunted", depth_, 1, "of the certificate");
}

INSTANTIATE_TEST_SUITE_P(LongBackends, CertificateHunt, ::testing::Values(Backend::kPolygon, Backend::kRay),
                         [](const auto& backend) { return std::string(core::to_string(backend.param)); });

}  // namespace
