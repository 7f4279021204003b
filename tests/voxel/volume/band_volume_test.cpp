// Bands of voxels: the densities of whole volumes, planes up to the border, cells, overhangs.
#include "vpe/voxel/volume/band_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "tests/support/support.h"
#include "tests/voxel/volume/volume_scenes.h"

namespace vpe::voxel {
namespace {

using test_support::Random;
using volume_scenes::heights_of;

constexpr VolumeFilter kFilters[] = {VolumeFilter::kNone, VolumeFilter::kGaussian, VolumeFilter::kBox};

TEST(BandVolumes, HaveTheDensitiesOfWholeVolumes) {
  constexpr int kSide = 48;
  const VolumeHeights grid = volume_scenes::hills(kSide);
  for (const VolumeFilter filter : kFilters) {
    const TerrainVolume whole = make_terrain_volume(grid, {.levels = 64, .filter = filter});
    const BandVolume band = make_band_volume(grid, {.filter = filter});
    // A Gaussian takes in what is beyond the border, which is another thing there.
    const int margin = filter == VolumeFilter::kNone ? 0 : filter == VolumeFilter::kBox ? 1 : 7;
    int differs = 0;
    for (int j = margin; j < kSide - margin; ++j) {
      for (int i = margin; i < kSide - margin; ++i) {
        for (int k = 0; k < 64; ++k) {
          const int off = std::abs(int{band.voxel(i, j, k)} - int{whole.column(i, j)[k]});
          // Sums are added up in another order: a density may be rounded to its neighbour.
          ASSERT_LE(off, 1) << i << " " << j << " " << k;
          differs += off;
        }
        ASSERT_EQ(band.voxel(i, j, -1000), 255);
        ASSERT_EQ(band.voxel(i, j, 1000), 0);
      }
    }
    EXPECT_LT(differs, 20);
    EXPECT_LT(band.band_bytes(), whole.bytes() / 2);
    EXPECT_GT(band.bytes(), band.band_bytes());
    Random random(3);
    for (int n = 0; n < 2000; ++n) {
      const glm::dvec3 at{random.uniform(margin, kSide - 1 - margin),
                          random.uniform(margin, kSide - 1 - margin), random.uniform(0, 63)};
      ASSERT_NEAR(band.density(at), whole.density(at), 1.0);
    }
  }
}

// Returns how far the surface of a band lies from a plane, in voxels along its normal, at a place of it.
double off_plane(const BandVolume& volume, const glm::dvec3& on, const glm::dvec3& normal) {
  double low = -2;
  double high = 2;
  for (int step = 0; step < 40; ++step) {
    const double middle = 0.5 * (low + high);
    (volume.density(on + middle * normal) > volume.surface() ? low : high) = middle;
  }
  return std::abs(low);
}

TEST(BandVolumes, PlanesStayWhereTheyAreUpToTheBorder) {
  constexpr int kSide = 17;
  Random random(2);
  double most = 0;
  for (int n = 0; n < 30; ++n) {
    const double a = n == 0 ? 0 : n == 1 ? 1 : random.uniform(-1.5, 1.5);
    const double b = n <= 1 ? a : random.uniform(-1.5, 1.5);
    const double h = random.uniform(-300, 300);
    const VolumeHeights grid = heights_of(kSide, kSide, [&](double x, double y) { return h + a * x + b * y; });
    const glm::dvec3 normal = glm::normalize(glm::dvec3(-a, -b, 1));
    for (const VolumeFilter filter : {VolumeFilter::kGaussian, VolumeFilter::kBox}) {
      const BandVolume volume = make_band_volume(grid, {.filter = filter});
      for (int place = 0; place < 100; ++place) {
        double x = random.uniform(0, kSide - 1);
        double y = random.uniform(0, kSide - 1);
        if (place % 4 == 0) x = place % 8 == 0 ? 0 : kSide - 1;
        if (place % 5 == 0) y = place % 10 == 0 ? 0 : kSide - 1;
        // Along the vertical, which does not leave the grid: a step of 1 / cos there is one along the normal.
        most = std::max(most, off_plane(volume, {x, y, h + a * x + b * y}, {0, 0, 1 / normal.z}));
      }
    }
  }
  EXPECT_LT(most, 0.02);
}

// Neighbours have the same posts on their common border, and nothing else.
TEST(BandVolumes, NeighboursMeetInNearlyTheSameSurface) {
  constexpr int kSide = 33;
  const VolumeHeights west = heights_of(kSide, kSide, volume_scenes::hill);
  const VolumeHeights east =
      heights_of(kSide, kSide, [](double x, double y) { return volume_scenes::hill(x + kSide - 1, y); });
  for (const VolumeFilter filter : kFilters) {
    const BandVolume a = make_band_volume(west, {.filter = filter});
    const BandVolume b = make_band_volume(east, {.filter = filter});
    double most = 0;
    for (int j = 0; j < kSide; ++j)
      most = std::max(most, std::abs(a.crossings(kSide - 1, j).low - b.crossings(0, j).low));
    std::printf("filter %d: borders of neighbours are at most %.3f voxels apart\n", static_cast<int>(filter),
                most);
    EXPECT_LT(most, filter == VolumeFilter::kGaussian ? 0.5 : 0.05);
  }
}

// Returns columns with overhangs and holes: random densities in runs.
BandVolume caves(int columns, int rows, Random& random, std::vector<std::vector<int>>& full) {
  BandColumns voxels;
  for (int n = 0; n < columns * rows; ++n) {
    const int first = random.integer(-9, 3);
    std::vector<std::uint8_t> densities;
    const int count = random.integer(0, 14);
    while (static_cast<int>(densities.size()) < count) {
      const auto density = static_cast<std::uint8_t>(random.integer(0, 2) == 0   ? random.integer(0, 255)
                                                     : random.integer(0, 1) == 0 ? 255
                                                                                 : 0);
      densities.insert(densities.end(), static_cast<std::size_t>(random.integer(1, 4)), density);
    }
    voxels.add(first, densities);
    std::vector<int> column;
    for (int k = -20; k < 30; ++k) {
      const int level = k - first;
      column.push_back(level < 0                                    ? 255
                       : level < static_cast<int>(densities.size()) ? densities[static_cast<std::size_t>(level)]
                                                                    : 0);
    }
    full.push_back(column);
  }
  return {columns, rows, 127, std::move(voxels)};
}

TEST(BandVolumes, CellsAreThoseOfEveryCorner) {
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const int columns = random.integer(2, 9);
    const int rows = random.integer(2, 9);
    std::vector<std::vector<int>> full;
    const BandVolume volume = caves(columns, rows, random, full);
    const auto voxel = [&](int i, int j, int k) {
      return full[static_cast<std::size_t>(j * columns + i)][static_cast<std::size_t>(k + 20)];
    };
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        for (int k = -20; k < 30; ++k) ASSERT_EQ(volume.voxel(i, j, k), voxel(i, j, k));
        // The crossings of a column, from every pair of voxels.
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (int k = -20; k < 29; ++k) {
          const double below = voxel(i, j, k) - 127.5;
          const double above = voxel(i, j, k + 1) - 127.5;
          if ((below > 0) == (above > 0)) continue;
          low = std::min(low, k + below / (below - above));
          high = std::max(high, k + below / (below - above));
        }
        EXPECT_NEAR(volume.crossings(i, j).low, low, 1e-12);
        EXPECT_NEAR(volume.crossings(i, j).high, high, 1e-12);
      }
    }
    int highest = -100;
    for (int j = 0; j + 1 < rows; ++j) {
      for (int i = 0; i + 1 < columns; ++i) {
        int low = 100;
        int high = -100;
        for (int k = -20; k < 29; ++k) {
          int ground = 0;
          for (int corner = 0; corner < 8; ++corner)
            ground += voxel(i + (corner & 1), j + ((corner >> 1) & 1), k + (corner >> 2)) > 127 ? 1 : 0;
          if (ground != 0 && ground != 8) {
            low = std::min(low, k);
            high = std::max(high, k);
          }
          const CellFlag flag = volume.flag(i, j, k);
          if (ground != 0 && ground != 8) {
            ASSERT_EQ(flag, CellFlag::kBoundary);
          }
          if (flag == CellFlag::kAir) {
            ASSERT_EQ(ground, 0);
          }
          if (flag == CellFlag::kGround) {
            ASSERT_EQ(ground, 8);
          }
        }
        ASSERT_EQ(volume.span(i, j).low, low);
        ASSERT_EQ(volume.span(i, j).high, high);
        highest = std::max(highest, high);
      }
    }
    EXPECT_EQ(volume.maxima().highest(), highest);
  }
}

