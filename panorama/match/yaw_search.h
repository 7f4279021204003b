// The coarse search: at which yaws, and fields of view, a photograph's skyline is like that of the planet.
#pragma once

#include <vector>

#include "panorama/match/skyline_fit.h"

namespace panorama {

// Holds limits of the search; match_skyline() enforces them.
struct YawSearchOptions {
  // Fields of view that are tried where none is given, vertical, degrees. Wider: slower, more chance likeness.
  double least_fov_deg = 8;
  double most_fov_deg = 110;
  // Attitudes beyond these are not tried, degrees. Larger: more chance likeness.
  double most_pitch_deg = 45;
  double most_roll_deg = 15;
  // Starts that are returned, 2 to 100. More: slower, less risk of a missed one.
  int starts = 24;
};

// Returns poses near local optima, best first; none where no attitude within the limits is like the skyline. At each
// yaw (steps of a hundredth of the photograph's width, 0.1 to 0.5 degrees) and field of view (steps of 3 %) pitch and
// roll are fitted to at most 160 of the points, for small angles, with the loss r^2 / (r^2 + s^2), s = 0.12 degrees
// (Geman and McClure). Starts differ by 2 degrees of yaw or 10 % of the field of view. Pure; any thread.
std::vector<PhotoPose> search_yaw(const FitProblem& problem, double fov_deg, const YawSearchOptions& options);

}  // namespace panorama
