// Tests the kernels of the meters, on each instruction set, against one post after the other.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lod/mesh/depth_kernel.h"
#include "lod/mesh/grid_kernel.h"
#include "tests/support/support.h"

namespace {

constexpr double kRounding = 1e-14;

void use(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// Calls `test` on each instruction set that this machine has.
template <class Test>
void on_each_target(const Test& test) {
  use(0);
  const std::int64_t all = hwy::SupportedTargets();
  for (std::int64_t left = all; left != 0; left &= left - 1) {
    SCOPED_TRACE(hwy::TargetName(left & -left));
    use(left & -left);
    test();
  }
  use(0);
}

TEST(DepthKernel, FindsTheLargestDifferencesInATriangle) {
  constexpr std::size_t kSide = 21;
  test_support::Random random(5);
  std::vector<double> u(kSide + lod::kDepthPad, 1e6);
  std::vector<double> v(kSide);
  for (std::size_t k = 0; k < kSide; ++k) {
    u[k] = 0.1 + 0.01 * static_cast<double>(k) + 1e-4 * static_cast<double>(k * k);
    v[k] = -0.2 + 0.02 * static_cast<double>(k);
  }
  std::vector<double> depth(kSide * kSide + lod::kDepthPad, 1.0);
  for (double& d : depth) d = random.uniform(0.9, 1.1);
  on_each_target([&] {
    for (int round = 0; round < 400; ++round) {
      // A right triangle with its corner in the south-west of the box; sides are counter-clockwise.
      const auto at = [&] {
        return static_cast<std::uint32_t>(random.integer(0, static_cast<int>(kSide) - 2));
      };
      lod::DepthBox box{at(), 0, at(), 0};
      box.i1 =
          static_cast<std::uint32_t>(random.integer(static_cast<int>(box.i0) + 1, static_cast<int>(kSide) - 1));
      box.j1 =
          static_cast<std::uint32_t>(random.integer(static_cast<int>(box.j0) + 1, static_cast<int>(kSide) - 1));
      const double du = u[box.i1] - u[box.i0];
      const double dv = v[box.j1] - v[box.j0];
      const std::array<lod::DepthSide, 3> sides{
          {{-v[box.j0] + 1e-12, 0, 1},
           {-u[box.i0] + 1e-12, 1, 0},
           {1 + u[box.i0] / du + v[box.j0] / dv - 1e-9, -1 / du, -1 / dv}}};
      const lod::DepthPlane plane{1.0, random.uniform(-1, 1), random.uniform(-1, 1), u[box.i0], v[box.j0]};
      double below = 0;
      double above = 0;
      for (std::uint32_t j = box.j0; j < box.j1; ++j) {
        for (std::uint32_t i = box.i0; i < box.i1; ++i) {
          if ((u[i] - u[box.i0]) / du + (v[j] - v[box.j0]) / dv > 1 - 1e-9) continue;
          const double difference =
              depth[j * kSide + i] - (1.0 + plane.du * (u[i] - plane.u) + plane.dv * (v[j] - plane.v));
          below = std::max(below, difference);
          above = std::max(above, -difference);
        }
      }
      const lod::DepthDifferences found =
          lod::largest_differences({depth.data(), u.data(), v.data(), kSide}, plane, sides, box);
      EXPECT_NEAR(found.below, below, kRounding);
      EXPECT_NEAR(found.above, above, kRounding);
    }
  });
}

TEST(DepthKernel, FillsRowsOfDepthsAndFindsTheirRange) {
  constexpr double kRadius_m = 3.39e6;
  test_support::Random random(11);
  on_each_target([&] {
    for (const std::size_t count : {2, 3, 4, 5, 8, 9, 33, 129}) {
      std::vector<double> u(count);
      std::vector<double> height_m(2 * count);
      std::vector<double> length(2 * count + 1, -1.0);
      std::vector<double> depth(2 * count + 1, -1.0);
      for (double& x : u) x = random.uniform(-1, 1);
      for (double& h : height_m) h = random.uniform(-8000, 21000);
      double least = 1e9;
      for (std::size_t row = 0; row < 2; ++row) {
        const double v = random.uniform(-1, 1);
        const std::size_t at = row * count;
        lod::fill_depths({u.data(), height_m.data() + at, v * v, kRadius_m, count}, length.data() + at,
                         depth.data() + at);
        for (std::size_t k = 0; k < count; ++k) {
          const double n = std::sqrt(u[k] * u[k] + v * v + 1.0);
          ASSERT_EQ(length[at + k], n);
          ASSERT_EQ(depth[at + k], n * kRadius_m / (kRadius_m + height_m[at + k]));
          least = std::min(least, depth[at + k]);
        }
      }
      ASSERT_EQ(length.back(), -1.0);
      ASSERT_EQ(depth.back(), -1.0);
      double cell = 0;
      for (std::size_t k = 0; k + 1 < count; ++k) {
        const auto [low, high] = std::minmax({depth[k], depth[k + 1], depth[count + k], depth[count + k + 1]});
        cell = std::max(cell, high - low);
      }
      const lod::DepthRange range = lod::range_of_depths(depth.data(), depth.data() + count, count);
      ASSERT_EQ(range.least, least);
      ASSERT_EQ(range.cell, cell);
    }
  });
}

TEST(GridKernel, BoundsARow) {
  test_support::Random random(6);
  on_each_target([&] {
    for (int round = 0; round < 200; ++round) {
      const auto columns = static_cast<std::size_t>(random.integer(1, 40));
      lod::GridStrip strip;
      strip.resize(columns);
      ASSERT_GE(strip.count, columns);
      std::vector<double> depth(strip.count, 1.0);
      std::vector<double> length(strip.count, 1.0);
      for (std::size_t k = 0; k < columns; ++k) {
        strip.x[k] = random.uniform(0, 1);
        depth[k] = random.uniform(1, 1.5);
        length[k] = random.uniform(1, 1.7);
        for (lod::StripPlanes* planes : {&strip.low, &strip.high}) {
          planes->depth[k] = random.uniform(1, 1.5);
          planes->length[k] = random.uniform(1, 1.7);
          planes->depth_dv[k] = random.uniform(-1, 1);
          planes->length_dv[k] = random.uniform(-1, 1);
        }
      }
      const lod::StripRow row{depth.data(), length.data(), random.uniform(0, 0.1), random.uniform(0, 1), 0.05};
      const double weight = random.uniform(1, 1.1);
      lod::StripDifferences want;
      for (std::size_t k = 0; k < columns; ++k) {
        const auto add = [&](const lod::StripPlanes& planes) {
          const double of_depth =
              std::abs(depth[k] - (planes.depth[k] + planes.depth_dv[k] * row.dv)) / length[k];
          const double of_length =
              std::abs(length[k] - (planes.length[k] + planes.length_dv[k] * row.dv)) / length[k];
          want.depth = std::max(want.depth, of_depth);
          want.length = std::max(want.length, of_length);
          want.both = std::max(want.both, weight * of_depth + of_length);
        };
        if (strip.x[k] >= row.y - row.margin) add(strip.low);
        if (strip.x[k] <= row.y + row.margin) add(strip.high);
      }
      const lod::StripDifferences found = lod::strip_differences(strip, row, weight);
      EXPECT_NEAR(found.depth, want.depth, kRounding);
      EXPECT_NEAR(found.length, want.length, kRounding);
      EXPECT_NEAR(found.both, want.both, 4 * kRounding);
    }
  });
}

}  // namespace
