// Images of the ray backend from 0.1 m to ten radii, 0.01 to 179 degrees wide, on planets of any size and
// ground that strains arithmetic: every pixel shows what a single exact cast shows, or what one less than a
// pixel beside it does.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/stability/terrains.h"
#include "tests/support/worst.h"
#include "vpe/base/parallel.h"
#include "vpe/voxel/cast/range_caster.h"

namespace {

namespace core = vpe::core;
using test_support::build_ground;
using test_support::Random;
using test_support::record_worst;
using test_support::StrangeGround;
using vpe::voxel::RangeCaster;
using vpe::voxel::RangeOptions;

constexpr std::size_t kBudget = std::size_t{1} << 26;
constexpr double kSame = 1e-5;  // of the range

struct Totals {
  double pixels = 0;
  double beside = 0;  // show a cast less than a pixel beside them
  double wrong = 0;   // show neither
  double range = 0;   // largest relative difference of the others, times the sine of incidence
  double wide = 0;    // the same in wide fields of view and over very large height differences
  double radial = 0;  // largest distance from S, radially, of what certificates state
};

bool same(double seen, double exact) {
  if (std::isinf(seen) || std::isinf(exact)) return std::isinf(seen) && std::isinf(exact);
  return std::abs(seen - exact) <= kSame * exact;
}

bool seen_beside(const paging::Surface& surface, const core::View& view, glm::dvec2 at, double seen,
                 double exaggeration) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  for (int n = 0; n < 24; ++n) {
    const double size = 0.25 * (n / 8 + 1);
    const glm::dvec2 moved = at + size * glm::dvec2(std::cos(0.785398 * n), std::sin(0.785398 * n));
    const double other =
        surface.cast(view.camera.position_m, core::pixel_ray(view, moved.x, moved.y), exaggeration);
    low = std::min(low, other);
    high = std::max(high, other);
  }
  return seen >= low * (1 - kSame) && seen <= high * (1 + kSame);
}

void check(RangeCaster& caster, vpe::base::ThreadPool& pool, const core::View& view, double exaggeration,
           Totals& totals) {
  const paging::PlanetMeta& meta = caster.surface().planet().meta();
  const bool wide = view.fov_deg > RangeCaster::kWide_deg ||
                    exaggeration * (meta.highest_radius_m - meta.lowest_radius_m) > 0.1 * meta.radius_m;
  const glm::ivec2 size = core::drawn_size(view);
  std::vector<float> range(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), -1.0F);
  const auto usage = caster.cast(view, {exaggeration}, pool, range);
  const double stated = caster.range_error(view, exaggeration) * std::hypot(1.0, usage.steepest_slope);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const auto seen = static_cast<double>(range[static_cast<std::size_t>(y * size.x + x)]);
      ASSERT_FALSE(std::isnan(seen) || seen < 0) << x << " " << y;
      const glm::dvec2 at(x + 0.5, y + 0.5);
      const glm::dvec3 ray = core::pixel_ray(view, at.x, at.y);
      const double exact = caster.surface().cast(view.camera.position_m, ray, exaggeration);
      totals.pixels += 1;
      if (same(seen, exact)) {
        if (!std::isfinite(exact) || exact <= 0) continue;
        const glm::dvec3 normal =
            caster.surface().at(view.camera.position_m + exact * ray, exaggeration).normal;
        double& range_error = wide ? totals.wide : totals.range;
        range_error = std::max(range_error, std::abs(glm::dot(normal, ray)) * std::abs(seen - exact) / exact);
        const glm::dvec3 place = view.camera.position_m + seen * ray;
        const double off_m = std::abs(glm::length(place) - caster.surface().at(place, exaggeration).radius_m);
        totals.radial = std::max(totals.radial, off_m / seen / stated);
      } else if (seen_beside(caster.surface(), view, at, seen, exaggeration)) {
        totals.beside += 1;
      } else {
        totals.wrong += 1;
      }
    }
  }
}

core::View random_view(Random& random, const paging::Surface& surface, double exaggeration, double fov_deg,
                       core::Projection projection) {
  static const std::vector<mars::LonLat> places = test_support::hostile_places();
  mars::LonLat place = mars::lon_lat(random.direction());
  if (random.integer(0, 1) == 0)
    place = places[static_cast<std::size_t>(random.integer(0, static_cast<int>(places.size()) - 1))];
  const double radius_m = surface.planet_radius_m();
  const double ground_m = surface.at(mars::direction(place), exaggeration).height_m;
  const double height_m = random.log_uniform(3e-8, 10) * radius_m;
  const double dip =
      mars::horizon_dip_rad(std::max(0.0, ground_m + height_m), radius_m) / mars::kRadiansPerDegree;
  const bool flat = projection == core::Projection::kPerspective;
  // About the skyline or straight down.
  const double pitch = !flat                       ? 0
                       : random.integer(0, 3) == 0 ? -90
                                                   : -dip - random.uniform(-0.4, 0.6) * std::min(fov_deg, 60.0);
  core::View view;
  view.projection = projection;
  view.fov_deg = fov_deg;
  view.width = 32;
  view.height = 24;
  view.camera = mars::to_camera({place.lon_deg, place.lat_deg, ground_m + height_m, random.uniform(-180, 180),
                                 std::max(-90.0, pitch), flat ? random.uniform(-180, 180) : 0},
                                radius_m);
  return view;
}

