// The values of a planet file at one place, for `vpe query` and the read-out under a cursor.
//
// Typical usage:
//   const PlaceAnswer answer = query(surface, {.lon_deg = 137.4, .lat_deg = -4.6});
#pragma once

#include <string>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"

namespace paging {

struct PlaceAnswer {
  mars::LonLat place;               // longitude in (-180, 180]
  bool nodata = false;              // no source has data there; the other values are those of the drawn surface
  double elevation_m = 0;           // of the reference surface, in PlanetMeta::datum
  double slope_deg = 0;             // of the facet, 0..90
  double aspect_deg = 0;            // of steepest descent, clockwise from north, [0, 360); 0 on level ground
  int level = 0;                    // of the finest tile there, 0 = coarsest
  double spacing_m = 0;             // of its posts
  std::string source;               // names of the sources that its posts come from, joined by ';'
  double geometric_error_m = 0;     // of the finest tile as drawn: 0 where it equals the reference surface
  ResamplingError resampling;       // against the sources' own posts, on the whole planet
  ResamplingError resampling_here;  // over the finest tiles of this level; posts = 0 where not measured
};

// Returns the values at a place; its latitude must be within -90..90. The error of the elevation is that of
// Surface::at(). Any thread may call it. Throws PlanetError.
PlaceAnswer query(const Surface& surface, mars::LonLat place);

// Returns the zero of elevations for people: "areoid", or "sphere:3396190 (true radii)".
std::string describe_datum(const PlanetMeta& meta);

}  // namespace paging
