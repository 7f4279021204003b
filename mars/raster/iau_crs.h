// Coordinate systems of the IAU (2015) whose axes a file format has lost.
#pragma once

#include <ogr_spatialref.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "mars/raster/gdal_grid.h"

namespace mars {

// Returns letters and digits of a system's name in groups with one underscore between: what the kinds of WKT have in common,
// and what ESRI's kind of names leaves. Pure.
std::string plain_crs_name(std::string_view name);

// Returns the code in IAU_2015 of the system whose plain_crs_name() this is, as "49900", or nullopt if there is none. Reads
// the whole list of PROJ, which is long. Must be called inside a GdalScope.
std::optional<std::string> iau_code(std::string_view plain_name);

// Returns the system of authority IAU_2015 that has the name of `crs`, if `crs` lacks its axes: GeoTIFF keeps
// neither longitudes that count west (49901, 49911) nor planetocentric latitudes of an ellipsoid (49902, which
// becomes a local system). Columns of the result run along the longitude. Returns nullopt if nothing is lost,
// or if body or projection differ from those of that name. Must be called inside a GdalScope.
std::optional<OGRSpatialReference> restored_iau_crs(const OGRSpatialReference& crs);

// Removes the codes of the IAU from a system. Returns false if it has none. With them PROJ 9.1 takes the body by its
// code in one place and by its radius in another, and finds no transformation where these differ (Vesta: 255 km).
// Must be called inside a GdalScope.
bool remove_iau_codes(OGRSpatialReference& crs);

// Corrects which axis runs along the columns of a geographic system that counts longitudes west. GDAL has no
// other order there than that of the system, latitude first, whatever the file's coordinates are. If these are
// no latitudes along that axis but are along the other, the axes are exchanged. `to_map` is the geotransform.
// Returns false if both orders are possible.
bool correct_axis_order(OGRSpatialReference& crs, const std::array<double, 6>& to_map, const PixelGrid& grid);

}  // namespace mars
