#include "mars/raster/pds_label.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <vector>

namespace mars {
namespace {

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

// Longest name of an object. It is stored with each keyword of the object, so a hostile label must not make it
// long.
constexpr std::size_t kMaxName = 100;

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  PdsLabel read() {
    PdsLabel label;
    std::vector<std::string> objects;
    for (;;) {
      skip_blank();
      const std::string key = upper(word());
      if (key.empty()) {
        if (at_end()) return label;
        ++at_;
        continue;
      }
      skip_blank();
      const bool assigned = !at_end() && text_[at_] == '=';
      if (assigned) ++at_;
      if (key == "END") return label;
      if (key == "END_OBJECT" || key == "END_GROUP") {
        if (assigned) value();
        if (!objects.empty()) objects.pop_back();
        continue;
      }
      if (!assigned) continue;
      const std::string text = value();
      if (key == "OBJECT" || key == "GROUP") {
        objects.push_back(upper(std::string_view(text).substr(0, kMaxName)));
      } else {
        label.values.emplace(objects.empty() ? key : objects.back() + "." + key, text);
      }
    }
  }

 private:
  bool at_end() const { return at_ >= text_.size(); }

  void skip_to(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
  }

  void skip_blank() {
    while (!at_end()) {
      if (is_space(text_[at_])) {
        ++at_;
      } else if (text_.substr(at_, 2) == "/*") {
        skip_to("*/");
      } else {
        return;
      }
    }
  }

  std::string_view word() {
    const std::size_t start = at_;
    while (!at_end() && !is_space(text_[at_]) && text_[at_] != '=') ++at_;
    return text_.substr(start, at_ - start);
  }

  std::string bracketed(char open, char close) {
    const std::size_t start = at_;
    int depth = 0;
    while (!at_end()) {
      const char c = text_[at_++];
      if (c == open) ++depth;
      if (c == close && --depth == 0) break;
    }
    return std::string(text_.substr(start, at_ - start));
  }

