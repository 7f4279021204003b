// Orders tiles from near to far along every direction from the camera, for occlusion culling.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "lod/tree/tile_key.h"

namespace lod {

// Writes the indices of disjoint tiles in an order such that nearer tiles come first along every half great
// circle that starts at the unit direction `nadir` (the point under the camera). An order by distance does not
// have this property: a wide tile may reach behind one that is farther away. The tiles must be in Morton order,
// as select() leaves them.
//
// Faces: along the half circle out . d - out' . d = A cos t + B sin t, with A >= 0 for the face with the larger
// out . nadir: once left, that face is never entered again. Likewise each of the two planes that split a tile
// is crossed at most once, away from the nadir's side: the child on the nadir's side of both comes first, then
// the two beside it, then the one across both.
void front_to_back(std::span<const TileKey> tiles, const glm::dvec3& nadir, std::vector<std::uint32_t>& order);

}  // namespace lod
