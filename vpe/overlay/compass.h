// Compass marks: selects azimuths, makes their labels, and computes their positions in a view. Pure functions
// without any drawing library. Azimuths are clockwise from north, in degrees.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "vpe/core/view.h"

namespace vpe::overlay {

enum class CompassRank : std::uint8_t {
  kTick,    // without a label
  kFigure,  // "30\u00b0"
  kWind,    // "N", "NE"
};

struct CompassMark {
  double azimuth_deg = 0;  // within the requested range, so it may lie outside of [0, 360)
  CompassRank rank = CompassRank::kTick;
  std::string label;  // empty for ticks
};

// Holds the spacing of marks, in degrees.
struct CompassSteps {
  double tick_deg = 15;
  double figure_deg = 90;
  double room_deg = 0;  // width of one label
};

// Selects the spacing of marks for an image with this many pixels per degree, where it has the fewest, and for
// labels that are `label_px` wide. Figures stand every 90, 45, 30, 15, 10, 5, 2, 1, 0.5 ... 0.001 degrees, at
// least two label widths apart (90 is always used if nothing smaller fits), with two to six ticks for each.
// Both arguments must be more than 0.
CompassSteps compass_steps(double px_per_deg, double label_px);

// Returns the marks from an azimuth over a span of 0 or more to the right, both ends included, sorted by
// azimuth. The eight winds stand at their azimuths; with figures every 90 degrees only four do. Figures closer
// to a wind than the width of a label become ticks.
std::vector<CompassMark> compass_marks(double from_deg, double span_deg, const CompassSteps& steps);

struct PlacedMark {
  CompassMark mark;
  glm::dvec2 at;  // pixels of the view's drawn part
};

// Returns marks along the middle row of a view, at the positions of their azimuths in that row. `frame` defines
// north and up at the camera. Returns none if azimuths are not ordered along the row: within 2 degrees of the
// zenith or nadir, and in cylindrical or equirectangular views whose camera is not level.
std::vector<PlacedMark> compass_row(const core::View& view, const mars::LocalFrame& frame, double label_px);

// Holds the line of elevation 0 in a view's drawn part.
struct HorizonLine {
  glm::dvec2 left;
  glm::dvec2 right;
};

// Computes the horizon line. Returns nullopt if the view does not show it, and for cylindrical or
// equirectangular views whose camera is not level.
std::optional<HorizonLine> horizon_line(const core::View& view, const mars::LocalFrame& frame);

// Returns marks along the horizon line, or none if there is no such line.
std::vector<PlacedMark> compass_horizon(const core::View& view, const mars::LocalFrame& frame, double label_px);

}  // namespace vpe::overlay
