// Maps the sphere to six cube faces whose grids are tangent-warped at 32 knots.
//
// A face has body axes (right, up, out) with right x up = out. A direction d on it has chart coordinates (u, v)
// = (d.right, d.up) / d.out in [-1, 1]. The chart is gnomonic: great circles, and flat triangles seen from the
// planet's centre, are straight. A grid of 2^n intervals a side has its lines at face_line(index, n). The
// tangent warp u = tan((2 s - 1) pi / 4) holds at the 33 knots s = k / 32; between the knots the lines are
// evenly spaced. Hence cells have nearly equal size, posts nest from grid to grid, and from 32 intervals on
// every 32nd part of a face is an even gnomonic grid.
//
// Every line coordinate is a dyadic rational that a double holds exactly up to n = kMaxGridLevel, and the warp
// is odd about the middle of the face. So a point on a cube edge or corner has bit-identical coordinates (up to
// exact sign changes) from each face that shares it: cube_point() returns equal bits.
//
// Typical usage:
//   const ChartPoint p = chart_point(direction({137.4, -4.6}));
//   const double u0 = face_line(3, 4);  // fourth of the 17 lines of a grid of 16 x 16 cells
//   const glm::dvec3 d = chart_direction(p.face, u0, p.v);
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace mars {

enum class Face : std::uint8_t { kPlusX, kPlusY, kMinusX, kMinusY, kPlusZ, kMinusZ };
inline constexpr int kFaces = 6;
inline constexpr int kWarpKnots = 32;
inline constexpr int kMaxGridLevel = 35;

// Bound the cells of a fine grid over a face: sides relative to a quarter circle / 2^n, areas relative to a
// sixth of the sphere / 4^n, and the ratio of the longer to the shorter side. (With evenly spaced gnomonic
// lines the areas would vary by 1 : 5.2.)
inline constexpr double kCellSideMin = 0.707;
inline constexpr double kCellSideMax = 1.047;
inline constexpr double kCellAreaMin = 0.793;
inline constexpr double kCellAreaMax = 1.183;
inline constexpr double kCellAspectMax = 1.414;

struct FaceAxes {
  glm::dvec3 right;
  glm::dvec3 up;
  glm::dvec3 out;
};

// Returns the axes of a face. On equatorial faces right is east and up is north at the face's centre. On both
// polar faces right is +Y.
const FaceAxes& face_axes(Face face);

// Returns the chart coordinate of grid line `index` of 2^grid_level intervals, 0 <= index <= 2^grid_level,
// grid_level <= kMaxGridLevel. The result is exact: a multiple of 2^-50.
double face_line(std::int64_t index, int grid_level);

// Bounds the difference between u and the warp of face_parameter(u).
inline constexpr double kFaceParameterError = 4e-16;

// Returns the inverse of the warp: s in [0, 1] for u in [-1, 1] (clamped). Exact at the knots, never
// decreasing.
double face_parameter(double u);

// Returns the point of the cube (|x|, |y| or |z| = 1) at chart coordinates of a face. Exact for grid lines.
inline glm::dvec3 cube_point(Face face, double u, double v) {
  const FaceAxes& a = face_axes(face);
  // Each component is one of u, v, +-1 up to sign: products with 0 and +-1 and sums with 0 are exact.
  return a.right * u + a.up * v + a.out;
}

// Returns the length of a cube point, summed in the order x, y, z so that all faces give equal bits.
inline double cube_length(const glm::dvec3& p) { return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z); }

// Bounds the errors of angle and length of chart_direction().
inline constexpr double kChartDirectionError_rad = 3e-16;

// Returns the unit vector of a chart point: the same bits from every face that shares the point.
inline glm::dvec3 chart_direction(Face face, double u, double v) {
  const glm::dvec3 p = cube_point(face, u, v);
  const double length = cube_length(p);
  return {p.x / length, p.y / length, p.z / length};
}

struct ChartPoint {
  Face face = Face::kPlusX;
  double u = 0;
  double v = 0;
};

// Describes a rectangle of a face's chart, u0 < u1, v0 < v1.
struct ChartRect {
  Face face = Face::kPlusX;
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
};

// Bounds the angular error of chart_point().
inline constexpr double kChartPointError_rad = 1e-16;

// Returns the chart point of any finite non-zero vector, |u| and |v| <= 1. Exact for cube points. On a shared
// edge the face that comes first in Face is chosen.
ChartPoint chart_point(const glm::dvec3& d);

// Returns (u, v) of a vector on a given face, also outside [-1, 1]. The component along face.out must be
// positive.
inline ChartPoint chart_on(Face face, const glm::dvec3& d) {
  const FaceAxes& a = face_axes(face);
  const double out = glm::dot(a.out, d);
  return {face, glm::dot(a.right, d) / out, glm::dot(a.up, d) / out};
}

}  // namespace mars
