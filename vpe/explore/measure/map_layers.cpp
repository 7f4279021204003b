#include "vpe/explore/measure/map_layers.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "mars/vector/antimeridian.h"
#include "vpe/explore/measure/map_coverage.h"

namespace vpe::explore {
namespace {

using mars::Shape;
using mars::ShapeKind;

constexpr double kThinnest_px = 1;
constexpr double kSmallestDisc_px = 3;
constexpr double kWidest_px = 100;
constexpr double kNearVertices_px = 0.25;  // that are drawn as one
constexpr double kMargin_px = kWidest_px;

// Paints the features of a layer.
class LayerPainter {
 public:
  LayerPainter(const MapView& map, double radius_m, MapCoverage& coverage, core::RgbImage& image)
      : map_(map),
        lon_px_(map.lon_degrees_per_px()),
        m_per_px_(map.degrees_per_px * mars::kRadiansPerDegree * radius_m),
        coverage_(coverage),
        image_(image) {}

  // Returns whether a feature is drawn at the scale of the map.
  bool shows(const mars::FeatureStyle& style) const {
    return m_per_px_ >= style.min_scale_m && m_per_px_ < style.max_scale_m;
  }

  void areas(const mars::Feature& feature, const mars::FeatureStyle& style, double opacity) {
    if (!style.fill) return;
    for (const Shape& shape : feature.shapes) {
      if (shape.kind != ShapeKind::polygon) continue;
      const bool has_pole = std::ranges::any_of(
          shape.rings, [](const auto& ring) { return std::abs(ring.back().x - ring.front().x) > 180; });
      if (!has_pole) {
        add_area(shape);
        continue;
      }
      for (const Shape& part : mars::cut_at_antimeridian(shape)) add_area(part);
    }
    coverage_.paint(style.fill->rgb, style.fill->opacity * opacity, image_);
  }

  void lines(const mars::Feature& feature, const mars::FeatureStyle& style, double opacity) {
    if (!style.stroke) return;
    const double width_px = std::clamp(length_px(style.width), kThinnest_px, kWidest_px);
    for (const Shape& shape : feature.shapes) {
      if (shape.kind == ShapeKind::point) continue;
      for (const auto& ring : shape.rings)
        each_turn(ring, [&](double turn_deg) { add_line(ring, turn_deg, width_px); });
    }
    coverage_.paint(style.stroke->rgb, style.stroke->opacity * opacity, image_);
  }

  void points(const mars::Feature& feature, const mars::FeatureStyle& style, double opacity) {
    if (!style.marker) return;
    const double size_px = std::clamp(length_px(style.marker_size), kSmallestDisc_px, kWidest_px);
    for (const Shape& shape : feature.shapes) {
      if (shape.kind != ShapeKind::point) continue;
      each_turn(shape.rings.at(0), [&](double turn_deg) {
        coverage_.add_disc(position(shape.rings[0][0], turn_deg), size_px / 2);
      });
    }
    coverage_.paint(style.marker->rgb, style.marker->opacity * opacity, image_);
  }

 private:
  // Returns where a place is `turn_deg` farther east.
  glm::dvec2 position(glm::dvec2 place, double turn_deg) const {
    return {map_.width / 2.0 + (place.x + turn_deg - map_.middle.lon_deg) / lon_px_,
            map_.height / 2.0 - (place.y - map_.middle.lat_deg) / map_.degrees_per_px};
  }

  double length_px(const mars::StyleLength& length) const {
    return length.on_ground ? length.value / m_per_px_ : length.value;
  }

  // Calls `draw` with each full turn by which the map shows vertices.
  template <class Draw>
  void each_turn(const std::vector<glm::dvec2>& vertices, const Draw& draw) const {
    glm::dvec2 low = vertices.at(0);
    glm::dvec2 high = low;
    for (const glm::dvec2& vertex : vertices) {
      low = glm::min(low, vertex);
      high = glm::max(high, vertex);
    }
    const double top = position(high, 0).y;
    const double bottom = position(low, 0).y;
    if (bottom < -kMargin_px || top > map_.height + kMargin_px) return;
    const double half_deg = (map_.width / 2.0 + kMargin_px) * lon_px_;
    const double first = std::ceil((map_.middle.lon_deg - half_deg - high.x) / 360);
    const double last = std::floor((map_.middle.lon_deg + half_deg - low.x) / 360);
    for (double turn = first; turn <= last; ++turn) draw(360 * turn);
  }

  void add_area(const Shape& shape) {
    each_turn(shape.rings.at(0), [&](double turn_deg) {
      std::vector<std::vector<glm::dvec2>> rings(shape.rings.size());
      for (std::size_t n = 0; n < rings.size(); ++n) {
        for (const glm::dvec2& vertex : shape.rings[n]) rings[n].push_back(position(vertex, turn_deg));
      }
      coverage_.add_area(rings);
    });
  }

  void add_line(const std::vector<glm::dvec2>& places, double turn_deg, double width_px) {
    glm::dvec2 from = position(places[0], turn_deg);
    for (std::size_t n = 1; n < places.size(); ++n) {
      const glm::dvec2 to = position(places[n], turn_deg);
      if (n + 1 < places.size() && glm::length(to - from) < kNearVertices_px) continue;
      coverage_.add_line(from, to, width_px);
      from = to;
    }
  }

  const MapView& map_;
  double lon_px_;
  double m_per_px_;
  MapCoverage& coverage_;
  core::RgbImage& image_;
};

}  // namespace

void paint_map_layers(const MapView& map, std::span<const MapLayer> layers, double radius_m,
                      core::RgbImage& image) {
  MapCoverage coverage(map.width, map.height);
  LayerPainter painter(map, radius_m, coverage, image);
  using Paint = void (LayerPainter::*)(const mars::Feature&, const mars::FeatureStyle&, double);
  for (const MapLayer& layer : layers) {
    const std::vector<mars::Feature>& features = layer.layer->features;
    for (const Paint paint : {&LayerPainter::areas, &LayerPainter::lines, &LayerPainter::points}) {
      for (std::uint32_t n = 0; n < features.size(); ++n) {
        const mars::FeatureStyle& style = layer.style(n);
        if (painter.shows(style)) (painter.*paint)(features[n], style, layer.opacity);
      }
    }
  }
}

}  // namespace vpe::explore
