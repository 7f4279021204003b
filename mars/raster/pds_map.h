// The map of a PDS3 label: its coordinate system and geotransform.
#pragma once

#include <optional>
#include <string>

#include "mars/raster/label_georeference.h"
#include "mars/raster/pds_label.h"

namespace mars {

// The projections of PDS3 and what they mean, as ISIS and the archives use them:
//   - SIMPLE CYLINDRICAL, EQUIRECTANGULAR, SINUSOIDAL, ORTHOGRAPHIC, MOLLWEIDE and oblique STEREOGRAPHIC use
//   the
//     equations of the sphere of A_AXIS_RADIUS, whatever kind their latitudes are of. Planetographic ones on a
//     flattened body therefore enter as they are; LabelPlace::centric_scale turns them into planetocentric.
//   - POLAR STEREOGRAPHIC with planetocentric latitudes: the sphere of C_AXIS_RADIUS (MOLA's polar products);
//     with planetographic ones the ellipsoid.
//   - MERCATOR, TRANSVERSE MERCATOR, LAMBERT CONFORMAL, ALBERS, LAMBERT AZIMUTHAL and CYLINDRICAL EQUAL AREA:
//     the sphere of A_AXIS_RADIUS, or the ellipsoid with planetographic latitudes.
// Longitudes that count west have the map the same way round, east to the right: only the numbers change sign.
// Of MAP_SCALE and MAP_RESOLUTION, which labels round, MAP_RESOLUTION counts if it is a whole number; in polar
// maps and on ellipsoids, where it may refer to one radius or another, only if MAP_SCALE is that number
// rounded.
//
// GDAL 3.6.2 places these wrongly: labels that count pixels from one or from a half; west-positive longitudes
// (the planet turned); planetographic latitudes on spheres (20 km at 45 degrees on Mars); "PLANETOCENTRIC" in
// quotes, as archives write it, which it takes for planetographic (polar maps on the ellipsoid: 0.3 degrees);
// oblique STEREOGRAPHIC, which it takes for polar.
//
// Nothing where the label lacks what it takes, for other projections, and for MAP_PROJECTION_ROTATION: GDAL
// may know. Throws SourceError (with `path`) for what nobody can place: triaxial bodies with planetographic
// latitudes, west-positive labels of such other projections.
std::optional<LabelPlace> pds_map(const std::string& path, const PdsLabel& label);

// Maps of 1991 (MDIM and DTM of the Viking volumes VO_2001 to VO_2014): object IMAGE_MAP_PROJECTION_CATALOG,
// SINUSOIDAL, longitudes west, latitudes planetographic. X is the axis of lines, Y of samples:
//   version 1: line = INT(X_AXIS_PROJECTION_OFFSET - lat RES + 1),
//              sample = INT(Y_AXIS_PROJECTION_OFFSET - (lon - CENTER_LONGITUDE) RES cos(lat) + 1)
//   version 2.0: the same without "+ 1".
// INT cuts: the first line of version 1 runs from 0 to 1 in X_AXIS_PROJECTION_OFFSET - lat RES, as the bounds
// in its labels say in both axes (MG30S317: within 0.001 lines). So MAXIMUM_LATITUDE tells which version, or
// whether integers were pixel centres (edge at 0.5), within a quarter of a pixel; else DATA_SET_ID ("V2.0")
// does. Positions are those of the time: several kilometres, in places 20, from today's frame. Throws
// SourceError for other projections, for missing keywords, and where offsets and bounds are more than two lines
// apart (Magellan's framelets).
bool has_pds_catalog_map(const PdsLabel& label);
LabelPlace pds_catalog_map(const std::string& path, const PdsLabel& label);

// Metres in a value with its unit in angle brackets; kilometres where it has none. "3396.19 <KM>", "1 <M/PIX>".
std::optional<double> pds_metres(const PdsLabel& label, const std::string& name);

// tan(planetocentric latitude) / tan(planetographic latitude) on a spheroid.
double squared_axis_ratio(double a_m, double c_m);

}  // namespace mars
