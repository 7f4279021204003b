// The map of a PDS3 label: its coordinate system and geotransform.
#pragma once

#include <optional>
#include <string>

#include "mars/label_place.h"
#include "mars/pds_label.h"

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
// Of MAP_SCALE and MAP_RESOLUTION, which labels round, MAP_RESOLUTION counts if it is a whole number.
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

// Metres in a value with its unit in angle brackets; kilometres where it has none. "3396.19 <KM>", "1 <M/PIX>".
std::optional<double> pds_metres(const PdsLabel& label, const std::string& name);

// tan(planetocentric latitude) / tan(planetographic latitude) on a spheroid.
double squared_axis_ratio(double a_m, double c_m);

}  // namespace mars
