// GPano: Google's XMP fields for panoramas, for cylinders and equirectangular images.
//
// Source: the namespace's public description. Lengths are whole pixels. The full image has 360 degrees
// across; the file is the part of it at cropped_left, cropped_top. For equirectangular images cropped_top is
// counted from the zenith (the full image is 180 degrees high); for cylinders from the horizon, negative
// above it. The heading is that of the full image's middle.
//
// Typical usage:
//   write_xmp(path, to_xmp(gpano_of(map)));
//   if (const auto gpano = read_gpano(packet)) map = map_of(*gpano);
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "panorama/image/metadata_error.h"
#include "panorama/projection.h"

namespace panorama {

// Holds the fields of a packet, as GPano counts them.
struct GPano {
  std::string projection_type;  // "cylindrical" or "equirectangular"
  std::int64_t cropped_width_px = 0;
  std::int64_t cropped_height_px = 0;
  std::int64_t full_width_px = 0;
  std::int64_t full_height_px = 0;
  std::int64_t cropped_left_px = 0;
  std::int64_t cropped_top_px = 0;

  std::optional<double> heading_deg;  // 0 to less than 360; absent: azimuths are counted as if it were 0
  std::optional<double> pitch_deg;
  std::optional<double> roll_deg;
  std::optional<std::int64_t> initial_heading_deg;
  std::optional<std::int64_t> initial_pitch_deg;
  std::optional<std::int64_t> initial_roll_deg;
  std::optional<double> initial_horizontal_fov_deg;
  std::optional<double> initial_vertical_fov_deg;
  std::optional<double> initial_camera_dolly;
  std::optional<bool> use_viewer;
  std::optional<bool> exposure_lock_used;
  std::optional<std::string> capture_software;
  std::optional<std::string> stitching_software;
  std::optional<std::string> first_photo_date;
  std::optional<std::string> last_photo_date;
  std::optional<std::int64_t> source_photos;
  std::optional<std::int64_t> interior_left_px;  // of the largest rectangle without nodata
  std::optional<std::int64_t> interior_top_px;
  std::optional<std::int64_t> interior_width_px;
  std::optional<std::int64_t> interior_height_px;

  bool operator==(const GPano&) const = default;
};

// Returns a whole XMP packet with the fields as elements. Leaves out characters that XML cannot hold.
std::string to_xmp(const GPano& gpano);

// Returns the fields of a packet, elements or attributes with any prefix; nullopt when it has none of GPano's.
// Throws MetadataError for XML that is not well-formed, a value of the wrong type, one field given twice with
// different values, and required fields that are absent.
std::optional<GPano> read_gpano(std::string_view xmp);

// Returns the fields in whole pixels that are nearest to a map. Throws MetadataError for facets (which GPano
// cannot express), cylinders that are not true ones (focal_px = turn_px / 2 pi), and where rounding to whole
// pixels would move a place of the image by more than max_shift_px.
GPano gpano_of(const PanoramaMap& map, double max_shift_px = 1.0);

// Returns the map of the fields. Throws MetadataError for other projections, a pitched or rolled image, and
// fields that make no map.
PanoramaMap map_of(const GPano& gpano);

}  // namespace panorama
