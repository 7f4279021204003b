// Ways over a height grid that keep to a slope limit at the least cost.
//
// Typical usage:
//   map::RouteOptions options;
//   options.max_slope_deg = 12;
//   const map::Route route = map::find_route(grid, {{10, 20}, {300, 250}}, options, threads);
//   if (route.outcome == map::RouteOutcome::found) draw(route.posts);
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "vpe/map/height_grid.h"

namespace vpe::map {

// Bounds the options below.
struct RouteLimits {
  static constexpr double kLeastSlope_deg = 0.01;
  static constexpr double kMostSlope_deg = 89;
  static constexpr double kMostWeight = 1000;
};

// Holds what a way must keep to.
struct RouteOptions {
  // Limits the slope along the way and the steepest slope of the ground at posts. Larger: shorter ways.
  double max_slope_deg = 15;
  // Limits the slope of the ground across the way, where it is below max_slope_deg. nullopt: it is not limited
  // further.
  std::optional<double> max_cross_slope_deg;
  // A metre at the slope limit costs 1 + this, a metre on level ground 1. Larger: longer ways that are less
  // steep; above 1 they climb steep slopes in zigzags. 0: the shortest way.
  double slope_weight = 1;
};

// Tells whether there is a way, or why not.
enum class RouteOutcome {
  found,
  no_ground,      // at a given post there is nodata
  too_steep,      // the ground at a given post is steeper than the limit
  not_connected,  // the limit separates two given posts
};

// Holds figures of a way or of a part of it.
struct RouteFigures {
  double cost_m = 0;        // length along the ground, each piece times 1 + weight * (grade / limiting grade)^2
  double length_m = 0;      // along the ground
  double map_length_m = 0;  // on the map
  double climb_m = 0;       // sum of all rises
  double descent_m = 0;     // sum of all falls, positive
  double steepest_deg = 0;  // along the way, up or down

  void add(const RouteFigures& next);
};

// Holds a way, or why there is none.
struct Route {
  RouteOutcome outcome = RouteOutcome::found;
  // Of the given posts the one that is unsuited, or at which the leg that has no way begins; 0 if a way was
  // found.
  std::size_t at = 0;
  // The corners of the way, (column, row); the given posts are among them. Empty if there is no way.
  std::vector<glm::ivec2> posts;
  RouteFigures figures;
  double steepest_ground_deg = 0;  // at the corners; with too_steep: at the post `at`
  // With not_connected: area of the posts that can be reached from the post `at`, m^2.
  double reached_m2 = 0;
};

// Finds the way of least cost through two or more posts in their order.
//
// The ground along a straight way is linear between its crossings with the lines of the grid, where heights are
// interpolated between two posts. The grade of each such piece must be within the limit. Grade is rise over
// run, the tangent of the slope. Where a way passes through a cell, all four of its posts must be passable; on
// an edge, both of them. A post is passable if it has a finite height and the steepest of the four planes
// through it and one neighbour in each direction is within the limit. Missing neighbours are left out.
//
// The way is the best of all that lead from post to post by the 16 steps (1, 0), (1, 1), (2, 1) and so on: on
// level ground at most 2.8 % longer than the straight line. Then straight lines between its corners replace
// them where that is allowed and does not cost more. The cost is the same in both directions; the corners may
// differ where ways cost the same.
//
// Memory: a byte a post, and 9 bytes for each post in blocks of 64 x 64 that the search has come to. Calls
// check() from time to time; it may throw to end the search. Any thread may call it; the result does not depend
// on `threads` (0: all cores). Throws std::invalid_argument for options out of their limits, posts outside the
// grid, fewer than two posts, and a grid whose sizes contradict.
//
// Source: Hart, Nilsson and Raphael 1968 (A*).
Route find_route(const HeightGrid& grid, std::span<const glm::ivec2> places, const RouteOptions& options,
                 int threads, const std::function<void()>& check = nullptr);

}  // namespace vpe::map
