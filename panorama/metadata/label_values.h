// Values of labels with their units, for any form of label. Private to panorama.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "panorama/metadata/label.h"

namespace panorama {

// Holds a value as the label writes it, and its unit, empty when it gives none.
struct LabelValue {
  std::string text;
  std::string unit;
};

// Returns a value of the label's projection. Keys are those of PDS3, except that MAP_RESOLUTION is split by
// axis into MAP_RESOLUTION_X and _Y.
using LabelLookup = std::function<std::optional<LabelValue>(std::string_view key)>;

// Returns the label with the values found. Throws MetadataError for one that cannot be used.
RoverLabel label_of(const LabelLookup& look_up);

// Throws MetadataError that names the projection, unless it is cylindrical.
void require_cylindrical(std::string_view projection);

}  // namespace panorama
