#include "vpe/explore/drawing/drawing_files.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "vpe/base/number.h"
#include "vpe/base/quote.h"
#include "vpe/core/json_text.h"
#include "vpe/explore/drawing/sphere_polygon.h"

namespace vpe::explore {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostDepth = 8;  // of collections in collections

Json position(mars::LonLat place) { return Json::array({place.lon_deg, place.lat_deg}); }

Json geometry_of(const Drawing& drawing, bool is_clockwise) {
  Json coordinates = Json::array();
  for (const mars::LonLat place : drawing.vertices) coordinates.push_back(position(place));
  if (drawing.kind == DrawingKind::kPoint)
    return {{"type", "Point"}, {"coordinates", position(drawing.vertices.front())}};
  if (drawing.kind == DrawingKind::kLine) return {{"type", "LineString"}, {"coordinates", coordinates}};
  if (is_clockwise) std::reverse(coordinates.begin() + 1, coordinates.end());
  coordinates.push_back(position(drawing.vertices.front()));
  return {{"type", "Polygon"}, {"coordinates", Json::array({coordinates})}};
}

class Reader {
 public:
  explicit Reader(ParsedGeoJson& out) : out_(out) {}

  void read(const Json& json, const std::string& at, int depth = 0) {
    const std::string type = type_of(json, at);
    if (depth > kMostDepth)
      fail(at, "expected at most " + std::to_string(kMostDepth) + " collections in each other");
    if (type == "FeatureCollection") {
      if (depth == 0) read_planet(json);
      each(json, "features", at,
           [&](const Json& feature, const std::string& where) { read(feature, where, depth + 1); });
    } else if (type == "Feature") {
      read_feature(json, at);
    } else {
      read_geometry(json, at, Drawing(), false, 0);
    }
  }

 private:
  [[noreturn]] static void fail(const std::string& at, const std::string& what) {
    throw std::runtime_error(at.empty() ? what : at + ": " + what);
  }
  static std::string found(const Json& json) {
    std::string text = json.is_structured() && json.size() > 8 ? json.type_name() : core::json_text(json);
    return base::quote_text(text);
  }
  static std::string below(const std::string& at, const std::string& name) {
    return at.empty() ? name : at + "." + name;
  }

  void note(const std::string& text) {
    if (std::find(out_.notes.begin(), out_.notes.end(), text) == out_.notes.end()) out_.notes.push_back(text);
  }

  static std::string type_of(const Json& json, const std::string& at) {
    if (!json.is_object()) fail(at, "expected an object of GeoJSON, found " + found(json));
    const auto type = json.find("type");
    if (type == json.end() || !type->is_string()) fail(at, "expected a \"type\" of GeoJSON");
    return type->get<std::string>();
  }

  template <class Read>
  static void each(const Json& json, const char* name, const std::string& at, Read&& read_one) {
    const auto list = json.find(name);
    const std::string where = below(at, name);
    if (list == json.end() || !list->is_array()) fail(where, "expected a list");
    for (std::size_t n = 0; n < list->size(); ++n) read_one((*list)[n], where + "[" + std::to_string(n) + "]");
  }

  void read_planet(const Json& json) {
    if (json.contains("crs")) note("\"crs\" is not read");
    const auto planet = json.find("planet");
    if (planet == json.end()) return;
    const auto body = planet->is_object() ? planet->find("body") : planet->end();
    const auto radius = planet->is_object() ? planet->find("radius_m") : planet->end();
    if (!planet->is_object() || body == planet->end() || !body->is_string() || radius == planet->end() ||
        !radius->is_number())
      fail("planet", "expected {\"body\": NAME, \"radius_m\": NUMBER}, found " + found(*planet));
    out_.planet = PlanetSphere{body->get<std::string>(), radius->get<double>()};
  }

