// Irregular meshes over a tile's posts, and how far they are from S.
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

// Triangles of a tile over a grid of `intervals` (2^k for a finest tile, 2^(k+1) for a parent, which is
// meshed over its children's posts). Counter-clockwise seen from outside. Vertices are sorted by (j, i),
// triangles start at their lowest vertex and ascend, so that equal meshes are equal bytes. Every post of the
// four borders that the mesh uses is a vertex of it and was chosen from the edge alone (choose_border), so
// equal-level neighbours share them.
struct TileMesh {
  int intervals = 0;
  std::vector<MeshVertex> vertices;      // at most 65536
  std::vector<std::uint16_t> triangles;  // three indices each

  std::size_t triangle_count() const { return triangles.size() / 3; }
};

// Border posts of one edge: indices of the posts kept, ascending, ends included: the worst post of an interval
// is kept until none is off by more than the tolerance (radially). `height_m` runs along the edge, `line`
// are the chart coordinates along it and `across` the fixed one. A function of the edge's geometry alone, the
// same to the bit from both sides (when the order is reversed, and `line` negated, the result is mirrored):
// of equally bad posts the one nearest to the interval's middle is kept, both of a pair that lies evenly
// about it.
std::vector<int> choose_border(std::span<const double> height_m, std::span<const double> line, double across,
                               double tolerance_m, double radius_m);

// The posts that a mesh keeps on its four borders, by Edge; each ascending with both ends.
using BorderPosts = std::array<std::vector<int>, 4>;
BorderPosts choose_borders(const Posts& posts, double tolerance_m, double radius_m);

// Greedy insertion of the worst post with Delaunay flips (Garland & Heckbert 1995) on OpenMesh half-edges.
// Starts from the border posts given and adds interior posts until every post of the grid that is not on
// a border lies within tolerance_m (radially, up to 1e-8 m of rounding) of the flat triangle over it, or
// until the mesh has 65536 vertices. Deterministic: candidates are totally ordered by (error, j, i),
// co-circular quads have a unique diagonal, predicates are exact; triangles are Delaunay in the chart (from
// level 5 on in the grid, which is the chart scaled along its axes). Up to 1024 intervals at levels >= 5,
// 2^14 lines a face below. Heights must be finite and above -radius_m. Throws std::invalid_argument for
// borders that are not ascending with both ends.
// Thread rule: one Mesher a thread; it keeps its scratch memory from tile to tile.
class Mesher {
 public:
  Mesher();
  ~Mesher();
  Mesher(Mesher&&) noexcept;
  Mesher& operator=(Mesher&&) noexcept;

  TileMesh mesh(const Posts& posts, const BorderPosts& borders, double tolerance_m, double radius_m);

  // A finer mesh of the same posts that has all vertices of the last one, for little more than the vertices it
  // adds. Borders are those to keep in all: posts that the last mesh had besides stay too.
  TileMesh refine(const BorderPosts& borders, double tolerance_m);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

// One mesh with a Mesher of its own.
TileMesh mesh_greedy(const Posts& posts, const BorderPosts& borders, double tolerance_m, double radius_m);

// The whole grid with S's diagonals: error 0 for a finest tile. At most 128 intervals (65536 vertices);
// std::invalid_argument beyond.
TileMesh mesh_full(int intervals);

// Heights of a mesh's vertices, in their order.
std::vector<double> vertex_heights(const TileMesh& mesh, const Posts& posts);

struct FineGrid;

// S over one finest tile, prepared once to be measured against the meshes of all its ancestors. The borders
// of `posts` are constrained. Immutable: any number of threads may share it.
class FinePosts {
 public:
  FinePosts(const Posts& posts, double radius_m);
  ~FinePosts();
  FinePosts(FinePosts&&) noexcept;
  FinePosts& operator=(FinePosts&&) noexcept;

 private:
  friend class ErrorMeter;
  friend class GridMeter;
  struct Prepared;
  const FineGrid& grid() const;
  std::unique_ptr<const Prepared> prepared_;
};

// Distance of one mesh to S, measured over the finest tiles below it one at a time.
//
// Over a piece of the overlay of both triangulations (mesh triangle and S facet) both inverse depths are
// affine, so their difference is largest at a vertex of the piece: all are visited (posts; mesh edges where
// they cross grid lines and diagonals; mesh vertices are posts). The radial distance differs from that by a
// factor which varies over one cell by at most kappa, where kappa - 1 is about (cell angle) (1 + slopes); the
// terms are raised by it, which makes them upper bounds: total = kappa max|total|, sag likewise,
// relief = max|relief| + (kappa - 1) (max|total| + max|sag|), all at the vertices. Rounding adds 3e-15 times
// the largest radius.
// Thread rule: immutable after construction, any number of threads may measure.
class ErrorMeter {
 public:
  // Throws std::invalid_argument when the number of heights is not that of vertices.
  ErrorMeter(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
             double radius_m);
  ~ErrorMeter();
  ErrorMeter(ErrorMeter&&) noexcept;
  ErrorMeter& operator=(ErrorMeter&&) noexcept;

  // `fine` is the mesh's own tile or one below it, its grid at least as fine as the mesh's and of the same
  // planet radius; else std::invalid_argument.
  ErrorTerms measure(const FinePosts& fine) const;
  ErrorTerms measure(const Posts& fine) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

// ErrorMeter for one finest tile.
ErrorTerms measure_error(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
                         const Posts& fine, double radius_m);

}  // namespace lod
