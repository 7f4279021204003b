// Terrain as a volume of densities, of which a narrow band about the surface is kept.
//
// Coordinates, densities and the threshold are those of TerrainVolume (terrain_volume.h), but levels have no ends: below its
// band a column is ground, above it air. Overhangs lie within the band.
//
// Typical usage:
//   const BandVolume volume = make_band_volume({129, 129, heights}, {.filter = VolumeFilter::kGaussian});
//   if (volume.flag(i, j, k) == CellFlag::kBoundary && volume.density(at) > volume.surface()) ...
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "vpe/voxel/volume/block_maxima.h"
#include "vpe/voxel/volume/boundary_cells.h"
#include "vpe/voxel/volume/terrain_volume.h"

namespace vpe::voxel {

// Levels lie within this, also those of bands.
inline constexpr int kMostBandLevel = 32000;

// Collects the columns of voxels of a BandVolume, row by row along x.
class BandColumns {
 public:
  // Adds a column with `densities` from level `first` on. Leaves out full densities at their beginning and empty ones at their
  // end.
  void add(int first, const std::vector<std::uint8_t>& densities);
  std::size_t size() const { return first_.size(); }

 private:
  friend class BandVolume;
  std::vector<std::int16_t> first_;
  std::vector<std::uint32_t> begin_{0};  // of a column's densities, and the end of the last one
  std::vector<std::uint8_t> densities_;
};

// Immutable; any thread may read it.
class BandVolume {
 public:
  // Throws std::invalid_argument if a side has fewer than 2 or more than kMostVolumeSide columns, or if the columns do not fill
  // the grid.
  BandVolume(int columns, int rows, std::uint8_t threshold, BandColumns voxels);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  // Returns the density at the surface, between the threshold and the next density.
  double surface() const { return threshold_ + 0.5; }

  // Returns the density of voxel (i, j, k), 0 <= i < columns(), 0 <= j < rows(), any k.
  std::uint8_t voxel(int i, int j, int k) const { return at(place(i, j), k); }
  // Returns the trilinear density at a point. The columns at the border go on beyond it.
  double density(const glm::dvec3& at) const;

  // Holds the lowest and the highest boundary cell of a column of cells (boundary_cells.h). Where `low` is above `high` there is
  // none: ground up to `high`, air above.
  struct Span {
    std::int16_t low = 0;
    std::int16_t high = 0;
  };
  // Returns that of column (i, j) of cells, 0 <= i < columns() - 1, 0 <= j < rows() - 1.
  const Span& span(int i, int j) const {
    return spans_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_ - 1) +
                  static_cast<std::size_t>(i)];
  }
  CellFlag flag(int i, int j, int k) const {
    const Span& column = span(i, j);
    return k > column.high ? CellFlag::kAir : k < column.low ? CellFlag::kGround : CellFlag::kBoundary;
  }
  const BlockMaxima& maxima() const { return *maxima_; }

  // Returns the lowest and the highest level at which the density of a column passes the surface, linear between voxels. They
  // are one where the column has no overhang.
  struct Crossings {
    double low = 0;
    double high = 0;
  };
  Crossings crossings(int i, int j) const;

  // Returns the size of the band, and of everything.
  std::size_t band_bytes() const;
  std::size_t bytes() const;

 private:
  std::size_t place(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i);
  }
  std::uint8_t at(std::size_t column, int k) const {
    const int n = k - voxels_.first_[column];
    if (n < 0) return 255;
    const std::uint32_t begin = voxels_.begin_[column];
    const auto level = static_cast<std::uint32_t>(n);
    return level < voxels_.begin_[column + 1] - begin ? voxels_.densities_[begin + level] : 0;
  }
  int end(std::size_t column) const {
    return voxels_.first_[column] + static_cast<int>(voxels_.begin_[column + 1] - voxels_.begin_[column]);
  }
  Span make_span(int i, int j) const;

  int columns_;
  int rows_;
  std::uint8_t threshold_;
  BandColumns voxels_;
  std::vector<Span> spans_;
  std::optional<BlockMaxima> maxima_;
};

// Says how the densities of a band follow from heights.
struct BandSpec {
  VolumeFilter filter = VolumeFilter::kGaussian;
  double sigma = 1.5;            // VolumeSpec::sigma
  double box_radius = 1.8;       // VolumeSpec::box_radius
  std::uint8_t threshold = 127;  // VolumeSpec::threshold
  bool operator==(const BandSpec&) const = default;
};

// Makes the band of a height grid, in voxels. The densities are those of make_terrain_volume() but for rounding and near the
// border of the grid. There the heights are continued by reflection at the outer posts: h(-k) = 2 h(0) - h(k). So planes stay
// planes up to the border, and grids with the same heights along their common border meet in the same surface, nearly: the
// difference is part of the slopes beside the border, and is bounded as the rest (crossings()). Throws std::invalid_argument as
// make_terrain_volume(), and for heights beyond kMostBandLevel less 200.
BandVolume make_band_volume(const VolumeHeights& heights, const BandSpec& spec);

}  // namespace vpe::voxel
