// Contours of a height grid: lines of equal height, by marching squares.
//
// Typical usage:
//   map::ContourOptions options;
//   options.interval_m = 50;
//   for (const map::ContourLine& line : map::contours(grid, options, threads)) write(line);
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "vpe/map/height_grid.h"

namespace vpe::map {

// Holds a contour. Points are (column, row) of the grid; posts lie at integers. Higher ground lies on the right
// of who follows the line on the map, so that rings around summits run clockwise with north up.
struct ContourLine {
  std::int64_t multiple = 0;  // level_m = base + multiple * interval
  double level_m = 0;
  bool is_closed = false;
  std::vector<glm::dvec2> points;  // at least two; a closed line does not repeat its first point
};

// Bounds the number of different levels between the lowest and the highest post.
inline constexpr double kMostContourLevels = 1e6;

// Holds which lines contours() makes.
struct ContourOptions {
  double interval_m = 100;  // between levels, > 0. Smaller: more lines
  double base_m = 0;        // a level; the others are multiples of the interval from it
  // Largest distance between a line and its simplified one, metres. Larger: fewer points. 0: no simplification.
  double tolerance_m = 0;
  // Largest number of points before simplification. Larger: more memory, some 50 bytes a point.
  std::size_t most_points = 200'000'000;
};

// Computes the contours of a grid, in ascending order of levels. Any thread may call it; the result does not
// depend on `threads` (0: all cores).
//
// Lines cross edges between neighbouring posts where linear interpolation on the edge has the level. They are
// straight in between. In a cell with two high posts on a diagonal, the mean of its four posts decides which
// ones are connected. A post exactly at a level counts as above it: a line passes through such a post if there
// is lower ground beside it, and level ground at a level has a line at its lower side only. A ridge of posts at
// a level that is one post wide has a line there and back; a single such post has none. Lines do not branch and
// do not cross each other. They may touch, at posts that are exactly at their level.
//
// Cells with a post that is NaN or infinite have no lines. Open lines end at such cells and at the border.
//
// With a tolerance, lines are simplified by simplify_contours(). Throws std::invalid_argument for options out
// of their limits, more than kMostContourLevels levels, levels that doubles cannot tell apart, and a grid whose
// sizes contradict; std::length_error for more than `most_points` points.
//
// Source: the cases of Lorensen and Cline 1987 in two dimensions; Nielson and Hamann 1991 on ambiguous cells.
std::vector<ContourLine> contours(const HeightGrid& grid, const ContourOptions& options, int threads);

// Returns the length of a line, in posts.
double length_posts(const ContourLine& line);

}  // namespace vpe::map
