// Finds segments of lines that meet where they should not.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace vpe::map {

// Holds a straight piece of a line.
struct LinePiece {
  glm::dvec2 begin{0};
  glm::dvec2 end{0};
  bool is_given = false;  // an edge of the line before simplification; two of those are never compared
  bool is_new = true;     // only pairs with a new one are compared
};

// Returns false only if two segments have no point in common but an end of both. Where rounding leaves it open,
// returns true. Pure.
bool may_meet(const LinePiece& a, const LinePiece& b);

// Returns for each segment whether it may meet another one that it is compared with. Ends must be within
// 0..2^31. The result does not depend on `threads`.
std::vector<std::uint8_t> find_conflicts(std::span<const LinePiece> pieces, int threads);

}  // namespace vpe::map
