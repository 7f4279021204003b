#include "lod/mesh/error_meter.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "lod/mesh/mesh_overlay.h"
#include "vpe/base/mutation.h"

namespace lod {

using vpe::base::Guard;
using vpe::base::mutated;

namespace {

using Pair = double __attribute__((vector_size(16)));

Pair load(const double* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof pair);
  return pair;
}

template <class T>
void raise(T& largest, T value) {
  const T size = -value > value ? -value : value;
  largest = size > largest ? size : largest;
}

// Visits the vertices of the overlay of a mesh with S over one finest tile.
class Overlay {
 public:
  Overlay(const CoarseMesh& mesh, const FineGrid& fine) : mesh_(mesh), fine_(fine), side_(fine.u.count()) {}

  void add_posts(const CoarseMesh::Triangle& t) {
    const CoarseMesh::Vertex& low = t.corner[0];
    const CoarseMesh::Vertex& middle = t.corner[1];
    const CoarseMesh::Vertex& high = t.corner[2];
    vary(t);
    const double whole = (high.u - low.u) / (high.v - low.v);
    const int begin = fine_.v.first(low.v);
    const int turn = fine_.v.first(middle.v);
    const int end = fine_.v.first(high.v);
    const auto rows = [&](int from, int to, const CoarseMesh::Vertex& a, const CoarseMesh::Vertex& b) {
      if (from >= to) return;  // horizontal edges have no slope
      const double half = (b.u - a.u) / (b.v - a.v);
      for (int j = from; j < to; ++j) {
        const double v = fine_.v[j];
        const int one = fine_.u.first(a.u + half * (v - a.v));
        const int two = fine_.u.first(low.u + whole * (v - low.v));
        if (t.middle_left) {
          add_row(t, j, one, two);
        } else {
          add_row(t, j, two, one);
        }
      }
    };
    rows(begin, turn, low, middle);
    rows(turn, end, middle, high);
  }

  // Visits the points where a mesh edge crosses lines and diagonals, cell by cell. The ends of slanting edges
  // are posts of S, which the triangles around them or the north and east borders have visited.
  void add_crossings(const CoarseMesh::Segment& s) {
    const LineTable& u = fine_.u;
    const LineTable& v = fine_.v;
    const double du = s.to.u - s.from.u;
    const double dv = s.to.v - s.from.v;
    const double per_u = du == 0.0 ? 0.0 : 1.0 / du;
    const double per_v = dv == 0.0 ? 0.0 : 1.0 / dv;
    double t = 0.0;
    double end = 1.0;
    const auto clip = [&](double at, double step, double per, double low, double high) {
      if (step == 0.0) return low <= at && at <= high;
      const double enter = ((step > 0.0 ? low : high) - at) * per;
      const double leave = ((step > 0.0 ? high : low) - at) * per;
      t = std::max(t, enter);
      end = std::min(end, leave);
      return true;
    };
    if (!clip(s.from.u, du, per_u, u[0], u[side_ - 1]) || !clip(s.from.v, dv, per_v, v[0], v[side_ - 1]))
      return;
    if (t > end) return;

    Point here{t, s.from.u + t * du, s.from.v + t * dv};
    int i = u.interval(here.u);
    int j = v.interval(here.v);
    // interval() gives a point on a line to the cell before it.
    if (du > 0.0 && i + 2 < side_ && here.u >= u[i + 1]) ++i;
    if (dv > 0.0 && j + 2 < side_ && here.v >= v[j + 1]) ++j;
    double x = u.fraction(i, here.u);
    double y = v.fraction(j, here.v);
    const bool slanting = du != 0.0 && dv != 0.0;
    if (!slanting || t > 0.0) add_point(s, here, i, j, x, y);
    constexpr double kNever = std::numeric_limits<double>::infinity();
    while (true) {
      const double next_u = du == 0.0 ? kNever : (u[du > 0.0 ? i + 1 : i] - s.from.u) * per_u;
      const double next_v = dv == 0.0 ? kNever : (v[dv > 0.0 ? j + 1 : j] - s.from.v) * per_v;
      const Point before = here;
      const double before_x = x;
      const double before_y = y;
      here.t = std::min({next_u, next_v, end});
      here.u = s.from.u + here.t * du;
      here.v = s.from.v + here.t * dv;
      x = u.fraction(i, here.u);
      y = v.fraction(j, here.v);
      if (!slanting || here.t < 1.0) add_point(s, here, i, j, x, y);
      if (const double from = before_x - before_y, to = x - y; from * to < 0.0) {
        const double f = from / (from - to);
        const double d = before_x + f * (x - before_x);
        add_point(s,
                  {before.t + f * (here.t - before.t), before.u + f * (here.u - before.u),
                   before.v + f * (here.v - before.v)},
                  i, j, d, d);
      }
      if (here.t >= end) return;
      if (next_u <= next_v) {
        i += du > 0.0 ? 1 : -1;
        x = du > 0.0 ? 0.0 : 1.0;
      }
      if (next_v <= next_u) {
        j += dv > 0.0 ? 1 : -1;
        y = dv > 0.0 ? 0.0 : 1.0;
      }
      if (i < 0 || j < 0 || i + 1 >= side_ || j + 1 >= side_) return;
    }
  }

