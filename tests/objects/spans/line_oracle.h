// Lines against all triangles of a mesh by brute force, and meshes with overhangs: the oracle of spans and
// surfaces.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>
#include <vector>

#include "objects/model/shapes.h"

namespace objects::line_oracle {

using Triangle = std::array<glm::dvec3, 3>;

// Returns the triangles of a mesh at a place: x = at + turned * x_model.
inline std::vector<Triangle> placed(const Mesh& mesh, const glm::dmat3& turned, const glm::dvec3& at) {
  std::vector<Triangle> out;
  const bool is_mirrored = glm::determinant(turned) < 0;
  for (const glm::uvec3& t : mesh.triangles) {
    Triangle& made = out.emplace_back();
    for (int k = 0; k < 3; ++k)
      made[static_cast<std::size_t>(k)] = at + turned * glm::dvec3(mesh.positions_m[t[k]]);
    if (is_mirrored) std::swap(made[1], made[2]);
  }
  return out;
}

// A top if the line leaves a solid there, else an underside.
struct Meeting {
  double t = 0;
  bool is_top = true;
};

// Returns where a line enters and leaves the union of closed meshes, ascending, by winding numbers in double
// precision. Gaps and solids shorter than `least` are left out.
inline std::vector<Meeting> meetings(const std::vector<Triangle>& triangles, const glm::dvec3& origin,
                                     const glm::dvec3& direction, double least) {
  std::vector<Meeting> all;
  for (const Triangle& t : triangles) {
    // The sides of the line on which the edges lie, as volumes of tetrahedra.
    const glm::dvec3 a = t[0] - origin;
    const glm::dvec3 b = t[1] - origin;
    const glm::dvec3 c = t[2] - origin;
    const double u = glm::dot(direction, glm::cross(b, c));
    const double v = glm::dot(direction, glm::cross(c, a));
    const double w = glm::dot(direction, glm::cross(a, b));
    if (std::min({u, v, w}) < 0 && std::max({u, v, w}) > 0) continue;
    const double sum = u + v + w;
    if (sum == 0) continue;
    all.push_back({glm::dot(u * a + v * b + w * c, direction) / sum / glm::dot(direction, direction), sum > 0});
  }
  std::sort(all.begin(), all.end(), [](const Meeting& a, const Meeting& b) { return a.t < b.t; });
  std::vector<Meeting> out;
  int depth = 0;
  for (const Meeting& m : all) {
    const int before = depth;
    depth += m.is_top ? -1 : 1;
    if ((before > 0) == (depth > 0)) continue;
    if (!out.empty() && m.t - out.back().t < least) {
      out.pop_back();
    } else {
      out.push_back(m);
    }
  }
  return out;
}

// Holds what lines around a line meet.
struct Neighbourhood {
  bool is_clear = true;     // voxels of an edge change neither the number of meetings nor their sides
  std::vector<double> low;  // of each meeting: the least and the largest t
  std::vector<double> high;
};

// Compares the meetings of a line of a unit direction with those of 24 lines beside it, up to three edges of a
// voxel away. It is clear if all have as many, solids and gaps are longer than six edges, and surfaces are
// slanted by less than 60 degrees.
inline Neighbourhood neighbourhood(const std::vector<Triangle>& triangles, const glm::dvec3& origin,
                                   const glm::dvec3& direction, double edge, double least) {
  constexpr int kLines = 12;
  constexpr double kReach = 3;
  constexpr double kLeastLength = 6;
  constexpr double kTangent = 1.73;
  Neighbourhood out;
  for (const Meeting& m : meetings(triangles, origin, direction, least)) out.low.push_back(m.t);
  out.high = out.low;
  const glm::dvec3 across = std::abs(direction.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 side = glm::normalize(glm::cross(direction, across));
  for (int k = 0; k < 2 * kLines; ++k) {
    const double angle = 2 * 3.14159265358979 * k / kLines;
    const double away = kReach * edge * (k < kLines ? 0.5 : 1);
    const glm::dvec3 beside = away * (std::cos(angle) * side + std::sin(angle) * glm::cross(direction, side));
    const std::vector<Meeting> near = meetings(triangles, origin + beside, direction, least);
    out.is_clear = out.is_clear && near.size() == out.low.size();
    for (std::size_t m = 0; out.is_clear && m < near.size(); ++m) {
      out.is_clear = m == 0 || near[m].t - near[m - 1].t > kLeastLength * edge;
      out.low[m] = std::min(out.low[m], near[m].t);
      out.high[m] = std::max(out.high[m], near[m].t);
    }
  }
  for (std::size_t m = 0; m < out.low.size(); ++m)
    out.is_clear = out.is_clear && out.high[m] - out.low[m] < 2 * kReach * edge * kTangent;
  return out;
}

// Returns the distance of a place from a triangle (Ericson 2005, section 5.1.5).
inline double distance(const Triangle& t, const glm::dvec3& p) {
  const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  bool is_above = glm::length(normal) > 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 from = t[k];
    const glm::dvec3 edge = t[(k + 1) % 3] - from;
    const double along =
        std::clamp(glm::dot(p - from, edge) / std::max(glm::dot(edge, edge), 1e-300), 0.0, 1.0);
    nearest = std::min(nearest, glm::distance(p, from + along * edge));
    is_above = is_above && glm::dot(glm::cross(normal, edge), p - from) >= 0;
  }
  if (is_above) nearest = std::abs(glm::dot(p - t[0], glm::normalize(normal)));
  return nearest;
}

inline double distance(const std::vector<Triangle>& triangles, const glm::dvec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : triangles) nearest = std::min(nearest, distance(t, p));
  return nearest;
}

