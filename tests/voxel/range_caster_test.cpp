// Tests ranges of columns against single exact casts, the analytic sphere, and each other.
#include "vpe/voxel/cast/range_caster.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "tests/gl/gl_fixture.h"
#include "tests/support/worst.h"
#include "tests/voxel/stated_range.h"
#include "vpe/voxel/cast/view_fan.h"
#include "vpe/voxel/columns/columns.h"

namespace {

namespace core = vpe::core;
using test_support::CastRay;
using test_support::is_tie;
using test_support::Random;
using vpe::voxel::RangeCaster;
using vpe::voxel::RangeOptions;

constexpr std::size_t kBudget = std::size_t{1} << 28;

std::vector<float> cast(RangeCaster& caster, const core::View& view, const RangeOptions& options = {},
                        int threads = 2) {
  vpe::base::ThreadPool pool(threads);
  const glm::ivec2 size = core::drawn_size(view);
  std::vector<float> out(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), -1.0F);
  caster.cast(view, options, pool, out);
  return out;
}

struct Agreement {
  int pixels = 0;
  int ties = 0;
  int wrong = 0;
  std::vector<double> error;  // relative, where both hit and agree
  double worst = 0;           // of the stated error
  double at(double share) {
    if (error.empty()) return 0;
    std::sort(error.begin(), error.end());
    return error[std::min(error.size() - 1,
                          static_cast<std::size_t>(share * static_cast<double>(error.size())))];
  }
};

// Pixels whose range differs by more than is stated are ties when a ray `tilt` radians away explains them.
void compare(Agreement& sum, const RangeCaster& caster, const core::View& view, const std::vector<float>& range,
             double exaggeration, double tilt, int expected = 0) {
  const paging::Surface& surface = caster.surface();
  const double stated = caster.range_error(view, exaggeration);
  const core::SubRectangle part = core::drawn_part(view);
  for (int y = 0; y < part.height; ++y) {
    for (int x = 0; x < part.width; ++x) {
      const CastRay ray{view.camera.position_m, core::pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5),
                        exaggeration};
      const double exact = surface.cast(ray.camera_m, ray.direction, exaggeration);
      const auto seen = static_cast<double>(range[static_cast<std::size_t>(y * part.width + x)]);
      ASSERT_FALSE(std::isnan(seen)) << x << " " << y;
      ++sum.pixels;
      if (std::isinf(exact) && std::isinf(seen)) continue;
      const bool finite = std::isfinite(exact) && std::isfinite(seen);
      const double error = finite ? test_support::stated_range_error(surface, ray, seen, exact) : 0;
      if (finite && error <= stated) {
        sum.error.push_back(std::abs(seen - exact) / exact);
        sum.worst = std::max(sum.worst, error / stated);
      } else if (is_tie(surface, ray, seen, tilt)) {
        ++sum.ties;
      } else {
        ++sum.wrong;
        if (sum.wrong <= 3 && expected == 0)
          ADD_FAILURE() << x << " " << y << ": " << seen << " for " << exact << "; " << view.width << "x"
                        << view.height << " fov " << view.fov_deg << " exaggeration " << exaggeration;
      }
    }
  }
}

class Columns : public testing::Test {
 protected:
  std::shared_ptr<const paging::PlanetFile> bumpy() {
    return test_support::build_fake(dir_ / "bumpy.vpe", test_support::FakeElevation(test_support::bumpy_height),
                                    50000);
  }

  // Returns a view from above ground in any direction, every few times over an edge or a corner of the cube.
  static core::View random_view(Random& random, const paging::Surface& surface, core::Projection projection,
                                double exaggeration) {
    glm::dvec3 place = random.direction();
    if (random.integer(0, 3) == 0) {
      place = {1, 1, random.integer(0, 1) == 0 ? 1.0 : random.uniform(-1, 1)};
      const double away = random.log_uniform(1e-9, 1e-2);
      place = glm::normalize(place + away * random.direction());
    }
    const mars::LonLat at = mars::lon_lat(place);
    const double ground = surface.at(mars::direction(at), exaggeration).height_m;
    mars::Pose pose{at.lon_deg, at.lat_deg, ground + random.log_uniform(1, 1e7), random.uniform(0, 360), 0, 0};
    core::View view;
    view.projection = projection;
    view.width = random.integer(1, 90);
    view.height = random.integer(1, 60);
    view.fov_deg = random.log_uniform(2, projection == core::Projection::kEquirectangular ? 180 : 150);
    view.principal_offset_px = {projection == core::Projection::kPerspective ? random.uniform(-30, 30) : 0.0,
                                random.uniform(-20, 20)};
    if (projection == core::Projection::kPerspective) {
      pose.pitch_deg = random.integer(0, 4) == 0 ? -90 : random.uniform(-90, 30);
      pose.roll_deg = random.integer(0, 3) == 0 ? 90 * random.integer(-1, 2) : random.uniform(-180, 180);
    }
    view.camera = mars::to_camera(pose, surface.planet_radius_m());
    if (random.integer(0, 2) == 0 && view.width > 4 && view.height > 4)
      view.part = {1, 2, view.width - 3, view.height - 4};
    return view;
  }

