// Results of polygons: areas, slopes, dip and strike, volumes as JSON, features and text. All functions are pure.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "mars/vector/feature.h"
#include "paging/planet/planet_file.h"
#include "vpe/explore/drawing/drawing.h"
#include "vpe/explore/drawing/ground_statistics.h"
#include "vpe/explore/measure/read_out.h"

namespace vpe::explore {

// Holds what was measured within a polygon.
struct MeasuredPolygon {
  Drawing polygon;
  double outline_m = 0;         // on the planet's sphere
  double ground_outline_m = 0;  // over the ground below it
  GroundStatistics ground;
  GroundStatisticsOptions options;
};

// Returns by how much the ground may be off its sources' posts, metres: there, or else anywhere on the planet.
double elevation_error_m(const GroundStatistics& ground, const paging::PlanetMeta& meta);

// Returns what `vpe measure --json` prints of a polygon; angles in degrees, volumes against references that do not exist
// are null.
nlohmann::json polygon_json(const MeasuredPolygon& measured, const paging::PlanetMeta& meta);

// Returns the same as lines of text, each ending in a line break.
std::string polygon_text(const MeasuredPolygon& measured, const paging::PlanetMeta& meta);

// Returns a feature for each polygon with the values of its JSON. Both lists have the same order and length.
mars::FeatureLayer polygon_layer(const nlohmann::json& results, std::span<const Drawing> polygons);

// Returns datum, resolution, error, and the shares of nodata and of made-up ground as lines for people.
std::vector<ReadOutLine> polygon_ground_lines(const GroundStatistics& ground, const paging::PlanetMeta& meta);

}  // namespace vpe::explore
