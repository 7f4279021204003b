#include "panorama/metadata/open_panorama.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "panorama/image/input.h"
#include "panorama/metadata/gpano.h"
#include "panorama/metadata/label.h"
#include "panorama/metadata/xml.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/core/json_text.h"

namespace panorama {

namespace {

namespace fs = std::filesystem;
using vpe::base::file_error;
using vpe::base::FileError;

constexpr std::uintmax_t kMaxTextBytes = std::uintmax_t{1} << 24;
// Attached labels of mosaics list every frame.
constexpr std::uint64_t kMaxLabelBytes = std::uint64_t{1} << 22;
constexpr double kAgree_px = 1.0;

struct Found {
  std::string source;
  PanoramaMap map;
  bool heading_is_known = true;
  std::optional<RecordedViewpoint> viewpoint;
  AuxiliaryFiles auxiliary;
};

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

// Calls a reader of metadata, and adds the name of its source to its errors.
template <class Reader>
auto reading(const std::string& source, const Reader& reader) {
  try {
    return reader();
  } catch (const MetadataError& e) {
    throw FileError("cannot read " + source + ": " + e.what());
  }
}

std::string text_of(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = vpe::base::read_file(path, kMaxTextBytes);
  return {bytes.begin(), bytes.end()};
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::string size_text(std::int64_t width_px, std::int64_t height_px) {
  return std::to_string(width_px) + "x" + std::to_string(height_px);
}

// Reduces a description of both eyes of a pair to one of them.
void take_one_eye(Found& found, const ImageFileHeader& header, PairLayout pair) {
  if (found.map.width_px != header.width_px || found.map.height_px != header.height_px) return;
  if (pair == PairLayout::kSideBySide) found.map.width_px /= 2;
  if (pair == PairLayout::kOverUnder) found.map.height_px /= 2;
}

void require_size(const Found& found, const fs::path& image, const ImageFileHeader& header, PairLayout pair) {
  const std::int64_t across = pair == PairLayout::kSideBySide ? 2 : 1;
  const std::int64_t down = pair == PairLayout::kOverUnder ? 2 : 1;
  if (across * found.map.width_px == header.width_px && down * found.map.height_px == header.height_px) return;
  throw FileError("cannot use " + quoted(image) + ": it has " + size_text(header.width_px, header.height_px) +
                  " pixels, but " + found.source + " describes " +
                  size_text(found.map.width_px, found.map.height_px) +
                  "; give the description of this very image, or remove the wrong one");
}

void require_agreement(const Found& a, const Found& b) {
  const double difference_px = largest_difference_px(a.map, b.map);
  if (difference_px <= kAgree_px || !a.heading_is_known || !b.heading_is_known) return;
  throw FileError("cannot use " + a.source + ": " + b.source + " contradicts it by " +
                  vpe::base::format_number(difference_px) + " pixels; remove the wrong one");
}

std::optional<Found> find_sidecar(const fs::path& image) {
  const fs::path beside = fs::path(image).replace_extension(".json");
  const fs::path of_folder = image.parent_path() / "pano.json";
  for (const fs::path& path : {beside, of_folder}) {
    if (!is_file(path)) continue;
    const std::string text = text_of(path);
    const Sidecar sidecar = reading(quoted(path), [&] { return read_sidecar(text); });
    const bool is_of_this =
        sidecar.image.empty() || sidecar.image == vpe::core::text_in_json(image.filename().string());
    if (path == beside && !is_of_this) {
      throw file_error("use", path, "it describes the image '" + sidecar.image + "', not " + quoted(image),
                       "correct its \"image\" or rename it");
    }
    if (path == of_folder && path != beside && (!is_of_this || sidecar.image.empty())) continue;
    return Found{quoted(path), sidecar.map, true, sidecar.viewpoint,
                 reading(quoted(path), [&] { return read_auxiliary_files(text); })};
  }
  return std::nullopt;
}

// Returns the start of the image's file if it begins with a label.
std::optional<std::string> attached_label(const Input& input) {
  const std::string start =
      input.read_text(0, static_cast<std::size_t>(std::min<std::uint64_t>(64, input.size())));
  if (!is_label_start(start)) return std::nullopt;
  return input.read_text(0, static_cast<std::size_t>(std::min(kMaxLabelBytes, input.size())));
}

std::optional<std::pair<std::string, RoverLabel>> find_label(const fs::path& image) {
  for (const char* extension : {".lbl", ".LBL", ".xml", ".XML"}) {
    const fs::path path = fs::path(image).replace_extension(extension);
    if (path == image || !is_file(path)) continue;
    const bool is_xml = lower_case(extension) == ".xml";
    const auto label = reading(quoted(path), [&] {
      const std::string text = text_of(path);
      return is_xml ? read_pds4_label(text) : read_text_label(text);
    });
    if (label) return std::pair("label " + quoted(path), *label);
  }
  const std::string inside = "the label in " + quoted(image);
  const auto label = reading(inside, [&]() -> std::optional<RoverLabel> {
    const auto text = attached_label(Input(image));
    return text ? read_text_label(*text) : std::nullopt;
  });
  return label ? std::optional(std::pair(inside, *label)) : std::nullopt;
}

std::optional<Found> find_gpano(const fs::path& image, const ImageFileHeader& header) {
  if (!header.xmp) return std::nullopt;
  const std::string source = "GPano in " + quoted(image);
  return reading(source, [&]() -> std::optional<Found> {
    const std::optional<GPano> gpano = read_gpano(*header.xmp);
    if (!gpano) return std::nullopt;
    return Found{source, map_of(*gpano), gpano->heading_deg.has_value(), std::nullopt, {}};
  });
}

// Returns the image that a JSON file describes, or `path` itself for other files.
fs::path image_of(const fs::path& path) {
  if (lower_case(path.extension().string()) != ".json") return path;
  const Sidecar sidecar = reading(quoted(path), [&] { return read_sidecar(text_of(path)); });
  if (sidecar.image.empty()) {
    throw file_error("use", path, "it names no image", "give the image, or add \"image\" to it");
  }
  return path.parent_path() / fs::path(sidecar.image).filename();
}

}  // namespace

PanoramaDescription describe(const fs::path& path, std::optional<PairLayout> pair) {
  const fs::path image = image_of(path);
  ImageFileHeader header = read_image_header(image);
  std::vector<Found> all;
  if (const auto found = find_sidecar(image)) all.push_back(*found);
  if (const auto found = find_label(image)) {
    const auto& [source, label] = *found;
    // A raw raster has no header but its label.
    if (header.format == ImageFileFormat::kOther && label.lines && label.samples) {
      header.width_px = *label.samples;
      header.height_px = *label.lines;
    }
    if (header.width_px > 0) {
      all.push_back(
          {source,
           reading(source, [&, &rover = label] { return map_of(rover, header.width_px, header.height_px); }),
           true,
           std::nullopt,
           {}});
    }
  }
  if (header.width_px < 1) {
    throw file_error("read", image, "it is neither PNG, JPEG nor TIFF, and no label gives its size",
                     "convert the image to one of them");
  }
  if (const auto found = find_gpano(image, header)) all.push_back(*found);
  if (all.empty()) {
    throw file_error(
        "use", image, "nothing says which directions it shows: no JSON or label beside it, no GPano inside",
        "write " + quoted(fs::path(image).replace_extension(".json")) +
            " with projection, width, height, azimuth_deg_at_left, degrees_per_pixel and horizon_row");
  }
  PanoramaDescription description{image,
                                  header.format,
                                  all.front().map,
                                  {},
                                  all.front().heading_is_known,
                                  {},
                                  pair.value_or(all.front().auxiliary.pair),
                                  all.front().auxiliary.planes};
  for (Found& found : all) {
    take_one_eye(found, header, description.pair);
    require_size(found, image, header, description.pair);
    require_agreement(all.front(), found);
    description.sources.push_back(found.source);
    if (!description.viewpoint) description.viewpoint = found.viewpoint;
  }
  description.map = all.front().map;
  return description;
}

}  // namespace panorama