  // Returns a round view whose camera is tilted in any way.
  static core::View tilted_view(Random& random, const paging::Surface& surface, double exaggeration) {
    const bool is_cylinder = random.integer(0, 1) == 0;
    core::View view = random_view(
        random, surface, is_cylinder ? core::Projection::kCylinder : core::Projection::kEquirectangular,
        exaggeration);
    const double pitch =
        random.integer(0, 3) == 0 ? -mars::kPi / 2 : random.uniform(-mars::kPi / 2, mars::kPi / 2);
    const double roll = random.integer(0, 2) == 0 ? 0 : random.uniform(-mars::kPi, mars::kPi);
    mars::Axes& axes = view.camera.axes;
    const auto turn = [](glm::dvec3& a, glm::dvec3& b, double angle) {
      const glm::dvec3 turned = std::cos(angle) * a + std::sin(angle) * b;
      b = std::cos(angle) * b - std::sin(angle) * a;
      a = turned;
    };
    turn(axes.forward, axes.up, pitch);
    turn(axes.right, axes.up, roll);
    return view;
  }

  test_support::TempDir dir_;
};

TEST_F(Columns, RoundImagesAreExact) {
  RangeCaster caster(bumpy(), kBudget);
  Random random(71);
  Agreement sum;
  for (int n = 0; n < 60; ++n) {
    const double exaggeration = n % 3 == 0 ? random.uniform(0.5, 20) : 1.0;
    const core::View view = random_view(
        random, caster.surface(), n % 2 == 0 ? core::Projection::kCylinder : core::Projection::kEquirectangular,
        exaggeration);
    compare(sum, caster, view, cast(caster, view, {exaggeration}), exaggeration, 1e-6);
  }
  EXPECT_EQ(sum.wrong, 0) << "of " << sum.pixels;
  EXPECT_LE(sum.ties, sum.pixels / 2000);
  EXPECT_LT(sum.at(0.5), 2e-7);
  EXPECT_LT(sum.at(0.99), 2e-6);
}

// Compares a million rays of columns with single casts, which voxel/missed_hits_test compares with every
// triangle.
TEST_F(Columns, AMillionRaysOfRoundImages) {
  RangeCaster caster(bumpy(), kBudget);
  Random random(76);
  Agreement sum;
  while (sum.pixels < 1000000) {
    const double exaggeration = random.integer(0, 2) == 0 ? random.uniform(0.5, 20) : 1.0;
    const core::View view = random_view(
        random, caster.surface(),
        random.integer(0, 1) == 0 ? core::Projection::kCylinder : core::Projection::kEquirectangular,
        exaggeration);
    compare(sum, caster, view, cast(caster, view, {exaggeration}), exaggeration, 1e-6);
  }
  test_support::record_worst("columns: wrong pixels of a million", sum.wrong, 0, "pixels");
  test_support::record_worst("columns: ties of a million pixels", sum.ties, 5, "pixels");
  test_support::record_worst("columns: range error, 99.9 %", sum.at(0.999), 1e-6, "of the range");
  test_support::record_worst("columns: range error times sine of incidence", sum.worst, 1, "of the stated");
  std::printf("%d pixels, %d ties, %d wrong; error p50 %.2g p99 %.2g p99.9 %.2g\n", sum.pixels, sum.ties,
              sum.wrong, sum.at(0.5), sum.at(0.99), sum.at(0.999));
}

