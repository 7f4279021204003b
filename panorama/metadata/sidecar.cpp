#include "panorama/metadata/sidecar.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "mars/geodesy/sphere.h"
#include "panorama/metadata/xml.h"
#include "vpe/base/number.h"
#include "vpe/core/json_text.h"

namespace panorama {

namespace {

using nlohmann::json;
using vpe::base::format_number;

// Samples and lines count pixel centres from 0, as the graticule of the MSL mosaics shows.
constexpr double kFirstCentre_px = 0.5;

// Returns values of an object by key. A value of another type is an error that names the key.
class Keys {
 public:
  explicit Keys(const json& object) : object_(object) {}

  std::optional<double> number(const char* key) const {
    const auto found = object_.find(key);
    if (found == object_.end() || found->is_null()) return std::nullopt;
    if (!found->is_number()) throw MetadataError(std::string(key) + " is not a number");
    return found->get<double>();
  }

  // Returns the value of the first of two keys that is there.
  std::optional<double> number(const char* key, const char* other) const {
    const std::optional<double> value = number(key);
    return value ? value : number(other);
  }

  std::optional<std::int64_t> count(const char* key) const {
    const std::optional<double> value = number(key);
    if (!value) return std::nullopt;
    if (*value != std::round(*value) || !(std::abs(*value) <= 1e9)) {
      throw MetadataError(std::string(key) + " is " + format_number(*value) + ", not a whole number");
    }
    return static_cast<std::int64_t>(*value);
  }

  std::string text(const char* key) const {
    const auto found = object_.find(key);
    if (found == object_.end() || found->is_null()) return {};
    if (!found->is_string()) throw MetadataError(std::string(key) + " is not a text");
    return found->get<std::string>();
  }

  const json* object(const char* key) const {
    const auto found = object_.find(key);
    if (found == object_.end() || found->is_null()) return nullptr;
    if (!found->is_object()) throw MetadataError(std::string(key) + " is not an object {...}");
    return &*found;
  }

