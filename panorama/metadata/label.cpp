#include "panorama/metadata/label.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mars/geodesy/sphere.h"
#include "panorama/metadata/label_values.h"
#include "panorama/metadata/xml.h"
#include "vpe/base/number.h"

namespace panorama {

namespace {

using vpe::base::format_number;

// Converts to lower case and removes separators of words, for "PIXELS/DEGREE" and "pix_deg" alike.
std::string bare(std::string_view text) {
  std::string result;
  for (const char c : lower_case(text)) {
    if (c != ' ' && c != '_' && c != '-') result += c;
  }
  return result;
}

struct Unit {
  const char* name;
  double factor;
};

constexpr std::array kAngles{Unit{"deg", 1.0},
                             Unit{"degree", 1.0},
                             Unit{"degrees", 1.0},
                             Unit{"rad", 180.0 / mars::kPi},
                             Unit{"radian", 180.0 / mars::kPi},
                             Unit{"radians", 180.0 / mars::kPi},
                             Unit{"mrad", 0.18 / mars::kPi},
                             Unit{"arcmin", 1.0 / 60.0},
                             Unit{"arcsec", 1.0 / 3600.0},
                             Unit{"hr", 15.0}};

std::optional<double> degrees_in(std::string_view unit) {
  for (const Unit& known : kAngles) {
    if (unit == known.name) return known.factor;
  }
  return std::nullopt;
}

bool is_pixel(std::string_view unit) {
  return unit == "pix" || unit == "pixel" || unit == "pixels" || unit == "px" || unit == "line" ||
         unit == "lines" || unit == "sample" || unit == "samples";
}

[[noreturn]] void refuse_unit(std::string_view key, const LabelValue& value) {
  throw MetadataError(std::string(key) + " is in '" + excerpt(value.unit) +
                      "', which is no unit of angles that is read here" +
                      "; describe the image in a JSON file instead");
}

double number_of(std::string_view key, const LabelValue& value) {
  const std::optional<double> number = vpe::base::parse_number(trim(value.text));
  if (!number) {
    throw MetadataError(std::string(key) + " is '" + excerpt(value.text) +
                        "', not a number; correct the label");
  }
  return *number;
}

class Values {
 public:
  explicit Values(const LabelLookup& look_up) : look_up_(look_up) {}

  std::optional<double> angle_deg(std::string_view key) const {
    const std::optional<LabelValue> value = look_up_(key);
    if (!value) return std::nullopt;
    const std::string unit = bare(value->unit);
    const std::optional<double> factor = unit.empty() ? 1.0 : degrees_in(unit);
    if (!factor) refuse_unit(key, *value);
    return number_of(key, *value) * *factor;
  }

  std::optional<double> pixels(std::string_view key) const {
    const std::optional<LabelValue> value = look_up_(key);
    if (!value) return std::nullopt;
    const std::string unit = bare(value->unit);
    if (!unit.empty() && !is_pixel(unit)) refuse_unit(key, *value);
    return number_of(key, *value);
  }

  std::optional<std::int64_t> count(std::string_view key) const {
    const std::optional<double> value = pixels(key);
    if (!value) return std::nullopt;
    if (!(*value >= 1 && *value <= 1e9) || *value != std::round(*value)) {
      throw MetadataError(std::string(key) + " is " + format_number(*value) + ", not a number of pixels");
    }
    return static_cast<std::int64_t>(*value);
  }

  // Returns pixels per degree for a value in pixels per angle or in angle per pixel.
  std::optional<double> resolution(std::string_view key) const {
    const std::optional<LabelValue> value = look_up_(key);
    if (!value) return std::nullopt;
    const double number = number_of(key, *value);
    if (!(number > 0.0)) {
      throw MetadataError(std::string(key) + " is " + format_number(number) + "; it must be more than 0");
    }
    const std::string unit = bare(value->unit);
    if (unit.empty()) return number;
    const std::size_t slash = unit.find('/');
    if (slash == std::string::npos) refuse_unit(key, *value);
    const std::string above = unit.substr(0, slash);
    const std::string below = unit.substr(slash + 1);
    if (const auto angle = degrees_in(below); angle && is_pixel(above)) return number / *angle;
    if (const auto angle = degrees_in(above); angle && is_pixel(below)) return 1.0 / (number * *angle);
    refuse_unit(key, *value);
  }

  std::string text(std::string_view key) const {
    const std::optional<LabelValue> value = look_up_(key);
    return value ? std::string(trim(value->text)) : std::string();
  }

