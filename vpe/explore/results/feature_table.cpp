#include "vpe/explore/results/feature_table.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "mars/vector/ring_longitudes.h"
#include "vpe/core/json_text.h"

namespace vpe::explore {

namespace {

using nlohmann::json;
using Values = std::vector<std::pair<std::string, mars::FieldValue>>;

constexpr int kMostEdgeHalvings = 14;
constexpr const char* kPartField = "part";

glm::dvec2 vertex_at(mars::LonLat place) { return {place.lon_deg, place.lat_deg}; }

// Appends vertices between two places, without the places.
void add_between(mars::LonLat a, mars::LonLat b, int halvings, std::vector<glm::dvec2>& ring) {
  const mars::LonLat middle = mars::lon_lat(mars::slerp(mars::direction(a), mars::direction(b), 0.5));
  const double turn_deg = std::remainder(b.lon_deg - a.lon_deg, 360.0);
  const mars::LonLat straight{a.lon_deg + turn_deg / 2, (a.lat_deg + b.lat_deg) / 2};
  if (halvings == kMostEdgeHalvings || mars::distance_rad(middle, straight) <= kStraightEdge_rad) return;
  add_between(a, middle, halvings + 1, ring);
  ring.push_back(vertex_at(middle));
  add_between(middle, b, halvings + 1, ring);
}

std::vector<glm::dvec2> ring_of(std::span<const mars::LonLat> places, bool is_closed) {
  std::vector<glm::dvec2> ring;
  for (std::size_t n = 0; n < places.size(); ++n) {
    if (n > 0) add_between(places[n - 1], places[n], 0, ring);
    ring.push_back(vertex_at(places[n]));
  }
  if (is_closed) {
    add_between(places.back(), places.front(), 0, ring);
    ring.push_back(vertex_at(places.front()));
  }
  return ring;
}

mars::Shape unwrapped(mars::Shape shape) {
  mars::unwrap_longitudes(shape);
  return shape;
}

std::string text_of(const json& value) {
  return value.is_string() ? core::text_in_json(value.get<std::string>()) : core::json_text(value);
}

bool holds_objects(const json& list) {
  return std::ranges::any_of(list, [](const json& value) { return value.is_object(); });
}

void add_value(const std::string& name, const json& value, Values& values) {
  const std::string prefix = name.empty() ? "" : name + "_";
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) add_value(prefix + key, inner, values);
  } else if (value.is_array() && holds_objects(value)) {
    for (std::size_t n = 0; n < value.size(); ++n) add_value(prefix + std::to_string(n + 1), value[n], values);
  } else if (value.is_array()) {
    std::string text;
    for (const json& one : value) text += (text.empty() ? "" : "; ") + text_of(one);
    values.emplace_back(name, text);
  } else if (value.is_boolean()) {
    values.emplace_back(name, std::int64_t{value.get<bool>()});
  } else if (value.is_number_integer()) {
    values.emplace_back(name, value.get<std::int64_t>());
  } else if (value.is_number() && std::isfinite(value.get<double>())) {
    values.emplace_back(name, value.get<double>());
  } else if (value.is_string()) {
    values.emplace_back(name, text_of(value));
  }
}

}  // namespace

mars::Shape point_shape(mars::LonLat place) { return {mars::ShapeKind::point, {{vertex_at(place)}}}; }

mars::Shape great_circle_line(std::span<const mars::LonLat> places) {
  return unwrapped({mars::ShapeKind::line, {ring_of(places, false)}});
}

mars::Shape great_circle_polygon(std::span<const mars::LonLat> places) {
  return unwrapped({mars::ShapeKind::polygon, {ring_of(places, true)}});
}

void FeatureTable::add(const std::string& part, const json& values, std::vector<mars::Shape> shapes) {
  Row& row = rows_.emplace_back();
  if (!part.empty()) row.values.emplace_back(kPartField, part);
  add_value("", values, row.values);
  row.shapes = std::move(shapes);
}

mars::FeatureLayer FeatureTable::layer() const {
  mars::FeatureLayer layer;
  layer.name = name_;
  std::unordered_map<std::string, std::size_t> positions;
  for (const Row& row : rows_)
    for (const auto& [name, value] : row.values)
      if (positions.emplace(name, layer.fields.size()).second) layer.fields.push_back(name);
  for (const Row& row : rows_) {
    mars::Feature& feature = layer.features.emplace_back();
    feature.number = static_cast<std::int64_t>(layer.features.size());
    feature.values.resize(layer.fields.size());
    for (const auto& [name, value] : row.values) feature.values[positions.at(name)] = value;
    feature.shapes = row.shapes;
  }
  return layer;
}

}  // namespace vpe::explore
