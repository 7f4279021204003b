// The posts of one tile, and the reference surface S over them: the exact surface as flat triangles.
//
// A tile of 2^k intervals has (2^k + 1)^2 posts on the grid lines of its face. Post (i, j) is stored at j *
// (2^k + 1) + i, i along the face's right axis, j along its up axis. Post P = (R + h) * p / |p| with the cube
// point p = (u, v, 1). Seen from the planet's centre a flat triangle is a plane in the chart: the inverse face
// depth w = |p| / (R + h) = 1 / Z is affine in (u, v) over it (docs/design/rays.md; a point at chart (u, v) has
// radius |p| / w). S splits every cell along the diagonal from (i, j) to (i + 1, j + 1).
//
// Typical usage:
//   const GridLines lines = grid_lines(posts.key, posts.intervals);
//   const double height_m = surface_height(posts, lines, point.u, point.v, radius_m);
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "lod/tree/tile_key.h"

namespace lod {

// The number of posts in each tile of a planet file.
struct TileShape {
  int k = 7;
  int intervals() const { return 1 << k; }
  int posts() const { return (1 << k) + 1; }
  int post_count() const { return posts() * posts(); }
};

// Holds the decoded posts of one tile: heights in metres above the sphere.
struct Posts {
  TileKey key;
  int intervals = 0;  // 2^k (tiles) or 2^(k+1) (the mesh grid of a parent)
  std::vector<double> height_m;

  int side() const { return intervals + 1; }
  double at(int i, int j) const {
    return height_m[static_cast<std::size_t>(j) * static_cast<std::size_t>(side()) +
                    static_cast<std::size_t>(i)];
  }
};

// Chart coordinates of a grid's lines: u of columns, v of rows. Exact (mars::face_line).
struct GridLines {
  std::vector<double> u;
  std::vector<double> v;
};
GridLines grid_lines(const TileKey& key, int intervals);

// Returns the post spacing on the sphere at the middle of a face, metres: the number that is shown to users.
double post_spacing_m(int level, int intervals, double radius_m);

// Returns the inverse face depth of a post.
inline double inverse_depth(double u, double v, double height_m, double radius_m) {
  return std::sqrt(u * u + v * v + 1.0) / (radius_m + height_m);
}

// Returns the height of S at a chart point of the tile (clamped to it), metres above the sphere: the height of
// the facet through its posts with their heights times `exaggeration`. That is not the exaggerated height of
// the facet, because its sagitta does not grow. Writes the normal of the facet (outward, unit, body-fixed) if
// `normal` is not null.
//
// Differences are formed before they are rounded. With d the chart side of the cell and h its largest |height|,
// the error of the height is at most kHeightError * (R d + h) and that of the normal kNormalError * (1 + h / (R
// d)) rad.
inline constexpr double kHeightError = 1e-15;
inline constexpr double kNormalError = 2e-15;
double surface_height(const Posts& posts, const GridLines& lines, double u, double v, double radius_m,
                      glm::dvec3* normal = nullptr, double exaggeration = 1.0);

// Returns an upper bound of the tangent of the slope of the facets over the posts, relative to the vertical at
// any of their points.
double steepest_slope(const Posts& posts, const GridLines& lines, double radius_m);

// Moves the posts of one edge onto the flat edges of the grid that keeps every `step`-th of them, so that a
// tile meets a coarser neighbour without a crack. `step` is a power of two, at most the number of intervals.
// The moved posts are within kHeightError * (R step d + h) of the coarse edge. With an exaggeration (> 0) they
// lie on the edge when all heights are drawn times that factor; these are other heights, because an edge's
// sagitta does not grow.
void constrain_edge(Posts& posts, const GridLines& lines, Edge edge, int step, double radius_m,
                    double exaggeration = 1.0);

}  // namespace lod
