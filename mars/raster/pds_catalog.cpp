#include <algorithm>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/pds_map.h"

namespace mars {
namespace {

constexpr double kEdgeAgreement_px = 0.25;
constexpr double kRefuse_px = 2;
constexpr double kRadiusSlack = 0.01;  // relative: radii that MAP_SCALE and MAP_RESOLUTION may mean
const char* const kRegister = "convert it to GeoTIFF first and register it to a known map";

// Reads the object of the map. Its errors name the file and the keyword.
class Catalog {
 public:
  Catalog(const std::string& path, const PdsLabel& label) : path_(path), label_(label) {}

  std::string name(const std::string& key) const { return "IMAGE_MAP_PROJECTION_CATALOG." + key; }
  std::string text(const std::string& key) const { return label_.text(name(key)); }
  std::optional<double> number(const std::string& key) const { return label_.number(name(key)); }
  std::optional<double> metres(const std::string& key) const { return pds_metres(label_, name(key)); }
  double last_digit_m(const std::string& key) const { return pds_last_digit_m(label_, name(key)); }
  const PdsLabel& label() const { return label_; }

  double needed(const std::string& key) const {
    const auto value = number(key);
    if (!value) throw unusable(key);
    return *value;
  }

  SourceError unusable(const std::string& key) const {
    return source_error(path_, "its label has no usable " + name(key), text(key), "check the label");
  }

  SourceError error(const std::string& operation, const std::string& words, const std::string& advice) const {
    return source_error(path_, operation, words, advice);
  }

  bool is_second_version() const { return label_.text("DATA_SET_ID").find("V2.0") != std::string::npos; }

