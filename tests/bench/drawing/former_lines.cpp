#include "tests/bench/drawing/former_lines.h"

#include "vpe/overlay/stroke_mask.h"

namespace vpe::overlay {
constexpr double kNoLineIsThin_px = -1;
}

// Compiles the canvas once more, under other names, with no line thin enough for the mask.
#define kWidestThinLine_px kNoLineIsThin_px
#define Canvas CairoCanvas
#define printable_utf8 printable_utf8_for_cairo
#include "vpe/overlay/canvas.cpp"

namespace bench {

void draw_by_cairo(std::span<const std::vector<glm::dvec2>> lines, double width_px, glm::ivec2 size,
                   vpe::overlay::Layer* out) {
  vpe::overlay::CairoCanvas canvas(size.x, size.y);
  for (const std::vector<glm::dvec2>& line : lines) canvas.line(line, false, width_px, {1, 1, 1, 1});
  if (out != nullptr) *out = canvas.layer();
}

}  // namespace bench