  void read_feature(const Json& feature, const std::string& at) {
    Drawing drawing;
    bool is_clockwise = false;
    const auto properties = feature.find("properties");
    if (properties != feature.end() && properties->is_object()) {
      for (const auto& [key, value] : properties->items()) {
        const std::string where = below(at, "properties." + key);
        if ((key == "name" || key == "Name" || key == "NAME") && value.is_string()) {
          drawing.name = value.get<std::string>();
          if (const std::string problem = problem_of_name(drawing.name); !problem.empty()) fail(where, problem);
        } else if (key == "colour") {
          const auto colour = value.is_string() ? parse_colour(value.get<std::string>()) : std::nullopt;
          if (!colour) fail(where, "expected a colour such as \"#ffd65a\", found " + found(value));
          drawing.colour = *colour;
        } else if (key == "visible" || key == "clockwise") {
          if (!value.is_boolean()) fail(where, "expected true or false, found " + found(value));
          (key == "visible" ? drawing.visible : is_clockwise) = value.get<bool>();
        } else {
          note("properties other than name, colour and visible are not read");
        }
      }
    } else if (properties != feature.end() && !properties->is_null()) {
      fail(below(at, "properties"), "expected an object or null, found " + found(*properties));
    }
    const auto geometry = feature.find("geometry");
    if (geometry == feature.end()) fail(at, "expected a \"geometry\"");
    if (geometry->is_null()) return note("features without geometry are not read");
    read_geometry(*geometry, below(at, "geometry"), drawing, is_clockwise, 0);
  }

  void read_geometry(const Json& json, const std::string& at, const Drawing& like, bool is_clockwise,
                     int depth) {
    const std::string type = type_of(json, at);
    const std::string where = below(at, "coordinates");
    const auto coordinates = json.find("coordinates");
    if (type == "GeometryCollection") {
      if (depth >= kMostDepth)
        fail(at, "expected at most " + std::to_string(kMostDepth) + " collections in each other");
      return each(json, "geometries", at, [&](const Json& part, const std::string& part_at) {
        read_geometry(part, part_at, like, is_clockwise, depth + 1);
      });
    }
    const bool is_multi = type.starts_with("Multi");
    const std::string one = is_multi ? type.substr(5) : type;
    if (one != "Point" && one != "LineString" && one != "Polygon")
      fail(below(at, "type"),
           "expected Point, LineString, Polygon, Multi..., GeometryCollection, Feature or "
           "FeatureCollection, found " +
               base::quote_text(type));
    if (coordinates == json.end() || !coordinates->is_array()) fail(where, "expected a list");
    const auto read_one = [&](const Json& part, const std::string& part_at) {
      add(one, part, part_at, like, is_clockwise);
    };
    if (!is_multi) return read_one(*coordinates, where);
    each(json, "coordinates", at, read_one);
  }

  void add(const std::string& type, const Json& coordinates, const std::string& at, Drawing drawing,
           bool is_clockwise) {
    drawing.vertices.clear();
    if (type == "Point") {
      drawing.kind = DrawingKind::kPoint;
      drawing.vertices.push_back(place_of(coordinates, at));
    } else if (type == "LineString") {
      drawing.kind = DrawingKind::kLine;
      drawing.vertices = places_of(coordinates, at);
    } else {
      drawing.kind = DrawingKind::kPolygon;
      if (!coordinates.is_array() || coordinates.empty()) fail(at, "expected a list of rings");
      if (coordinates.size() > 1) note("holes of polygons are not read");
      drawing.vertices = places_of(coordinates[0], at + "[0]");
      const auto& ring = drawing.vertices;
      if (ring.size() < 4 || ring.front().lon_deg != ring.back().lon_deg ||
          ring.front().lat_deg != ring.back().lat_deg)
        fail(at + "[0]", "expected a ring of at least four positions, of which the last is the first again");
      drawing.vertices.pop_back();
      if (is_clockwise) std::reverse(drawing.vertices.begin() + 1, drawing.vertices.end());
    }
    if (const std::string problem = problem_of(drawing); !problem.empty()) fail(at, problem);
    if (out_.drawings.size() >= DrawingLimits::kMostDrawings)
      fail(at, "expected at most " + std::to_string(DrawingLimits::kMostDrawings) + " drawings");
    for (mars::LonLat& place : drawing.vertices) place.lon_deg = mars::normalize_lon_deg(place.lon_deg);
    out_.drawings.push_back(std::move(drawing));
  }

