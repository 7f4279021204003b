// Layers of vector features over an image.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <map>

#include "vpe/core/view.h"
#include "vpe/overlay/draped_lines.h"
#include "vpe/overlay/filled_areas.h"
#include "vpe/overlay/ground_features.h"
#include "vpe/overlay/layer_functions.h"

namespace vpe::overlay {
namespace {

constexpr double kThinnestLine_px = 0.3;
constexpr double kWidestLine_px = 200;
constexpr double kSmallestMarker_px = 1;
constexpr double kHiddenDash_px = 4;  // at 720 rows
constexpr double kHiddenOpacity = 0.6;
constexpr std::size_t kMostLabels = 200;

Ink ink_of(const mars::StyleColour& colour, double opacity) {
  return {colour.rgb.r / 255.0, colour.rgb.g / 255.0, colour.rgb.b / 255.0, colour.opacity * opacity};
}

// Draws one layer.
class LayerDrawer {
 public:
  LayerDrawer(LabelLayout& layout, const VisibleTerrain& terrain, const SceneLayer& layer,
              core::HiddenLines hidden)
      : layout_(layout),
        terrain_(terrain),
        features_(*layer.features),
        opacity_(layer.opacity),
        hidden_(hidden),
        focal_px_(core::focal_px(terrain.scene().view)) {}

  void draw_areas(const ShownPlaces& places) {
    const Layer fills = fill_areas(features_, terrain_, places, opacity_);
    if (!fills.pixels.empty()) layout_.canvas().paint(fills);
  }

  void draw_lines() {
    drape_lines(features_, terrain_, [this](const DrapedRun& run) { draw_run(run); });
  }

  void draw_points() {
    for (const GroundFeatures::Point& point : features_.points()) {
      const mars::FeatureStyle& style = features_.style(point.feature);
      const auto at = drape(terrain_, point.place);
      if (!at || at->is_hidden || !is_inside(at->at_px)) continue;
      const double radius_px = std::max(kSmallestMarker_px, 0.5 * length_px(style.marker_size, at->distance_m));
      anchors_.try_emplace(point.feature, Anchor{at->at_px, at->distance_m, radius_px});
      if (!style.marker) continue;
      const auto disc = [&](double radius, const Ink& ink) {
        std::array<glm::dvec2, 24> circle;
        for (std::size_t n = 0; n < circle.size(); ++n) {
          const double a = 2 * mars::kPi * static_cast<double>(n) / static_cast<double>(circle.size());
          circle[n] = at->at_px + radius * glm::dvec2(std::cos(a), std::sin(a));
        }
        layout_.canvas().polygon(circle, ink);
      };
      disc(radius_px + layout_.line_px(1), {kShade.r, kShade.g, kShade.b, kShade.a * opacity_});
      disc(radius_px, ink_of(*style.marker, opacity_));
    }
  }

  // Labels stand beside points, and at the middle of the longest run of a line that is seen.
  void draw_labels() {
    if (!features_.has_labels()) return;
    std::size_t count = 0;
    for (const auto& [feature, anchor] : anchors_) {
      const std::string text = features_.label(feature);
      if (text.empty()) continue;
      const mars::FeatureStyle& style = features_.style(feature);
      const Font font{
          std::clamp(length_px(style.label_size, anchor.distance_m), layout_.font(11).size_px, layout_.px(96)),
          false};
      const TextSize size = layout_.canvas().measure(text, font);
      const double beside = 0.5 * size.width + anchor.radius_px + layout_.px(3);
      const double over = 0.5 * size.height + anchor.radius_px;
      const std::array<glm::dvec2, 4> offsets{glm::dvec2{beside, 0}, glm::dvec2{-beside, 0},
                                              glm::dvec2{0, -over}, glm::dvec2{0, over}};
      for (const glm::dvec2& offset : offsets) {
        const Box box = Box::about(anchor.at_px + offset, size);
        if (!layout_.is_free(box)) continue;
        layout_.take(box.grown(layout_.px(2)));
        layout_.canvas().text(text, anchor.at_px + offset, 0,
                              {font, ink_of(style.label_colour, opacity_), {0, 0, 0, 0.65 * opacity_}});
        if (++count == kMostLabels) return;
        break;
      }
    }
  }

 private:
  struct Anchor {
    glm::dvec2 at_px;
    double distance_m = 0;
    double radius_px = 0;
    double length_px = 0;
  };

  bool is_inside(glm::dvec2 at) const {
    return at.x >= 0 && at.y >= 0 && at.x < terrain_.width() && at.y < terrain_.height();
  }

  double length_px(const mars::StyleLength& length, double distance_m) const {
    return length.on_ground ? length.value * focal_px_ / std::max(distance_m, 1e-3) : layout_.px(length.value);
  }

  void draw_run(const DrapedRun& run) {
    const mars::FeatureStyle& style = features_.style(run.feature);
    if (run.is_hidden && hidden_ == core::HiddenLines::kLeftOut) return;
    const double width_px =
        std::clamp(length_px(style.width, run.distance_m), kThinnestLine_px, kWidestLine_px);
    std::vector<double> lengths;
    for (const mars::StyleLength& length : style.dash)
      lengths.push_back(std::max(0.5, length_px(length, run.distance_m)));
    double opacity = opacity_;
    if (run.is_hidden) {
      lengths = {layout_.px(kHiddenDash_px), layout_.px(kHiddenDash_px)};
      opacity *= kHiddenOpacity;
    }
    layout_.canvas().dashed(run.points_px, width_px, ink_of(*style.stroke, opacity), lengths);
    if (run.is_hidden || !features_.has_labels()) return;
    const glm::dvec2 middle = run.points_px[run.points_px.size() / 2];
    const auto length = static_cast<double>(run.points_px.size());
    if (!is_inside(middle)) return;
    Anchor& anchor = anchors_[run.feature];
    if (anchor.length_px < length) anchor = {middle, run.distance_m, width_px, length};
  }

  LabelLayout& layout_;
  const VisibleTerrain& terrain_;
  const GroundFeatures& features_;
  double opacity_;
  core::HiddenLines hidden_;
  double focal_px_;
  std::map<std::uint32_t, Anchor> anchors_;  // of labels
};

}  // namespace

void draw_layers(LabelLayout& layout, const VisibleTerrain& terrain, core::HiddenLines hidden) {
  const std::vector<SceneLayer>& layers = terrain.scene().layers;
  const bool has_areas =
      std::ranges::any_of(layers, [](const SceneLayer& layer) { return !layer.features->areas().empty(); });
  const ShownPlaces places = has_areas ? shown_places(terrain) : ShownPlaces{};
  std::vector<LayerDrawer> drawers;
  drawers.reserve(layers.size());
  for (const SceneLayer& layer : layers) {
    LayerDrawer& drawer = drawers.emplace_back(layout, terrain, layer, hidden);
    if (!layer.features->areas().empty()) drawer.draw_areas(places);
    drawer.draw_lines();
    drawer.draw_points();
  }
  // The uppermost layer has the first choice of room.
  for (auto drawer = drawers.rbegin(); drawer != drawers.rend(); ++drawer) drawer->draw_labels();
}

}  // namespace vpe::overlay
