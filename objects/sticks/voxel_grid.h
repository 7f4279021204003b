// A grid of voxels while a model of sticks is made from it: a bit for each voxel, and the colours of those at the
// surface.
//
// Typical usage:
//   VoxelGrid voxels({.columns_x = 64, .columns_y = 64, .height = 32, .voxel_m = 0.01F});
//   voxels.set(3, 4, 5, stick_voxel({200, 30, 30, 255}, {0, 0, 1}));
//   const StickModel model = build_sticks(std::move(voxels));
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "objects/sticks/stick_model.h"
#include "objects/sticks/voxel_stretches.h"

namespace objects {

// Returns a voxel with a normal of any length; that of a zero vector is up. Pure.
StickVoxel stick_voxel(const Rgba& colour, const glm::vec3& normal);

class VoxelGrid {
 public:
  static constexpr std::size_t kMostBits = std::size_t{1} << 31;

  struct Coloured {
    std::uint64_t place = 0;  // column * height + z
    StickVoxel voxel;
  };

  VoxelGrid() = default;
  // All voxels are empty. Throws std::invalid_argument for sides or sizes beyond StickLimits, a grid that takes more
  // than kMostBits, and edges or corners that are not finite.
  explicit VoxelGrid(const StickGrid& grid);

  const StickGrid& grid() const { return grid_; }
  std::size_t columns() const { return bits_.size() / (words_ > 0 ? words_ : 1); }
  std::size_t column(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.columns_x) +
           static_cast<std::size_t>(x);
  }
  std::uint64_t place(int x, int y, int z) const {
    return std::uint64_t{column(x, y)} * static_cast<std::uint64_t>(grid_.height) +
           static_cast<std::uint64_t>(z);
  }
  glm::ivec3 voxel_of(std::uint64_t place) const;

  // The voxels of a column: bit z % 64 of word z / 64. Bits above the height must stay 0.
  std::size_t words() const { return words_; }
  std::span<std::uint64_t> bits(std::size_t column) { return {bits_.data() + column * words_, words_}; }
  std::span<const std::uint64_t> bits(std::size_t column) const {
    return {bits_.data() + column * words_, words_};
  }

  // Returns false outside of the grid.
  bool is_set(int x, int y, int z) const;
  // Fills a voxel. One without a colour is opaque and looks like the nearest coloured opaque one of its stretch of
  // the column, the lower one of two at the same distance; where there is none, like `filling`.
  void set(int x, int y, int z);
  // Fills a voxel with a colour; alpha below 255 makes it semi-transparent, alpha 0 empties it.
  void set(int x, int y, int z, const StickVoxel& voxel);
  void clear(int x, int y, int z);

  // Colours of voxels. Those of empty voxels do not count; of two for a voxel the later one counts.
  const std::vector<Coloured>& coloured() const { return coloured_; }
  void add_colour(std::uint64_t place, const StickVoxel& voxel) { coloured_.push_back({place, voxel}); }
  void set_coloured(std::vector<Coloured> coloured) { coloured_ = std::move(coloured); }
  // Sorts colours by place and removes those that do not count.
  void tidy();
  // Returns, for a tidy grid, the index of the first colour of each column, and their number at the end.
  std::vector<std::uint32_t> first_colours() const;

  StickVoxel filling{{160, 160, 160, 255}, {0, 0, 127}};

 private:
  StickGrid grid_;
  std::size_t words_ = 0;  // of a column
  std::vector<std::uint64_t> bits_;
  std::vector<Coloured> coloured_;
};

}  // namespace objects
