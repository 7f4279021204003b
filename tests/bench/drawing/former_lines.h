// Draws lines by Cairo alone, as vpe::overlay::Canvas did before it had a way of its own for thin ones.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "vpe/overlay/overlay.h"

namespace bench {

// Draws open white lines on an image of this size. Writes what was drawn, unless `out` is null.
void draw_by_cairo(std::span<const std::vector<glm::dvec2>> lines, double width_px, glm::ivec2 size,
                   vpe::overlay::Layer* out);

}  // namespace bench
