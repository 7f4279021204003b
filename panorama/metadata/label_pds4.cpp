// Labels of PDS4: class Map_Projection_Lander of the cartography dictionary, and the array's own size.
#include <array>
#include <pugixml.hpp>
#include <utility>

#include "panorama/metadata/label_values.h"
#include "panorama/metadata/xml.h"

namespace panorama {

namespace {

constexpr int kMaxDepth = 100;

pugi::xml_node find_local(pugi::xml_node under, std::string_view name) {
  return under.find_node([name](pugi::xml_node node) { return local_name(node.name()) == name; });
}

pugi::xml_node child_local(pugi::xml_node of, std::string_view name) {
  for (const pugi::xml_node child : of.children()) {
    if (local_name(child.name()) == name) return child;
  }
  return {};
}

// Keys of PDS3 for the same values.
constexpr std::array kNames{std::pair{"MAP_RESOLUTION_X", "pixel_scale_x"},
                            std::pair{"MAP_RESOLUTION_Y", "pixel_scale_y"},
                            std::pair{"START_AZIMUTH", "start_azimuth"},
                            std::pair{"STOP_AZIMUTH", "stop_azimuth"},
                            std::pair{"MAXIMUM_ELEVATION", "maximum_elevation"},
                            std::pair{"MINIMUM_ELEVATION", "minimum_elevation"},
                            std::pair{"ZERO_ELEVATION_LINE", "zero_elevation_line"}};

std::optional<LabelValue> value_of(pugi::xml_node node) {
  if (!node) return std::nullopt;
  return LabelValue{std::string(trim(node.child_value())), node.attribute("unit").value()};
}

// Returns the number of elements of the array's axis "Line" or "Sample".
std::optional<LabelValue> axis_length(pugi::xml_node document, std::string_view axis) {
  const pugi::xml_node found = document.find_node([axis](pugi::xml_node node) {
    return local_name(node.name()) == "Axis_Array" &&
           trim(child_local(node, "axis_name").child_value()) == axis;
  });
  return value_of(child_local(found, "elements"));
}

struct DepthCheck : pugi::xml_tree_walker {
  bool for_each(pugi::xml_node& /*node*/) override { return depth() <= kMaxDepth; }
};

}  // namespace

std::optional<RoverLabel> read_pds4_label(std::string_view xml) {
  pugi::xml_document document = parse_xml(xml, "label");
  // The search below recurses for each level.
  if (DepthCheck check; !document.traverse(check)) {
    throw MetadataError("XML nested deeper than " + std::to_string(kMaxDepth));
  }
  const pugi::xml_node projection = find_local(document, "Map_Projection_Lander");
  const pugi::xml_node cylindrical = find_local(projection ? projection : document, "Cylindrical");
  if (!projection && !cylindrical) return std::nullopt;
  if (!cylindrical) {
    const std::string name(trim(find_local(projection, "lander_map_projection_name").child_value()));
    require_cylindrical(name == "Cylindrical" ? "" : name);
  }
  const pugi::xml_node frame = find_local(projection, "coordinate_space_frame_type");
  return label_of([&](std::string_view asked) -> std::optional<LabelValue> {
    if (asked == "MAP_PROJECTION_TYPE") return LabelValue{"CYLINDRICAL", ""};
    if (asked == "LINES") return axis_length(document, "Line");
    if (asked == "LINE_SAMPLES") return axis_length(document, "Sample");
    if (asked == "REFERENCE_COORD_SYSTEM_NAME") return value_of(frame);
    for (const auto& [key, name] : kNames) {
      if (asked == key) return value_of(child_local(cylindrical, name));
    }
    return std::nullopt;
  });
}

}  // namespace panorama