  std::vector<mars::LonLat> places_of(const Json& json, const std::string& at) {
    if (!json.is_array()) fail(at, "expected a list of positions, found " + found(json));
    if (json.size() > DrawingLimits::kMostVertices + 1)
      fail(at, "expected at most " + std::to_string(DrawingLimits::kMostVertices) + " positions, found " +
                   std::to_string(json.size()));
    std::vector<mars::LonLat> places;
    places.reserve(json.size());
    for (std::size_t n = 0; n < json.size(); ++n)
      places.push_back(place_of(json[n], at + "[" + std::to_string(n) + "]"));
    return places;
  }

  mars::LonLat place_of(const Json& json, const std::string& at) {
    if (!json.is_array() || json.size() < 2 || !json[0].is_number() || !json[1].is_number())
      fail(at, "expected [LONGITUDE, LATITUDE] in degrees, found " + found(json));
    if (json.size() > 2) note("heights of positions are not read");
    const mars::LonLat place{json[0].get<double>(), json[1].get<double>()};
    if (const std::string problem = problem_of_place(place); !problem.empty()) fail(at, problem);
    return place;
  }

  ParsedGeoJson& out_;
};

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string to_geojson(SharedDrawings drawings, const PlanetSphere& planet) {
  Json features = Json::array();
  for (const auto& drawing : drawings) {
    Json properties{
        {"name", drawing->name}, {"colour", colour_text(drawing->colour)}, {"visible", drawing->visible}};
    const bool is_clockwise =
        drawing->kind == DrawingKind::kPolygon && signed_sphere_area(directions_of(drawing->vertices)) < 0;
    if (is_clockwise) properties["clockwise"] = true;
    features.push_back({{"type", "Feature"},
                        {"properties", std::move(properties)},
                        {"geometry", geometry_of(*drawing, is_clockwise)}});
  }
  // One feature a line: the whole in one line cannot be compared, indented numbers would fill pages.
  std::string text =
      "{\"type\": \"FeatureCollection\",\n \"planet\": " +
      core::json_text(Json{{"body", planet.body},
                           {"radius_m", planet.radius_m},
                           {"coordinates", "longitude east, planetocentric latitude, degrees"}}) +
      ",\n \"features\": [";
  for (std::size_t n = 0; n < features.size(); ++n)
    text.append(n == 0 ? "\n  " : ",\n  ").append(core::json_text(features[n]));
  return text + "\n]}\n";
}

ParsedGeoJson parse_geojson(std::string_view text, const std::string& file) {
  ParsedGeoJson out;
  if (text.size() > DrawingFileLimits::kMostBytes) {
    out.error = file + ": expected at most " + std::to_string(DrawingFileLimits::kMostBytes >> 20U) +
                " MiB, found " + std::to_string(text.size() >> 20U);
    return out;
  }
  try {
    Reader(out).read(Json::parse(text), "");
  } catch (const Json::parse_error& e) {
    const auto line =
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(e.byte, text.size())),
                       '\n');
    out.error = file + ":" + std::to_string(line) + ": not JSON; a file of GeoJSON is expected";
  } catch (const std::exception& e) {
    out.error = file + ": " + e.what();
  }
  if (!out.error.empty()) out.drawings.clear();
  return out;
}

std::string to_csv(SharedDrawings drawings,
                   const std::function<std::optional<double>(mars::LonLat)>& elevation_m) {
  std::string text = "drawing,kind,name,colour,visible,vertex,lon_deg,lat_deg";
  text += elevation_m ? ",elevation_m\n" : "\n";
  for (std::size_t n = 0; n < drawings.size(); ++n) {
    const Drawing& d = *drawings[n];
    const std::string begin = std::to_string(n + 1) + "," + std::string(to_string(d.kind)) + "," +
                              csv_text(d.name) + "," + colour_text(d.colour) + "," + (d.visible ? "1" : "0") +
                              ",";
    for (std::size_t k = 0; k < d.vertices.size(); ++k) {
      text.append(begin).append(std::to_string(k + 1)).append(",");
      text += base::format_number(d.vertices[k].lon_deg) + "," + base::format_number(d.vertices[k].lat_deg);
      if (elevation_m) {
        const std::optional<double> height_m = elevation_m(d.vertices[k]);
        text.append(",").append(height_m ? base::format_display(*height_m, 3) : "");
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace vpe::explore
