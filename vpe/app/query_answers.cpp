#include "vpe/app/query_answers.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "vpe/app/cli/json_output.h"
#include "vpe/app/planet/measured_part.h"
#include "vpe/base/number.h"
#include "vpe/explore/results/feature_table.h"

namespace vpe::app {

namespace {

nlohmann::json to_json(const paging::PlaceAnswer& a, const paging::PlanetMeta& meta, double measured_m) {
  const char* kind = kind_of(a, meta);
  using nlohmann::json;
  const auto value = [&](double x) { return a.nodata ? json() : json(x); };
  const mars::SourceInfo* source = source_of(a, meta);
  const bool has_error = a.resampling.posts > 0;
  json tile_sources = json::array();
  for (const int s : a.tile_sources) tile_sources.push_back(meta.sources.at(static_cast<std::size_t>(s)).name);
  return {{"lon_deg", a.place.lon_deg},
          {"lat_deg", a.place.lat_deg},
          {"elevation_m", value(a.elevation_m)},
          {"measured_m", std::isfinite(measured_m) ? json(measured_m) : json()},
          {"kind", kind != nullptr ? json(kind) : json()},
          {"datum", to_string(meta.datum)},
          {"radius_m", meta.datum.is_geometric()
                           ? value(mars::radius_at(meta.datum, mars::direction(a.place), a.elevation_m))
                           : json()},
          {"slope_deg", value(a.slope_deg)},
          {"aspect_deg", value(a.aspect_deg)},
          {"level", a.level},
          {"post_spacing_m", a.spacing_m},
          {"source", source != nullptr ? json(source->name) : json()},
          {"source_spacing_m", source != nullptr ? json(source->resolution_m) : json()},
          {"tile_sources", std::move(tile_sources)},
          {"tile_error_m", value(a.geometric_error_m)},
          {"resampling_max_m", has_error ? json(a.resampling.max_m) : json()},
          {"resampling_rms_m", has_error ? json(a.resampling.rms_m) : json()},
          {"resampling_posts", a.resampling.posts},
          {"resampling_scope", has_error ? json(a.resampling_of_level ? "level" : "tile") : json()},
          {"planet_resampling_max_m", meta.resampling.max_m},
          {"illustration", source != nullptr && source->illustration}};
}

nlohmann::json surface_to_json(const PlaceSurface& s, const paging::PlaceAnswer& ground) {
  using nlohmann::json;
  const auto value = [](bool is_known, double x) { return is_known ? json(x) : json(); };
  return {{"surface", s.object ? "object" : "ground"},
          {"object", s.object ? json(*s.object) : json()},
          {"side", s.is_top ? "top" : "underside"},
          {"height_m", value(!s.nodata, s.height_m)},
          {"above_ground_m", value(!ground.nodata, s.height_m - ground.elevation_m)},
          {"surface_error_m", value(!s.nodata, s.geometric_error_m)}};
}

std::string fixed(double x, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", digits, x);
  return text;
}

// The columns of a place, of the ground there, and of the objects.
constexpr const char* kPlaceColumns = "lon_deg,lat_deg";
constexpr const char* kGroundColumns =
    ",elevation_m,slope_deg,aspect_deg,level,post_spacing_m,source,tile_error_m,datum,source_spacing_m,"
    "resampling_max_m,resampling_rms_m,kind,measured_m";
constexpr const char* kNoGround = ",,,,,,,,,,,,,";
constexpr const char* kTopColumns = ",object,object_top_m";
// Numbers come before texts, which may hold commas, so that awk finds them.
constexpr const char* kSurfaceColumns = ",surface,side,height_m,above_ground_m,surface_error_m,object";

std::string place_cells(const mars::LonLat& place) {
  return base::format_number(place.lon_deg) + "," + base::format_number(place.lat_deg);
}

std::string ground_cells(const paging::PlaceAnswer& a, const paging::PlanetMeta& meta, double measured_m) {
  const auto number = [&](double x, int digits) { return a.nodata ? "" : fixed(x, digits); };
  const auto error = [&](double x) { return a.resampling.posts > 0 ? fixed(x, 3) : ""; };
  const mars::SourceInfo* source = source_of(a, meta);
  const char* kind = kind_of(a, meta);
  std::string cells;
  for (const std::string& cell :
       {number(a.elevation_m, 3), number(a.slope_deg, 3), number(a.aspect_deg, 2), std::to_string(a.level),
        fixed(a.spacing_m, 2), source != nullptr ? csv_field(source->name) : "", number(a.geometric_error_m, 3),
        csv_field(to_string(meta.datum)), source != nullptr ? fixed(source->resolution_m, 2) : "",
        error(a.resampling.max_m), error(a.resampling.rms_m), std::string(kind != nullptr ? kind : ""),
        std::isfinite(measured_m) ? fixed(measured_m, 3) : ""})
    cells += "," + cell;
  return cells;
}

std::string top_cells(const std::optional<ObjectTop>& top) {
  return top ? "," + csv_field(top->name) + "," + fixed(top->top_m, 3) : ",,";
}

std::string surface_cells(const PlaceSurface& s, const paging::PlaceAnswer& ground) {
  std::string cells = s.object ? ",object," : ",ground,";
  cells += s.is_top ? "top," : "underside,";
  cells += (s.nodata ? "" : fixed(s.height_m, 3)) + ",";
  cells += (ground.nodata ? "" : fixed(s.height_m - ground.elevation_m, 3)) + ",";
  cells += s.nodata ? "" : fixed(s.geometric_error_m, 6);
  return cells + "," + (s.object ? csv_field(*s.object) : "");
}

// Returns the names of a table's further columns as the answer has them.
std::string input_columns(const std::vector<std::string>& columns, const std::string& own) {
  std::string names;
  for (const std::string& name : columns) {
    const bool is_taken = ("," + own + ",").find("," + name + ",") != std::string::npos;
    names += "," + csv_field(is_taken ? "input_" + name : name);
  }
  return names;
}

std::string input_cells(const std::vector<std::string>& values) {
  std::string cells;
  for (const std::string& value : values) cells += "," + csv_field(value);
  return cells;
}

}  // namespace

nlohmann::json answers_json(const QueryAnswers& answers, const PlaceTable& table,
                            const paging::PlanetMeta& meta) {
  const std::vector<double> measured_m = measured_parts_m(answers.ground, meta);
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t n = 0; n < answers.ground.size(); ++n) {
    nlohmann::json& answer = list.emplace_back(to_json(answers.ground[n], meta, measured_m[n]));
    if (answers.tops) {
      const std::optional<ObjectTop>& top = (*answers.tops)[n];
      answer["object"] = top ? nlohmann::json(top->name) : nlohmann::json();
      answer["object_top_m"] = top ? nlohmann::json(top->top_m) : nlohmann::json();
    }
    if (answers.surfaces) {
      const std::vector<PlaceSurface>& surfaces = (*answers.surfaces)[n];
      for (const PlaceSurface& s : surfaces)
        answer["surfaces"].push_back(surface_to_json(s, answers.ground[n]));
    }
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      answer["input"][table.columns[c]] = table.cells[n][c];
  }
  return list;
}

