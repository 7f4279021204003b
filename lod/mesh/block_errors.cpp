#include "lod/mesh/block_errors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace lod {

namespace {

// Places nearer to an edge than this part of the chart count as on it.
constexpr double kOnEdge = 1e-13;

// Rounding of depths on planes over slivers, as a part of the radius.
constexpr double kDepthRounding = 1e-11;

struct MeshCorner {
  int i, j;
  double u, v;
  double depth;  // R n / (R + x h), as in mesh_overlay.h
};

class BlockMeter {
 public:
  BlockMeter(const Posts& posts, const BlockErrorOptions& options)
      : intervals_(posts.intervals),
        rows_(options.rows),
        options_(options),
        lines_(grid_lines(posts.key, posts.intervals)),
        off_(static_cast<std::size_t>(intervals_ * intervals_), 0.0) {
    depth_.reserve(posts.height_m.size());
    for (int j = 0; j <= intervals_; ++j) {
      for (int i = 0; i <= intervals_; ++i) depth_.push_back(depth_of(i, j, posts.at(i, j)));
    }
  }

  MeshCorner corner(const MeshVertex& vertex, double height_m) const {
    return {vertex.i, vertex.j, u(vertex.i), v(vertex.j), depth_of(vertex.i, vertex.j, height_m)};
  }

  // Visits the posts in a closed triangle.
  void add_posts(const std::array<MeshCorner, 3>& t) {
    const auto& [a, b, c] = t;
    const double turn = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
    const double du = ((b.depth - a.depth) * (c.v - a.v) - (c.depth - a.depth) * (b.v - a.v)) / turn;
    const double dv = ((c.depth - a.depth) * (b.u - a.u) - (b.depth - a.depth) * (c.u - a.u)) / turn;
    const auto [low_i, high_i] = std::minmax({a.i, b.i, c.i});
    const auto [low_j, high_j] = std::minmax({a.j, b.j, c.j});
    for (int j = low_j; j <= high_j; ++j) {
      double from = std::numeric_limits<double>::infinity();
      double to = -from;
      for (std::size_t k = 0; k < 3; ++k) {
        const MeshCorner& p = t[k];
        const MeshCorner& q = t[(k + 1) % 3];
        if (j < std::min(p.j, q.j) || j > std::max(p.j, q.j)) continue;
        const auto reach = [&](double at) { from = std::min(from, at), to = std::max(to, at); };
        if (p.j == q.j) {
          reach(p.u), reach(q.u);
        } else {
          reach(p.u + (q.u - p.u) * ((v(j) - p.v) / (q.v - p.v)));
        }
      }
      const auto begin = lines_.u.begin();
      int i = static_cast<int>(std::lower_bound(begin + low_i, begin + high_i + 1, from - kOnEdge) - begin);
      for (; i <= high_i && u(i) <= to + kOnEdge; ++i)
        add_post(i, j, a.depth + du * (u(i) - a.u) + dv * (v(j) - a.v));
    }
  }

  // Visits the places where an edge crosses grid lines and diagonals.
  void add_crossings(const MeshCorner& p, const MeshCorner& q) {
    if (p.i == q.i || p.j == q.j) return;  // on a line, where it meets others at posts
    at_.assign({0.0, 1.0});
    for (int i = std::min(p.i, q.i) + 1; i < std::max(p.i, q.i); ++i) at_.push_back((u(i) - p.u) / (q.u - p.u));
    for (int j = std::min(p.j, q.j) + 1; j < std::max(p.j, q.j); ++j) at_.push_back((v(j) - p.v) / (q.v - p.v));
    std::sort(at_.begin(), at_.end());
    for (std::size_t k = 0; k + 1 < at_.size(); ++k) add_in_cell(p, q, at_[k], at_[k + 1]);
  }

  BlockErrors errors() const {
    BlockErrors out;
    const int side = intervals_ / rows_;
    for (int k = 0; k <= rows_; ++k) {
      out.u.push_back(u(k * side));
      out.v.push_back(v(k * side));
    }
    for (int j = 0; j < rows_; ++j) {
      for (int i = 0; i < rows_; ++i) {
        double bound_m = 0;
        for (int y = j * side; y < (j + 1) * side; ++y) {
          for (int x = i * side; x < (i + 1) * side; ++x) bound_m = std::max(bound_m, distance_m(x, y));
        }
        out.bound_m.push_back(
            std::nextafter(static_cast<float>(bound_m), std::numeric_limits<float>::infinity()));
      }
    }
    return out;
  }

 private:
  double u(int i) const { return lines_.u[static_cast<std::size_t>(i)]; }
  double v(int j) const { return lines_.v[static_cast<std::size_t>(j)]; }
  double length(int i, int j) const { return std::sqrt(u(i) * u(i) + v(j) * v(j) + 1.0); }
  double depth_of(int i, int j, double height_m) const {
    return length(i, j) * options_.radius_m / (options_.radius_m + options_.exaggeration * height_m);
  }
  double depth(int i, int j) const { return depth_[static_cast<std::size_t>(j * (intervals_ + 1) + i)]; }

  void raise(int i, int j, double off) {
    double& most = off_[static_cast<std::size_t>(j * intervals_ + i)];
    most = std::max(most, std::abs(off));
  }

