// Marks of azimuth: which there are, what they say, and where a view has them. Pure, and without any library of
// letters. Azimuth is clockwise from north, degrees.
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
  double azimuth_deg = 0;  // within the range that was asked for, any number of turns
  CompassRank rank = CompassRank::kTick;
  std::string label;  // empty for ticks
};

// How far marks are apart, degrees.
struct CompassSteps {
  double tick_deg = 15;
  double figure_deg = 90;
  double room_deg = 0;  // that one label takes
};

// As suits an image of so many pixels a degree, where it has the fewest, and labels that are `label_px` wide:
// figures every 90, 45, 30, 15, 10, 5, 2, 1, 0.5 ... 0.001 degrees, two labels apart at least (90 always), and
// two to six ticks to each. Both numbers are more than 0.
CompassSteps compass_steps(double px_per_deg, double label_px);

// The marks from one azimuth over a span of 0 or more to the right, both ends belonging to it, by azimuth. The
// eight winds stand at their azimuths (with figures every 90 degrees only four), and figures closer to one than
// a label's room are ticks.
std::vector<CompassMark> compass_marks(double from_deg, double span_deg, const CompassSteps& steps);

struct PlacedMark {
  CompassMark mark;
  glm::dvec2 at;  // pixels of the view's drawn part
};

// Where the azimuths that the middle row of a view shows are in that row. `frame` says what is north and up at
// the camera. Empty where the row has no order of azimuths: within 2 degrees of the zenith or nadir, and in round
// views whose camera is not level.
std::vector<PlacedMark> compass_row(const core::View& view, const mars::LocalFrame& frame, double label_px);

// The line of elevation 0 in a view's drawn part, left to right; nothing where it shows none, and in round
// views whose camera is not level.
struct HorizonLine {
  glm::dvec2 left;
  glm::dvec2 right;
};
std::optional<HorizonLine> horizon_line(const core::View& view, const mars::LocalFrame& frame);

// Where azimuths are on it; empty where there is none.
std::vector<PlacedMark> compass_horizon(const core::View& view, const mars::LocalFrame& frame, double label_px);

}  // namespace vpe::overlay
