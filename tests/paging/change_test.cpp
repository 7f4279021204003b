// Change between two planets against closed forms, brute force and itself.
#include "paging/surface/change.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>

#include "paging/planet/planet_user.h"
#include "paging/surface/height_difference.h"
#include "tests/paging/planet_fixture.h"

namespace paging {
namespace {

using test_support::build_fake;
using test_support::FakeElevation;
using test_support::fine_around;

constexpr double kRadius_m = mars::kMarsRadius_m;
constexpr std::size_t kBudget = std::size_t{64} << 20;
constexpr double kSphere = 4 * mars::kPi * kRadius_m * kRadius_m;
const glm::dvec3 kMiddle = glm::normalize(glm::dvec3(0.7, 0.5, 0.3));
constexpr double kReach_rad = 0.02;  // 68 km

class Change : public ::testing::Test {
 protected:
  std::shared_ptr<const PlanetFile> build(const char* name, const FakeElevation& source,
                                          double base_spacing_m = 200000) const {
    return build_fake(dir_.path() / name, source, base_spacing_m);
  }
  ChangeStatistics measure(const std::shared_ptr<const PlanetFile>& earlier,
                           const std::shared_ptr<const PlanetFile>& later, const ChangeRegion& region = {},
                           double threshold_m = 0, int threads = 2) const {
    vpe::base::ThreadPool pool(threads);
    return measure_change(Surface(earlier, kBudget), Surface(later, kBudget), region,
                          {.threshold_m = threshold_m, .tell = {}}, pool);
  }

  test_support::TempDir dir_;
};

double level_ground(const glm::dvec3&) { return 0; }

// A bowl: -depth (1 - t^2) within kReach_rad.
double bowl(const glm::dvec3& d, double depth_m) {
  const double t = glm::length(d - kMiddle) / kReach_rad;
  return t < 1 ? -depth_m * (1 - t * t) : 0;
}

TEST(ChangeOfATriangle, PartsAboveAreThoseOfManySamples) {
  const auto mean = [](double a, double b, double c, auto&& f) {
    constexpr int kSteps = 400;
    double sum = 0;
    int count = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps - i; ++j, ++count) {
        const double x = (i + 1.0 / 3) / kSteps;
        const double y = (j + 1.0 / 3) / kSteps;
        sum += f(a * x + b * y + c * (1 - x - y));
      }
    }
    return sum / count;
  };
  const double corners[][3] = {{1, 2, 3},  {-1, -2, -3}, {3, -1, -2}, {-2, 3, -1}, {2, 1, -3},
                               {0, 0, 1},  {0, 1, 1},    {0, -1, 2},  {5, 5, 5},   {0, 0, 0},
                               {-4, 0, 0}, {1, -1, 0},   {2, 2, -1},  {-2, -2, 1}};
  for (const auto& [a, b, c] : corners) {
    EXPECT_NEAR(mean_of_positive_part(a, b, c), mean(a, b, c, [](double x) { return std::max(x, 0.0); }), 0.02)
        << a << " " << b << " " << c;
    EXPECT_NEAR(mean_of_positive_part(a, b, c) - mean_of_positive_part(-a, -b, -c), (a + b + c) / 3, 1e-15);
    for (const double above : {0.0, 0.5, 2.0})
      EXPECT_NEAR(share_above(a, b, c, above), mean(a, b, c, [=](double x) { return x > above ? 1.0 : 0.0; }),
                  0.01)
          << a << " " << b << " " << c << " above " << above;
  }
}

TEST_F(Change, APlanetDoesNotDifferFromItself) {
  const auto planet =
      build("a.vpe", FakeElevation(test_support::bumpy_height, fine_around(kMiddle, kReach_rad, 4000)));
  const ChangeStatistics same = measure(planet, planet);
  EXPECT_NEAR(same.area_m2, kSphere, 1e-9 * kSphere);
  EXPECT_EQ(same.changed_area_m2, 0);
  EXPECT_EQ(same.mean_m, 0);
  EXPECT_EQ(same.median_m, 0);
  EXPECT_EQ(same.rms_m, 0);
  EXPECT_EQ(same.gained_m3, 0);
  EXPECT_EQ(same.lost_m3, 0);
  EXPECT_EQ(same.least->difference_m, 0);
  EXPECT_EQ(same.most->difference_m, 0);
  EXPECT_EQ(same.nodata_area_m2, 0);
}

