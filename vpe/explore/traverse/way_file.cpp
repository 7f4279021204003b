#include "vpe/explore/traverse/way_file.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "mars/vector/feature_reader.h"
#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

using mars::Feature;
using mars::FeatureLayer;
using mars::ShapeKind;

std::string lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

bool is_gpx(const std::string& file) {
  return lower_case(std::filesystem::path(file).extension().string()) == ".gpx";
}

// Takes digits from the front of a text.
class StampReader {
 public:
  explicit StampReader(std::string_view text) : text_(text) {}

  bool is_done() const { return at_ >= text_.size(); }
  bool takes(std::string_view any) {
    if (is_done() || any.find(text_[at_]) == std::string_view::npos) return false;
    ++at_;
    return true;
  }
  std::optional<int> digits(std::size_t count) {
    int value = 0;
    for (std::size_t n = 0; n < count; ++n, ++at_) {
      if (is_done() || text_[at_] < '0' || text_[at_] > '9') return std::nullopt;
      value = 10 * value + (text_[at_] - '0');
    }
    return value;
  }
  // Returns the fraction behind a point; 0 without one.
  double fraction() {
    double value = 0;
    if (!takes(".,")) return value;
    for (double unit = 0.1; !is_done() && text_[at_] >= '0' && text_[at_] <= '9'; unit /= 10, ++at_)
      value += unit * (text_[at_] - '0');
    return value;
  }
  char sign() {
    const char c = is_done() ? '\0' : text_[at_];
    return takes("+-") ? c : '\0';
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

// Returns the seconds that a zone is ahead of UTC, or nullopt for what is none.
std::optional<double> read_zone(StampReader& reader) {
  if (reader.is_done() || reader.takes("Zz")) return 0;
  const char sign = reader.sign();
  if (sign == '\0') return std::nullopt;
  const auto hours = reader.digits(2);
  if (!hours || *hours > 23) return std::nullopt;
  int minutes = 0;
  (void)reader.takes(":");
  if (!reader.is_done()) {
    const auto read = reader.digits(2);
    if (!read || *read > 59) return std::nullopt;
    minutes = *read;
  }
  return (sign == '-' ? -1 : 1) * (3600.0 * *hours + 60.0 * minutes);
}

// Returns a value as text; empty: it has none.
std::string value_text(const mars::FieldValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&value)) return base::format_number(*number);
  return {};
}

// Reads values of points by the names of their fields.
class PointFields {
 public:
  PointFields(const FeatureLayer& layer, const std::string& file)
      : where_(file + ": layer '" + layer.name + "', feature ") {
    for (std::size_t n = 0; n < layer.fields.size(); ++n) {
      std::string name = lower_case(layer.fields[n]);
      if (name.starts_with("ogr_")) name.erase(0, 4);
      if (name.ends_with("_deg")) name.resize(name.size() - 4);
      columns_.emplace(name, n);
    }
  }

  std::string text(const Feature& feature, std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      const auto found = columns_.find(name);
      if (found == columns_.end()) continue;
      if (std::string value = value_text(feature.values[found->second]); !value.empty()) return value;
    }
    return {};
  }

  std::optional<double> angle_deg(const Feature& feature, std::initializer_list<const char*> names,
                                  double most_deg) const {
    const std::string value = text(feature, names);
    if (value.empty()) return std::nullopt;
    const auto angle = base::parse_number(value);
    if (angle && std::abs(*angle) <= most_deg) return angle;
    fail(feature, std::string(*names.begin()) + " from " + base::format_number(-most_deg) + " to " +
                      base::format_number(most_deg) + " degrees, found '" + value + "'");
  }

  WayPoint point(const Feature& feature, glm::dvec2 at) const {
    constexpr double kMostYaw_deg = 360;
    constexpr double kMostPitch_deg = 90;
    constexpr double kMostRoll_deg = 180;
    WayPoint point;
    point.place = {mars::normalize_lon_deg(at.x), at.y};
    const std::string stamp = text(feature, {"time", "timestamp", "datetime", "time_s"});
    if (!stamp.empty()) {
      point.time_s = parse_time_stamp(stamp);
      if (!point.time_s) fail(feature, "a time as 2026-11-27T12:00:00Z or in seconds, found '" + stamp + "'");
    }
    point.yaw_deg = angle_deg(feature, {"yaw", "heading"}, kMostYaw_deg);
    point.pitch_deg = angle_deg(feature, {"pitch"}, kMostPitch_deg);
    point.roll_deg = angle_deg(feature, {"roll"}, kMostRoll_deg);
    return point;
  }

 private:
  [[noreturn]] void fail(const Feature& feature, const std::string& expected) const {
    throw std::runtime_error(where_ + std::to_string(feature.number) + ": expected " + expected);
  }

  std::string where_;
  std::map<std::string, std::size_t> columns_;
};

