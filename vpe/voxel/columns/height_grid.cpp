#include "vpe/voxel/columns/height_grid.h"

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

// Fills `store` with the posts that height(GridPost) returns and their maxima, and appends the grid to `grids`.
template <typename T, typename Height>
void add_grid(const DepthPlane& reference, const Shape& shape, T* store, int intervals, LineFamily family,
              std::vector<HeightGridLines<T>>& grids, const Height& height) {
  T* const first = store + 1;
  T* const maxima = store + shape.posts();
  const HeightGridLines<T> lines{reference, first, maxima, shape.side, shape.first_block, shape.blocks};
  for (int k = shape.first_line; k <= shape.last_line; ++k) {
    const Span span = span_of(k, intervals, family);
    T* const line = first + (lines.line(k) - first);
    for (int p = span.begin; p < span.end; ++p) line[p] = height(post_of(k, p, family));
  }
  fill_maxima(lines, shape, intervals, family, maxima);
  grids.push_back(lines);
}

// Places a line of a finer tile among the lines of a coarser one: in a cell, at a share of its width.
struct CoarsePlace {
  int cell = 0;
  double share = 0;
};

}  // namespace

int grids_per_side(int level, int intervals) {
  return level >= kKnotLevel ? 1 : std::min(intervals, 1 << (kKnotLevel - level));
}

template <typename T>
TileHeightGrids<T>::TileHeightGrids(const paging::TileHeights& heights, double radius_m, double exaggeration,
                                    LineFamily family)
    : family_(family), per_side_(grids_per_side(heights.posts.key.level, heights.posts.intervals)) {
  const lod::Posts& posts = heights.posts;
  const lod::GridLines grid = lod::grid_lines(posts.key, posts.intervals);
  const auto side = static_cast<std::size_t>(posts.side());
  std::vector<double> w(side * side);
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x)
      w[y * side + x] =
          lod::inverse_depth(grid.u[x], grid.v[y], exaggeration * posts.height_m[y * side + x], radius_m);
  }
  set(w, posts.intervals, radius_m);
}

template <typename T>
TileHeightGrids<T>::TileHeightGrids(const TileHeightGrids& other, LineFamily family)
    : family_(family), per_side_(other.per_side_) {
  const int n = other.lines_.front().side - 1;
  const Shape shape = shape_of(n, family);
  storage_.assign(other.lines_.size() * shape.total(), T(0));
  for (const HeightGridLines<T>& from : other.lines_) {
    add_grid(from.reference, shape, storage_.data() + lines_.size() * shape.total(), n, family, lines_,
             [&](GridPost at) { return post_height(from, other.family_, at.x, at.y); });
  }
}

template <typename T>
TileHeightGrids<T>::TileHeightGrids(const TileHeightGrids<float>& coarser, const FallbackTile& tile,
                                    double radius_m, double exaggeration, LineFamily family)
    : family_(family), per_side_(grids_per_side(tile.key.level, tile.intervals)) {
  const int n = tile.intervals;
  const int coarser_n = tile.coarser_intervals > 0 ? tile.coarser_intervals : n;
  const auto side = static_cast<std::size_t>(n) + 1;
  const lod::GridLines lines = lod::grid_lines(tile.key, n);
  const lod::GridLines coarse_lines = lod::grid_lines(tile.coarser, coarser_n);
  const int levels = tile.key.level - tile.coarser.level;
  const auto places = [&](std::int32_t index, std::int32_t coarse_index, const std::vector<double>& at,
                          const std::vector<double>& coarse_at) {
    const std::int64_t first = (index - (std::int64_t{coarse_index} << levels)) * n;
    std::vector<CoarsePlace> out(side);
    for (std::size_t k = 0; k < side; ++k) {
      const std::int64_t at_coarser = (first + static_cast<std::int64_t>(k)) * (coarser_n / n);
      const auto cell = std::min<std::int64_t>(at_coarser >> levels, coarser_n - 1);
      const auto c = static_cast<std::size_t>(cell);
      out[k] = {static_cast<int>(cell), (at[k] - coarse_at[c]) / (coarse_at[c + 1] - coarse_at[c])};
    }
    return out;
  };
  const std::vector<CoarsePlace> across = places(tile.key.i, tile.coarser.i, lines.u, coarse_lines.u);
  const std::vector<CoarsePlace> up = places(tile.key.j, tile.coarser.j, lines.v, coarse_lines.v);
  const int coarse_n = coarser_n / coarser.per_side();
  const double per_depth = 1 / (radius_m * radius_m);
  std::vector<double> w(side * side);
  for (std::size_t y = 0; y < side; ++y) {
    const int row = up[y].cell / coarse_n;
    for (std::size_t x = 0; x < side; ++x) {
      const int column = across[x].cell / coarse_n;
      const HeightGridLines<float>& grid = coarser.lines(column, row);
      const auto depth_at = [&](int i, int j) {
        const GridPost at{across[x].cell - column * coarse_n + i, up[y].cell - row * coarse_n + j};
        return grid.reference.w0 + grid.reference.wx * at.x + grid.reference.wy * at.y -
               static_cast<double>(post_height(grid, coarser.family(), at.x, at.y)) * per_depth;
      };
      const double s = across[x].share;
      const double t = up[y].share;
      const double middle = s >= t ? depth_at(1, 0) : depth_at(0, 1);
      const double corner = depth_at(0, 0);
      const double sampled =
          corner + std::max(s, t) * (middle - corner) + std::min(s, t) * (depth_at(1, 1) - middle);
      const auto limit = [&](double height_m) {
        return lod::inverse_depth(lines.u[x], lines.v[y], exaggeration * height_m, radius_m);
      };
      w[y * side + x] = std::clamp(sampled, limit(tile.max_height_m), limit(tile.min_height_m));
    }
  }
  set(w, n, radius_m);
}

template <typename T>
void TileHeightGrids<T>::set(const std::vector<double>& inverse_depth, int intervals, double radius_m) {
  const int n = intervals / per_side_;
  const auto side = static_cast<std::size_t>(intervals) + 1;
  const Shape shape = shape_of(n, family_);
  const std::size_t count = static_cast<std::size_t>(per_side_) * static_cast<std::size_t>(per_side_);
  storage_.assign(count * shape.total(), T(0));
  for (int j = 0; j < per_side_; ++j) {
    for (int i = 0; i < per_side_; ++i) {
      const auto x0 = static_cast<std::size_t>(i * n);
      const auto y0 = static_cast<std::size_t>(j * n);
      const DepthPlane plane = plane_of(x0, y0, n, inverse_depth, side);
      add_grid(
          plane, shape, storage_.data() + lines_.size() * shape.total(), n, family_, lines_, [&](GridPost at) {
            const double post = inverse_depth[(y0 + static_cast<std::size_t>(at.y)) * side + x0 +
                                              static_cast<std::size_t>(at.x)];
            return static_cast<T>((plane.w0 + plane.wx * at.x + plane.wy * at.y - post) * radius_m * radius_m);
          });
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
