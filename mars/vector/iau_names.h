// Systems of IAU_2015 that vector formats give back without their axes.
#pragma once

#include <ogr_spatialref.h>

#include <optional>
#include <string>

namespace mars {

// Returns the system of authority IAU_2015 that has the code of `crs` or, after the changes that ESRI's kind of WKT
// makes, its name, if body, kind and projection agree: GeoJSON and Shapefile keep neither longitudes that count west
// (49901, 49911) nor planetocentric latitudes of an ellipsoid (49902). Returns nullopt for all other systems. Must be
// called inside a GdalScope.
std::optional<OGRSpatialReference> with_iau_axes(const OGRSpatialReference& crs);

// Returns the code of IAU_2015 of the sphere of a body with longitudes that count east, as "49900" for "Mars", or "" if
// PROJ has none of this radius. Must be called inside a GdalScope.
std::string iau_sphere_code(const std::string& body, double radius_m);

}  // namespace mars
