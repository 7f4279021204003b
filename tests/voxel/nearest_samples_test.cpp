// Tests rays.sample=nearest: a pixel has the range of a ray at most half a spacing away, and the certificate says what that adds.
#include "vpe/voxel/cast/nearest_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "tests/gl/gl_fixture.h"
#include "tests/voxel/stated_range.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using test_support::CastRay;
using test_support::Random;
using vpe::voxel::RangeCaster;
using vpe::voxel::RangeOptions;
using vpe::voxel::SectorPlan;
using vpe::voxel::ViewSector;

constexpr std::size_t kBudget = std::size_t{1} << 28;

class NearestSamples : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = std::make_unique<test_support::TempDir>();
    planet_ = test_support::build_fake(*dir_ / "bumpy.vpe",
                                       test_support::FakeElevation(test_support::bumpy_height), 50000);
  }
  static void TearDownTestSuite() {
    planet_.reset();
    dir_.reset();
  }

  static std::vector<float> cast(RangeCaster& caster, const core::View& view, const RangeOptions& options,
                                 int threads = 2) {
    vpe::base::ThreadPool pool(threads);
    const glm::ivec2 size = core::drawn_size(view);
    std::vector<float> out(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), -1.0F);
    caster.cast(view, options, pool, out);
    return out;
  }

  // Returns a request of any pitch and roll; now and then straight down, with the middle of a pixel at V.
  static core::DrawRequest random_request(Random& random) {
    const paging::Surface surface(planet_, std::size_t{1} << 26);
    const mars::LonLat at = mars::lon_lat(random.direction());
    const double ground_m = surface.at(mars::direction(at)).height_m;
    mars::Pose pose{at.lon_deg,
                    at.lat_deg,
                    ground_m + random.log_uniform(2, 1e7),
                    random.uniform(0, 360),
                    random.uniform(-90, 30),
                    random.uniform(-180, 180)};
    if (random.integer(0, 4) == 0) pose.pitch_deg = -90;
    if (random.integer(0, 3) == 0) pose.roll_deg = 90 * random.integer(-1, 2);
    core::DrawRequest request = test_support::request_for(pose, planet_->radius_m(), random.integer(1, 61),
                                                          random.integer(1, 47), random.log_uniform(2, 140));
    core::View& view = request.view;
    if (random.integer(0, 1) == 0)
      view.principal_offset_px = {random.uniform(-20, 20), random.uniform(-20, 20)};
    if (random.integer(0, 2) == 0 && view.width > 4 && view.height > 4)
      view.part = {1, 2, view.width - 3, view.height - 4};
    request.settings.smooth_edges = false;
    request.settings.ray_sample = core::RaySample::kNearest;
    request.settings.ray_spacing_px = random.log_uniform(0.25, 4);
    return request;
  }

  static inline std::unique_ptr<test_support::TempDir> dir_;
  static inline std::shared_ptr<const paging::PlanetFile> planet_;
};

// Finds the ray of the sample nearest to a pixel, as place in the image; nullopt where the pixel has its own.
std::optional<glm::dvec2> nearest_ray(const SectorPlan& plan, double x, double y) {
  const SectorPlan::Side side = plan.side_of(x, y);
  const ViewSector* const sector = plan.sector_of(side);
  if (sector == nullptr) return std::nullopt;
  const double s = side.upright ? x : y;
  const double t = side.upright ? y : x;
  const auto step = static_cast<int>(std::floor(t)) - sector->first_step;
  if (step < 0 || step >= sector->steps) return std::nullopt;
  const ViewSector::Map& map = sector->maps[static_cast<std::size_t>(step)];
  const double line = std::floor((map.scale * s + map.shift - sector->first_line) / sector->spacing + 0.5);
  EXPECT_GE(line, 0) << x << " " << y;
  EXPECT_LT(line, sector->lines) << x << " " << y;
  const double nearest = (sector->first_line + line * sector->spacing - map.shift) / map.scale;
  return side.upright ? glm::dvec2(nearest, y) : glm::dvec2(x, nearest);
}

