// Leaves out points of lines that are not seen to be missing: strokes of many short pieces take most of the time of drawing
// lines.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace vpe::overlay {

// Largest distance between a line and what is drawn of it.
inline constexpr double kStrokeTolerance_px = 0.03;

// Returns the first and the last point and some between, in their order: every other point lies within tolerance_px of the
// straight piece drawn in its place. Larger: fewer points.
std::vector<glm::dvec2> simplified(std::span<const glm::dvec2> points,
                                   double tolerance_px = kStrokeTolerance_px);

}  // namespace vpe::overlay
