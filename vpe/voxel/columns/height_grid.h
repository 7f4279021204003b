// Posts of a tile in the form that the column kernel reads.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): the data under the column walk. HeightGridStore
// (height_grid_store.h) makes them from the planet file; walk_grid() (columns.h) and refine_row() (refine.h)
// read them.
//
// A height grid is a part of a tile whose grid lines are even: a whole tile from level 5 on, a part of it
// before (mars/geodesy/cube.h). Post (x, y), 0 <= x, y <= intervals, lies at chart (u0 + du x, v0 + dv y). The
// edges of the facets lie on three families of straight lines, x = k, y = k and x - y = k. In whatever
// direction a straight path crosses the grid, it crosses one family most often, and between two neighbouring
// lines of that family exactly one edge of the two others (docs/design/rays.md). So posts are kept line by line
// of one family, each family on its own.
//
// A post is kept as H = (w_ref - w) R^2 metres, with w the inverse face depth (lod/tree/posts.h) and w_ref an
// affine function of (x, y). Flat facets stay flat, and H is small (height error and sagitta of the grid), so
// float holds it within 2^-24 of its largest |H|.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "paging/planet/planet_file.h"

namespace vpe::voxel {

// Selects a family of lines: x = k, y = k, x - y = k.
enum class LineFamily : std::uint8_t { kColumns, kRows, kDiagonals };
inline constexpr int kFamilies = 3;

// Lines in a block of the maximum pyramid. Smaller: finer blocks are skipped, more tests; larger: the reverse.
inline constexpr int kBlockLines = 16;

// Places a grid in the chart of its face.
struct HeightGridFrame {
  int intervals = 0;
  double u0 = 0;
  double du = 0;
  double v0 = 0;
  double dv = 0;
};

// Holds the reference of a grid's posts: w_ref = w0 + wx x + wy y, 1/m.
struct DepthPlane {
  double w0 = 0;
  double wx = 0;
  double wy = 0;
};

// Points to the posts of one grid in one family. Line k holds the posts of position p (y, x and x for the three
// families); diagonals k >= 0 share a row of memory with k - side. The memory belongs to a TileHeightGrids.
template <typename T>
struct HeightGridLines {
  DepthPlane reference;
  const T* posts = nullptr;  // of line 0; one before and kReadAhead after all lines are readable
  const T* block_max = nullptr;
  int side = 0;
  int first_block = 0;  // floor(first line / kBlockLines)
  int blocks = 0;       // blocks along a line

  const T* line(int k) const {
    return posts + static_cast<std::ptrdiff_t>(k < 0 ? k + side : k) * static_cast<std::ptrdiff_t>(side);
  }
  // Returns the maxima of lines [16 b, 16 b + 16] and positions [16 c, 16 c + 16], indexed by c.
  const T* maxima(int b) const {
    return block_max + static_cast<std::ptrdiff_t>(b - first_block) * static_cast<std::ptrdiff_t>(blocks);
  }
};
inline constexpr int kReadAhead = 64;

// Returns H of post (x, y) of a grid whose lines are of `family`.
template <typename T>
T post_height(const HeightGridLines<T>& lines, LineFamily family, int x, int y) {
  if (family == LineFamily::kColumns) return lines.line(x)[y];
  if (family == LineFamily::kRows) return lines.line(y)[x];
  return lines.line(x - y)[x];
}

// Describes a tile whose posts are taken from a coarser tile that contains it.
struct FallbackTile {
  lod::TileKey key;
  lod::TileKey coarser;  // an ancestor of `key`
  int intervals = 0;     // of the tile
  // Heights of the tile that is replaced, without exaggeration. Posts outside are moved to the nearer limit.
  double min_height_m = 0;
  double max_height_m = 0;
  // Counts those of the coarser tile: as many, or twice as many, so that the posts of a parent are taken as they are. 0: as many.
  int coarser_intervals = 0;
};

// Holds the height grids of one tile in one family. Immutable; any thread may read it.
template <typename T>
class TileHeightGrids {
 public:
  TileHeightGrids(const paging::TileHeights& heights, double radius_m, double exaggeration, LineFamily family);
  // Copies the posts of another family.
  TileHeightGrids(const TileHeightGrids& other, LineFamily family);
  // Samples the facets of the coarser tile at the posts of the finer one. Where the coarser tile's lines are even
  // and no post is moved, both have the same facets but for rounding. Posts are moved to the limits, so that
  // whatever holds of the replaced tile's heights holds of these.
  TileHeightGrids(const TileHeightGrids<float>& coarser, const FallbackTile& tile, double radius_m,
                  double exaggeration, LineFamily family);
  TileHeightGrids(const TileHeightGrids&) = delete;
  TileHeightGrids& operator=(const TileHeightGrids&) = delete;

  // Returns the number of grids along a side of the tile.
  int per_side() const { return per_side_; }
  // Returns grid (i, j), 0 <= i, j < per_side().
  const HeightGridLines<T>& lines(int i, int j) const {
    return lines_[static_cast<std::size_t>(j * per_side_ + i)];
  }
  LineFamily family() const { return family_; }
  std::size_t bytes() const;

 private:
  // Sets all grids from inverse face depths at the posts of a tile, row by row.
  void set(const std::vector<double>& inverse_depth, int intervals, double radius_m);

  LineFamily family_;
  int per_side_ = 1;
  std::vector<HeightGridLines<T>> lines_;  // grid (i, j) at j * per_side + i
  std::vector<T> storage_;
};

extern template class TileHeightGrids<float>;
extern template class TileHeightGrids<double>;

// Returns the number of grids along a side of a tile.
int grids_per_side(int level, int intervals);

}  // namespace vpe::voxel
