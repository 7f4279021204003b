// One ray in the chart of a face, and where it first meets the patches of a tile.
//
// Stage of the pipeline (vpe/voxel/smooth/smooth_caster.h): under SmoothGround and SmoothCaster. A ray is a straight line in the
// central chart of a face, so it crosses each line of the grid once at most.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

#include "mars/geodesy/cube.h"
#include "vpe/voxel/smooth/smooth_tile.h"

namespace vpe::voxel {

// Holds the points e + s d in the axes of a face: right, up, out. `d` is a unit vector.
struct FaceRay {
  glm::dvec3 e{0, 0, 0};
  glm::dvec3 d{0, 0, 0};
  double ee = 0;  // e . e
  double ed = 0;  // e . d

  FaceRay() = default;
  FaceRay(mars::Face face, const glm::dvec3& origin_m, const glm::dvec3& direction);
};

struct RaySegment {
  double s0 = 0;
  double s1 = 0;
};

// Cuts a segment to where the ray is over the rectangle of chart. Returns false if nothing is left.
bool cut_to_rect(const FaceRay& ray, double u0, double u1, double v0, double v1, RaySegment& segment);

// Says where a ray has met a tile.
struct TileMeeting {
  double s = 0;
  int i = 0;  // the cell
  int j = 0;
};

// Keeps the patches that one thread used last, so that neighbouring rays need not make them again. Not synchronised.
class PatchCache {
 public:
  // Returns the patch of a cell; valid until the next call. Expects the same tile and exaggeration until clear().
  const SmoothPatch& get(const SmoothTile& tile, int i, int j, double exaggeration) {
    Slot& slot = slots_[static_cast<std::size_t>((i + 3 * j) & 15)];
    if (slot.tile != &tile || slot.i != i || slot.j != j) slot = {&tile, i, j, tile.patch(i, j, exaggeration)};
    return slot.patch;
  }
  void clear() {
    for (Slot& slot : slots_) slot.tile = nullptr;
  }

 private:
  struct Slot {
    const SmoothTile* tile = nullptr;
    int i = 0;
    int j = 0;
    SmoothPatch patch;
  };
  std::array<Slot, 16> slots_;
};

// Names a block of 2^b x 2^b cells of a tile; the largest, (levels(), 0, 0), is the tile.
struct TileBlock {
  int b = 0;
  int i = 0;
  int j = 0;
};

// Finds the first point of the patches of a tile's block on a segment of a ray over the block. Returns false if there is
// none. Sets `is_near` if the ray comes below the block's highest point.
bool meet_block(const SmoothTile& tile, const TileBlock& block, double radius_m, double exaggeration,
                const FaceRay& ray, const RaySegment& segment, PatchCache& patches, TileMeeting& found,
                bool& is_near);

// Returns the height and the normal of a tile's patch, which belongs to cell (i, j), at a point over the cell.
struct PatchPoint {
  double height_m = 0;         // above the sphere, exaggerated
  glm::dvec3 normal{0, 0, 1};  // unit, outward, in the body's axes
};
PatchPoint patch_point(const SmoothTile& tile, const SmoothPatch& patch, double exaggeration,
                       const glm::dvec3& point_m, int i, int j);

}  // namespace vpe::voxel