  // A post belongs to all cells around it.
  void add_post(int i, int j, double mesh_depth) {
    const double off = mesh_depth - depth(i, j);
    for (int y = std::max(j - 1, 0); y <= std::min(j, intervals_ - 1); ++y) {
      for (int x = std::max(i - 1, 0); x <= std::min(i, intervals_ - 1); ++x) raise(x, y, off);
    }
  }

  // Adds the part [from, to] of an edge, which lies in one cell: its ends, and where it crosses the diagonal.
  void add_in_cell(const MeshCorner& p, const MeshCorner& q, double from, double to) {
    const double middle = 0.5 * (from + to);
    const auto cell = [middle](const std::vector<double>& lines, double a, double b, int low, int high) {
      const auto begin = lines.begin();
      return static_cast<int>(std::upper_bound(begin + low + 1, begin + high, a + middle * (b - a)) - begin -
                              1);
    };
    const int i = cell(lines_.u, p.u, q.u, std::min(p.i, q.i), std::max(p.i, q.i));
    const int j = cell(lines_.v, p.v, q.v, std::min(p.j, q.j), std::max(p.j, q.j));
    const auto x = [&](double t) { return (p.u + t * (q.u - p.u) - u(i)) / (u(i + 1) - u(i)); };
    const auto y = [&](double t) { return (p.v + t * (q.v - p.v) - v(j)) / (v(j + 1) - v(j)); };
    const auto add = [&](double t, double at_x, double at_y) {
      const double third = at_x > at_y ? depth(i + 1, j) : depth(i, j + 1);
      const double large = std::max(at_x, at_y);
      const double small = std::min(at_x, at_y);
      const double facet = depth(i, j) + large * (third - depth(i, j)) + small * (depth(i + 1, j + 1) - third);
      raise(i, j, p.depth + t * (q.depth - p.depth) - facet);
    };
    const double before = x(from) - y(from);
    const double after = x(to) - y(to);
    add(from, x(from), y(from));
    add(to, x(to), y(to));
    if (before * after >= 0.0) return;
    const double t = from + (to - from) * (before / (before - after));
    const double diagonal = 0.5 * (x(t) + y(t));
    add(t, diagonal, diagonal);
  }

  // Returns how far the radii n R / W of two depths are apart at most in a cell. n is convex, W affine over facets.
  double distance_m(int i, int j) const {
    const double least =
        std::min(std::min(depth(i, j), depth(i + 1, j)), std::min(depth(i, j + 1), depth(i + 1, j + 1)));
    const double longest =
        std::max(std::max(length(i, j), length(i + 1, j)), std::max(length(i, j + 1), length(i + 1, j + 1)));
    const double off = off_[static_cast<std::size_t>(j * intervals_ + i)] + kDepthRounding * longest;
    if (!(least > off)) return std::numeric_limits<double>::infinity();
    return options_.radius_m * longest * off / (least * (least - off));
  }

  int intervals_;
  int rows_;
  BlockErrorOptions options_;
  GridLines lines_;
  std::vector<double> depth_;  // of the posts
  std::vector<double> off_;    // largest difference of depths by cell
  std::vector<double> at_;     // scratch
};

}  // namespace

double BlockErrors::largest_m(double at_u, double at_v, double reach) const {
  const auto block = [](const std::vector<double>& lines, double at) {
    const auto next = std::upper_bound(lines.begin() + 1, lines.end() - 1, at);
    return static_cast<std::size_t>(next - lines.begin() - 1);
  };
  const std::size_t rows = u.size() - 1;
  const std::size_t last_i = block(u, at_u + reach);
  const std::size_t last_j = block(v, at_v + reach);
  float most = 0;
  for (std::size_t j = block(v, at_v - reach); j <= last_j; ++j) {
    for (std::size_t i = block(u, at_u - reach); i <= last_i; ++i) most = std::max(most, bound_m[j * rows + i]);
  }
  return static_cast<double>(most);
}

BlockErrors block_errors(const TileMesh& mesh, std::span<const double> vertex_height_m, const Posts& posts,
                         const BlockErrorOptions& options) {
  const int rows = options.rows;
  if (posts.intervals != mesh.intervals || vertex_height_m.size() != mesh.vertices.size())
    throw std::invalid_argument("block_errors: tile " + to_string(posts.key) + " has another mesh");
  if (rows < 1 || rows > mesh.intervals || !std::has_single_bit(static_cast<unsigned>(rows)))
    throw std::invalid_argument("block_errors: " + std::to_string(rows) + " rows");
  BlockMeter meter(posts, options);
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const std::array<std::size_t, 3> at{mesh.triangles[t], mesh.triangles[t + 1], mesh.triangles[t + 2]};
    std::array<MeshCorner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = meter.corner(mesh.vertices[at[k]], vertex_height_m[at[k]]);
    meter.add_posts(corners);
    for (std::size_t k = 0; k < 3; ++k) {
      // Inner edges belong to two triangles, slanting ones are inner.
      if (at[k] < at[(k + 1) % 3]) meter.add_crossings(corners[k], corners[(k + 1) % 3]);
    }
  }
  return meter.errors();
}

}  // namespace lod
