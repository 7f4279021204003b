// Pyramids of least and largest values against all cells.
#include "relief/field/bounds_pyramid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/relief/samples.h"

namespace relief {
namespace {

TEST(ReliefBoundsPyramid, HoldsTheCellsOfEveryRectangle) {
  samples::Random random(14);
  const int columns = 37;
  const int rows = 22;
  std::vector<Interval> cells;
  for (int n = 0; n < columns * rows; ++n) {
    const double low = random.in(-1.0, 1.0);
    cells.push_back({low, low + random.in(0.0, 0.1)});
  }
  const BoundsPyramid pyramid(columns, rows, cells);
  EXPECT_EQ(pyramid.levels(), 7);
  for (int n = 0; n < 2000; ++n) {
    const int i0 = random.in(0, columns - 1);
    const int i1 = random.in(i0, columns - 1);
    const int j0 = random.in(0, rows - 1);
    const int j1 = random.in(j0, rows - 1);
    Interval expected = cells[static_cast<std::size_t>(j0 * columns + i0)];
    for (int j = j0; j <= j1; ++j)
      for (int i = i0; i <= i1; ++i)
        expected = hull(expected, cells[static_cast<std::size_t>(j * columns + i)]);
    const Interval found = pyramid.over(i0, i1, j0, j1);
    EXPECT_LE(found.low, expected.low);
    EXPECT_GE(found.high, expected.high);
    if (i1 - i0 <= 1 && j1 - j0 <= 1) {
      EXPECT_LE(width(found), width(expected) + 3e-7);
    }
  }
  const Interval all = pyramid.over(0, columns - 1, 0, rows - 1);
  EXPECT_EQ(all.low, pyramid.all().low);
  EXPECT_EQ(all.high, pyramid.all().high);
}

TEST(ReliefBoundsPyramid, RoundsOutwards) {
  const double third = 1.0 / 3;
  const Interval found = BoundsPyramid(1, 1, {{third, third}}).all();
  EXPECT_LE(found.low, third);
  EXPECT_GE(found.high, third);
  EXPECT_LT(width(found), 1e-7);
}

TEST(ReliefBoundsPyramid, NeedsAFullGrid) {
  EXPECT_THROW(BoundsPyramid(2, 2, {{0, 1}}), std::invalid_argument);
  EXPECT_THROW(BoundsPyramid(0, 0, {}), std::invalid_argument);
}

}  // namespace
}  // namespace relief
