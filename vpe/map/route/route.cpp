#include "vpe/map/route/route.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "vpe/map/route/route_search.h"

namespace vpe::map {

namespace {

double slope_of_grade_deg(double grade) { return std::atan(grade) * 180 / std::numbers::pi; }

}  // namespace

void RouteFigures::add(const RouteFigures& next) {
  cost_m += next.cost_m;
  length_m += next.length_m;
  map_length_m += next.map_length_m;
  climb_m += next.climb_m;
  descent_m += next.descent_m;
  steepest_deg = std::max(steepest_deg, next.steepest_deg);
}

Route find_route(const HeightGrid& grid, std::span<const glm::ivec2> places, const RouteOptions& options,
                 int threads, const std::function<void()>& check) {
  const RouteGround ground(grid, options, threads);
  if (places.size() < 2) throw std::invalid_argument("find_route: a way needs two posts or more");
  Route route;
  for (std::size_t n = 0; n < places.size(); ++n) {
    if (!ground.is_inside(places[n]))
      throw std::invalid_argument("find_route: post " + std::to_string(n) + " is outside the grid");
    if (route.outcome != RouteOutcome::found || ground.is_passable(places[n])) continue;
    const bool is_nodata = !std::isfinite(grid.at(places[n].x, places[n].y));
    route.outcome = is_nodata ? RouteOutcome::no_ground : RouteOutcome::too_steep;
    route.at = n;
    if (!is_nodata) route.steepest_ground_deg = slope_of_grade_deg(ground.steepest_grade(places[n]));
  }
  if (route.outcome != RouteOutcome::found) return route;

  std::vector<glm::ivec2> corners{places[0]};
  for (std::size_t n = 0; n + 1 < places.size(); ++n) {
    const SearchResult leg = search_route(ground, places[n], places[n + 1], check);
    if (leg.posts.empty()) {
      route.outcome = RouteOutcome::not_connected;
      route.at = n;
      route.reached_m2 = static_cast<double>(leg.reached) * grid.spacing_m * grid.spacing_m;
      return route;
    }
    const std::vector<glm::ivec2> straight = straighten(ground, leg.posts, check);
    corners.insert(corners.end(), straight.begin() + 1, straight.end());
  }
  route.posts = std::move(corners);
  for (std::size_t n = 0; n < route.posts.size(); ++n) {
    if (n > 0) route.figures.add(*ground.straight(route.posts[n - 1], route.posts[n]));
    route.steepest_ground_deg =
        std::max(route.steepest_ground_deg, slope_of_grade_deg(ground.steepest_grade(route.posts[n])));
  }
  return route;
}

}  // namespace vpe::map