TEST_F(Columns, PerspectiveImagesAreExactButForWhatIsNarrowerThanAPixel) {
  RangeCaster caster(bumpy(), kBudget);
  Random random(72);
  Agreement sum;
  Agreement wide;
  for (int n = 0; n < 120; ++n) {
    const double exaggeration = n % 3 == 0 ? random.uniform(0.5, 20) : 1.0;
    core::View view = random_view(random, caster.surface(), core::Projection::kPerspective, exaggeration);
    const double pixel = 1.0 / core::focal_px(view);
    compare(pixel < 2e-3 ? sum : wide, caster, view, cast(caster, view, {exaggeration}), exaggeration,
            0.7 * pixel, 1);
  }
  EXPECT_EQ(sum.wrong, 0) << "of " << sum.pixels;
  EXPECT_LE(sum.ties, sum.pixels / 2000);
  // Ridges far wider than a pixel's neighbourhood hide behind pixels of a tenth of a radian.
  EXPECT_LE(wide.wrong, wide.pixels / 20000);
  EXPECT_LE(wide.ties, wide.pixels / 100);
  EXPECT_LT(sum.at(0.99), 1e-6);
  EXPECT_LT(wide.at(0.99), 1e-6);
}

// A ray between two columns may meet a crest that only one of them meets.
TEST_F(Columns, PerspectiveRaysSeldomMissCrestsBesideTheirSamples) {
  RangeCaster caster(bumpy(), kBudget);
  const paging::Surface& surface = caster.surface();
  Random random(76);
  std::int64_t pixels = 0;
  std::int64_t beyond = 0;
  std::int64_t nearer = 0;
  for (int n = 0; n < 24; ++n) {
    const mars::LonLat at = mars::lon_lat(random.direction());
    const double height_m = surface.at(mars::direction(at)).height_m + (n < 8 ? 2e3 : n < 16 ? 2e4 : 1e5);
    core::View view;
    view.width = 240;
    view.height = 160;
    view.fov_deg = 40;
    view.camera =
        mars::to_camera({at.lon_deg, at.lat_deg, height_m, random.uniform(0, 360), -5, 45.0 * (n % 2)},
                        surface.planet_radius_m());
    const std::vector<float> range = cast(caster, view, {1.0});
    for (std::size_t k = 0; k < range.size(); ++k) {
      const auto width = static_cast<std::size_t>(view.width);
      const glm::dvec3 ray =
          core::pixel_ray(view, static_cast<double>(k % width) + 0.5, static_cast<double>(k / width) + 0.5);
      const double exact = surface.cast(view.camera.position_m, ray);
      ++pixels;
      if (std::isinf(exact)) continue;
      beyond += static_cast<double>(range[k]) > exact * (1 + 1e-4) ? 1 : 0;
      nearer += static_cast<double>(range[k]) < exact * (1 - 1e-4) ? 1 : 0;
    }
  }
  std::printf("of %lld pixels %lld show ground behind a crest\n", static_cast<long long>(pixels),
              static_cast<long long>(beyond));
  // Without the search for crests 498.
  EXPECT_LE(beyond, pixels / 5000);
  EXPECT_EQ(nearer, 0);
}

TEST_F(Columns, TiltedRoundImagesAreExactButForWhatIsNarrowerThanAPixel) {
  RangeCaster caster(bumpy(), kBudget);
  Random random(78);
  Agreement sum;
  Agreement wide;
  int by_fan = 0;
  while (sum.pixels < 100000 || wide.pixels < 100000) {
    const double exaggeration = random.integer(0, 2) == 0 ? random.uniform(0.5, 20) : 1.0;
    core::View view = tilted_view(random, caster.surface(), exaggeration);
    const bool is_fine = wide.pixels > sum.pixels;
    if (is_fine) {
      // Wide enough for pixels of less than 2 mrad, of which a part is drawn.
      view.width = random.integer(5000, 9000);
      view.height = random.integer(400, 3000);
      view.fov_deg = std::min(view.fov_deg, 0.05 * view.height);
      view.principal_offset_px = {0, 0};
      view.part = {random.integer(0, 4900), random.integer(0, 340), 90, 60};
    }
    const vpe::voxel::ViewFan fan(view, glm::normalize(view.camera.position_m));
    const glm::ivec2 size = core::drawn_size(view);
    if (fan.sample_count() < 8 * static_cast<std::int64_t>(size.x) * size.y) ++by_fan;
    compare(fan.spacing_rad() < 2e-3 ? sum : wide, caster, view, cast(caster, view, {exaggeration}),
            exaggeration, 0.7 * fan.spacing_rad(), 1);
  }
  EXPECT_GE(by_fan, 40);
  EXPECT_EQ(sum.wrong, 0) << "of " << sum.pixels;
  EXPECT_LE(sum.ties, sum.pixels / 2000);
  EXPECT_LE(wide.wrong, wide.pixels / 20000);
  EXPECT_LE(wide.ties, wide.pixels / 100);
  EXPECT_LT(sum.at(0.99), 1e-6);
  EXPECT_LT(wide.at(0.99), 1e-6);
  std::printf("fine: %d pixels, %d ties, %d wrong, p99 %.2g; wide: %d, %d, %d, %.2g; %d views by fans\n",
              sum.pixels, sum.ties, sum.wrong, sum.at(0.99), wide.pixels, wide.ties, wide.wrong, wide.at(0.99),
              by_fan);
}

