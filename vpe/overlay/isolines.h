// Lines of equal value over the terrain in an image, as chains of points (marching squares).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "vpe/overlay/visible_terrain.h"

namespace vpe::overlay {

struct Isoline {
  std::int64_t multiple = 0;  // the line's value divided by IsolineOptions::step
  bool closed = false;
  std::vector<glm::dvec2> points;  // in the layer's pixels
  std::vector<double> spacing_px;  // distance to the next line at each point, smoothed along the line
  std::vector<double> trust;       // 0 to 1 at each point; empty means 1 everywhere

  double length_px() const;
};

struct IsolineOptions {
  double step = 1;        // Smaller: more lines, slower; larger: fewer lines.
  double period = 0;      // > 0: values are angles in (-period/2, period/2]
  int leave_out = 0;      // > 0: multiples of this number are skipped
  double noise = 0;       // cells that span at most this times VisibleTerrain::noise_m() have no line
  double densest_px = 1;  // cells with lines closer than this have no line
};

// Traces isolines. `values` holds one value for each pixel and is interpolated linearly between pixel centres.
// Each point of a line lies on the edge between two neighbouring pixels. The order of the lines is not
// specified, but is the same for the same input.
std::vector<Isoline> isolines(const VisibleTerrain& terrain, const std::vector<double>& values,
                              const IsolineOptions& options);

}  // namespace vpe::overlay
