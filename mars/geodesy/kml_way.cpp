#include "mars/geodesy/kml_way.h"

#include <cpl_error.h>
#include <cpl_minixml.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "vpe/base/number.h"

namespace mars {

namespace {

using vpe::base::format_number;

constexpr double kFarthest_m = 1e10;
constexpr std::size_t kShownText = 60;
constexpr std::string_view kXmlBlanks = " \t\r\n";

// Says where in a file a fault is.
struct Where {
  std::string file;
  std::string way;
  std::size_t point = 0;  // from 1; 0: the whole way

  [[noreturn]] void fail(const std::string& fault) const {
    throw std::runtime_error(file + ": " + way + (point > 0 ? ", point " + std::to_string(point) : "") + ": " +
                             fault);
  }
};

std::string shown(std::string_view text) {
  std::string part(text.substr(0, kShownText));
  for (char& c : part)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return "'" + part + (text.size() > kShownText ? "...'" : "'");
}

std::vector<std::string_view> split_at(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = text.find_first_not_of(separators); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(separators, end);
  }
  return parts;
}

double number_in(std::string_view text, double least, double most, const char* what, const Where& where) {
  const auto value = vpe::base::parse_number(text);
  if (!value || *value < least || *value > most)
    where.fail(shown(text) + " is no " + what + "; expected a number from " + format_number(least) + " to " +
               format_number(most));
  return *value;
}

KmlPoint point_of(const std::vector<std::string_view>& numbers, std::string_view text, const Where& where) {
  if (numbers.size() != 2 && numbers.size() != 3)
    where.fail(shown(text) + ": expected longitude, latitude and, if known, altitude");
  KmlPoint point;
  point.place.lon_deg = normalize_lon_deg(number_in(numbers[0], -360, 360, "longitude", where));
  point.place.lat_deg = number_in(numbers[1], -90, 90, "latitude", where);
  if (numbers.size() == 3)
    point.altitude_m = number_in(numbers[2], -kFarthest_m, kFarthest_m, "altitude", where);
  return point;
}

bool is_element(const CPLXMLNode* node, const char* name) {
  return node->eType == CXT_Element && std::string_view(node->pszValue) == name;
}

const CPLXMLNode* child_of(const CPLXMLNode* parent, const char* name) {
  for (const CPLXMLNode* child = parent->psChild; child != nullptr; child = child->psNext)
    if (is_element(child, name)) return child;
  return nullptr;
}

// Returns the text of an element without blanks at its ends.
std::string_view text_of(const CPLXMLNode* element) {
  for (const CPLXMLNode* child = element->psChild; child != nullptr; child = child->psNext) {
    if (child->eType != CXT_Text) continue;
    std::string_view text = child->pszValue;
    const std::size_t begin = text.find_first_not_of(kXmlBlanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kXmlBlanks) - begin + 1);
  }
  return {};
}

// Calls a function for every element below a list of siblings, in the order of the file. It returns whether to look
// into the element. Keeps its own stack, since files may be nested deeply.
void visit(const CPLXMLNode* first, const std::function<bool(const CPLXMLNode*)>& look) {
  std::vector<const CPLXMLNode*> open{first};
  while (!open.empty()) {
    const CPLXMLNode* node = open.back();
    if (node == nullptr) {
      open.pop_back();
      continue;
    }
    open.back() = node->psNext;
    if (node->eType == CXT_Element && look(node)) open.push_back(node->psChild);
  }
}

void add_line(const CPLXMLNode* line, Where where, KmlWay& way) {
  const CPLXMLNode* coordinates = child_of(line, "coordinates");
  if (coordinates == nullptr) where.fail("expected <coordinates>");
  for (const std::string_view tuple : split_at(text_of(coordinates), kXmlBlanks)) {
    where.point = way.points.size() + 1;
    way.points.push_back(point_of(split_at(tuple, ","), tuple, where));
  }
}

void add_track(const CPLXMLNode* track, Where where, KmlWay& way) {
  for (const CPLXMLNode* child = track->psChild; child != nullptr; child = child->psNext) {
    if (!is_element(child, "coord")) continue;
    where.point = way.points.size() + 1;
    const std::string_view text = text_of(child);
    way.points.push_back(point_of(split_at(text, kXmlBlanks), text, where));
  }
}

