// Densities of terrain volumes: filters, planes, half a voxel.
#include "vpe/voxel/volume/terrain_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "tests/support/support.h"
#include "tests/voxel/volume/volume_scenes.h"
#include "vpe/voxel/volume/cube_share.h"

namespace vpe::voxel {
namespace {

using test_support::Random;
using volume_scenes::heights_of;

TEST(CubeShare, IsThatOfTheCube) {
  EXPECT_NEAR(cube_share_below({0, 0, 1}, 0.3), 0.8, 1e-4);
  EXPECT_NEAR(cube_share_below({-1, 0, 0}, -0.25), 0.25, 1e-4);
  const double half = std::sqrt(0.5);
  EXPECT_NEAR(cube_share_below({half, half, 0}, -0.5 * half), 0.125, 1e-4);  // the triangle of half a side
  EXPECT_EQ(cube_share_below({half, half, 0}, 1), 1);
  EXPECT_EQ(cube_share_below({half, half, 0}, -1), 0);
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    const glm::dvec3 normal = random.direction();
    const double distance = random.uniform(-0.9, 0.9);
    EXPECT_NEAR(cube_share_below(normal, distance) + cube_share_below(-normal, -distance), 1, 1e-6);
    constexpr int kSide = 24;
    int below = 0;
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
      const glm::dvec3 p{(i % kSide + 0.5) / kSide - 0.5, (i / kSide % kSide + 0.5) / kSide - 0.5,
                         (i / kSide / kSide + 0.5) / kSide - 0.5};
      below += glm::dot(normal, p) <= distance ? 1 : 0;
    }
    EXPECT_NEAR(cube_share_below(normal, distance), static_cast<double>(below) / (kSide * kSide * kSide), 0.03);
  }
}

// Returns how far the surface of a volume lies from a plane z = h + a x + b y, in voxels along its normal, at random places
// away from the border.
double off_plane(VolumeFilter filter, double h, double a, double b, Random& random) {
  constexpr int kSide = 33;
  constexpr int kLevels = 128;
  const VolumeHeights grid = heights_of(kSide, kSide, [&](double x, double y) { return h + a * x + b * y; });
  const TerrainVolume volume = make_terrain_volume(grid, {.levels = kLevels, .filter = filter});
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-a, -b, 1));
  double most = 0;
  for (int n = 0; n < 200; ++n) {
    const double x = random.uniform(12, kSide - 13);
    const double y = random.uniform(12, kSide - 13);
    const glm::dvec3 on{x, y, h + a * x + b * y};
    // Where the density passes the threshold along the normal.
    double low = -2;
    double high = 2;
    for (int step = 0; step < 40; ++step) {
      const double middle = 0.5 * (low + high);
      (volume.density(on + middle * normal) > volume.threshold() + 0.5 ? low : high) = middle;
    }
    most = std::max(most, std::abs(low));
  }
  return most;
}

TEST(TerrainVolumes, PlanesStayWhereTheyAreUnderBothFilters) {
  Random random(2);
  for (int n = 0; n < 30; ++n) {
    const double a = n == 0 ? 0 : n == 1 ? 1 : random.uniform(-1.5, 1.5);
    const double b = n <= 1 ? a : random.uniform(-1.5, 1.5);
    const double h = 64 - 16 * (a + b) + random.uniform(-1, 1);
    EXPECT_LT(off_plane(VolumeFilter::kGaussian, h, a, b, random), 0.02) << a << " " << b << " " << h;
    EXPECT_LT(off_plane(VolumeFilter::kBox, h, a, b, random), 0.02) << a << " " << b << " " << h;
  }
}

TEST(TerrainVolumes, WithoutAFilterDensitiesAreAllOrNothing) {
  const VolumeHeights grid = volume_scenes::hills(40);
  const TerrainVolume volume = make_terrain_volume(grid, {.levels = 64, .filter = VolumeFilter::kNone});
  for (int j = 0; j < 40; ++j) {
    for (int i = 0; i < 40; ++i) {
      const float height = grid.heights[static_cast<std::size_t>(j * 40 + i)];
      for (int k = 0; k < 64; ++k) ASSERT_EQ(volume.column(i, j)[k], static_cast<float>(k) < height ? 255 : 0);
    }
  }
}

TEST(TerrainVolumes, FilteredDensitiesFallUpwards) {
  for (const VolumeFilter filter : {VolumeFilter::kGaussian, VolumeFilter::kBox}) {
    const TerrainVolume volume =
        make_terrain_volume(volume_scenes::hills(40), {.levels = 64, .filter = filter});
    int between = 0;
    for (int j = 0; j < 40; ++j) {
      for (int i = 0; i < 40; ++i) {
        for (int k = 0; k + 1 < 64; ++k) {
          ASSERT_GE(volume.column(i, j)[k], volume.column(i, j)[k + 1]);
          between += volume.column(i, j)[k] > 0 && volume.column(i, j)[k] < 255 ? 1 : 0;
        }
      }
    }
    EXPECT_GT(between, 40 * 40 * 3);
  }
}

TEST(TerrainVolumes, DensitiesAreTrilinear) {
  std::vector<std::uint8_t> densities{10, 20, 30, 40, 50, 60, 70, 80};
  const TerrainVolume volume(2, 2, 2, 127, densities);
  EXPECT_EQ(volume.density({0, 0, 0}), 10);
  EXPECT_EQ(volume.density({0, 0, 1}), 20);
  EXPECT_EQ(volume.density({1, 0, 0}), 30);
  EXPECT_EQ(volume.density({0, 1, 0}), 50);
  EXPECT_EQ(volume.density({1, 1, 1}), 80);
  EXPECT_NEAR(volume.density({0.5, 0.5, 0.5}), 45, 1e-12);
  EXPECT_NEAR(volume.density({0.25, 0.5, 1}), 45, 1e-12);
  EXPECT_EQ(volume.bytes(), 8U);
}

TEST(TerrainVolumes, RefuseWhatTheyCannotHold) {
  const VolumeHeights grid = volume_scenes::hills(8);
  EXPECT_THROW(make_terrain_volume(grid, {.levels = 2}), std::invalid_argument);
  EXPECT_THROW(make_terrain_volume(grid, {.levels = 257}), std::invalid_argument);
  EXPECT_THROW(make_terrain_volume(grid, {.levels = 64, .sigma = 0}), std::invalid_argument);
  EXPECT_THROW(make_terrain_volume(grid, {.levels = 64, .box_radius = NAN}), std::invalid_argument);
  EXPECT_THROW(make_terrain_volume({8, 7, grid.heights}, {.levels = 64}), std::invalid_argument);
  EXPECT_THROW(make_terrain_volume({64, 1, grid.heights}, {.levels = 64}), std::invalid_argument);
  VolumeHeights broken = grid;
  broken.heights[3] = NAN;
  EXPECT_THROW(make_terrain_volume(broken, {.levels = 64}), std::invalid_argument);
  EXPECT_THROW(make_terrain_volume(heights_of(8, 8, [](double, double) { return 63.9; }), {.levels = 64}),
               std::invalid_argument);
  EXPECT_THROW(make_terrain_volume(heights_of(8, 8, [](double, double) { return -1; }), {.levels = 64}),
               std::invalid_argument);
  EXPECT_THROW(TerrainVolume(2, 2, 2, 127, std::vector<std::uint8_t>(7)), std::invalid_argument);
  EXPECT_THROW(TerrainVolume(2, 2, 1, 127, std::vector<std::uint8_t>(4)), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::voxel
