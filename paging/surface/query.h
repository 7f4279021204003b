// What a planet file says of one place: the numbers of `vpe query` and of the read-out under a cursor.
#pragma once

#include <string>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"

namespace paging {

struct PlaceAnswer {
  mars::LonLat place;            // longitude in (-180, 180]
  bool nodata = false;           // no source has data there; what follows is of the ground as it is drawn
  double elevation_m = 0;        // of S, in PlanetMeta::datum
  double slope_deg = 0;          // of the facet of S, 0..90
  double aspect_deg = 0;         // of steepest descent, clockwise from north, [0, 360); 0 on level ground
  int level = 0;                 // of the finest tile there, 1 = coarsest
  double spacing_m = 0;          // of its posts
  std::string source;            // names of the sources that its posts come from, joined by ';'
  double geometric_error_m = 0;  // of the finest tile as drawn: 0 where that is S
  ResamplingError resampling;    // S against the sources' own posts, on the whole planet
  ResamplingError
      resampling_here;  // the same over the finest tiles of this level; posts = 0 where not measured
};

// The place's latitude is within -90..90. Error of the elevation as Surface::at(). Any thread. Throws
// PlanetError.
PlaceAnswer query(const Surface& surface, mars::LonLat place);

// "areoid", or "sphere:3396190 (true radii)": what elevations are counted from.
std::string describe_datum(const PlanetMeta& meta);

}  // namespace paging
