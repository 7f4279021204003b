#include "panorama/metadata/gpano.h"

#include <array>
#include <cmath>
#include <pugixml.hpp>
#include <sstream>
#include <variant>

#include "mars/geodesy/sphere.h"
#include "panorama/metadata/xml.h"
#include "vpe/base/number.h"

namespace panorama {

namespace {

using vpe::base::format_number;

constexpr std::string_view kNamespace = "http://ns.google.com/photos/1.0/panorama/";

// Required fields come first, then those that may be absent.
using Member = std::variant<std::string GPano::*, std::int64_t GPano::*, std::optional<double> GPano::*,
                            std::optional<std::int64_t> GPano::*, std::optional<bool> GPano::*,
                            std::optional<std::string> GPano::*>;

struct Field {
  const char* name;
  Member member;
};

const std::array<Field, 27>& fields() {
  static const std::array<Field, 27> kFields{{
      {"ProjectionType", &GPano::projection_type},
      {"CroppedAreaImageWidthPixels", &GPano::cropped_width_px},
      {"CroppedAreaImageHeightPixels", &GPano::cropped_height_px},
      {"FullPanoWidthPixels", &GPano::full_width_px},
      {"FullPanoHeightPixels", &GPano::full_height_px},
      {"CroppedAreaLeftPixels", &GPano::cropped_left_px},
      {"CroppedAreaTopPixels", &GPano::cropped_top_px},
      {"PoseHeadingDegrees", &GPano::heading_deg},
      {"PosePitchDegrees", &GPano::pitch_deg},
      {"PoseRollDegrees", &GPano::roll_deg},
      {"InitialViewHeadingDegrees", &GPano::initial_heading_deg},
      {"InitialViewPitchDegrees", &GPano::initial_pitch_deg},
      {"InitialViewRollDegrees", &GPano::initial_roll_deg},
      {"InitialHorizontalFOVDegrees", &GPano::initial_horizontal_fov_deg},
      {"InitialVerticalFOVDegrees", &GPano::initial_vertical_fov_deg},
      {"InitialCameraDolly", &GPano::initial_camera_dolly},
      {"UsePanoramaViewer", &GPano::use_viewer},
      {"ExposureLockUsed", &GPano::exposure_lock_used},
      {"CaptureSoftware", &GPano::capture_software},
      {"StitchingSoftware", &GPano::stitching_software},
      {"FirstPhotoDate", &GPano::first_photo_date},
      {"LastPhotoDate", &GPano::last_photo_date},
      {"SourcePhotosCount", &GPano::source_photos},
      {"LargestValidInteriorRectLeft", &GPano::interior_left_px},
      {"LargestValidInteriorRectTop", &GPano::interior_top_px},
      {"LargestValidInteriorRectWidth", &GPano::interior_width_px},
      {"LargestValidInteriorRectHeight", &GPano::interior_height_px},
  }};
  return kFields;
}

[[noreturn]] void refuse_value(const char* name, const std::string& text, const char* wanted) {
  throw MetadataError(std::string("GPano:") + name + " is '" + excerpt(text) + "', not " + wanted);
}

template <class Value>
struct Plain {
  using Type = Value;
};
template <class Value>
struct Plain<std::optional<Value>> {
  using Type = Value;
};

template <class Value>
Value parse(const char* name, const std::string& text) {
  if constexpr (std::is_same_v<Value, std::string>) {
    return text;
  } else if constexpr (std::is_same_v<Value, bool>) {
    const std::string lower = lower_case(text);
    if (lower == "true" || lower == "1") return true;
    if (lower == "false" || lower == "0") return false;
    refuse_value(name, text, "True or False");
  } else {
    const std::optional<double> number = vpe::base::parse_number(text);
    if (!number) refuse_value(name, text, "a number");
    if constexpr (std::is_same_v<Value, double>) {
      return *number;
    } else {
      // Programs write whole numbers as reals too.
      constexpr double kLargest = 1e15;
      if (!(std::abs(*number) <= kLargest) || *number != std::round(*number)) {
        refuse_value(name, text, "a whole number");
      }
      return static_cast<Value>(*number);
    }
  }
}

template <class Value>
std::string write(const Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    return value;
  } else if constexpr (std::is_same_v<Value, bool>) {
    return value ? "True" : "False";
  } else if constexpr (std::is_same_v<Value, double>) {
    return format_number(value);
  } else {
    return std::to_string(value);
  }
}

bool is_true_cylinder(const PanoramaMap& map) {
  const double true_focal_px = map.turn_px / (2.0 * mars::kPi);
  return std::abs(map.focal_px - true_focal_px) <= 1e-6 * true_focal_px;
}

// Counts columns from t = 0 if the image then begins at a whole column and ends within the full circle, else
// from its left edge.
void set_columns(GPano& gpano, const PanoramaMap& map) {
  const auto left_px = std::llround(map.crop_left_px);
  double start_deg = map.turn_azimuth_deg;
  if (static_cast<double>(left_px) == map.crop_left_px && left_px + map.width_px <= gpano.full_width_px) {
    gpano.cropped_left_px = left_px;
  } else {
    start_deg = map.to_direction(0.0, map.horizon_px).azimuth_deg;
  }
  const double heading_deg = std::fmod(std::fmod(start_deg + 180.0, 360.0) + 360.0, 360.0);
  gpano.heading_deg = heading_deg;
}

}  // namespace

