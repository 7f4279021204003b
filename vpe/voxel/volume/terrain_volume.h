// Terrain as a volume of densities (Wan, Qu and Kaufman 1999, section 3).
//
// Coordinates count voxels: voxel (i, j, k) lies at the point (i, j, k), z is up, and heights are z. A density is 0 in the air
// and 255 in the ground; filters make the densities near the surface rise smoothly. Between voxels densities are trilinear, and
// the surface is where they pass the threshold.
//
// Typical usage:
//   const TerrainVolume volume = make_terrain_volume({512, 512, heights}, {.levels = 64, .filter = VolumeFilter::kGaussian});
//   const BoundaryCells cells(volume);
//   const VolumeRanges found = cast_volume(volume, cells, view, {}, pool);  // volume_caster.h
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace vpe::voxel {

inline constexpr int kMostVolumeLevels = 256;
inline constexpr int kMostVolumeSide = 4096;

// Says how densities follow from heights.
enum class VolumeFilter : std::uint8_t {
  kNone,      // 255 up to the height, 0 above
  kGaussian,  // shares of the voxels' cubes below the ground, smoothed by a separable Gaussian
  kBox,  // 255 (1/2 + d / 2 r) with the depth d below the local plane (Sramek and Kaufman 1998, oriented box)
};

struct VolumeSpec {
  int levels = 64;  // voxels along z, 3 to kMostVolumeLevels
  VolumeFilter filter = VolumeFilter::kGaussian;
  double sigma = 1.5;       // of the Gaussian, voxels, 0.5 to 4. Larger: smoother ground, and rounder ridges
  double box_radius = 1.8;  // r of the box filter, voxels, 1 to 4
  std::uint8_t threshold = 127;  // densities above it are ground
};

// Holds a grid of heights in voxels, row by row along x.
struct VolumeHeights {
  int columns = 0;
  int rows = 0;
  std::vector<float> heights;
};

// Holds densities. Immutable; any thread may read it.
class TerrainVolume {
 public:
  // Takes densities column by column: voxel (i, j, k) at (j * columns + i) * levels + k. Overhangs are allowed. Throws
  // std::invalid_argument if a side has fewer than 2 or too many voxels, or the densities do not fill the grid.
  TerrainVolume(int columns, int rows, int levels, std::uint8_t threshold, std::vector<std::uint8_t> densities);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int levels() const { return levels_; }
  std::uint8_t threshold() const { return threshold_; }
  std::size_t bytes() const { return densities_.size(); }

  // Returns the densities of a column of voxels, from the lowest.
  const std::uint8_t* column(int i, int j) const {
    return densities_.data() +
           (static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)) *
               static_cast<std::size_t>(levels_);
  }
  bool is_ground(int i, int j, int k) const { return column(i, j)[k] > threshold_; }

  // Returns the trilinear density at a point of the grid, from (0, 0, 0) to the last voxel, borders included.
  double density(const glm::dvec3& at) const;

 private:
  int columns_;
  int rows_;
  int levels_;
  std::uint8_t threshold_;
  std::vector<std::uint8_t> densities_;
};

// Makes the volume of a height grid. The surface of an unfiltered volume lies within half a voxel of the heights, that of a
// plane with a filter within 0.02 voxels, away from the border of the grid. Throws std::invalid_argument for options beyond their limits, heights that
// do not fill the grid or are not finite, and for heights so near the lowest or the highest voxel that a column would be all
// ground or all air.
TerrainVolume make_terrain_volume(const VolumeHeights& heights, const VolumeSpec& spec);

}  // namespace vpe::voxel
