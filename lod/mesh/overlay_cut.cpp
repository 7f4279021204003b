#include "lod/mesh/overlay_cut.h"

#include <algorithm>
#include <cmath>

namespace lod {

namespace {

// Distances in units of the radius that rounding may add.
constexpr double kRounding = 1e-14;
// A post is taken for inside so far beyond a side, for a point's rounding.
constexpr double kSideRounding = 1e-12;

double least_of(double a, double b, double c) { return std::min(std::min(a, b), c); }
double most_of(double a, double b, double c) { return std::max(std::max(a, b), c); }

double squared(double du, double dv) { return du * du + dv * dv; }

}  // namespace

OverlayCut::OverlayCut(const CoarseMesh& mesh, const FineGrid& fine, std::int64_t first_i, std::int64_t first_j)
    : fine_(fine),
      radius_m_(mesh.radius_m),
      cell_curve_(squared(fine.u.widest(), fine.v.widest()) / 8),
      rounding_(kRounding * (4 + fine.depth_variation / std::min(fine.u.widest(), fine.v.widest()))),
      first_i_(first_i),
      first_j_(first_j),
      intervals_(fine.intervals) {}

bool OverlayCut::to_tile(const CoarseMesh::Box& box, DepthBox& own) const {
  const std::int64_t i0 = box.i0 - first_i_;
  const std::int64_t i1 = box.i1 - first_i_;
  const std::int64_t j0 = box.j0 - first_j_;
  const std::int64_t j1 = box.j1 - first_j_;
  if (i0 < 0 || j0 < 0 || i1 > intervals_ || j1 > intervals_) return false;
  own = {static_cast<std::uint32_t>(i0), static_cast<std::uint32_t>(i1), static_cast<std::uint32_t>(j0),
         static_cast<std::uint32_t>(j1)};
  return true;
}

OverlayCut::Limits OverlayCut::limits(const Extent& extent, double span, const LargestDistances& most) const {
  // The length n of directions is convex with second derivatives of at most 1 / n, and falls by at most 1 for each unit. A
  // plane through its values at the corners is above it by at most (radius of a circle around the corners)^2 / 2 of that,
  // and S's own planes by at most the same of a cell. A sagitta is R (difference of lengths) / length or less.
  constexpr Limits kNone{-1, -1};
  const double per_lowest = 1.0 / std::max(1.0, extent.least_length - span);
  const double metres = radius_m_ * per_lowest;
  const double deepest_m =
      metres * extent.half_curve * per_lowest + radius_m_ * kRounding;  // S outside of the mesh
  const double cell_m = metres * cell_curve_ + radius_m_ * kRounding;   // S inside of it
  if (std::max(deepest_m, cell_m) > std::min(most.sagitta_m, most.height_error_m)) return kNone;
  // The height error is total - sagitta, and the sagitta from -deepest to cell.
  const double below_m = std::min(most.total_m, most.height_error_m - deepest_m);
  const double above_m = std::min(most.total_m, most.height_error_m - cell_m);
  // |D| n R / (W (W - |D|)) <= total, that is |D| <= total W^2 / (n R + total W). One division for both.
  const double depth = extent.least_depth;
  const double farthest = extent.most_length * radius_m_ + std::max(below_m, above_m) * depth;
  const double per_metre = depth * depth / farthest * (1 - 1e-9);
  return {below_m * per_metre - rounding_, above_m * per_metre - rounding_};
}

bool OverlayCut::leaves_out(const CoarseMesh::Triangle& t, const CoarseMesh::Box& box,
                            const LargestDistances& most) const {
  DepthBox own;
  if (!to_tile(box, own)) return false;
  const auto& [low, middle, high] = t.corner;
  const double longest2 =
      most_of(squared(middle.u - low.u, middle.v - low.v), squared(high.u - middle.u, high.v - middle.v),
              squared(high.u - low.u, high.v - low.v));
  // A circle of (longest side)^2 / 3 covers every triangle (Jung).
  const Limits limit =
      limits({least_of(low.depth, middle.depth, high.depth), least_of(low.length, middle.length, high.length),
              most_of(low.length, middle.length, high.length), longest2 / 6},
             std::abs(high.u - low.u) + std::abs(middle.u - low.u) + high.v - low.v, most);
  if (limit.below < 0 || limit.above < 0) return false;
  const double turn = t.middle_left ? 1.0 : -1.0;
  const auto side = [&](const CoarseMesh::Vertex& from, const CoarseMesh::Vertex& to) {
    const double du = turn * (to.u - from.u);
    const double dv = turn * (to.v - from.v);
    return DepthSide{dv * from.u - du * from.v + kSideRounding * (std::abs(du) + std::abs(dv)), -dv, du};
  };
  // Counter-clockwise where the middle corner lies left of the long side; else `turn` makes them so.
  const std::array<DepthSide, 3> sides{side(middle, low), side(high, middle), side(low, high)};
  const DepthDifferences found =
      largest_differences({fine_.depth.data(), fine_.padded_u.data(), fine_.v.data(), fine_.side()},
                          {low.depth, t.depth_du, t.depth_dv, low.u, low.v}, sides, own);
  return found.below <= limit.below && found.above <= limit.above;
}

bool OverlayCut::leaves_out(const CoarseMesh::Segment& s, const CoarseMesh::Box& box,
                            const LargestDistances& most) const {
  DepthBox own;
  if (box.i0 == box.i1 || box.j0 == box.j1 || !to_tile(box, own)) return false;
  const double du = s.to.u - s.from.u;
  const double dv = s.to.v - s.from.v;
  const Limits limit = limits({std::min(s.from.depth, s.to.depth), std::min(s.from.length, s.to.length),
                               std::max(s.from.length, s.to.length), squared(du, dv) / 8},
                              std::abs(du) + std::abs(dv), most);
  return limit.below >= 0 && limit.above >= 0 && stays_within(s, own, limit);
}

bool OverlayCut::stays_within(const CoarseMesh::Segment& s, const DepthBox& box, const Limits& limit) const {
  const double from_u = s.from.u;
  const double from_v = s.from.v;
  const double du = s.to.u - from_u;
  const double dv = s.to.v - from_v;
  const double per_u = 1.0 / du;
  const double per_v = 1.0 / dv;
  const double from_depth = s.from.depth;
  const double climb = s.to.depth - from_depth;
  const double* u = fine_.u.data();
  const double* v = fine_.v.data();
  const double* per_column = fine_.u.inverse_widths();
  const double* per_row = fine_.v.inverse_widths();
  const std::size_t side = fine_.side();
  const std::size_t east = du > 0 ? 1 : 0;
  const std::size_t north = dv > 0 ? 1 : 0;
  std::size_t i = du > 0 ? box.i0 : box.i1 - 1;
  std::size_t j = dv > 0 ? box.j0 : box.j1 - 1;
  // Cell by cell: the diagonal inside it, then the line through which the edge leaves it. Differences are affine between
  // these, and 0 at the ends, which are posts.
  const auto is_beyond = [&](double difference) {
    return difference > limit.below || -difference > limit.above;
  };
  double t = 0;
  double x = 1.0 - static_cast<double>(east);  // the place in the cell, 0 to 1
  double y = 1.0 - static_cast<double>(north);
  double t_column = (u[i + east] - from_u) * per_u;
  double t_row = (v[j + north] - from_v) * per_v;
  while (true) {
    const double* low = fine_.depth.data() + j * side + i;
    const double* high = low + side;
    const double next = std::min(t_column, t_row);
    const bool is_last = next > 1.0 - kRounding;
    const double end = is_last ? 1.0 : next;
    const double to_x = (from_u + end * du - u[i]) * per_column[i];
    const double to_y = (from_v + end * dv - v[j]) * per_row[j];
    const double before = x - y;
    const double after = to_x - to_y;
    if (before * after < 0) {
      const double part = before / (before - after);
      const double surface = low[0] + (x + part * (to_x - x)) * (high[1] - low[0]);
      if (is_beyond(surface - (from_depth + (t + part * (end - t)) * climb))) return false;
    }
    if (is_last) return true;
    double surface = 0;
    if (t_column <= t_row) {
      surface = low[east] + to_y * (high[east] - low[east]);
      i += 2 * east - 1;
      t_column = (u[i + east] - from_u) * per_u;
      x = 1.0 - static_cast<double>(east);
      y = to_y;
    } else {
      const double* line = north != 0 ? high : low;
      surface = line[0] + to_x * (line[1] - line[0]);
      j += 2 * north - 1;
      t_row = (v[j + north] - from_v) * per_v;
      x = to_x;
      y = 1.0 - static_cast<double>(north);
    }
    if (is_beyond(surface - (from_depth + end * climb))) return false;
    t = end;
  }
}

}  // namespace lod
