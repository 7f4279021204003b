// The list of image layers of the setting image.layers: which layers of a planet file are shown, and how.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vpe::core {

// Describes how a layer of imagery is shown. Values are those of the layer, 0 to 255.
struct ImageLayerLook {
  std::string name;    // as the planet file has it
  double opacity = 1;  // 0 to 1
  double low = 0;      // is shown black; above `high`: the negative
  double high = 255;   // is shown white
  double gamma = 1;    // between both, 0.1 to 10; larger: brighter
  bool operator==(const ImageLayerLook&) const = default;
};

// Parses "viking;ctx@0.6 low=20 high=200 gamma=1.4": names with ';' between them, the lowest first, each of which may be
// followed by '@' and an opacity, and then by values of its stretch. An '@' without a number after it belongs to the name.
// Empty text: none, which stands for the imagery as the planet file was built. Throws std::invalid_argument for an empty name, a
// name that stands twice, and for values that are not within their limits.
std::vector<ImageLayerLook> parse_image_layers(std::string_view text);

// Returns the text of a list: the inverse.
std::string image_layers_text(const std::vector<ImageLayerLook>& layers);

// Returns "" for a text that parse_image_layers() reads, else what is wrong.
std::string image_layers_problem(const std::string& text);

}  // namespace vpe::core
