// A PDS3 label as text, and how it counts pixels, longitudes and latitudes.
//
// LINE/SAMPLE_PROJECTION_OFFSET are counted in three ways. Archive labels (MOLA MEGDR) follow the PDS standard:
// line 1 is the centre of the first line. Others (LOLA, LROC, HRSC) count from 0 there, a few (MOC) from 0.5.
// GDAL assumes the second, so labels of the first kind open one pixel too far north-west. A label's own bounds
// tell which it is.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "mars/geodesy/datum.h"

namespace mars {

// Keywords of a label, named OBJECT.KEYWORD with the innermost object (upper case), or KEYWORD outside of any.
// Values as written, without quotes, units included ("4.0 <PIXEL/DEGREE>"). The first of equal names counts.
struct PdsLabel {
  std::map<std::string, std::string, std::less<>> values;

  std::string text(std::string_view name) const;              // empty when absent
  std::optional<double> number(std::string_view name) const;  // nothing when absent or not a number
};

// Reads up to END. Never fails: what cannot be understood is left out.
PdsLabel parse_pds_label(std::string_view text);

// A grid that is even in longitude and latitude; edges are outer edges of pixels.
struct DegreeGrid {
  double west_deg = 0;
  double north_deg = 0;
  double pixels_per_degree = 0;
  bool operator==(const DegreeGrid&) const = default;
};

// How many pixels beyond LINE/SAMPLE_PROJECTION_OFFSET the outer edge of the first pixel lies: that plus the
// offset is the distance in pixels from the edge to the projection's origin.
inline constexpr double kCountsFromZero = 0.5;  // what GDAL assumes
inline constexpr double kCountsFromHalf = 0.0;
inline constexpr double kCountsFromOne = -0.5;

struct PdsPlacement {
  double edge_offset_px = kCountsFromZero;
  bool edge_is_proved = false;  // the label's bounds say so
  // For SIMPLE CYLINDRICAL the grid itself: labels round MAP_SCALE (0.463 km), off by a pixel over a file.
  // Degrees are east, latitudes of the label's kind.
  std::optional<DegreeGrid> grid;
  bool west_positive = false;   // longitudes count to the west, which GDAL 3.6.2 does not heed
  bool planetographic = false;  // latitudes are planetographic, which GDAL 3.6.2 does not heed on spheres
  // Longitude in the label's counting to degrees east.
  double east(double lon_deg) const { return west_positive ? -lon_deg : lon_deg; }
};

// The convention whose edge agrees with MAXIMUM_LATITUDE (and WESTERNMOST_LONGITUDE of cylindrical maps), or
// for polar maps with the image's middle, within a quarter of a pixel; GDAL's own when none does, or when the
// label's latitudes are not as far apart as its lines (bounds of the data: HiRISE, HRSC). A label that does not
// name the kind of its latitudes has planetographic ones if its longitudes count west (the IAU's pairing).
PdsPlacement place_pds(const PdsLabel& label);

// MAP_PROJECTION_TYPE of an object in capitals, with spaces for underscores.
std::string pds_projection(const PdsLabel& label, const std::string& object = "IMAGE_MAP_PROJECTION");

// From what the label says of its values: MOLA's are counted from the areoid, or are radii (which GDAL makes of
// the label's OFFSET).
VerticalDatum pds_datum(const PdsLabel& label);

}  // namespace mars
