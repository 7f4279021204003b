// Finds the way of least cost between two posts, step by step, and straightens it.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <vector>

#include "vpe/map/route/route_ground.h"

namespace vpe::map {

// Holds a way from post to post.
struct SearchResult {
  std::vector<glm::ivec2> posts;  // from the first to the last one; empty if they are not connected
  double cost_m = 0;
  std::size_t reached = 0;  // posts of known least cost; if there is no way, all that can be reached
};

// Searches by A* with the 16 steps. Both posts must be passable. Calls check() each 4096 posts unless it is
// empty. Deterministic; of ways of equal cost it takes one by the order of posts.
SearchResult search_route(const RouteGround& ground, glm::ivec2 from, glm::ivec2 to,
                          const std::function<void()>& check);

// Leaves out posts where the straight way between others is allowed and does not cost more. Ends stay. The way
// costs at most as much as before, up to rounding.
std::vector<glm::ivec2> straighten(const RouteGround& ground, std::vector<glm::ivec2> posts,
                                   const std::function<void()>& check);

}  // namespace vpe::map
