// Vector features prepared for drawing on the ground: their styles, their lines in pieces with bounds, an index of the edges
// of their polygons.
//
// Edges are straight between their vertices in degrees of longitude and latitude, as GeoJSON has them.
//
// Typical usage:
//   const auto features = std::make_shared<const GroundFeatures>(layer, mars::FeatureStyle{});
//   scene.layers.push_back({features, 0.5});
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mars/vector/area_index.h"
#include "mars/vector/feature.h"
#include "mars/vector/feature_style.h"
#include "vpe/overlay/features/area_tree.h"

namespace vpe::overlay {

// Holds a layer and all that is computed of it once. Any number of threads may read it.
class GroundFeatures {
 public:
  // Throws mars::SourceError for a style that is wrong.
  GroundFeatures(mars::FeatureLayer layer, const mars::FeatureStyle& defaults);
  GroundFeatures(const GroundFeatures&) = delete;
  GroundFeatures& operator=(const GroundFeatures&) = delete;

  // Holds some successive vertices of a line or ring.
  struct Piece {
    std::uint32_t feature = 0;
    std::span<const glm::dvec2> places;  // the last one is the first one of the next piece
    glm::dvec3 centre{0, 0, 1};          // all edges lie within radius_rad of this unit direction
    double radius_rad = 0;
    bool begins = false;  // of its line
  };
  struct Point {
    std::uint32_t feature = 0;
    glm::dvec2 place;
  };
  struct Area {
    std::uint32_t feature = 0;
    mars::AreaIndex index;
  };

  const mars::FeatureLayer& layer() const { return layer_; }
  const std::vector<Piece>& pieces() const { return pieces_; }  // those of a line follow each other
  const std::vector<Point>& points() const { return points_; }
  const std::vector<Area>& areas() const { return areas_; }  // with a fill
  // Returns the style of a feature without its label.
  const mars::FeatureStyle& style(std::uint32_t feature) const { return styles_[style_of_[feature]]; }
  // Returns the number of a feature's style among the different ones, and a style by its number.
  std::uint32_t style_number(std::uint32_t feature) const { return style_of_[feature]; }
  const mars::FeatureStyle& style_of_number(std::uint32_t number) const { return styles_[number]; }
  std::size_t styles() const { return styles_.size(); }
  // Returns the extents of areas(), by their numbers.
  const AreaTree& area_tree() const { return area_tree_; }
  // Returns whether some feature has a label, and the label of one.
  bool has_labels() const { return has_labels_; }
  std::string label(std::uint32_t feature) const;
  std::size_t bytes() const;

 private:
  std::uint32_t keep(mars::FeatureStyle style);
  void add_line(std::uint32_t feature, const std::vector<glm::dvec2>& places);

  mars::FeatureLayer layer_;
  mars::FeatureStyle defaults_;
  std::vector<mars::FeatureStyle> styles_;  // different ones
  std::vector<std::uint32_t> style_of_;     // of each feature
  std::vector<Piece> pieces_;
  std::vector<Point> points_;
  std::vector<Area> areas_;
  AreaTree area_tree_;
  bool has_labels_ = false;
};

}  // namespace vpe::overlay
