// The ground as a way sees it: which posts are passable, what straight pieces cost.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "vpe/map/route/route.h"

namespace vpe::map {

// Evaluates straight ways between posts of a grid, which must outlive it. Any thread may call const members.
class RouteGround {
 public:
  // Computes which posts are passable. Throws as find_route().
  RouteGround(const HeightGrid& grid, const RouteOptions& options, int threads);

  const HeightGrid& grid() const { return grid_; }
  bool is_inside(glm::ivec2 post) const;
  bool is_passable(glm::ivec2 post) const { return passable_[index(post)] != 0; }
  std::size_t index(glm::ivec2 post) const;

  // Returns the tangent of the steepest slope at a post with a finite height.
  double steepest_grade(glm::ivec2 post) const;

  // Returns the figures of the straight way between two posts inside the grid, or nullopt if a limit forbids
  // it.
  std::optional<RouteFigures> straight(glm::ivec2 from, glm::ivec2 to) const;

  // Returns a lower bound of the cost between two posts by the search's steps. It is 0 for a post and itself,
  // and obeys the triangle inequality.
  double least_cost_m(glm::ivec2 from, glm::ivec2 to) const;

 private:
  struct Crossing;
  bool add_piece(const Crossing& begin, const Crossing& end, RouteFigures& figures,
                 double& steepest_grade) const;
  double cross_grade(const Crossing& begin, const Crossing& end) const;
  bool is_cell_passable(int column, int row) const;

  const HeightGrid& grid_;
  double limit_grade_ = 0;
  double most_grade_ = 0;        // with room for rounding
  double most_cross_grade_ = 0;  // infinity: no limit of its own
  double slope_weight_ = 0;
  std::vector<std::uint8_t> passable_;
};

}  // namespace vpe::map
