// The values of a planet file at one place, for `vpe query` and the read-out under a cursor.
//
// Typical usage:
//   const PlaceAnswer answer = query(surface, {.lon_deg = 137.4, .lat_deg = -4.6});
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"

namespace paging {

struct PlaceAnswer {
  mars::LonLat place;      // longitude in (-180, 180]
  bool nodata = false;     // no source has data there; the other values are those of the drawn surface
  double elevation_m = 0;  // of the reference surface, in PlanetMeta::datum
  double slope_deg = 0;    // of the facet, 0..90
  double aspect_deg = 0;   // of steepest descent, clockwise from north, [0, 360); 0 on level ground
  int level = 0;           // of the finest tile there, 0 = coarsest
  double spacing_m = 0;    // of its posts
  // The source of the nearest post, which is one of the facet's: index into PlanetMeta::sources. nullopt at
  // nodata, and where the file does not tell: tiles of several sources before format 1.3.
  std::optional<int> source;
  std::vector<int> tile_sources;  // indices of all sources that posts of the tile come from
  double geometric_error_m = 0;   // of the finest tile as drawn: 0 where it equals the reference surface
  // Against the posts of that source: in the finest tile, or where it has none of them in all finest tiles of
  // the level. posts = 0 where it is not known.
  ResamplingError resampling;
  bool resampling_of_level = false;   // `resampling` is that of the level
  ResamplingError planet_resampling;  // against the posts of all sources, on the whole planet
};

// Returns the values at a place; its latitude must be within -90..90. The error of the elevation is that of
// Surface::at(). Any thread may call it. Throws PlanetError.
PlaceAnswer query(const Surface& surface, mars::LonLat place);

// Holds PlaceAnswer::slope_deg and aspect_deg.
struct SlopeAndAspect {
  double slope_deg = 0;
  double aspect_deg = 0;
};
// Returns those of a facet by its normal, outward and body-fixed, at a place. Pure.
SlopeAndAspect slope_and_aspect(const glm::dvec3& normal, mars::LonLat place);

// Returns the source of the nearest post in a direction (of any length but 0), as PlaceAnswer::source. Throws
// PlanetError.
std::optional<int> source_at(const Surface& surface, const glm::dvec3& direction);

// Returns whether the height in a direction is made up rather than measured; nullopt where there is no data, and where the
// file does not tell. Throws PlanetError.
std::optional<bool> is_synthetic(const Surface& surface, const glm::dvec3& direction);

// Returns the zero of elevations for people: "areoid", or "sphere:3396190 (true radii)".
std::string describe_datum(const PlanetMeta& meta);

}  // namespace paging
