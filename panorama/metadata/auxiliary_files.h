// What a panorama's JSON says besides its projection: which eyes the image holds, and which rasters belong to
// it.
//
// Keys:
//   stereo   "sbs" (left eye on the left half) or "ou" (left eye on the upper half); width, height and all
//   other
//            keys of the JSON may be those of one eye or of the whole image
//   planes   {"range": "NAME.tif", ...}: rasters with a value or more for every pixel of the image (of one
//            camera), in the same folder; the file's name may also be given as {"file": "NAME.tif"}
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "panorama/image/metadata_error.h"

namespace panorama {

// How the eyes of a pair lie in one image.
enum class PairLayout : std::uint8_t { kNone, kSideBySide, kOverUnder };

// "none", "sbs", "ou"; nothing for other words.
std::optional<PairLayout> parse_pair_layout(std::string_view name);

struct PlaneName {
  std::string name;  // what it holds: "range", "lonlat", "elevation", ...
  std::string file;  // without a folder
};

struct AuxiliaryFiles {
  PairLayout pair = PairLayout::kNone;
  std::vector<PlaneName> planes;  // in the order of their names
};

// Throws MetadataError: no JSON, or a key with a value that is not one of those above.
AuxiliaryFiles read_auxiliary_files(std::string_view json);

}  // namespace panorama
