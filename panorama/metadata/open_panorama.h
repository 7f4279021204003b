// What a panorama's image shows, from whatever describes it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "panorama/image/xmp_file.h"
#include "panorama/metadata/auxiliary_files.h"
#include "panorama/metadata/sidecar.h"
#include "panorama/projection.h"

namespace panorama {

struct PanoramaDescription {
  std::filesystem::path image;
  ImageFileFormat format = ImageFileFormat::kOther;
  PanoramaMap map;  // of the image's size; of one eye's when it holds a pair
  std::vector<std::string>
      sources;  // what described it, the one that counts first: "'x.json'", "GPano in 'x.jpg'"
  bool heading_is_known =
      true;  // false: GPano without a heading, azimuths are counted from the full image's middle
  std::optional<Viewpoint> viewpoint;
  PairLayout pair = PairLayout::kNone;
  std::vector<PlaneName> planes;  // beside the image; of the map's size
};

// `path` is an image, or the JSON that names one. Looked for, and the first found counts:
//   1. NAME.json, or pano.json in the same folder when its "image" is this image (sidecar.h)
//   2. a label: NAME.lbl or NAME.xml (in either case), or at the start of the file (label.h)
//   3. GPano inside of PNG, JPEG or TIFF (gpano.h)
// Sizes are read without unpacking pixels. Throws vpe::base::FileError: nothing found; a description that
// cannot be used; two that differ by more than a pixel, or one that does not fit the image, naming both.
// `pair` says which eyes the image holds, whatever its JSON says.
PanoramaDescription describe(const std::filesystem::path& path, std::optional<PairLayout> pair = std::nullopt);

}  // namespace panorama
