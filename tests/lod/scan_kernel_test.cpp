// Tests the search for the worst post under a triangle, on each instruction set, against one post after the other.
#include "lod/mesh/scan_kernel.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/support.h"

namespace {

constexpr std::size_t kSide = 33;
constexpr std::size_t kPosts = kSide * kSide;

class ScanKernel : public ::testing::Test {
 protected:
  void SetUp() override {
    for (std::size_t k = 0; k < kSide; ++k) {
      x_[k] = static_cast<double>(k * k + 7 * k);
      y_[k] = static_cast<double>(3 * k * k + 5 * k);
    }
    for (std::size_t k = kSide; k < x_.size(); ++k) x_[k] = 1e9;
    for (std::size_t k = 0; k < kPosts; ++k) {
      w_[k] = random_.uniform(0.9, 1.1);
      weight_[k] = random_.integer(0, 9) == 0 ? 0 : random_.uniform(1, 2);
    }
    // Equal errors, of which the lowest post wins.
    for (int n = 0; n < 200; ++n) {
      const auto to = static_cast<std::size_t>(random_.integer(0, static_cast<int>(kPosts) - 1));
      w_[to] = 1.1;
      weight_[to] = 2;
    }
  }
  void TearDown() override { use(0); }

  static void use(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  // Calls `test` on each instruction set that this machine has.
  template <class Test>
  static void on_each_target(const Test& test) {
    const std::int64_t all = hwy::SupportedTargets();
    for (std::int64_t left = all; left != 0; left &= left - 1) {
      SCOPED_TRACE(hwy::TargetName(left & -left));
      use(left & -left);
      test();
    }
    use(0);
  }

  std::uint32_t line() { return static_cast<std::uint32_t>(random_.integer(0, static_cast<int>(kSide) - 1)); }
  lod::ScannedPosts posts() const { return {w_.data(), weight_.data(), x_.data(), y_.data(), kSide}; }
  double error_at(const lod::ScannedPlane& plane, std::size_t i, std::size_t j) const {
    const std::size_t post = j * kSide + i;
    const double flat = (plane.w + plane.dy * (y_[j] - plane.y)) + plane.dx * (x_[i] - plane.x);
    return std::abs((w_[post] - flat) * weight_[post]);
  }
  lod::ScannedPlane random_plane() {
    // Level in every other case, so that equal posts have equal errors.
    if (random_.integer(0, 1) == 0) return {1, 0, 0, x_[3], y_[5]};
    return {random_.uniform(0.9, 1.1), random_.uniform(-1e-4, 1e-4), random_.uniform(-1e-4, 1e-4), x_[3],
            y_[5]};
  }

  test_support::Random random_{31};
  std::vector<double> x_ = std::vector<double>(kSide + lod::kScanPad);
  std::vector<double> y_ = std::vector<double>(kSide + lod::kScanPad);
  std::vector<double> w_ = std::vector<double>(kPosts + lod::kScanPad);
  std::vector<double> weight_ = std::vector<double>(kPosts + lod::kScanPad);
};

TEST_F(ScanKernel, FindsTheWorstPostOfABox) {
  int found = 0;
  for (int n = 0; n < 2000; ++n) {
    const std::array<std::array<std::uint32_t, 2>, 3> corners{
        {{line(), line()}, {line(), line()}, {line(), line()}}};
    lod::ScannedBox box{corners[0][0], corners[0][0], corners[0][1], corners[0][1]};
    for (const auto& [i, j] : corners) {
      box.i0 = std::min(box.i0, i);
      box.i1 = std::max(box.i1, i);
      box.j0 = std::min(box.j0, j);
      box.j1 = std::max(box.j1, j);
    }
    const lod::ScannedPlane plane = random_plane();
    std::array<lod::ScannedSide, 3> sides;
    double area = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& from = corners[k];
      const auto& to = corners[(k + 1) % 3];
      const double dx = x_[to[0]] - x_[from[0]];
      const double dy = y_[to[1]] - y_[from[1]];
      // Posts on an edge are outside.
      sides[k] = {dy * x_[from[0]] - dx * y_[from[1]] - 0.5, -dy, dx};
      area += x_[from[0]] * y_[to[1]] - x_[to[0]] * y_[from[1]];
    }
    if (!(area > 0)) continue;
    lod::WorstPost expected;
    for (std::uint32_t j = box.j0; j < box.j1; ++j) {
      for (std::uint32_t i = box.i0; i < box.i1; ++i) {
        const bool is_inside = std::ranges::all_of(sides, [&](const lod::ScannedSide& side) {
          return side.at + side.along_x * x_[i] + side.along_y * y_[j] > 0;
        });
        const double error = error_at(plane, i, j);
        if (is_inside && error > expected.geometric_error_m)
          expected = {error, static_cast<std::uint32_t>(j * kSide + i)};
      }
    }
    if (expected.geometric_error_m > 0) ++found;
    on_each_target([&] {
      const lod::WorstPost worst = lod::worst_in_box(posts(), plane, sides, box);
      EXPECT_EQ(worst.geometric_error_m, expected.geometric_error_m);
      if (expected.geometric_error_m > 0) {
        EXPECT_EQ(worst.post, expected.post);
      }
    });
  }
  EXPECT_GT(found, 300);
}

TEST_F(ScanKernel, FindsTheWorstPostOfRows) {
  for (int n = 0; n < 1000; ++n) {
    const lod::ScannedPlane plane = random_plane();
    std::vector<lod::ScannedRow> rows;
    lod::WorstPost expected;
    for (std::uint32_t j = line(); j < kSide; j += 1 + line() / 4) {
      const auto a = static_cast<int>(line());
      const auto b = static_cast<int>(line());
      rows.push_back({j, a, b});  // empty where b <= a
      for (int i = a; i < b; ++i) {
        const double error = error_at(plane, static_cast<std::size_t>(i), j);
        if (error > expected.geometric_error_m)
          expected = {error, static_cast<std::uint32_t>(j * kSide + static_cast<std::size_t>(i))};
      }
    }
    on_each_target([&] {
      lod::WorstPost worst;
      lod::scan_rows(posts(), plane, rows, worst);
      EXPECT_EQ(worst.geometric_error_m, expected.geometric_error_m);
      if (expected.geometric_error_m > 0) {
        EXPECT_EQ(worst.post, expected.post);
      }
      const lod::WorstPost worse{1e9, 5};
      worst = worse;
      lod::scan_rows(posts(), plane, rows, worst);
      EXPECT_EQ(worst.post, worse.post);
    });
  }
}

}  // namespace
