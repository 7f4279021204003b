// The list of vector files of the setting overlay.layers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vpe::core {

struct LayerFile {
  std::string path;
  double opacity = 1;  // 0 to 1
  bool operator==(const LayerFile&) const = default;
};

// Parses "units.gpkg@0.4;traverse.geojson": paths with ';' between them, each of which may be followed by '@' and an opacity.
// An '@' without a number after it belongs to the path. Empty text: none. Throws std::invalid_argument for an empty path and
// for an opacity that is not within 0 to 1.
std::vector<LayerFile> parse_layer_list(std::string_view text);

// Returns the text of a list: the inverse.
std::string layer_list_text(const std::vector<LayerFile>& files);

// Returns "" for a list of files that can be read, else what is wrong.
std::string layers_problem(const std::string& text);

}  // namespace vpe::core
