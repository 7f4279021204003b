// Occlusion culling over a selection: finds the tiles that are hidden behind nearer drawn tiles.
//
// Typical usage:
//   front_to_back(keys, nadir, order);
//   pass.begin(camera_m, camera_is_above_ground, margin_rad);
//   for (std::uint32_t n : order) {
//     if (pass.hidden(region_of(n))) continue;
//     draw(n);
//     pass.add(keys[n], profile_of(n), radius_m);
//   }
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "cull/terrain_horizon.h"
#include "lod/occluder_profile.h"

namespace lod {

// Handles the tiles of one frame one at a time, in the order of front_to_back(). Tiles can be loaded in waves:
// tiles that are hidden behind loaded ones need not be loaded. A tile that is not added hides nothing.
//
// Hidden tiles are invisible, to the pixel, under these conditions:
//  - The given tiles cover everything that the camera sees. Those not hidden are all drawn, with the meshes of
//    their profiles and with the skirts of the whole selection (call skirt_depths() before this pass: a crack
//    beside a hidden tile is closed by its neighbour's skirt).
//  - The near plane cuts nothing off them.
//  - The drawn triangles are within margin_rad, as the camera sees them, of the meshes. The margin covers
//    rounded vertices and the corners of pixels.
//
// Use it from one thread at a time. It keeps its memory from frame to frame; results depend only on the frame's
// calls.
class OcclusionPass {
 public:
  // Starts a frame. camera_is_above_ground must be true only if the camera is above the drawn ground of the
  // tile under it; else nothing is hidden.
  void begin(const glm::dvec3& camera_m, bool camera_is_above_ground, double margin_rad);

  // Returns true if the tile is invisible. `region` is TileTree::region() with the error of the mesh that would
  // be drawn.
  bool hidden(const cull::BoundingRegion& region) const;

  // Adds the occluders of a drawn tile.
  void add(const TileKey& key, const OccluderProfile& occluders, double radius_m);

 private:
  cull::TerrainHorizon horizon_;
  bool above_ = false;
};

// A tile whose profile is known, or null.
struct OccludingTile {
  TileKey key;
  cull::BoundingRegion region;
  const OccluderProfile* occluders = nullptr;
};

// Runs the whole pass. The tiles must be in Morton order. Sets hidden[n] to 1 for tiles that need not be drawn,
// else 0.
void occlude(std::span<const OccludingTile> tiles, const glm::dvec3& camera_m, bool camera_is_above_ground,
             double margin_rad, double radius_m, OcclusionPass& pass, std::vector<std::uint8_t>& hidden);

}  // namespace lod