  ErrorTerms terms() const {
    const double kappa =
        mutated(Guard::kCellVariation)
            ? 1.0
            : (1.0 + fine_.length_variation) * (1.0 + fine_.depth_variation) * (1.0 + depth_variation_);
    const double flat =
        (1.0 + fine_.length_variation) * (1.0 + fine_.length_variation) * (1.0 + length_variation_);
    const double total = largest(total_);
    const double sagitta = largest(sagitta_);
    ErrorTerms terms;
    terms.height_error_m = largest(height_error_) + (kappa - 1.0) * total + (flat - 1.0) * sagitta;
    terms.sagitta_m = flat * sagitta;
    terms.total_m = std::min(kappa * total, terms.height_error_m + terms.sagitta_m);
    return terms;
  }

 private:
  struct Point {
    double t, u, v;
  };

  static double largest(Pair pair) { return std::max(pair[0], pair[1]); }

  // Adds the distances in a direction of length n, from the depths W of mesh and S and their lengths n.
  template <class T>
  void add(T n, T mesh_depth, T depth, T mesh_length, T length, T& total_most, T& sagitta_most,
           T& height_error_most) const {
    const T depths = mesh_depth * depth;
    const T lengths = mesh_length * length;
    const T scale = n * mesh_.radius_m / (depths * lengths);
    const T total = (depth - mesh_depth) * lengths * scale;
    const T sagitta = (length - mesh_length) * depths * scale;
    raise(total_most, total);
    raise(sagitta_most, sagitta);
    raise(height_error_most, total - sagitta);
  }
  void add(double n, double mesh_depth, double depth, double mesh_length, double length) {
    double total = total_[0];
    double sagitta = sagitta_[0];
    double height_error = height_error_[0];
    add(n, mesh_depth, depth, mesh_length, length, total, sagitta, height_error);
    total_[0] = total;
    sagitta_[0] = sagitta;
    height_error_[0] = height_error;
  }

  void add_row(const CoarseMesh::Triangle& t, int j, int first, int end) {
    const CoarseMesh::Vertex& low = t.corner[0];
    const double depth_row = low.depth + t.depth_dv * (fine_.v[j] - low.v);
    const double length_row = low.length + t.length_dv * (fine_.v[j] - low.v);
    const std::size_t row = static_cast<std::size_t>(j) * static_cast<std::size_t>(side_);
    const double* u = fine_.u.data();
    const double* depth = fine_.depth.data() + row;
    const double* length = fine_.length.data() + row;
    int i = first;
    for (; i + 1 < end; i += 2) {
      const Pair off = load(u + i) - low.u;
      const Pair n = load(length + i);
      add(n, depth_row + t.depth_du * off, load(depth + i), length_row + t.length_du * off, n, total_, sagitta_,
          height_error_);
    }
    if (i < end) {
      const double off = u[i] - low.u;
      add(length[i], depth_row + t.depth_du * off, depth[i], length_row + t.length_du * off, length[i]);
    }
  }

  // Adds a point of a mesh edge at (x, y) of cell (i, j).
  void add_point(const CoarseMesh::Segment& s, const Point& p, int i, int j, double x, double y) {
    const std::size_t at =
        static_cast<std::size_t>(j) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(i);
    const std::size_t up = at + static_cast<std::size_t>(side_);
    // S's diagonal runs from (i, j) to (i + 1, j + 1).
    const std::size_t middle = x > y ? at + 1 : up;
    const double large = std::max(x, y);
    const double small = std::min(x, y);
    const auto facet = [&](const std::vector<double>& f) {
      return f[at] + large * (f[middle] - f[at]) + small * (f[up + 1] - f[middle]);
    };
    add(std::sqrt(p.u * p.u + p.v * p.v + 1.0), s.from.depth + p.t * (s.to.depth - s.from.depth),
        facet(fine_.depth), s.from.length + p.t * (s.to.length - s.from.length), facet(fine_.length));
  }

