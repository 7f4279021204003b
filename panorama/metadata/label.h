// Labels of rover mosaics: the azimuths and elevations of their lines and samples.
//
// Read are the group SURFACE_PROJECTION_PARMS of JPL's PDS3 and VICAR labels (detached, or at the start of the
// image's file), and cart:Cylindrical of PDS4. JPL's CYLINDRICAL is even in angle in both directions: lines
// have constant elevation, so its map is kEquirectangular. By the label's own equations
//   azimuth = START_AZIMUTH + sample / columns_per_degree
//   elevation = (ZERO_ELEVATION_LINE - line) / rows_per_degree
// whole samples and lines are pixel centres. Samples count from 0. Lines count from the number that
// MAXIMUM_ELEVATION gives to the first line (1 or 0), else from 1.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "panorama/image/metadata_error.h"
#include "panorama/projection.h"

namespace panorama {

// Holds what a label states of its projection.
struct RoverLabel {
  double columns_per_degree = 0;
  double rows_per_degree = 0;
  double start_azimuth_deg = 0;
  double zero_elevation_line = 0;
  std::optional<double> stop_azimuth_deg;
  std::optional<double> maximum_elevation_deg;
  std::optional<double> minimum_elevation_deg;
  std::optional<std::int64_t> lines;  // of the label's own image
  std::optional<std::int64_t> samples;
  std::string frame;  // REFERENCE_COORD_SYSTEM_NAME, empty when the label does not name it
};

// Returns whether a file that starts with this text has a label of PDS3 or VICAR there.
bool is_label_start(std::string_view text);

// Read a label. Return nullopt for text that has no such group. Throw MetadataError for a label that cannot be
// used: other projections (by name), frames that turn with the rover, units that are not angles, absent values.
std::optional<RoverLabel> read_text_label(std::string_view text);
std::optional<RoverLabel> read_pds4_label(std::string_view xml);

// Returns the map of an image of the label's size. Throws MetadataError when label and size contradict each
// other or the label contradicts itself.
PanoramaMap map_of(const RoverLabel& label, std::int64_t width_px, std::int64_t height_px);

}  // namespace panorama
