#include "mars/raster/pds_map.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"

namespace mars {
namespace {

const std::string kObject = "IMAGE_MAP_PROJECTION.";
constexpr double kRounding = 0.01;  // relative difference of MAP_SCALE and MAP_RESOLUTION taken for rounding

struct Axes {
  double a_m = 0;
  double b_m = 0;
  double c_m = 0;
};

std::optional<Axes> axes(const PdsLabel& label) {
  const auto a = pds_metres(label, kObject + "A_AXIS_RADIUS");
  if (!a || !(*a > 0)) return std::nullopt;
  const double b = pds_metres(label, kObject + "B_AXIS_RADIUS").value_or(*a);
  const double c = pds_metres(label, kObject + "C_AXIS_RADIUS").value_or(*a);
  if (!(b > 0) || !(c > 0)) return std::nullopt;
  return Axes{*a, b, c};
}

enum class Figure { kSphere, kPolarSphere, kEither };  // kEither: the ellipsoid with planetographic latitudes

struct Projection {
  std::string words;  // PROJ string without the body and the central meridian
  Figure body = Figure::kSphere;
};

std::string text_of(double value) {
  std::ostringstream out;
  out << std::setprecision(17) << value;
  return out.str();
}

std::optional<Projection> projection(const PdsLabel& label, const PdsPlacement& placement) {
  const auto number = [&](const char* key) { return label.number(kObject + key); };
  const double centre = number("CENTER_LATITUDE").value_or(0.0);
  if (!(std::abs(centre) <= 90)) return std::nullopt;
  const auto parallels = [&]() -> std::optional<std::string> {
    const auto first = number("FIRST_STANDARD_PARALLEL");
    const auto second = number("SECOND_STANDARD_PARALLEL");
    if (!first) return std::nullopt;
    return " +lat_1=" + text_of(*first) + " +lat_2=" + text_of(second.value_or(*first));
  };
  const std::string at_centre = " +lat_0=" + text_of(centre);
  const std::string type = pds_projection(label);
  if (type == "SIMPLE CYLINDRICAL") {
    // True to scale at the equator by definition. Lines count from CENTER_LATITUDE if the bounds confirm that.
    const auto line = number("LINE_PROJECTION_OFFSET");
    const auto north = number("MAXIMUM_LATITUDE");
    const auto resolution = number("MAP_RESOLUTION");
    const bool from_centre = centre != 0 && !placement.edge_is_confirmed && line && north && resolution &&
                             std::abs(*line - (*north - centre) * *resolution) <= 1;
    return Projection{from_centre ? "eqc +lat_ts=0" + at_centre : "eqc +lat_ts=0"};
  }
  if (type == "EQUIRECTANGULAR" || type == "EQUIDISTANT") return Projection{"eqc +lat_ts=" + text_of(centre)};
  if (type == "SINUSOIDAL") return Projection{"sinu"};
  if (type == "MOLLWEIDE") return Projection{"moll"};
  if (type == "ORTHOGRAPHIC") return Projection{"ortho" + at_centre};
  if (type == "POLAR STEREOGRAPHIC" || (type == "STEREOGRAPHIC" && std::abs(centre) == 90)) {
    const std::string pole = centre < 0 ? "-90" : "90";
    return Projection{"stere +lat_0=" + pole + " +lat_ts=" + pole, Figure::kPolarSphere};
  }
  if (type == "STEREOGRAPHIC") return Projection{"stere" + at_centre};
  if (type == "MERCATOR") return Projection{"merc +lat_ts=" + text_of(centre), Figure::kEither};
  if (type == "TRANSVERSE MERCATOR") return Projection{"tmerc" + at_centre, Figure::kEither};
  if (type == "LAMBERT AZIMUTHAL EQUAL AREA") return Projection{"laea" + at_centre, Figure::kEither};
  if (type == "CYLINDRICAL EQUAL AREA") {
    const auto parallel = number("FIRST_STANDARD_PARALLEL");
    return Projection{"cea +lat_ts=" + text_of(parallel.value_or(centre)), Figure::kEither};
  }
  if (type == "LAMBERT CONFORMAL" || type == "LAMBERT CONFORMAL CONIC" || type == "ALBERS") {
    const auto both = parallels();
    if (!both) return std::nullopt;
    return Projection{(type == "ALBERS" ? "aea" : "lcc") + at_centre + *both, Figure::kEither};
  }
  return std::nullopt;
}

// Returns metres per pixel on a sphere of this radius. If the label may mean another radius (`unsure`),
// MAP_RESOLUTION is used only if MAP_SCALE is its rounding.
std::optional<double> pixel_m(const PdsLabel& label, double radius_m, bool unsure) {
  const auto scale = pds_metres(label, kObject + "MAP_SCALE");
  const auto resolution = label.number(kObject + "MAP_RESOLUTION");
  if (!resolution || !(*resolution > 0)) return scale && *scale > 0 ? scale : std::nullopt;
  const double by_resolution = radius_m * kRadiansPerDegree / *resolution;
  if (!scale || !(*scale > 0)) return by_resolution;
  const bool whole = std::abs(*resolution - std::round(*resolution)) < 1e-9;
  const double slack_m = unsure ? pds_last_digit_m(label, kObject + "MAP_SCALE") : kRounding * by_resolution;
  return whole && std::abs(*scale - by_resolution) <= slack_m ? by_resolution : *scale;
}

}  // namespace

std::optional<double> pds_metres(const PdsLabel& label, const std::string& name) {
  const auto value = label.number(name);
  if (!value) return std::nullopt;
  const std::string text = label.text(name);
  const std::size_t open = text.find('<');
  std::string unit =
      open == std::string::npos ? "" : text.substr(open + 1, text.find_first_of("/>", open) - open - 1);
  for (char& c : unit) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const bool metres = unit == "M" || unit == "METER" || unit == "METERS" || unit == "METRE" || unit == "METRES";
  return metres ? *value : *value * 1000;
}

double pds_last_digit_m(const PdsLabel& label, const std::string& name) {
  const std::string text = label.text(name);
  const std::size_t end = text.find_first_not_of("+-.0123456789");
  const std::size_t point = text.find('.');
  const std::size_t last = end == std::string::npos ? text.size() : end;
  const double digits = point < last ? static_cast<double>(last - point - 1) : 0.0;
  const auto value = label.number(name);
  if (!value) return 0;
  return std::pow(10.0, -digits) * (*value == 0 ? 1.0 : *pds_metres(label, name) / *value);
}

double squared_axis_ratio(double a_m, double c_m) { return c_m / a_m * (c_m / a_m); }

std::optional<LabelGeoreference> pds_map(const std::string& path, const PdsLabel& label) {
  const PdsPlacement placement = pds_placement(label);
  const auto number = [&](const char* key) { return label.number(kObject + key); };
  const auto line = number("LINE_PROJECTION_OFFSET");
  const auto sample = number("SAMPLE_PROJECTION_OFFSET");
  const auto body = axes(label);
  const auto projected = projection(label, placement);
  const bool turned = number("MAP_PROJECTION_ROTATION").value_or(0.0) != 0;
  if (!line || !sample || !body || !projected || turned) {
    if (!placement.west_positive) return std::nullopt;
    throw source_error(path, "its label counts longitudes to the west in an unsupported projection",
                       turned ? "MAP_PROJECTION_ROTATION" : pds_projection(label),
                       "convert it to POSITIVE_LONGITUDE_DIRECTION = EAST first, e.g. with ISIS");
  }
  const bool flattened = body->a_m != body->c_m;
  if (placement.planetographic && body->a_m != body->b_m) {
    throw source_error(path, "its latitudes are planetographic on a triaxial body", "",
                       "convert it to planetocentric latitudes first, e.g. with ISIS");
  }

  LabelGeoreference georeference;
  const bool ellipsoid = flattened && placement.planetographic && projected->body != Figure::kSphere;
  const double radius_m = projected->body == Figure::kPolarSphere && !ellipsoid ? body->c_m : body->a_m;
  const auto scale_m = pixel_m(label, radius_m, projected->body == Figure::kPolarSphere || ellipsoid);
  if (!scale_m) return std::nullopt;
  georeference.crs =
      "+proj=" + projected->words +
      " +lon_0=" + text_of(placement.east(number("CENTER_LONGITUDE").value_or(0.0))) +
      (ellipsoid ? " +a=" + text_of(body->a_m) + " +b=" + text_of(body->c_m) : " +R=" + text_of(radius_m)) +
      " +units=m +no_defs";
  georeference.to_map = {-(*sample + placement.edge_offset_px) * *scale_m, *scale_m, 0,
                         (*line + placement.edge_offset_px) * *scale_m,    0,        -*scale_m};
  georeference.grid = placement.grid;
  if (flattened && placement.planetographic && !ellipsoid) {
    georeference.centric_scale = squared_axis_ratio(body->a_m, body->c_m);
  }
  return georeference;
}

}  // namespace mars
