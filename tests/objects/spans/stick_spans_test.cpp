// Stretches of lines in sticks: against each voxel by brute force, solid blocks, planes of sides, opacity.
#include "objects/sticks/stick_spans.h"

#include <gtest/gtest.h>

#include "tests/objects/sticks/stick_shapes.h"
#include "tests/support/support.h"

namespace objects {
namespace {

using Voxels = std::vector<glm::ivec3>;

// Returns where a line is in a box; empty if it passes.
SolidSpan in_box(const ModelLine& line, const glm::dvec3& low, const glm::dvec3& high) {
  SolidSpan s{-1e300, 1e300};
  for (int k = 0; k < 3; ++k) {
    const double a = (low[k] - line.origin_m[k]) / line.direction[k];
    const double b = (high[k] - line.origin_m[k]) / line.direction[k];
    s = {std::max(s.begin, std::min(a, b)), std::min(s.end, std::max(a, b))};
  }
  return s;
}

std::vector<SolidSpan> by_voxels(const StickGrid& grid, const Voxels& voxels, const ModelLine& line,
                                 double touch) {
  std::vector<SolidSpan> spans;
  const auto edge_m = static_cast<double>(grid.voxel_m);
  for (const glm::ivec3& v : voxels) {
    const glm::dvec3 low = glm::dvec3(grid.corner_m) + edge_m * glm::dvec3(v);
    const SolidSpan s = in_box(line, low, low + edge_m);
    if (s.begin < s.end) spans.push_back(s);
  }
  join_spans(spans, touch);
  return spans;
}

TEST(StickSpans, AgreesWithEachVoxel) {
  test_support::Random random(7);
  const StickGrid grid{17, 11, 14, 0.3F, {-2.1F, 0.7F, 30}};
  const auto edge_m = static_cast<double>(grid.voxel_m);
  std::size_t spans_met = 0;
  std::size_t slivers = 0;
  for (int model = 0; model < 12; ++model) {
    VoxelGrid voxels(grid);
    Voxels filled;
    const int share = random.integer(1, 9);
    for (int y = 0; y < grid.columns_y; ++y) {
      for (int x = 0; x < grid.columns_x; ++x) {
        for (int z = 0; z < grid.height; ++z) {
          if (random.integer(1, 10) > share) continue;
          voxels.set(x, y, z);
          filled.emplace_back(x, y, z);
        }
      }
    }
    const StickModel sticks = build_sticks(std::move(voxels));
    for (int n = 0; n < 150; ++n) {
      const double length = random.uniform(0.1, 5);
      glm::dvec3 direction = length * random.direction();
      // Nearly upright ones, as those of upright models are.
      if (n % 3 == 0)
        direction = {random.uniform(-1e-9, 1e-9), random.uniform(-1e-9, 1e-9), n % 2 == 0 ? 1 : -1};
      const glm::dvec3 voxel{random.uniform(0, grid.columns_x), random.uniform(0, grid.columns_y),
                             random.uniform(0, grid.height)};
      const glm::dvec3 through = glm::dvec3(grid.corner_m) + edge_m * voxel;
      const ModelLine line{through - random.uniform(-100, 100) * direction, direction};
      const double touch = kStickTouch_voxels * edge_m / glm::length(direction);
      const std::vector<SolidSpan> spans = stick_spans(sticks.levels()[0], line);
      std::vector<SolidSpan> expected = by_voxels(grid, filled, line, touch);
      slivers += std::erase_if(expected, [&](const SolidSpan& s) { return s.end - s.begin <= touch; });
      ASSERT_EQ(spans.size(), expected.size()) << model << " " << n;
      spans_met += spans.size();
      for (std::size_t k = 0; k < spans.size(); ++k) {
        EXPECT_NEAR(spans[k].begin, expected[k].begin, touch);
        EXPECT_NEAR(spans[k].end, expected[k].end, touch);
        EXPECT_TRUE(k == 0 || spans[k].begin > spans[k - 1].end);
      }
    }
  }
  EXPECT_GT(spans_met, 3000U);
  EXPECT_LT(slivers, 20U);
}

// A line through a tilted block crosses hundreds of sticks and has one stretch.
TEST(StickSpans, ASolidBlockIsOneStretch) {
  test_support::Random random(8);
  const StickGrid grid{200, 180, 160, 0.01F, {-1, -0.9F, 0}};
  VoxelGrid voxels(grid);
  for (int y = 0; y < grid.columns_y; ++y)
    for (int x = 0; x < grid.columns_x; ++x)
      for (int z = 0; z < grid.height; ++z) voxels.set(x, y, z);
  const StickModel sticks = build_sticks(std::move(voxels));
  const auto edge_m = static_cast<double>(grid.voxel_m);
  const glm::dvec3 low(grid.corner_m);
  const glm::dvec3 high = low + edge_m * glm::dvec3(grid.columns_x, grid.columns_y, grid.height);
  for (int n = 0; n < 500; ++n) {
    glm::dvec3 through;
    for (int k = 0; k < 3; ++k) through[k] = random.uniform(low[k], high[k]);
    // Through corners of voxels, where sides of three axes meet.
    if (n % 2 == 0) through = low + edge_m * glm::round((through - low) / edge_m);
    const glm::dvec3 direction = random.direction();
    const ModelLine line{through - 3.4e6 * direction, direction};
    const SolidSpan expected = in_box(line, low, high);
    if (expected.end - expected.begin < edge_m) continue;
    const std::vector<SolidSpan> spans = stick_spans(sticks.levels()[0], line);
    ASSERT_EQ(spans.size(), 1U) << n;
    EXPECT_NEAR(spans[0].begin, expected.begin, 1e-6);
    EXPECT_NEAR(spans[0].end, expected.end, 1e-6);
  }
}

// A slanted line passes corners of air between the steps of voxels.
TEST(StickSpans, ClosesNotchesBetweenStepsOnRequest) {
  VoxelGrid voxels({6, 1, 6, 0.5F, {0, 0, 0}});
  for (int x = 0; x < 6; ++x)
    for (int z = 0; z < x; ++z) voxels.set(x, 0, z);
  voxels.set(1, 0, 3);  // with a gap in its stick
  voxels.set(1, 0, 5);
  const StickModel sticks = build_sticks(std::move(voxels));
  const auto count = [&](const ModelLine& line, double step_voxels) {
    return stick_spans(sticks.levels()[0], line, step_voxels).size();
  };
  // Along the steps, half a voxel deep: voxel, corner of air, voxel and so on.
  const ModelLine along{{0.75, 0.25, 0.4}, {1, 0, 1}};
  EXPECT_EQ(count(along, 0), 5U);
  EXPECT_EQ(count(along, 0.2), 5U);
  EXPECT_EQ(count(along, 1.5), 1U);
  const ModelLine upright{{0.75, 0.25, 0}, {0, 0, 1}};
  EXPECT_EQ(count(upright, 0), 3U);
  EXPECT_EQ(count(upright, 4), 3U);
}

TEST(StickSpans, LinesInPlanesOfSidesAreInOneVoxel) {
  VoxelGrid voxels({8, 8, 8, 1, {0, 0, 0}});
  for (int y = 2; y < 6; ++y)
    for (int x = 2; x < 6; ++x)
      for (const int z : {1, 2, 5}) voxels.set(x, y, z);
  const StickModel sticks = build_sticks(std::move(voxels));
  const auto spans = [&](const glm::dvec3& from, const glm::dvec3& d) {
    return stick_spans(sticks.levels()[0], {from, d});
  };
  for (const double inside : {2.0, 3.0, 5.0}) {
    const std::vector<SolidSpan> up = spans({inside, inside, -10}, {0, 0, 1});
    ASSERT_EQ(up.size(), 2U);
    EXPECT_EQ(up[0].begin, 11);
    EXPECT_EQ(up[0].end, 13);
    EXPECT_EQ(up[1].begin, 15);
    EXPECT_EQ(up[1].end, 16);
    const std::vector<SolidSpan> down = spans({inside, inside, 10}, {0, 0, -2});
    ASSERT_EQ(down.size(), 2U);
    EXPECT_EQ(down[0].begin, 2);
    EXPECT_EQ(down[1].end, 4.5);
  }
  EXPECT_TRUE(spans({6, 3.5, -10}, {0, 0, 1}).empty());  // the side belongs to the column on its right
  EXPECT_EQ(spans({-10, 3.5, 1}, {1, 0, 0}).size(), 1U);
  EXPECT_TRUE(spans({-10, 3.5, 3}, {1, 0, 0}).empty());
}

TEST(StickSpans, VoxelsOfHalfTheLightAreSolid) {
  VoxelGrid voxels({1, 1, 12, 0.5F, {0, 0, 0}});
  voxels.set(0, 0, 1, stick_voxel({200, 30, 30, 127}, {0, 0, 1}));
  voxels.set(0, 0, 2, stick_voxel({200, 30, 30, 128}, {0, 0, 1}));
  voxels.set(0, 0, 3, stick_voxel({100, 90, 30, 200}, {0, 0, 1}));
  voxels.set(0, 0, 4);
  voxels.set(0, 0, 7, stick_voxel({200, 30, 30, 90}, {0, 0, 1}));
  voxels.set(0, 0, 9, stick_voxel({200, 30, 30, 254}, {0, 0, 1}));
  voxels.set(0, 0, 10, stick_voxel({200, 30, 30, 1}, {0, 0, 1}));
  const StickModel sticks = build_sticks(std::move(voxels));
  const std::vector<SolidSpan> spans = stick_spans(sticks.levels()[0], {{0.2, 0.3, 0}, {0, 0, 1}});
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_EQ(spans[0].begin, 1);
  EXPECT_EQ(spans[0].end, 2.5);
  EXPECT_EQ(spans[1].begin, 4.5);
  EXPECT_EQ(spans[1].end, 5);
}

TEST(StickSpans, MeetsNothingWhereThereIsNothing) {
  VoxelGrid voxels({2, 2, 2, 1, {0, 0, 0}});
  const StickModel empty = build_sticks(voxels);
  EXPECT_TRUE(stick_spans(empty.levels()[0], {{0.5, 0.5, 0}, {0, 0, 1}}).empty());
  voxels.set(0, 0, 0);
  const StickModel sticks = build_sticks(std::move(voxels));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const ModelLine& line : {ModelLine{{kNaN, 0.5, 0}, {0, 0, 1}}, ModelLine{{0.5, 0.5, 0}, {0, 0, 0}},
                                ModelLine{{0.5, 0.5, 0}, {kNaN, 0, 1}}, ModelLine{{1.5, 0.5, 0}, {0, 0, 1}},
                                ModelLine{{0.5, 0.5, 0}, {0, 0, std::numeric_limits<double>::infinity()}}})
    EXPECT_TRUE(stick_spans(sticks.levels()[0], line).empty());
}

}  // namespace
}  // namespace objects
