// Fifty named and two hundred random views of whole planets, real and embedded, against exact casts.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "mars/embedded/embedded.h"
#include "paging/build/builder.h"
#include "tests/gl/certified.h"
#include "vpe/base/quantile.h"

namespace {

using test_support::expect_certified;
using test_support::Random;
using test_support::request_for;
using vpe::base::median_upper;

constexpr int kWidth = 240;
constexpr int kHeight = 144;

class LongViews : public test_support::GlTest {
 protected:
  void check(const std::shared_ptr<const paging::PlanetFile>& planet) {
    const paging::Surface surface(planet, std::size_t{1} << 29);
    const auto draw = renderer(planet, std::size_t{1} << 29);
    named_views(*draw, surface);
    random_views(*draw, surface);
  }

  // $VPE_EMBEDDED_PLANET may name a planet file of the embedded Mars that exists already.
  std::shared_ptr<const paging::PlanetFile> embedded() {
    const char* ready = std::getenv("VPE_EMBEDDED_PLANET");
    std::string path = ready != nullptr ? ready : "";
    if (path.empty()) {
      paging::BuildOptions options;
      options.output = path = (dir_ / "embedded.vpe").string();
      options.resampling_posts = 10000;
      paging::build_planet(options, *mars::embedded_elevation(), nullptr);
    }
    return paging::PlanetFile::open(path);
  }

  // Returns a view from anywhere, every second one over the canyons; 1.5 m to 30 000 km above ground.
  static vpe::core::DrawRequest random_request(Random& random, int n, const paging::Surface& surface, int width,
                                               int height) {
    const glm::dvec3 at = n % 2 == 0
                              ? random.direction()
                              : glm::normalize(mars::direction({-64, -12.8}) + 0.03 * random.direction());
    const mars::LonLat place = mars::lon_lat(at);
    const double ground = surface.at(at).height_m;
    const mars::Pose pose{
        place.lon_deg,          place.lat_deg,           ground + random.log_uniform(1.5, 3e7),
        random.uniform(0, 360), random.uniform(-90, 10), random.uniform(-180, 180)};
    return request_for(pose, surface.planet_radius_m(), width, height, random.log_uniform(2, 110));
  }

 private:
  void named_views(vpe::core::Renderer& draw, const paging::Surface& surface) {
    const struct {
      const char* name;
      mars::LonLat place;
    } places[] = {{"Olympus Mons", {-133.125, 17.375}},
                  {"Olympus scarp", {-133.9, 21.0}},
                  {"Coprates Chasma", {-64.2, -12.84}},
                  {"Hellas", {70, -42.5}},
                  {"Argyre", {-43, -50}},
                  {"north pole", {0, 90}},
                  {"south pole", {0, -90}},
                  {"antimeridian", {180, -10}},
                  {"cube edge", {45, 12}},
                  {"cube corner", {-135, 35.264389682754654}}};
    Random random(81);
    const double radius = surface.planet_radius_m();
    for (const auto& p : places) {
      const double ground = surface.at(mars::direction(p.place)).height_m;
      for (const double height : {2.0, 150.0, 6000.0, 4e5, 1.2e7}) {
        const double dip =
            mars::horizon_dip_rad(std::max(ground + height, 1.0), radius) / mars::kRadiansPerDegree;
        const double pitch = height > 1e6 ? -90 : height > 1e5 ? -dip - 15 : -dip - 4;
        const mars::Pose pose{p.place.lon_deg,        p.place.lat_deg, ground + height,
                              random.uniform(0, 360), pitch,           random.uniform(-40, 40)};
        expect_certified(draw, surface, request_for(pose, radius, kWidth, kHeight, 60),
                         std::string(p.name) + " from " + std::to_string(height) + " m", 1);
      }
    }
  }