TEST_F(Columns, TiltedRoundImagesDependOnNoThreadsAndLittleOnVectorUnits) {
  RangeCaster caster(bumpy(), kBudget);
  Random random(79);
  int ties = 0;
  std::int64_t pixels = 0;
  for (int n = 0; n < 8; ++n) {
    core::View view = tilted_view(random, caster.surface(), 1);
    view.part = {};
    view.width = 90;
    view.height = 60;
    const std::vector<float> best = cast(caster, view);
    pixels += static_cast<std::int64_t>(best.size());
    ASSERT_EQ(best, cast(caster, view, {}, 1));
    ASSERT_EQ(best, cast(caster, view, {}, 5));
    RangeCaster fresh(caster.surface().shared_planet(), kBudget);
    ASSERT_EQ(best, cast(fresh, view));
    hwy::SetSupportedTargetsForTest(HWY_SCALAR);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const std::vector<float> other = cast(caster, view);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (std::size_t k = 0; k < best.size(); ++k) {
      const auto a = static_cast<double>(best[k]);
      const auto b = static_cast<double>(other[k]);
      if (a == b || std::abs(a - b) <= 2e-6 * a) continue;
      const glm::dvec3 ray =
          core::pixel_ray(view, static_cast<double>(k % 90) + 0.5, static_cast<double>(k / 90) + 0.5);
      EXPECT_TRUE(is_tie(caster.surface(), {view.camera.position_m, ray}, b, 0.7 / core::focal_px(view))) << k;
      ++ties;
    }
  }
  EXPECT_LE(ties, pixels / 500);
}

TEST_F(Columns, FlatPlanetIsTheSphere) {
  const auto planet = test_support::build_fake(
      dir_ / "flat.vpe", test_support::FakeElevation([](const glm::dvec3&) { return 0.0; }), 100000);
  RangeCaster caster(planet, kBudget);
  const double radius = planet->radius_m();
  const double spacing =
      lod::post_spacing_m(planet->meta().finest_level, planet->meta().tile.intervals(), radius);
  // Facets lie below the sphere by their sagitta at most.
  const double sagitta = 1.2 * spacing * spacing / (4 * radius);
  for (const double height : {1e5, 1e6, 1e7}) {
    core::View view;
    view.projection = core::Projection::kEquirectangular;
    view.fov_deg = 179;
    view.width = 64;
    view.height = 400;
    view.camera = mars::to_camera({20, 30, height, 0, 0, 0}, radius);
    const std::vector<float> range = cast(caster, view);
    for (int y = 0; y < view.height; ++y) {
      for (int x = 0; x < view.width; ++x) {
        const glm::dvec3 ray = core::pixel_ray(view, x + 0.5, y + 0.5);
        const double half = glm::dot(ray, view.camera.position_m);
        const double closest =
            std::sqrt(glm::dot(view.camera.position_m, view.camera.position_m) - half * half);
        const auto seen = static_cast<double>(range[static_cast<std::size_t>(y * view.width + x)]);
        // Leaves out the limb within the sagitta and one millionth.
        if (half >= 0 || closest > radius * (1 + 1e-6)) {
          ASSERT_TRUE(std::isinf(seen)) << x << " " << y;
        } else if (closest < radius * (1 - 1e-6) - 4 * sagitta) {
          const double under = std::sqrt(radius * radius - closest * closest);
          const double sine = under / radius;
          ASSERT_NEAR(seen, -half - under, (1e-6 * (-half - under) + 1.2 * sagitta) / sine) << x << " " << y;
        }
      }
    }
  }
}

