// Lines of equal value over the ground in an image, as chains of points (marching squares).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "vpe/overlay/visible_terrain.h"

namespace vpe::overlay {

struct Isoline {
  std::int64_t multiple = 0;  // its value is this times the step
  bool closed = false;
  std::vector<glm::dvec2> points;  // in the layer's pixels
  std::vector<double> spacing_px;  // at each point, to the next line, smoothed along the line
  std::vector<double> trust;       // 0 to 1 at each point; empty for 1

  double length_px() const;
};

struct IsolineOptions {
  double step = 1;
  double period = 0;      // values are angles in (-period/2, period/2]
  int leave_out = 0;      // multiples of this are not made
  double noise = 0;       // cells that span no more than this times Ground::noise_m() have no line
  double densest_px = 1;  // nor have cells with lines closer than this
};

// `values`: of every pixel of the ground, straight between pixel centres. Each point of a line is where its
// value is on the edge between two neighbouring pixels. In no particular order, but the same for the same
// input.
std::vector<Isoline> isolines(const VisibleTerrain& ground, const std::vector<double>& values,
                              const IsolineOptions& options);

}  // namespace vpe::overlay
