// Derives coordinate system and geotransform of a map from its PDS3 label.
#pragma once

#include <optional>
#include <string>

#include "mars/raster/label_georeference.h"
#include "mars/raster/pds_label.h"

namespace mars {

// Returns the georeference of a label, or nullopt if the label lacks needed values, for other projections, and
// for MAP_PROJECTION_ROTATION: GDAL may support those. Throws SourceError (with `path`) for maps that cannot be
// placed:
// triaxial bodies with planetographic latitudes, and west-positive labels of such other projections.
//
// The projections of PDS3, as ISIS and the archives use them:
// - SIMPLE CYLINDRICAL, EQUIRECTANGULAR, SINUSOIDAL, ORTHOGRAPHIC, MOLLWEIDE and oblique STEREOGRAPHIC use the
//   equations of the sphere of A_AXIS_RADIUS for latitudes of either kind. Planetographic latitudes on a
//   flattened body are therefore used unchanged; LabelGeoreference::centric_scale converts them to
//   planetocentric.
// - POLAR STEREOGRAPHIC uses the sphere of C_AXIS_RADIUS with planetocentric latitudes (MOLA's polar products),
//   and the ellipsoid with planetographic ones.
// - MERCATOR, TRANSVERSE MERCATOR, LAMBERT CONFORMAL, ALBERS, LAMBERT AZIMUTHAL and CYLINDRICAL EQUAL AREA use
//   the sphere of A_AXIS_RADIUS, or the ellipsoid with planetographic latitudes.
// Where longitudes count west, east is still to the right of the map: only the numbers change sign. Labels
// round MAP_SCALE and MAP_RESOLUTION. MAP_RESOLUTION is used if it is a whole number; in polar maps and on
// ellipsoids, where it may refer to one radius or another, only if MAP_SCALE is that number rounded.
//
// GDAL 3.6.2 misplaces these: labels that count pixels from one or from a half; west-positive longitudes (the
// planet is rotated); planetographic latitudes on spheres (20 km at 45 degrees on Mars); "PLANETOCENTRIC" in
// quotes, as archives write it, which it takes for planetographic (polar maps on the ellipsoid: 0.3 degrees);
// oblique STEREOGRAPHIC, which it takes for polar.
std::optional<LabelGeoreference> pds_map(const std::string& path, const PdsLabel& label);

// Returns true for maps of 1991 (MDIM and DTM of the Viking volumes VO_2001 to VO_2014), which have an object
// IMAGE_MAP_PROJECTION_CATALOG.
bool has_pds_catalog_map(const PdsLabel& label);

// Returns the georeference of a map of 1991. X is the axis of lines, Y of samples, and longitudes count west.
//
// SINUSOIDAL, latitudes planetographic (volinfo.txt of the MDIM, appendix E):
// - version 1: line = INT(X_AXIS_PROJECTION_OFFSET - lat RES + 1), sample = INT(Y_AXIS_PROJECTION_OFFSET - (lon
//   - CENTER_LONGITUDE) RES cos(lat) + 1)
// - version 2.0: the same without "+ 1".
// INT truncates: the first line of version 1 runs from 0 to 1 in X_AXIS_PROJECTION_OFFSET - lat RES, as the
// bounds in its labels confirm in both axes (MG30S317: within 0.001 lines). So MAXIMUM_LATITUDE shows the
// version, or whether integers were pixel centres (edge at 0.5), within a quarter of a pixel; else DATA_SET_ID
// ("V2.0") does.
//
// POLAR STEREOGRAPHIC, and STEREOGRAPHIC about a pole. The catalogues of the time (DSMAPP.LBL of Magellan's P-MIDR,
// 1991; DSMAP.CAT of Clementine, 1997) count east: sample = Y + D sin(lon - CENTER_LONGITUDE) + 0.5, line = X + D
// cos(lon - CENTER_LONGITUDE) + 0.5 about the north pole, and X - D cos(...) + 0.5 about the south pole, where
// integers are pixel centres and D = 2 tan(colatitude / 2) radius / MAP_SCALE. So X and Y are the distances of the
// pole from the outer edges of the first pixel, as X is that of the equator in version 1. West longitudes change the
// sign of lon and CENTER_LONGITUDE alone; east is on the right of CENTER_LONGITUDE, which runs down from the north
// pole and up from the south pole. The edge lies at 0, 0.5 or 1 where that puts the pole into the middle of the
// image, within a quarter of a pixel; else DATA_SET_ID tells. On a flattened body west longitudes mean planetographic
// latitudes and Snyder's equations of the ellipsoid (USGS Professional Paper 1395, 21-33 and 15-9), and east ones
// planetocentric latitudes on the sphere of C_AXIS_RADIUS, as in pds_map(). MAP_SCALE holds at the pole; where it is
// A_AXIS_RADIUS, C_AXIS_RADIUS or A^2 / C over MAP_RESOLUTION rounded, that number counts.
//
// Positions are those of the time: several kilometres, in places 20, from today's frame. Throws SourceError for
// other projections, for absent and contradictory keywords, and if offsets and bounds differ by more than two
// lines (Magellan's framelets).
LabelGeoreference pds_catalog_map(const std::string& path, const PdsLabel& label);

// Returns a value in metres. Its unit stands in angle brackets; without one it is kilometres. "3396.19 <KM>",
// "1 <M/PIX>".
std::optional<double> pds_metres(const PdsLabel& label, const std::string& name);

// Returns the value of one unit in the last written digit of such a value, in metres: 1 for "0.463 <KM/PIXEL>"; 0 if
// it has no number.
double pds_last_digit_m(const PdsLabel& label, const std::string& name);

// Returns tan(planetocentric latitude) / tan(planetographic latitude) on a spheroid.
double squared_axis_ratio(double a_m, double c_m);

}  // namespace mars
