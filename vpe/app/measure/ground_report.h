// Writes what vpe measure prints of a polygon: JSON, or lines for people.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/explore/drawing/drawing.h"
#include "vpe/explore/drawing/ground_statistics.h"

namespace vpe::app {

struct MeasuredGround {
  explore::Drawing polygon;
  double outline_m = 0;         // on the planet's sphere
  double ground_outline_m = 0;  // over the ground below it
  explore::GroundStatistics ground;
  explore::GroundStatisticsOptions options;
};

// Returns the values of a polygon; angles in degrees, volumes against references that do not exist are null.
nlohmann::json to_json(const MeasuredGround& measured, const paging::PlanetMeta& meta);

// Returns the same as lines of text, each ending in a line break.
std::string to_text(const MeasuredGround& measured, const paging::PlanetMeta& meta);

}  // namespace vpe::app
