// The little of a PDS3 label that GDAL does not get right: where the first pixel lies.
//
// LINE/SAMPLE_PROJECTION_OFFSET are counted in two ways. Archive labels (MOLA MEGDR) follow the PDS standard:
// line 1 is the centre of the first line. Others (LOLA, LROC, HRSC) count from 0 there. GDAL assumes the
// second, so labels of the first kind open one pixel too far north-west. A label's own bounds tell which it is.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "mars/datum.h"

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

struct PdsPlacement {
  bool counts_from_one = false;  // true: GDAL's place is one pixel too far north-west
  // For SIMPLE CYLINDRICAL the grid itself: labels round MAP_SCALE (0.463 km), off by a pixel over a file.
  std::optional<DegreeGrid> grid;
  bool west_positive = false;  // longitudes count to the west, which GDAL does not heed
};

// The convention whose edge agrees with MAXIMUM_LATITUDE (and WESTERNMOST_LONGITUDE of cylindrical maps) within
// a quarter of a pixel; GDAL's own when neither does.
PdsPlacement place_pds(const PdsLabel& label);

// From what the label says of its values: MOLA's are counted from the areoid, or are radii (which GDAL makes of the
// label's OFFSET). A label that says RADIUS and has no OFFSET counts from the sphere of its axes.
VerticalDatum pds_datum(const PdsLabel& label);

}  // namespace mars
