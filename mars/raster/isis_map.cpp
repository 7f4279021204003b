#include "mars/raster/isis_map.h"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "mars/geodesy/sphere.h"
#include "mars/raster/pds_map.h"

namespace mars {

std::optional<LabelGeoreference> isis_map(const IsisMapping& mapping) {
  const double a = mapping.equatorial_radius_m;
  const double c = mapping.polar_radius_m;
  const double centre = mapping.centre_lat_deg;
  if (!(a > 0) || !(c > 0) || !(std::abs(centre) <= 90)) return std::nullopt;
  const double ratio = squared_axis_ratio(a, c);
  const auto graphic = [&](double lat_deg) {
    if (mapping.planetographic || std::abs(lat_deg) >= 90) return lat_deg;
    return std::atan(std::tan(lat_deg * kRadiansPerDegree) / ratio) / kRadiansPerDegree;
  };
  std::ostringstream words;
  words << std::setprecision(17);
  double radius_m = a;
  bool spherical = true;
  if (mapping.projection == "SimpleCylindrical") {
    words << "eqc";
  } else if (mapping.projection == "Sinusoidal") {
    words << "sinu";
  } else if (mapping.projection == "Orthographic") {
    words << "ortho +lat_0=" << centre;
  } else if (mapping.projection == "Equirectangular") {
    const double lat = centre * kRadiansPerDegree;
    radius_m = a * c / std::hypot(c * std::cos(lat), a * std::sin(lat));
    words << "eqc +lat_ts=" << centre;
  } else {
    spherical = false;
    if (mapping.projection == "PolarStereographic" && centre != 0) {
      words << "stere +lat_0=" << (centre < 0 ? -90 : 90) << " +lat_ts=" << graphic(centre);
    } else if (mapping.projection == "Mercator") {
      words << "merc +lat_ts=" << graphic(centre);
    } else if (mapping.projection == "TransverseMercator" && mapping.scale_factor > 0) {
      words << "tmerc +lat_0=" << graphic(centre) << " +k=" << mapping.scale_factor;
    } else if (mapping.projection == "LambertConformal" && mapping.first_parallel_deg &&
               mapping.second_parallel_deg) {
      words << "lcc +lat_0=" << graphic(centre) << " +lat_1=" << graphic(*mapping.first_parallel_deg)
            << " +lat_2=" << graphic(*mapping.second_parallel_deg);
    } else if (mapping.projection == "LambertAzimuthalEqualArea") {
      words << "laea +lat_0=" << graphic(centre);
    } else {
      return std::nullopt;
    }
  }
  std::ostringstream crs;
  crs << std::setprecision(17) << "+proj=" << words.str()
      << " +lon_0=" << (mapping.west_positive ? -mapping.centre_lon_deg : mapping.centre_lon_deg);
  if (spherical || a == c) {
    crs << " +R=" << radius_m;
  } else {
    crs << " +a=" << a << " +b=" << c;
  }
  LabelGeoreference georeference;
  georeference.crs = crs.str() + " +units=m +no_defs";
  if (spherical && mapping.planetographic && a != c) georeference.centric_scale = ratio;
  return georeference;
}

}  // namespace mars
