// Files and eyes that belong to a panorama, as its JSON lists them besides the projection.
//
// Keys:
//   stereo   "sbs" (left eye on the left half) or "ou" (left eye on the upper half); width, height and all
//            other keys of the JSON may be those of one eye or of the whole image
//   planes   {"range": "NAME.tif", ...}: auxiliary layers, rasters with a value or more for every pixel of the
//            image (of one eye), in the same folder; the file's name may also be {"file": "NAME.tif"}
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "panorama/image/metadata_error.h"

namespace panorama {

// Describes how the eyes of a pair lie in one image.
enum class PairLayout : std::uint8_t { kNone, kSideBySide, kOverUnder };

// Parses "none", "sbs" or "ou". Returns nullopt for other words.
std::optional<PairLayout> parse_pair_layout(std::string_view name);

// Names an auxiliary layer and its file.
struct PlaneName {
  std::string name;  // of the layer: "range", "lonlat", "elevation", ...
  std::string file;  // without a folder
};

struct AuxiliaryFiles {
  PairLayout pair = PairLayout::kNone;
  std::vector<PlaneName> planes;  // in the order of their names
};

// Reads the keys above from a JSON text. Throws MetadataError: no JSON, or a key with another kind of value.
AuxiliaryFiles read_auxiliary_files(std::string_view json);

}  // namespace panorama
