#include "objects/points/gap_looks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <glm/vec3.hpp>
#include <span>

#include "objects/sticks/voxel_stretches.h"

namespace objects {

namespace {

// The sum of looks; whole numbers, so that their order has no effect.
struct LookSum {
  std::int64_t count = 0;
  std::array<std::int64_t, 3> colour{};
  glm::ivec3 normal{0, 0, 0};

  void add(const StickVoxel& voxel) {
    ++count;
    colour[0] += voxel.colour.r;
    colour[1] += voxel.colour.g;
    colour[2] += voxel.colour.b;
    normal += glm::ivec3(voxel.normal[0], voxel.normal[1], voxel.normal[2]);
  }

  StickVoxel mean() const {
    const auto byte = [&](std::int64_t sum) {
      return static_cast<std::uint8_t>((2 * sum + count) / (2 * count));
    };
    return stick_voxel({byte(colour[0]), byte(colour[1]), byte(colour[2]), 255}, glm::vec3(normal));
  }
};

// Adds the looks of the set voxels of the surface of a cube.
class CubeSurface {
 public:
  CubeSurface(const PointVoxels& points, const std::vector<StickVoxel>& looks, const VoxelGrid& held)
      : points_(points), looks_(looks), held_(held) {}

  LookSum sum(const glm::ivec3& middle, int reach) const {
    const StickGrid& g = held_.grid();
    LookSum sum;
    for (int y = std::max(middle.y - reach, 0); y <= std::min(middle.y + reach, g.columns_y - 1); ++y) {
      for (int x = std::max(middle.x - reach, 0); x <= std::min(middle.x + reach, g.columns_x - 1); ++x) {
        if (std::abs(x - middle.x) == reach || std::abs(y - middle.y) == reach) {
          add(x, y, middle.z - reach, middle.z + reach, sum);
        } else {
          add(x, y, middle.z - reach, middle.z - reach, sum);
          add(x, y, middle.z + reach, middle.z + reach, sum);
        }
      }
    }
    return sum;
  }

 private:
  void add(int x, int y, int low, int high, LookSum& sum) const {
    const std::span<const std::uint64_t> column = held_.bits(held_.column(x, y));
    for (int z = next_bit(column, std::max(low, 0), true); z <= std::min(high, held_.grid().height - 1);
         z = next_bit(column, z + 1, true))
      sum.add(looks_[points_.number(held_.place(x, y, z))]);
  }

  const PointVoxels& points_;
  const std::vector<StickVoxel>& looks_;
  const VoxelGrid& held_;
};

// Returns the voxels of a word of a column that are set and have a side at which there is an empty one.
std::uint64_t open_voxels(const VoxelGrid& voxels, int x, int y, std::size_t word) {
  const std::span<const std::uint64_t> own = voxels.bits(voxels.column(x, y));
  const StickGrid& g = voxels.grid();
  const auto beside = [&](int other_x, int other_y) {
    const bool is_inside = other_x >= 0 && other_y >= 0 && other_x < g.columns_x && other_y < g.columns_y;
    return is_inside ? voxels.bits(voxels.column(other_x, other_y))[word] : 0;
  };
  const std::uint64_t below = own[word] << 1 | (word > 0 ? own[word - 1] >> 63 : 0);
  const std::uint64_t above = own[word] >> 1 | (word + 1 < own.size() ? own[word + 1] << 63 : 0);
  return own[word] &
         ~(below & above & beside(x - 1, y) & beside(x + 1, y) & beside(x, y - 1) & beside(x, y + 1));
}

}  // namespace

void colour_gaps(const PointVoxels& points, const std::vector<StickVoxel>& looks, const VoxelGrid& held,
                 int most_reach, VoxelGrid& out) {
  const CubeSurface surface(points, looks, held);
  const StickGrid& g = held.grid();
  const auto look_of = [&](const glm::ivec3& at) {
    LookSum sum;
    for (int reach = 1; reach <= most_reach && sum.count == 0; ++reach) sum = surface.sum(at, reach);
    return sum;
  };
  for (int y = 0; y < g.columns_y; ++y) {
    for (int x = 0; x < g.columns_x; ++x) {
      for (std::size_t w = 0; w < out.words(); ++w) {
        std::uint64_t rest = open_voxels(out, x, y, w) & ~held.bits(held.column(x, y))[w];
        for (; rest != 0; rest &= rest - 1) {
          const int z = static_cast<int>(w) * 64 + std::countr_zero(rest);
          const LookSum sum = look_of({x, y, z});
          if (sum.count > 0) out.add_colour(out.place(x, y, z), sum.mean());
        }
      }
    }
  }
}

}  // namespace objects