TEST_F(NearestSamples, PixelsHaveTheRangeOfARayHalfASpacingAwayAtMost) {
  RangeCaster caster(planet_, kBudget);
  const paging::Surface& surface = caster.surface();
  Random random(2028);
  int pixels = 0;
  int ties = 0;
  int own = 0;
  double farthest = 0;
  for (int n = 0; n < 60; ++n) {
    const core::DrawRequest request = random_request(random);
    const core::View& view = request.view;
    const double spacing_px = request.settings.ray_spacing_px;
    const std::vector<float> range_m =
        cast(caster, view, vpe::voxel::range_options(request, planet_->radius_m()));
    const SectorPlan plan(view, glm::normalize(view.camera.position_m), spacing_px);
    const core::SubRectangle part = core::drawn_part(view);
    for (std::size_t k = 0; k < range_m.size(); ++k) {
      const auto width = static_cast<std::size_t>(part.width);
      const double x = part.x + static_cast<double>(k % width) + 0.5;
      const double y = part.y + static_cast<double>(k / width) + 0.5;
      const std::optional<glm::dvec2> place = nearest_ray(plan, x, y);
      own += place ? 0 : 1;
      const glm::dvec2 at = place.value_or(glm::dvec2(x, y));
      farthest = std::max(farthest, glm::distance(at, {x, y}) / spacing_px);
      const CastRay ray{view.camera.position_m, core::pixel_ray(view, at.x, at.y)};
      const double exact = surface.cast(ray.camera_m, ray.direction);
      const auto seen = static_cast<double>(range_m[k]);
      ++pixels;
      if (std::isinf(exact) && std::isinf(seen)) continue;
      if (std::isfinite(exact) && std::isfinite(seen) &&
          test_support::stated_range_error(surface, ray, seen, exact) <= RangeCaster::range_error(view))
        continue;
      ++ties;
      ASSERT_TRUE(test_support::is_tie(surface, ray, seen, 1e-6))
          << n << ", " << x << " " << y << ": " << seen << " for " << exact;
    }
  }
  EXPECT_GT(pixels, 20000);
  EXPECT_LE(ties, pixels / 2000);
  EXPECT_LE(own, 60);
  EXPECT_LE(farthest, 0.5 + 1e-9);
  EXPECT_GT(farthest, 0.49);
}

TEST_F(NearestSamples, TheCertificateHoldsInModesExactAndMultires) {
  const paging::Surface surface(planet_, std::size_t{1} << 27);
  const auto draw = vpe::voxel::make_ray_renderer(planet_, {std::size_t{256} << 20, 2});
  Random random(2029);
  double worst = 0;
  for (int n = 0; n < 60; ++n) {
    core::DrawRequest request = random_request(random);
    request.settings.ray_mode = n % 2 == 0 ? core::RayMode::kExact : core::RayMode::kMultires;
    request.settings.ray_cell_px = random.log_uniform(0.25, 4);
    request.settings.exaggeration = n % 3 == 0 ? random.uniform(0.5, 8) : 1;
    if (n % 5 == 4) {
      request.view.width += 60;
      request.view.height += 40;
      request.settings.ray_fovea = 0.3;
      request.settings.ray_mode = core::RayMode::kMultires;
    }
    const core::DrawResult drawn = draw->draw(request);
    if (drawn.certificate.is_below_ground) continue;
    const core::Certificate& c = drawn.certificate;
    EXPECT_EQ(c.sample_distance_px, 0.5 * request.settings.ray_spacing_px);
    const core::SurfaceRadius radius = [&](std::span<const glm::dvec3> directions, std::span<double> radius_m) {
      surface.radius(directions, radius_m, request.settings.exaggeration);
    };
    for (const double shift_px : core::forward_shift_px(request.view, drawn.frame.range_m, radius, {1, 1})) {
      if (std::isnan(shift_px)) continue;
      worst = std::max(worst, shift_px / c.shift_bound_px);
      ASSERT_LE(shift_px, c.shift_bound_px) << n;
    }
    core::DrawRequest own = request;
    own.settings.ray_sample = core::RaySample::kPixel;
    const core::Certificate without = draw->draw(own).certificate;
    EXPECT_EQ(without.sample_distance_px, 0);
    EXPECT_LT(without.shift_bound_px, c.shift_bound_px);
  }
  std::printf("largest shift of its bound: %.3f\n", worst);
  EXPECT_GT(worst, 0.1);
}

TEST_F(NearestSamples, ThreadsPartsAndEarlierImagesDoNotMatter) {
  RangeCaster used(planet_, kBudget);
  Random random(2030);
  for (int n = 0; n < 12; ++n) {
    core::DrawRequest request = random_request(random);
    if (n % 2 == 0) request.view.width += 150;
    RangeOptions options = vpe::voxel::range_options(request, planet_->radius_m());
    const std::vector<float> alone = cast(used, request.view, options, 1);
    EXPECT_EQ(cast(used, request.view, options, 5), alone) << n;
    RangeCaster fresh(planet_, kBudget);
    EXPECT_EQ(cast(fresh, request.view, options), alone) << n;
    const core::SubRectangle part = core::drawn_part(request.view);
    options.only = {part.x + part.width / 3, part.y + part.height / 3, part.width / 2, part.height / 2};
    const std::vector<float> some = cast(fresh, request.view, options);
    for (int y = options.only.y - part.y; y < options.only.y - part.y + options.only.height; ++y) {
      for (int x = options.only.x - part.x; x < options.only.x - part.x + options.only.width; ++x) {
        const auto k = static_cast<std::size_t>(y * part.width + x);
        ASSERT_EQ(some[k], alone[k]) << n << ", " << x << " " << y;
      }
    }
  }
}