std::string to_xmp(const GPano& gpano) {
  pugi::xml_document document;
  pugi::xml_node meta = document.append_child("x:xmpmeta");
  meta.append_attribute("xmlns:x") = "adobe:ns:meta/";
  pugi::xml_node rdf = meta.append_child("rdf:RDF");
  rdf.append_attribute("xmlns:rdf") = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
  pugi::xml_node description = rdf.append_child("rdf:Description");
  description.append_attribute("rdf:about") = "";
  description.append_attribute("xmlns:GPano") = std::string(kNamespace).c_str();
  const auto put = [&description](const char* name, const std::string& value) {
    description.append_child((std::string("GPano:") + name).c_str()).text().set(xml_text(value).c_str());
  };
  for (const Field& field : fields()) {
    std::visit(
        [&](const auto member) {
          const auto& value = gpano.*member;
          if constexpr (requires { value.has_value(); }) {
            if (value) put(field.name, write(*value));
          } else {
            put(field.name, write(value));
          }
        },
        field.member);
  }
  std::ostringstream text;
  text << "<?xpacket begin='\xEF\xBB\xBF' id='W5M0MpCehiHzreSzNTczkc9d'?>\n";
  document.save(text, " ", pugi::format_indent | pugi::format_no_declaration, pugi::encoding_utf8);
  text << "<?xpacket end='w'?>";
  return text.str();
}

std::optional<GPano> read_gpano(std::string_view xmp) {
  const pugi::xml_document document = parse_xml(xmp, "XMP");
  const std::map<std::string, std::string> found = fields_of_namespace(document, kNamespace);
  if (found.empty()) return std::nullopt;
  GPano gpano;
  for (const Field& field : fields()) {
    const auto at = found.find(field.name);
    std::visit(
        [&](const auto member) {
          auto& value = gpano.*member;
          using Value = typename Plain<std::remove_reference_t<decltype(value)>>::Type;
          if (at != found.end()) {
            value = parse<Value>(field.name, at->second);
          } else if constexpr (!requires { value.has_value(); }) {
            throw MetadataError(std::string("GPano without ") + field.name +
                                "; add it, e.g. exiftool -XMP-GPano:" + field.name + "=... FILE");
          }
        },
        field.member);
  }
  return gpano;
}

