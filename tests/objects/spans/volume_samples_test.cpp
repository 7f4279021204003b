// Stretches of rays in the dense parts of random volumes against samples, from both ends, in parts, and across borders of cells
// and bricks.
#include <gtest/gtest.h>

#include <limits>

#include "objects/volumes/volume_spans.h"
#include "tests/objects/spans/volume_fields.h"

namespace objects {
namespace {

using namespace volume_fields;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

using Spans = std::vector<SolidSpan>;

// Returns false within 1e-6 of a cell from a side of a brick.
bool is_within_brick(const VolumeLattice& lattice, const glm::dvec3& place_m) {
  for (int k = 0; k < 3; ++k) {
    const double bricks = (place_m[k] - static_cast<double>(lattice.corner_m[k])) /
                          (VolumeLevel::kBrickCells * static_cast<double>(lattice.spacing_m));
    if (std::abs(bricks - std::round(bricks)) < 1e-6) return false;
  }
  return true;
}

bool holds(const Spans& spans, double t) {
  for (const SolidSpan& s : spans)
    if (s.begin <= t && t <= s.end) return true;
  return false;
}

// What lies above the threshold by 1e-6 of a stored 1 is in a stretch, what lies below it by as much is in none; ends that are
// not those of the ray are at the threshold.
TEST(VolumeSpans, AgreeWithSamplesOfRandomFields) {
  test_support::Random random(41);
  std::size_t met = 0;
  std::size_t ends = 0;
  double worst = 0;  // of the bound
  for (int n = 0; n < 1200; ++n) {
    const bool is_torn = n % 16 == 15;
    const VolumeLevel level = random_level(random, n % 4, is_torn);
    const auto unit = static_cast<double>(level.unit_per_m);
    const double away = n % 3 == 0 ? 1e4 : 40;
    const VolumeRay ray = random_ray(random, level.lattice, random.integer(0, 4), away);
    // Many are values of posts; for three values these are plateaus.
    const double stored = n % 8 < 3 ? random.uniform(0.01, 255) : n % 4 == 2 ? 100 : random.integer(1, 255);
    const double from = n % 5 == 0 ? away - 3 : away - 50;
    const double to = n % 5 == 0 ? away + 4 : away + 50;
    const Spans spans = volume_spans(level, ray, from, to, stored * unit);
    met += spans.size();
    const double error = 1e-6 * (away > 1e3 ? 10 : 1);
    const auto stored_at = [&](double t) {
      return extinction_per_m(level, ray.origin_m + t * ray.direction) / unit;
    };
    constexpr int kSamples = 3000;
    for (int k = 0; k < kSamples; ++k) {
      const double t = from + (to - from) * (k + 0.5) / kSamples;
      if (is_torn && !is_within_brick(level.lattice, ray.origin_m + t * ray.direction)) continue;
      const double value = stored_at(t);
      if (std::abs(value - stored) > error) {
        ASSERT_EQ(holds(spans, t), value > stored) << n << " " << t << " " << value - stored;
      }
    }
    for (std::size_t k = 0; k < spans.size(); ++k) {
      ASSERT_LT(spans[k].begin, spans[k].end);
      ASSERT_TRUE(k == 0 || spans[k].begin > spans[k - 1].end) << n;
      ASSERT_GE(spans[k].begin, from);
      ASSERT_LE(spans[k].end, to);
      if (is_torn) continue;
      for (const double t : {spans[k].begin, spans[k].end}) {
        if (t == from || t == to) continue;
        worst = std::max(worst, std::abs(stored_at(t) - stored) / error);
        ++ends;
      }
    }
  }
  EXPECT_GT(met, 1200U);
  EXPECT_GT(ends, 2000U);
  EXPECT_LT(worst, 0.01);
}

// The same places are found from the other end, in another unit of t and in parts.
TEST(VolumeSpans, DoNotDependOnTheRaysWay) {
  test_support::Random random(42);
  std::size_t met = 0;
  for (int n = 0; n < 300; ++n) {
    const VolumeLevel level = random_level(random, 3, false);
    const VolumeRay ray = random_ray(random, level.lattice, n % 5, 40);
    const double threshold_per_m = random.uniform(20, 235) * static_cast<double>(level.unit_per_m);
    const Spans spans = volume_spans(level, ray, -kInfinite, kInfinite, threshold_per_m);
    met += spans.size();
    const Spans back = volume_spans(level, {ray.origin_m + 80.0 * ray.direction, -2.0 * ray.direction},
                                    -kInfinite, kInfinite, threshold_per_m);
    ASSERT_EQ(back.size(), spans.size()) << n;
    for (std::size_t k = 0; k < spans.size(); ++k) {
      EXPECT_NEAR(80 - 2 * back[spans.size() - 1 - k].end, spans[k].begin, 1e-7) << n;
      EXPECT_NEAR(80 - 2 * back[spans.size() - 1 - k].begin, spans[k].end, 1e-7) << n;
    }
    const double cut = random.uniform(35, 45);
    Spans parts = volume_spans(level, ray, -kInfinite, cut, threshold_per_m);
    for (const SolidSpan& s : volume_spans(level, ray, cut, kInfinite, threshold_per_m)) parts.push_back(s);
    join_spans(parts, 1e-8);
    ASSERT_EQ(parts.size(), spans.size()) << n;
    for (std::size_t k = 0; k < spans.size(); ++k) {
      EXPECT_NEAR(parts[k].begin, spans[k].begin, 1e-7);
      EXPECT_NEAR(parts[k].end, spans[k].end, 1e-7);
    }
  }
  EXPECT_GT(met, 200U);
}

// Plateaus at the threshold to the bit, of many bricks: level ones, and a ramp that a ray crosses along lines of equal values.
TEST(VolumeSpans, StretchesAreJoinedAtBordersOfCellsAndBricks) {
  test_support::Random random(45);
  const VolumeLevel block = level_of({40, 41, 42}, [](int, int, int) { return 255; });
  const VolumeLevel slope =
      level_of({52, 52, 52}, [](int x, int y, int z) { return std::min(255, 2 * (x + y) + z); });
  for (int n = 0; n < 2000; ++n) {
    const VolumeRay ray = [&] {
      VolumeRay r = random_ray(random, {{37, 37, 37}, 1, {1, 1, 1}}, n % 5, 0);
      if (n % 4 == 0) r.origin_m = 8.0 * glm::floor(r.origin_m / 8.0) + 7.0;  // posts of corners of bricks
      r.origin_m = glm::clamp(r.origin_m, 1.0, 38.0);
      return r;
    }();
    const double away = n % 2 == 0 ? 60 : 1e5;
    const VolumeRay from{ray.origin_m - away * ray.direction, ray.direction};
    const Spans solid = volume_spans(block, from, -kInfinite, kInfinite, 255);
    ASSERT_EQ(solid.size(), 1U) << n;
    double begin = -kInfinite;
    double end = kInfinite;
    const glm::dvec3 high(39, 40, 41);
    for (int k = 0; k < 3; ++k) {
      if (ray.direction[k] == 0) continue;
      const double a = -from.origin_m[k] / ray.direction[k];
      const double b = (high[k] - from.origin_m[k]) / ray.direction[k];
      begin = std::max(begin, std::min(a, b));
      end = std::min(end, std::max(a, b));
    }
    EXPECT_NEAR(solid[0].begin, begin, 1e-8) << n;
    EXPECT_NEAR(solid[0].end, end, 1e-8) << n;

    // 2 (x + y) + z stays along this direction.
    const glm::dvec3 along(random.uniform(-1, 1), random.uniform(-1, 1), 0);
    const glm::dvec3 level_way(along.x, along.y, -2 * (along.x + along.y));
    const glm::dvec3 place = glm::dvec3(random.uniform(20, 30), random.uniform(20, 30), random.uniform(20, 30));
    const double stored = 2 * (place.x + place.y) + place.z;
    const Spans plateau = volume_spans(slope, {place, level_way}, -5, 5, stored);
    ASSERT_EQ(plateau.size(), 1U) << n;
    EXPECT_EQ(plateau[0].begin, -5);
    EXPECT_EQ(plateau[0].end, 5);
    EXPECT_TRUE(volume_spans(slope, {place, level_way}, -5, 5, stored + 1e-8).empty());
  }
}

TEST(VolumeCells, FollowEachOtherThroughTheLattice) {
  test_support::Random random(46);
  for (int n = 0; n < 200; ++n) {
    const VolumeLevel level = random_level(random, 0, false);
    const VolumeRay ray = random_ray(random, level.lattice, n % 5, 40);
    const LatticeRay in = in_lattice(level.lattice, ray, 0, kInfinite);
    ASSERT_LT(in.begin, in.end);
    double at = in.begin;
    visit_cells(level, in, [&](const CellStretch& s) {
      EXPECT_EQ(s.begin, at);
      EXPECT_GT(s.end, s.begin);
      at = s.end;
      const glm::dvec3 low_m = glm::dvec3(level.lattice.corner_m) +
                               static_cast<double>(level.lattice.spacing_m) * glm::dvec3(s.cell);
      EXPECT_NEAR(*s.posts(), extinction_per_m(level, low_m + 1e-9) / static_cast<double>(level.unit_per_m),
                  1e-3);
      const glm::dvec3 middle = in.origin + 0.5 * (s.begin + s.end) * in.direction - glm::dvec3(s.cell);
      for (int k = 0; k < 3; ++k) {
        EXPECT_GE(middle[k], -1e-9);
        EXPECT_LE(middle[k], 1 + 1e-9);
      }
      return true;
    });
    EXPECT_EQ(at, in.end);
    int seen = 0;
    visit_cells(level, in, [&](const CellStretch&) { return ++seen < 2; });
    EXPECT_LE(seen, 2);
  }
  const LatticeRay missed = in_lattice({{4, 4, 4}, 2, {0, 0, 0}}, {{9, 1, 0}, {0, 0, 1}}, 0, 9);
  EXPECT_FALSE(missed.begin < missed.end);
  const LatticeRay met = in_lattice({{4, 4, 4}, 2, {1, 0, 0}}, {{2, 1, -4}, {0, 0, 4}}, 0, 9);
  EXPECT_EQ(met.origin, glm::dvec3(0.5, 0.5, -2));
  EXPECT_EQ(met.direction, glm::dvec3(0, 0, 2));
  EXPECT_EQ(met.inverse, glm::dvec3(0, 0, 0.5));
  EXPECT_EQ(met.begin, 1);
  EXPECT_EQ(met.end, 2.5);
}

}  // namespace
}  // namespace objects
