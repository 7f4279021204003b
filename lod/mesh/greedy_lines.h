// Integer coordinates of a tile's grid lines, for exact predicates and exact row spans. Internal to lod.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "lod/tree/tile_key.h"

namespace lod {

// An edge of a triangle from (x0, y0) to (x1, y1), y0 < y1, to be walked row by row.
struct RowEdge {
  std::int64_t x0, y0, x1, y1;
};

// A vertex of a triangulation: its post with grid and integer coordinates. Small, since meshes do not fit the nearest caches.
struct Corner {
  std::uint32_t post;
  std::uint16_t i, j;
  std::int32_t x, y;
};

// Returns twice the area of a triangle, above 0 if it is counter-clockwise.
inline std::int64_t turn_of(const Corner& a, const Corner& b, const Corner& c) {
  const auto product = [](std::int32_t p, std::int32_t q) { return std::int64_t{p} * q; };
  return product(b.x - a.x, c.y - a.y) - product(b.y - a.y, c.x - a.x);
}

// The lines of a tile of level 5 or finer. They are even along both axes, so that the chart is the grid up to a
// scale: the coordinate of a line is its index.
class EvenLines {
 public:
  explicit EvenLines(int intervals);
  const std::vector<std::int64_t>& x() const { return index_; }
  const std::vector<std::int64_t>& y() const { return index_; }

  // Returns the first line at or beyond an edge, row by row.
  class Walk {
   public:
    Walk(const EvenLines&, const RowEdge& e)
        : slope_(static_cast<double>(e.x1 - e.x0) / static_cast<double>(e.y1 - e.y0)),
          // Crossings are multiples of 1 / (y1 - y0) >= 1 / 1024: far coarser than this and its rounding.
          base_(static_cast<double>(e.x0) + (1.0 - 1e-6) - slope_ * static_cast<double>(e.y0)) {}
    int first(std::int64_t y) { return static_cast<int>(base_ + slope_ * static_cast<double>(y)); }

   private:
    double slope_;
    double base_;
  };

  // Returns true if a counter-clockwise triangle contains no post except its corners (Pick's theorem).
  static bool has_no_post(const Corner& a, const Corner& b, const Corner& c) { return turn_of(a, b, c) == 1; }

  // Returns the sign of the in-circle determinant of a counter-clockwise triangle a b c and d: > 0 inside.
  // Arguments are relative to d.
  static int in_circle(std::int64_t adx, std::int64_t ady, std::int64_t bdx, std::int64_t bdy, std::int64_t cdx,
                       std::int64_t cdy) {
    const std::int64_t det = (adx * adx + ady * ady) * (bdx * cdy - bdy * cdx) +
                             (bdx * bdx + bdy * bdy) * (cdx * ady - cdy * adx) +
                             (cdx * cdx + cdy * cdy) * (adx * bdy - ady * bdx);
    return (det > 0) - (det < 0);
  }

 private:
  std::vector<std::int64_t> index_;
};

// The lines of a tile of level 0 to 4, which spans several knots of the warp. Lines are multiples of a power of
// two (mars::face_line). In units of it, from the tile's first line, they stay below 2^27 for grids of up to
// 2^14 lines a face, so that orientation fits 64 bits and in-circle needs 128.
class WarpedLines {
 public:
  WarpedLines(const TileKey& key, int intervals);
  const std::vector<std::int64_t>& x() const { return x_; }
  const std::vector<std::int64_t>& y() const { return y_; }

  class Walk {
   public:
    Walk(const WarpedLines& lines, const RowEdge& e) : lines_(lines), e_(e) {
      slope_ = static_cast<double>(e.x1 - e.x0) / static_cast<double>(e.y1 - e.y0);
    }
    int first(std::int64_t y) {
      const std::int64_t dy = e_.y1 - e_.y0;
      const std::int64_t reach = (e_.x1 - e_.x0) * (y - e_.y0);
      const double x = static_cast<double>(e_.x0) + slope_ * static_cast<double>(y - e_.y0);
      const auto at = static_cast<std::size_t>(std::max(0.0, (x - 1.0) * lines_.buckets_per_unit_));
      int i = lines_.first_in_bucket_[std::min(at, lines_.first_in_bucket_.size() - 1)];
      const auto before = [&] { return (lines_.x_[static_cast<std::size_t>(i)] - e_.x0) * dy < reach; };
      i += before() ? 1 : 0;  // nearly always the only step; avoids a branch
      while (before()) ++i;
      return i;
    }

   private:
    const WarpedLines& lines_;
    RowEdge e_;
    double slope_;
  };

  // Recognizes half cells only; returns false for thin triangles without posts.
  static bool has_no_post(const Corner& a, const Corner& b, const Corner& c) {
    return std::max({a.i, b.i, c.i}) - std::min({a.i, b.i, c.i}) == 1 &&
           std::max({a.j, b.j, c.j}) - std::min({a.j, b.j, c.j}) == 1;
  }

  static int in_circle(std::int64_t adx, std::int64_t ady, std::int64_t bdx, std::int64_t bdy, std::int64_t cdx,
                       std::int64_t cdy) {
    __extension__ using Wide = __int128;
    const auto wide = [](std::int64_t value) { return static_cast<Wide>(value); };
    const Wide det = wide(adx * adx + ady * ady) * wide(bdx * cdy - bdy * cdx) +
                     wide(bdx * bdx + bdy * bdy) * wide(cdx * ady - cdy * adx) +
                     wide(cdx * cdx + cdy * cdy) * wide(adx * bdy - ady * bdx);
    return (det > 0) - (det < 0);
  }

 private:
  std::vector<std::int64_t> x_;
  std::vector<std::int64_t> y_;
  std::vector<int> first_in_bucket_;  // buckets are at most as wide as the narrowest interval
  double buckets_per_unit_ = 0;
};

}  // namespace lod