 private:
  const std::string& path_;
  const PdsLabel& label_;
};

LabelGeoreference sinusoidal_map(const Catalog& catalog) {
  const auto a_m = catalog.metres("A_AXIS_RADIUS");
  const double c_m = catalog.metres("C_AXIS_RADIUS").value_or(a_m.value_or(0));
  const double resolution = catalog.needed("MAP_RESOLUTION");
  const double line = catalog.needed("X_AXIS_PROJECTION_OFFSET");
  const double sample = catalog.needed("Y_AXIS_PROJECTION_OFFSET");
  const double centre = catalog.needed("CENTER_LONGITUDE");
  const double north = catalog.needed("MAXIMUM_LATITUDE");
  if (!a_m || !(*a_m > 0) || !(c_m > 0) || !(resolution > 0)) {
    throw catalog.error("its label has no usable radii or MAP_RESOLUTION", "", "check the label");
  }

  // `edge` is the coordinate X_AXIS_PROJECTION_OFFSET - lat RES of the outer edge of the first pixel.
  const double bound = line - north * resolution;
  double edge = catalog.is_second_version() ? 1.0 : 0.0;
  bool agrees = false;
  for (const double each : {0.0, 0.5, 1.0}) {
    if (std::abs(bound - each) >= kEdgeAgreement_px) continue;
    edge = each;
    agrees = true;
  }
  if (!agrees && !(std::abs(bound - edge) <= kRefuse_px)) {
    std::ostringstream words;
    words << "by " << bound - edge << " lines";
    throw catalog.error("its label's offsets and MAXIMUM_LATITUDE disagree", words.str(), kRegister);
  }

  const bool west = catalog.text("POSITIVE_LONGITUDE_DIRECTION") != "EAST";
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

// ---- About a pole

// The spheroid of a polar map; a sphere has equal axes.
struct PolarFigure {
  double a_m = 0;
  double c_m = 0;

  // Returns the distance on the map from the pole, true to scale there, of a latitude counted towards that pole.
  double distance_m(double lat_deg) const {
    const double e = std::sqrt(std::max(0.0, 1 - squared_axis_ratio(a_m, c_m)));
    const double lat = lat_deg * kRadiansPerDegree;
    const double curve = e * std::sin(lat);
    const double t = std::tan((kPi / 2 - lat) / 2) / std::pow((1 - curve) / (1 + curve), e / 2);
    return 2 * a_m * t / std::sqrt(std::pow(1 + e, 1 + e) * std::pow(1 - e, 1 - e));
  }
};

bool counts_west(const Catalog& catalog) {
  std::string way = catalog.text("POSITIVE_LONGITUDE_DIRECTION");
  for (char& c : way) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (way != "WEST" && way != "EAST") throw catalog.unusable("POSITIVE_LONGITUDE_DIRECTION");
  return way == "WEST";
}

// Returns an offset that the keywords of 1991 or those of later years give.
double polar_offset(const Catalog& catalog, const std::string& key, const std::string& later_key) {
  const auto value = catalog.number(key);
  const auto later = catalog.number(later_key);
  if (value && later && std::abs(*value - *later) > kEdgeAgreement_px) {
    throw catalog.error("its label's " + catalog.name(key) + " and " + later_key + " disagree",
                        catalog.text(key) + " and " + catalog.text(later_key),
                        "remove the wrong one from the label");
  }
  if (!value && later) return *later;
  return value ? *value : catalog.needed(key);
}

double polar_pixel_m(const Catalog& catalog, double a_m, double c_m) {
  const auto scale = catalog.metres("MAP_SCALE");
  const auto resolution = catalog.number("MAP_RESOLUTION");
  if ((scale && !(*scale > 0)) || (!scale && a_m != c_m)) throw catalog.unusable("MAP_SCALE");
  if (resolution ? !(*resolution > 0) : !scale) throw catalog.unusable("MAP_RESOLUTION");
  if (!resolution) return *scale;
  const double least_m = std::min(a_m, c_m) * kRadiansPerDegree / *resolution;
  const double most_m = a_m * std::max(1.0, a_m / c_m) * kRadiansPerDegree / *resolution;
  if (!scale) return most_m;
  for (const double radius_m : {a_m, c_m, a_m * a_m / c_m}) {
    const double by_resolution_m = radius_m * kRadiansPerDegree / *resolution;
    if (std::abs(by_resolution_m - *scale) <= catalog.last_digit_m("MAP_SCALE")) return by_resolution_m;
  }
  if (*scale < (1 - kRadiusSlack) * least_m || *scale > (1 + kRadiusSlack) * most_m) {
    throw catalog.error(
        "its label's " + catalog.name("MAP_SCALE") + " and MAP_RESOLUTION disagree",
        catalog.text("MAP_SCALE") + " and " + catalog.text("MAP_RESOLUTION"),
        "correct the wrong one in the label: one degree at the pole is A_AXIS_RADIUS times pi / 180");
  }
  return *scale;
}

// Throws if the bounds of the label are not those of an image whose pole lies at `pole`, in pixels from its corner.
void check_polar_bounds(const Catalog& catalog, const PolarFigure& figure, double scale_m, bool south,
                        double pole_line, double pole_sample, double lines, double samples) {
  const auto outside = [](double at, double size) { return std::max({0.0, -at, at - size}); };
  const auto farthest = [](double at, double size) { return std::max(std::abs(at), std::abs(at - size)); };
  const double near_px = std::hypot(outside(pole_line, lines), outside(pole_sample, samples));
  const double far_px = std::hypot(farthest(pole_line, lines), farthest(pole_sample, samples));
  for (const bool is_near : {true, false}) {
    const std::string key = is_near == south ? "MINIMUM_LATITUDE" : "MAXIMUM_LATITUDE";
    const auto bound = catalog.number(key);
    if (!bound) continue;
    if (!(std::abs(*bound) <= 90)) throw catalog.unusable(key);
    const double bound_px = figure.distance_m(south ? -*bound : *bound) / scale_m;
    const double most_px = is_near && near_px == 0 ? 0.0 : far_px;
    if (bound_px >= near_px - kRefuse_px && bound_px <= most_px + kRefuse_px) continue;
    std::ostringstream words;
    words << *bound << " degrees lie " << bound_px << " pixels from the pole, the image from " << near_px
          << " to " << far_px;
    throw catalog.error("its label's offsets and " + catalog.name(key) + " disagree", words.str(), kRegister);
  }
}

LabelGeoreference polar_map(const Catalog& catalog) {
  const double centre_lat = catalog.needed("CENTER_LATITUDE");
  if (std::abs(centre_lat) != 90) {
    throw catalog.error(
        "its label of 1991 has a polar map whose " + catalog.name("CENTER_LATITUDE") + " is no pole",
        catalog.text("CENTER_LATITUDE"), "set it to 90 or -90 in the label");
  }
  if (catalog.number("MAP_PROJECTION_ROTATION").value_or(0.0) != 0) {
    throw catalog.error("its label of 1991 has a rotated map: " + catalog.name("MAP_PROJECTION_ROTATION"),
                        catalog.text("MAP_PROJECTION_ROTATION"), kRegister);
  }
  const bool south = centre_lat < 0;
  const bool west = counts_west(catalog);
  const double centre_lon = catalog.needed("CENTER_LONGITUDE");
  const double line = polar_offset(catalog, "X_AXIS_PROJECTION_OFFSET", "LINE_PROJECTION_OFFSET");
  const double sample = polar_offset(catalog, "Y_AXIS_PROJECTION_OFFSET", "SAMPLE_PROJECTION_OFFSET");
  const auto a_m = catalog.metres("A_AXIS_RADIUS");
  if (!a_m || !(*a_m > 0)) throw catalog.unusable("A_AXIS_RADIUS");
  const double c_m = catalog.metres("C_AXIS_RADIUS").value_or(*a_m);
  if (!(c_m > 0)) throw catalog.unusable("C_AXIS_RADIUS");
  const bool ellipsoid = west && *a_m != c_m;
  const PolarFigure figure = ellipsoid ? PolarFigure{*a_m, c_m} : PolarFigure{c_m, c_m};
  const double scale_m = polar_pixel_m(catalog, *a_m, c_m);

  const double lines = catalog.label().number("IMAGE.LINES").value_or(0.0);
  const double samples = catalog.label().number("IMAGE.LINE_SAMPLES").value_or(0.0);
  double edge = catalog.is_second_version() ? 1.0 : 0.0;
  for (const double each : {0.0, 0.5, 1.0}) {
    const bool agrees = std::abs(line - each - lines / 2) < kEdgeAgreement_px &&
                        std::abs(sample - each - samples / 2) < kEdgeAgreement_px;
    if (agrees) edge = each;
  }
  check_polar_bounds(catalog, figure, scale_m, south, line - edge, sample - edge, lines, samples);

  const char* const pole = south ? "-90" : "90";
  std::ostringstream crs;
  crs << std::setprecision(17) << "+proj=stere +lat_0=" << pole << " +lat_ts=" << pole
      << " +lon_0=" << (west ? -centre_lon : centre_lon);
  if (ellipsoid) {
    crs << " +a=" << *a_m << " +b=" << c_m;
  } else {
    crs << " +R=" << c_m;
  }
  LabelGeoreference georeference;
  georeference.crs = crs.str() + " +units=m +no_defs";
  georeference.to_map = {-(sample - edge) * scale_m, scale_m, 0, (line - edge) * scale_m, 0, -scale_m};
  return georeference;
}

}  // namespace

bool has_pds_catalog_map(const PdsLabel& label) {
  return !label.text("IMAGE_MAP_PROJECTION_CATALOG.MAP_PROJECTION_TYPE").empty();
}

LabelGeoreference pds_catalog_map(const std::string& path, const PdsLabel& label) {
  const Catalog catalog(path, label);
  const std::string type = pds_projection(label, "IMAGE_MAP_PROJECTION_CATALOG");
  if (type == "SINUSOIDAL") return sinusoidal_map(catalog);
  if (type == "POLAR STEREOGRAPHIC" || type == "STEREOGRAPHIC") return polar_map(catalog);
  throw catalog.error("its label of 1991 has a map that is neither SINUSOIDAL nor POLAR STEREOGRAPHIC", type,
                      "convert it to GeoTIFF first, e.g. with ISIS (pds2isis, then gdal_translate)");
}

}  // namespace mars