TEST(BandVolumes, BlocksLeadPastAirAlone) {
  const BandVolume volume = make_band_volume(volume_scenes::hills(64), {});
  EXPECT_GT(volume.maxima().bytes(), 63U * 63U * 2U);
  Random random(7);
  int skipped = 0;
  for (int n = 0; n < 3000; ++n) {
    const glm::dvec3 origin{random.uniform(0, 63), random.uniform(0, 63), random.uniform(0, 60)};
    const glm::dvec3 way{random.uniform(0, 63), random.uniform(0, 63), random.uniform(0, 60)};
    const double length = glm::length(way - origin);
    const glm::dvec3 direction = (way - origin) / length;
    const double first = volume.maxima().first_low(origin, direction, 0, length);
    ASSERT_GE(first, 0);
    ASSERT_LE(first, length);
    skipped += first > 0 ? 1 : 0;
    for (double t = 0; t < first; t += 0.2) ASSERT_LE(volume.density(origin + t * direction), volume.surface());
  }
  EXPECT_GT(skipped, 1000);
  // Straight down, and along a border of blocks.
  EXPECT_GT(volume.maxima().first_low({20, 20, 500}, {0, 0, -1}, 0, 500), 430);
  EXPECT_EQ(volume.maxima().first_low({32, 0, 500}, {0, 1, 0}, 0, 63), 63);
  EXPECT_EQ(volume.maxima().first_low({32, 0, 500}, glm::normalize(glm::dvec3(1e-16, 1, 0)), 0, 63), 63);
}

