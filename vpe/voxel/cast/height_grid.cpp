#include "vpe/voxel/cast/height_grid.h"

#include <algorithm>
#include <limits>

#include "mars/geodesy/cube.h"

namespace vpe::voxel {

namespace {

constexpr int kKnotLevel = 5;  // lines are even between 2^5 + 1 knots of a face

int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

struct Shape {
  int side;
  int first_line;
  int last_line;
  int first_block;
  int block_rows;
  int blocks;
  std::size_t posts() const {
    return static_cast<std::size_t>(side) * static_cast<std::size_t>(side) + 1 + kReadAhead;
  }
  std::size_t total() const {
    return posts() + static_cast<std::size_t>(block_rows) * static_cast<std::size_t>(blocks);
  }
};

Shape shape_of(int intervals, LineFamily family) {
  Shape s{};
  s.side = intervals + 1;
  s.first_line = family == LineFamily::kDiagonals ? -intervals : 0;
  s.last_line = intervals;
  s.first_block = floor_div(s.first_line, kBlockLines);
  s.block_rows = floor_div(s.last_line, kBlockLines) - s.first_block + 1;
  s.blocks = intervals / kBlockLines + 1;
  return s;
}

// Range of positions at which a line has posts.
struct Span {
  int begin;
  int end;  // past the last
};
Span span_of(int k, int intervals, LineFamily family) {
  if (family != LineFamily::kDiagonals) return {0, intervals + 1};
  return {std::max(0, k), intervals + std::min(0, k) + 1};
}

// Indices of a post in its grid.
struct GridPost {
  int x;
  int y;
};
GridPost post_of(int k, int p, LineFamily family) {
  if (family == LineFamily::kColumns) return {k, p};
  if (family == LineFamily::kRows) return {p, k};
  return {p, p - k};
}

template <typename T>
void fill_maxima(const HeightGridLines<T>& lines, const Shape& shape, int intervals, LineFamily family,
                 T* out) {
  std::fill_n(out, shape.block_rows * shape.blocks, std::numeric_limits<T>::lowest());
  for (int k = shape.first_line; k <= shape.last_line; ++k) {
    const Span span = span_of(k, intervals, family);
    const T* line = lines.line(k);
    for (int b = floor_div(k - 1, kBlockLines); b <= floor_div(k, kBlockLines); ++b) {
      if (b < shape.first_block) continue;
      T* row = out + (b - shape.first_block) * shape.blocks;
      for (int p = span.begin; p < span.end; ++p) {
        T& own = row[p / kBlockLines];
        own = std::max(own, line[p]);
        if (p % kBlockLines == 0 && p > 0)
          row[p / kBlockLines - 1] = std::max(row[p / kBlockLines - 1], line[p]);
      }
    }
  }
}

// Returns the plane that fits the four corner posts of a grid best (least squares).
DepthPlane plane_of(std::size_t x0, std::size_t y0, int n, const std::vector<double>& w, std::size_t side) {
  const auto m = static_cast<std::size_t>(n);
  const double a = w[y0 * side + x0];
  const double b = w[y0 * side + x0 + m];
  const double c = w[(y0 + m) * side + x0];
  const double d = w[(y0 + m) * side + x0 + m];
  return {(3.0 * a + b + c - d) / 4.0, (b - a + d - c) / (2.0 * n), (c - a + d - b) / (2.0 * n)};
}

}  // namespace

int grids_per_side(int level, int intervals) {
  return level >= kKnotLevel ? 1 : std::min(intervals, 1 << (kKnotLevel - level));
}

template <typename T>
TileHeightGrids<T>::TileHeightGrids(const paging::TileHeights& heights, double radius_m, double exaggeration,
                                    LineFamily family) {
  const lod::Posts& posts = heights.posts;
  per_side_ = grids_per_side(posts.key.level, posts.intervals);
  const lod::GridLines grid = lod::grid_lines(posts.key, posts.intervals);
  const auto side = static_cast<std::size_t>(posts.side());
  std::vector<double> w(side * side);
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x)
      w[y * side + x] =
          lod::inverse_depth(grid.u[x], grid.v[y], exaggeration * posts.height_m[y * side + x], radius_m);
  }
  const int n = posts.intervals / per_side_;
  const Shape shape = shape_of(n, family);
  const std::size_t count = static_cast<std::size_t>(per_side_) * static_cast<std::size_t>(per_side_);
  storage_.assign(count * shape.total(), T(0));
  for (int j = 0; j < per_side_; ++j) {
    for (int i = 0; i < per_side_; ++i) {
      T* const store = storage_.data() + lines_.size() * shape.total();
      const auto x0 = static_cast<std::size_t>(i * n);
      const auto y0 = static_cast<std::size_t>(j * n);
      const DepthPlane plane = plane_of(x0, y0, n, w, side);
      T* const first = store + 1;
      T* const maxima = store + shape.posts();
      HeightGridLines<T> lines{plane, first, maxima, shape.side, shape.first_block, shape.blocks};
      for (int k = shape.first_line; k <= shape.last_line; ++k) {
        const Span span = span_of(k, n, family);
        T* line = first + (lines.line(k) - first);
        for (int p = span.begin; p < span.end; ++p) {
          const GridPost at = post_of(k, p, family);
          const double post =
              w[(y0 + static_cast<std::size_t>(at.y)) * side + x0 + static_cast<std::size_t>(at.x)];
          line[p] = static_cast<T>((plane.w0 + plane.wx * at.x + plane.wy * at.y - post) * radius_m * radius_m);
        }
      }
      fill_maxima(lines, shape, n, family, maxima);
      lines_.push_back(lines);
    }
  }
}

template <typename T>
std::size_t TileHeightGrids<T>::bytes() const {
  return sizeof(*this) + storage_.capacity() * sizeof(T) + lines_.capacity() * sizeof(HeightGridLines<T>);
}

template class TileHeightGrids<float>;
template class TileHeightGrids<double>;

}  // namespace vpe::voxel