TEST(GeometryViews, PixelsAreTheCastsOfTheirRays) {
  test_support::TempDir dir;
  Random random(321);
  vpe::base::ThreadPool pool(2);
  Totals smooth;
  Totals rough;
  int n = 0;
  for (const double radius_m : {1.0, mars::kMarsRadius_m, 1e8}) {
    for (const StrangeGround& ground : test_support::strange_grounds(0.008)) {
      RangeCaster caster(build_ground(dir / std::to_string(n++), radius_m, ground), kBudget);
      const std::string name = ground.name;
      Totals& totals =
          name == "flat" || name == "constant" || name == "ramp" || name == "no data" ? smooth : rough;
      for (const double exaggeration : {0.1, 1.0, 100.0}) {
        for (const double fov_deg : {0.01, 1.0, 60.0, 120.0, 179.0}) {
          for (const core::Projection projection :
               {core::Projection::kPerspective, core::Projection::kCylinder}) {
            const core::View view = random_view(random, caster.surface(), exaggeration, fov_deg, projection);
            SCOPED_TRACE(name + " radius " + std::to_string(radius_m) + " times " +
                         std::to_string(exaggeration) + " fov " + std::to_string(fov_deg));
            check(caster, pool, view, exaggeration, totals);
          }
        }
      }
    }
  }
  EXPECT_GT(smooth.pixels + rough.pixels, 100000);
  record_worst("ray images: range times sine of incidence", std::max(smooth.range, rough.range),
               RangeCaster::kRangeError, "of the range");
  record_worst(
      "ray images, over 150 degrees or relief over a tenth of the radius: range times sine of incidence",
      std::max(smooth.wide, rough.wide), RangeCaster::kWideRangeError, "of the range");
  record_worst("ray images: radial distance from S", std::max(smooth.radial, rough.radial), 1,
               "of the certificate");
  record_worst("ray images, smooth ground: pixels of neither their own ray nor one beside",
               smooth.wrong / smooth.pixels, 0, "of all");
  record_worst("ray images, walls and spikes: pixels of neither their own ray nor one beside",
               rough.wrong / rough.pixels, 1e-3, "of all");
}

// From there all that other faces show lies along columns that point straight up. An earlier version lost
// parts of it.
TEST(GeometryViews, FromOverTheMiddleOfAFaceTheWholeDiscIsThere) {
  test_support::TempDir dir;
  vpe::base::ThreadPool pool(2);
  RangeCaster caster(build_ground(dir / "p", 3e6, {"flat", [](const glm::dvec3&) { return 0.0; }}), kBudget);
  Totals totals;
  for (const mars::LonLat at :
       {mars::LonLat{0, 0}, {90, 0}, {180, 0}, {-90, 0}, {0, 90}, {0, -90}, {45, 0}, {0, 45}}) {
    for (const double up : {0.5, 1.0, 3.0, 10.0}) {
      for (const core::Projection projection :
           {core::Projection::kPerspective, core::Projection::kCylinder, core::Projection::kEquirectangular}) {
        const bool flat = projection == core::Projection::kPerspective;
        core::View view;
        view.projection = projection;
        view.width = 32;
        view.height = 24;
        view.fov_deg = flat ? 2.2 * std::asin(1 / (1 + up)) / mars::kRadiansPerDegree : 178;
        view.camera =
            mars::to_camera({at.lon_deg, at.lat_deg, up * 3e6, 77, flat ? -90.0 : 0.0, flat ? 33.0 : 0.0}, 3e6);
        check(caster, pool, view, 1, totals);
      }
    }
  }
  record_worst("ray images from over the middle of a face: pixels of neither their own ray nor one beside",
               totals.wrong / totals.pixels, 0, "of all");
  record_worst("ray images: range times sine of incidence", totals.range, RangeCaster::kRangeError,
               "of the range");
  record_worst(
      "ray images, over 150 degrees or relief over a tenth of the radius: range times sine of incidence",
      totals.wide, RangeCaster::kWideRangeError, "of the range");
}

}  // namespace