GPano gpano_of(const PanoramaMap& map, double max_shift_px) {
  if (const std::string problem = check(map); !problem.empty()) throw MetadataError(problem);
  if (map.kind == MapKind::kFacets) {
    throw MetadataError(
        "GPano has no faceted cylinder; use a true cylinder or an equirectangular image for it");
  }
  if (map.kind == MapKind::kCylinder && !is_true_cylinder(map)) {
    throw MetadataError("GPano has true cylinders only: focal length " +
                        format_number(map.turn_px / (2 * mars::kPi)) + " pixels for " +
                        format_number(map.turn_px) + " columns to a full circle, not " +
                        format_number(map.focal_px));
  }
  GPano gpano;
  gpano.use_viewer = true;
  gpano.cropped_width_px = map.width_px;
  gpano.cropped_height_px = map.height_px;
  gpano.full_width_px = std::llround(map.turn_px);
  gpano.pitch_deg = 0.0;
  gpano.roll_deg = 0.0;
  set_columns(gpano, map);
  if (map.kind == MapKind::kCylinder) {
    gpano.projection_type = "cylindrical";
    gpano.full_height_px = map.height_px;
    gpano.cropped_top_px = std::llround(-map.horizon_px);
  } else {
    gpano.projection_type = "equirectangular";
    gpano.full_height_px = std::llround(map.focal_px * mars::kPi);
    gpano.cropped_top_px = std::llround(0.5 * static_cast<double>(gpano.full_height_px) - map.horizon_px);
  }
  const double shift_px = largest_difference_px(map, map_of(gpano));
  if (shift_px > max_shift_px) {
    throw MetadataError(
        "GPano counts in whole pixels, which would shift this image by " + format_number(shift_px) +
        " pixels; choose whole numbers of columns for the full circle and of rows to the horizon");
  }
  return gpano;
}

PanoramaMap map_of(const GPano& gpano) {
  const std::string type = lower_case(gpano.projection_type);
  if (type != "cylindrical" && type != "equirectangular") {
    throw MetadataError("GPano:ProjectionType is '" + excerpt(gpano.projection_type) +
                        "'; only cylindrical and equirectangular are read");
  }
  for (const auto& [name, angle_deg] :
       {std::pair{"PosePitchDegrees", gpano.pitch_deg}, std::pair{"PoseRollDegrees", gpano.roll_deg}}) {
    if (angle_deg.value_or(0.0) != 0.0) {
      throw MetadataError(std::string("GPano:") + name + " is " + format_number(*angle_deg) +
                          "; only level panoramas are read: reproject the image to a level horizon");
    }
  }
  if (gpano.full_width_px < 1 || gpano.full_height_px < 1) {
    throw MetadataError("GPano:FullPanoWidthPixels x FullPanoHeightPixels is " +
                        std::to_string(gpano.full_width_px) + "x" + std::to_string(gpano.full_height_px) +
                        "; both must be at least 1");
  }
  const bool is_cylinder = type == "cylindrical";
  const auto outside = [](std::int64_t from, std::int64_t size, std::int64_t whole) {
    return from < 0 || size > whole || from > whole - size;
  };
  if (outside(gpano.cropped_left_px, gpano.cropped_width_px, gpano.full_width_px) ||
      (!is_cylinder && outside(gpano.cropped_top_px, gpano.cropped_height_px, gpano.full_height_px))) {
    throw MetadataError("GPano's cropped area, " + std::to_string(gpano.cropped_width_px) + "x" +
                        std::to_string(gpano.cropped_height_px) + " at (" +
                        std::to_string(gpano.cropped_left_px) + ", " + std::to_string(gpano.cropped_top_px) +
                        "), is not inside its full panorama of " + std::to_string(gpano.full_width_px) + "x" +
                        std::to_string(gpano.full_height_px));
  }
  const auto turn_px = static_cast<double>(gpano.full_width_px);
  const auto top_px = static_cast<double>(gpano.cropped_top_px);
  const auto full_height_px = static_cast<double>(gpano.full_height_px);
  const double start_deg = gpano.heading_deg.value_or(0.0) - 180.0;
  const double horizon_px = is_cylinder ? -top_px : 0.5 * full_height_px - top_px;
  PanoramaMap map =
      cylinder_map(gpano.cropped_width_px, gpano.cropped_height_px, turn_px, start_deg, horizon_px);
  map.crop_left_px = static_cast<double>(gpano.cropped_left_px);
  if (!is_cylinder) {
    map.kind = MapKind::kEquirectangular;
    map.focal_px = full_height_px / mars::kPi;
  }
  if (const std::string problem = check(map); !problem.empty()) throw MetadataError("GPano: " + problem);
  return map;
}

}  // namespace panorama
