// Results of drawings, as the window has measured them: JSON, features and text. All functions are pure.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mars/vector/feature.h"
#include "vpe/explore/drawing/drawing_measures.h"
#include "vpe/explore/results/ground_along.h"

namespace vpe::explore {

// Refers to a drawing and to what was measured of it; all of it must outlive this.
struct DrawingResults {
  const Drawing& drawing;
  const SphereMeasures& sphere;
  const GroundMeasures& ground;
  const GroundAlong& along;  // at the point, or along line or outline
  const paging::PlanetMeta& meta;
};

// Returns datum, resolution, error, and the shares of nodata and of made-up ground as lines for people: of the area of a
// polygon that has statistics, else along the drawing.
std::vector<ReadOutLine> drawing_ground_lines(const DrawingResults& results);

// Returns the figures: of a polygon with statistics those of polygon_json(), else lengths, elevations, and ground_json()
// along the drawing.
nlohmann::json drawing_json(const DrawingResults& results);

// Returns one feature, the drawing, with the values of drawing_json().
mars::FeatureLayer drawing_layer(const DrawingResults& results);

// Returns the figures as lines of text, each ending in a line break.
std::string drawing_text(const DrawingResults& results);

}  // namespace vpe::explore