  std::string value() {
    skip_blank();
    if (at_end()) return {};
    const char first = text_[at_];
    if (first == '"' || first == '\'') {
      const std::size_t start = ++at_;
      skip_to(std::string_view(&first, 1));
      const std::size_t stop = at_end() && text_.back() != first ? at_ : at_ - 1;
      return std::string(trim(text_.substr(start, stop - std::min(stop, start))));
    }
    if (first == '(') return bracketed('(', ')');
    if (first == '{') return bracketed('{', '}');
    const std::size_t start = at_;
    while (!at_end() && text_[at_] != '\n' && text_[at_] != '\r' && text_.substr(at_, 2) != "/*") ++at_;
    return std::string(trim(text_.substr(start, at_ - start)));
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

constexpr double kAgree_px = 0.25;

bool same_lon(double a_deg, double b_deg, double pixels_per_degree) {
  return std::abs(std::remainder(a_deg - b_deg, 360.0)) * pixels_per_degree <= kAgree_px;
}

// Returns true if the lines of the map are even in latitude.
bool has_even_lines(const std::string& type) {
  return type == "SIMPLE CYLINDRICAL" || type == "EQUIRECTANGULAR" || type == "EQUIDISTANT" ||
         type == "SINUSOIDAL";
}

bool is_polar_map(const std::string& type, double centre_lat_deg) {
  return type == "POLAR STEREOGRAPHIC" || (type == "STEREOGRAPHIC" && std::abs(centre_lat_deg) == 90);
}

bool says_planetographic(const PdsLabel& label, bool west_positive) {
  for (const char* key : {"COORDINATE_SYSTEM_NAME", "PROJECTION_LATITUDE_TYPE", "LATITUDE_TYPE"}) {
    const std::string kind = upper(label.text(std::string("IMAGE_MAP_PROJECTION.") + key));
    if (kind == "PLANETOGRAPHIC") return true;
    if (kind == "PLANETOCENTRIC") return false;
  }
  return west_positive;
}

}  // namespace

std::string PdsLabel::text(std::string_view name) const {
  const auto found = values.find(name);
  return found == values.end() ? std::string() : found->second;
}

std::optional<double> PdsLabel::number(std::string_view name) const {
  const std::string value = text(name);
  const char* begin = value.data();
  if (!value.empty() && value.front() == '+') ++begin;
  double result = 0;
  const auto [rest, error] = std::from_chars(begin, value.data() + value.size(), result);
  if (error != std::errc() || !std::isfinite(result)) return std::nullopt;
  const std::string_view tail = trim({rest, static_cast<std::size_t>(value.data() + value.size() - rest)});
  if (!tail.empty() && tail.front() != '<') return std::nullopt;
  return result;
}

PdsLabel parse_pds_label(std::string_view text) { return Reader(text).read(); }

std::string pds_projection(const PdsLabel& label, const std::string& object) {
  std::string type = upper(label.text(object + ".MAP_PROJECTION_TYPE"));
  std::replace(type.begin(), type.end(), '_', ' ');
  return type;
}

PdsPlacement pds_placement(const PdsLabel& label) {
  const auto number = [&](const char* key) { return label.number(std::string("IMAGE_MAP_PROJECTION.") + key); };
  PdsPlacement placement;
  placement.west_positive = upper(label.text("IMAGE_MAP_PROJECTION.POSITIVE_LONGITUDE_DIRECTION")) == "WEST";
  placement.planetographic = says_planetographic(label, placement.west_positive);

  const auto line = number("LINE_PROJECTION_OFFSET");
  const auto sample = number("SAMPLE_PROJECTION_OFFSET");
  const auto resolution = number("MAP_RESOLUTION");
  const std::string type = pds_projection(label);
  if (!line || !sample) return placement;

  const auto centre_lon = number("CENTER_LONGITUDE");
  const auto north = number("MAXIMUM_LATITUDE");
  const auto west = number("WESTERNMOST_LONGITUDE");
  const auto lines = label.number("IMAGE.LINES");
  const auto samples = label.number("IMAGE.LINE_SAMPLES");
  const double centre_lat = number("CENTER_LATITUDE").value_or(0.0);
  const bool even = type == "SIMPLE CYLINDRICAL" && centre_lat == 0 && centre_lon;
  const auto west_edge = [&](double edge_offset) {
    return placement.east(*centre_lon) - (*sample + edge_offset) / *resolution;
  };

  // Bounds of the data, instead of the edges of the pixels, confirm nothing.
  const auto south = number("MINIMUM_LATITUDE");
  const bool bounds_are_edges =
      north && resolution && *resolution > 0 &&
      (!south || !lines || std::abs((*north - *south) * *resolution - *lines) <= kAgree_px);
  const auto lines_agree = [&](double edge_offset) {
    if (is_polar_map(type, centre_lat)) {
      return lines && samples && std::abs(*line + edge_offset - *lines / 2) <= kAgree_px &&
             std::abs(*sample + edge_offset - *samples / 2) <= kAgree_px;
    }
    return has_even_lines(type) && bounds_are_edges &&
           std::abs(*line + edge_offset - *north * *resolution) <= kAgree_px;
  };
  const auto samples_agree = [&](double edge_offset) {
    return !even || !west || same_lon(west_edge(edge_offset), placement.east(*west), *resolution);
  };
  // A file with fewer lines than its map has the edges of its columns all the same.
  const auto east = number("EASTERNMOST_LONGITUDE");
  const bool columns_are_edges =
      even && west && east && samples && resolution && *resolution > 0 && !bounds_are_edges &&
      std::abs(std::remainder(std::abs(*east - *west) * *resolution - *samples, 360 * *resolution)) <=
          kAgree_px;
  for (const double edge_offset : {kCountsFromOne, kCountsFromZero, kCountsFromHalf}) {
    if (!(columns_are_edges || lines_agree(edge_offset)) || !samples_agree(edge_offset)) continue;
    placement.edge_offset_px = edge_offset;
    placement.edge_is_confirmed = true;
    if (even) {
      placement.grid = DegreeGrid{west_edge(edge_offset), (*line + edge_offset) / *resolution, *resolution};
    }
    break;
  }
  return placement;
}

VerticalDatum pds_datum(const PdsLabel& label) {
  const std::string text = upper(label.text("IMAGE.NAME") + " " + label.text("IMAGE.DESCRIPTION"));
  const auto says = [&](std::string_view word) { return text.find(word) != std::string::npos; };
  if (says("TOPOGRAPHY") || says("ABOVE AREOID") || says("ABOVE THE AREOID")) return VerticalDatum::areoid();
  if (says("RADIUS") || says("AREOID")) return VerticalDatum::radius();
  return {};
}

}  // namespace mars
