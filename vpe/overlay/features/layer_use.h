// Holds which styles of a layer an image shows.
#pragma once

#include <cstdint>
#include <vector>

#include "vpe/overlay/ground_features.h"

namespace vpe::overlay {

// Holds a mark for each style of a layer (GroundFeatures::style_number()), by what is drawn with it.
struct LayerUse {
  std::vector<std::uint8_t> areas;
  std::vector<std::uint8_t> lines;
  std::vector<std::uint8_t> points;

  LayerUse() = default;
  explicit LayerUse(const GroundFeatures& features)
      : areas(features.styles()), lines(features.styles()), points(features.styles()) {}
};

}  // namespace vpe::overlay
