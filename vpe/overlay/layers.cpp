// Layers of vector features over an image.
#include <algorithm>
#include <array>
#include <map>

#include "vpe/overlay/draped_lines.h"
#include "vpe/overlay/features/feature_painter.h"
#include "vpe/overlay/features/image_sight.h"
#include "vpe/overlay/features/layers_legend.h"
#include "vpe/overlay/filled_areas.h"
#include "vpe/overlay/ground_features.h"
#include "vpe/overlay/layer_functions.h"

namespace vpe::overlay {
namespace {

constexpr std::size_t kMostLabels = 200;

}  // namespace

// Draws one layer.
class LayersDrawing::LayerDrawer {
 public:
  LayerDrawer(LabelLayout& layout, const VisibleTerrain& terrain, const ImageSight& sight,
              const SceneLayer& layer, core::HiddenLines hidden)
      : layout_(layout),
        terrain_(terrain),
        sight_(sight),
        features_(*layer.features),
        painter_{sight.frame().scale, layer.opacity, hidden},
        use_(features_) {}

  const LayerUse& use() const { return use_; }

  void draw_areas(const ShownPlaces& places) {
    const Layer fills = fill_areas(features_, terrain_, places, painter_.opacity, &use_);
    if (!fills.pixels.empty()) layout_.canvas().paint(fills);
  }

  void draw_lines() {
    drape_lines(features_, sight_, [this](const DrapedRun& run) { draw_run(run); });
  }

  void draw_points() {
    for (const GroundFeatures::Point& point : features_.points()) {
      const mars::FeatureStyle& style = features_.style(point.feature);
      const auto at = drape(sight_, point.place);
      if (!at || at->is_hidden || !is_inside(at->at_px) || !painter_.scale.shows(style, at->distance_m))
        continue;
      const double radius_px = painter_.radius_px(style, at->distance_m);
      anchors_.try_emplace(point.feature, Anchor{at->at_px, at->distance_m, radius_px});
      painter_.marker(layout_.canvas(), at->at_px, at->distance_m, style);
      if (style.marker) use_.points[features_.style_number(point.feature)] = 1;
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
      const Font font = painter_.font(style, anchor.distance_m);
      const TextSize size = layout_.canvas().measure(text, font);
      const double beside = 0.5 * size.width + anchor.radius_px + layout_.px(3);
      const double over = 0.5 * size.height + anchor.radius_px;
      const std::array<glm::dvec2, 4> offsets{glm::dvec2{beside, 0}, glm::dvec2{-beside, 0},
                                              glm::dvec2{0, -over}, glm::dvec2{0, over}};
      for (const glm::dvec2& offset : offsets) {
        const Box box = Box::about(anchor.at_px + offset, size);
        if (!layout_.is_free(box)) continue;
        layout_.take(box.grown(layout_.px(2)));
        layout_.canvas().text(
            text, anchor.at_px + offset, 0,
            {font, ink_of(style.label_colour, painter_.opacity), {0, 0, 0, 0.65 * painter_.opacity}});
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

  void draw_run(const DrapedRun& run) {
    const mars::FeatureStyle& style = features_.style(run.feature);
    painter_.run(layout_.canvas(), run, style, {0, 0});
    const glm::dvec2 middle = run.points_px[run.points_px.size() / 2];
    if (run.is_hidden || !is_inside(middle)) return;
    use_.lines[features_.style_number(run.feature)] = 1;
    if (!features_.has_labels()) return;
    const auto length = static_cast<double>(run.points_px.size());
    Anchor& anchor = anchors_[run.feature];
    if (anchor.length_px < length)
      anchor = {middle, run.distance_m, painter_.width_px(style, run.distance_m), length};
  }

  LabelLayout& layout_;
  const VisibleTerrain& terrain_;
  const ImageSight& sight_;
  const GroundFeatures& features_;
  FeaturePainter painter_;
  LayerUse use_;
  std::map<std::uint32_t, Anchor> anchors_;  // of labels
};

LayersDrawing::LayersDrawing(LabelLayout& layout, const VisibleTerrain& terrain, core::HiddenLines hidden)
    : layout_(layout), layers_(terrain.scene().layers), sight_(std::make_unique<ImageSight>(terrain)) {
  const bool has_areas =
      std::ranges::any_of(layers_, [](const SceneLayer& layer) { return !layer.features->areas().empty(); });
  const ShownPlaces places = has_areas ? shown_places(terrain) : ShownPlaces{};
  for (const SceneLayer& layer : layers_) {
    drawers_.push_back(std::make_unique<LayerDrawer>(layout, terrain, *sight_, layer, hidden));
    LayerDrawer& drawer = *drawers_.back();
    if (!layer.features->areas().empty()) drawer.draw_areas(places);
    drawer.draw_lines();
    drawer.draw_points();
  }
}

LayersDrawing::~LayersDrawing() = default;

void LayersDrawing::draw_legend() const {
  std::vector<LayerUse> uses;
  for (const auto& drawer : drawers_) uses.push_back(drawer->use());
  const LayersLegend legend(legend_rows(layers_, uses), layout_.canvas(), layout_.px(1));
  const auto site = legend.find_site(layout_.area(), [this](const Box& box) { return layout_.is_free(box); });
  if (!site) return;
  legend.draw(layout_.canvas(), site->plan, site->corner);
  layout_.take(Box{site->corner.x, site->corner.y, site->corner.x + site->plan.size.width,
                   site->corner.y + site->plan.size.height}
                   .grown(layout_.px(4)));
}

void LayersDrawing::draw_labels() const {
  // The uppermost layer has the first choice of room.
  for (auto drawer = drawers_.rbegin(); drawer != drawers_.rend(); ++drawer) (*drawer)->draw_labels();
}

}  // namespace vpe::overlay
