// A controller that holds the time of a frame by drawing coarser: it raises the tolerance (metric kError) or
// the distances (metric kDistance) by a multiplier. Pure: it reads no clock, the caller passes measured times.
//
// A frame drawn with the multiplier m takes about  load * m^-slope  milliseconds. Load and slope are unknown
// and change. In logarithms this is a line, and the controller keeps an estimate of it: next_multiplier()
// corrects the line by one measured time and returns the multiplier where the line meets the budget. Each time
// comes with the multiplier of its frame, so the delay of the measurement does not matter. Only the estimate of
// the load is integrated, so nothing winds up at the limits.
//
//  - A time near the line moves it by a fraction, which averages noise.
//  - A time far off is accepted if a second one confirms it, or if the multiplier has just moved far and a
//    slope within the limits explains it. So a single slow frame (a page fault) changes nothing.
//  - Times may swing from far above the budget to far below it and back, because a single tile takes more than
//    the remaining budget. The controller then settles on the side below: for a while the multiplier may only
//    rise.
//  - The error after a move of the multiplier corrects the slope, the rest corrects the load.
//
// Stable if the true slope is less than twice the estimated one, at any delay (docs/design/level-of-detail.md
// derives the gain margin). Steps of the load by a factor of ten settle within 15 % of the budget in at most 10
// frames, at delays of 1 to 3 frames and slopes from 0.5 to 4 (tested).
//
// Typical usage:
//   request.coarsening = next_multiplier(options, {last_multiplier, last_ms}, state);
#pragma once

namespace lod {

struct FrameBudgetOptions {
  double budget_ms = 16;       // > 0; smaller: smoother motion, coarser images
  double max_multiplier = 64;  // >= 1; limit of the coarsening
  double first_slope = 2;      // estimate before the first measurement
  double min_slope = 0.4;
  double max_slope = 6;
};

// A measured frame.
struct FrameTime {
  double multiplier = 1;  // with which the frame was drawn, > 0
  double ms = 0;          // time that it took
};

// The estimate of the controller. Regular type; a default one knows nothing.
struct FrameBudgetState {
  bool started = false;
  double multiplier = 1;
  double log_load = 0;        // log of (time at multiplier 1 / budget)
  double slope = 0;           // -d log time / d log multiplier, positive
  double slope_variance = 1;  // uncertainty of the slope
  double anchor = 0;          // log multiplier at which the line was last corrected
  bool doubting = false;      // the last time was far off and not accepted
  double doubted = 0;         // its distance from the line, in logarithms
  double doubted_at = 0;      // its log multiplier
  int side = 0;               // of the budget, for the last accepted time far off: 1 above, -1 below
  double swings = 0;          // number of changes of side; decays over time

  bool operator==(const FrameBudgetState&) const = default;
};

// Returns the multiplier for the next frame, in 1 .. max_multiplier, and keeps it in the state. Times may come
// late, and some may be left out. A time or multiplier that is not finite and positive changes nothing. Throws
// std::invalid_argument for options out of range.
double next_multiplier(const FrameBudgetOptions& options, const FrameTime& measured, FrameBudgetState& state);

}  // namespace lod
