// The figures of a line of sight as text. All functions are pure.
#pragma once

#include <string>
#include <vector>

#include "vpe/explore/measure/line_of_sight.h"
#include "vpe/explore/measure/read_out.h"

namespace vpe::explore {

// Names the ends of a line of sight.
struct SightEnds {
  std::string first;
  std::string last;
  double last_height_m = 0;  // above the ground
  bool has_objects = false;  // a scene was regarded
};

// Returns the figures of a line of sight: its length and clearance; if it is obstructed, by which object, where, and from
// which height on the last point is seen. That height regards ground alone, and says so where there are objects.
std::vector<ReadOutLine> sight_lines(const LineOfSight& sight, const SightEnds& ends);

}  // namespace vpe::explore