 private:
  const LabelLookup& look_up_;
};

template <class Value>
Value needed(std::string_view key, const std::optional<Value>& value) {
  if (value) return *value;
  throw MetadataError("the label has no " + std::string(key) + "; describe the image in a JSON file instead");
}

// Returns whether azimuth is counted from north in a frame. In others it turns with the rover, its mast or its
// arm.
bool is_level_frame(std::string_view frame) {
  const std::string name = bare(frame);
  return name.empty() || name.starts_with("site") || name.starts_with("locallevel");
}

// Stated limits are rounded and cut in many ways; those of other images are farther off than half a degree.
constexpr double kSlack_deg = 0.5;

double slack_px(double pixels_per_degree) { return std::max(4.0, kSlack_deg * pixels_per_degree); }

void check_span(const char* what, double stated_px, double image_px, double pixels_per_degree) {
  if (std::abs(stated_px - image_px) <= slack_px(pixels_per_degree)) return;
  throw MetadataError(std::string("the label contradicts the image: by ") + what + " it would have " +
                      format_number(std::round(stated_px)) + " pixels, but it has " + format_number(image_px) +
                      "; give the label of this very image");
}

// Returns the number that the label gives to the centre of the first line.
double first_line(const RoverLabel& label) {
  if (!label.maximum_elevation_deg) return 1.0;
  const double number = label.zero_elevation_line - *label.maximum_elevation_deg * label.rows_per_degree;
  if (std::abs(number - 0.5) > slack_px(label.rows_per_degree)) {
    throw MetadataError(
        "the label contradicts itself: by ZERO_ELEVATION_LINE and resolution, MAXIMUM_ELEVATION " +
        format_number(*label.maximum_elevation_deg) + " degrees is at line " + format_number(number) +
        ", not at the first; correct the label");
  }
  return number < 0.5 ? 0.0 : 1.0;
}

}  // namespace

void require_cylindrical(std::string_view projection) {
  if (bare(projection) == "cylindrical") return;
  throw MetadataError("projection " + (projection.empty() ? "without a name" : excerpt(projection)) +
                      " of the label is not read, only Cylindrical (even in azimuth and elevation)" +
                      "; project the mosaic again, e.g. marsmap projection=cylindrical");
}

RoverLabel label_of(const LabelLookup& look_up) {
  const Values values(look_up);
  require_cylindrical(values.text("MAP_PROJECTION_TYPE"));
  RoverLabel label;
  label.frame = values.text("REFERENCE_COORD_SYSTEM_NAME");
  if (!is_level_frame(label.frame)) {
    throw MetadataError("azimuths of the label are in " + excerpt(label.frame) +
                        ", which is not level or not counted from north; use a mosaic in SITE_FRAME");
  }
  label.columns_per_degree = needed("MAP_RESOLUTION", values.resolution("MAP_RESOLUTION_X"));
  label.rows_per_degree = needed("MAP_RESOLUTION", values.resolution("MAP_RESOLUTION_Y"));
  label.start_azimuth_deg = needed("START_AZIMUTH", values.angle_deg("START_AZIMUTH"));
  label.stop_azimuth_deg = values.angle_deg("STOP_AZIMUTH");
  label.maximum_elevation_deg = values.angle_deg("MAXIMUM_ELEVATION");
  label.minimum_elevation_deg = values.angle_deg("MINIMUM_ELEVATION");
  label.zero_elevation_line = needed("ZERO_ELEVATION_LINE", values.pixels("ZERO_ELEVATION_LINE"));
  label.lines = values.count("LINES");
  label.samples = values.count("LINE_SAMPLES");
  return label;
}

PanoramaMap map_of(const RoverLabel& label, std::int64_t width_px, std::int64_t height_px) {
  if (label.lines.value_or(height_px) != height_px || label.samples.value_or(width_px) != width_px) {
    throw MetadataError("the label is of an image of " + std::to_string(label.samples.value_or(width_px)) +
                        "x" + std::to_string(label.lines.value_or(height_px)) + " pixels, this one has " +
                        std::to_string(width_px) + "x" + std::to_string(height_px) +
                        "; give the label of this very image");
  }
  const double first = first_line(label);
  const double turn_px = 360.0 * label.columns_per_degree;
  if (label.stop_azimuth_deg) {
    // Equal azimuths at both ends mean the full circle.
    double span_deg = std::fmod(*label.stop_azimuth_deg - label.start_azimuth_deg, 360.0);
    if (span_deg <= 0.0) span_deg += 360.0;
    const auto width = static_cast<double>(width_px);
    const double over_px = std::abs(std::remainder(span_deg * label.columns_per_degree - width, turn_px));
    if (over_px > slack_px(label.columns_per_degree)) {
      check_span("START_AZIMUTH and STOP_AZIMUTH", span_deg * label.columns_per_degree, width,
                 label.columns_per_degree);
    }
  }
  if (label.maximum_elevation_deg && label.minimum_elevation_deg) {
    check_span("MAXIMUM_ELEVATION and MINIMUM_ELEVATION",
               (*label.maximum_elevation_deg - *label.minimum_elevation_deg) * label.rows_per_degree,
               static_cast<double>(height_px), label.rows_per_degree);
  }
  PanoramaMap map = equirectangular_map(width_px, height_px, turn_px,
                                        label.start_azimuth_deg - 0.5 / label.columns_per_degree,
                                        label.zero_elevation_line - first + 0.5);
  map.focal_px = label.rows_per_degree / mars::kRadiansPerDegree;
  if (const std::string problem = check(map); !problem.empty()) throw MetadataError("the label: " + problem);
  return map;
}

}  // namespace panorama
