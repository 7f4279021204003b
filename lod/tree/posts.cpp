#include "lod/tree/posts.h"

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>

#include "lod/tree/facet.h"
#include "vpe/base/mutation.h"

namespace lod {

using vpe::base::Guard;
using vpe::base::mutated;

namespace {

// One vertex of a facet: R w = length - deficit, where the deficit |p| h / (R + h) is small compared with the
// length.
struct Vertex {
  double u, v;
  double length;
  double deficit;
};

Vertex vertex(double u, double v, double height_m, double radius_m) {
  const double length = std::sqrt(u * u + v * v + 1.0);
  return {u, v, length, length * (height_m / (radius_m + height_m))};
}

// Returns |b| - |a| without cancellation.
double length_difference(const Vertex& a, const Vertex& b) {
  return ((b.u - a.u) * (b.u + a.u) + (b.v - a.v) * (b.v + a.v)) / (b.length + a.length);
}

// Returns R w(b) - R w(a).
double depth_difference(const Vertex& a, const Vertex& b) {
  return length_difference(a, b) - (b.deficit - a.deficit);
}

// Returns the height at (u, v), where R w exceeds that of vertex a by `growth`: R (|p| - R w) / (R w).
double height_at(const Vertex& a, double u, double v, double growth, double radius_m) {
  const Vertex here{u, v, std::sqrt(u * u + v * v + 1.0), 0.0};
  const double above = length_difference(a, here) + a.deficit - growth;
  return radius_m * above / (here.length - above);
}

// Returns the index of the interval of ascending lines that contains x (clamped). The last line belongs to the
// last interval.
int interval_of(const std::vector<double>& lines, double x) {
  const int last = static_cast<int>(lines.size()) - 2;
  const double t = (x - lines.front()) / (lines.back() - lines.front()) * (last + 1);
  int i = std::clamp(static_cast<int>(t), 0, last);
  const auto line = [&](int k) { return lines[static_cast<std::size_t>(k)]; };
  while (i > 0 && x < line(i)) --i;
  while (i < last && x >= line(i + 1)) ++i;
  return i;
}

}  // namespace

GridLines grid_lines(const TileKey& key, int intervals) {
  const int grid_level = key.level + std::countr_zero(static_cast<unsigned>(intervals));
  GridLines lines;
  const auto side = static_cast<std::size_t>(intervals) + 1;
  lines.u.resize(side);
  lines.v.resize(side);
  for (std::size_t k = 0; k < side; ++k) {
    const auto step = static_cast<std::int64_t>(k);
    lines.u[k] = mars::face_line(std::int64_t{key.i} * intervals + step, grid_level);
    lines.v[k] = mars::face_line(std::int64_t{key.j} * intervals + step, grid_level);
  }
  return lines;
}

double post_spacing_m(int level, int intervals, double radius_m) {
  const int grid_level = level + std::countr_zero(static_cast<unsigned>(intervals));
  if (grid_level == 0) return nominal_side_m(0, radius_m);
  return radius_m * std::atan(mars::face_line((std::int64_t{1} << (grid_level - 1)) + 1, grid_level));
}

Facet facet_at(const Posts& posts, const GridLines& lines, double u, double v, double radius_m,
               double exaggeration) {
  u = std::clamp(u, lines.u.front(), lines.u.back());
  v = std::clamp(v, lines.v.front(), lines.v.back());
  const int i = interval_of(lines.u, u);
  const int j = interval_of(lines.v, v);
  const auto post = [&](int column, int row) {
    return vertex(lines.u[static_cast<std::size_t>(column)], lines.v[static_cast<std::size_t>(row)],
                  exaggeration * posts.at(column, row), radius_m);
  };
  const Vertex a = post(i, j);
  const Vertex c = post(i + 1, j + 1);
  const double du = c.u - a.u;
  const double dv = c.v - a.v;
  const bool lower = (u - a.u) * dv >= (v - a.v) * du;
  const Vertex b = lower ? post(i + 1, j) : post(i, j + 1);
  Facet facet{a.u, c.u, a.v, c.v, lower, a.length, a.deficit};
  facet.slope_u = (lower ? depth_difference(a, b) : depth_difference(b, c)) / du;
  facet.slope_v = (lower ? depth_difference(b, c) : depth_difference(a, b)) / dv;
  return facet;
}

double Facet::height_m(double u, double v, double radius_m) const {
  return height_at({u0, v0, length, deficit}, u, v, slope_u * (u - u0) + slope_v * (v - v0), radius_m);
}

glm::dvec3 Facet::normal(mars::Face face) const {
  // On the facet R w = n . (u, v, 1), hence n . P = R: n is its normal in the face's axes.
  const double constant = length - deficit - slope_u * u0 - slope_v * v0;
  const mars::FaceAxes& axes = mars::face_axes(face);
  return glm::normalize(axes.right * slope_u + axes.up * slope_v + axes.out * constant);
}

double surface_height(const Posts& posts, const GridLines& lines, double u, double v, double radius_m,
                      glm::dvec3* normal, double exaggeration) {
  u = std::clamp(u, lines.u.front(), lines.u.back());
  v = std::clamp(v, lines.v.front(), lines.v.back());
  const Facet facet = facet_at(posts, lines, u, v, radius_m, exaggeration);
  if (normal != nullptr) *normal = facet.normal(posts.key.face);
  return facet.height_m(u, v, radius_m);
}

void constrain_edge(Posts& posts, const GridLines& lines, Edge edge, int step, double radius_m,
                    double exaggeration) {
  if (mutated(Guard::kBorderPosts)) return;
  const int n = posts.intervals;
  const bool vertical = edge == Edge::kWest || edge == Edge::kEast;
  const int fixed = edge == Edge::kEast || edge == Edge::kNorth ? n : 0;
  const auto index = [&](int k) {
    const int i = vertical ? fixed : k;
    const int j = vertical ? k : fixed;
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(posts.side()) + static_cast<std::size_t>(i);
  };
  const auto post = [&](int k) {
    const double u = lines.u[static_cast<std::size_t>(vertical ? fixed : k)];
    const double v = lines.v[static_cast<std::size_t>(vertical ? k : fixed)];
    return vertex(u, v, exaggeration * posts.height_m[index(k)], radius_m);
  };
  const std::vector<double>& along = vertical ? lines.v : lines.u;
  for (int start = 0; start < n; start += step) {
    const Vertex a = post(start);
    const Vertex b = post(start + step);
    const double from = along[static_cast<std::size_t>(start)];
    const double slope = depth_difference(a, b) / (along[static_cast<std::size_t>(start + step)] - from);
    for (int k = start + 1; k < start + step; ++k) {
      const double here = along[static_cast<std::size_t>(k)];
      const double u = vertical ? a.u : here;
      const double v = vertical ? here : a.v;
      posts.height_m[index(k)] = height_at(a, u, v, slope * (here - from), radius_m) / exaggeration;
    }
  }
}

}  // namespace lod
