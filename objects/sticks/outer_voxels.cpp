#include "objects/sticks/outer_voxels.h"

#include <cmath>
#include <glm/common.hpp>

namespace objects {

namespace {

// A surface that only touches a voxel can pass two centres behind its own.
constexpr int kInsideReach = 2;
// At edges of solids, which are thicker than this, other directions count too: the share of the longest part of one.
constexpr int kSolidDepth = 3;
constexpr float kSolidShare = 0.4F;

// Returns the longest axis; of axes that are about as long the last one, so that the voxels of a plane agree.
int longest_of(const glm::vec3& v) {
  const glm::vec3 size = glm::abs(v) * glm::vec3(1.0F, 1.001F, 1.002F);
  return size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
}

// Returns whether the next voxels along a step are of the surface and then one has its centre inside.
bool has_inside_behind(const VoxelGrid& inside, const PlaceIndex& index, glm::ivec3 at,
                       const glm::ivec3& step) {
  const StickGrid& g = inside.grid();
  for (int n = 0; n < kInsideReach; ++n) {
    at += step;
    if (inside.is_set(at.x, at.y, at.z)) return true;
    const bool is_in_grid =
        at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < g.columns_x && at.y < g.columns_y && at.z < g.height;
    if (!is_in_grid || index.find(inside.place(at.x, at.y, at.z)) == PlaceIndex::kNone) return false;
  }
  return false;
}

// Returns whether the next voxels along an axis near the direction, or along all such, have their centres inside.
bool has_solid_behind(const VoxelGrid& inside, const glm::ivec3& at, const glm::vec3& to_centre) {
  const auto is_solid = [&](const glm::ivec3& step) {
    for (int n = 1; n <= kSolidDepth; ++n) {
      const glm::ivec3 behind = at + n * step;
      if (!inside.is_set(behind.x, behind.y, behind.z)) return false;
    }
    return true;
  };
  const float least = kSolidShare * std::abs(to_centre[longest_of(to_centre)]);
  glm::ivec3 all(0);
  for (int k = 0; k < 3; ++k) {
    if (!(std::abs(to_centre[k]) >= least)) continue;
    glm::ivec3 step(0);
    step[k] = all[k] = to_centre[k] > 0 ? -1 : 1;
    if (is_solid(step)) return true;
  }
  return is_solid(all);
}

}  // namespace

std::vector<std::uint8_t> outer_voxels(const VoxelGrid& inside, const PlaceIndex& index,
                                       const std::vector<glm::vec3>& to_centres) {
  const StickGrid& g = inside.grid();
  const auto count = static_cast<std::uint32_t>(to_centres.size());
  std::vector<std::uint8_t> marks(count, 0);
  // The surface voxel behind one that no inside backs.
  std::vector<std::uint32_t> backs(count, PlaceIndex::kNone);
  for (std::uint32_t n = 0; n < count; ++n) {
    const int axis = longest_of(to_centres[n]);
    if (to_centres[n][axis] == 0.0F) continue;
    glm::ivec3 at = inside.voxel_of(index.places()[n]);
    if (inside.is_set(at.x, at.y, at.z)) continue;
    glm::ivec3 step(0);
    step[axis] = to_centres[n][axis] > 0 ? -1 : 1;
    if (has_inside_behind(inside, index, at, step) || has_solid_behind(inside, at, to_centres[n])) {
      marks[n] = 1;
      continue;
    }
    at += step;
    if (at[axis] < 0 || at[axis] >= (axis == 0 ? g.columns_x : axis == 1 ? g.columns_y : g.height)) continue;
    backs[n] = index.find(inside.place(at.x, at.y, at.z));
  }
  // Of thin sheets that lie between two layers one layer stays.
  for (std::uint32_t n = 0; n < count; ++n) {
    const std::uint32_t back = backs[n];
    if (back != PlaceIndex::kNone && backs[back] == n && marks[back] == 0) marks[n] = 1;
  }
  return marks;
}

}  // namespace objects
