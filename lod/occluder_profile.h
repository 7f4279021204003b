// Walls inside a drawn tile, for occlusion: along the lines of a coarse grid in the tile, how high the drawn
// surface stands at least.
#pragma once

#include <array>
#include <span>

#include "lod/mesh/mesh.h"

namespace lod {

inline constexpr int kOccluderStrips = 4;  // between lines
inline constexpr int kOccluderPieces = 8;  // of a line

// Line n is the tile's chart line at n / kWallStrips of its width (columns: fixed u, west to east) or height
// (rows: fixed v, south to north), borders included; its piece p runs from p / kWallPieces on, with v (columns)
// or u (rows). An entry is a height above the sphere, metres: nowhere along the piece are the mesh's flat
// triangles, sag included, lower. Rounded down to float.
struct OccluderProfile {
  using Line = std::array<float, kOccluderPieces>;
  std::array<Line, kOccluderStrips + 1> columns{};
  std::array<Line, kOccluderStrips + 1> rows{};
};

// height_m: one a vertex, above the sphere; drawn `exaggeration` times as high. lower_m (>= 0) is taken off:
// how far the surface as drawn may lie below the mesh, such as by rounding of its vertices. Exact up to
// rounding, 1e-15 of the radius, which is taken off too. The mesh's intervals must be a multiple of
// kWallPieces, the heights as many as the vertices, and the drawn radii positive, else std::invalid_argument.
OccluderProfile make_occluder_profile(const TileKey& key, const TileMesh& mesh,
                                      std::span<const double> height_m, double exaggeration, double radius_m,
                                      double lower_m = 0.0);

}  // namespace lod
