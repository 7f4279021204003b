// Parses PDS3 labels and determines how they count pixels, longitudes and latitudes.
//
// Labels count LINE/SAMPLE_PROJECTION_OFFSET in three ways. Archive labels (MOLA MEGDR) follow the PDS
// standard:
// line 1 is the centre of the first line. Others (LOLA, LROC, HRSC) count it from 0, a few (MOC) from 0.5. GDAL
// assumes 0, so it places labels of the first kind one pixel too far to the north-west. The bounds in a label
// show which convention it uses.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "mars/geodesy/datum.h"

namespace mars {

// Holds the keywords of a label, named OBJECT.KEYWORD with the innermost object (upper case), or KEYWORD
// outside of any object. Values are as written, without quotes, with units ("4.0 <PIXEL/DEGREE>"). Of equal
// names the first counts.
struct PdsLabel {
  std::map<std::string, std::string, std::less<>> values;

  std::string text(std::string_view name) const;              // empty if absent
  std::optional<double> number(std::string_view name) const;  // nullopt if absent or not a number
};

// Parses up to END. Never fails: skips what it cannot parse.
PdsLabel parse_pds_label(std::string_view text);

// Describes a grid that is even in longitude and latitude. Edges are outer edges of pixels.
struct DegreeGrid {
  double west_deg = 0;
  double north_deg = 0;
  double pixels_per_degree = 0;
  bool operator==(const DegreeGrid&) const = default;
};

// Number of pixels from LINE/SAMPLE_PROJECTION_OFFSET to the outer edge of the first pixel: the offset plus
// this number is the distance in pixels from that edge to the origin of the projection.
inline constexpr double kCountsFromZero = 0.5;  // GDAL's assumption
inline constexpr double kCountsFromHalf = 0.0;
inline constexpr double kCountsFromOne = -0.5;

// Describes how a label counts.
struct PdsPlacement {
  double edge_offset_px = kCountsFromZero;
  bool edge_is_confirmed = false;  // by the bounds in the label
  // The grid of SIMPLE CYLINDRICAL maps. Labels round MAP_SCALE (0.463 km), which adds up to a pixel over a
  // file. Degrees are east, latitudes are of the label's kind.
  std::optional<DegreeGrid> grid;
  bool west_positive = false;   // longitudes count to the west, which GDAL 3.6.2 ignores
  bool planetographic = false;  // latitudes are planetographic, which GDAL 3.6.2 ignores on spheres
  // Converts a longitude as the label counts it to degrees east.
  double east(double lon_deg) const { return west_positive ? -lon_deg : lon_deg; }
};

// Returns the convention whose edge agrees within a quarter of a pixel with MAXIMUM_LATITUDE (and
// WESTERNMOST_LONGITUDE of cylindrical maps), or for polar maps with the middle of the image. If the label's
// latitudes do not span its lines, but its longitudes span the samples of a cylindrical map, these alone decide.
// Returns GDAL's own if none agrees, or if neither spans the file (bounds of the data: HiRISE, HRSC). A
// label that does not state the kind of its latitudes has planetographic ones if its longitudes count west (the
// pairing of the IAU).
PdsPlacement pds_placement(const PdsLabel& label);

// Returns MAP_PROJECTION_TYPE of an object in capitals, with spaces for underscores.
std::string pds_projection(const PdsLabel& label, const std::string& object = "IMAGE_MAP_PROJECTION");

// Returns the datum that the label's description of its values implies: MOLA's heights are counted from the
// areoid, or are radii (which GDAL makes of the label's OFFSET).
VerticalDatum pds_datum(const PdsLabel& label);

}  // namespace mars
