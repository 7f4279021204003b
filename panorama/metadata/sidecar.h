// NAME.json beside a panorama's image: its projection and its viewpoint.
//
// Keys (docs/design/panoramas.md has examples); other keys are ignored, so that programs that write images may
// add their own:
//   image                 the image's file name
//   projection            "cylinder" (rows even in tangent), "equirectangular" (rows even in angle),
//                         "facets"
//   width, height         pixels of the image
//   azimuth_deg_at_left   azimuth of the image's left edge; facets have start_yaw_deg, of facet 0's
//                         middle, and crop_left_px instead
//   columns_per_turn | degrees_per_pixel | azimuth_deg_at_right
//                         scale of columns
//   horizon_row | elevation_deg_at_top
//                         row of elevation 0, counted from the image's upper edge
//   focal_px | degrees_per_row | elevation_deg_at_bottom
//                         scale of rows where it is not that of the columns
//   facets                number of facets in the full circle
//   pose                  lon_deg, lat_deg, alt_m (above the sphere), height_m (above the ground),
//                         ground_m (elevation of the ground), datum (mars/geodesy/datum.h) of ground_m
// Keys of images that other programs have described are read, too: azimuth_deg_at_sample_0 and
// elevation_deg_at_line_0 (of the first pixel's centre), elevation_deg_per_line, rover {lon_deg_east, lat_deg,
// elevation_m_areoid, camera_height_above_ground_m_approx}.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "mars/geodesy/datum.h"
#include "panorama/image/metadata_error.h"
#include "panorama/projection.h"

namespace panorama {

// Holds what a description states of the place from where a panorama is seen.
struct RecordedViewpoint {
  double lon_deg = 0;              // east
  double lat_deg = 0;              // planetocentric
  std::optional<double> alt_m;     // of the camera above the sphere
  std::optional<double> height_m;  // of the camera above the ground
  std::optional<double> ground_m;  // elevation of the ground in `datum`
  mars::VerticalDatum datum;

  bool operator==(const RecordedViewpoint&) const = default;
};

struct Sidecar {
  std::string image;  // empty when the sidecar does not name it
  PanoramaMap map;
  std::optional<RecordedViewpoint> viewpoint;
};

// Reads a JSON text. Throws MetadataError: no JSON, absent keys, wrong types, or contradictions of more than a
// pixel.
Sidecar read_sidecar(std::string_view json);

// Returns JSON with the keys above. read_sidecar() of it gives the same map within kRoundTrip_px.
nlohmann::ordered_json to_json(const Sidecar& sidecar);
// Returns the JSON as the text of a file.
std::string to_text(const Sidecar& sidecar);

}  // namespace panorama