// Reads a Camera or LookAt.
KmlPoint view_of_element(const CPLXMLNode* element, const CPLXMLNode* fly_to, const Where& where) {
  const bool looks_at = is_element(element, "LookAt");
  const auto value = [&](const char* key, double least, double most) -> std::optional<double> {
    const CPLXMLNode* child = child_of(element, key);
    if (child == nullptr) return std::nullopt;
    return number_in(text_of(child), least, most, key, where);
  };
  const auto needed = [&](const char* key, double least, double most) {
    const std::optional<double> found = value(key, least, most);
    if (!found) where.fail(std::string("expected <") + key + "> in <" + element->pszValue + ">");
    return *found;
  };
  KmlPoint point;
  point.place.lon_deg = normalize_lon_deg(needed("longitude", -360, 360));
  point.place.lat_deg = needed("latitude", -90, 90);
  point.altitude_m = value("altitude", -kFarthest_m, kFarthest_m).value_or(0);
  const CPLXMLNode* mode = child_of(element, "altitudeMode");
  point.is_absolute = mode != nullptr && text_of(mode) == "absolute";
  // Without a mode and on the ground the altitude does not count.
  if (!point.is_absolute && (mode == nullptr || text_of(mode) != "relativeToGround")) point.altitude_m = 0;
  KmlView view;
  view.heading_deg = value("heading", -360, 360).value_or(0);
  view.tilt_deg = value("tilt", 0, 180).value_or(0);
  if (looks_at)
    view.range_m = needed("range", 0, kFarthest_m);
  else
    view.roll_deg = value("roll", -180, 180).value_or(0);
  if (const CPLXMLNode* duration = child_of(fly_to, "duration"))
    view.duration_s = number_in(text_of(duration), 0, 1e6, "duration", where);
  point.view = view;
  return point;
}

void add_tour(const CPLXMLNode* tour, Where where, KmlWay& way) {
  visit(tour->psChild, [&](const CPLXMLNode* node) {
    if (!is_element(node, "FlyTo")) return true;
    where.point = way.points.size() + 1;
    const CPLXMLNode* camera = child_of(node, "Camera");
    const CPLXMLNode* element = camera != nullptr ? camera : child_of(node, "LookAt");
    if (element == nullptr) where.fail("expected <Camera> or <LookAt> in <gx:FlyTo>");
    way.points.push_back(view_of_element(element, node, where));
    return false;
  });
}

}  // namespace

const char* to_string(KmlWay::Kind kind) {
  switch (kind) {
    case KmlWay::Kind::kLineString: return "LineString";
    case KmlWay::Kind::kTrack: return "gx:Track";
    case KmlWay::Kind::kTour: break;
  }
  return "gx:Tour";
}

std::vector<KmlWay> parse_kml(std::string_view text, const std::string& name) {
  if (text.size() > kLargestKml_bytes)
    throw std::runtime_error(name + ": more than 64 MiB; divide the file or leave out other features");
  if (text.starts_with("PK\x03\x04"))
    throw std::runtime_error(name + ": a KMZ archive; extract the KML file in it (unzip) and give that");
  if (text.find('\0') != std::string_view::npos)
    throw std::runtime_error(name + ": not a KML file: it contains zero bytes; save it as UTF-8");
  const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
  const CPLErrorStateBackuper state;
  CPLErrorReset();
  const CPLXMLTreeCloser tree(CPLParseXMLString(std::string(text).c_str()));
  bool is_xml = false;
  for (const CPLXMLNode* node = tree.get(); node != nullptr; node = node->psNext)
    is_xml = is_xml || (node->eType == CXT_Element && node->pszValue[0] != '?');
  if (!is_xml) {
    std::string words = tree.get() == nullptr ? CPLGetLastErrorMsg() : "no element in it";
    std::replace(words.begin(), words.end(), '\n', ' ');
    throw std::runtime_error(name + ": not a KML file" + (words.empty() ? "" : ": " + words) +
                             "; expected XML with a LineString, gx:Track or gx:Tour");
  }
  CPLStripXMLNamespace(tree.get(), nullptr, TRUE);
  std::vector<KmlWay> ways;
  visit(tree.get(), [&](const CPLXMLNode* node) {
    KmlWay way;
    if (is_element(node, "LineString"))
      way.kind = KmlWay::Kind::kLineString;
    else if (is_element(node, "Track"))
      way.kind = KmlWay::Kind::kTrack;
    else if (is_element(node, "Tour"))
      way.kind = KmlWay::Kind::kTour;
    else
      return true;
    const Where where{name,
                      std::string(to_string(way.kind)) + " (way " + std::to_string(ways.size() + 1) + ")"};
    switch (way.kind) {
      case KmlWay::Kind::kLineString: add_line(node, where, way); break;
      case KmlWay::Kind::kTrack: add_track(node, where, way); break;
      case KmlWay::Kind::kTour: add_tour(node, where, way); break;
    }
    if (way.points.empty()) where.fail("has no points");
    ways.push_back(std::move(way));
    return false;
  });
  if (ways.empty())
    throw std::runtime_error(name + ": no way in it; expected a LineString, gx:Track or gx:Tour");
  return ways;
}

}  // namespace mars