// Returns an arch of three boxes, which touch: 24 m wide, 6 m deep, 14 m high, with a gate of 16 m by 10 m.
inline Mesh arch() {
  const Rgba stone{150, 120, 100, 255};
  Mesh mesh;
  append(mesh, make_box({4, 6, 10}), glm::translate(glm::mat4(1), {-10, 0, 0}), stone);
  append(mesh, make_box({4, 6, 10}), glm::translate(glm::mat4(1), {10, 0, 0}), stone);
  append(mesh, make_box({24, 6, 4}), glm::translate(glm::mat4(1), {0, 0, 10}), stone);
  return mesh;
}

// Returns a sphere around the origin of rings of latitude and segments of longitude.
inline Mesh uv_sphere(double radius_m, unsigned rings, unsigned segments) {
  constexpr double kPi = 3.14159265358979323846;
  Mesh mesh;
  for (unsigned r = 0; r <= rings; ++r) {
    for (unsigned s = 0; s < segments; ++s) {
      const double lat = kPi * (static_cast<double>(r) / rings - 0.5);
      const double lon = 2 * kPi * s / segments;
      const double across = r == 0 || r == rings ? 0 : std::cos(lat);
      mesh.positions_m.emplace_back(radius_m * across * std::cos(lon), radius_m * across * std::sin(lon),
                                    radius_m * std::sin(lat));
    }
  }
  for (unsigned r = 0; r < rings; ++r) {
    for (unsigned s = 0; s < segments; ++s) {
      const unsigned a = r * segments + s;
      const unsigned b = r * segments + (s + 1) % segments;
      if (r > 0) mesh.triangles.emplace_back(a, b, b + segments);
      if (r + 1 < rings) mesh.triangles.emplace_back(a, b + segments, a + segments);
    }
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  mesh.material_table = {Material{}};
  return mesh;
}

// Returns one closed surface around the cells that is_solid(x, y, z) accepts, between lines of a grid.
inline Mesh of_cells(const std::vector<float>& x_m, const std::vector<float>& y_m,
                     const std::vector<float>& z_m, const std::function<bool(int, int, int)>& is_solid) {
  const glm::ivec3 cells(static_cast<int>(x_m.size()) - 1, static_cast<int>(y_m.size()) - 1,
                         static_cast<int>(z_m.size()) - 1);
  Mesh mesh;
  for (int z = 0; z <= cells.z; ++z)
    for (int y = 0; y <= cells.y; ++y)
      for (int x = 0; x <= cells.x; ++x)
        mesh.positions_m.emplace_back(x_m[static_cast<std::size_t>(x)], y_m[static_cast<std::size_t>(y)],
                                      z_m[static_cast<std::size_t>(z)]);
  const auto vertex = [&](const glm::ivec3& p) {
    return static_cast<unsigned>((p.z * (cells.y + 1) + p.y) * (cells.x + 1) + p.x);
  };
  const auto holds = [&](const glm::ivec3& p) {
    for (int k = 0; k < 3; ++k)
      if (p[k] < 0 || p[k] >= cells[k]) return false;
    return is_solid(p.x, p.y, p.z);
  };
  for (int n = 0; n < cells.x * cells.y * cells.z; ++n) {
    const glm::ivec3 at(n % cells.x, n / cells.x % cells.y, n / cells.x / cells.y);
    if (!holds(at)) continue;
    for (int k = 0; k < 3; ++k) {
      for (const int sign : {-1, 1}) {
        glm::ivec3 step(0);
        step[k] = sign;
        if (holds(at + step)) continue;
        glm::ivec3 u(0);
        glm::ivec3 v(0);
        u[(k + 1) % 3] = 1;
        v[(k + 2) % 3] = 1;
        if (sign < 0) std::swap(u, v);
        const glm::ivec3 corner = sign > 0 ? at + step : at;
        mesh.triangles.emplace_back(vertex(corner), vertex(corner + u), vertex(corner + u + v));
        mesh.triangles.emplace_back(vertex(corner), vertex(corner + u + v), vertex(corner + v));
      }
    }
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  mesh.material_table = {Material{}};
  return mesh;
}

// Returns a closed surface in the form of a C with two shelves below its upper arm: 24 m wide, 9 m deep, 26 m
// high.
inline Mesh overhang() {
  return of_cells({-12, -6, 2, 8, 12}, {-4, 0, 5}, {0, 5, 10, 12, 20, 26}, [](int x, int y, int z) {
    if (x == 0 || z == 4) return true;  // the spine and the upper arm
    if (z == 0) return x < 3;           // the lower arm
    return z == 2 && x == 1 && y == 0;  // a shelf
  });
}

}  // namespace objects::line_oracle