// Between diagonals through V a sector has no more lines than these enclose, wherever V is.
TEST_F(NearestSamples, SectorsHaveTheLinesBesideTheirPixelsAlone) {
  Random random(2031);
  double most_of_enclosed = 0;
  for (int n = 0; n < 200; ++n) {
    const core::DrawRequest request = random_request(random);
    const core::View& view = request.view;
    const glm::dvec3 up = glm::normalize(view.camera.position_m);
    const double spacing_px = request.settings.ray_spacing_px;
    const SectorPlan plan(view, up, spacing_px);
    const core::SubRectangle part = core::drawn_part(view);
    const mars::Axes& axes = view.camera.axes;
    const glm::dvec2 v = glm::dvec2(0.5 * view.width, 0.5 * view.height) + view.principal_offset_px +
                         core::focal_px(view) / glm::dot(up, axes.forward) *
                             glm::dvec2(glm::dot(up, axes.right), -glm::dot(up, axes.up));
    for (const ViewSector& sector : plan.sectors()) {
      double low = sector.lines;
      double high = -1;
      for (int y = part.y; y < part.y + part.height; ++y) {
        for (int x = part.x; x < part.x + part.width; ++x) {
          if (plan.sector_of(plan.side_of(x + 0.5, y + 0.5)) != &sector) continue;
          const int step = (sector.upright ? y : x) - sector.first_step;
          if (step < 0 || step >= sector.steps) continue;
          const ViewSector::Map& map = sector.maps[static_cast<std::size_t>(step)];
          const double line =
              (map.scale * ((sector.upright ? x : y) + 0.5) + map.shift - sector.first_line) / spacing_px;
          low = std::min(low, line);
          high = std::max(high, line);
        }
      }
      if (high < low) continue;  // its steps are all too near to V
      EXPECT_GE(low, 0) << n;
      EXPECT_LE(high, sector.lines - 1) << n;
      const double enclosed = 2 * std::abs(sector.reference - (sector.upright ? v.y : v.x)) / spacing_px;
      EXPECT_LE(sector.lines, 1.1 * enclosed + 5 + 2 / spacing_px) << n;
      most_of_enclosed = std::max(most_of_enclosed, sector.lines / enclosed);
    }
  }
  EXPECT_GT(most_of_enclosed, 0.9);
}

TEST_F(NearestSamples, AutoTakesThemForSeveralSamplesOfColoursAlone) {
  const auto draw = vpe::voxel::make_ray_renderer(planet_, {std::size_t{256} << 20, 2});
  core::DrawRequest request =
      test_support::request_for({10, 20, 300000, 30, -35, 10}, planet_->radius_m(), 64, 48);
  EXPECT_EQ(request.settings.ray_sample, core::RaySample::kAuto);
  EXPECT_FALSE(vpe::voxel::takes_nearest(request));
  const core::DrawResult one = draw->draw(request);
  EXPECT_EQ(one.certificate.sample_distance_px, 0);
  request.settings.samples = 4;
  EXPECT_TRUE(vpe::voxel::takes_nearest(request));
  const core::DrawResult four = draw->draw(request);
  EXPECT_EQ(four.certificate.sample_distance_px, 0.5);
  EXPECT_EQ(four.frame.range_m, one.frame.range_m);
  request.settings.ray_sample = core::RaySample::kPixel;
  EXPECT_EQ(draw->draw(request).certificate.sample_distance_px, 0);
  request.settings.ray_sample = core::RaySample::kAuto;
  request.want_colour = false;
  EXPECT_FALSE(vpe::voxel::takes_nearest(request));
  request.want_colour = true;
  request.view.projection = core::Projection::kCylinder;
  EXPECT_FALSE(vpe::voxel::takes_nearest(request));
}

TEST_F(NearestSamples, OtherModesAndProjectionsRefuseThem) {
  core::DrawRequest request =
      test_support::request_for({10, 20, 300000, 30, -35, 10}, planet_->radius_m(), 64, 48);
  request.settings.ray_sample = core::RaySample::kNearest;
  EXPECT_EQ(vpe::voxel::why_not(request), "");
  for (const core::RayMode mode :
       {core::RayMode::kReference, core::RayMode::kDiscrete, core::RayMode::kVolume}) {
    request.settings.ray_mode = mode;
    EXPECT_NE(vpe::voxel::why_not(request).find("rays.sample=nearest"), std::string::npos);
  }
  request.settings.ray_mode = core::RayMode::kMultires;
  request.view.projection = core::Projection::kCylinder;
  EXPECT_NE(vpe::voxel::why_not(request).find("perspective"), std::string::npos);
}

}  // namespace
