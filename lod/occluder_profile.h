// Occluders inside a drawn tile: lower bounds of the height of the drawn surface along the lines of a coarse
// grid.
#pragma once

#include <array>
#include <span>

#include "lod/mesh/mesh.h"

namespace lod {

inline constexpr int kOccluderStrips = 4;  // between lines
inline constexpr int kOccluderPieces = 8;  // of a line

// Line n is the tile's chart line at n / kOccluderStrips of its width (columns: fixed u, west to east) or
// height (rows: fixed v, south to north), borders included. Piece p starts at p / kOccluderPieces and runs with
// v (columns) or u (rows). An entry is a height above the sphere in metres: the mesh's flat triangles, with
// their sagitta, are nowhere lower along the piece. Rounded down to float.
struct OccluderProfile {
  using Line = std::array<float, kOccluderPieces>;
  std::array<Line, kOccluderStrips + 1> columns{};
  std::array<Line, kOccluderStrips + 1> rows{};
};

// Computes the profile of a mesh. height_m holds one height above the sphere for each vertex; they are drawn
// times `exaggeration`. lower_m (>= 0) is subtracted: how far the drawn surface may lie below the mesh, for
// example by rounding of its vertices. Exact up to rounding, 1e-15 of the radius, which is subtracted too. The
// mesh's intervals must be a multiple of kOccluderPieces, the heights as many as the vertices, and the drawn
// radii positive, else throws std::invalid_argument.
OccluderProfile make_occluder_profile(const TileKey& key, const TileMesh& mesh,
                                      std::span<const double> height_m, double exaggeration, double radius_m,
                                      double lower_m = 0.0);

}  // namespace lod
