// Finds the features of vector layers under a cursor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "mars/vector/feature.h"

namespace vpe::explore {

// Describes what lies under a cursor, and how an image or a map shows places.
struct PickQuery {
  mars::LonLat place;        // on the ground below the cursor, or nearest to it
  bool is_on_ground = true;  // the cursor shows `place` itself, so that areas can hold it
  double reach_rad = 0;      // no place within reach_px of the cursor is farther from `place`
  glm::dvec2 cursor_px{0, 0};
  double reach_px = 6;
  // Returns where a place in degrees is shown; nullopt: nowhere. Places nearby are shown near each other.
  std::function<std::optional<glm::dvec2>(glm::dvec2 place_deg)> position;
  // Returns true if nothing hides a place. Empty: all are seen.
  std::function<bool(glm::dvec2 place_deg)> is_seen;
};

// Names a feature that was found.
struct PickedFeature {
  std::size_t layer = 0;                          // index among those that were searched
  std::uint32_t feature = 0;                      // index in its layer
  mars::ShapeKind kind = mars::ShapeKind::point;  // of what was found: an outline of a polygon is a line
  double distance_px = 0;                         // from the cursor; 0 for areas
  bool operator==(const PickedFeature&) const = default;
};

// Finds all features within reach of a cursor: points and lines by their distance in the image, areas by whether they hold the
// place. Layers are given with the lowest first. The result has the topmost layer first, and in each layer points, then lines,
// then areas, of these the nearest first, and of equal ones that which is drawn last. Each feature is in it once. Edges are
// straight in degrees; they are followed until they are shown within a pixel. Pure if position and is_seen are.
std::vector<PickedFeature> pick_features(std::span<const mars::FeatureLayer* const> layers,
                                         const PickQuery& query);

// Returns the text of a value; "" for none.
std::string field_text(const mars::FieldValue& value);

// Returns names and values of all fields of a feature, in the order of its layer. Pure.
std::vector<std::pair<std::string, std::string>> field_texts(const mars::FeatureLayer& layer,
                                                             const mars::Feature& feature);

}  // namespace vpe::explore
