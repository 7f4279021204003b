#include "vpe/overlay/ground_features.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"

namespace vpe::overlay {
namespace {

constexpr std::size_t kVerticesOfPiece = 32;
// Styles that are looked through for an equal one.
constexpr std::size_t kComparedStyles = 64;

glm::dvec3 to_direction(glm::dvec2 place_deg) { return mars::direction({place_deg.x, place_deg.y}); }

// Returns an upper bound of the length of an edge, which is straight in degrees.
double length_rad(glm::dvec2 from, glm::dvec2 to) {
  return (std::abs(to.x - from.x) + std::abs(to.y - from.y)) * mars::kRadiansPerDegree;
}

}  // namespace

GroundFeatures::GroundFeatures(mars::FeatureLayer layer, const mars::FeatureStyle& defaults)
    : layer_(std::move(layer)), defaults_(defaults) {
  style_of_.reserve(layer_.features.size());
  for (std::uint32_t f = 0; f < layer_.features.size(); ++f) {
    const mars::Feature& feature = layer_.features[f];
    mars::FeatureStyle style = mars::feature_style(feature, layer_, defaults_);
    has_labels_ = has_labels_ || !style.label.empty();
    const bool is_filled = style.fill.has_value();
    const bool has_lines = style.stroke.has_value();
    style_of_.push_back(keep(std::move(style)));
    for (const mars::Shape& shape : feature.shapes) {
      if (shape.kind == mars::ShapeKind::point) {
        points_.push_back({f, shape.rings.at(0).at(0)});
        continue;
      }
      if (shape.kind == mars::ShapeKind::polygon && is_filled) areas_.push_back({f, mars::AreaIndex(shape)});
      if (!has_lines) continue;
      for (const auto& ring : shape.rings) add_line(f, ring);
    }
  }
  std::vector<AreaTree::Extent> extents;
  extents.reserve(areas_.size());
  for (const Area& area : areas_) extents.push_back({area.index.low_deg(), area.index.high_deg()});
  area_tree_ = AreaTree(extents);
}

std::uint32_t GroundFeatures::keep(mars::FeatureStyle style) {
  style.label.clear();
  const std::size_t first = styles_.size() > kComparedStyles ? styles_.size() - kComparedStyles : 0;
  for (std::size_t k = styles_.size(); k > first; --k)
    if (styles_[k - 1] == style) return static_cast<std::uint32_t>(k - 1);
  styles_.push_back(std::move(style));
  return static_cast<std::uint32_t>(styles_.size() - 1);
}

void GroundFeatures::add_line(std::uint32_t feature, const std::vector<glm::dvec2>& places) {
  for (std::size_t first = 0; first + 1 < places.size(); first += kVerticesOfPiece) {
    Piece piece;
    piece.feature = feature;
    piece.begins = first == 0;
    piece.places = std::span(places).subspan(first, std::min(kVerticesOfPiece + 1, places.size() - first));
    glm::dvec3 sum(0);
    for (const glm::dvec2& place : piece.places) sum += to_direction(place);
    piece.centre = glm::length(sum) > 1e-9 ? glm::normalize(sum) : to_direction(piece.places[0]);
    double farthest = 0;
    double longest = 0;
    for (std::size_t i = 0; i < piece.places.size(); ++i) {
      farthest = std::max(farthest, mars::angle_between_rad(piece.centre, to_direction(piece.places[i])));
      if (i > 0) longest = std::max(longest, length_rad(piece.places[i - 1], piece.places[i]));
    }
    // A place of an edge is at most half the edge's length from one of its ends.
    piece.radius_rad = std::min(farthest + 0.5 * longest, mars::kPi);
    pieces_.push_back(piece);
  }
}

std::string GroundFeatures::label(std::uint32_t feature) const {
  return mars::feature_style(layer_.features[feature], layer_, defaults_).label;
}

std::size_t GroundFeatures::bytes() const {
  std::size_t total = sizeof(*this) + area_tree_.bytes() + pieces_.capacity() * sizeof(Piece) +
                      points_.capacity() * sizeof(Point) + styles_.capacity() * sizeof(mars::FeatureStyle) +
                      style_of_.capacity() * sizeof(std::uint32_t);
  for (const mars::Feature& feature : layer_.features) {
    total += sizeof(feature) + feature.values.capacity() * sizeof(mars::FieldValue);
    for (const mars::Shape& shape : feature.shapes) {
      for (const auto& ring : shape.rings) total += ring.capacity() * sizeof(glm::dvec2) + sizeof(ring);
    }
  }
  return total;
}

}  // namespace vpe::overlay