// A shell of 100 m around the whole sphere: its volume in closed form.
TEST_F(Change, ALiftedPlanetGainsAShell) {
  const auto low = build("a.vpe", FakeElevation([](const glm::dvec3&) { return -50.0; }));
  const auto high = build("b.vpe", FakeElevation([](const glm::dvec3&) { return 50.0; }));
  const ChangeStatistics change = measure(low, high, {}, 99);
  const double shell_m3 = 4 * mars::kPi / 3 * (std::pow(kRadius_m + 50, 3) - std::pow(kRadius_m - 50, 3));
  EXPECT_NEAR(change.gained_m3, shell_m3, 1e-8 * shell_m3);
  EXPECT_EQ(change.lost_m3, 0);
  EXPECT_NEAR(*change.mean_m, 100, 1e-9);
  EXPECT_NEAR(*change.median_m, 100, 0.01);
  EXPECT_NEAR(*change.rms_m, 100, 1e-9);
  EXPECT_NEAR(change.changed_area_m2, kSphere, 1e-9 * kSphere);
  EXPECT_EQ(measure(low, high, {}, 100).changed_area_m2, 0);
}

TEST_F(Change, ABowlHasItsVolume) {
  constexpr double kDepth_m = 400;
  const auto fine = fine_around(kMiddle, 2 * kReach_rad, 1000);
  const auto before = build("a.vpe", FakeElevation(level_ground, fine));
  const auto after = build("b.vpe", FakeElevation([](const glm::dvec3& d) { return bowl(d, kDepth_m); }, fine));
  const double cap_m2 = mars::kPi * std::pow(kReach_rad * kRadius_m, 2);  // exact: chords
  const ChangeStatistics change = measure(before, after, {}, 10);
  EXPECT_NEAR(change.lost_m3, cap_m2 * kDepth_m / 2, 1e-3 * cap_m2 * kDepth_m / 2);
  EXPECT_EQ(change.gained_m3, 0);
  EXPECT_EQ(*change.median_m, 0);
  EXPECT_NEAR(change.changed_area_m2, cap_m2 * (1 - 10 / kDepth_m), 5e-3 * cap_m2);
  ChangeRegion inside;
  inside.holds = [](const glm::dvec3& d) { return glm::length(d - kMiddle) < kReach_rad; };
  const ChangeStatistics in = measure(before, after, inside, 10);
  EXPECT_NEAR(in.area_m2, cap_m2, 2e-2 * cap_m2);
  EXPECT_NEAR(*in.mean_m, -kDepth_m / 2, 0.01 * kDepth_m);
  EXPECT_NEAR(*in.median_m, -kDepth_m / 2, 0.01 * kDepth_m);
  EXPECT_NEAR(*in.rms_m, kDepth_m / std::sqrt(3.0), 0.01 * kDepth_m);
  EXPECT_NEAR(in.changed_area_m2, cap_m2 * (1 - 10 / kDepth_m), 1e-2 * cap_m2);
  EXPECT_NEAR(in.least->difference_m, -kDepth_m, 1);
  EXPECT_LT(glm::length(mars::direction(in.least->place) - kMiddle), 0.05 * kReach_rad);
  EXPECT_LT(in.triangles, change.triangles);
}

// Changes add up, whichever tiles are finer: flat facets of a coarse planet lie below the sphere, and fine ones less.
TEST_F(Change, LevelsOfDetailMayDiffer) {
  const auto fine = fine_around(kMiddle, 2 * kReach_rad, 2000);
  const auto coarse = build("a.vpe", FakeElevation(level_ground));
  const auto level = build("b.vpe", FakeElevation(level_ground, fine));
  const auto dug = build("c.vpe", FakeElevation([](const glm::dvec3& d) { return bowl(d, 400); }, fine));
  const auto net_m3 = [](const ChangeStatistics& change) { return change.gained_m3 - change.lost_m3; };
  const ChangeStatistics facets = measure(coarse, level);
  const ChangeStatistics both = measure(coarse, dug);
  EXPECT_GT(facets.gained_m3, 1e10);
  EXPECT_NEAR(net_m3(both), net_m3(facets) + net_m3(measure(level, dug)), 1e-9 * facets.gained_m3);
  // The volume under facets by many single heights.
  const Surface before(coarse, kBudget);
  const Surface after(level, kBudget);
  double sum = 0;
  constexpr int kSamples = 200000;
  for (int n = 0; n < kSamples; ++n) {
    const double z = 1 - (2.0 * n + 1) / kSamples;
    const double angle = 2.399963229728653 * n;
    const double r = std::sqrt(1 - z * z);
    const glm::dvec3 at(r * std::cos(angle), r * std::sin(angle), z);
    sum += after.at(at).height_m - before.at(at).height_m;
  }
  EXPECT_NEAR(*facets.mean_m, sum / kSamples, 0.02 * sum / kSamples);
}

