// The order in which the camera meets tiles.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "lod/tree/tile_key.h"

namespace lod {

// Indices of disjoint tiles such that along every half great circle that starts at the unit direction `nadir`
// (the point under the camera) nearer tiles come first. An order by distance would not do: a wide tile may reach
// behind one that is farther away.
//
// Faces: out . d - out' . d = A cos t + B sin t along the half circle, with A >= 0 for the face with the larger
// out . nadir: once left it is never entered again. Below a tile likewise each of the two planes that split it
// is crossed once at most, away from the nadir's side: the child on the nadir's side of both comes first, then
// the two beside it, then the one across both.
//
// Tiles must ascend along the Z curve, as select() leaves them.
void front_to_back(std::span<const TileKey> tiles, const glm::dvec3& nadir, std::vector<std::uint32_t>& order);

}  // namespace lod
