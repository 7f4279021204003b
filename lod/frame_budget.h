// Holds the time of a frame by drawing coarser: a controller on the tolerance (in rule hitchner, on the
// distances). Pure: no clock, it is told what frames took.
//
// A frame drawn with the multiplier m on its tolerance takes some  load * m^-slope  milliseconds. Load and
// slope are not known, and change. In logarithms that is a line, and the controller keeps an estimate of it:
// next() corrects the line by what one frame took and gives the multiplier where the line meets the budget.
// Each time is told together with the multiplier of the frame that took it, so that it does not matter how many
// frames ago that was; nothing is integrated beyond the estimate of the load itself, so that nothing winds up
// at the limits.
//
//   - A time near the line moves it by a part: noise is averaged out.
//   - A time far off is believed when a second one says the same, or when the multiplier has just moved far and
//   a slope
//     within the limits explains it. So a single slow frame (a page fault) changes nothing.
//   - Times that swing from far above the budget to far below it and back, because a single tile is more than
//   the
//     budget's fraction, are ended on the side below: for a while the multiplier may only rise.
//   - What is off after the multiplier has moved tells the slope, the rest the load.
//
// Stable when the true slope is less than twice the estimated one, whatever the delay (docs/lod.md: gain
// margin). Steps of the load of ten times either way settle within 15 % of the budget in at most 10 frames at
// delays of 1 to 3 frames and slopes from 0.5 to 4 (tested).
#pragma once

namespace lod {

struct FrameBudgetOptions {
  double budget_ms = 16;       // > 0
  double max_multiplier = 64;  // >= 1
  double first_slope = 2;      // before anything is known
  double min_slope = 0.4;
  double max_slope = 6;
};

struct FrameTime {
  double multiplier = 1;  // that the frame was drawn with, > 0
  double ms = 0;          // that it took
};

// What is known so far. Regular type; a new one knows nothing.
struct FrameBudgetState {
  bool started = false;
  double multiplier = 1;
  double log_load = 0;        // of the time at multiplier 1 over the budget
  double slope = 0;           // of log time over log multiplier, positive
  double slope_variance = 1;  // how open the slope is to what is measured
  double anchor = 0;          // log multiplier at which the line was last right
  bool doubting = false;      // the last time was far off and not believed
  double doubted = 0;         // how far, in logarithms
  double doubted_at = 0;      // at which log multiplier
  int side = 0;               // of the budget on which the last believed time was far off: 1 above, -1 below
  double swings = 0;          // changes of side, forgotten by and by

  bool operator==(const FrameBudgetState&) const = default;
};

// The multiplier for the next frame, in 1 .. max_multiplier, which is also kept in the state. Times may come
// late, and some may be left out. A time or multiplier that is not finite and positive changes nothing. Throws
// std::invalid_argument for options out of range.
double next_multiplier(const FrameBudgetOptions& options, const FrameTime& measured, FrameBudgetState& state);

}  // namespace lod
