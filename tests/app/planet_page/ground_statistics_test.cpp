// Slopes, elevations and areas of sources against surfaces in closed form.
#include "vpe/app/planet/info/ground_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/paging/planet_fixture.h"
#include "vpe/app/planet/info/source_coverage.h"
#include "vpe/app/planet/info/tile_area.h"

namespace vpe::app {
namespace {

using test_support::FakeElevation;

constexpr double kHeight_m = 8000;
constexpr double kWaves = 6;

double latitude_rad(const glm::dvec3& d) { return std::asin(std::clamp(d.z, -1.0, 1.0)); }

// Ground of rings about the axis.
double ring_height(const glm::dvec3& d) { return kHeight_m * std::sin(kWaves * latitude_rad(d)); }

// Returns the value below which a share of the sphere lies, by many rings of equal area.
template <class Value>
double true_percentile(double share, const Value& value) {
  constexpr int kRings = 200000;
  std::vector<double> values;
  for (int n = 0; n < kRings; ++n) values.push_back(value(std::asin(2 * (n + 0.5) / kRings - 1)));
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * kRings)];
}

TEST(GroundStatistics, OfRingsAreThoseOfTheClosedForm) {
  const test_support::TempDir dir;
  const auto planet = test_support::build_fake(dir / "rings.vpe", FakeElevation(ring_height), 40000);
  base::ThreadPool pool(2);
  const std::vector<GroundStatistics> levels = ground_statistics(*planet, pool);
  const GroundStatistics& finest = levels[finest_whole_level(levels)];
  EXPECT_EQ(finest.level, planet->meta().finest_level);
  EXPECT_NEAR(finest.slopes_deg.area_sr(), 4 * mars::kPi, 1e-3);
  const double radius_m = planet->radius_m();
  for (const double share : {0.05, 0.25, 0.5, 0.75, 0.95}) {
    const double slope_deg = true_percentile(share, [&](double lat) {
      const double rise = kHeight_m * kWaves * std::cos(kWaves * lat);
      const double radius = radius_m + kHeight_m * std::sin(kWaves * lat);
      return std::atan(std::abs(rise) / radius) / mars::kRadiansPerDegree;
    });
    // A chord of the baseline flattens a wave by (waves * angle)^2 / 24 of its slope.
    EXPECT_NEAR(finest.slopes_deg.percentile(share), slope_deg, 0.002 + 0.002 * slope_deg) << share;
    const double height_m =
        true_percentile(share, [&](double lat) { return kHeight_m * std::sin(kWaves * lat); });
    EXPECT_NEAR(finest.elevations_m.percentile(share), height_m, 25) << share;
  }
}

TEST(GroundStatistics, DoNotDependOnThreads) {
  const test_support::TempDir dir;
  const auto planet = test_support::build_fake(dir / "a.vpe", FakeElevation(test_support::bumpy_height), 60000);
  base::ThreadPool one(1);
  base::ThreadPool three(3);
  const auto a = ground_statistics(*planet, one);
  const auto b = ground_statistics(*planet, three);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_EQ(a[n].slopes_deg.percentile(0.37), b[n].slopes_deg.percentile(0.37));
    EXPECT_EQ(a[n].elevations_m.mean(), b[n].elevations_m.mean());
    EXPECT_EQ(a[n].slopes_deg.count(), b[n].slopes_deg.count());
  }
}

TEST(GroundStatistics, FlatGroundIsFlat) {
  const test_support::TempDir dir;
  const auto planet = test_support::build_fake(dir / "flat.vpe",
                                               FakeElevation([](const glm::dvec3&) { return 250.0; }), 200000);
  base::ThreadPool pool(1);
  for (const GroundStatistics& level : ground_statistics(*planet, pool)) {
    EXPECT_LT(level.slopes_deg.highest(), 1e-9);
    EXPECT_NEAR(level.elevations_m.percentile(0.5), 250, 1e-3);
  }
}

// Half of the planet has no data: a cap of 60 degrees has a quarter of the sphere.
TEST(SourceCoverage, SharesAreThoseOfACap) {
  const test_support::TempDir dir;
  const auto planet = test_support::build_fake(
      dir / "cap.vpe", FakeElevation([](const glm::dvec3& d) { return d.z > 0.5 ? std::nan("") : 100 * d.x; }),
      60000);
  base::ThreadPool pool(2);
  const SourceCoverage coverage = source_coverage(planet, 1 << 24, pool);
  ASSERT_EQ(coverage.sources.size(), 1U);
  EXPECT_NEAR(coverage.nodata_share, 0.25, 0.003);
  EXPECT_NEAR(coverage.sources[0].share + coverage.nodata_share + coverage.unknown_share, 1, 1e-9);
  EXPECT_EQ(coverage.map.source.front(), kNoSource);
  EXPECT_EQ(coverage.map.source.back(), 0);
  base::ThreadPool one(1);
  EXPECT_EQ(source_coverage(planet, 1 << 24, one).sources[0].share, coverage.sources[0].share);
  const auto levels = ground_statistics(*planet, pool);
  EXPECT_NEAR(levels.back().slopes_deg.area_sr() / (4 * mars::kPi), 0.75, 0.02);
}

TEST(TileArea, AllTilesOfALevelAreTheSphere) {
  for (const int level : {0, 3}) {
    double sum_sr = 0;
    for (int face = 0; face < mars::kFaces; ++face)
      for (int i = 0; i < 1 << level; ++i)
        for (int j = 0; j < 1 << level; ++j)
          sum_sr += tile_area_sr({static_cast<mars::Face>(face), level, i, j});
    EXPECT_NEAR(sum_sr, 4 * mars::kPi, 1e-12);
  }
}

TEST(Distribution, PercentilesOfEvenValues) {
  Distribution even(0, 10, 1000, Distribution::Spacing::kEven);
  EXPECT_TRUE(even.is_empty());
  EXPECT_EQ(even.share_between(0, 10), 0);
  Distribution square(0, 10, 1000, Distribution::Spacing::kSquare);
  for (int n = 0; n < 10000; ++n) {
    even.add((n + 0.5) / 1000, 1e-4);
    square.add((n + 0.5) / 1000, 1e-4);
  }
  for (const Distribution* d : {&even, &square}) {
    EXPECT_NEAR(d->percentile(0.25), 2.5, 0.011);
    EXPECT_NEAR(d->share_between(2, 3), 0.1, 0.002);
    EXPECT_NEAR(d->mean(), 5, 0.02);
    EXPECT_NEAR(d->rms(), std::sqrt(100.0 / 3), 0.02);
    EXPECT_EQ(d->count(), 10000);
    EXPECT_NEAR(d->area_sr(), 1, 1e-9);
  }
  Distribution ends(0, 1, 4, Distribution::Spacing::kEven);
  ends.add(-5, 1);
  ends.add(7, 1);
  EXPECT_EQ(ends.lowest(), -5);
  EXPECT_EQ(ends.highest(), 7);
  EXPECT_EQ(ends.share_between(0, 0.25), 0.5);
}

}  // namespace
}  // namespace vpe::app
