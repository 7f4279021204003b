// A straight line in space over the chart of a cube face. Its projection to the chart stays straight, so grid
// lines cut it where linear functions of its parameter vanish. Casting (cast.cpp) and sections (section.cpp)
// use it.
//
// Typical usage:
//   const ChartLine line(face, start, direction);
//   const Interval inside = line.in_face({0.0, 1.0});
//   visit_quarters(inside, line.line_u(u), line.line_v(v), 1.0, visit);
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "lod/tree/posts.h"
#include "mars/geodesy/cube.h"

namespace paging {

// Holds a function of the line's parameter t: value + slope * t.
struct Linear {
  double value = 0;
  double slope = 0;
  double at(double t) const { return value + slope * t; }
};

struct Interval {
  double begin = 0;
  double end = 0;
  bool empty() const { return !(begin < end); }
};

// Returns the part of an interval where f >= 0.
inline Interval clip(Interval in, Linear f) {
  if (f.slope == 0.0) return f.value >= 0.0 ? in : Interval{};
  const double root = -f.value / f.slope;
  if (f.slope > 0.0) {
    in.begin = std::max(in.begin, root);
  } else {
    in.end = std::min(in.end, root);
  }
  return in;
}

// Holds the components of start + t direction along a face's axes.
struct ChartLine {
  Linear x;
  Linear y;
  Linear z;

  ChartLine(mars::Face face, const glm::dvec3& start, const glm::dvec3& direction) {
    const mars::FaceAxes& a = mars::face_axes(face);
    x = {glm::dot(a.right, start), glm::dot(a.right, direction)};
    y = {glm::dot(a.up, start), glm::dot(a.up, direction)};
    z = {glm::dot(a.out, start), glm::dot(a.out, direction)};
  }

  // Return functions that are zero on the chart line u = const or v = const and positive beyond it (Z > 0).
  Linear line_u(double u) const { return {x.value - u * z.value, x.slope - u * z.slope}; }
  Linear line_v(double v) const { return {y.value - v * z.value, y.slope - v * z.slope}; }

  // Returns the part of the line inside the face's pyramid.
  Interval in_face(Interval all) const {
    const auto negated = [](Linear f) { return Linear{-f.value, -f.slope}; };
    all = clip(all, z);
    all = clip(all, line_u(-1.0));
    all = clip(all, negated(line_u(1.0)));
    all = clip(all, line_v(-1.0));
    return clip(all, negated(line_v(1.0)));
  }
};

// Holds the two facets of a cell as functions over a line: 1 - Z w, negative where the line is above the
// facet, positive below it, scaled so that it is linear. Here u = line_u and v = line_v of the cell's first
// corner, and w are the inverse depths.
struct CellFacets {
  Linear lower;  // south-east of the diagonal
  Linear upper;
  Linear diagonal;  // positive to the south-east

  CellFacets(const ChartLine& line, const lod::GridLines& lines, const lod::Posts& posts, int i, int j,
             double exaggeration, double radius_m) {
    const auto column = static_cast<std::size_t>(i);
    const auto row = static_cast<std::size_t>(j);
    const double u0 = lines.u[column];
    const double du = lines.u[column + 1] - u0;
    const double v0 = lines.v[row];
    const double dv = lines.v[row + 1] - v0;
    const auto depth = [&](int a, int b) {
      return lod::inverse_depth(lines.u[column + static_cast<std::size_t>(a)],
                                lines.v[row + static_cast<std::size_t>(b)],
                                exaggeration * posts.at(i + a, j + b), radius_m);
    };
    const double w00 = depth(0, 0);
    const double w11 = depth(1, 1);
    const double w10 = depth(1, 0);
    const double w01 = depth(0, 1);
    // Relative to the cell's corner, s = (u - u0) / du and t likewise; w = w00 + ws s + wt t on each triangle.
    const Linear fs = line.line_u(u0);
    const Linear ft = line.line_v(v0);
    const auto facet = [&](double ws, double wt) {
      const double a = ws / du;
      const double b = wt / dv;
      return Linear{1.0 - w00 * line.z.value - a * fs.value - b * ft.value,
                    -w00 * line.z.slope - a * fs.slope - b * ft.slope};
    };
    lower = facet(w10 - w00, w11 - w10);
    upper = facet(w11 - w01, w01 - w00);
    diagonal = {fs.value / du - ft.value / dv, fs.slope / du - ft.slope / dv};
  }
};

// Visits, in order along the line, the up to four pieces into which two grid lines cut a part of it.
// visit(east, north, interval) returns true to stop; the function then returns true. `far` is added to the
// begin of an unbounded piece to get a point inside it; any positive length works.
template <typename Visit>
bool visit_quarters(Interval part, Linear fu, Linear fv, double far, Visit&& visit) {
  std::array<double, 4> cuts{part.begin, part.end, part.end, part.end};
  int count = 1;
  for (const Linear& f : {fu, fv}) {
    const double root = f.slope == 0.0 ? std::numeric_limits<double>::infinity() : -f.value / f.slope;
    if (root > part.begin && root < part.end) cuts[static_cast<std::size_t>(count++)] = root;
  }
  cuts[static_cast<std::size_t>(count)] = part.end;
  if (count == 3 && cuts[1] > cuts[2]) std::swap(cuts[1], cuts[2]);
  for (std::size_t c = 0; c < static_cast<std::size_t>(count); ++c) {
    const Interval piece{cuts[c], cuts[c + 1]};
    if (piece.empty()) continue;
    const double middle = std::isfinite(piece.end) ? 0.5 * (piece.begin + piece.end) : 2.0 * piece.begin + far;
    if (visit(fu.at(middle) >= 0.0, fv.at(middle) >= 0.0, piece)) return true;
  }
  return false;
}

}  // namespace paging
