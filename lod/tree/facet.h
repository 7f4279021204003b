// One flat triangle of the reference surface, found once for many places on it.
//
// surface_height() of posts.h is made of these functions, so both give the same bits.
//
// Typical usage:
//   const Facet facet = facet_at(posts, lines, u, v, radius_m);
//   const glm::dvec3 normal = facet.normal(posts.key.face);
//   if (facet.contains(other_u, other_v)) height_m = facet.height_m(other_u, other_v, radius_m);
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

#include "lod/tree/posts.h"

namespace lod {

// Holds a facet: its cell, and the plane that it is in the chart.
struct Facet {
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;  // lines of its cell
  bool lower = false;                     // below the cell's diagonal, which is part of it
  // R w of inverse_depth() at the post (u0, v0) is length - deficit, and grows by the slopes.
  double length = 1;
  double deficit = 0;
  double slope_u = 0;
  double slope_v = 0;

  // Returns how far a place lies on the lower side of the diagonal, times the diagonal's length in the chart.
  double below_diagonal(double u, double v) const { return (u - u0) * (v1 - v0) - (v - v0) * (u1 - u0); }

  // Returns true if facet_at() of a place in the tile gives this facet. May return false on the last line of a tile.
  bool contains(double u, double v) const {
    return u >= u0 && u < u1 && v >= v0 && v < v1 && ((u - u0) * (v1 - v0) >= (v - v0) * (u1 - u0)) == lower;
  }

  // Returns whether all places within `margin` of one on the facet are on it, in both chart coordinates.
  bool contains_around(double u, double v, double margin) const {
    const double nearest = std::min(std::min(u - u0, u1 - u), std::min(v - v0, v1 - v));
    return nearest > margin && std::abs(below_diagonal(u, v)) > margin * (u1 - u0 + v1 - v0);
  }

  // Returns the height at a place of the facet, metres above the sphere.
  double height_m(double u, double v, double radius_m) const;

  // Returns the outward unit normal, body-fixed.
  glm::dvec3 normal(mars::Face face) const;
};

// Returns the facet at a chart point of the tile, clamped to it, with the heights of posts times `exaggeration`.
Facet facet_at(const Posts& posts, const GridLines& lines, double u, double v, double radius_m,
               double exaggeration = 1.0);

}  // namespace lod
