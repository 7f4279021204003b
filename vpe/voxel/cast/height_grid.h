// Posts of a tile as the column kernel reads them.
//
// Where a tile's grid lines are even (a whole tile from level 5 on, a part of it before: mars/geodesy/cube.h) they are
// a lattice: post (x, y), 0 <= x, y <= intervals, at chart (u0 + du x, v0 + dv y). Its facets' edges lie on
// three families of straight lines, x = k, y = k and x - y = k. Whatever way a straight path crosses the
// lattice, it crosses one family most often, and between two neighbouring lines of that one exactly one edge of
// the two others (docs/rays.md). So posts are kept line by line of one family, each family on its own.
//
// A post is kept as H = (w_ref - w) R^2 metres, w the inverse face depth (lod/tree/posts.h) and w_ref an affine
// function of (x, y): flat facets stay flat, and H is small (relief and sagitta of the lattice), so that float
// holds it within 2^-24 of its largest |H|.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "paging/planet/planet_file.h"

namespace vpe::voxel {

enum class LineFamily : std::uint8_t { kColumns, kRows, kDiagonals };  // x = k, y = k, x - y = k
inline constexpr int kFamilies = 3;

// Lines in a block of the maximum pyramid.
inline constexpr int kBlockLines = 16;

struct HeightGridFrame {
  int intervals = 0;
  double u0 = 0;
  double du = 0;
  double v0 = 0;
  double dv = 0;
};

// w_ref = w0 + wx x + wy y, 1/m.
struct DepthPlane {
  double w0 = 0;
  double wx = 0;
  double wy = 0;
};

// Posts of one family. Line k holds the posts of position p (y, x and x for the three families); diagonals
// k >= 0 share a row with k - side.
template <typename T>
struct HeightGridLines {
  DepthPlane reference;
  const T* posts = nullptr;  // of line 0; one before and kReadAhead after all lines may be read
  const T* block_max = nullptr;
  int side = 0;
  int first_block = 0;  // floor(first line / kBlockLines)
  int blocks = 0;       // a line

  const T* line(int k) const {
    return posts + static_cast<std::ptrdiff_t>(k < 0 ? k + side : k) * static_cast<std::ptrdiff_t>(side);
  }
  // Maxima of lines [16 b, 16 b + 16], positions [16 c, 16 c + 16], by c.
  const T* maxima(int b) const {
    return block_max + static_cast<std::ptrdiff_t>(b - first_block) * static_cast<std::ptrdiff_t>(blocks);
  }
};
inline constexpr int kReadAhead = 64;

// The lattices of one tile, in one family; lattice (i, j) of per_side^2 at j * per_side + i.
template <typename T>
class TileHeightGrids {
 public:
  TileHeightGrids(const paging::TileHeights& heights, double radius_m, double exaggeration, LineFamily family);
  TileHeightGrids(const TileHeightGrids&) = delete;
  TileHeightGrids& operator=(const TileHeightGrids&) = delete;

  int per_side() const { return per_side_; }
  const HeightGridLines<T>& lines(int i, int j) const {
    return lines_[static_cast<std::size_t>(j * per_side_ + i)];
  }
  std::size_t bytes() const;

 private:
  int per_side_ = 1;
  std::vector<HeightGridLines<T>> lines_;
  std::vector<T> storage_;
};

extern template class TileHeightGrids<float>;
extern template class TileHeightGrids<double>;

// Lattices along a side of a tile.
int grids_per_side(int level, int intervals);

}  // namespace vpe::voxel