TEST_F(Columns, VectorUnitsAndThreadsAgree) {
  RangeCaster caster(bumpy(), kBudget);
  Random random(73);
  int ties = 0;
  int compared = 0;
  for (int n = 0; n < 12; ++n) {
    const core::View view = random_view(random, caster.surface(), static_cast<core::Projection>(n % 3), 1);
    const std::vector<float> best = cast(caster, view);
    ASSERT_EQ(best, cast(caster, view, {}, 1));
    ASSERT_EQ(best, cast(caster, view, {}, 5));
    for (std::int64_t targets = hwy::SupportedTargets() & ~HWY_SCALAR; targets != 0;) {
      // Removes the best remaining target.
      targets &= targets - 1;
      hwy::SetSupportedTargetsForTest(targets != 0 ? targets : HWY_SCALAR);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      const std::string name = vpe::voxel::column_target();
      const std::vector<float> other = cast(caster, view);
      for (std::size_t k = 0; k < best.size(); ++k) {
        const auto a = static_cast<double>(best[k]);
        const auto b = static_cast<double>(other[k]);
        if (a == b) continue;
        const core::SubRectangle part = core::drawn_part(view);
        const auto width = static_cast<std::size_t>(part.width);
        const glm::dvec3 ray = core::pixel_ray(view, part.x + static_cast<double>(k % width) + 0.5,
                                               part.y + static_cast<double>(k / width) + 0.5);
        if (std::isinf(a) != std::isinf(b)) {
          EXPECT_TRUE(is_tie(caster.surface(), {view.camera.position_m, ray}, b, 1e-6)) << name << " " << k;
          ++ties;
        } else if (std::abs(a - b) > 2e-6 * a) {
          // A grazing ray: both ranges are on the surface.
          const glm::dvec3 place = view.camera.position_m + b * ray;
          EXPECT_NEAR(glm::length(place), caster.surface().at(place).radius_m, 1e-6 * b) << name << " " << k;
          ++ties;
        }
        ++compared;
      }
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  test_support::record_worst("columns: other vector units differ beyond 2e-6, all ties", ties, compared / 100,
                             "pixels");
}

TEST_F(Columns, ResultsDoNotDependOnWhatWasCastBefore) {
  const auto planet = bumpy();
  Random random(74);
  RangeCaster used(planet, std::size_t{1} << 21);
  for (int n = 0; n < 9; ++n) {
    const core::View view = random_view(random, used.surface(), static_cast<core::Projection>(n % 3), 1);
    RangeCaster fresh(planet, kBudget);
    EXPECT_EQ(cast(fresh, view), cast(used, view)) << n;
  }
}

TEST_F(Columns, CoarserCellsStayWithinTheirWidth) {
  RangeCaster caster(bumpy(), kBudget);
  const paging::Surface& surface = caster.surface();
  Random random(75);
  for (int n = 0; n < 12; ++n) {
    core::View view = random_view(random, surface, static_cast<core::Projection>(n % 3), 1);
    view.part = {};
    const double focal = core::focal_px(view);
    const std::vector<float> range = cast(caster, view, {1, 2.0});
    for (int y = 0; y < view.height; ++y) {
      for (int x = 0; x < view.width; ++x) {
        const auto seen = static_cast<double>(range[static_cast<std::size_t>(y * view.width + x)]);
        ASSERT_FALSE(std::isnan(seen));
        if (std::isinf(seen)) continue;
        // Posts of coarser tiles lie on the reference surface, so a facet is off by its slope over a cell at
        // most.
        const glm::dvec3 place = view.camera.position_m + seen * core::pixel_ray(view, x + 0.5, y + 0.5);
        const double off = std::abs(glm::length(place) - surface.at(place).radius_m);
        const double steepest = 4;
        ASSERT_LE(off, 2.0 * 1.5 * steepest * seen / focal + 1.0) << x << " " << y;
      }
    }
  }
}

TEST_F(Columns, ACameraBelowTheGroundSeesNothingFar) {
  RangeCaster caster(bumpy(), kBudget);
  core::View view;
  view.width = 16;
  view.height = 9;
  const double ground = caster.surface().at(mars::direction({10, 20})).height_m;
  view.camera = mars::to_camera({10, 20, ground - 5, 0, 0, 0}, caster.surface().planet_radius_m());
  for (const auto projection : {core::Projection::kPerspective, core::Projection::kCylinder}) {
    view.projection = projection;
    for (float range : cast(caster, view)) EXPECT_EQ(range, 0.0F);
  }
}

}  // namespace
