#include "vpe/overlay/label_layout.h"

#include <algorithm>
#include <cmath>

namespace vpe::overlay {

Box Box::about(glm::dvec2 centre, TextSize size, double angle_rad) {
  const double c = std::abs(std::cos(angle_rad));
  const double s = std::abs(std::sin(angle_rad));
  const double x = 0.5 * (c * size.width + s * size.height);
  const double y = 0.5 * (s * size.width + c * size.height);
  return {centre.x - x, centre.y - y, centre.x + x, centre.y + y};
}

LabelLayout::LabelLayout(Canvas& canvas)
    : LabelLayout(canvas, std::min(canvas.width(), canvas.height()) / 720.0) {}

LabelLayout::LabelLayout(Canvas& canvas, double unit)
    : canvas_(canvas),
      unit_(unit),
      area_{0, 0, static_cast<double>(canvas.width()), static_cast<double>(canvas.height())} {}

double LabelLayout::line_px(double at_720) const { return std::max(px(at_720), 0.75 * at_720); }

Font LabelLayout::font(double at_720, bool bold) const {
  // Smaller letters are not legible in images of any size.
  return {std::max(px(at_720), 0.7 * at_720), bold};
}

bool LabelLayout::is_free(const Box& box) const {
  if (box.left < area_.left || box.top < area_.top || box.right > area_.right || box.bottom > area_.bottom)
    return false;
  return std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) { return box.meets(other); });
}

void LabelLayout::label(std::string_view text, glm::dvec2 centre, const Font& font) {
  canvas_.text(text, centre, 0, {font, kWhite, kShade});
}

void LabelLayout::outlined(const std::vector<glm::dvec2>& points, double width_px, const Ink& ink,
                           const Ink& halo) {
  canvas_.line(points, false, width_px + 2 * line_px(1), halo);
  canvas_.line(points, false, width_px, ink);
}

}  // namespace vpe::overlay
