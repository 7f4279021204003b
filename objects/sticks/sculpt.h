// Carves voxels out of photographs of an object from several sides (Cohen-Or 1996, section 5).
//
// Typical usage:
//   const std::vector<SculptView> views{{side, mask_by_background(side, grey, 20), SculptSide::kRight}, ...};
//   const StickModel tank = build_sticks(sculpt(views, {.size_m = {3.4, 6.9, 2.4}}));
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string_view>

#include "objects/sticks/photo_mask.h"
#include "objects/sticks/voxel_grid.h"

namespace objects {

// From where a photograph was taken. The model frame has x to the object's right and y to its front.
enum class SculptSide : std::uint8_t {
  kRight,   // looking left: the front of the object is at the right of the photograph
  kLeft,    // looking right: its front is at the left
  kFront,   // looking backwards: its right is at the left
  kBack,    // looking forward: its right is at the right
  kTop,     // looking down: its front is at the top, its right at the right
  kBottom,  // looking up: its front is at the top, its right at the left
};

// Returns "right", "front" and so on. Pure.
std::string_view name_of(SculptSide side);

// A photograph from far away, without perspective. What the mask shows reaches from edge to edge of the object, so
// the box around it is as large as the object.
struct SculptView {
  vpe::core::RgbImage image;
  PhotoMask mask;  // of the same size
  SculptSide side = SculptSide::kRight;
};

struct SculptOptions {
  glm::dvec3 size_m{1, 1, 1};  // width (x), length (y), height (z)
  int voxels_longest = 256;    // along the longest side, 1 to 1024
};

// The most by which width to height of a silhouette may differ from that of the object.
inline constexpr double kMostAspectError = 0.1;

// Returns the voxels that lie in all silhouettes: those of which at least half is on the mask in each photograph. The
// object stands on z = 0, the middle of its box above the origin.
//
// A voxel at the surface has the mean colour of its pixels, in the photograph that faces it best among those that see
// it. Voxels that no photograph sees get the mean of coloured neighbours, nearest first. Throws std::runtime_error,
// which names the photograph, for fewer than three of them, two from one side, all from one axis, sizes that do not
// fit, masks that are empty or whole, silhouettes whose proportions differ by more than kMostAspectError; and where
// no voxel is left. Takes time in proportion to the voxels of the grid / 64, those at the surface and the pixels.
VoxelGrid sculpt(std::span<const SculptView> views, const SculptOptions& options);

}  // namespace objects
