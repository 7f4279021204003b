// Which of the tiles to draw are hidden behind nearer ones that are drawn.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "cull/terrain_horizon.h"
#include "lod/occluder_profile.h"

namespace lod {

// One frame's pass, a tile at a time in the order of front_to_back(): ask hidden(), and if it is not, draw the
// tile and add() its walls, if they are known. So tiles can be loaded in waves: what is hidden behind those
// that are there need not be. A tile that is not added hides nothing.
//
// What must be so for hidden tiles to be invisible, to the pixel:
// - the tiles given cover all that the camera sees; those not hidden are all drawn, with the meshes that the walls
// were
//   made of and with the skirts that the whole selection needs (skirt_depths before this pass: a crack beside a
//   hidden tile is closed by its neighbour's skirt);
// - nothing of them is cut off by the near plane;
// - what is drawn is within margin_rad, as the camera sees it, of the meshes: rounded vertices, and pixels'
// corners. Thread rule: one at a time. Keeps its memory from frame to frame; results depend on nothing but the
// frame's calls.
class OcclusionPass {
 public:
  // camera_is_above_ground: above what is drawn of the tile under it. Else nothing is hidden.
  void begin(const glm::dvec3& camera_m, bool camera_is_above_ground, double margin_rad);

  // shell: TileTree::shell() with the error of the mesh that would be drawn.
  bool hidden(const cull::BoundingRegion& region) const;

  void add(const TileKey& key, const OccluderProfile& occluders, double radius_m);

 private:
  cull::TerrainHorizon horizon_;
  bool above_ = false;
};

// The whole of it for tiles whose walls are all at hand.
struct OccludingTile {
  TileKey key;
  cull::BoundingRegion region;
  const OccluderProfile* occluders = nullptr;  // null: not known
};
// tiles ascend along the Z curve; hidden[n] = 1 for those that need not be drawn.
void occlude(std::span<const OccludingTile> tiles, const glm::dvec3& camera_m, bool camera_is_above_ground,
             double margin_rad, double radius_m, OcclusionPass& pass, std::vector<std::uint8_t>& hidden);

}  // namespace lod
