// Descriptions of panorama images, found in their metadata.
//
// Typical usage:
//   const PanoramaDescription description = describe("lookout.png");
//   const Direction direction = description.map.to_direction(x, y);
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
  // Everything that describes the image, that which counts first: "'x.json'", "GPano in 'x.jpg'".
  std::vector<std::string> sources;
  // False for GPano without a heading: azimuths are counted from the full image's middle.
  bool heading_is_known = true;
  std::optional<RecordedViewpoint> viewpoint;
  PairLayout pair = PairLayout::kNone;
  std::vector<PlaneName> planes;  // auxiliary layers in the image's folder, of the map's size
};

// Finds the description of an image. `path` is an image, or the JSON that names one. The first found of these
// counts:
//   1. NAME.json, or pano.json in the same folder when its "image" is this image (sidecar.h)
//   2. a label: NAME.lbl or NAME.xml (in either case), or at the start of the file (label.h)
//   3. GPano inside of PNG, JPEG or TIFF (gpano.h)
// Sizes are read without decoding pixels. `pair` overrides the JSON's statement about eyes. Throws
// vpe::base::FileError: nothing found; a description that cannot be used; two that differ by more than a pixel,
// or one that does not fit the image, naming both.
PanoramaDescription describe(const std::filesystem::path& path, std::optional<PairLayout> pair = std::nullopt);

}  // namespace panorama
