#include "vpe/explore/results/drawing_results.h"

#include "vpe/base/number.h"
#include "vpe/explore/results/feature_table.h"
#include "vpe/explore/results/path_results.h"
#include "vpe/explore/results/polygon_results.h"

namespace vpe::explore {

namespace {

bool has_statistics(const DrawingResults& results) {
  return results.drawing.kind == DrawingKind::kPolygon && results.ground.statistics.has_value();
}

MeasuredPolygon polygon_of(const DrawingResults& results) {
  return {results.drawing, results.sphere.length_m, results.ground.length_m, *results.ground.statistics, {}};
}

mars::Shape shape_of(const Drawing& drawing) {
  switch (drawing.kind) {
    case DrawingKind::kPoint: return point_shape(drawing.vertices.front());
    case DrawingKind::kLine: return great_circle_line(drawing.vertices);
    case DrawingKind::kPolygon: break;
  }
  return great_circle_polygon(drawing.vertices);
}

}  // namespace

std::vector<ReadOutLine> drawing_ground_lines(const DrawingResults& results) {
  return has_statistics(results) ? polygon_ground_lines(*results.ground.statistics, results.meta)
                                 : ground_lines(results.along, results.meta);
}

nlohmann::json drawing_json(const DrawingResults& results) {
  if (has_statistics(results)) return polygon_json(polygon_of(results), results.meta);
  nlohmann::json all = ground_json(results.along, results.meta);
  all["name"] = results.drawing.name;
  all["kind"] = std::string(to_string(results.drawing.kind));
  all["lowest_m"] = results.ground.lowest_m;
  all["highest_m"] = results.ground.highest_m;
  if (results.drawing.kind == DrawingKind::kPoint) return all;
  all["length_m"] = results.sphere.length_m;
  all["ground_length_m"] = results.ground.length_m;
  if (results.sphere.area_m2) all["sphere_area_m2"] = *results.sphere.area_m2;
  if (results.ground.area) all["ground_area_m2"] = results.ground.area->area_m2;
  return all;
}

mars::FeatureLayer drawing_layer(const DrawingResults& results) {
  FeatureTable table("measure");
  table.add("", drawing_json(results), {shape_of(results.drawing)});
  return table.layer();
}

std::string drawing_text(const DrawingResults& results) {
  if (has_statistics(results)) return polygon_text(polygon_of(results), results.meta);
  std::vector<ReadOutLine> lines;
  const auto add = [&](const char* label, std::string text) { lines.push_back({label, std::move(text)}); };
  const auto height = [](double height_m) { return base::format_display(height_m, 1) + " m"; };
  add("", results.drawing.name);
  if (results.drawing.kind == DrawingKind::kPoint) {
    add("Place", coordinates_text(results.drawing.vertices.front()));
    add("Elevation", height(results.ground.lowest_m));
  } else {
    add("Great circle", measured_length_text(results.sphere.length_m));
    add("Over ground", measured_length_text(results.ground.length_m));
    if (results.sphere.area_m2) add("Area", measured_area_text(*results.sphere.area_m2));
    if (results.ground.area) add("Area of ground", measured_area_text(results.ground.area->area_m2));
    add("Lowest", height(results.ground.lowest_m));
    add("Highest", height(results.ground.highest_m));
  }
  for (ReadOutLine& line : drawing_ground_lines(results)) lines.push_back(std::move(line));
  return text_of_lines(lines);
}

}  // namespace vpe::explore
