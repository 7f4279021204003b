// Drawings as GeoJSON (RFC 7946) and CSV.
//
// GeoJSON has coordinates in the order longitude, latitude, in degrees, east positive, planetocentric, on the
// planet's sphere. RFC 7946 means the Earth; other programs read the file as such. The foreign member "planet"
// of the collection names the body and the radius of its sphere. Edges are great circles; they are not cut at
// the date line. Outer rings run counterclockwise as the format asks for; the property "clockwise" tells that a
// polygon was drawn the other way, so that reading restores the order of its vertices.
//
//   {"type": "FeatureCollection", "planet": {"body": "Mars", "radius_m": 3396190}, "features": [
//     {"type": "Feature", "properties": {"name": "Rim", "colour": "#ffd65a", "visible": true},
//      "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}}]}
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/explore/drawing/drawing.h"

namespace vpe::explore {

struct DrawingFileLimits {
  static constexpr std::size_t kMostBytes = std::size_t{128} << 20;
};

// Describes the body that coordinates belong to.
struct PlanetSphere {
  std::string body;
  double radius_m = 0;
};

using SharedDrawings = std::span<const std::shared_ptr<const Drawing>>;

// Returns the text of a GeoJSON file. parse_geojson() reads the same drawings back to the bit, but for their
// ids.
std::string to_geojson(SharedDrawings drawings, const PlanetSphere& planet);

struct ParsedGeoJson {
  std::vector<Drawing> drawings;       // none if there is an error; ids are 0
  std::optional<PlanetSphere> planet;  // that the file names
  std::vector<std::string> notes;      // what was left out, such as holes of polygons and heights; each once
  std::string error;                   // "FILE: features[3].geometry: ...", or "FILE:LINE: ..."
};

// Parses any text. Accepts features, collections and bare geometries; parts of a Multi geometry become drawings
// of their own. `file` is its name in messages.
ParsedGeoJson parse_geojson(std::string_view text, const std::string& file);

// Returns a CSV file with a line for each vertex: drawing (its number, from 1), kind, name, colour, visible,
// vertex (from 1), lon_deg, lat_deg, and elevation_m if `elevation_m` is given; that is empty where it returns
// nullopt. Names with commas or quotes are in quotes, as RFC 4180 asks for.
std::string to_csv(SharedDrawings drawings,
                   const std::function<std::optional<double>(mars::LonLat)>& elevation_m = {});

}  // namespace vpe::explore
