#include "panorama/page/page_marks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "mars/geodesy/sphere.h"
#include "panorama/viewpoint.h"

namespace panorama {

namespace {

using MarkJson = nlohmann::json;

double mark_number(const MarkJson& mark, const char* key, double most, const std::string& where) {
  const auto value = mark.find(key);
  if (value == mark.end() || !value->is_number() || !(std::abs(value->get<double>()) <= most)) {
    throw MetadataError(where + " needs " + key + ", a number within +-" +
                        std::to_string(static_cast<int>(most)));
  }
  return value->get<double>();
}

PageName name_of_mark(const MarkJson& mark, const std::string& where) {
  const auto text = mark.is_object() ? mark.find("name") : mark.end();
  if (!mark.is_object() || text == mark.end() || !text->is_string() || text->get<std::string>().empty())
    throw MetadataError(where + " is no object {...} with a name");
  PageName name{text->get<std::string>(),
                {mark_number(mark, "azimuth_deg", PanoramaLimits::kMaxAzimuth_deg, where),
                 mark_number(mark, "elevation_deg", 90.0, where)},
                {}};
  if (const auto range = mark.find("range_m"); range != mark.end() && !range->is_null()) {
    if (!range->is_number() || !(range->get<double>() > 0.0))
      throw MetadataError(where + ": range_m is no number above 0");
    name.range_m = range->get<double>();
  }
  return name;
}

// Returns true for an address that leads to nothing but another file: no scheme, no server.
bool is_relative_address(const std::string& address) {
  if (address.empty() || address.front() == '/' || address.front() == '\\') return false;
  if (std::any_of(address.begin(), address.end(), [](char c) { return static_cast<unsigned char>(c) <= ' '; }))
    return false;
  const std::size_t colon = address.find(':');
  return colon == std::string::npos || address.find_first_of("/?#") < colon;
}

const MarkJson& list_of(const MarkJson& root, const char* key) {
  static const MarkJson kNone = MarkJson::array();
  const auto list = root.find(key);
  if (list == root.end() || list->is_null()) return kNone;
  if (!list->is_array()) throw MetadataError(std::string(key) + " is not a list [...]");
  return *list;
}

}  // namespace

PageMarks read_page_marks(std::string_view text) {
  PageMarks marks;
  try {
    const MarkJson root = MarkJson::parse(text);
    if (!root.is_object()) throw MetadataError("JSON without an object {...} of keys");
    int number = 0;
    for (const MarkJson& mark : list_of(root, "names"))
      marks.names.push_back(name_of_mark(mark, "names, entry " + std::to_string(++number)));
    number = 0;
    for (const MarkJson& mark : list_of(root, "hotspots")) {
      const std::string where = "hotspots, entry " + std::to_string(++number);
      PageHotspot hotspot{name_of_mark(mark, where), ""};
      if (const auto page = mark.find("page"); page != mark.end() && page->is_string())
        hotspot.page = page->get<std::string>();
      if (!is_relative_address(hotspot.page)) {
        throw MetadataError(where + R"( needs page, the relative address of a page, as "../rim/index.html")");
      }
      marks.hotspots.push_back(std::move(hotspot));
    }
  } catch (const MarkJson::exception& e) {
    throw MetadataError("not well-formed JSON: " + excerpt(e.what(), 300));
  }
  return marks;
}

std::string address_of(const std::filesystem::path& file, const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  const fs::path to = fs::weakly_canonical(fs::absolute(file));
  const std::string relative =
      to.lexically_relative(fs::weakly_canonical(fs::absolute(folder))).generic_string();
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string address;
  for (const char c : relative) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                          c == '-' || c == '.' || c == '_' || c == '~' || c == '/';
    if (is_plain) {
      address += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    address += '%';
    address += kDigits[byte >> 4];
    address += kDigits[byte & 15];
  }
  return address;
}

std::optional<PageName> seen_from(const RecordedViewpoint& here, const RecordedViewpoint& there,
                                  double radius_m) {
  if (!here.alt_m || !there.alt_m) return std::nullopt;
  const Viewpoint from = viewpoint_at({here.lon_deg, here.lat_deg}, *here.alt_m, radius_m);
  const Viewpoint to = viewpoint_at({there.lon_deg, there.lat_deg}, *there.alt_m, radius_m);
  const glm::dvec3 way = to.position_m - from.position_m;
  const double range_m = glm::length(way);
  constexpr double kSamePlace_m = 0.01;
  if (!(range_m > kSamePlace_m)) return std::nullopt;
  const double east = glm::dot(way, from.frame.east);
  const double north = glm::dot(way, from.frame.north);
  const double up = glm::dot(way, from.frame.up);
  PageName name;
  name.direction.azimuth_deg = std::atan2(east, north) / mars::kRadiansPerDegree;
  if (name.direction.azimuth_deg < 0.0) name.direction.azimuth_deg += 360.0;
  // A direction just west of north is rounded to a full circle.
  if (name.direction.azimuth_deg >= 360.0) name.direction.azimuth_deg = 0.0;
  name.direction.elevation_deg = std::atan2(up, std::hypot(east, north)) / mars::kRadiansPerDegree;
  name.range_m = range_m;
  return name;
}

}  // namespace panorama
