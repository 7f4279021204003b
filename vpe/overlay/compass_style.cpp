#include "vpe/overlay/compass_style.h"

#include <array>
#include <cmath>

#include "vpe/overlay/layer_functions.h"

namespace vpe::overlay {

double CompassStyle::label_px(const Canvas& canvas, double px_per_deg) const {
  const Font figure = font(CompassRank::kFigure);
  const auto width_px = [&](const char* text) {
    return canvas.measure(text, figure).width + 0.5 * figure.size_px;
  };
  const double whole_px = width_px("000\u00b0");
  // Figures below one degree have decimals.
  return compass_steps(px_per_deg, whole_px).figure_deg >= 1 ? whole_px : width_px("000.000\u00b0");
}

glm::dvec2 CompassStyle::label_centre(glm::dvec2 at) const {
  const double away_px = tick_px(CompassRank::kFigure) + 0.7 * font(CompassRank::kFigure).size_px;
  return {at.x, at.y + (is_up ? -away_px : away_px)};
}

Box CompassStyle::label_box(const Canvas& canvas, glm::dvec2 at, const CompassMark& mark) const {
  return Box::about(label_centre(at), canvas.measure(mark.label, font(mark.rank)));
}

Box CompassStyle::tick_box(glm::dvec2 at, const CompassMark& mark) const {
  const double half_px = 1.5 * line_px();
  const double length_px = tick_px(mark.rank);
  return {at.x - half_px, is_up ? at.y - length_px : at.y, at.x + half_px, is_up ? at.y : at.y + length_px};
}

void CompassStyle::draw_tick(Canvas& canvas, glm::dvec2 at, const CompassMark& mark) const {
  const Box box = tick_box(at, mark);
  const std::array<glm::dvec2, 2> line{glm::dvec2{at.x, box.top}, glm::dvec2{at.x, box.bottom}};
  canvas.line(line, false, 3 * line_px(), kShade);
  canvas.line(line, false, line_px(), kWhite);
}

void CompassStyle::draw_label(Canvas& canvas, glm::dvec2 at, const CompassMark& mark) const {
  canvas.text(mark.label, label_centre(at), 0, {font(mark.rank), kWhite, kShade});
}

void draw_compass(LabelLayout& layout, const Scene& scene, core::CompassStrip where) {
  constexpr double kPole = 1e-7;
  Canvas& canvas = layout.canvas();
  const core::View& view = scene.view;
  const glm::dvec3& camera_m = view.camera.position_m;
  if (!scene.frame && std::hypot(camera_m.x, camera_m.y) < kPole * scene.radius_m) return;
  const mars::LocalFrame frame = scene.frame ? *scene.frame : mars::local_frame(mars::lon_lat(camera_m));
  CompassStyle style{layout.px(1)};
  const double px_per_deg = view.projection == core::Projection::kPerspective
                                ? core::focal_px(view) * mars::kRadiansPerDegree
                                : view.width / 360.0;
  const double label_px = style.label_px(canvas, px_per_deg);
  std::vector<PlacedMark> marks;
  if (where == core::CompassStrip::kHorizon) marks = compass_horizon(view, frame, label_px);
  const bool is_horizon = !marks.empty();
  if (!is_horizon) {
    marks = compass_row(view, frame, label_px);
    if (marks.empty()) return;
    style.is_up = where == core::CompassStrip::kTop;
    const Box area = layout.area();
    const double height_px = std::ceil(style.height_px());
    if (2 * height_px > area.bottom - area.top) return;
    const Box band = style.is_up ? Box{area.left, area.top, area.right, area.top + height_px}
                                 : Box{area.left, area.bottom - height_px, area.right, area.bottom};
    const std::array<glm::dvec2, 4> corners{glm::dvec2{band.left, band.top}, glm::dvec2{band.right, band.top},
                                            glm::dvec2{band.right, band.bottom},
                                            glm::dvec2{band.left, band.bottom}};
    canvas.clear({0.5 * (band.left + band.right), 0.5 * (band.top + band.bottom)},
                 {band.right - band.left, height_px}, 0);
    canvas.polygon(corners, kCompassBand);
    for (PlacedMark& m : marks) m.at.y = style.is_up ? band.bottom : band.top;
  }
  if (is_horizon) {
    const auto line = horizon_line(view, frame);
    layout.outlined({line->left, line->right}, style.line_px(), kWhite, kShade);
  }
  for (const PlacedMark& m : marks) style.draw_tick(canvas, m.at, m.mark);
  for (const PlacedMark& m : marks) {
    if (m.mark.rank == CompassRank::kTick) continue;
    const Box box = style.label_box(canvas, m.at, m.mark);
    if (!layout.is_free(box)) continue;
    layout.take(box);
    style.draw_label(canvas, m.at, m.mark);
  }
  if (!is_horizon) {
    if (style.is_up) layout.cut_top(std::ceil(style.height_px()));
    if (!style.is_up) layout.cut_bottom(std::ceil(style.height_px()));
  }
}

}  // namespace vpe::overlay
