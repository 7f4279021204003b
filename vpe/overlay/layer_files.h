// Vector files read for drawing.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "vpe/overlay/ground_features.h"

namespace vpe::overlay {

// Holds the layers of a vector file in their order. Any number of threads may read them.
using LayerFeatures = std::vector<std::shared_ptr<const GroundFeatures>>;
// Holds those of several files, by path.
using LayersByFile = std::map<std::string, LayerFeatures>;

// Reads all layers of a vector file. Features about which the file says nothing have one of seven colours that differ for all
// kinds of sight (Okabe and Ito 2008): `number` selects that of the first layer, and each further one has the next. Throws what
// mars::read_features() and GroundFeatures throw.
LayerFeatures read_layer_file(const std::string& path, double radius_m, std::size_t number);

}  // namespace vpe::overlay
