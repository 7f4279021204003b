// NAME.json beside a panorama's image: its projection, and from where it was seen.
//
// Keys (docs/panoramas.md has examples); others are left alone, so that who writes images may add more:
//   image                              the image's file name
//   projection                         "cylinder" (rows even in tangent), "equirectangular" (rows even in
//   angle),
//                                      "facets"
//   width, height                      pixels of the image
//   azimuth_deg_at_left                of the image's left edge; or start_yaw_deg, of facet 0's middle, and
//                                      crop_left_px with facets
//   columns_per_turn | degrees_per_pixel | azimuth_deg_at_right
//   horizon_row | elevation_deg_at_top row of elevation 0, counted from the image's upper edge
//   focal_px | degrees_per_row | elevation_deg_at_bottom
//                                      scale of rows where it is not that of the columns
//   facets                             how many to the turn
//   pose                               lon_deg, lat_deg, alt_m (above the sphere), height_m (above the ground),
//                                      ground_m (elevation of the ground), datum (mars/geodesy/datum.h) of ground_m
// and the words of images that others have described: azimuth_deg_at_sample_0 and elevation_deg_at_line_0 (of
// the first pixel's centre), elevation_deg_per_line, rover {lon_deg_east, lat_deg, elevation_m_areoid,
// camera_height_above_ground_m_approx}.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "mars/geodesy/datum.h"
#include "panorama/image/metadata_error.h"
#include "panorama/projection.h"

namespace panorama {

// From where a panorama is seen, as far as it is known.
struct Viewpoint {
  double lon_deg = 0;              // east
  double lat_deg = 0;              // planetocentric
  std::optional<double> alt_m;     // of the camera above the sphere
  std::optional<double> height_m;  // of the camera above the ground
  std::optional<double> ground_m;  // elevation of the ground in `datum`
  mars::VerticalDatum datum;

  bool operator==(const Viewpoint&) const = default;
};

struct Sidecar {
  std::string image;  // empty when it does not say
  PanoramaMap map;
  std::optional<Viewpoint> viewpoint;
};

// Throws MetadataError: no JSON, keys missing, of the wrong type, or in contradiction by more than a pixel.
Sidecar read_sidecar(std::string_view json);

// JSON of the keys above; read_sidecar() of it gives the same map within kRoundTrip_px.
std::string to_json(const Sidecar& sidecar);

}  // namespace panorama
