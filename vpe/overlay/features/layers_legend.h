// Legend of the styles of vector layers: what their colours and patterns stand for.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vpe/overlay/features/layer_use.h"
#include "vpe/overlay/label_layout.h"
#include "vpe/overlay/overlay.h"

namespace vpe::overlay {

// Holds one entry: a style, what is drawn with it, and its text.
struct LegendRow {
  enum class Kind { kArea, kLine, kPoint };
  mars::FeatureStyle style;
  Kind kind = Kind::kArea;
  double opacity = 1;  // of its layer
  std::string text;    // FeatureStyle::legend, or the layer's name where that is empty

  bool operator==(const LegendRow&) const = default;
};

// Returns an entry for each different style in use, the uppermost layer first, styles of a layer in the order of its file.
// `uses` has an element for each layer. Pure.
std::vector<LegendRow> legend_rows(std::span<const SceneLayer> layers, std::span<const LayerUse> uses);

// Lays out and draws entries in columns on a dark box. Sizes are for `unit` pixels for each pixel of an image with 720 rows.
// One thread at a time.
class LayersLegend {
 public:
  // Measures the texts with `ruler`, a canvas of any size that is used here only.
  LayersLegend(std::vector<LegendRow> rows, const Canvas& ruler, double unit);

  // Describes a division into columns. Entries that have no room are counted in a last one, "and N more".
  struct Plan {
    std::size_t shown = 0;  // of the entries
    std::size_t lines = 0;  // of a column
    TextSize size{0, 0};    // of the box
  };
  // Returns the plan with the fewest columns in a box of at most this size; nullopt if not even one entry fits.
  std::optional<Plan> plan(double width_px, double height_px) const;
  void draw(Canvas& canvas, const Plan& plan, glm::dvec2 corner) const;

  // Finds room in an area: along its left edge from the top, then along its right edge, then for smaller boxes. Returns the
  // plan and its corner; nullopt if there is no room.
  struct Site {
    Plan plan;
    glm::dvec2 corner{0, 0};
  };
  std::optional<Site> find_site(const Box& area, const std::function<bool(const Box&)>& is_free) const;

 private:
  double px(double at_720) const { return unit_ * at_720; }
  void draw_swatch(Canvas& canvas, const LegendRow& row, glm::dvec2 centre) const;

  std::vector<LegendRow> rows_;  // with texts that are cut to the longest width
  double unit_;
  Font font_;
  double line_px_ = 0;
  double text_px_ = 0;  // of the widest text
};

}  // namespace vpe::overlay
