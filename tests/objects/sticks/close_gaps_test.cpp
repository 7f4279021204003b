// Gaps between voxels against their definition, voxel by voxel.
#include "objects/points/close_gaps.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <utility>

#include "tests/objects/sticks/point_shapes.h"
#include "tests/support/support.h"

namespace objects {
namespace {

using point_shapes::Place;
using point_shapes::Places;
using point_shapes::places_of;

VoxelGrid grid_of(const glm::ivec3& size) { return VoxelGrid({size.x, size.y, size.z, 1}); }

// Returns random voxels; columns have up to three words.
VoxelGrid random_voxels(::test_support::Random& random) {
  const glm::ivec3 size(random.integer(1, 9), random.integer(1, 9),
                        random.integer(0, 2) == 0 ? random.integer(1, 140) : random.integer(1, 12));
  VoxelGrid voxels = grid_of(size);
  const double share = random.log_uniform(0.005, 0.5);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (int z = 0; z < size.z; ++z)
        if (random.uniform(0, 1) < share) voxels.set(x, y, z);
  return voxels;
}

TEST(CloseGaps, IsAsDefined) {
  ::test_support::Random random(20261127);
  for (int n = 0; n < 60; ++n) {
    VoxelGrid voxels = random_voxels(random);
    const int reach = random.integer(0, 4);
    const Places before = places_of(voxels);
    const Places expected = point_shapes::closed(before, voxels.grid(), reach);
    close_gaps(voxels, reach);
    ASSERT_EQ(places_of(voxels), expected) << n << ": " << reach;
    close_gaps(voxels, reach);
    ASSERT_EQ(places_of(voxels), expected) << n << ": again";
  }
}

RC_GTEST_PROP(CloseGaps, IsAClosing, (std::uint64_t seed)) {
  ::test_support::Random random(seed);
  const VoxelGrid before = random_voxels(random);
  const int reach = random.integer(0, kMostCloseVoxels);
  VoxelGrid after = before;
  close_gaps(after, reach);
  VoxelGrid again = after;
  close_gaps(again, reach);
  VoxelGrid more = before;
  const StickGrid& g = more.grid();
  for (int n = random.integer(1, 9); n > 0; --n) {
    const int x = random.integer(0, g.columns_x - 1);
    const int y = random.integer(0, g.columns_y - 1);
    more.set(x, y, random.integer(0, g.height - 1));
  }
  close_gaps(more, reach);
  for (std::size_t column = 0; column < after.columns(); ++column) {
    for (std::size_t w = 0; w < after.words(); ++w) {
      const std::uint64_t word = std::as_const(after).bits(column)[w];
      RC_ASSERT((before.bits(column)[w] & ~word) == 0U);
      RC_ASSERT(std::as_const(again).bits(column)[w] == word);
      RC_ASSERT((word & ~std::as_const(more).bits(column)[w]) == 0U);
    }
  }
}

TEST(CloseGaps, ReachesNoFurtherUnlessEnclosed) {
  ::test_support::Random random(20261128);
  for (int n = 0; n < 20; ++n) {
    VoxelGrid voxels = random_voxels(random);
    const int reach = random.integer(0, 3);
    const Places near = point_shapes::dilated(places_of(voxels), reach);
    const Place last{voxels.grid().columns_x - 1, voxels.grid().columns_y - 1, voxels.grid().height - 1};
    const Places allowed = point_shapes::with_inside(near, {-reach, -reach, -reach},
                                                     {last[0] + reach, last[1] + reach, last[2] + reach});
    close_gaps(voxels, reach);
    for (const Place& at : places_of(voxels)) ASSERT_TRUE(allowed.contains(at));
  }
}

// A slanted sheet of voxels with holes of one voxel all over, as one side of a shell: the shell gets an inside, which the
// closing by a cube alone does not give it.
TEST(CloseGaps, SlantedShellsWithHolesAreFilled) {
  VoxelGrid voxels = grid_of({41, 41, 41});
  for (int x = -20; x <= 20; ++x)
    for (int y = -20; y <= 20; ++y)
      for (int z = -20; z <= 20; ++z)
        if (std::abs(x) + std::abs(y) + std::abs(z) == 20 && (x + 2 * y) % 3 == 0)
          voxels.set(x + 20, y + 20, z + 20);
  VoxelGrid open = voxels;
  close_gaps(open, 0);
  EXPECT_FALSE(open.is_set(20, 20, 20));
  const Places cubes = point_shapes::eroded(point_shapes::dilated(places_of(voxels), 2), 2);
  EXPECT_FALSE(point_shapes::with_inside(cubes, {0, 0, 0}, {40, 40, 40}).contains({20, 20, 20}));
  close_gaps(voxels, 2);
  for (int x = -14; x <= 14; ++x)
    for (int y = -14; y <= 14; ++y)
      for (int z = -14; z <= 14; ++z)
        if (std::abs(x) + std::abs(y) + std::abs(z) <= 14) {
          ASSERT_TRUE(voxels.is_set(x + 20, y + 20, z + 20)) << x << " " << y << " " << z;
        }
}

TEST(CloseGaps, ClosesGapsOfTwiceTheReach) {
  for (int reach = 0; reach <= kMostCloseVoxels; ++reach) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int gap : {2 * reach, 2 * reach + 1}) {
        glm::ivec3 size(1);
        size[axis] = gap + 2;
        VoxelGrid voxels = grid_of(size);
        voxels.set(0, 0, 0);
        voxels.set(size.x - 1, size.y - 1, size.z - 1);
        close_gaps(voxels, reach);
        EXPECT_EQ(places_of(voxels).size(), gap == 2 * reach ? static_cast<std::size_t>(gap) + 2 : 2U)
            << reach << " " << axis;
      }
    }
  }
}

TEST(CloseGaps, BitsAboveTheHeightStayClear) {
  for (const int height : {1, 31, 63, 64, 65, 127, 128}) {
    VoxelGrid voxels = grid_of({3, 3, height});
    for (int z = 0; z < height; ++z) voxels.set(1, 1, z);
    close_gaps(voxels, 16);
    for (std::size_t column = 0; column < voxels.columns(); ++column)
      for_each_stretch(voxels.bits(column), [&](int, int end) { EXPECT_LE(end, height); });
  }
}

}  // namespace
}  // namespace objects
