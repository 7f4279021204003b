#include <algorithm>
#include <array>
#include <cmath>

#include "lod/tree/posts.h"

namespace lod {

namespace {

constexpr std::size_t kCells = 64;

// Two rows of posts over some columns, and what the cells between them have.
struct CellRow {
  struct Posts {
    std::array<double, kCells + 1> x, y, z;
  };
  Posts south, north;
  // Of both facets of a cell: the squared tangent of the slope at the corner that they share.
  std::array<double, kCells> south2, north2;
  std::array<double, kCells> diagonal2, other2;  // squared lengths
};

// Calculates the cells between both rows.
[[gnu::always_inline]] inline void fill_cells(CellRow& row, std::size_t count) {
  const CellRow::Posts& s = row.south;
  const CellRow::Posts& n = row.north;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = s.x[i];
    const double y = s.y[i];
    const double z = s.z[i];
    const double dx = n.x[i + 1] - x;
    const double dy = n.y[i + 1] - y;
    const double dz = n.z[i + 1] - z;
    const double length2 = x * x + y * y + z * z;
    const auto tangent2 = [&](double bx, double by, double bz, double cx, double cy, double cz) {
      const double nx = by * cz - cy * bz;
      const double ny = bz * cx - cz * bx;
      const double nz = bx * cy - cx * by;
      const double up = nx * x + ny * y + nz * z;
      return (nx * nx + ny * ny + nz * nz) * length2 / (up * up) - 1.0;
    };
    row.south2[i] = tangent2(s.x[i + 1] - x, s.y[i + 1] - y, s.z[i + 1] - z, dx, dy, dz);
    row.north2[i] = tangent2(dx, dy, dz, n.x[i] - x, n.y[i] - y, n.z[i] - z);
    const double ox = n.x[i] - s.x[i + 1];
    const double oy = n.y[i] - s.y[i + 1];
    const double oz = n.z[i] - s.z[i + 1];
    row.diagonal2[i] = dx * dx + dy * dy + dz * dz;
    row.other2[i] = ox * ox + oy * oy + oz * oz;
  }
}

// A row of a tile's posts, from the first one of some columns.
struct PostRow {
  const double* u;
  const double* height_m;
  double v;
  double radius_m;
  const mars::FaceAxes& axes;
};

// Sets the northern row to posts: mars::chart_direction() times their distances from the planet's centre.
[[gnu::always_inline]] inline void fill_north(CellRow& cells, const PostRow& row, std::size_t count) {
  const auto& [right, up, out] = row.axes;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = right.x * row.u[i] + up.x * row.v + out.x;
    const double y = right.y * row.u[i] + up.y * row.v + out.y;
    const double z = right.z * row.u[i] + up.z * row.v + out.z;
    const double length = std::sqrt(x * x + y * y + z * z);
    const double r = row.radius_m + row.height_m[i];
    cells.north.x[i] = x / length * r;
    cells.north.y[i] = y / length * r;
    cells.north.z[i] = z / length * r;
  }
}

// Moves both rows north to the given one and calculates the cells between them.
[[gnu::always_inline]] inline void advance(CellRow& cells, const PostRow& row, std::size_t count) {
  cells.south = cells.north;
  fill_north(cells, row, count + 1);
  fill_cells(cells, count);
}

void advance_plain(CellRow& cells, const PostRow& row, std::size_t count) { advance(cells, row, count); }

// The same code for wider registers. No products are fused with sums, so both give the same bits.
#if defined(__x86_64__) && defined(__GNUC__)
[[gnu::target("avx2")]] void advance_avx2(CellRow& cells, const PostRow& row, std::size_t count) {
  advance(cells, row, count);
}
bool has_avx2() { return __builtin_cpu_supports("avx2") != 0; }
#else
void advance_avx2(CellRow& cells, const PostRow& row, std::size_t count) { advance(cells, row, count); }
bool has_avx2() { return false; }
#endif

}  // namespace

double steepest_slope(const Posts& posts, const GridLines& lines, double radius_m) {
  const auto side = static_cast<std::size_t>(posts.side());
  const auto advance_to = has_avx2() ? advance_avx2 : advance_plain;
  const mars::FaceAxes& axes = mars::face_axes(posts.key.face);
  CellRow cells{};
  double largest2 = 0;
  double longest2 = 0;
  for (std::size_t i0 = 0; i0 + 1 < side; i0 += kCells) {
    const std::size_t count = std::min(kCells, side - 1 - i0);
    for (std::size_t j = 0; j < side; ++j) {
      advance_to(cells, {&lines.u[i0], &posts.height_m[j * side + i0], lines.v[j], radius_m, axes}, count);
      if (j == 0) continue;
      for (std::size_t i = 0; i < count; ++i) {
        largest2 = std::max(largest2, std::max(cells.south2[i], cells.north2[i]));
        longest2 = std::max(longest2, std::max(cells.diagonal2[i], cells.other2[i]));
      }
    }
  }
  // Over a facet the vertical changes by at most the angle of its longest side.
  const double turn =
      std::sqrt(longest2) / (radius_m + *std::min_element(posts.height_m.begin(), posts.height_m.end()));
  const double tangent = std::sqrt(largest2);
  return turn * tangent < 0.9 ? (tangent + 1.1 * turn) / (1.0 - turn * tangent) : 1e6;
}

}  // namespace lod
