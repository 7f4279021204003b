#include <cmath>
#include <iomanip>
#include <sstream>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_scope.h"
#include "mars/raster/pds_map.h"

namespace mars {
namespace {

constexpr double kEdgeAgreement_px = 0.25;
constexpr double kRefuse_px = 2;

}  // namespace

bool has_pds_catalog_map(const PdsLabel& label) {
  return !label.text("IMAGE_MAP_PROJECTION_CATALOG.MAP_PROJECTION_TYPE").empty();
}

LabelGeoreference pds_catalog_map(const std::string& path, const PdsLabel& label) {
  const std::string object = "IMAGE_MAP_PROJECTION_CATALOG.";
  const auto needed = [&](const char* key) {
    const auto value = label.number(object + key);
    if (!value) {
      throw source_error(path, "its label has no usable " + object + key, label.text(object + key),
                         "check the label");
    }
    return *value;
  };
  const std::string type = pds_projection(label, "IMAGE_MAP_PROJECTION_CATALOG");
  if (type != "SINUSOIDAL") {
    throw source_error(path, "its label of 1991 has a map that is not SINUSOIDAL", type,
                       "convert it to GeoTIFF first, e.g. with ISIS (pds2isis, then gdal_translate)");
  }
  const auto a_m = pds_metres(label, object + "A_AXIS_RADIUS");
  const double c_m = pds_metres(label, object + "C_AXIS_RADIUS").value_or(a_m.value_or(0));
  const double resolution = needed("MAP_RESOLUTION");
  const double line = needed("X_AXIS_PROJECTION_OFFSET");
  const double sample = needed("Y_AXIS_PROJECTION_OFFSET");
  const double centre = needed("CENTER_LONGITUDE");
  const double north = needed("MAXIMUM_LATITUDE");
  if (!a_m || !(*a_m > 0) || !(c_m > 0) || !(resolution > 0)) {
    throw source_error(path, "its label has no usable radii or MAP_RESOLUTION", "", "check the label");
  }

  // `edge` is the coordinate X_AXIS_PROJECTION_OFFSET - lat RES of the outer edge of the first pixel.
  const double bound = line - north * resolution;
  const bool second = label.text("DATA_SET_ID").find("V2.0") != std::string::npos;
  double edge = second ? 1.0 : 0.0;
  bool agrees = false;
  for (const double each : {0.0, 0.5, 1.0}) {
    if (std::abs(bound - each) >= kEdgeAgreement_px) continue;
    edge = each;
    agrees = true;
  }
  if (!agrees && !(std::abs(bound - edge) <= kRefuse_px)) {
    std::ostringstream words;
    words << "by " << bound - edge << " lines";
    throw source_error(path, "its label's offsets and MAXIMUM_LATITUDE disagree", words.str(),
                       "convert it to GeoTIFF first and register it to a known map");
  }

  const bool west = label.text(object + "POSITIVE_LONGITUDE_DIRECTION") != "EAST";
  const double scale_m = *a_m * kRadiansPerDegree / resolution;
  std::ostringstream crs;
  crs << std::setprecision(17) << "+proj=sinu +lon_0=" << (west ? -centre : centre) << " +R=" << *a_m
      << " +units=m +no_defs";
  LabelGeoreference georeference;
  georeference.crs = crs.str();
  georeference.to_map = {-(sample - edge) * scale_m, scale_m, 0, (line - edge) * scale_m, 0, -scale_m};
  if (*a_m != c_m && west) georeference.centric_scale = squared_axis_ratio(*a_m, c_m);
  return georeference;
}

}  // namespace mars
