// One function for each overlay. Each records the boxes that it uses in the layout and draws nothing that does
// not find room.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vpe/overlay/label_layout.h"
#include "vpe/overlay/visible_terrain.h"

namespace vpe::overlay {

// Describes a label of a line over the terrain. Labels are drawn after all other overlays have their boxes.
struct LineLabel {
  std::string text;
  glm::dvec2 at;
  double angle_rad;
  Lettering style;
};

// Draw lines and return their labels.
std::vector<LineLabel> draw_graticule(LabelLayout& layout, const VisibleTerrain& terrain, double step_deg);
std::vector<LineLabel> draw_contours(LabelLayout& layout, const VisibleTerrain& terrain, double step_m);
// Draws labels into gaps that it cuts into the lines. Keeps a distance between labels with the same text.
void draw_labels(LabelLayout& layout, const std::vector<LineLabel>& labels);

class ImageSight;

// Draws the layers of vector features. Keeps references.
class LayersDrawing {
 public:
  // Draws areas, lines and points of each layer.
  LayersDrawing(LabelLayout& layout, const VisibleTerrain& terrain, core::HiddenLines hidden);
  ~LayersDrawing();
  LayersDrawing(const LayersDrawing&) = delete;
  LayersDrawing& operator=(const LayersDrawing&) = delete;

  // Draws what the colours and patterns in the image stand for (features/layers_legend.h).
  void draw_legend() const;
  // Draws labels, as far as there is room.
  void draw_labels() const;

 private:
  class LayerDrawer;
  LabelLayout& layout_;
  const std::vector<SceneLayer>& layers_;
  std::unique_ptr<ImageSight> sight_;
  std::vector<std::unique_ptr<LayerDrawer>> drawers_;
};

void draw_title(LabelLayout& layout, const std::string& title);
void draw_time(LabelLayout& layout, double time_s);
void draw_solar_time(LabelLayout& layout, const SolarTime& solar);
void draw_legend(LabelLayout& layout, const Scene& scene);
void draw_scale_bar(LabelLayout& layout, const VisibleTerrain& terrain);
void draw_north_arrow(LabelLayout& layout, const VisibleTerrain& terrain);
// Draws compass marks. Along an edge, removes the band from the layout's area.
void draw_compass(LabelLayout& layout, const Scene& scene, core::CompassStrip where);
// Draws names of places; with `distances` each name is followed by its distance (name_text()).
void draw_names(LabelLayout& layout, const VisibleTerrain& terrain, bool distances);

}  // namespace vpe::overlay