mars::FeatureLayer answers_layer(const nlohmann::json& answers) {
  explore::FeatureTable table("query");
  for (const nlohmann::json& answer : answers) {
    const mars::LonLat place{answer.at("lon_deg").get<double>(), answer.at("lat_deg").get<double>()};
    const auto surfaces = answer.find("surfaces");
    if (surfaces == answer.end()) {
      table.add("", answer, {explore::point_shape(place)});
      continue;
    }
    nlohmann::json ground = answer;
    ground.erase("surfaces");
    for (const nlohmann::json& surface : *surfaces) {
      nlohmann::json one = ground;
      one.update(surface);
      table.add("", one, {explore::point_shape(place)});
    }
  }
  return table.layer();
}

void print_csv_answers(const QueryAnswers& answers, const PlaceTable& table, const paging::PlanetMeta& meta) {
  const std::vector<double> measured_m = measured_parts_m(answers.ground, meta);
  std::string columns = kPlaceColumns;
  if (answers.surfaces) columns += kSurfaceColumns;
  columns += kGroundColumns;
  if (answers.tops && !answers.surfaces) columns += kTopColumns;
  std::puts((columns + input_columns(table.columns, columns)).c_str());
  for (std::size_t n = 0; n < answers.ground.size(); ++n) {
    const std::string place = place_cells(answers.ground[n].place);
    const std::string ground = ground_cells(answers.ground[n], meta, measured_m[n]);
    const std::string input = table.columns.empty() ? "" : input_cells(table.cells[n]);
    if (!answers.surfaces) {
      const std::string top = answers.tops ? top_cells((*answers.tops)[n]) : "";
      std::puts((place + ground + top + input).c_str());
      continue;
    }
    const std::vector<PlaceSurface>& surfaces = (*answers.surfaces)[n];
    for (const PlaceSurface& s : surfaces)
      std::puts(
          (place + surface_cells(s, answers.ground[n]) + (s.object ? kNoGround : ground) + input).c_str());
  }
}

}  // namespace vpe::app
