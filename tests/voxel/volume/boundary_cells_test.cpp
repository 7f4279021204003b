// The array of boundary cells against flags of all cells.
#include "vpe/voxel/volume/boundary_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/support/support.h"
#include "tests/voxel/volume/volume_scenes.h"

namespace vpe::voxel {
namespace {

using test_support::Random;

CellFlag flag_by_corners(const TerrainVolume& volume, int i, int j, int k) {
  int ground = 0;
  for (int corner = 0; corner < 8; ++corner)
    ground += volume.column(i + corner % 2, j + corner / 2 % 2)[k + corner / 4] > volume.threshold() ? 1 : 0;
  return ground == 0 ? CellFlag::kAir : ground == 8 ? CellFlag::kGround : CellFlag::kBoundary;
}

TEST(BoundaryCells, EqualTheFlagsOfAllCells) {
  for (const VolumeFilter filter : {VolumeFilter::kNone, VolumeFilter::kGaussian, VolumeFilter::kBox}) {
    const TerrainVolume volume =
        make_terrain_volume(volume_scenes::hills(50), {.levels = 64, .filter = filter});
    const BoundaryCells cells(volume);
    EXPECT_EQ(cells.columns(), 49);
    EXPECT_EQ(cells.rows(), 49);
    for (int j = 0; j < 49; ++j)
      for (int i = 0; i < 49; ++i)
        for (int k = 0; k < 63; ++k)
          ASSERT_EQ(cells.flag(i, j, k), flag_by_corners(volume, i, j, k)) << i << " " << j << " " << k;
  }
}

TEST(BoundaryCells, TakeTwoBytesAColumn) {
  const BoundaryCells cells(make_terrain_volume(volume_scenes::hills(33), {.levels = 64}));
  EXPECT_EQ(cells.bytes(), 2U * 32 * 32);
}

// Over a cave the array holds the lowest and the highest boundary cell: what is between may be anything.
TEST(BoundaryCells, HoldEverySurfaceOfAnOverhang) {
  std::vector<std::uint8_t> densities;
  for (int n = 0; n < 9; ++n)
    for (int k = 0; k < 20; ++k) densities.push_back(k < 4 || (k > 8 && k < 12) ? 255 : 0);
  const TerrainVolume volume(3, 3, 20, 127, densities);
  const BoundaryCells cells(volume);
  EXPECT_EQ(cells.span(0, 0).low, 3);
  EXPECT_EQ(cells.span(1, 1).high, 11);
  for (int k = 0; k < 19; ++k) {
    const CellFlag exact = flag_by_corners(volume, 1, 1, k);
    if (cells.flag(1, 1, k) == CellFlag::kBoundary) continue;
    EXPECT_EQ(cells.flag(1, 1, k), exact);
  }
  EXPECT_THROW(BoundaryCells(TerrainVolume(2, 2, 2, 127, std::vector<std::uint8_t>(8, 255))),
               std::invalid_argument);
}

TEST(BoundaryCells, FirstLowIsNeverTooFar) {
  const TerrainVolume volume = make_terrain_volume(volume_scenes::hills(60), {.levels = 64});
  const BoundaryCells cells(volume);
  Random random(3);
  int stopped = 0;
  double skipped = 0;
  double wanted = 0;
  for (int n = 0; n < 5000; ++n) {
    const glm::dvec3 origin{random.uniform(0, 59), random.uniform(0, 59), random.uniform(40, 62)};
    glm::dvec3 direction = random.direction();
    if (n % 10 == 0) direction = glm::normalize(glm::dvec3(n % 20 == 0 ? 1 : 0, n % 20 == 0 ? 0 : -1, -0.1));
    // To where the ray leaves the volume.
    double end = 200;
    for (int axis = 0; axis < 3; ++axis) {
      const double limit = axis == 2 ? 63 : 59;
      if (direction[axis] > 0) end = std::min(end, (limit - origin[axis]) / direction[axis]);
      if (direction[axis] < 0) end = std::min(end, -origin[axis] / direction[axis]);
    }
    const double found = cells.first_low(origin, direction, 0, end);
    EXPECT_LE(found, end);
    stopped += found < end ? 1 : 0;
    double first = end;
    for (double t = 0; t <= end; t += 0.02) {
      const glm::dvec3 p = origin + t * direction;
      const int i = std::clamp(static_cast<int>(p.x), 0, 58);
      const int j = std::clamp(static_cast<int>(p.y), 0, 58);
      if (cells.flag(i, j, static_cast<int>(p.z)) == CellFlag::kAir) continue;
      first = t;
      break;
    }
    EXPECT_LE(found, first + 1e-6) << n;
    skipped += found;
    wanted += first;
  }
  EXPECT_GT(stopped, 500);
  EXPECT_GT(skipped, 0.85 * wanted);  // and not much too near
}

}  // namespace
}  // namespace vpe::voxel