std::vector<FileWay> lines_of(const std::vector<FeatureLayer>& layers) {
  std::vector<FileWay> ways;
  for (const FeatureLayer& layer : layers) {
    for (const Feature& feature : layer.features) {
      for (const mars::Shape& shape : feature.shapes) {
        if (shape.kind != ShapeKind::line) continue;
        FileWay& way = ways.emplace_back(FileWay{"line", {}});
        for (const glm::dvec2& at : shape.rings.front())
          way.points.push_back({{mars::normalize_lon_deg(at.x), at.y}, {}, {}, {}, {}});
      }
    }
  }
  return ways;
}

// Returns the points of a layer: a way for each of their groups, of which fields tell the number, or one way.
std::vector<FileWay> points_of_layer(const FeatureLayer& layer, const std::string& file,
                                     std::span<const char* const> groups) {
  const PointFields fields(layer, file);
  std::vector<FileWay> ways;
  std::vector<std::string> last;
  for (const Feature& feature : layer.features) {
    std::vector<std::string> group;
    for (const char* name : groups) group.push_back(fields.text(feature, {name}));
    for (const mars::Shape& shape : feature.shapes) {
      if (shape.kind != ShapeKind::point) continue;
      if (ways.empty() || group != last) ways.push_back({"points", {}});
      last = group;
      ways.back().points.push_back(fields.point(feature, shape.rings.front().front()));
    }
  }
  return ways;
}

// Returns the ways of the first of the layers of GPX that has points.
std::vector<FileWay> gpx_ways(const std::string& file, const std::string& chosen, double radius_m) {
  struct GpxLayer {
    const char* name;
    const char* lines;  // the layer that has the same as lines
    std::vector<const char*> groups;
  };
  const std::array<GpxLayer, 3> kinds{
      GpxLayer{"track_points", "tracks", {"track_fid", "track_seg_id"}},
      GpxLayer{"route_points", "routes", {"route_fid"}},
      GpxLayer{"waypoints", "waypoints", {}},
  };
  for (const GpxLayer& kind : kinds) {
    if (!chosen.empty() && chosen != kind.name && chosen != kind.lines) continue;
    mars::FeatureReadOptions options;
    options.layer = kind.name;
    for (const FeatureLayer& layer : mars::read_features(file, options, radius_m)) {
      std::vector<FileWay> ways = points_of_layer(layer, file, kind.groups);
      if (!ways.empty()) return ways;
    }
  }
  if (chosen.empty()) return {};
  mars::FeatureReadOptions options;
  options.layer = chosen;
  return lines_of(mars::read_features(file, options, radius_m));
}

}  // namespace

std::vector<FileWay> read_ways(const std::string& file, const std::string& layer, double planet_radius_m) {
  std::vector<FileWay> ways;
  if (is_gpx(file)) {
    ways = gpx_ways(file, layer, planet_radius_m);
  } else {
    mars::FeatureReadOptions options;
    options.layer = layer;
    const std::vector<FeatureLayer> layers = mars::read_features(file, options, planet_radius_m);
    ways = lines_of(layers);
    if (ways.empty()) {
      for (const FeatureLayer& points : layers) {
        for (FileWay& way : points_of_layer(points, file, {})) ways.push_back(std::move(way));
      }
    }
  }
  if (ways.empty())
    throw std::runtime_error(file + (layer.empty() ? std::string() : ": layer '" + layer + "'") +
                             ": expected lines or points of a way, found none");
  return ways;
}

std::optional<double> parse_time_stamp(std::string_view text) {
  if (const auto seconds = base::parse_number(text)) return seconds;
  StampReader reader(text);
  const auto year = reader.digits(4);
  if (!year || !reader.takes("-/")) return std::nullopt;
  const auto month = reader.digits(2);
  if (!month || !reader.takes("-/")) return std::nullopt;
  const auto day = reader.digits(2);
  if (!day || !reader.takes(" Tt")) return std::nullopt;
  const auto hour = reader.digits(2);
  if (!hour || *hour > 23 || !reader.takes(":")) return std::nullopt;
  const auto minute = reader.digits(2);
  if (!minute || *minute > 59) return std::nullopt;
  double second = 0;
  if (reader.takes(":")) {
    const auto whole = reader.digits(2);
    if (!whole || *whole > 60) return std::nullopt;
    second = *whole + reader.fraction();
  }
  const auto zone_s = read_zone(reader);
  const std::chrono::year_month_day date{std::chrono::year{*year},
                                         std::chrono::month{static_cast<unsigned>(*month)},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  if (!zone_s || !reader.is_done() || !date.ok()) return std::nullopt;
  const auto days = static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
  return 86400.0 * days + 3600.0 * *hour + 60.0 * *minute + second - *zone_s;
}

}  // namespace vpe::explore