 private:
  const json& object_;
};

template <class Value>
Value needed(const std::optional<Value>& value, const char* keys) {
  if (value) return *value;
  throw MetadataError(std::string("it needs ") + keys);
}

double positive(double value, const char* what) {
  if (value > 0.0) return value;
  throw MetadataError(std::string(what) + " is " + format_number(value) + "; it must be more than 0");
}

MapKind kind_of(const Keys& keys) {
  const std::string name = lower_case(keys.text("projection"));
  for (const MapKind kind : {MapKind::kCylinder, MapKind::kEquirectangular, MapKind::kFacets}) {
    if (name == to_string(kind)) return kind;
  }
  // JPL calls rows even in angle cylindrical; elsewhere the name means rows even in tangent.
  const bool is_cylindrical = name.starts_with("cylindrical") && !name.starts_with("cylindrical-perspective");
  if (is_cylindrical && keys.number("degrees_per_row", "elevation_deg_per_line"))
    return MapKind::kEquirectangular;
  if (is_cylindrical) {
    throw MetadataError("projection '" + excerpt(name) +
                        "' has two meanings: give \"equirectangular\" for rows even in angle (rover mosaics), "
                        "\"cylinder\" for rows even in tangent");
  }
  throw MetadataError("projection '" + excerpt(name) +
                      "' is not known: give \"cylinder\", \"equirectangular\" or \"facets\"");
}

double turn_of(const Keys& keys, double width_px, std::optional<double> left_deg) {
  if (const auto turn_px = keys.number("columns_per_turn")) return *turn_px;
  if (const auto scale_deg = keys.number("degrees_per_pixel")) {
    return 360.0 / positive(*scale_deg, "degrees_per_pixel");
  }
  const auto right_deg = keys.number("azimuth_deg_at_right");
  if (right_deg && left_deg) {
    double span_deg = std::fmod(*right_deg - *left_deg, 360.0);
    if (span_deg <= 0.0) span_deg += 360.0;
    return width_px * 360.0 / span_deg;
  }
  throw MetadataError("it needs columns_per_turn, degrees_per_pixel or azimuth_deg_at_right");
}

// Returns the number of rows from the horizon to an elevation for a focal length of 1.
double rise_of(MapKind kind, double elevation_deg) {
  const double elevation_rad = elevation_deg * mars::kRadiansPerDegree;
  return kind == MapKind::kEquirectangular ? elevation_rad : std::tan(elevation_rad);
}

std::optional<double> row_scale_deg(const Keys& keys) {
  if (const auto scale_deg = keys.number("degrees_per_row")) return positive(*scale_deg, "degrees_per_row");
  const auto per_line_deg = keys.number("elevation_deg_per_line");
  if (!per_line_deg) return std::nullopt;
  return positive(-*per_line_deg, "elevation_deg_per_line with its sign changed");
}

// Replaces the scale of rows, which is that of the columns so far, by the one that the keys state.
void set_rows(PanoramaMap& map, const Keys& keys) {
  const auto top_deg = keys.number("elevation_deg_at_top", "elevation_deg_at_line_0");
  const double top_px = keys.number("elevation_deg_at_top") ? 0.0 : kFirstCentre_px;
  const auto bottom_deg = keys.number("elevation_deg_at_bottom");
  if (const auto focal_px = keys.number("focal_px")) {
    map.focal_px = *focal_px;
  } else if (const auto scale_deg = row_scale_deg(keys)) {
    if (map.kind != MapKind::kEquirectangular) {
      throw MetadataError("rows of a " + std::string(to_string(map.kind)) +
                          " are not even in angle: give focal_px instead of degrees by row");
    }
    map.focal_px = 1.0 / (*scale_deg * mars::kRadiansPerDegree);
  } else if (top_deg && bottom_deg && map.kind != MapKind::kFacets) {
    const double rise = rise_of(map.kind, *top_deg) - rise_of(map.kind, *bottom_deg);
    map.focal_px = (static_cast<double>(map.height_px) - top_px) /
                   positive(rise, "elevation_deg_at_top less elevation_deg_at_bottom");
  }
  if (const auto row = keys.number("horizon_row")) {
    map.horizon_px = *row;
  } else {
    const double deg = needed(top_deg, "horizon_row or elevation_deg_at_top");
    map.horizon_px = top_px + map.focal_px * rise_of(map.kind, deg);
  }
}

// Compares keys that state something a second time with the map that the others made.
void check_agreement(const PanoramaMap& map, const Keys& keys) {
  constexpr double kSlack_px = 1.0;
  const auto compare = [](const char* key, std::optional<double> stated, double is, double pixels_per_unit) {
    if (!stated || std::abs(*stated - is) * pixels_per_unit <= kSlack_px) return;
    throw MetadataError(std::string(key) + " is " + format_number(*stated) + ", but by the other keys it is " +
                        format_number(is) + "; correct one or leave one out");
  };
  const auto width_px = static_cast<double>(map.width_px);
  const auto height_px = static_cast<double>(map.height_px);
  const double column_deg = 360.0 / map.turn_px;
  compare("degrees_per_pixel", keys.number("degrees_per_pixel"), column_deg, width_px / column_deg);
  const auto compare_azimuth = [&](const char* key, double x) {
    const auto stated = keys.number(key);
    if (!stated) return;
    const double is_deg = map.to_direction(x, map.horizon_px).azimuth_deg;
    compare(key, is_deg + std::remainder(*stated - is_deg, 360.0), is_deg, 1.0 / column_deg);
  };
  compare_azimuth("azimuth_deg_at_left", 0.0);
  compare_azimuth("azimuth_deg_at_sample_0", kFirstCentre_px);
  compare_azimuth("azimuth_deg_at_right", width_px);
  if (map.kind == MapKind::kFacets) return;
  const auto compare_elevation = [&](const char* key, double y) {
    const auto stated = keys.number(key);
    if (!stated) return;
    const double is_deg = map.to_direction(0.0, y).elevation_deg;
    compare(key, map.horizon_px - map.focal_px * rise_of(map.kind, *stated),
            map.horizon_px - map.focal_px * rise_of(map.kind, is_deg), 1.0);
  };
  compare_elevation("elevation_deg_at_top", 0.0);
  compare_elevation("elevation_deg_at_line_0", kFirstCentre_px);
  compare_elevation("elevation_deg_at_bottom", height_px);
}

PanoramaMap map_of(const Keys& keys) {
  const MapKind kind = kind_of(keys);
  const std::int64_t width_px = needed(keys.count("width"), "width");
  const std::int64_t height_px = needed(keys.count("height"), "height");
  const std::string sense = lower_case(keys.text("azimuth_increases"));
  if (sense.find("counter") != std::string::npos || sense.find("anti") != std::string::npos) {
    throw MetadataError("azimuth_increases is '" + excerpt(sense) +
                        "'; only images with azimuth to the right are read");
  }
  const auto facets = keys.count("facets");
  if (kind == MapKind::kFacets &&
      !(facets && *facets >= PanoramaLimits::kMinFacets && *facets <= PanoramaLimits::kMaxFacets)) {
    throw MetadataError((facets ? std::to_string(*facets) + " facets" : std::string("facets are missing")) +
                        ": must be " + std::to_string(PanoramaLimits::kMinFacets) + " to " +
                        std::to_string(PanoramaLimits::kMaxFacets));
  }
  auto left_deg = keys.number("azimuth_deg_at_left", "azimuth_deg_at_sample_0");
  const auto start_yaw_deg = keys.number("start_yaw_deg");
  if (kind == MapKind::kFacets) {
    left_deg = needed(start_yaw_deg, "start_yaw_deg") - 180.0 / static_cast<double>(*facets);
  }
  const auto left = needed(left_deg, "azimuth_deg_at_left");
  const double turn_px = turn_of(keys, static_cast<double>(width_px), left);
  PanoramaMap map = cylinder_map(width_px, height_px, turn_px, left, 0.0);
  map.kind = kind;
  if (kind != MapKind::kFacets && !keys.number("azimuth_deg_at_left")) {
    map.turn_azimuth_deg -= kFirstCentre_px * 360.0 / turn_px;
  }
  if (kind == MapKind::kFacets) {
    map.facets = static_cast<int>(*facets);
    map.crop_left_px = keys.number("crop_left_px").value_or(0.0);
    map.focal_px = 0.5 * map.facet_px() / std::tan(mars::kPi / map.facets);
  }
  set_rows(map, keys);
  if (const std::string problem = check(map); !problem.empty()) throw MetadataError(problem);
  check_agreement(map, keys);
  return map;
}

mars::VerticalDatum datum_of(const Keys& keys) {
  const std::string name = keys.text("datum");
  if (name.empty()) return {};
  const auto datum = mars::parse_datum(name, mars::kMarsRadius_m);
  if (!datum) throw MetadataError("datum '" + excerpt(name) + "' is not known: areoid, sphere:RADIUS, radius");
  return *datum;
}

std::optional<RecordedViewpoint> viewpoint_of(const Keys& keys) {
  const json* pose = keys.object("pose");
  const json* rover = keys.object("rover");
  if (pose == nullptr && rover == nullptr) return std::nullopt;
  const Keys place(pose != nullptr ? *pose : *rover);
  RecordedViewpoint viewpoint;
  viewpoint.lon_deg = needed(place.number("lon_deg", "lon_deg_east"), "lon_deg of the pose");
  viewpoint.lat_deg = needed(place.number("lat_deg"), "lat_deg of the pose");
  if (!mars::is_valid({viewpoint.lon_deg, viewpoint.lat_deg})) {
    throw MetadataError("pose at lon " + format_number(viewpoint.lon_deg) + ", lat " +
                        format_number(viewpoint.lat_deg) + ": latitudes are -90 to 90");
  }
  viewpoint.lon_deg = mars::normalize_lon_deg(viewpoint.lon_deg);
  for (const char* angle : {"pitch_deg", "roll_deg"}) {
    if (pose != nullptr && place.number(angle).value_or(0.0) != 0.0) {
      throw MetadataError(std::string(angle) + " of the pose is not 0; only level panoramas are read");
    }
  }
  viewpoint.alt_m = place.number("alt_m");
  viewpoint.height_m = place.number("height_m", "camera_height_above_ground_m_approx");
  viewpoint.datum = datum_of(place);
  viewpoint.ground_m = place.number("ground_m");
  if (const auto areoid_m = place.number("elevation_m_areoid"); areoid_m && !viewpoint.ground_m) {
    viewpoint.ground_m = areoid_m;
    viewpoint.datum = mars::VerticalDatum::areoid();
  }
  return viewpoint;
}

}  // namespace

Sidecar read_sidecar(std::string_view text) {
  json root;
  try {
    root = json::parse(text);
  } catch (const json::exception& e) {
    throw MetadataError("not well-formed JSON: " + excerpt(e.what(), 300));
  }
  if (!root.is_object()) throw MetadataError("JSON without an object {...} of keys");
  const Keys keys(root);
  return {keys.text("image"), map_of(keys), viewpoint_of(keys)};
}

nlohmann::ordered_json to_json(const Sidecar& sidecar) {
  const PanoramaMap& map = sidecar.map;
  nlohmann::ordered_json root;
  if (!sidecar.image.empty()) root["image"] = sidecar.image;
  root["projection"] = to_string(map.kind);
  root["width"] = map.width_px;
  root["height"] = map.height_px;
  root["columns_per_turn"] = map.turn_px;
  if (map.kind == MapKind::kFacets) {
    root["facets"] = map.facets;
    root["start_yaw_deg"] = map.turn_azimuth_deg + 180.0 / map.facets;
    root["crop_left_px"] = map.crop_left_px;
  } else {
    root["azimuth_deg_at_left"] = map.to_direction(0.0, map.horizon_px).azimuth_deg;
  }
  root["horizon_row"] = map.horizon_px;
  root["focal_px"] = map.focal_px;
  if (sidecar.viewpoint) {
    const RecordedViewpoint& viewpoint = *sidecar.viewpoint;
    nlohmann::ordered_json pose;
    pose["lon_deg"] = viewpoint.lon_deg;
    pose["lat_deg"] = viewpoint.lat_deg;
    if (viewpoint.alt_m) pose["alt_m"] = *viewpoint.alt_m;
    if (viewpoint.height_m) pose["height_m"] = *viewpoint.height_m;
    if (viewpoint.ground_m) pose["ground_m"] = *viewpoint.ground_m;
    if (viewpoint.datum.is_known()) pose["datum"] = mars::to_string(viewpoint.datum);
    root["pose"] = pose;
  }
  return root;
}

std::string to_text(const Sidecar& sidecar) { return vpe::core::json_text(to_json(sidecar), 1) + "\n"; }

}  // namespace panorama
