// Irregular meshes over a tile's posts, and how far they are from S.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lod/posts.h"

namespace lod {

// A vertex is a post of the mesh's grid.
struct MeshVertex {
  std::uint16_t i = 0;
  std::uint16_t j = 0;
  auto operator<=>(const MeshVertex&) const = default;
};

// Triangles of a tile over a grid of `intervals` (2^k for a finest tile, 2^(k+1) for a parent, which is
// meshed over its children's posts). Counter-clockwise seen from outside. Vertices are sorted by (j, i), so
// that equal meshes are equal bytes. Every post of the four borders that the mesh uses is a vertex of it and
// was chosen from the edge alone (choose_border), so equal-level neighbours share them.
struct TileMesh {
  int intervals = 0;
  std::vector<MeshVertex> vertices;
  std::vector<std::uint16_t> triangles;  // three indices each; a tile never has more than 65536 vertices

  std::size_t triangle_count() const { return triangles.size() / 3; }
};

// Largest radial distances between a mesh's flat triangles and S, metres. At every direction
// (mesh - S) = relief part + sag part, where sag is what is left with all heights 0 (the chords under the
// sphere). With vertical exaggeration x the distance is at most error_bound().
struct ErrorTerms {
  double relief_m = 0;
  double sag_m = 0;
  double total_m = 0;  // of the sum, at exaggeration 1; <= relief + sag

  void include(const ErrorTerms& other);
};

// Bound at exaggeration x for a tile whose heights span `height_range_m`: total at x = 1, else
// |x| relief + sag + the second-order term x^2 range^2 / (4 (R + min)).
double error_bound(const ErrorTerms& terms, double exaggeration, double height_range_m, double radius_m);

// Border posts of one edge: indices of the posts kept, ascending, ends included. `height_m` runs along the
// edge, `line` are the chart coordinates along it and `across` the fixed one. A function of the edge's
// geometry alone, the same from both sides (also when the order is reversed: the result is mirrored).
std::vector<int> choose_border(std::span<const double> height_m, std::span<const double> line, double across,
                               double tolerance_m, double radius_m);

// The posts that a mesh keeps on its four borders, by Edge; each ascending with both ends.
using BorderPosts = std::array<std::vector<int>, 4>;

// Greedy insertion of the worst post with Delaunay flips (Garland & Heckbert 1995) on OpenMesh half-edges.
// Starts from the border posts given and adds interior posts until every post of the grid that is not on
// a border lies within tolerance_m (radially) of the flat triangle over it. Deterministic: candidates are totally
// ordered by (error, j, i), co-circular quads have a unique diagonal, predicates are exact.
TileMesh mesh_greedy(const Posts& posts, const BorderPosts& borders, double tolerance_m, double radius_m);

// The whole grid with S's diagonals: error 0 for a finest tile.
TileMesh mesh_full(int intervals);

// Distance of a mesh of tile `key` to S over one finest tile below it (or itself): all overlay vertices of
// both triangulations are visited, so the measure is the maximum up to a relative 4 * (cell angle) that is
// added. `fine` are the posts of the finest tile with its borders constrained.
ErrorTerms measure_error(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
                         const Posts& fine, double radius_m);

}  // namespace lod
