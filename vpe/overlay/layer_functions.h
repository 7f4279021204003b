// The overlays one by one. Each takes the room it uses on the sheet; what finds none is left out.
#pragma once

#include "vpe/overlay/label_layout.h"
#include "vpe/overlay/visible_terrain.h"

namespace vpe::overlay {

// Lines over the ground, and the labels that they get once everything else has its place.
struct LineLabel {
  std::string text;
  glm::dvec2 at;
  double angle_rad;
  Lettering style;
};
std::vector<LineLabel> draw_graticule(LabelLayout& layout, const VisibleTerrain& ground, double step_deg);
std::vector<LineLabel> draw_contours(LabelLayout& layout, const VisibleTerrain& ground, double step_m);
// In gaps of the lines. Labels of the same text keep a distance.
void draw_labels(LabelLayout& layout, const std::vector<LineLabel>& labels);

void draw_title(LabelLayout& layout, const std::string& title);
void draw_time(LabelLayout& layout, double time_s);
void draw_legend(LabelLayout& layout, const Scene& scene);
void draw_scale_bar(LabelLayout& layout, const VisibleTerrain& ground);
void draw_north_arrow(LabelLayout& layout, const VisibleTerrain& ground);
// Takes the edge for itself. With `distances` a name has its distance beside it (name_text()).
void draw_compass(LabelLayout& layout, const Scene& scene, core::CompassStrip where);
void draw_names(LabelLayout& layout, const VisibleTerrain& ground, bool distances);

}  // namespace vpe::overlay
