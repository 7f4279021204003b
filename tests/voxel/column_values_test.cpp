// Tests where the values of a group's runs are, and what expand_rows() makes of them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "vpe/voxel/columns/columns.h"

namespace vpe::voxel {
namespace {

constexpr int kRows = 40;

struct alignas(64) RowValues {
  float value[kMaxLanes];
};

// Two columns whose runs end at the rows 9 and 29, and 4 and 19; the rows above are sky.
TEST(ColumnValues, RunsBecomeRanges) {
  constexpr int kEnds[2][2] = {{9, 29}, {4, 19}};
  const int step = value_step();
  ASSERT_TRUE(step == 1 || step == 2);
  ASSERT_LE(step * column_lanes(), kMaxLanes);
  Rows rows;
  rows.count = kRows;
  rows.centre = 20;
  rows.step = 0.01;
  std::vector<float> length;
  for (int r = 0; r < kRows; ++r)
    length.push_back(static_cast<float>(std::hypot(1.0, (r - rows.centre) * rows.step)));
  rows.length = length.data();

  std::vector<RowValues> starts(kRows + 1), gains(kRows + 1);
  ColumnGroup group{};
  group.start = starts[0].value;
  group.gain = step == 2 ? group.start + 1 : gains[0].value;
  group.columns = column_lanes() > 1 ? 2 : 1;
  const auto start_of = [](int column, int run) {
    return 0.02F - 0.004F * static_cast<float>(2 * run + column);
  };
  const auto gain_of = [](int column, int run) { return -0.01F * static_cast<float>(1 + run + column); };
  for (int c = 0; c < group.columns; ++c) {
    group.row[c] = static_cast<float>(kEnds[c][1] + 1);
    group.row_end[c] = kRows;
    for (int run = 0; run < 2; ++run) {
      const std::ptrdiff_t at = kEnds[c][run] * kMaxLanes + c * step;
      group.start[at] = start_of(c, run);
      group.gain[at] = gain_of(c, run);
    }
  }
  std::array<std::array<float, kMaxLanes>, kRows> out{};
  expand_rows(rows, group, kRows / 2, kRows, out[kRows / 2].data(), kMaxLanes);
  expand_rows(rows, group, 0, kRows / 2, out[0].data(), kMaxLanes);

  for (int c = 0; c < group.columns; ++c) {
    for (int r = 0; r < kRows; ++r) {
      const auto row = static_cast<std::size_t>(r);
      const float range_m = out[row][static_cast<std::size_t>(c)];
      if (r > kEnds[c][1]) {
        EXPECT_TRUE(std::isinf(range_m)) << r;
        continue;
      }
      const int run = r > kEnds[c][0] ? 1 : 0;
      const double below = (r - kEnds[c][run]) * rows.step;
      const double expected_m =
          static_cast<double>(length[row]) /
          (static_cast<double>(start_of(c, run)) + static_cast<double>(gain_of(c, run)) * below);
      EXPECT_NEAR(range_m, expected_m, 1e-5 * expected_m) << "column " << c << " row " << r;
    }
  }
  // The memory is as before, for the next group.
  for (const std::vector<RowValues>& values : {starts, gains}) {
    for (const RowValues& row : values) {
      for (const float value : row.value) EXPECT_EQ(value, 0.0F);
    }
  }
}

}  // namespace
}  // namespace vpe::voxel
