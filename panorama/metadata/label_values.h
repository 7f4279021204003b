// Values of labels with their units, whatever the label's form. Private to panorama.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "panorama/metadata/label.h"

namespace panorama {

// A value as the label writes it, and its unit, empty when it gives none.
struct LabelValue {
  std::string text;
  std::string unit;
};

// What a label says of its projection, keys as in PDS3 but MAP_RESOLUTION by axis: MAP_RESOLUTION_X and _Y.
using LabelLookup = std::function<std::optional<LabelValue>(std::string_view key)>;

RoverLabel label_of(const LabelLookup& look_up);

// Throws MetadataError unless the projection is cylindrical, naming what it is.
void require_cylindrical(std::string_view projection);

}  // namespace panorama
