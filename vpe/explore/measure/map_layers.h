// Vector layers on the flat map.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "mars/vector/feature.h"
#include "mars/vector/feature_style.h"
#include "vpe/core/image/image.h"
#include "vpe/explore/measure/map_view.h"

namespace vpe::explore {

// Holds a layer that a map shows.
struct MapLayer {
  std::shared_ptr<const mars::FeatureLayer> layer;  // not null
  // Returns the style of a feature, by its index. Any thread may call it while the layer exists.
  std::function<const mars::FeatureStyle&(std::uint32_t feature)> style;
  double opacity = 1;  // 0 to 1
};

// Paints layers over the image of a map, the lowest first: of each layer the areas, then lines and outlines, then points, each at
// the opacity of its style times that of the layer. Edges are straight between their vertices, as the map is linear in degrees;
// where the map shows a place twice, features are there twice. Lines are solid and at least a pixel wide, points at least 3
// pixels; labels are left out. The image has the size of the map. Features beyond the scale
// range of their style are left out. Lengths on the ground, and scales, are those along meridians. Pure.
void paint_map_layers(const MapView& map, std::span<const MapLayer> layers, double radius_m,
                      core::RgbImage& image);

}  // namespace vpe::explore
