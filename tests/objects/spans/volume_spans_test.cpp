// Stretches of rays in the dense parts of volumes: closed forms, extremes at the threshold, values of posts, what is refused.
#include "objects/volumes/volume_spans.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "tests/objects/spans/volume_fields.h"
#include "tests/objects/volumes/volume_shapes.h"

namespace objects {
namespace {

using volume_fields::level_of;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Spans = std::vector<SolidSpan>;

// Returns a level of one cell whose eight posts, x fastest, are those of a list, and far from it a post of 255.
VolumeLevel cell_level(const std::array<int, 8>& posts) {
  return level_of({2, 2, 6}, [&](int x, int y, int z) {
    if (z > 1) return z == 5 ? 255 : 0;
    return posts[static_cast<std::size_t>(x + 2 * y + 4 * z)];
  });
}

TEST(VolumeSpans, ARampIsCrossedWhereItIs) {
  test_support::Random random(43);
  const VolumeLevel ramp = level_of({18, 30, 30}, [](int x, int, int) { return 15 * x; });
  for (int n = 0; n < 500; ++n) {
    glm::dvec3 d = random.direction();
    if (n % 3 == 0) d = {1, 0, 0};
    if (std::abs(d.x) < 0.8) continue;
    const double stored = n % 2 == 0 ? random.uniform(1, 254) : 15 * random.integer(1, 16);
    const glm::dvec3 through{stored / 15, random.uniform(13, 16), random.uniform(13, 16)};
    // Up to the last posts, from which on the field falls.
    const double far = (17 - through.x) / std::abs(d.x);
    if (d.x < 0) d = -d;
    const Spans up = volume_spans(ramp, {through - 5.0 * d, d}, 5 - through.x / d.x, 5 + far, stored);
    ASSERT_EQ(up.size(), 1U) << n;
    EXPECT_NEAR(up[0].begin, 5, 1e-12) << n;
    EXPECT_EQ(up[0].end, 5 + far);
    const Spans down = volume_spans(ramp, {through, -d}, -far, through.x / d.x, stored);
    ASSERT_EQ(down.size(), 1U) << n;
    EXPECT_EQ(down[0].begin, -far);
    EXPECT_NEAR(down[0].end, 0, 1e-12) << n;
  }
}

// A field that falls by 20 a metre with the distance from a ball's surface: rounding moves it by 1/40 m, and straight lines
// between posts by less than 1/(8 * 6) m for each of three axes.
TEST(VolumeSpans, ABallHasItsChords) {
  test_support::Random random(44);
  constexpr double kRadius_m = 6;
  const glm::dvec3 centre_m(12.2, 12.4, 11.9);
  const VolumeLevel ball = level_of({25, 25, 25}, [&](int x, int y, int z) {
    return std::clamp(128 + 20 * (kRadius_m - glm::distance(glm::dvec3(x, y, z), centre_m)), 0.0, 255.0);
  });
  const double threshold_per_m = 128;
  int met = 0;
  for (int n = 0; n < 500; ++n) {
    const glm::dvec3 d = random.direction();
    const glm::dvec3 through = centre_m + random.uniform(0, 7) * random.direction();
    const glm::dvec3 to = centre_m - through;
    const double beside_m = glm::length(to - glm::dot(to, d) * d);
    const Spans spans = volume_spans(ball, {through - 30.0 * d, d}, 0, kInfinite, threshold_per_m);
    if (beside_m > kRadius_m + 0.1) {
      EXPECT_TRUE(spans.empty());
    }
    if (beside_m > kRadius_m - 1) continue;
    ++met;
    ASSERT_EQ(spans.size(), 1U);
    const double half = std::sqrt(kRadius_m * kRadius_m - beside_m * beside_m);
    const double most = (1.0 / 40 + 3.0 / 48) * kRadius_m / half;
    EXPECT_NEAR(spans[0].begin, 30 + glm::dot(to, d) - half, most);
    EXPECT_NEAR(spans[0].end, 30 + glm::dot(to, d) + half, most);
  }
  EXPECT_GT(met, 200);
}

// Along the diagonal of a cell's side the field is a parabola, 510 s (1 - s), or 255 less that.
TEST(VolumeSpans, AnExtremeAtTheThresholdIsADoubleRoot) {
  const VolumeLevel hill = cell_level({0, 255, 255, 0, 0, 255, 255, 0});
  const VolumeLevel valley = cell_level({255, 0, 0, 255, 255, 0, 0, 255});
  const VolumeRay ray{{0, 0, 0.5}, {1, 1, 0}};
  for (const double less : {1e-10, 1e-8, 1e-6, 1e-3, 1.0, 60.0}) {
    const double half = std::sqrt(less / 510);
    const double error = less < 1e-9 ? 2e-6 : 1e-12 / half;
    const Spans top = volume_spans(hill, ray, 0, 1, 127.5 - less);
    ASSERT_EQ(top.size(), 1U) << less;
    EXPECT_NEAR(top[0].begin, 0.5 - half, error);
    EXPECT_NEAR(top[0].end, 0.5 + half, error);
    const Spans bottom = volume_spans(valley, ray, 0, 1, 127.5 + less);
    if (less <= kVolumeValueError) {
      ASSERT_EQ(bottom.size(), 1U) << less;  // what is so little below the threshold is no gap
      continue;
    }
    ASSERT_EQ(bottom.size(), 2U) << less;
    EXPECT_EQ(bottom[0].begin, 0);
    EXPECT_NEAR(bottom[0].end, 0.5 - half, error);
    EXPECT_NEAR(bottom[1].begin, 0.5 + half, error);
    EXPECT_EQ(bottom[1].end, 1);
    EXPECT_TRUE(volume_spans(hill, ray, 0, 1, 127.5 + 2 * less).empty());
    EXPECT_EQ(volume_spans(valley, ray, 0, 1, 127.5 - less).size(), 1U);
  }
  // It touches the threshold to the bit: nothing, or no more than rounding makes of it.
  for (const SolidSpan& s : volume_spans(hill, ray, 0, 1, 127.5)) EXPECT_LT(s.end - s.begin, 1e-6);
  const Spans touched = volume_spans(valley, ray, 0, 1, 127.5);
  ASSERT_EQ(touched.size(), 1U);
  EXPECT_EQ(touched[0].begin, 0);
  EXPECT_EQ(touched[0].end, 1);
}

// The diagonal of a cell: with posts of 0 and 255 by turns 127.5 + 1020 (s - 1/2)^3, and with other posts three roots.
TEST(VolumeSpans, CubicsHaveTheirRoots) {
  const VolumeRay diagonal{{0, 0, 0}, {1, 1, 1}};
  const VolumeLevel triple = cell_level({0, 255, 255, 0, 255, 0, 0, 255});
  for (const double stored : {127.5, 127.5 + 1e-6, 127.5 - 1e-3, 100.0, 200.0}) {
    const Spans spans = volume_spans(triple, diagonal, 0, 1, stored);
    ASSERT_EQ(spans.size(), 1U);
    EXPECT_NEAR(spans[0].begin, 0.5 + std::cbrt((stored - 127.5) / 1020), stored == 127.5 ? 2e-5 : 1e-9);
    EXPECT_EQ(spans[0].end, 1);
  }
  // Bernstein coefficients 20, 240, 0, 220: up, down and up again through 120, with roots symmetric about the middle.
  const VolumeLevel wave = cell_level({20, 240, 240, 0, 240, 0, 0, 220});
  const Spans spans = volume_spans(wave, diagonal, 0, 1, 120);
  ASSERT_EQ(spans.size(), 2U);
  const auto field = [](double s) {
    const double r = 1 - s;
    return 20 * r * r * r + 720 * s * r * r + 220 * s * s * s;
  };
  EXPECT_NEAR(field(spans[0].begin), 120, 1e-10);
  EXPECT_NEAR(spans[0].end, 0.5, 1e-12);
  EXPECT_NEAR(spans[1].begin, 1 - spans[0].begin, 1e-12);
  EXPECT_EQ(spans[1].end, 1);
  EXPECT_LT(spans[0].begin, 0.4);
}

TEST(VolumeSpans, ThresholdsAtValuesOfPosts) {
  // Posts 0 10 200 200 10 0 255 0 along z.
  const std::array<int, 8> column{0, 10, 200, 200, 10, 0, 255, 0};
  const VolumeLevel level =
      level_of({5, 5, 8}, [&](int, int, int z) { return column[static_cast<std::size_t>(z)]; });
  const VolumeRay ray{{2, 1.5, -10}, {0, 0, 1}};
  const auto spans = [&](double stored) { return volume_spans(level, ray, 0, kInfinite, stored); };
  const auto expect = [&](double stored, const Spans& expected) {
    const Spans met = spans(stored);
    ASSERT_EQ(met.size(), expected.size()) << stored;
    for (std::size_t n = 0; n < met.size(); ++n) {
      EXPECT_NEAR(met[n].begin, 10 + expected[n].begin, 1e-12) << stored;
      EXPECT_NEAR(met[n].end, 10 + expected[n].end, 1e-12) << stored;
    }
  };
  expect(10, {{1, 4}, {5 + 10.0 / 255, 7 - 10.0 / 255}});
  expect(200, {{2, 3}, {5 + 200.0 / 255, 7 - 200.0 / 255}});
  expect(200 + 1e-7, {{5 + (200 + 1e-7) / 255, 7 - (200 + 1e-7) / 255}});
  expect(255, {});  // one place
  expect(255.001, {});
  expect(1e300, {});
  expect(1e-300, {{0, 7}});  // it is below in one place
}

TEST(VolumeSpans, BadThresholdsAreRefusedAndNoneIsMetEverywhere) {
  const VolumeLevel level = ball_level(4, 1, 30);
  const VolumeRay ray{{0, 0, -9}, {0, 0, 1}};
  for (const double bad : {kNaN, kInfinite, -kInfinite})
    EXPECT_THROW((void)volume_spans(level, ray, 0, kInfinite, bad), std::invalid_argument);
  for (const double none : {0.0, -0.0, -3.0}) {
    const Spans spans = volume_spans(level, ray, -1, kInfinite, none);
    ASSERT_EQ(spans.size(), 1U);
    EXPECT_EQ(spans[0].begin, -1);
    EXPECT_EQ(spans[0].end, kInfinite);
  }
}

TEST(VolumeSpans, MeetNothingWhereThereIsNothing) {
  const VolumeLevel level = ball_level(4, 1, 30);
  const auto count = [&](const glm::dvec3& from, const glm::dvec3& d, double begin = 0,
                         double end = kInfinite) {
    return volume_spans(level, {from, d}, begin, end, 0.5).size();
  };
  EXPECT_EQ(count({0, 0, -9}, {0, 0, 1}), 1U);
  EXPECT_EQ(count({0, 0, -9}, {0, 0, 1}, -kInfinite), 1U);
  EXPECT_EQ(count({0, 0, -9}, {1e-320, -1e-300, 1}), 1U);
  EXPECT_EQ(count({9, 0, -9}, {0, 0, 1}), 0U);      // beside it
  EXPECT_EQ(count({4.2, 4.2, -9}, {0, 0, 1}), 0U);  // in an empty corner
  EXPECT_EQ(count({0, 0, -9}, {0, 0, -1}), 0U);     // behind it
  EXPECT_EQ(count({0, 0, -9}, {0, 0, 1}, 5, 5), 0U);
  EXPECT_EQ(count({0, 0, -9}, {0, 0, 1}, 0, 4), 0U);
  EXPECT_EQ(count({0, 0, -9}, {0, 0, 1}, kNaN), 0U);
  EXPECT_EQ(count({0, 0, -9}, {0, 0, 1}, 0, kNaN), 0U);
  EXPECT_EQ(count({0, 0, -9}, {0, 0, 0}), 0U);
  EXPECT_EQ(count({kNaN, 0, -9}, {0, 0, 1}), 0U);
  EXPECT_EQ(count({0, 0, -9}, {0, kNaN, 1}), 0U);
  EXPECT_EQ(count({0, 0, -9}, {0, kInfinite, 1}), 0U);
  EXPECT_EQ(count({0, kInfinite, -9}, {0, 0, 1}), 0U);
  const VolumeLevel empty = build_level(DenseVolume({{9, 9, 9}, 1, {0, 0, 0}}));
  EXPECT_TRUE(volume_spans(empty, {{4, 4, -9}, {0, 0, 1}}, 0, kInfinite, 1e-9).empty());
}

TEST(VolumeSpans, TheDefaultIsHalfOfTheLargestExtinction) {
  const VolumeModel model(slab_level(9, 9, 30, 0.5F, 0.7F), {});
  EXPECT_NEAR(model.largest_per_m(), 0.7, 1e-7);
  EXPECT_EQ(default_threshold_per_m(model), 0.5 * model.largest_per_m());
  const Spans spans =
      volume_spans(model.levels()[0], {{0, 0, 0}, {0, 0, 1}}, -9, 99, default_threshold_per_m(model));
  ASSERT_EQ(spans.size(), 1U);
  EXPECT_NEAR(spans[0].begin, -0.25, 1e-7);
  EXPECT_NEAR(spans[0].end, 14.75, 1e-7);
}

}  // namespace
}  // namespace objects