TEST(BandVolumes, RefuseWhatTheyCannotHold) {
  const VolumeHeights grid = volume_scenes::hills(8);
  EXPECT_THROW(make_band_volume(grid, {.sigma = 0.4}), std::invalid_argument);
  EXPECT_THROW(make_band_volume(grid, {.sigma = 4.1}), std::invalid_argument);
  EXPECT_THROW(make_band_volume(grid, {.box_radius = NAN}), std::invalid_argument);
  EXPECT_THROW(make_band_volume({8, 7, grid.heights}, {}), std::invalid_argument);
  EXPECT_THROW(make_band_volume({1, 64, grid.heights}, {}), std::invalid_argument);
  VolumeHeights broken = grid;
  broken.heights[3] = NAN;
  EXPECT_THROW(make_band_volume(broken, {}), std::invalid_argument);
  broken.heights[3] = 32000;
  EXPECT_THROW(make_band_volume(broken, {}), std::invalid_argument);
  broken.heights[3] = -31000;
  EXPECT_NO_THROW(make_band_volume(broken, {.filter = VolumeFilter::kNone}));
  BandColumns three;
  for (int n = 0; n < 3; ++n) three.add(0, {});
  EXPECT_EQ(three.size(), 3U);
  EXPECT_THROW(BandVolume(2, 2, 127, three), std::invalid_argument);
  EXPECT_THROW(BandVolume(3, 1, 127, three), std::invalid_argument);
  EXPECT_THROW(BlockMaxima(2, 2, {1, 2, 3}), std::invalid_argument);
  EXPECT_THROW(BlockMaxima(0, 2, {}), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::voxel
