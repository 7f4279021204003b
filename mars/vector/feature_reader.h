// Reads the features of vector files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mars/vector/axis_order.h"
#include "mars/vector/feature.h"

namespace mars {

// Holds what to read of a file, and how much is accepted.
struct FeatureReadOptions {
  std::string layer;  // empty: all layers
  // Names of the columns of a CSV file; empty: found by their names. Either both are given or none.
  std::string lon_column;
  std::string lat_column;
  AxisOrder axis_order = AxisOrder::by_contents;
  // Limits of the whole file. A feature without vertices counts as one.
  std::size_t most_vertices = 20'000'000;
  // Limits the file, what a KMZ unpacks to, and the texts of attributes, each.
  std::size_t most_bytes = std::size_t{2} << 30;
};

// Reads points, lines and polygons of a local file. Its extension names the format:
//
//   .gpkg            GeoPackage
//   .geojson, .json  GeoJSON, also with a member "crs"
//   .shp             Shapefile with .shx and .dbf; .prj is its CRS
//   .kml, .kmz       KML; of a KMZ its doc.kml, or else the first .kml, and the documents in it that this links to
//   .gpx             GPX: waypoints, routes and tracks
//   .csv, .tsv       columns lon and lat, longitude and latitude, x and y, Center_Longitude and Center_Latitude, or
//                    one column WKT; degrees; upper and lower case do not matter
//
// Coordinates become degrees on the planet of `radius_m`, see LayerCrs, with unwrapped longitudes, see
// unwrap_longitudes(). Heights and measures are dropped. Curves become lines of 4 degrees a piece. A multi-geometry or
// a collection becomes as many shapes. Edges are straight between the vertices on the planet's own degrees, whatever
// they were in the file's map.
//
// Polygons may intersect themselves: what a straight line leaves after an odd number of outlines is inside. Rings may go
// around a pole, see pole_of(). Refused are coordinates that are not finite, latitudes beyond 90 degrees, longitudes
// beyond 3600 (a point of which both coordinates are NaN is an empty one, as GeoPackage has it), lines of fewer than 2 vertices, and rings of fewer than 3 places.
//
// Values of attributes: integers and truth values are std::int64_t, other numbers are double, all else is text, also
// dates and lists; numbers that are not finite and binary values become none. In CSV a column is of numbers if all
// of its texts are. Layers without features or without places are left out unless named.
//
// A file is read alone: names of servers and of GDAL's other file systems are refused, nothing that the file refers to
// is opened, and KML with a NetworkLink out of the file is refused, see xml_documents().
// Views of a GeoPackage that call functions are refused. GDAL writes nothing to stderr. Any number of threads
// may call this at once. Throws SourceError that names file, layer and feature, with GDAL's own words.
std::vector<FeatureLayer> read_features(const std::string& path, const FeatureReadOptions& options,
                                        double radius_m);

}  // namespace mars