TEST_F(Change, SwappedPlanetsGiveTheNegative) {
  const auto a = build("a.vpe", FakeElevation(test_support::bumpy_height, fine_around(kMiddle, 0.05, 5000)));
  const auto b = build(
      "b.vpe",
      FakeElevation([](const glm::dvec3& d) { return test_support::bumpy_height(d) + bowl(d, 300) + 40 * d.z; },
                    fine_around({0, 0, 1}, 0.1, 9000)),
      150000);
  const ChangeStatistics there = measure(a, b, {}, 5, 1);
  const ChangeStatistics back = measure(b, a, {}, 5, 3);
  EXPECT_GT(there.gained_m3, 0);
  EXPECT_GT(there.lost_m3, 0);
  EXPECT_EQ(there.gained_m3, back.lost_m3);
  EXPECT_EQ(there.lost_m3, back.gained_m3);
  EXPECT_EQ(*there.mean_m, -*back.mean_m);
  EXPECT_EQ(*there.median_m, -*back.median_m);
  EXPECT_EQ(*there.rms_m, *back.rms_m);
  EXPECT_EQ(there.changed_area_m2, back.changed_area_m2);
  EXPECT_EQ(there.least->difference_m, -back.most->difference_m);
  EXPECT_EQ(there.most->difference_m, -back.least->difference_m);
  EXPECT_EQ(there.area_m2, back.area_m2);
}

// A hole of one planet and one of the other, of a known size together.
TEST_F(Change, NodataIsCountedAndLeftOut) {
  const auto with_hole = [](const glm::dvec3& middle, double height_m) {
    return FakeElevation(
        [=](const glm::dvec3& d) { return glm::length(d - middle) < 0.1 ? std::nan("") : height_m; });
  };
  const auto a = build("a.vpe", with_hole({1, 0, 0}, 0), 60000);
  const auto b = build("b.vpe", with_hole({0, 1, 0}, 10), 60000);
  const ChangeStatistics change = measure(a, b);
  const double hole_m2 = mars::kPi * std::pow(0.1 * kRadius_m, 2);
  // Triangles with one post in the hole count as nodata: half a spacing more around.
  EXPECT_GT(change.nodata_area_m2, 2 * hole_m2);
  EXPECT_LT(change.nodata_area_m2, 2.8 * hole_m2);
  EXPECT_NEAR(change.nodata_area_m2 + change.area_m2, kSphere, 1e-9 * kSphere);
  EXPECT_EQ(change.least->difference_m, 10);
  EXPECT_EQ(change.most->difference_m, 10);
  ChangeRegion hole;
  hole.holds = [](const glm::dvec3& d) { return d.x > 0.999; };
  const ChangeStatistics none = measure(a, b, hole);
  EXPECT_EQ(none.area_m2, 0);
  EXPECT_GT(none.nodata_area_m2, 0);
  EXPECT_FALSE(none.mean_m || none.median_m || none.rms_m || none.least || none.most);
}

TEST_F(Change, TilesOutsideAreNotRead) {
  const auto before = build("a.vpe", FakeElevation(level_ground, fine_around(kMiddle, 0.05, 5000)));
  std::atomic<int> reads = 0;
  const auto counted =
      PlanetFile::open((dir_.path() / "a.vpe").string(), [&](const lod::TileKey&) { ++reads; });
  ChangeRegion nowhere;
  nowhere.may_hold = [](const lod::TileKey&) { return false; };
  EXPECT_EQ(measure(before, counted, nowhere).triangles, 0);
  EXPECT_EQ(reads, 0);
}

TEST_F(Change, HeightsAtPostsAreThoseOfTheSurface) {
  const auto planet =
      build("a.vpe", FakeElevation(test_support::bumpy_height, fine_around(kMiddle, 0.05, 8000)));
  const Surface surface(planet, kBudget);
  const int n = planet->meta().tile.intervals();
  const lod::TileInfo& finest = planet->tree().deepest(lod::tile_at(mars::chart_point(kMiddle), 12));
  ASSERT_GT(finest.key.level, 2);
  for (const lod::TileKey& key :
       {finest.key, lod::parent(finest.key), lod::child(finest.key, 2), lod::TileKey{mars::Face(1), 0, 0, 0}}) {
    for (const int intervals : {n, n / 2}) {
      const PostHeights heights = heights_at_posts(surface, key, intervals);
      const lod::GridLines lines = lod::grid_lines(key, intervals);
      ASSERT_EQ(heights.height_m.size(), lines.u.size() * lines.v.size());
      EXPECT_TRUE(heights.nodata.empty());
      for (std::size_t j = 0; j < lines.v.size(); ++j)
        for (std::size_t i = 0; i < lines.u.size(); ++i)
          EXPECT_NEAR(heights.height_m[j * lines.u.size() + i],
                      surface.at(mars::chart_direction(key.face, lines.u[i], lines.v[j])).height_m, 1e-8);
    }
  }
}

TEST_F(Change, OtherPlanetsAreRefused) {
  const FakeElevation ground(level_ground);
  const auto mars = build("a.vpe", ground);
  const auto moon = build_fake(dir_.path() / "b.vpe", ground, 200000, 2, "Moon");
  try {
    measure(mars, moon);
    FAIL();
  } catch (const PlanetError& e) {
    for (const char* part : {"a.vpe", "b.vpe", "body", "Mars", "Moon"})
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
  EXPECT_NO_THROW(require_comparable(*mars, *mars));
  EXPECT_THROW(measure(mars, mars, {}, -1), std::invalid_argument);
  EXPECT_THROW(measure(mars, mars, {}, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace paging
