// Irregular triangle meshes over a tile's posts.
//
// Typical usage:
//   Mesher mesher;
//   const BorderPosts borders = choose_borders(posts, tolerance_m, radius_m);
//   const TileMesh mesh = mesher.mesh(posts, borders, tolerance_m, radius_m);
//   const ErrorMeter meter(posts.key, mesh, vertex_heights(mesh, posts), radius_m);  // lod/mesh/error_meter.h
//   const ErrorTerms terms = meter.measure(FinePosts(posts, radius_m));
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lod/tree/error_terms.h"
#include "lod/tree/posts.h"

namespace lod {

// A vertex is a post of the mesh's grid.
struct MeshVertex {
  std::uint16_t i = 0;
  std::uint16_t j = 0;
  auto operator<=>(const MeshVertex&) const = default;
};

// The triangles of a tile over a grid of `intervals` (2^k for a finest tile, 2^(k+1) for a parent, which is
// meshed over its children's posts). They are counter-clockwise seen from outside. Vertices are sorted by (j,
// i), triangles start at their lowest vertex and ascend, so that equal meshes have equal bytes. The mesh uses
// exactly the border posts that were chosen from each edge alone (choose_border()), so neighbours of equal
// level share them.
struct TileMesh {
  int intervals = 0;
  std::vector<MeshVertex> vertices;      // at most 65536
  std::vector<std::uint16_t> triangles;  // three indices each

  std::size_t triangle_count() const { return triangles.size() / 3; }
};

// Returns the posts to keep on one edge: ascending indices with both ends. The worst post of an interval is
// kept until no post is off by more than the tolerance (radially). `height_m` and `line` are the heights and
// the chart coordinates along the edge, `across` is the fixed chart coordinate. The result depends only on the
// geometry of the edge and is the same to the bit from both sides (if the order is reversed, and `line`
// negated, the result is mirrored): of equally bad posts the one nearest to the interval's middle is kept, or
// both of a pair that is symmetric about it.
std::vector<int> choose_border(std::span<const double> height_m, std::span<const double> line, double across,
                               double tolerance_m, double radius_m);

// The posts that a mesh keeps on its four borders, by Edge; each ascending with both ends.
using BorderPosts = std::array<std::vector<int>, 4>;
BorderPosts choose_borders(const Posts& posts, double tolerance_m, double radius_m);

// Makes meshes by greedy insertion of the worst post with Delaunay flips (Garland & Heckbert 1995) on OpenMesh
// half-edges. It keeps its scratch memory from tile to tile; use it from one thread at a time.
class Mesher {
 public:
  Mesher();
  ~Mesher();
  Mesher(Mesher&&) noexcept;
  Mesher& operator=(Mesher&&) noexcept;

  // Returns a mesh with the given border posts. Adds interior posts until every post of the grid that is not on
  // a border lies within tolerance_m (radially, up to 1e-8 m of rounding) of the flat triangle over it, or
  // until the mesh has 65536 vertices. Smaller tolerances give more triangles.
  //
  // Deterministic: candidates are totally ordered by (error, j, i), co-circular quads have a unique diagonal,
  // predicates are exact. Triangles are Delaunay in the chart (from level 5 on in the grid, which is the chart
  // scaled along its axes). Supports up to 1024 intervals at levels >= 5, and 2^14 lines a face below. Heights
  // must be finite and above -radius_m. Throws std::invalid_argument for borders that are not ascending with
  // both ends.
  TileMesh mesh(const Posts& posts, const BorderPosts& borders, double tolerance_m, double radius_m);

  // Returns a finer mesh of the same posts that has all vertices of the last one. Costs little more than the
  // vertices that it adds. `borders` holds all posts to keep; other border posts of the last mesh stay too.
  TileMesh refine(const BorderPosts& borders, double tolerance_m);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

// Makes one mesh with a temporary Mesher.
TileMesh mesh_greedy(const Posts& posts, const BorderPosts& borders, double tolerance_m, double radius_m);

// Returns the mesh of the whole grid with the diagonals of the reference surface: error 0 for a finest tile.
// Throws std::invalid_argument for more than 128 intervals (65536 vertices).
TileMesh mesh_full(int intervals);

// Returns the heights of a mesh's vertices, in their order.
std::vector<double> vertex_heights(const TileMesh& mesh, const Posts& posts);

}  // namespace lod
