#include "objects/sticks/voxel_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace objects {

StickVoxel stick_voxel(const Rgba& colour, const glm::vec3& normal) {
  const float length = glm::length(normal);
  StickVoxel voxel{colour, {0, 0, 127}};
  if (!(length > 0) || !std::isfinite(length)) return voxel;
  for (int k = 0; k < 3; ++k)
    voxel.normal[k] = static_cast<std::int8_t>(std::lround(normal[k] / length * 127.0F));
  return voxel;
}

VoxelGrid::VoxelGrid(const StickGrid& grid) : grid_(grid) {
  for (const int side : {grid.columns_x, grid.columns_y, grid.height}) {
    if (side < 1 || side > StickLimits::kMostSide)
      throw std::invalid_argument("a grid of voxels has 1 to " + std::to_string(StickLimits::kMostSide) +
                                  " voxels along a side, not " + std::to_string(side));
  }
  const double extent_m =
      static_cast<double>(grid.voxel_m) * std::max({grid.columns_x, grid.columns_y, grid.height});
  if (!(grid.voxel_m > 0) || !(extent_m <= MeshLimits::kMostExtent_m) ||
      !std::isfinite(glm::length(grid.corner_m)))
    throw std::invalid_argument("the voxels of a grid have no positive size, or it is not finite");
  words_ = (static_cast<std::size_t>(grid.height) + 63) / 64;
  const std::size_t columns =
      static_cast<std::size_t>(grid.columns_x) * static_cast<std::size_t>(grid.columns_y);
  if (columns > StickLimits::kMostColumns || columns * words_ > kMostBits / 64)
    throw std::invalid_argument("a grid of " + std::to_string(grid.columns_x) + " x " +
                                std::to_string(grid.columns_y) + " x " + std::to_string(grid.height) +
                                " voxels is too large; use fewer voxels");
  bits_.resize(columns * words_);
}

glm::ivec3 VoxelGrid::voxel_of(std::uint64_t place) const {
  const auto height = static_cast<std::uint64_t>(grid_.height);
  const std::uint64_t column = place / height;
  const auto row = static_cast<std::uint64_t>(grid_.columns_x);
  return {static_cast<int>(column % row), static_cast<int>(column / row), static_cast<int>(place % height)};
}

bool VoxelGrid::is_set(int x, int y, int z) const {
  if (x < 0 || y < 0 || z < 0 || x >= grid_.columns_x || y >= grid_.columns_y || z >= grid_.height)
    return false;
  return ((bits(column(x, y))[static_cast<std::size_t>(z) / 64] >> (z % 64)) & 1U) != 0;
}

void VoxelGrid::set(int x, int y, int z) {
  bits(column(x, y))[static_cast<std::size_t>(z) / 64] |= std::uint64_t{1} << (z % 64);
}

void VoxelGrid::set(int x, int y, int z, const StickVoxel& voxel) {
  if (voxel.colour.a == 0) {
    clear(x, y, z);
    return;
  }
  set(x, y, z);
  add_colour(place(x, y, z), voxel);
}

void VoxelGrid::clear(int x, int y, int z) {
  bits(column(x, y))[static_cast<std::size_t>(z) / 64] &= ~(std::uint64_t{1} << (z % 64));
}

void VoxelGrid::tidy() {
  const auto before = [](const Coloured& a, const Coloured& b) { return a.place < b.place; };
  if (!std::is_sorted(coloured_.begin(), coloured_.end(), before))
    std::stable_sort(coloured_.begin(), coloured_.end(), before);
  std::size_t kept = 0;
  for (std::size_t n = 0; n < coloured_.size(); ++n) {
    if (n + 1 < coloured_.size() && coloured_[n + 1].place == coloured_[n].place) continue;
    const glm::ivec3 at = voxel_of(coloured_[n].place);
    if (coloured_[n].voxel.colour.a > 0 && is_set(at.x, at.y, at.z)) coloured_[kept++] = coloured_[n];
  }
  coloured_.resize(kept);
}

std::vector<std::uint32_t> VoxelGrid::first_colours() const {
  std::vector<std::uint32_t> first(columns() + 1, 0);
  for (const Coloured& c : coloured_) ++first[c.place / static_cast<std::uint64_t>(grid_.height) + 1];
  for (std::size_t n = 1; n < first.size(); ++n) first[n] += first[n - 1];
  return first;
}

}  // namespace objects