  // Records how much a mesh triangle's depths vary over one cell.
  void vary(const CoarseMesh::Triangle& t) {
    const auto& [a, b, c] = t.corner;
    const auto variation = [&](double du, double dv, double fa, double fb, double fc) {
      const double least = std::min({fa, fb, fc});
      const double cell = std::abs(du) * fine_.u.widest() + std::abs(dv) * fine_.v.widest();
      return std::min(cell, std::max({fa, fb, fc}) - least) / least;
    };
    depth_variation_ = std::max(depth_variation_, variation(t.depth_du, t.depth_dv, a.depth, b.depth, c.depth));
    length_variation_ =
        std::max(length_variation_, variation(t.length_du, t.length_dv, a.length, b.length, c.length));
  }

  const CoarseMesh& mesh_;
  const FineGrid& fine_;
  int side_;
  Pair total_{0.0, 0.0};
  Pair sagitta_{0.0, 0.0};
  Pair height_error_{0.0, 0.0};
  double depth_variation_ = 0;
  double length_variation_ = 0;
};

ErrorTerms measure_overlay(const CoarseMesh& mesh, const FineGrid& fine) {
  const int depth = fine.key.level - mesh.key.level;
  const auto bits = [](int intervals) { return std::countr_zero(static_cast<unsigned>(intervals)); };
  if (!contains(mesh.key, fine.key) || depth + bits(fine.intervals) < bits(mesh.intervals)) {
    throw std::invalid_argument("ErrorMeter: tile " + to_string(fine.key) + " of " +
                                std::to_string(fine.intervals) +
                                " intervals does not refine the mesh of tile " + to_string(mesh.key) +
                                " over " + std::to_string(mesh.intervals));
  }
  if (fine.radius_m != mesh.radius_m)
    throw std::invalid_argument("ErrorMeter: mesh and posts have different planet radii");

  // The extent of the fine tile in units of the mesh's grid, rounded outwards.
  const auto span = [&](std::int32_t fine_index, std::int32_t index) {
    const std::int64_t at =
        (static_cast<std::int64_t>(fine_index) - (static_cast<std::int64_t>(index) << depth)) * mesh.intervals;
    const std::int64_t round_up = (std::int64_t{1} << depth) - 1;
    return std::pair(at >> depth, (at + mesh.intervals + round_up) >> depth);
  };
  const auto i = span(fine.key.i, mesh.key.i);
  const auto j = span(fine.key.j, mesh.key.j);
  const auto touches = [&](const CoarseMesh::Box& b) {
    return b.i0 <= i.second && b.i1 >= i.first && b.j0 <= j.second && b.j1 >= j.first;
  };

  Overlay overlay(mesh, fine);
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    if (touches(mesh.triangle_boxes[k])) overlay.add_posts(mesh.triangles[k]);
  }
  const bool same_grid = depth + bits(fine.intervals) == bits(mesh.intervals);
  for (std::size_t k = 0; k < mesh.segments.size(); ++k) {
    const CoarseMesh::Box& box = mesh.segment_boxes[k];
    if (!touches(box)) continue;
    const CoarseMesh::Segment& s = mesh.segments[k];
    const bool ascending = (s.to.u - s.from.u) * (s.to.v - s.from.v) > 0.0;
    // Such an edge is a diagonal of S itself.
    if (same_grid && ascending && box.i1 - box.i0 == 1 && box.j1 - box.j0 == 1) continue;
    overlay.add_crossings(s);
  }
  return overlay.terms();
}

}  // namespace

struct FinePosts::Prepared : FineGrid {
  using FineGrid::FineGrid;
};

FinePosts::FinePosts(const Posts& posts, double radius_m)
    : prepared_(std::make_unique<const Prepared>(posts, radius_m)) {}
FinePosts::~FinePosts() = default;
FinePosts::FinePosts(FinePosts&&) noexcept = default;
FinePosts& FinePosts::operator=(FinePosts&&) noexcept = default;
const FineGrid& FinePosts::grid() const { return *prepared_; }

struct ErrorMeter::Prepared : CoarseMesh {
  using CoarseMesh::CoarseMesh;
};

ErrorMeter::ErrorMeter(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
                       double radius_m)
    : prepared_(std::make_unique<const Prepared>(key, mesh, vertex_height_m, radius_m)) {}
ErrorMeter::~ErrorMeter() = default;
ErrorMeter::ErrorMeter(ErrorMeter&&) noexcept = default;
ErrorMeter& ErrorMeter::operator=(ErrorMeter&&) noexcept = default;

ErrorTerms ErrorMeter::measure(const FinePosts& fine) const {
  return measure_overlay(*prepared_, *fine.prepared_);
}

ErrorTerms ErrorMeter::measure(const Posts& fine) const {
  return measure(FinePosts(fine, prepared_->radius_m));
}

ErrorTerms measure_error(const TileKey& key, const TileMesh& mesh, std::span<const double> vertex_height_m,
                         const Posts& fine, double radius_m) {
  return ErrorMeter(key, mesh, vertex_height_m, radius_m).measure(fine);
}

}  // namespace lod
