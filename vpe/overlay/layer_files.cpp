#include "vpe/overlay/layer_files.h"

#include <array>
#include <utility>

#include "mars/vector/feature_reader.h"

namespace vpe::overlay {
namespace {

mars::FeatureStyle style_of_layer(std::size_t number) {
  constexpr std::array<base::Rgb, 7> kColours{{{230, 159, 0},
                                               {86, 180, 233},
                                               {0, 158, 115},
                                               {240, 228, 66},
                                               {0, 114, 178},
                                               {213, 94, 0},
                                               {204, 121, 167}}};
  const mars::StyleColour colour{kColours[number % kColours.size()], 1};
  mars::FeatureStyle style;
  style.stroke = colour;
  style.marker = colour;
  style.label_colour = {{255, 255, 255}, 1};
  return style;
}

}  // namespace

LayerFeatures read_layer_file(const std::string& path, double radius_m, std::size_t number) {
  LayerFeatures features;
  for (mars::FeatureLayer& layer : mars::read_features(path, {}, radius_m))
    features.push_back(std::make_shared<const GroundFeatures>(std::move(layer), style_of_layer(number++)));
  return features;
}

}  // namespace vpe::overlay
