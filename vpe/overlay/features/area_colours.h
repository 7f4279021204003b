// The colours of the fills of areas.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "vpe/core/image/image.h"
#include "vpe/overlay/features/feature_scale.h"
#include "vpe/overlay/features/layer_use.h"
#include "vpe/overlay/ground_features.h"

namespace vpe::overlay {

// Holds a colour times its opacity, 0 to 255, and the opacity, 0 to 1.
struct FillColour {
  double r = 0, g = 0, b = 0, a = 0;

  bool operator==(const FillColour&) const = default;
  // Adds a share of another colour.
  void add(const FillColour& other, double share);
  // Lays this over a colour of the same kind, or over a pixel.
  FillColour over(const FillColour& below) const;
  base::Rgb over(base::Rgb below) const;
  // Returns it with straight alpha.
  core::Rgba straight() const;
};

// Tells the colour of the areas of a layer at places. Refers to the features. Any number of threads may use it.
class AreaColours {
 public:
  AreaColours(const GroundFeatures& features, double opacity, const FeatureScale& scale)
      : features_(features), opacity_(opacity), scale_(scale) {}

  // Puts the areas that may hold places within `pad_deg` of one into `found`.
  void find(glm::dvec2 place_deg, double pad_deg, std::vector<std::uint32_t>& found) const {
    features_.area_tree().find(place_deg, pad_deg, found);
  }
  // Returns the fills of those of `found` that hold a place so far away, later ones over earlier ones. Marks their styles in
  // `use` unless it is null.
  FillColour at(std::span<const std::uint32_t> found, glm::dvec2 place_deg, double distance_m,
                LayerUse* use) const;

 private:
  const GroundFeatures& features_;
  double opacity_;
  FeatureScale scale_;
};

}  // namespace vpe::overlay