  void random_views(vpe::core::Renderer& draw, const paging::Surface& surface) {
    Random random(82);
    for (int n = 0; n < 200; ++n) {
      expect_certified(draw, surface, random_request(random, n, surface, kWidth, kHeight),
                       "random view " + std::to_string(n), 1);
    }
  }
};

TEST_F(LongViews, MolaKeepsItsCertificates) {
  VPE_NEED_SHARED(dem, "mola8/mola8_topo.lbl");
  paging::BuildOptions options;
  options.output = (dir_ / "mola8.vpe").string();
  options.resampling_posts = 10000;
  paging::build_planet(options, *mars::open_elevation(dem.string()), nullptr);
  check(paging::PlanetFile::open(options.output));
}

TEST_F(LongViews, EmbeddedMarsKeepsItsCertificates) { check(embedded()); }

// Bounds far above the true errors are of no use. An image of nothing but the reference surface has no error to
// measure, only the grid of the rasteriser and floats: there the bound itself is small.
TEST_F(LongViews, CertificatesAreNotLazy) {
  const auto planet = embedded();
  const paging::Surface surface(planet, std::size_t{1} << 29);
  const auto draw = renderer(planet, std::size_t{1} << 29);
  Random random(83);
  std::vector<double> ratios;  // stated to measured maximum, for each image with coarser tiles
  std::array<std::vector<double>, 8> ratios_from;  // the same by decade of height above ground
  std::vector<double> exact_px;                    // stated where every tile is the reference surface
  constexpr int kViews = 1000;
  for (int n = 0; n < kViews; ++n) {
    const vpe::core::DrawRequest request = random_request(random, n, surface, 256, 144);
    const vpe::core::DrawResult result = draw->draw(request);
    const auto reference = test_support::reference_ranges(surface, request.view);
    const auto errors = vpe::core::compare_to_reference(request.view, result.frame.range_m, reference,
                                                        test_support::radius_of(surface), {2, 2});
    const double bound_px = result.certificate.image_bound_px.value();
    // Without this term one pixel of view 268 is beyond its bound (docs/design/open-points.md).
    const double range_px = test_support::range_error_px(request.view, result.frame.range_m);
    ASSERT_LE(errors.forward.max_px, bound_px + range_px)
        << "view " << n << " " << vpe::core::to_json(errors) << vpe::core::to_json(result.certificate).dump(2);
    if (errors.forward.pixels < 4000) continue;  // nearly all sky
    if (result.certificate.screen_space_error_px == 0) {
      exact_px.push_back(bound_px);
      continue;
    }
    const double height_m =
        glm::length(request.view.camera.position_m) - surface.at(request.view.camera.position_m).radius_m;
    const auto decade = static_cast<std::size_t>(std::clamp(std::log10(height_m), 0.0, 7.0));
    ratios.push_back(bound_px / std::max(errors.forward.max_px, 1e-9));
    ratios_from[decade].push_back(ratios.back());
  }
  for (std::size_t decade = 0; decade < ratios_from.size(); ++decade) {
    std::vector<double>& r = ratios_from[decade];
    if (r.size() < 20) continue;
    std::printf("from 1e%zu m: %zu views, median of stated to measured %.2f\n", decade, r.size(),
                median_upper(r));
  }
  std::printf("all: %zu views, %.2f; %zu views of the reference surface itself, median of stated %.3f px\n",
              ratios.size(), median_upper(ratios), exact_px.size(), median_upper(exact_px));
  EXPECT_GT(ratios.size(), 0.3 * kViews);
  EXPECT_LE(median_upper(ratios), 4.0);
  EXPECT_LE(median_upper(exact_px), 0.1);
}

using LongHairlines = test_support::GlTest;

// Equal borders are stored relative to two centres. In many large images of nothing but ground no pixel between
// tiles may show the sky or the far side of the planet. Without ribbons 1 to 6 pixels of these images do.
TEST_F(LongHairlines, AreClosedByRibbons) {
  const auto planet =
      test_support::build_fake(dir_ / "p.vpe", test_support::FakeElevation(test_support::bumpy_height), 30000);
  const auto draw = renderer(planet);
  Random random(64);
  std::int64_t behind = 0;
  for (int n = 0; n < 60; ++n) {
    const mars::LonLat place = mars::lon_lat(random.direction());
    const double alt = random.log_uniform(1e5, 6e5);
    vpe::core::DrawRequest request =
        test_support::request_for({place.lon_deg, place.lat_deg, alt, random.uniform(0, 360), -90, 0},
                                  planet->radius_m(), 1200, 1200, 50);
    request.settings.lod_tolerance_px = 0.3;
    for (const float range : draw->draw(request).frame.range_m) behind += range < 4 * alt ? 0 : 1;
  }
  EXPECT_EQ(behind, 0);
}

}  // namespace
